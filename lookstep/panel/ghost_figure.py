"""The ghost in the scene: the robot's figure, see-through, whose legs reach where the preview steps."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import viser

from lookstep import palette
from lookstep.panel.figure import Figure
from lookstep.panel.ghost import GhostPose
from sim_envs.robot import RobotDescription
from skills.geometry.pose import rotation_z
from skills.walking import RobotModel, RobotState
from skills.walking.inverse_kinematics import InverseKinematics

_ITERATIONS, _TOLERANCE = 8, 1e-3


class GhostFigure:
    """Shows poses of a preview.

    Args:
        server: whose scene it is in.
        name: of its node.
        robot: its table.
        joint_names: in the order of the robot's joint positions.
    """

    def __init__(
        self, server: viser.ViserServer, name: str, robot: RobotDescription, joint_names: Sequence[str]
    ) -> None:
        self._figure = Figure(server, name, robot, joint_names, color=palette.GHOST[:3], opacity=0.35)
        model = RobotModel(robot.mjcf_path, robot.sole_length, robot.sole_width, robot.torso_body)
        self._model, self._kinematics = model, InverseKinematics(model)
        self._q = model.neutral_configuration()
        self._fresh = True

    def show(self, pose: GhostPose, state: RobotState) -> None:
        """Show a pose; arms, back and the height of the CoM are those of the robot's state."""
        if self._fresh:
            self._q = np.concatenate(
                (state.T_world_pelvis.p, state.T_world_pelvis.quaternion_xyzw, state.joint_positions)
            )
            self._height = float(state.com_world[2] - state.stance.mid_feet[2])
            self._fresh = False
        com = np.array((*pose.com_xy, pose.ground_height + self._height))
        solved = self._kinematics.solve(
            self._q, com, rotation_z(pose.yaw), pose.stance, iterations=_ITERATIONS, tolerance=_TOLERANCE
        )
        self._q = solved.q
        self._figure.show(self._model.pelvis_pose(self._q), self._q[7:].copy())

    def hide(self) -> None:
        """Take it out of sight."""
        self._fresh = True
        self._figure.hide()
