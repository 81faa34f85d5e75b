"""What becomes of the walk when nobody leads the robot any more: the operator's link, watched on the robot's clock."""

from __future__ import annotations

from dataclasses import dataclass

from behaviors.operator import OperatorEvent, PauseWalk, ResetBehavior, StopNow
from skills.parameters import parameter, parameters

_DONE: dict[str, tuple[OperatorEvent | None, str]] = {
    "hold": (PauseWalk(), "the robot finishes its step and stands, until it is told to resume"),
    "go_on": (None, "the robot goes on"),
    "reset": (ResetBehavior(), "the robot finishes its step, stands, and forgets its goal"),
    "stop": (StopNow(), "the run is stopped"),
}


@parameters
class OperatorLinkParameters:
    """What is done when the operator's link is lost; a link counts from the first operator who takes control."""

    when_lost: str = parameter(
        "hold", unit="1", meaning="finish the step and hold, go on, reset, or stop the run", choices=tuple(_DONE)
    )
    patience: float = parameter(
        3.0, unit="s", meaning="robot time without an operator after which the link is lost", minimum=0.2, maximum=600.0
    )


@dataclass(frozen=True, slots=True)
class LinkChange:
    """The link is lost, or there again.

    Attributes:
        text: what to tell.
        event: what to send to the tree; None for nothing.
    """

    text: str
    event: OperatorEvent | None = None


class OperatorLink:
    """Watches whether an operator is there."""

    def __init__(self) -> None:
        self._last_heard: float | None = None
        self._lost = False

    @property
    def lost(self) -> bool:
        """Whether there was an operator and there is none now."""
        return self._lost

    def watch(self, time: float, heard: bool, parameters: OperatorLinkParameters) -> LinkChange | None:
        """Once a tick.

        Args:
            time: robot time [s].
            heard: whether an operator who holds control was heard of since the last call.
            parameters: what to do, and when.
        """
        if heard:
            self._last_heard = time
            if self._lost:
                self._lost = False
                return LinkChange("the operator is back")
            return None
        if self._lost or self._last_heard is None or time - self._last_heard <= parameters.patience:
            return None
        self._lost = True
        event, told = _DONE[parameters.when_lost]
        return LinkChange(
            f"the operator's link is lost, nothing was heard for {parameters.patience:g} s: {told}", event
        )
