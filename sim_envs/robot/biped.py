"""The robot as a composer entity: its MJCF file, and the depth camera that its table mounts on it."""

from __future__ import annotations

import numpy as np
from dm_control import composer, mjcf

from sim_envs.robot.robot_description import RobotDescription
from skills.geometry.pose import Pose, rotation_x

_HOUSING_HALF_SIZE = (0.045, 0.0125, 0.0125)
_HOUSING_BEHIND_LENS = 0.02


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
        T_body_camera = self._description.T_body_camera
        # MuJoCo's cameras look along -z with y up.
        T_body_mujoco_camera = Pose(T_body_camera.R @ rotation_x(np.pi), T_body_camera.p)
        self._camera = body.add("camera", name="depth", pos=T_body_camera.p, quat=T_body_mujoco_camera.quaternion_wxyz)
        # Behind the lens, where the camera does not see it.
        self._housing = body.add(
            "geom",
            name="camera_housing",
            type="box",
            size=_HOUSING_HALF_SIZE,
            pos=T_body_camera.p - _HOUSING_BEHIND_LENS * T_body_camera.R[:, 2],
            quat=T_body_camera.quaternion_wxyz,
            dclass="frame",
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
    def camera(self) -> mjcf.Element:
        """The depth camera, for MuJoCo's renderers."""
        return self._camera

    @property
    def camera_body(self) -> mjcf.Element:
        """The body that carries the depth camera."""
        return self._camera.parent

    @property
    def sole_sites(self) -> tuple[mjcf.Element, mjcf.Element]:
        """Sites at the centres of the left and the right sole."""
        sites = [site for side in ("left", "right") if (site := self._mjcf_root.find("site", f"{side}_sole"))]
        if len(sites) != 2:
            raise ValueError(f"{self._description.mjcf}: needs sites `left_sole` and `right_sole`")
        return sites[0], sites[1]
