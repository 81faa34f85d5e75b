"""Command the walking controller, and wait for it."""

from __future__ import annotations

from py_trees.common import Status

from behaviors.leaf import Leaf
from behaviors.ports import Input
from behaviors.registry import leaf
from skills.footsteps import FootstepPlan
from skills.parameters import parameter, parameters
from skills.walking import WalkingPhase


@leaf
class SendFootsteps(Leaf):
    """Sends a plan to the robot in place of all steps that have not begun."""

    plan = Input(FootstepPlan, "the next footsteps")

    def tick(self) -> Status:
        """SUCCESS once the steps are queued; steps that began while the plan was made are left out."""
        status = self.context.robot.status()
        begun = -1 if status.current_step is None else status.current_step.sequence_id
        if status.current_step is not None and status.phase is WalkingPhase.TRANSFER:
            begun -= 1
        steps = tuple(step for step in self.plan.steps if step.sequence_id > begun)
        if not steps:
            return self.failed("all planned steps have begun while they were planned")
        self.context.robot.send_footsteps(steps)
        return self.succeeded(f"sent {len(steps)} steps")


@parameters
class SwingParameters:
    """Which part of the swing to wait for."""

    fraction: float = parameter(
        0.5, unit="1", meaning="share of the swing after which the next plan begins", minimum=0.0, maximum=1.0
    )


@leaf
class WaitForSwing(Leaf):
    """Waits until the first step of the plan is halfway through its swing, or has landed early."""

    Parameters = SwingParameters
    plan = Input(FootstepPlan, "the footsteps that were sent")

    def tick(self) -> Status:
        """SUCCESS at the share of the swing; FAILURE where the robot stands instead."""
        status = self.context.robot.status()
        first = self.plan.steps[0].sequence_id
        step = status.current_step
        if step is None or status.phase is WalkingPhase.STANDING:
            if self.context.time > self._sent_at + self._patience:
                return self.failed("the robot stands although steps were sent")
            return self.running("waits for the step to begin")
        if step.sequence_id < first or (step.sequence_id == first and status.phase is WalkingPhase.TRANSFER):
            return self.running("waits for the swing to begin")
        share = status.phase_elapsed / max(status.phase_duration, 1e-9)
        if step.sequence_id == first and share < self.parameters.fraction:
            return self.running("waits for half of the swing")
        return self.succeeded()

    def start(self) -> None:
        """Note when the steps were sent, and how long the robot may take to begin."""
        self._sent_at = self.context.time
        self._patience = 2.0 * self.plan.steps[0].transfer_duration + 0.1


@leaf
class WaitUntilStanding(Leaf):
    """Waits until the robot stands on both feet with no step left."""

    def tick(self) -> Status:
        """SUCCESS when it stands."""
        status = self.context.robot.status()
        if status.phase is WalkingPhase.STANDING and not status.queue:
            return self.succeeded()
        return self.running("waits until the robot stands")


@leaf
class PauseWalking(Leaf):
    """Lets the robot finish its step and stand; queued steps are dropped."""

    def tick(self) -> Status:
        """SUCCESS at once."""
        self.context.robot.pause_walking()
        return self.succeeded()
