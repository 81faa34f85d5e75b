"""One file a plan: the request with regions, stances and parameters, the plan, and the whole search for it.

The file is a zip of numpy arrays, compressed; the entry `header` is JSON and names format and version. It is written
beside its place and moved there, so that nobody ever reads half a file. What a newer version of this program has added
or dropped among the parameters is taken from their defaults, or left out.
"""

from __future__ import annotations

import dataclasses
import json
import zipfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from lookstep.errors import UserError
from lookstep.plan_log.packing import (
    pack_plan,
    pack_regions,
    pack_search,
    pack_stance,
    unpack_plan,
    unpack_regions,
    unpack_search,
    unpack_stance,
)
from skills.body_path import BodyPath, SubGoal
from skills.footsteps import (
    FootstepParameters,
    FootstepPlan,
    PlanRequest,
    SearchLog,
    Side,
    TerrainParameters,
)
from skills.parameters import ParameterError

PLAN_SUFFIX = ".plan"
_FORMAT, _VERSION = "lookstep footstep plan", 1


class PlanFileError(UserError):
    """A file that is no plan log, or one of another version; the message says which file and what is wrong."""


@dataclass(frozen=True, slots=True, eq=False)
class LoggedPlan:
    """A plan as it was made in a run.

    Attributes:
        request: what it was made from.
        plan: what came out.
        searches: the search for a fresh plan, one a foot that was tried first.
        time: robot time at which it was delivered [s].
        compute_ms: wall time that it took; NaN where that is not known [ms].
    """

    request: PlanRequest
    plan: FootstepPlan
    searches: tuple[SearchLog, ...]
    time: float
    compute_ms: float


def write_plan(file: Path, logged: LoggedPlan) -> None:
    """Write a plan log, whole or not at all."""
    request, arrays = logged.request, {}
    goal = request.sub_goal
    header = {
        "format": _FORMAT,
        "version": _VERSION,
        "time": logged.time,
        "compute_ms": logged.compute_ms,
        "first_side": None if request.first_side is None else request.first_side.value,
        "plan_id": request.plan_id,
        "first_sequence_id": request.first_sequence_id,
        "sub_goal": [goal.start_arc_length, goal.arc_length, goal.search_arc_length],
        "footsteps": dataclasses.asdict(request.footsteps),
        "terrain": dataclasses.asdict(request.terrain),
        "ground": pack_regions(request.ground, "ground", arrays),
        "plan": pack_plan(logged.plan, "plan", arrays),
        "reference": None if request.reference is None else pack_plan(request.reference, "reference", arrays),
        "searches": [pack_search(log, f"search{i}", arrays) for i, log in enumerate(logged.searches)],
    }
    arrays |= {
        "path": goal.path.waypoints_world,
        "searched_path": goal.searched_world,
        "stance": pack_stance(request.stance),
        "header": np.frombuffer(json.dumps(header).encode(), dtype=np.uint8),
    }
    partial = file.with_name(file.name + ".partial")
    with partial.open("wb") as stream:
        np.savez_compressed(stream, **arrays)
    partial.replace(file)


def read_plan(file: Path) -> LoggedPlan:
    """Read a plan log.

    Raises:
        PlanFileError: where the file is missing, is no plan log, or is one of another version.
    """
    arrays = _arrays(file)
    try:
        header = json.loads(bytes(arrays["header"]))
        if header["format"] != _FORMAT:
            raise PlanFileError(f'{file}: is a "{header["format"]}", needs a "{_FORMAT}"')
        if header["version"] != _VERSION:
            raise PlanFileError(f"{file}: is of version {header['version']}; this program reads version {_VERSION}")
        start, end, searched = header["sub_goal"]
        reference = header["reference"]
        request = PlanRequest(
            ground=unpack_regions(header["ground"], "ground", arrays),
            sub_goal=SubGoal(BodyPath(arrays["path"]), start, end, searched, arrays["searched_path"]),
            stance=unpack_stance(arrays["stance"]),
            first_side=None if header["first_side"] is None else Side(header["first_side"]),
            plan_id=header["plan_id"],
            first_sequence_id=header["first_sequence_id"],
            reference=None if reference is None else unpack_plan(reference, "reference", arrays),
            footsteps=_parameters(FootstepParameters, header["footsteps"]),
            terrain=_parameters(TerrainParameters, header["terrain"]),
        )
        return LoggedPlan(
            request=request,
            plan=unpack_plan(header["plan"], "plan", arrays),
            searches=tuple(unpack_search(log, f"search{i}", arrays) for i, log in enumerate(header["searches"])),
            time=header["time"],
            compute_ms=header["compute_ms"],
        )
    except (KeyError, IndexError, TypeError, ValueError) as error:
        raise PlanFileError(f"{file}: is a damaged plan log: {type(error).__name__}: {error}") from error


def _arrays(file: Path) -> dict[str, np.ndarray]:
    if file.is_dir():
        raise PlanFileError(f"{file}: is a folder, needs one plan log (*{PLAN_SUFFIX}); `lookstep plans` lists them")
    try:
        with np.load(file, allow_pickle=False) as loaded:
            return dict(loaded)
    except FileNotFoundError as error:
        raise PlanFileError(f"{file}: no such file") from error
    except (OSError, ValueError, EOFError, AttributeError, TypeError, zipfile.BadZipFile) as error:
        raise PlanFileError(f"{file}: is no plan log: {error}") from error


def _parameters(cls: type, values: Mapping[str, Any]) -> Any:
    """Parameters by name, without those that no longer exist."""
    known = {field.name for field in dataclasses.fields(cls)}
    try:
        return cls(**{name: value for name, value in values.items() if name in known})
    except ParameterError as error:
        raise ValueError(f"{cls.__name__}: {error}") from error
