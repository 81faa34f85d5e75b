"""Planar regions: flat pieces of ground with an outline, the map on which footsteps are planned."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from skills.geometry.pose import Array, Pose, readonly


@dataclass(frozen=True, slots=True, eq=False)
class PlanarRegion:
    """A flat piece of ground.

    Attributes:
        T_world_region: region frame, z along the upward surface normal, origin on the plane.
        hull_region: simplified concave outline in the region's xy plane, (N, 2) counter-clockwise [m].
        holes_region: outlines of holes, each (M, 2) clockwise [m].
        convex_parts_region: convex pieces that cover the region, each (K, 2) counter-clockwise [m].
        area: area of the outline less its holes [m^2].
        time: robot time at which the region was last seen [s].
        sigma: standard deviation of the points about the plane [m].
    """

    T_world_region: Pose
    hull_region: Array
    convex_parts_region: tuple[Array, ...]
    area: float
    time: float
    holes_region: tuple[Array, ...] = ()
    sigma: float = 0.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "hull_region", readonly(self.hull_region, (None, 2)))
        for name in ("holes_region", "convex_parts_region"):
            object.__setattr__(self, name, tuple(readonly(part, (None, 2)) for part in getattr(self, name)))

    def moved(self, T: Pose) -> PlanarRegion:
        """The same region seen from another frame."""
        return replace(self, T_world_region=T @ self.T_world_region)

    def scaled(self, factor: float, about: Array) -> PlanarRegion:
        """The region drawn near to a point, (3,) in its frame of reference, or away from it."""
        T = self.T_world_region
        return replace(
            self,
            T_world_region=Pose(T.R, about + factor * (T.p - about)),
            hull_region=factor * self.hull_region,
            holes_region=tuple(factor * hole for hole in self.holes_region),
            convex_parts_region=tuple(factor * part for part in self.convex_parts_region),
            area=factor**2 * self.area,
            sigma=factor * self.sigma,
        )

    @property
    def normal_world(self) -> Array:
        """Unit upward normal, (3,)."""
        return self.T_world_region.R[:, 2]

    @property
    def hull_world(self) -> Array:
        """Outline in the world, (N, 3) [m]."""
        return self.T_world_region @ np.column_stack((self.hull_region, np.zeros(len(self.hull_region))))


@dataclass(frozen=True, slots=True, eq=False)
class PlanarRegions:
    """The regions of one depth image or of a map.

    Attributes:
        regions: the regions; where two of a map overlap, the later one in the tuple is the newer.
        time: robot time of the newest data that had depth [s].
        frame_id: the newest depth image in it.
    """

    regions: tuple[PlanarRegion, ...]
    time: float
    frame_id: int

    def moved(self, T: Pose) -> PlanarRegions:
        """The same regions seen from another frame."""
        return replace(self, regions=tuple(region.moved(T) for region in self.regions))
