"""Walks whose footsteps are known beforehand: a course, and the steps over it.

What the steps say and what the course is may differ by errors that the robot does not know. Courses of blocks have one
block a step, in two columns; blocks neither touch nor leave room beside them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from sim_envs.courses import Box, Course
from skills.footsteps import FootstepParameters
from skills.footsteps.footstep import Footstep, Side
from skills.geometry.pose import Array, Pose, rotation_x, rotation_y, rotation_z

STANCE_WIDTH = 0.24
_BLOCK = (0.40, 0.235, 0.30)  # [m]
_SEAM = 0.005  # between pads and blocks [m]
_LEAD = 0.38  # at least this far from the feet on a pad to the middle of the next block [m]
_PAD = (1.2, 1.2, 0.2)  # [m]
_CLEARANCE = 0.10  # of a swing over the higher end of its way [m]
_CORNERS = np.array([[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]])
_SOLE = 0.5 * _CORNERS * (0.26, 0.138)
# Where else a sole's centre may land, as the planner tells it: level ground, a whole block, or nowhere.
_ANYWHERE = FootstepParameters().landing_move * _CORNERS
_ON_BLOCK = _CORNERS * (0.5 * np.array(_BLOCK[:2]) - _SOLE[0] - FootstepParameters().landing_margin)
_NOWHERE_ELSE = np.zeros((0, 2))


@dataclass(frozen=True, slots=True)
class Cadence:
    """How fast and how far the robot steps.

    Attributes:
        length: way from foot to foot [m].
        swing, transfer: time in the air, and in double support before it [s].
    """

    length: float
    swing: float
    transfer: float

    @property
    def speed(self) -> float:
        """Nominal speed [m/s]."""
        return self.length / (self.swing + self.transfer)


@dataclass(frozen=True, slots=True)
class GroundErrors:
    """How far ground may be from what the steps say, each uniform and to both sides.

    Attributes:
        height: of a block [m].
        tilt: of a block about both axes [rad].
    """

    height: float = 0.0
    tilt: float = 0.0


@dataclass(frozen=True, slots=True, eq=False)
class KnownWalk:
    """A course and the footsteps over it, the last of which puts the feet beside each other."""

    course: Course
    steps: tuple[Footstep, ...]

    @property
    def duration(self) -> float:
        """Nominal time of all steps [s]."""
        return sum(step.swing_duration + step.transfer_duration for step in self.steps)


def flat_walk(count: int, cadence: Cadence, rng: np.random.Generator, *, turn: float = 0.0) -> KnownWalk:
    """Steps on level ground from a random foot, each turned to the left of the one before [rad]."""
    side, middle, yaw = _first_side(rng), np.zeros(3), 0.0
    steps = []
    for index in range(count):
        if index < count - 1:
            yaw += turn
            middle = middle + rotation_z(yaw) @ (cadence.length, 0.0, 0.0)
        p = middle + rotation_z(yaw) @ (0.0, 0.5 * STANCE_WIDTH * side.sign, 0.0)
        steps.append(_step(index, side, Pose(rotation_z(yaw), p), cadence, landing_region_sole=_ANYWHERE))
        side = side.opposite
    goal = (float(middle[0]), float(middle[1]), yaw)
    extent = 2.0 * (count * cadence.length + 2.0)
    ground = Box("ground", (extent, extent, _PAD[2]), Pose.from_xyz_rpy((0.0, 0.0, -0.5 * _PAD[2])), "pad")
    return KnownWalk(Course("flat", (ground,), (0.0, 0.0, 0.0), goal), tuple(steps))


def block_walk(
    count: int,
    cadence: Cadence,
    rng: np.random.Generator,
    *,
    levels: Sequence[float],
    tilt: float = 0.0,
    errors: GroundErrors | None = None,
) -> KnownWalk:
    """Steps over one block each, at random levels and tilted to a random side; the last two end on a pad.

    Args:
        count: of steps.
        cadence: of all steps.
        rng: of all that is random.
        levels: heights of which each block has one [m].
        tilt: of each block, about one of its axes [rad].
        errors: of the blocks, which the steps do not know.
    """
    errors = errors or GroundErrors()
    side, steps, blocks = _first_side(rng), [], []
    clearance = _CLEARANCE + 0.5 * _BLOCK[0] * np.tan(tilt)
    for index in range(count - 2):
        p = np.array((_place(index, cadence), 0.5 * STANCE_WIDTH * side.sign, rng.choice(levels)))
        about = (rotation_x, rotation_y)[rng.integers(2)]
        T_world_sole = Pose(about(rng.choice((-1.0, 1.0)) * tilt), p)
        T_sole_top = Pose(
            rotation_x(rng.uniform(-1.0, 1.0) * errors.tilt) @ rotation_y(rng.uniform(-1.0, 1.0) * errors.tilt),
            np.array((0.0, 0.0, rng.uniform(-1.0, 1.0) * errors.height)),
        )
        blocks.append(_block(index, T_world_sole @ T_sole_top, _BLOCK))
        steps.append(_step(index, side, T_world_sole, cadence, clearance, landing_region_sole=_ON_BLOCK))
        side = side.opposite
    return _with_pads("blocks", blocks, steps, side, cadence, clearance)


def ridge_walk(count: int, cadence: Cadence, rng: np.random.Generator, *, share: float) -> KnownWalk:
    """Steps onto ridges that leave a share of the sole, along or across it; the last two end on a pad."""
    length, width = 2.0 * _SOLE[0]
    side, steps, blocks = _first_side(rng), [], []
    for index in range(count - 2):
        size = (share * length, width) if rng.integers(2) else (length, share * width)
        T_world_sole = Pose.from_xyz_rpy((_place(index, cadence), 0.5 * STANCE_WIDTH * side.sign, 0.0))
        foothold = _SOLE * size / (length, width)
        # A ridge goes on where the sole does not end on it.
        along, across = (_BLOCK[i] if size[i] == (length, width)[i] else size[i] for i in range(2))
        blocks.append(_block(index, T_world_sole, (along, across, _BLOCK[2])))
        steps.append(_step(index, side, T_world_sole, cadence, foothold_sole=foothold))
        side = side.opposite
    return _with_pads("ridges", blocks, steps, side, cadence, _CLEARANCE)


def _with_pads(
    name: str, blocks: list[Box], steps: list[Footstep], side: Side, cadence: Cadence, clearance: float
) -> KnownWalk:
    """Put a pad before and behind blocks, and two steps onto the second one."""
    last = _place(len(blocks) - 1, cadence)
    end = last + max(cadence.length, _LEAD)
    for index in range(len(steps), len(steps) + 2):
        T_world_sole = Pose.from_xyz_rpy((end, 0.5 * STANCE_WIDTH * side.sign, 0.0))
        steps.append(_step(index, side, T_world_sole, cadence, clearance))
        side = side.opposite
    start = _place(0, cadence) - 0.5 * _BLOCK[0] - _SEAM
    goal = last + 0.5 * _BLOCK[0] + _SEAM
    pads = (_pad("start", start - 0.5 * _PAD[0]), _pad("goal", goal + 0.5 * _PAD[0]))
    return KnownWalk(Course(name, (*pads, *blocks), (0.0, 0.0, 0.0), (end, 0.0, 0.0)), tuple(steps))


def _place(index: int, cadence: Cadence) -> float:
    """Where along the course the middle of a block lies [m]."""
    return max(cadence.length, _LEAD) + index * cadence.length


def _first_side(rng: np.random.Generator) -> Side:
    return Side.LEFT if rng.integers(2) else Side.RIGHT


def _step(
    index: int,
    side: Side,
    T_world_sole: Pose,
    cadence: Cadence,
    clearance: float = _CLEARANCE,
    foothold_sole: Array = _SOLE,
    landing_region_sole: Array = _NOWHERE_ELSE,
) -> Footstep:
    return Footstep(
        sequence_id=index,
        side=side,
        T_world_sole=T_world_sole,
        foothold_sole=foothold_sole,
        swing_duration=cadence.swing,
        transfer_duration=cadence.transfer,
        swing_height=clearance,
        swing_waypoints_world=np.zeros((0, 3)),
        landing_region_sole=landing_region_sole,
    )


def _block(index: int, T_world_top: Pose, size: tuple[float, float, float]) -> Box:
    return Box(f"block_{index}", size, T_world_top @ Pose.from_xyz_rpy((0.0, 0.0, -0.5 * size[2])), "block")


def _pad(name: str, x: float) -> Box:
    return Box(name, _PAD, Pose.from_xyz_rpy((x, 0.0, -0.5 * _PAD[2])), "pad")
