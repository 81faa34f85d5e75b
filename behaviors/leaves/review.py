"""The operator's checkpoint: nothing goes on before a person has approved it."""

from __future__ import annotations

from py_trees.common import Status

from behaviors.leaf import Leaf
from behaviors.operator import Approve, Reject
from behaviors.ports import Input
from behaviors.registry import leaf
from skills.footsteps import FootstepPlan
from skills.parameters import parameter, parameters


@parameters
class ReviewPlanParameters:
    """Whether to wait."""

    automatic: bool = parameter(False, unit="1", meaning="go on without asking")


@leaf
class ReviewPlan(Leaf):
    """Waits until the operator approves the plan; fails when it is rejected, so that another is made.

    An approval names the plan that it approves, so that a late one approves nothing else: the events are "approve" and
    "reject" with the plan's id. Whoever wants no review sets `automatic`, also while it waits.
    """

    Parameters = ReviewPlanParameters
    parameters: ReviewPlanParameters
    plan = Input(FootstepPlan, "the footsteps to be approved")

    def tick(self) -> Status:
        """SUCCESS when approved, or where nobody wants to be asked."""
        plan_id = self.plan.plan_id
        for event in self.context.operator_events:
            if event == Approve("footsteps", plan_id):
                return self.succeeded(f"plan {plan_id} is approved")
            if event == Reject("footsteps", plan_id):
                return self.failed(f"plan {plan_id} is rejected by the operator")
        if self.parameters.automatic:
            return self.succeeded("goes on without review")
        return self.running(f"waits for approval of plan {plan_id}")
