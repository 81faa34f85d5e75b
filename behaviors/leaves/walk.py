"""Command the walking controller, and wait for it."""

from __future__ import annotations

import numpy as np
from py_trees.common import Status

from behaviors.leaf import Leaf
from behaviors.ports import Input
from behaviors.registry import leaf
from skills.footsteps import FootstepPlan
from skills.parameters import parameter, parameters
from skills.walking import WalkingPhase, WalkingStatus


@parameters
class SendFootstepsParameters:
    """When a plan no longer fits the steps that began while it was made."""

    tolerance: float = parameter(
        0.05, unit="m", meaning="distance of a step that began from its place in the plan", minimum=0.0, maximum=1.0
    )


@leaf
class SendFootsteps(Leaf):
    """Sends a plan to the robot in place of all steps that have not begun."""

    Parameters = SendFootstepsParameters
    parameters: SendFootstepsParameters
    plan = Input(FootstepPlan, "the next footsteps", when_missing=Status.FAILURE)

    def tick(self) -> Status:
        """SUCCESS once the steps are queued; steps that began while the plan was made are left out."""
        status = self.context.robot.status()
        if status.unable:
            return self.failed(status.unable)
        begun = status.last_sequence_id
        if status.current_step is not None and status.phase is WalkingPhase.TRANSFER:
            # Its foot is still on the ground: a newer step may take its place.
            begun -= 1
        steps = tuple(step for step in self.plan.steps if step.sequence_id > begun)
        if not steps:
            return self.failed("all planned steps have begun while they were planned")
        elsewhere = self._elsewhere(status, begun)
        if elsewhere > self.parameters.tolerance:
            return self.failed(f"step {begun} began {elsewhere:.2f} m from its place in the plan")
        self.context.robot.send_footsteps(steps)
        return self.succeeded(f"sent {len(steps)} steps")

    def _elsewhere(self, status: WalkingStatus, begun: int) -> float:
        """How far the last step that began lands from where the plan has it; 0 where it has it not [m]."""
        planned = next((step for step in self.plan.steps if step.sequence_id == begun), None)
        if planned is None:
            return 0.0
        return float(np.linalg.norm(status.imminent_stance.sole(planned.side).p - planned.T_world_sole.p))


@parameters
class QueueParameters:
    """How many steps may be left to make."""

    most: int = parameter(3, unit="1", meaning="incomplete footsteps with which a plan is made", minimum=0, maximum=100)


@leaf
class WaitForQueue(Leaf):
    """Waits until no more than so many of the footsteps that were sent are incomplete."""

    Parameters = QueueParameters
    ends_with = (Status.SUCCESS,)
    parameters: QueueParameters

    def tick(self) -> Status:
        """SUCCESS when few enough are left."""
        status, most = self.context.robot.status(), self.parameters.most
        left = len(status.queue) + (status.current_step is not None)
        if left > most:
            return self.running(f"{left} footsteps are incomplete, limit {most}")
        return self.succeeded()


@parameters
class SwingParameters:
    """Which part of the swing to wait for, and for how long in vain."""

    fraction: float = parameter(
        0.5, unit="1", meaning="share of the swing after which the next plan begins", minimum=0.0, maximum=1.0
    )
    patience: float = parameter(
        1.5, unit="s", meaning="time that the robot may stand before the step begins", minimum=0.0, maximum=60.0
    )


@leaf
class WaitForSwing(Leaf):
    """Waits until a share of the swing of the plan's first step is over, or the step has landed early."""

    Parameters = SwingParameters
    parameters: SwingParameters
    plan = Input(FootstepPlan, "the footsteps that were sent")

    def start(self) -> None:
        """Note when the steps were sent."""
        self._sent_at = self.context.time

    def tick(self) -> Status:
        """SUCCESS at the share of the swing; FAILURE where the robot stands instead, or has fallen."""
        status = self.context.robot.status()
        if status.unable:
            return self.failed(status.unable)
        first, step = self.plan.steps[0].sequence_id, status.current_step
        if status.last_sequence_id > first or (status.last_sequence_id == first and step is None):
            return self.succeeded("the step has landed")
        if step is None:
            if self.context.time > self._sent_at + self.parameters.patience:
                return self.failed("the robot stands although steps were sent")
            return self.running("waits for the step to begin")
        if step.sequence_id < first or status.phase is WalkingPhase.TRANSFER:
            return self.running("waits for the swing to begin")
        if status.phase_elapsed < self.parameters.fraction * status.phase_duration:
            return self.running(f"waits for {100 * self.parameters.fraction:.0f} % of the swing")
        return self.succeeded()


@leaf
class WaitUntilStanding(Leaf):
    """Waits until the robot stands on both feet with no step left."""

    ends_with = (Status.SUCCESS,)

    def tick(self) -> Status:
        """SUCCESS when it stands."""
        status = self.context.robot.status()
        if status.phase is WalkingPhase.STANDING and not status.queue:
            return self.succeeded()
        return self.running("waits until the robot stands")


@leaf
class PauseWalking(Leaf):
    """Lets the robot finish its step and stand; queued steps are dropped."""

    ends_with = (Status.SUCCESS,)

    def tick(self) -> Status:
        """SUCCESS at once."""
        self.context.robot.pause_walking()
        return self.succeeded()
