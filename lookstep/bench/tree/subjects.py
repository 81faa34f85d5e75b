"""The tree that is measured, twice: as a tree file of ours, and as py_trees has it.

Six branches of a reactive sequence, each a fallback whose first way fails and whose second is a sequence of leaves,
an inverter and a parallel; all 60 nodes are visited at every tick. Two leaves of each branch read one key and write
another. The plain tree has the same shape and no ports.
"""

from __future__ import annotations

import numpy as np
import py_trees
from py_trees.common import ParallelPolicy, Status

from behaviors import Input, Leaf, Output, Registry, Trace, Tree, parse_tree
from skills.footsteps.footstep import Footstep, Stance
from skills.geometry.pose import Pose
from skills.walking.walking_state import RobotState, StepEvent, WalkingPhase, WalkingStatus

BRANCHES = 6
NODES = 60

registry = Registry()


@registry
class Yes(Leaf):
    """Succeeds."""

    def tick(self) -> Status:
        """SUCCESS."""
        return Status.SUCCESS


@registry
class No(Leaf):
    """Fails."""

    ends_with = (Status.FAILURE,)

    def tick(self) -> Status:
        """FAILURE."""
        return Status.FAILURE


@registry
class Begin(Leaf):
    """Gives the number of the tick."""

    number = Output(float, "a number that changes with every tick")

    def tick(self) -> Status:
        """SUCCESS with the number."""
        self.number = float(self.context.tick)
        return Status.SUCCESS


@registry
class AddOne(Leaf):
    """Gives a number one larger than the one it takes."""

    number = Input(float, "a number")
    sum = Output(float, "a larger number")

    def tick(self) -> Status:
        """SUCCESS with the sum."""
        self.sum = self.number + 1.0
        return Status.SUCCESS


@registry
class GoOn(Leaf):
    """Runs for ever."""

    def tick(self) -> Status:
        """RUNNING."""
        return Status.RUNNING


def tree_text() -> str:
    """The tree file."""
    branch = """
    - reactive_selector:
        - No
        - reactive_sequence:
            - AddOne: {{in: {{number: {key}}}, out: {{sum: {key}_more}}}}
            - inverter: No
            - reactive_parallel:
                - AddOne: {{in: {{number: {key}_more}}, out: {{sum: {next}}}}}
                - Yes"""
    branches = "".join(branch.format(key=f"n{index}", next=f"n{index + 1}") for index in range(BRANCHES))
    ends = "\n    - Yes" * 3
    return (
        f"tree: bench\nroot:\n  reactive_sequence:\n    - Begin: {{out: {{number: n0}}}}{branches}{ends}\n    - GoOn\n"
    )


def our_tree(trace: Trace | None = None) -> tuple[Tree, StandingRobot]:
    """Our tree, on a robot that stands."""
    robot = StandingRobot()
    return Tree(parse_tree(tree_text(), registry), robot, trace=trace), robot


class _Says(py_trees.behaviour.Behaviour):
    def __init__(self, status: Status) -> None:
        super().__init__("leaf")
        self._says = status

    def update(self) -> Status:
        return self._says


def plain_tree() -> py_trees.behaviour.Behaviour:
    """The same shape in plain py_trees."""
    yes, no = Status.SUCCESS, Status.FAILURE

    def branch() -> py_trees.behaviour.Behaviour:
        parallel = py_trees.composites.Parallel(
            "parallel", ParallelPolicy.SuccessOnAll(synchronise=False), [_Says(yes), _Says(yes)]
        )
        inverter = py_trees.decorators.Inverter("inverter", _Says(no))
        sequence = py_trees.composites.Sequence("sequence", False, [_Says(yes), inverter, parallel])
        return py_trees.composites.Selector("selector", False, [_Says(no), sequence])

    ends = [_Says(yes), _Says(yes), _Says(yes), _Says(Status.RUNNING)]
    return py_trees.composites.Sequence("bench", False, [_Says(yes), *(branch() for _ in range(BRANCHES)), *ends])


class StandingRobot:
    """A robot that does nothing, with a new estimate of its state at every time."""

    def __init__(self) -> None:
        self.time = 0.0
        self._stance = Stance(Pose.from_xyz_rpy((0.0, 0.1, 0.0)), Pose.from_xyz_rpy((0.0, -0.1, 0.0)))
        self._pose = Pose.identity()
        self._status = WalkingStatus(WalkingPhase.STANDING, 0.0, 0.0, None, (), self._stance, None, False)

    def state(self) -> RobotState:
        """An estimate of its own."""
        joints = np.full(23, self.time)
        return RobotState(self.time, self._pose, joints, joints, self._stance, np.zeros(3), np.zeros(3))

    def status(self) -> WalkingStatus:
        """Standing."""
        return self._status

    def depth_frames(self) -> dict[str, int]:
        """None."""
        return {}

    def depth_image(self, camera: str) -> None:
        """Nothing."""

    def lidar_scan(self) -> None:
        """Nothing."""

    def send_footsteps(self, steps: tuple[Footstep, ...]) -> None:
        """Take no notice."""

    def pause_walking(self) -> None:
        """Stand."""

    def drain_events(self) -> tuple[StepEvent, ...]:
        """None."""
        return ()

    def drain_log(self) -> tuple[()]:
        """None."""
        return ()
