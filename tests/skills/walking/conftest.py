from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
import pytest
from perfect_body import PerfectBody

from skills.footsteps.footstep import Footstep, Side, Stance
from skills.geometry.pose import Array, Pose
from skills.walking import RobotModel, Walker, WalkerParameters
from skills.walking.quadratic_program import MakeSolver

MJCF = Path(__file__).parents[3] / "sim_envs" / "robot" / "atlas_class.xml"
WIDTH = 0.24


@pytest.fixture(scope="session")
def model() -> RobotModel:
    return RobotModel(MJCF)


@pytest.fixture
def stance() -> Stance:
    return Stance(Pose.from_xyz_rpy((0.0, WIDTH / 2, 0.0)), Pose.from_xyz_rpy((0.0, -WIDTH / 2, 0.0)))


@pytest.fixture
def make_step(model: RobotModel) -> Callable[..., Footstep]:
    def make(
        sequence_id: int,
        side: Side,
        pose: Pose,
        timing: tuple[float, float] = (0.8, 0.3),
        waypoints: Sequence[Sequence[float]] = (),
    ) -> Footstep:
        points = np.asarray(waypoints, dtype=float).reshape(-1, 3)
        return Footstep(sequence_id, side, pose, model.foothold_sole, *timing, 0.1, points)

    return make


@pytest.fixture
def make_steps(make_step: Callable[..., Footstep]) -> Callable[..., tuple[Footstep, ...]]:
    """Steps along an arc, the last beside the one before it."""

    def make(
        count: int,
        *,
        length: float = 0.3,
        turn: float = 0.0,
        timing: tuple[float, float] = (0.8, 0.3),
        height: Callable[[int], float] = lambda i: 0.0,
        tilt: Callable[[int], tuple[float, float]] = lambda i: (0.0, 0.0),
        first: Side = Side.LEFT,
        first_id: int = 0,
        start: tuple[float, float, float] = (0.0, 0.0, 0.0),
    ) -> tuple[Footstep, ...]:
        x, y, yaw = start
        side, steps = first, []
        for i in range(count):
            yaw += turn
            if i + 1 < count:
                x, y = x + length * np.cos(yaw), y + length * np.sin(yaw)
            offset = 0.5 * WIDTH * side.sign
            pose = Pose.from_xyz_rpy((x - offset * np.sin(yaw), y + offset * np.cos(yaw), height(i)), (*tilt(i), yaw))
            steps.append(make_step(first_id + i, side, pose, timing))
            side = side.opposite
        return tuple(steps)

    return make


@pytest.fixture
def make_body(model: RobotModel, stance: Stance) -> Callable[..., PerfectBody]:
    """A walking robot that moves as it commands, on level ground unless told otherwise."""

    def make(
        ground: Callable[[Array], Array] = lambda points: np.zeros(len(points)),
        make_solver: MakeSolver | None = None,
    ) -> PerfectBody:
        return PerfectBody(model, Walker(model, stance, WalkerParameters(), make_solver), ground)

    return make
