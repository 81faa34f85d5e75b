"""The operator's checkpoints: nothing goes on before a person has approved it."""

from __future__ import annotations

from typing import Any, ClassVar

from py_trees.common import Status

from behaviors.halt import HaltCause
from behaviors.leaf import Leaf
from behaviors.operator import Approve, Reject, ReviewRequest
from behaviors.ports import Input
from behaviors.registry import leaf
from skills.body_path import BodyPath
from skills.footsteps import FootstepPlan


class Review(Leaf):
    """Waits until the operator approves a thing; fails when it is rejected, so that another is made.

    It lets the robot stand meanwhile, so that what is approved still begins where the robot is. An approval names what
    it approves, so that a late one approves nothing else. Whoever wants no review switches the checkpoint off, also
    while it waits.

    Attributes:
        checkpoint: its name, that of the parameter in `review` which switches it.
        thing: what it is called.
    """

    checkpoint: ClassVar[str]
    thing: ClassVar[str]

    def item(self) -> tuple[Any, int]:
        """What is to be approved, and its id."""
        raise NotImplementedError

    def start(self) -> None:
        """Note when it is asked."""
        self._since = self.context.time
        self._asked = False

    def tick(self) -> Status:
        """SUCCESS when approved, or where nobody wants to be asked."""
        item, item_id = self.item()
        for event in self.context.operator_events:
            if isinstance(event, Approve | Reject) and event.checkpoint == self.checkpoint and self._asked:
                if event.item_id != item_id:
                    self.log(f"{event.name} {event.item_id} comes too late: {self.thing} {item_id} waits for approval")
                elif isinstance(event, Approve):
                    return self.succeeded(f"{self.thing} {item_id} is approved")
                else:
                    return self.failed(f"{self.thing} {item_id} is rejected by the operator")
        if not getattr(self.context.parameters["review"], self.checkpoint):
            return self.succeeded("goes on without review")
        if not self._asked:
            self._asked = True
            self.context.robot.hold()
            self.log(f"{self.thing} {item_id} waits for approval")
        self.context.reviews.append(ReviewRequest(self.checkpoint, item_id, item, self.node_path, self._since))
        return self.halted(HaltCause.REVIEW, f"waits for approval of {self.thing} {item_id}")


@leaf
class ReviewBodyPath(Review):
    """Waits until the operator approves the body path; fails when it is rejected, so that another is planned."""

    checkpoint = "body_path"
    thing = "body path"
    path = Input(BodyPath, "the way to be approved", when_missing=Status.FAILURE)

    def item(self) -> tuple[Any, int]:
        """The path."""
        return self.path, self.path.path_id


@leaf
class ReviewFootsteps(Review):
    """Waits until the operator approves the plan; fails when it is rejected, so that another is made."""

    checkpoint = "footsteps"
    thing = "plan"
    plan = Input(FootstepPlan, "the footsteps to be approved", when_missing=Status.FAILURE)

    def item(self) -> tuple[Any, int]:
        """The plan."""
        return self.plan, self.plan.plan_id
