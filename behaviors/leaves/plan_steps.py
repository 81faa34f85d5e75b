"""Plan the next footsteps toward the sub-goal, from the stance that the robot is about to have."""

from __future__ import annotations

import dataclasses

from py_trees.common import Status

from behaviors.leaf import Call, SkillLeaf, SkillParameters
from behaviors.leaves.vain_attempts import VainAttempts
from behaviors.ports import Input, Output
from behaviors.registry import leaf
from skills.body_path import SubGoal
from skills.footsteps import FootstepPlan, PlanRequest, plan_on_request
from skills.parameters import parameter, parameters
from skills.regions import PlanarRegions
from skills.walking import WalkingPhase, WalkingStatus


@parameters
class PlanFootstepsParameters(SkillParameters):
    """How long a plan may take."""

    latency: float = parameter(0.2, unit="s", meaning="robot time until a plan is delivered", minimum=0.0, maximum=60.0)
    search_time: float = parameter(
        0.1, unit="s", meaning="time after which a search in realtime ends with the best so far", minimum=0.001
    )
    longer: float = parameter(
        0.5,
        unit="1",
        meaning="share by which an attempt in vain lengthens the next, of a standing robot",
        minimum=0.0,
    )
    longest: float = parameter(3.0, unit="1", meaning="how many times longer at most", minimum=1.0, maximum=100.0)


@leaf
class PlanFootsteps(SkillLeaf):
    """Plans at least three steps by A* over the regions; partial plans count, no step at all is a failure."""

    Parameters = PlanFootstepsParameters
    parameters: PlanFootstepsParameters
    ground = Input(PlanarRegions, "planar regions around the robot")
    sub_goal = Input(SubGoal, "where the next steps should lead")
    plan = Output(FootstepPlan, "the next footsteps")
    vain = Output(VainAttempts, "attempts in a row that found no step; nothing after a plan")

    def request(self) -> Call | Status:
        """From the imminent stance with the other foot first; with either foot when the robot stands.

        A standing robot has time: after each attempt in vain it searches longer.
        """
        status, parameters = self.context.robot.status(), self.parameters
        standing = status.phase is WalkingPhase.STANDING or status.last_side is None
        tried = self.vain.count if self.vain is not None and standing else 0
        longer = min(1.0 + parameters.longer * tried, parameters.longest)
        footsteps = self.context.parameters["footsteps"]
        request = PlanRequest(
            ground=self.ground,
            sub_goal=self.sub_goal,
            stance=status.imminent_stance,
            first_side=None if standing or status.last_side is None else status.last_side.opposite,
            plan_id=self.context.new_id("plan"),
            first_sequence_id=status.last_sequence_id + 1,
            reference=None if standing else self._not_begun(status),
            footsteps=dataclasses.replace(footsteps, max_expansions=round(longer * footsteps.max_expansions)),
            terrain=self.context.parameters["terrain"],
        )
        x, y, _ = self.sub_goal.path.waypoints_world[-1].tolist()
        self._goal = (x, y)
        alarm = self.context.executor.alarm(longer * parameters.search_time)
        timed = () if alarm is None else (alarm,)
        budget = longer * parameters.latency
        return self.call(plan_on_request, request, *timed, budget=budget, deadline=self._deadline(status))

    def receive(self, result: FootstepPlan) -> Status:
        """Hand an executable plan on."""
        if not result.steps:
            self.vain = VainAttempts.after(self.vain, self._goal, result.reason)
            return self.failed(result.reason)
        self.plan, self.vain = result, None
        return self.succeeded(result.reason)

    def _deadline(self, status: WalkingStatus) -> float | None:
        """When the foot in the air lands: a later plan may find the robot waiting for it."""
        if status.phase is not WalkingPhase.SWING:
            return None
        return self.context.time + status.phase_duration - status.phase_elapsed

    def _not_begun(self, status: WalkingStatus) -> FootstepPlan | None:
        """The last plan without the steps that have begun."""
        if self.plan is None:
            return None
        steps = tuple(step for step in self.plan.steps if step.sequence_id > status.last_sequence_id)
        return dataclasses.replace(self.plan, steps=steps) if steps else None
