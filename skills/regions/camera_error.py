"""A camera that sits askew or measures too long, and how what it saw is put right.

A mount that is off by small angles turns all that the camera sees about its own place, and a wrong scale stretches it
from there. Both keep planes planes: regions can be put right as well as the image that they come from.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from skills.geometry.camera import DepthImage
from skills.geometry.pose import Array, Pose, readonly, rotation_about
from skills.regions.planar_region import PlanarRegion, PlanarRegions


@dataclass(frozen=True, slots=True, eq=False)
class CameraError:
    """What is wrong with a camera.

    Attributes:
        mount_camera: rotation vector from the camera as it sits to where it is believed to be, (3,) [rad].
        scale: share by which it measures too long [1].
    """

    mount_camera: Array
    scale: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "mount_camera", readonly(self.mount_camera, (3,)))

    @property
    def vector(self) -> Array:
        """Mount and scale as one, (4,)."""
        return np.append(self.mount_camera, self.scale)

    def less(self, other: CameraError) -> CameraError:
        """What of this error is left where the other one is made good."""
        return CameraError(self.mount_camera - other.mount_camera, self.scale - other.scale)

    def image_corrected(self, image: DepthImage) -> DepthImage:
        """The image as a camera without this error would have taken it."""
        T = image.T_world_camera
        R = T.R @ rotation_about(-self.mount_camera)
        depth = (image.depth * np.float32(1.0 / (1.0 + self.scale))).astype(np.float32, copy=False)
        return replace(image, depth=depth, T_world_camera=Pose(R, T.p))

    def regions_corrected(self, regions: PlanarRegions, T_world_camera: Pose) -> PlanarRegions:
        """Regions that this camera saw from where it was believed to be, as they are."""
        return replace(regions, regions=tuple(self.region_corrected(r, T_world_camera) for r in regions.regions))

    def region_corrected(self, region: PlanarRegion, T_world_camera: Pose) -> PlanarRegion:
        """The same for one of them."""
        p, R = T_world_camera.p, rotation_about(-T_world_camera.R @ self.mount_camera)
        return region.scaled(1.0 / (1.0 + self.scale), p).moved(Pose(R, p - R @ p))


NO_ERROR = CameraError(np.zeros(3), 0.0)
