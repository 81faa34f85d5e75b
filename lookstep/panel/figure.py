"""The robot's figure in the scene: its links as meshes, moved by joint angles."""

# mujoco keeps its types in binary modules without stubs.
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

from collections.abc import Sequence

import mujoco
import numpy as np
import viser

from lookstep import shapes
from sim_envs.robot import RobotDescription
from skills.geometry import Array, Pose


class Figure:
    """Links under one node of the scene.

    Args:
        server: whose scene it is in.
        name: of its node, such as `/robot`.
        robot: its table.
        joint_names: in the order of the joint angles that it will be shown with.
        color: of all links, RGB; their own where None.
        opacity: solid where None.
    """

    def __init__(
        self,
        server: viser.ViserServer,
        name: str,
        robot: RobotDescription,
        joint_names: Sequence[str],
        *,
        color: tuple[int, int, int] | None = None,
        opacity: float | None = None,
    ) -> None:
        self._server = server
        self._model = mujoco.MjModel.from_xml_path(str(robot.mjcf_path))
        self._data = mujoco.MjData(self._model)
        self._addresses = np.array([self._model.joint(joint).qposadr[0] for joint in joint_names])
        self._shown: tuple[Pose, Array] | None = None
        self.root = server.scene.add_frame(name, show_axes=False, visible=False)
        self._links: list[tuple[int, viser.FrameHandle]] = []
        for body, triangles in shapes.link_triangles(self._model):
            link = f"{name}/{self._model.body(body).name}"
            self._links.append((body, server.scene.add_frame(link, show_axes=False)))
            parts = by_color(triangles) if color is None else [(color, triangles.corners)]
            for i, (part_color, corners) in enumerate(parts):
                server.scene.add_mesh_simple(
                    f"{link}/{i}",
                    corners,
                    np.arange(len(corners), dtype=np.uint32).reshape(-1, 3),
                    color=part_color,
                    opacity=opacity,
                    flat_shading=True,
                )

    def show(self, T_world_pelvis: Pose, joint_positions: Array) -> None:
        """Put it somewhere, with joint angles [rad]."""
        shown = self._shown
        if shown is not None and shown[0] is T_world_pelvis and np.array_equal(shown[1], joint_positions):
            return
        self._shown = (T_world_pelvis, joint_positions)
        self._data.qpos[self._addresses] = joint_positions
        mujoco.mj_kinematics(self._model, self._data)
        T_world_model = T_world_pelvis @ Pose.from_quaternion_wxyz(self._data.xquat[1], self._data.xpos[1]).inverse
        with self._server.atomic():
            self.root.position, self.root.wxyz = T_world_model.p, T_world_model.quaternion_wxyz
            self.root.visible = True
            for body, link in self._links:
                link.position, link.wxyz = self._data.xpos[body].copy(), self._data.xquat[body].copy()

    def hide(self) -> None:
        """Take it out of sight."""
        self._shown = None
        self.root.visible = False


def by_color(triangles: shapes.Triangles) -> list[tuple[tuple[int, int, int], np.ndarray]]:
    """Corners by the colour of their triangle, each (3 N, 3): the browser draws meshes of one colour."""
    colors = triangles.colors[:, :3]
    kinds, inverse = np.unique(colors, axis=0, return_inverse=True)
    inverse = inverse.ravel()
    return [
        ((int(r), int(g), int(b)), np.ascontiguousarray(triangles.corners[inverse == i]))
        for i, (r, g, b) in enumerate(kinds)
    ]
