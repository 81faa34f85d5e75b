"""The numbers behind region extraction."""

from __future__ import annotations

import numpy as np

from skills.parameters import parameter, parameters


@parameters
class RegionParameters:
    """How a depth image is cut into planar regions.

    Blocks of a field touch, and links from patch to patch chain across their seams. So the tolerances to the plane of
    the whole region decide, not those between neighbours: a level block parts from one tilted by 11 degrees. Limits
    marked by * hold without noise; noise_factor times the standard deviation that the image's noise causes is added.
    """

    patch_size: int = parameter(
        0, unit="px", minimum=0, maximum=64, meaning="edge of a patch; 0 = the even size nearest to patch_angle"
    )
    patch_angle: float = parameter(
        0.011, unit="rad", minimum=0.002, maximum=0.1, meaning="edge of a patch as seen from the camera"
    )
    depth_max: float = parameter(4.0, unit="m", minimum=0.2, maximum=20.0, meaning="deeper pixels are ignored")
    noise_factor: float = parameter(
        3.0, unit="1", minimum=0.5, maximum=10.0, meaning="standard deviations of the image's noise that limits allow"
    )
    link_angle: float = parameter(
        np.deg2rad(1.0), unit="rad", minimum=0.0, maximum=1.0, meaning="normals of neighbouring patches that link *"
    )
    link_offset: float = parameter(
        0.002, unit="m", minimum=0.0, maximum=0.1, meaning="offset of neighbouring patches from each other's plane *"
    )
    grow_angle: float = parameter(
        np.deg2rad(2.0), unit="rad", minimum=0.0, maximum=1.0, meaning="normal of a patch and of its region *"
    )
    grow_offset: float = parameter(
        0.001, unit="m", minimum=0.0, maximum=0.1, meaning="offset of a patch from the plane of its region *"
    )
    fill_offset: float = parameter(
        0.0, unit="m", minimum=0.0, maximum=0.1, meaning="offset at which a patch joins without regard to its normal *"
    )
    merge_offset: float = parameter(
        0.0005, unit="m", minimum=0.0, maximum=0.1, meaning="mean distance of regions from the plane they merge to *"
    )
    pixel_offset: float = parameter(
        0.002, unit="m", minimum=0.0, maximum=0.1, meaning="depth of pixels of a region from its plane *"
    )
    patches_min: int = parameter(12, unit="1", minimum=1, maximum=10000, meaning="fewer patches are no region")
    bend_max: float = parameter(
        0.005,
        unit="m",
        minimum=0.0005,
        maximum=0.1,
        meaning="spread of patch means about a region beyond noise; more is curved",
    )
    area_min: float = parameter(0.01, unit="m^2", minimum=0.0, maximum=10.0, meaning="smaller regions are dropped")
    hole_area_min: float = parameter(0.002, unit="m^2", minimum=0.0, maximum=1.0, meaning="smaller holes are filled")
    slope_max: float = parameter(
        np.deg2rad(40.0), unit="rad", minimum=0.0, maximum=np.pi, meaning="steeper regions are no ground"
    )
    distance_min: float = parameter(
        0.45, unit="m", minimum=0.0, maximum=5.0, meaning="regions nearer to the camera are the robot's own body"
    )
    outline_tolerance: float = parameter(
        0.01, unit="m", minimum=0.0005, maximum=0.1, meaning="how far the outline between two corners may stray"
    )
    outline_pixels: float = parameter(
        2.5, unit="px", minimum=0.5, maximum=20.0, meaning="the same as seen by the camera; the greater of both counts"
    )
    convex_tolerance: float = parameter(
        0.015, unit="m", minimum=0.0005, maximum=0.2, meaning="depth of notches that convex parts fill"
    )
