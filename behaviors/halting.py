"""Decorators that let the robot stand: while something must be waited for, and where something has gone wrong."""

from __future__ import annotations

from py_trees.common import Status

from behaviors.decorators import Decorator


class HaltUnless(Decorator):
    """Ticks its child only while a condition succeeds, which it asks at every tick; else the robot is held.

    Held means: the child is stopped, the robot finishes the step under way and stands, and when the condition succeeds
    again, the child begins anew. Both ends are told in the log, the first with the condition's reason.
    """

    kind = "halt_unless"
    slots = ("condition", "child")

    def initialise(self) -> None:
        """Nothing is held."""
        self._halted_at: float | None = None

    def update(self) -> Status:
        """The child's status while the condition succeeds, else RUNNING with the condition's reason."""
        condition = self.children[0]
        condition.tick_once()
        if condition.status is Status.SUCCESS:
            self._go_on()
            return self._tick_child()
        self._stop_from(1)
        self.reason = f"halted: {condition.reason}"
        if self._halted_at is None:
            self._halted_at = self.context.time
            self.context.robot.caller = self.path
            self.context.robot.hold()
            self.context.log(self.reason, path=self.path)
        return Status.RUNNING

    def _go_on(self) -> None:
        if self._halted_at is not None:
            self.context.log(f"goes on after {self.context.time - self._halted_at:.1f} s", path=self.path)
            self._halted_at = None


class PauseOnFailure(Decorator):
    """Lets the robot finish the step under way and stand where its child fails; queued steps are dropped."""

    kind = "pause_on_failure"

    def update(self) -> Status:
        """The child's status."""
        status = self._tick_child()
        if status is Status.FAILURE:
            self.context.robot.caller = self.path
            self.context.robot.hold()
            self.context.log(f"pauses: {self.reason}", path=self.path)
        return status
