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
    heel_lift_rate: float = parameter(
        1.0, unit="rad/s", meaning="how fast a heel is planned to rise", minimum=0.1, maximum=20.0
    )
    heel_lift_start: float = parameter(0.35, unit="1", meaning="share of the transfer before heels lift", maximum=0.9)
    toe_off_knee: float = parameter(
        0.5, unit="rad", meaning="trailing knee straighter than this lifts its heel", minimum=0.0, maximum=1.5
    )

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
    cmp_excess: float = parameter(
        0.02, unit="m", meaning="how far the CMP may leave the soles to save balance", minimum=0.0, maximum=0.2
    )
    hold_error: float = parameter(0.03, unit="m", meaning="DCM error that holds double support", minimum=0.0)
    hold_limit: float = parameter(1.0, unit="s", meaning="longest hold of double support", minimum=0.0)
    fall_distance: float = parameter(
        0.05, unit="m", meaning="a DCM this far out of support and off its plan is a fall", minimum=0.0
    )

    touchdown_load: float = parameter(
        0.047, unit="1", meaning="share of the weight on a foot that tells it has landed", minimum=0.001, maximum=0.5
    )
    touchdown_time: float = parameter(0.004, unit="s", meaning="how long it must last", minimum=0.0, maximum=0.1)
    touchdown_share: float = parameter(
        0.7, unit="1", meaning="share of the swing before which no contact is a landing", minimum=0.0, maximum=1.0
    )
    touchdown_distance: float = parameter(
        0.06, unit="m", meaning="an early contact farther off its foothold is no landing", minimum=0.0
    )
    touchdown_depth: float = parameter(
        0.05, unit="m", meaning="an early contact higher over its foothold is no landing", minimum=0.0
    )
    latest_landing: float = parameter(
        1.8, unit="1", meaning="share of the swing at which a foot counts as landed all the same", minimum=1.0
    )
    phantom_time: float = parameter(
        0.05, unit="s", meaning="a landed foot without force for this long goes on sinking", minimum=0.0
    )

    knee_bend: float = parameter(1.0, unit="rad", meaning="knee angle that standing is solved from", minimum=0.2)
    pelvis_pitch: float = parameter(0.03, unit="rad", meaning="forward lean of the pelvis", minimum=-0.5, maximum=0.5)
    posture: tuple[tuple[str, float], ...] = parameter(
        (
            ("left_shoulder_yaw", -0.3),
            ("left_shoulder_roll", -1.2),
            ("left_elbow_pitch", radians(90.0)),
            ("left_elbow_roll", 0.6),
            ("right_shoulder_yaw", 0.3),
            ("right_shoulder_roll", 1.2),
            ("right_elbow_pitch", radians(90.0)),
            ("right_elbow_roll", -0.6),
        ),
        unit="rad",
        meaning="angles that joints of arms and back are drawn to, by name; all others 0",
    )
