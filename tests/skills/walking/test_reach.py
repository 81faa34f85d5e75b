from collections.abc import Callable
from itertools import product
from math import hypot, radians

import pytest

from skills.footsteps.footstep import Footstep, Side, Stance
from skills.geometry.pose import Pose
from skills.walking import KinematicWalker, RobotModel, WalkingParameters, WalkingPhase

Maker = Callable[..., Footstep]
HEIGHTS = (-0.26, -0.1, 0.12, 0.26)
NOSE_UP = (0.0, -20.0)
TILTS = ((0.0, 0.0), (20.0, 0.0), (-20.0, 0.0), (0.0, 20.0), NOSE_UP)


def failure_of_step(
    model: RobotModel, stance: Stance, make_step: Maker, x: float, y: float, z: float, tilt_deg: tuple[float, float]
) -> str:
    """Why a step from a level stance and the step that brings the other foot beside it failed; empty where not."""
    roll, pitch = (radians(angle) for angle in tilt_deg)
    walker = KinematicWalker(model, WalkingParameters(), stance)
    there = Pose.from_xyz_rpy((x, y - 0.12, z), (roll, pitch, 0.0))
    beside = Pose.from_xyz_rpy((x, y - 0.36, z), (0.0, 0.0, 0.0))
    walker.send((make_step(0, Side.LEFT, there), make_step(1, Side.RIGHT, beside)))
    while walker.status().phase not in (WalkingPhase.STANDING, WalkingPhase.FALLEN):
        walker.advance(0.01)
    return walker.status().failure


@pytest.mark.parametrize(
    ("x", "z", "tilt_deg"),
    (
        (0.52, 0.0, (20.0, 0.0)),
        (0.52, 0.0, (0.0, -20.0)),
        (0.45, 0.26, (0.0, 0.0)),
        (0.42, -0.26, (0.0, 20.0)),
    ),
)
def test_the_legs_reach_the_longest_steps(
    model: RobotModel, stance: Stance, make_step: Maker, x: float, z: float, tilt_deg: tuple[float, float]
) -> None:
    assert failure_of_step(model, stance, make_step, x, 0.24, z, tilt_deg) == ""


@pytest.mark.sweep
def test_the_legs_reach_every_step_within_the_limits(model: RobotModel, stance: Stance, make_step: Maker) -> None:
    failures = []
    for x, y, z, tilt in product((-0.12, 0.0, 0.26, 0.42, 0.52), (0.18, 0.24, 0.4), HEIGHTS, TILTS):
        reach = 0.52 if -0.1 <= z <= 0.12 else 0.42
        # Ankle and knee cannot have a foot nose-up on the lowest ground, nor on the highest beside or behind the other.
        folded = tilt == NOSE_UP and (z < -0.2 or (z > 0.2 and x <= 0.0))
        if hypot(x, y - 0.24) <= reach and not folded:
            failure = failure_of_step(model, stance, make_step, x, y, z, tilt)
            if failure:
                failures.append((x, y, z, tilt, failure))
    assert failures == []
