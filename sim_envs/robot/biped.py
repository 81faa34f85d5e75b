"""The robot as a composer entity: its MJCF file, and the depth camera that its table mounts on it."""

from __future__ import annotations

import numpy as np
from dm_control import composer, mjcf

from sim_envs.robot.robot_description import RobotDescription
from skills.geometry.pose import Pose, rotation_x

_HOUSING_HALF_SIZE = (0.045, 0.0125, 0.0125)
_HOUSING_BEHIND_LENS = 0.02
_HOUSING_COLOR = (0.22, 0.24, 0.28, 1.0)


class Biped(composer.Entity):
    """A biped without a free joint; an arena adds one with `add_free_entity`."""

    def _build(self, description: RobotDescription) -> None:
        self._description = description
        self._mjcf_root = mjcf.from_path(str(description.mjcf_path))
        self._add_camera()

    def _add_camera(self) -> None:
        body = self._mjcf_root.find("body", self._description.camera_body)
        if body is None:
            raise ValueError(
                f"camera_body: got {self._description.camera_body!r}, which is no body of {self._description.mjcf}"
            )
        self._camera_body = body
        T_body_camera = self._description.T_body_camera
        # MuJoCo's cameras look along -z with y up.
        T_body_mujoco_camera = Pose(T_body_camera.R @ rotation_x(np.pi), T_body_camera.p)
        body.add("camera", name="depth", pos=T_body_camera.p, quat=T_body_mujoco_camera.quaternion_wxyz)
        # Behind the lens, where the camera does not see it.
        body.add(
            "geom",
            name="camera_housing",
            type="box",
            size=_HOUSING_HALF_SIZE,
            pos=T_body_camera.p - _HOUSING_BEHIND_LENS * T_body_camera.R[:, 2],
            quat=T_body_camera.quaternion_wxyz,
            group=2,
            contype=0,
            conaffinity=0,
            mass=0,
            rgba=_HOUSING_COLOR,
        )

    @property
    def mjcf_model(self) -> mjcf.RootElement:
        """The robot's own MJCF tree."""
        return self._mjcf_root

    @property
    def description(self) -> RobotDescription:
        """The table this robot was built from."""
        return self._description

    @property
    def camera_body(self) -> mjcf.Element:
        """The body that carries the depth camera."""
        return self._camera_body
