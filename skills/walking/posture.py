"""How the robot holds itself: the posture that joints are drawn to, and the configuration in which it stands."""

from __future__ import annotations

import numpy as np

from skills.footsteps.footstep import Stance
from skills.geometry.pose import Array, Pose, rotation_y, rotation_z
from skills.walking.inverse_kinematics import IkSolution, InverseKinematics
from skills.walking.robot_model import RobotError, RobotModel
from skills.walking.walking_parameters import WalkingParameters

_ITERATIONS = 100
_TOLERANCE = 1e-7
_SOLE_RESIDUAL = 0.005
_COM_RESIDUAL = 0.03


def nominal_posture(model: RobotModel, parameters: WalkingParameters) -> Array:
    """Bent knees, arms at the sides, (7 + n,) with the pelvis at the origin.

    Raises:
        RobotError: where the posture names a joint that the robot has not.
    """
    q = model.neutral_configuration()
    for name, angle in parameters.posture:
        if name not in model.joint_names:
            raise RobotError(f"posture: got joint {name!r}, the robot has {', '.join(model.joint_names)}")
        q[7 + model.joint_names.index(name)] = angle
    bend = parameters.knee_bend
    for leg in model.legs.values():
        q[[7 + leg.hip_pitch, 7 + leg.knee, 7 + leg.ankle_pitch]] = -0.5 * bend, bend, -0.5 * bend
    q[7:] = np.clip(q[7:], model.lower_limits, model.upper_limits)
    return q


def standing_configuration(model: RobotModel, stance: Stance, parameters: WalkingParameters) -> Array:
    """The configuration that stands on a stance with the CoM between the feet, (7 + n,).

    Raises:
        RobotError: where the legs do not reach.
    """
    p = parameters
    height = min(sole.p[2] for sole in (stance.T_world_left, stance.T_world_right)) + p.com_height
    com = np.array((*stance.mid_feet[:2], height))
    R = rotation_z(stance.yaw) @ rotation_y(p.pelvis_pitch)
    q = nominal_posture(model, p)
    q[:3] = com - model.com(q)
    q[3:7] = Pose(R, np.zeros(3)).quaternion_xyzw
    solution = InverseKinematics(model).solve(q, com, R, stance, _ITERATIONS, _TOLERANCE)
    failure = _out_of_reach(solution)
    if failure:
        raise RobotError(
            f"the robot cannot stand on soles at {stance.T_world_left.p}, {stance.T_world_right.p}: {failure}"
        )
    return solution.q


def _out_of_reach(solution: IkSolution) -> str:
    """One sentence where inverse kinematics missed its targets; empty where it did not."""
    errors = (
        (solution.left_error, _SOLE_RESIDUAL, "the left sole"),
        (solution.right_error, _SOLE_RESIDUAL, "the right sole"),
        (solution.com_error, _COM_RESIDUAL, "the CoM"),
    )
    for error, limit, name in errors:
        if error > limit:
            return f"inverse kinematics is off by {1000 * error:.0f} mm at {name}"
    return ""
