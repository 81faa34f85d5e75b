"""What the whole body shall do in one tick, from what gait and balance want: the objectives of its program.

Feet on the ground rest, the foot in the air follows its swing, pelvis and torso head where the feet do, joints are
drawn to a posture, and the CoM accelerates as balance says. The weights put them into order: rest of the feet on the
ground, CoM, swing, pelvis, posture.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pinocchio as pin  # pyright: ignore[reportMissingImports]

from skills.footsteps.footstep import Side
from skills.geometry.pose import Array, cross, rotation_y, rotation_z
from skills.walking.body_dynamics import BodyDynamics
from skills.walking.contact import Contact
from skills.walking.gait import Gait, toe_points
from skills.walking.posture import nominal_posture
from skills.walking.robot_model import RobotModel
from skills.walking.swing import Swing
from skills.walking.walking_parameters import WalkingParameters
from skills.walking.whole_body_controller import BodyTasks, SoleTask
from skills.walking.whole_body_parameters import WholeBodyParameters

_SOLE_CENTRE = np.zeros(3)
_PITCH = 4


class MotionObjectives:
    """The objectives of one walking robot.

    Args:
        gait: what the feet do.
        model: the robot.
        parameters: settings of walking.
        body_parameters: weights and gains.
    """

    def __init__(
        self, gait: Gait, model: RobotModel, parameters: WalkingParameters, body_parameters: WholeBodyParameters
    ) -> None:
        self._gait, self._model = gait, model
        self._parameters, self._body_parameters = parameters, body_parameters
        self._posture = nominal_posture(model, parameters)[7:]
        self._posture_weights = _posture_weights(model, body_parameters)
        p = body_parameters
        self._stance_weights = np.full(6, p.stance_weight)
        self._toe_weights = self._stance_weights.copy()
        self._toe_weights[_PITCH] = 0.0
        self._swing_weights = np.array([p.swing_weight] * 3 + [p.swing_turn_weight] * 3)

    def tasks(
        self,
        body: BodyDynamics,
        com_acceleration: Array,
        heading: tuple[float, float],
        contacts: Mapping[Side, Contact],
    ) -> BodyTasks:
        """The tasks of this tick.

        Args:
            body: the robot as it is.
            com_acceleration: wanted, in the world, (3,) [m/s^2].
            heading: wanted yaw of pelvis and torso [rad] and its rate [rad/s].
            contacts: of the feet on the ground.
        """
        p = self._body_parameters
        R_upright, turn = rotation_z(heading[0]), np.array((0.0, 0.0, heading[1]))
        R_pelvis = R_upright @ rotation_y(self._parameters.pelvis_pitch)
        torso_rate = body.torso_jacobian @ body.v
        posture, weights = self._posture_task(body)
        return BodyTasks(
            com_acceleration=com_acceleration,
            momentum_rate=-p.momentum_damping * body.momentum[3:],
            pelvis_acceleration=_turn_towards(
                body.R_world_pelvis, R_pelvis, body.v[3:6], turn, p.pelvis_stiffness, p.pelvis_damping
            ),
            torso_acceleration=_turn_towards(
                body.R_world_torso, R_upright, torso_rate, turn, p.torso_stiffness, p.torso_damping
            ),
            posture_acceleration=posture,
            posture_weights=weights,
            soles={side: self._sole_task(body, side, contacts) for side in Side},
        )

    def _posture_task(self, body: BodyDynamics) -> tuple[Array, Array]:
        """Accelerations towards the posture and their weights, (n,) each; in toe-off the trailing knee stays bent."""
        p, gait = self._body_parameters, self._gait
        acceleration = p.posture_stiffness * (self._posture - body.q[7:]) - p.posture_damping * body.v[6:]
        if not gait.on_toe or gait.step is None:
            return acceleration, self._posture_weights
        knee, weights = self._model.legs[gait.step.side].knee, self._posture_weights.copy()
        bend = self._parameters.toe_off_knee - body.q[7 + knee]
        acceleration[knee] = p.bent_knee_stiffness * bend - p.bent_knee_damping * body.v[6 + knee]
        weights[knee] = p.bent_knee_weight
        return acceleration, weights

    def _sole_task(self, body: BodyDynamics, side: Side, contacts: Mapping[Side, Contact]) -> SoleTask:
        gait = self._gait
        if gait.swing is not None and gait.swing.step.side is side:
            return self._swing_task(body, side, gait.swing)
        if gait.stands_on_toe(side):
            return self._toe_task(body, side, contacts[side])
        return self._stance_task(body, side, contacts[side])

    def _stance_task(self, body: BodyDynamics, side: Side, contact: Contact) -> SoleTask:
        p = self._body_parameters
        acceleration = -p.stance_damping * body.sole_velocity(side)
        if p.stance_stiffness > 0.0:
            sole, landed = body.sole(side), self._gait.stance.sole(side)
            acceleration[:3] += p.stance_stiffness * (sole.R.T @ (landed.p - sole.p))
            acceleration[3:] += p.stance_stiffness * pin.log3(sole.R.T @ landed.R)
        return SoleTask(acceleration, self._stance_weights, _SOLE_CENTRE, contact)

    def _toe_task(self, body: BodyDynamics, side: Side, contact: Contact) -> SoleTask:
        """Rest of the toe line, about which the foot may pitch."""
        p, points, velocity = self._body_parameters, self._gait.points(side), body.sole_velocity(side)
        toe = np.append(points[toe_points(points)].mean(axis=0), 0.0)
        acceleration = -p.stance_damping * velocity
        acceleration[:3] -= p.stance_damping * cross(velocity[3:], toe)
        return SoleTask(acceleration, self._toe_weights, toe, contact)

    def _swing_task(self, body: BodyDynamics, side: Side, swing: Swing) -> SoleTask:
        p, sole, velocity, motion = self._body_parameters, body.sole(side), body.sole_velocity(side), swing.motion()
        to_sole = sole.R.T
        linear = to_sole @ (motion.acceleration[:3] + p.swing_stiffness * (motion.pose.p - sole.p))
        linear += p.swing_damping * (to_sole @ motion.velocity[:3] - velocity[:3])
        # The task is a spatial acceleration: the classical one without the part that turning makes.
        linear -= cross(velocity[3:], velocity[:3])
        angular = to_sole @ motion.acceleration[3:] + p.swing_stiffness * pin.log3(to_sole @ motion.pose.R)
        angular += p.swing_damping * (to_sole @ motion.velocity[3:] - velocity[3:])
        return SoleTask(np.concatenate((linear, angular)), self._swing_weights, _SOLE_CENTRE, None)


def _turn_towards(R: Array, R_wanted: Array, rate: Array, turn_world: Array, stiffness: float, damping: float) -> Array:
    """Angular acceleration of a body in its own frame that turns it to an orientation which turns itself, (3,)."""
    return stiffness * pin.log3(R.T @ R_wanted) + damping * (R.T @ turn_world - rate)


def _posture_weights(model: RobotModel, parameters: WholeBodyParameters) -> Array:
    """Weight of each joint's posture, (n,): legs, back, and all others, which are arms."""
    weights = np.full(len(model.joint_names), parameters.arm_weight)
    weights[list(model.back)] = parameters.back_weight
    for leg in model.legs.values():
        weights[list(leg.joints)] = parameters.leg_weight
    return weights
