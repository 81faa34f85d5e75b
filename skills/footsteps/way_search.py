"""One search for a way of footholds: from a request to what the kernel takes, and from its nodes back to footholds."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skills.footsteps.footstep import Side, Stance
from skills.footsteps.footstep_lattice import FootstepLattice
from skills.footsteps.footstep_parameters import FootstepParameters
from skills.footsteps.footstep_search import OUT_OF_BUDGET, REACHED, search_footsteps
from skills.footsteps.open_list import EDGE
from skills.footsteps.rejections import counted, most_frequent
from skills.footsteps.search_log import SearchLog
from skills.footsteps.search_request import search_space
from skills.footsteps.search_target import SearchTarget
from skills.footsteps.terrain import Foothold, Terrain

_OPEN_LIST = 16384
# Nodes that are expanded between two looks at the clock: a few milliseconds.
_SLICE = 100


@dataclass(frozen=True, slots=True, eq=False)
class SearchBudget:
    """How long a search may take.

    Attributes:
        expansions: nodes that it may expand.
        out_of_time: whether it must end; None where time does not count.
        steps: fewest steps of a way that is not yet at the end of the path.
    """

    expansions: int
    out_of_time: Callable[[], bool] | None
    steps: int


@dataclass(frozen=True, slots=True, eq=False)
class Found:
    """What a search has found.

    Attributes:
        footholds: the best way.
        reached: whether it ends where it was to go.
        reason: why it does not.
        saved: what is saved of the estimated cost to go.
        expansions: nodes that were expanded.
        rejections: counts by reason.
        log: every step looked at; None where that was not asked for.
    """

    footholds: list[Foothold]
    reached: bool
    reason: str
    saved: float
    expansions: int
    rejections: NDArray[np.int64]
    log: SearchLog | None


def search_way(
    terrain: Terrain,
    stance: Stance,
    first_side: Side,
    target: SearchTarget,
    parameters: FootstepParameters,
    budget: SearchBudget,
    *,
    logged: bool = False,
) -> Found:
    """Search for footholds from a stance to a target, until it is reached or the budget is spent."""
    lattice = FootstepLattice.around(terrain, stance, first_side, target, parameters)
    room = budget.expansions if logged else 0
    space = search_space(terrain, lattice, stance, first_side, target, parameters, budget.steps, room)
    open_list = np.empty(_OPEN_LIST, dtype=EDGE)
    timed_out, most = False, 0
    while True:
        most = budget.expansions if budget.out_of_time is None else min(most + _SLICE, budget.expansions)
        ended, last, before_last, _, saved, open_list = search_footsteps(space, open_list, most)
        if ended != OUT_OF_BUDGET or most == budget.expansions:
            break
        timed_out = budget.out_of_time is not None and budget.out_of_time()
        if timed_out:
            break
    expansions = int(space.state[0]["expansions"])
    return Found(
        footholds=[lattice.foothold(node, space.grounds) for node in _way(space.nodes["parent"], last, before_last)],
        reached=ended == REACHED,
        reason=_why(ended, timed_out, expansions, space.rejections),
        saved=saved,
        expansions=expansions,
        rejections=space.rejections,
        log=SearchLog.of(lattice, first_side, space) if logged else None,
    )


def _way(parents: NDArray[np.int64], last: int, before_last: int) -> list[int]:
    """Nodes from the first step to the last; the stance foot's node, whose parent is past the end, is left out."""
    way = [last, before_last]
    while way[-1] < len(parents) - 1:
        way.append(int(parents[way[-1]]))
    return way[-3::-1]


def _why(ended: int, timed_out: bool, expansions: int, rejections: NDArray[np.int64]) -> str:
    """One sentence on why a search ended without its goal."""
    if ended == REACHED:
        return ""
    frequent = most_frequent(counted(rejections))
    most = f", most rejected: {frequent}" if frequent else ""
    if timed_out:
        return f"the sub-goal was not found in time, after {expansions} expansions{most}"
    if ended == OUT_OF_BUDGET:
        return f"the sub-goal was not found within {expansions} expansions{most}"
    return f"no footholds lead to the sub-goal{most}"
