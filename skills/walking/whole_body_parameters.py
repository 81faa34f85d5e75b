"""How the whole body serves its tasks: weights, gains and limits of the momentum-based controller."""

from __future__ import annotations

from skills.parameters import parameter, parameters


@parameters
class WholeBodyParameters:
    """Weights, gains and limits of the whole-body quadratic program."""

    com_weight: float = parameter(300.0, unit="1", meaning="CoM acceleration in the plane", minimum=0.0)
    height_weight: float = parameter(100.0, unit="1", meaning="CoM acceleration upwards", minimum=0.0)
    momentum_weight: float = parameter(0.002, unit="1/(N m)^2", meaning="rate of angular momentum", minimum=0.0)
    pelvis_weight: float = parameter(15.0, unit="1", meaning="pelvis orientation", minimum=0.0)
    torso_weight: float = parameter(5.0, unit="1", meaning="torso orientation", minimum=0.0)
    stance_weight: float = parameter(2000.0, unit="1", meaning="rest of a foot on the ground", minimum=0.0)
    swing_weight: float = parameter(20.0, unit="1", meaning="position of a swinging foot", minimum=0.0)
    swing_turn_weight: float = parameter(2.0, unit="1", meaning="orientation of a swinging foot", minimum=0.0)
    arm_weight: float = parameter(1.0, unit="1", meaning="posture of the arms", minimum=0.0)
    back_weight: float = parameter(0.1, unit="1", meaning="posture of the back", minimum=0.0)
    leg_weight: float = parameter(0.01, unit="1", meaning="posture of the legs", minimum=0.0)
    bent_knee_weight: float = parameter(5.0, unit="1", meaning="bend of the trailing knee in toe-off", minimum=0.0)
    force_weight: float = parameter(
        0.005, unit="1", meaning="contact forces, in seventeenths of the robot's weight", minimum=1e-6
    )

    height_stiffness: float = parameter(40.0, unit="1/s^2", meaning="CoM height", minimum=0.0)
    height_damping: float = parameter(11.0, unit="1/s", meaning="CoM height", minimum=0.0)
    momentum_damping: float = parameter(4.0, unit="1/s", meaning="decay of angular momentum", minimum=0.0)
    pelvis_stiffness: float = parameter(100.0, unit="1/s^2", meaning="pelvis orientation", minimum=0.0)
    pelvis_damping: float = parameter(20.0, unit="1/s", meaning="pelvis orientation", minimum=0.0)
    torso_stiffness: float = parameter(60.0, unit="1/s^2", meaning="torso orientation", minimum=0.0)
    torso_damping: float = parameter(15.0, unit="1/s", meaning="torso orientation", minimum=0.0)
    stance_stiffness: float = parameter(0.0, unit="1/s^2", meaning="pull back to where a foot landed", minimum=0.0)
    stance_damping: float = parameter(20.0, unit="1/s", meaning="rest of a foot on the ground", minimum=0.0)
    swing_stiffness: float = parameter(300.0, unit="1/s^2", meaning="pose of a swinging foot", minimum=0.0)
    swing_damping: float = parameter(34.0, unit="1/s", meaning="pose of a swinging foot", minimum=0.0)
    bent_knee_stiffness: float = parameter(
        400.0, unit="1/s^2", meaning="bend of the trailing knee in toe-off", minimum=0.0
    )
    bent_knee_damping: float = parameter(40.0, unit="1/s", meaning="bend of the trailing knee in toe-off", minimum=0.0)
    posture_stiffness: float = parameter(30.0, unit="1/s^2", meaning="posture", minimum=0.0)
    posture_damping: float = parameter(10.0, unit="1/s", meaning="posture", minimum=0.0)

    friction: float = parameter(0.75, unit="1", meaning="coefficient of friction that forces keep to", minimum=0.1)
    joint_limit_rate: float = parameter(20.0, unit="1/s", meaning="how fast joints may near their limits", minimum=1.0)
    lowest_descent: float = parameter(0.4, unit="g", meaning="greatest commanded CoM acceleration down", minimum=0.05)
    highest_ascent: float = parameter(0.6, unit="g", meaning="greatest commanded CoM acceleration up", minimum=0.05)

    qp_tolerance: float = parameter(1e-3, unit="1", meaning="tolerance of the quadratic program", minimum=1e-9)
    qp_iterations: int = parameter(200, unit="1", meaning="most iterations of the quadratic program", minimum=10)
    qp_check: int = parameter(5, unit="1", meaning="iterations between looks at its residuals", minimum=1)
