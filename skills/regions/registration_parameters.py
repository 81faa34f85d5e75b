"""The numbers behind the registration of frames."""

from __future__ import annotations

import numpy as np

from skills.parameters import parameter, parameters


@parameters
class RegistrationParameters:
    """How far the newest frame is trusted to say that the robot's estimate has drifted."""

    cell: float = parameter(0.02, unit="m", minimum=0.005, maximum=0.1, meaning="edge of the cells of the height map")
    reach: float = parameter(2.2, unit="m", minimum=0.5, maximum=20.0, meaning="ground this far from the camera counts")
    overlap_min: float = parameter(
        0.3, unit="1", minimum=0.0, maximum=1.0, meaning="least share of a frame's ground that must be known; 1 is off"
    )
    shift_max: float = parameter(0.15, unit="m", minimum=0.0, maximum=1.0, meaning="larger corrections are refused")
    turn_max: float = parameter(
        np.deg2rad(8.0), unit="rad", minimum=0.0, maximum=1.0, meaning="larger corrections of the heading are refused"
    )
    prior: float = parameter(
        0.03, unit="1", minimum=0.0, maximum=10.0, meaning="mean squared slope of ground that moves an estimate halfway"
    )
    prior_turn: float = parameter(
        0.25, unit="m^2", minimum=0.0, maximum=100.0, meaning="weight of the heading in that prior, to that of position"
    )
    prior_shift: float = parameter(
        0.015, unit="m", minimum=0.001, maximum=1.0, meaning="jumps well beyond this are no drift: the prior lets go"
    )
    prior_yaw: float = parameter(
        np.deg2rad(0.7), unit="rad", minimum=0.001, maximum=1.0, meaning="the same for jumps of the heading"
    )
    rate_gain: float = parameter(
        0.05, unit="1", minimum=0.0, maximum=1.0, meaning="share of a turn that is taken for steady drift"
    )
    mount_min: float = parameter(
        np.deg2rad(0.3), unit="rad", minimum=0.0, maximum=1.0, meaning="smaller errors of the mount are not looked at"
    )
    scale_min: float = parameter(
        0.003, unit="1", minimum=0.0, maximum=1.0, meaning="smaller errors of the depth's scale are not looked at"
    )
    rate_memory: float = parameter(
        60.0,
        unit="s",
        minimum=0.1,
        maximum=1000.0,
        meaning="steady drift that nothing shows dies away in this time",
    )
    same_height: float = parameter(
        0.02, unit="m", minimum=0.001, maximum=0.5, meaning="ground further from what it was has moved, and is replaced"
    )
    frames_max: int = parameter(
        8, unit="1", minimum=1, maximum=100, meaning="frames that a cell's height is the mean of"
    )
    correct_camera: bool = parameter(
        True, unit="1", meaning="what is found wrong with the camera's mount and scale is made good"
    )
    camera_doubt: float = parameter(
        1.0, unit="1", minimum=0.01, maximum=10.0, meaning="standard deviations of it, in mount_min and scale_min"
    )
    expected_drift: float = parameter(
        0.01, unit="m/s", minimum=1e-4, maximum=1.0, meaning="how fast estimates drift, as a rule"
    )
    expected_mount: float = parameter(
        0.035, unit="rad", minimum=1e-4, maximum=1.0, meaning="how far askew cameras are mounted, as a rule"
    )
    expected_scale: float = parameter(
        0.01, unit="1", minimum=1e-5, maximum=1.0, meaning="how wrong the scale of depth is, as a rule"
    )
    exact_level: float = parameter(
        1e-3, unit="m", minimum=1e-5, maximum=0.1, meaning="standard deviation of the shift of a frame along the ground"
    )
    exact_height: float = parameter(2e-4, unit="m", minimum=1e-5, maximum=0.1, meaning="the same for its height")
