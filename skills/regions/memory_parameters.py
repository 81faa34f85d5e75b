"""The numbers behind region memory."""

from __future__ import annotations

import numpy as np

from skills.parameters import parameter, parameters


@parameters
class MemoryParameters:
    """What is remembered of earlier frames."""

    age_max: float = parameter(8.0, unit="s", minimum=0.1, maximum=600.0, meaning="older regions expire")
    radius: float = parameter(2.0, unit="m", minimum=0.1, maximum=50.0, meaning="regions further from the feet expire")
    key_distance: float = parameter(
        0.15, unit="m", minimum=0.0, maximum=5.0, meaning="camera travel after which a frame is kept"
    )
    key_angle: float = parameter(
        np.deg2rad(30.0), unit="rad", minimum=0.0, maximum=np.pi, meaning="camera turn after which a frame is kept"
    )
    same_height: float = parameter(
        0.02, unit="m", minimum=0.001, maximum=0.5, meaning="old ground further from what is seen now has changed"
    )
    changed_share: float = parameter(
        0.2, unit="1", minimum=0.0, maximum=1.0, meaning="least share of an old region to be seen before it is judged"
    )
    covered_share: float = parameter(
        0.98, unit="1", minimum=0.0, maximum=1.0, meaning="an old region covered this far by newer ones is dropped"
    )
    regions_max: int = parameter(150, unit="1", minimum=1, maximum=10000, meaning="the oldest beyond this are dropped")
    start_support: float = parameter(
        3.0, unit="1", minimum=1.0, maximum=5.0, meaning="assumed ground around the soles at the start, in soles"
    )
