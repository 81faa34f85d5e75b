"""How the robot walks: timing, balance, swing and reach settings of the walking controller."""

from __future__ import annotations

from math import radians

from skills.parameters import parameter, parameters


@parameters
class WalkingParameters:
    """Settings of the walking controller; swing and transfer times come with each footstep."""

    first_transfer: float = parameter(0.7, unit="s", meaning="shortest double support before a first step", minimum=0.1)
    final_transfer: float = parameter(
        0.8, unit="s", meaning="double support from the last step to standing", minimum=0.1
    )

    gravity: float = parameter(9.81, unit="m/s^2", meaning="gravity", minimum=1.0, maximum=30.0)
    com_height: float = parameter(1.12, unit="m", meaning="CoM above the ground", minimum=0.5, maximum=2.0)
    rise_in_swing: float = parameter(0.25, unit="1", meaning="share of a step up that the CoM rises in its swing")
    drop_after_swing: float = parameter(0.4, unit="1", meaning="share of a step down left to sink after its swing")
    rise_in_transfer: float = parameter(0.75, unit="1", meaning="share of a step up made when its transfer ends")
    height_horizon: float = parameter(2.4, unit="s", meaning="preview of the CoM height", minimum=0.5, maximum=6.0)
    height_knot: float = parameter(0.1, unit="s", meaning="knot spacing of the CoM height", minimum=0.02, maximum=0.5)
    straightest_knee: float = parameter(
        0.45, unit="rad", meaning="least knee angle planned for", minimum=0.0, maximum=1.0
    )
    most_bent_knee: float = parameter(
        2.2, unit="rad", meaning="greatest knee angle planned for", minimum=1.0, maximum=3.0
    )
    heel_lift: float = parameter(0.6, unit="rad", meaning="largest pitch of a trailing foot about its toe", minimum=0.0)
    heel_lift_start: float = parameter(0.35, unit="1", meaning="share of the transfer before heels lift", maximum=0.9)
    heel_lift_stages: int = parameter(4, unit="1", meaning="heel lifts tried between none and the largest", minimum=1)

    cop_in: float = parameter(0.0, unit="m", meaning="CoP before the sole's centre when its swing starts")
    cop_out: float = parameter(0.02, unit="m", meaning="CoP before the sole's centre when its swing ends")
    cop_inward: float = parameter(0.008, unit="m", meaning="CoP inwards of the sole's centre line")
    cop_margin: float = parameter(
        0.01, unit="m", meaning="distance of the CoP from sole corners", minimum=0.0, maximum=0.05
    )
    dcm_gain: float = parameter(3.0, unit="1/s", meaning="feedback of the DCM error", minimum=0.0, maximum=20.0)
    shortest_replan: float = parameter(
        0.08, unit="s", meaning="phases with less time left keep their CoP line", minimum=0.0
    )
    hold_error: float = parameter(0.03, unit="m", meaning="DCM error that holds double support", minimum=0.0)
    hold_extension: float = parameter(0.1, unit="s", meaning="double support is prolonged by this", minimum=0.01)
    hold_limit: float = parameter(1.0, unit="s", meaning="longest hold of double support", minimum=0.0)
    fall_distance: float = parameter(
        0.05, unit="m", meaning="a DCM this far out of support and off its plan is a fall", minimum=0.0
    )

    swing_knots: int = parameter(32, unit="1", meaning="spline intervals of a swing", minimum=16, maximum=128)
    swing_leave: float = parameter(0.12, unit="1", meaning="share of the swing before the foot travels", minimum=0.1)
    swing_arrive: float = parameter(
        0.85, unit="1", meaning="share of the swing when the foot has travelled", maximum=0.9
    )
    swing_detour: float = parameter(0.15, unit="1", meaning="travel starts later, ends earlier at walls", maximum=0.25)
    swing_ramp: float = parameter(
        0.45, unit="1", meaning="most of the swing to rise or sink in", minimum=0.1, maximum=0.5
    )
    swing_shoulder: float = parameter(
        0.35, unit="1", meaning="share of the way to the apex without waypoints", maximum=0.5
    )
    swing_normal: float = parameter(0.03, unit="m", meaning="way along the surface normal at both ends", minimum=0.001)
    swing_level: float = parameter(0.5, unit="1", meaning="share of the swing when the sole is level", minimum=0.1)
    swing_aligned: float = parameter(0.9, unit="1", meaning="share of the swing when it has the foothold's tilt")
    swing_strict: float = parameter(
        0.15, unit="1", meaning="share of the swing, at both ends, with an exact orientation", minimum=0.01, maximum=0.5
    )

    knee_bend: float = parameter(1.0, unit="rad", meaning="knee angle that standing is solved from", minimum=0.2)
    pelvis_pitch: float = parameter(0.03, unit="rad", meaning="forward lean of the pelvis", minimum=-0.5, maximum=0.5)
    shoulder_yaw: float = parameter(-0.3, unit="rad", meaning="posture of the left arm, mirrored on the right")
    shoulder_roll: float = parameter(-1.2, unit="rad", meaning="posture of the left arm, mirrored on the right")
    elbow_pitch: float = parameter(radians(90.0), unit="rad", meaning="posture of both arms")
    elbow_roll: float = parameter(0.6, unit="rad", meaning="posture of the left arm, mirrored on the right")

    control_period: float = parameter(0.01, unit="s", meaning="longest control step", minimum=0.0005, maximum=0.02)
    control_period: float = parameter(0.01, unit="s", meaning="longest control step", minimum=0.0005, maximum=0.02)
    ik_iterations: int = parameter(5, unit="1", meaning="iterations of inverse kinematics a control step", minimum=1)
    ik_tolerance: float = parameter(1e-7, unit="m", meaning="error at which its iterations end", minimum=0.0)
    sole_residual: float = parameter(
        0.005, unit="m", meaning="sole error that inverse kinematics may leave", minimum=0.0
    )
    com_residual: float = parameter(0.03, unit="m", meaning="CoM error in the plane that it may leave", minimum=0.0)
