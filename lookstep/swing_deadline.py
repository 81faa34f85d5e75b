"""Whether plans can be there before the swing ends, by the parameters alone: a deadline that no run could meet."""

from __future__ import annotations

from collections.abc import Iterator

from behaviors import NodeSpec, TreeSpec
from behaviors.leaves import PlanFootsteps, WaitForSwing
from strict_yaml import Problem


def check_swing_deadlines(tree: TreeSpec, swing_duration: float) -> list[Problem]:
    """A problem for each leaf that plans longer than what is left of a swing when it is asked.

    Args:
        tree: plans in the sequences that also wait for the swing.
        swing_duration: of the shipped configuration [s].
    """
    problems = []
    for node in tree:
        if not node.kind.endswith("sequence"):
            continue
        below = [*_of(node, WaitForSwing.__name__)]
        if len(below) != 1:
            continue
        (wait,) = below
        rest = (1.0 - wait.parameters.fraction) * swing_duration
        for plan in _of(node, PlanFootsteps.__name__):
            latency = plan.parameters.latency
            if latency > rest:
                message = (
                    f"can never be in time: a plan takes {latency:g} s, and {wait.path} leaves {rest:g} s of a swing "
                    f"of {swing_duration:g} s"
                )
                problems.append(Problem(plan.location, message, plan.path))
    return sorted(set(problems))


def _of(node: NodeSpec, kind: str) -> Iterator[NodeSpec]:
    return (found for found in node if found.kind == kind)
