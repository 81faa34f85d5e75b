"""The robot as a table: which MJCF file describes its body, how large its soles are, where its eyes sit.

The figures of the body itself (masses, limits, efforts) live in the MJCF file alone, which MuJoCo and pinocchio both
read.
"""

from pathlib import Path

import numpy as np

from skills.geometry.camera import looking
from skills.geometry.pose import Pose, rotation_y
from skills.parameters import parameter, parameters

SHIPPED_ROBOTS = Path(__file__).parent


@parameters
class CameraMount:
    """Where a depth camera sits and looks."""

    name: str = parameter("front", unit="1", meaning="name of the camera")
    body: str = parameter("torso", unit="1", meaning="body that carries it")
    position: tuple[float, float, float] = parameter(
        (0.14, 0.0, 0.03), unit="m", meaning="optical centre in that body's frame", minimum=-2.0, maximum=2.0
    )
    yaw_deg: float = parameter(
        0.0, unit="deg", meaning="how far it looks to the left of the body's x axis", minimum=-180.0, maximum=180.0
    )
    pitch_deg: float = parameter(
        47.0, unit="deg", meaning="how far it looks below the horizon", minimum=0.0, maximum=90.0
    )

    @property
    def T_body_camera(self) -> Pose:
        """The camera (x right, y down, z forward) in the body that carries it."""
        return looking(self.position, pitch=np.deg2rad(self.pitch_deg), yaw=np.deg2rad(self.yaw_deg))


@parameters
class RobotDescription:
    """What the simulation must know of a biped beside its MJCF file."""

    mjcf: str = parameter(
        "atlas_class.xml",
        unit="1",
        meaning="MJCF file without a free joint: a name among the shipped robots, or an absolute path",
    )
    sole_length: float = parameter(0.26, unit="m", meaning="sole along x", minimum=0.05, maximum=0.5)
    sole_width: float = parameter(0.138, unit="m", meaning="sole along y", minimum=0.03, maximum=0.3)
    torso_body: str = parameter("torso", unit="1", meaning="body that is kept upright")
    cameras: tuple[CameraMount, ...] = parameter(
        (CameraMount(),),
        unit="1",
        meaning="depth cameras: body, optical centre in its frame [m], view to the left and below the horizon [deg]",
    )
    lidar_body: str = parameter("torso", unit="1", meaning="body that carries the lidar")
    lidar_position: tuple[float, float, float] = parameter(
        (0.16, 0.0, 0.8), unit="m", meaning="centre of its rays in that body's frame", minimum=-2.0, maximum=2.0
    )
    lidar_pitch_deg: float = parameter(
        25.0,
        unit="deg",
        meaning="how far the lidar's forward axis looks below the horizon",
        minimum=-90.0,
        maximum=90.0,
    )

    @property
    def mjcf_path(self) -> Path:
        """Where the MJCF file is; both MuJoCo and pinocchio load it by name."""
        return SHIPPED_ROBOTS / self.mjcf

    @property
    def T_body_lidar(self) -> Pose:
        """Lidar (x forward, y left, z up) in the body that carries it."""
        return Pose(rotation_y(np.deg2rad(self.lidar_pitch_deg)), np.array(self.lidar_position))

    @property
    def sole_corners_sole(self) -> np.ndarray:
        """Corners of the sole in its own plane, (4, 2) counter-clockwise from the front left [m]."""
        signs = np.array([[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]])
        return 0.5 * signs * (self.sole_length, self.sole_width)
