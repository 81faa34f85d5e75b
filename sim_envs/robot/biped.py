"""The robot as a composer entity: its MJCF file, and the depth cameras and the lidar that its table mounts on it."""

from __future__ import annotations

from typing import Any

import numpy as np
from dm_control import composer, mjcf

from sim_envs.robot.robot_description import CameraMount, RobotDescription
from skills.footsteps.footstep import Side
from skills.geometry.pose import Pose, rotation_x
from skills.walking import RobotError

_CAMERA_HALF_SIZE = (0.045, 0.0125, 0.0125)
_CAMERA_BEHIND_LENS = 0.02
# The lidar is drawn as the lower part of its housing, which its lowest rays just miss, and the mast that carries it.
_LIDAR_RADIUS, _LIDAR_HALF_LENGTH, _LIDAR_BELOW = 0.04, 0.035, 0.08
_HOUSING_COLOR = (0.22, 0.24, 0.28, 1.0)


class Biped(composer.Entity):
    """A biped without a free joint; an arena adds one with `add_free_entity`.

    Raises:
        RobotError: where the MJCF file lacks what the simulation needs.
    """

    def _build(self, description: RobotDescription) -> None:
        self._description = description
        if not description.mjcf_path.is_file():
            raise RobotError(f"{description.mjcf_path}: there is no such MJCF file")
        self._mjcf_root = mjcf.from_path(str(description.mjcf_path))
        for side in Side:
            for kind in ("touch", "force", "torque"):
                self._need("sensor", f"{side.value}_{kind}")
            self._need("geom", f"{side.value}_foot_collision")
        names = [mount.name for mount in description.cameras]
        if not names or len(set(names)) < len(names):
            raise RobotError(f"cameras: got the names {names}, needs at least one, each once")
        self._camera_bodies = [self._add_camera(mount) for mount in description.cameras]
        self._add_lidar()

    def _add_camera(self, mount: CameraMount) -> Any:
        body = self._mount(f"camera {mount.name}", mount.body)
        T_body_camera = mount.T_body_camera
        # MuJoCo's cameras look along -z with y up.
        T_body_mujoco_camera = Pose(T_body_camera.R @ rotation_x(np.pi), T_body_camera.p)
        body.add("camera", name=mount.name, pos=T_body_camera.p, quat=T_body_mujoco_camera.quaternion_wxyz)
        # Behind the lens, where the camera does not see it.
        T_camera_housing = Pose(np.eye(3), np.array((0.0, 0.0, -_CAMERA_BEHIND_LENS)))
        name = f"{mount.name}_camera"
        _add_housing(body, name, T_body_camera @ T_camera_housing, "box", _CAMERA_HALF_SIZE)
        return body

    def _add_lidar(self) -> None:
        self._lidar_body = self._mount("lidar_body", self._description.lidar_body)
        T_lidar_housing = Pose(np.eye(3), np.array((0.0, 0.0, -_LIDAR_BELOW)))
        T_body_housing = self._description.T_body_lidar @ T_lidar_housing
        _add_housing(self._lidar_body, "lidar", T_body_housing, "cylinder", (_LIDAR_RADIUS, _LIDAR_HALF_LENGTH))

    def _mount(self, parameter: str, name: str) -> Any:
        body = self._mjcf_root.find("body", name)
        if body is None:
            bodies = ", ".join(found.name for found in self._mjcf_root.find_all("body"))
            raise RobotError(f"{parameter}: got {name!r}, the bodies of {self._description.mjcf} are {bodies}")
        return body

    def _need(self, kind: str, name: str) -> None:
        if self._mjcf_root.find(kind, name) is None:
            raise RobotError(f"{self._description.mjcf_path}: there is no {kind} {name!r}")

    @property
    def mjcf_model(self) -> mjcf.RootElement:
        """The robot's own MJCF tree."""
        return self._mjcf_root

    @property
    def description(self) -> RobotDescription:
        """The table this robot was built from."""
        return self._description

    @property
    def pelvis(self) -> mjcf.Element:
        """The body that the others hang on."""
        root: Any = self._mjcf_root
        return root.worldbody.body[0]

    @property
    def camera_bodies(self) -> list[mjcf.Element]:
        """The bodies that carry the depth cameras, in the order of the table."""
        return self._camera_bodies

    @property
    def lidar_body(self) -> mjcf.Element:
        """The body that carries the lidar."""
        return self._lidar_body


def _add_housing(body: Any, sensor: str, T_body_housing: Pose, shape: str, size: tuple[float, ...]) -> None:
    body.add(
        "geom",
        name=f"{sensor}_housing",
        type=shape,
        size=size,
        pos=T_body_housing.p,
        quat=T_body_housing.quaternion_wxyz,
        group=2,
        contype=0,
        conaffinity=0,
        mass=0,
        rgba=_HOUSING_COLOR,
    )
