"""Scenes with known ground for the perception benchmark, and the cameras that look at them.

`scattered` is a field of boxes of all sizes and tilts on level ground; `contiguous` is the rough course, where blocks
touch and a loose tolerance chains across their seams. Each seed is another scene and another camera.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from sim_envs.courses import Box, Ground, load_course
from sim_envs.sensors import DEPTH_NOISE_PRESETS, DepthCameraParameters, DepthNoise
from skills.geometry.camera import PinholeCamera
from skills.geometry.pose import Pose, rotation_z

CAMERA = DepthCameraParameters().camera
TUNING_SEEDS = range(1000)
"""Scenes on which parameters may be chosen."""
HELD_OUT_SEEDS = range(1000, 2000)
"""Scenes that no parameter was chosen on; published figures come from these."""

NOISES: dict[str, DepthNoise] = {
    "none": DEPTH_NOISE_PRESETS["none"],
    "white_5mm": DepthNoise(white=0.005, white_per_metre=0.0, correlated=0.0, edge_loss=0.0),
    "standard": DepthNoise(),
    "correlated_4mm": DepthNoise(correlated=0.004),
}
"""Sensor noise by name."""

SCENES = ("scattered", "contiguous")

_GRID, _SPACING = (
    10,
    0.7,
)  # boxes of a scattered field stand on a grid of this many rows and columns, this far apart [m]
_SMALLEST, _LARGEST = (0.3, 0.2, 0.1), (1.0, 0.6, 0.3)
_TILT = np.deg2rad(15.0)
_HEIGHT = (0.9, 1.4)
_PITCH = np.deg2rad((35.0, 66.0))
_ROLL = np.deg2rad(5.0)
_COURSE_YAW = np.deg2rad(20.0)


@dataclass(frozen=True, slots=True, eq=False)
class Scene:
    """Boxes and a camera.

    Attributes:
        name, seed: which one it is.
        boxes: all there is to see.
        camera, T_world_camera: who looks.
    """

    name: str
    seed: int
    boxes: tuple[Box, ...]
    camera: PinholeCamera
    T_world_camera: Pose


def scene(name: str, seed: int, camera: PinholeCamera = CAMERA) -> Scene:
    """The scene of a name in `SCENES` and a seed; the same seed gives the same scene."""
    rng = np.random.default_rng((SCENES.index(name), seed))
    if name == "scattered":
        boxes = _scattered_boxes(rng)
        x, y = rng.uniform(-1.5, 1.5, 2)
        yaw = rng.uniform(-np.pi, np.pi)
    else:
        course = load_course("rough", seed=seed)
        boxes = course.boxes
        x, y = rng.uniform(course.start[0], course.goal[0] - 1.0), rng.uniform(-0.2, 0.2)
        yaw = rng.uniform(-_COURSE_YAW, _COURSE_YAW)
    z = Ground(boxes).ground_height(np.array([[x, y]]))[0] + rng.uniform(*_HEIGHT)
    pose = camera_pose((x, y, z), pitch=rng.uniform(*_PITCH), yaw=yaw, roll=rng.uniform(-_ROLL, _ROLL))
    return Scene(name, seed, boxes, camera, pose)


def camera_pose(xyz: tuple[float, float, float], *, pitch: float, yaw: float = 0.0, roll: float = 0.0) -> Pose:
    """T_world_camera of a camera that looks along yaw, pitch below the horizon, turned about its axis [m, rad]."""
    level = Pose.from_xyz_rpy(xyz, (0.0, pitch, yaw))
    R_forward_camera = np.array([[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]])
    return Pose(level.R @ R_forward_camera @ rotation_z(roll), level.p)


def _scattered_boxes(rng: np.random.Generator) -> tuple[Box, ...]:
    """A level slab and a hundred boxes that stand, lean or are half sunk in it."""
    half = 0.5 * _SPACING * (_GRID - 1)
    boxes = [Box("ground", (40.0, 40.0, 1.0), Pose(np.eye(3), np.array((0.0, 0.0, -0.5))), "pad")]
    for index in range(_GRID * _GRID):
        size = rng.uniform(_SMALLEST, _LARGEST)
        x, y = _SPACING * np.array(divmod(index, _GRID)) - half + rng.uniform(-0.15, 0.15, 2)
        rpy = (*rng.uniform(-_TILT, _TILT, 2), rng.uniform(-np.pi, np.pi))
        middle = 0.5 * size[2] * rng.uniform(0.4, 1.0)
        T_world_box = Pose.from_xyz_rpy((x, y, middle), rpy)
        boxes.append(Box(f"box_{index}", (float(size[0]), float(size[1]), float(size[2])), T_world_box, "block"))
    return tuple(boxes)
