"""Asks the operator in the terminal, while the robot's clock waits."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager

from behaviors import SettingError, Tree
from behaviors.operator import (
    Approve,
    OperatorEvent,
    Reject,
    ResetBehavior,
    ReviewRequest,
    StopNow,
    SwitchReview,
)
from lookstep.moment import Moment
from skills.body_path import BodyPath
from skills.footsteps import FootstepPlan
from skills.parameters import ParameterError
from strict_yaml import YamlError, parse_document

HELP = """\
  a, approve         let it be done
  r, reject          plan it again
  off                approve, and ask no more at this checkpoint
  set KEY=VALUE      change a parameter, such as set footsteps.reach=0.4; then reject, to plan with it
  reset              forget the goal and wait for a new one
  stop               end the run"""


class TerminalReview:
    """An observer that asks for each thing that waits for approval, and sends the answer to the tree.

    Args:
        ask: shows a prompt and gives the line that is typed; raises EOFError where nothing comes any more.
        tell: shows a line.
        aside: is entered while it asks, so that nothing else writes into the terminal.
    """

    def __init__(
        self,
        ask: Callable[[str], str],
        tell: Callable[[str], None],
        aside: Callable[[], AbstractContextManager[object]],
    ) -> None:
        self._ask = ask
        self._tell = tell
        self._aside = aside

    def observe(self, moment: Moment) -> None:
        """Ask until there is an answer; no robot time passes meanwhile."""
        for request in moment.tree.context.reviews:
            with self._aside():
                self._tell(f"{moment.time:.2f} s: {_describe(request)}")
                moment.tree.send(self._answer(request, moment.tree))

    def _answer(self, request: ReviewRequest, tree: Tree) -> OperatorEvent:
        while True:
            try:
                line = self._ask("approve, reject, off, set KEY=VALUE, reset, stop? ").strip()
            except EOFError:
                self._tell("nobody answers; the run is stopped")
                return StopNow()
            word, _, rest = line.partition(" ")
            match word.lower():
                case "a" | "approve":
                    return Approve(request.checkpoint, request.item_id)
                case "r" | "reject":
                    return Reject(request.checkpoint, request.item_id)
                case "off":
                    return SwitchReview(request.checkpoint, asks=False)
                case "reset":
                    return ResetBehavior()
                case "stop":
                    return StopNow()
                case "set":
                    self._tell(_set(rest, tree))
                case _:
                    self._tell(HELP)


def _set(text: str, tree: Tree) -> str:
    """Change a parameter between two ticks; what to tell about it."""
    name, equals, value = text.partition("=")
    target, _, key = name.strip().rpartition(".")
    if not (equals and target and key):
        return f"got {text!r}, needs KEY=VALUE such as footsteps.reach=0.4"
    try:
        tree.set_parameter(target, key, parse_document(value, "set").value)
    except (SettingError, ParameterError, YamlError) as error:
        return str(error)
    return f"{target}.{key} is {value.strip()} now"


def _describe(request: ReviewRequest) -> str:
    """What waits for approval, in one line and one for each step."""
    item = request.item
    if isinstance(item, BodyPath):
        x, y, _ = item.waypoints_world[-1]
        return f"body path {item.path_id} waits for approval: {item.length:.2f} m to x {x:.2f} m, y {y:.2f} m"
    if isinstance(item, FootstepPlan):
        steps = [
            f"\n  {step.side.value:5} x {step.T_world_sole.p[0]:6.2f} m, y {step.T_world_sole.p[1]:6.2f} m, "
            f"z {step.T_world_sole.p[2]:5.2f} m, yaw {step.T_world_sole.yaw:5.2f} rad"
            for step in item.steps
        ]
        return f"plan {item.plan_id} waits for approval: {item.outcome.value}{''.join(steps)}"
    return f"{request.checkpoint} {request.item_id} waits for approval"
