"""Small courses and walks for the tests of worlds."""

import numpy as np

from sim_envs.courses import Box, Course
from sim_envs.sensors import DepthCameraParameters
from sim_envs.worlds import SimulatedWorld, WorldKind
from skills.footsteps.footstep import Footstep, Side
from skills.geometry.pose import Pose

SMALL_CAMERA = DepthCameraParameters(resolution=0.125)
SOLE = 0.5 * np.array([[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]]) * (0.26, 0.138)


def slab(x_end=4.0, name="slab"):
    """A box from x = -1 to x_end with its top at z = 0."""
    return Box(name, (x_end + 1.0, 2.0, 0.2), Pose.from_xyz_rpy(((x_end - 1.0) / 2, 0.0, -0.1)), "pad")


def course(*boxes, events=(), start=(0.0, 0.0, 0.0)):
    return Course("small", boxes or (slab(),), start, (3.0, 0.0, 0.0), tuple(events))


def world(*boxes, **options):
    events, start = options.pop("events", ()), options.pop("start", (0.0, 0.0, 0.0))
    options.setdefault("camera", SMALL_CAMERA)
    kind = options.pop("kind", WorldKind.KINEMATIC)
    return SimulatedWorld(course(*boxes, events=events, start=start), kind, **options)


def steps(count, length=0.3, first=Side.LEFT, height=0.0):
    """Level steps straight ahead from the start, left and right in turn, the last one beside the one before."""
    made, side, x = [], first, 0.0
    for i in range(count):
        x += length if i < count - 1 else 0.0
        pose = Pose.from_xyz_rpy((x, 0.12 * side.sign, height))
        made.append(Footstep(i, side, pose, SOLE, 0.6, 0.2, 0.1, np.zeros((0, 3))))
        side = side.opposite
    return tuple(made)
