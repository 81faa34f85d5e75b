"""The robot's body as the walking controller sees it: kinematics, mass and limits, read from one MJCF file.

A configuration is q = (pelvis position 3, pelvis quaternion xyzw 4, joints n) in the world, and a velocity is
(linear 3 and angular 3 in the pelvis frame, joint rates n), both in the order of pinocchio (Carpentier et al., 2019).
A leg is six joints from the pelvis to the sole: three of the hip in any order, one of them pitch, then knee, ankle
pitch and ankle roll. What a joint is for follows from its place in that chain and from its axis, never from its name.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pinocchio as pin  # pyright: ignore[reportMissingImports]

from skills.footsteps.footstep import Side, Stance
from skills.geometry.pose import Array, Pose, readonly
from skills.walking.walking_state import RobotState

_JOINTS_IN_LEG = 6
_SIDEWAYS = (0.0, 1.0, 0.0)


class RobotError(ValueError):
    """A robot that its description, its MJCF file or the ground under it does not allow."""


@dataclass(frozen=True, slots=True, eq=False)
class Leg:
    """One leg's joints and lengths.

    Attributes:
        joints: its places among the robot's joints, hip to ankle.
        hip_pitch, knee, ankle_pitch: those of them that bend the leg.
        p_pelvis_hip: last hip joint in the pelvis frame with those before it at zero, (3,) [m].
        p_sole_ankle: ankle in the sole frame, (3,) [m].
        thigh, shank: hip to knee, knee to ankle [m].
        knee_offset: knee angle at which hip, knee and ankle are in line [rad].
        mass_at_ankle: mass that, put at the ankle, moves the CoM as the leg does when hip or ankle moves [kg].
    """

    joints: tuple[int, ...]
    hip_pitch: int
    knee: int
    ankle_pitch: int
    p_pelvis_hip: Array
    p_sole_ankle: Array
    thigh: float
    shank: float
    knee_offset: float
    mass_at_ankle: float

    def length(self, knee: float) -> float:
        """Distance from hip to ankle at a knee angle [m]."""
        bend = np.cos(knee - self.knee_offset)
        return float(np.sqrt(self.thigh**2 + self.shank**2 + 2.0 * self.thigh * self.shank * bend))


class RobotModel:
    """Kinematics of a biped with two soles; not for use by two threads at once.

    Args:
        mjcf_path: MJCF file without a free joint, with the sites left_sole and right_sole.
        sole_length, sole_width: size of a sole along x and y [m].
        torso: name of the body that is kept upright.

    Raises:
        RobotError: where the file has no such robot.
    """

    def __init__(
        self, mjcf_path: str | Path, sole_length: float = 0.26, sole_width: float = 0.138, torso: str = "torso"
    ) -> None:
        if not Path(mjcf_path).is_file():
            raise RobotError(f"{mjcf_path}: there is no such MJCF file")
        built = pin.buildModelAndLegacyConstraintsFromMJCF(str(mjcf_path), pin.JointModelFreeFlyer(), "root")
        self.pin_model: pin.Model = built[0]
        self._data = self.pin_model.createData()
        self.sole_frames = {side: _sole_frame(self.pin_model, side, mjcf_path) for side in Side}
        self.joint_names: tuple[str, ...] = tuple(self.pin_model.names)[2:]
        self.lower_limits = readonly(self.pin_model.lowerPositionLimit[7:])
        self.upper_limits = readonly(self.pin_model.upperPositionLimit[7:])
        self.effort_limits = readonly(self.pin_model.upperEffortLimit[6:])
        self.mass = float(pin.computeTotalMass(self.pin_model))
        self.sole_length, self.sole_width = sole_length, sole_width
        self.foothold_sole = readonly(
            0.5 * np.array([[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]]) * (sole_length, sole_width)
        )
        self.legs = {side: self._leg(side, mjcf_path) for side in Side}
        self.torso_frame = torso
        if not self.pin_model.existFrame(torso):
            raise RobotError(f"{mjcf_path}: there is no body {torso!r} for the torso")
        carried_by = self.pin_model.supports[self.pin_model.frames[self.pin_model.getFrameId(torso)].parentJoint]
        self.back = tuple(int(joint) - 2 for joint in carried_by if joint >= 2)

    def neutral_configuration(self) -> Array:
        """Pelvis at the world's origin, all joints at zero, (7 + n,)."""
        return np.array(pin.neutral(self.pin_model))

    def pelvis_pose(self, q: Array) -> Pose:
        """T_world_pelvis at a configuration."""
        return Pose.from_quaternion_xyzw(q[3:7], q[:3])

    def sole_pose(self, q: Array, side: Side) -> Pose:
        """T_world_sole at a configuration."""
        return self._frame_pose(q, self.sole_frames[side])

    def frame_pose(self, q: Array, name: str) -> Pose:
        """T_world_frame of a body or site at a configuration.

        Raises:
            ValueError: where the robot has no such frame.
        """
        if not self.pin_model.existFrame(name):
            raise ValueError(
                f"the robot has no frame {name!r}, only {', '.join(f.name for f in self.pin_model.frames)}"
            )
        return self._frame_pose(q, self.pin_model.getFrameId(name))

    def com(self, q: Array) -> Array:
        """Centre of mass in the world at a configuration, (3,) [m]."""
        return np.array(pin.centerOfMass(self.pin_model, self._data, q))

    def state(self, time: float, q: Array, v: Array, omega: float) -> RobotState:
        """What a configuration and a velocity mean, at a robot time [s] and a pendulum rate omega [1/s]."""
        model, data = self.pin_model, self._data
        pin.centerOfMass(model, data, q, v)
        com = np.array(data.com[0])
        soles = []
        for side in Side:
            placement = pin.updateFramePlacement(model, data, self.sole_frames[side])
            soles.append(Pose(placement.rotation, placement.translation))
        return RobotState(
            time=time,
            T_world_pelvis=Pose(data.oMi[1].rotation, q[:3]),
            joint_positions=q[7:],
            joint_velocities=v[6:],
            stance=Stance(*soles),
            com_world=com,
            dcm_world=com + data.vcom[0] / omega,
        )

    def _frame_pose(self, q: Array, frame: int) -> Pose:
        pin.forwardKinematics(self.pin_model, self._data, q)
        placement = pin.updateFramePlacement(self.pin_model, self._data, frame)
        return Pose(placement.rotation, placement.translation)

    def _leg(self, side: Side, mjcf_path: str | Path) -> Leg:
        model, q = self.pin_model, self.neutral_configuration()
        frame = self.sole_frames[side]
        chain = [int(joint) for joint in model.supports[model.frames[frame].parentJoint]][2:]
        if len(chain) != _JOINTS_IN_LEG:
            names = ", ".join(model.names[joint] for joint in chain)
            raise RobotError(f"{mjcf_path}: the {side.value} leg has the joints {names}, needs {_JOINTS_IN_LEG}")
        pin.forwardKinematics(model, self._data, q)
        bending = [joint for joint in chain if np.allclose(self._axis(joint), _SIDEWAYS, atol=1e-6)]
        if len(bending) != 3 or bending[1:] != chain[3:5]:
            names = ", ".join(model.names[joint] for joint in bending)
            raise RobotError(
                f"{mjcf_path}: the {side.value} leg bends about +y at {names or 'no joint'}; needs one joint of its "
                f"hip, the knee {model.names[chain[3]]} and the ankle {model.names[chain[4]]}"
            )
        hip, knee, ankle = (np.array(self._data.oMi[chain[i]].translation) for i in (2, 3, 4))
        thigh, shank = hip - knee, knee - ankle
        bodies = [(model.inertias[joint], self._data.oMi[joint]) for joint in chain]
        heights = [(inertia.mass, float((placement * inertia.lever)[2])) for inertia, placement in bodies]
        shares = [mass * np.clip((hip[2] - height) / (hip[2] - ankle[2]), 0.0, 1.0) for mass, height in heights]
        return Leg(
            joints=tuple(joint - 2 for joint in chain),
            hip_pitch=bending[0] - 2,
            knee=bending[1] - 2,
            ankle_pitch=bending[2] - 2,
            p_pelvis_hip=readonly(hip),
            p_sole_ankle=readonly(self._frame_pose(q, frame).inverse @ ankle),
            thigh=float(np.linalg.norm(thigh)),
            shank=float(np.linalg.norm(shank)),
            knee_offset=float(np.arctan2(thigh[0], thigh[2]) - np.arctan2(shank[0], shank[2])),
            mass_at_ankle=float(sum(shares)),
        )

    def _axis(self, joint: int) -> Array:
        """Axis of a revolute joint in the pelvis frame where the data's kinematics were computed, (3,)."""
        motion = pin.computeJointJacobian(self.pin_model, self._data, self.neutral_configuration(), joint)
        return self._data.oMi[joint].rotation @ motion[3:, self.pin_model.joints[joint].idx_v]


def _sole_frame(model: pin.Model, side: Side, mjcf_path: str | Path) -> int:
    name = f"{side.value}_sole"
    if not model.existFrame(name):
        raise RobotError(f"{mjcf_path}: there is no site {name!r}")
    return int(model.getFrameId(name))
