"""The outlines of the ground's regions in one table, and the edges of them that matter to a sole."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from skills.geometry.pose import Array
from skills.kernels import kernel
from skills.regions.planar_region import PlanarRegion

_SHORTEST = 1e-6  # edges shorter than this have no direction [m]


class Outlines(NamedTuple):
    """Outlines and holes of regions.

    Attributes:
        vertices: of all rings one after the other, (V, 2) in the region frame [m].
        ring_starts: first vertex of each ring, and the number of vertices, (rings + 1,).
        ring_regions: region of each ring, ascending, (rings,).
        rotations: R_world_region of each region, (R, 3, 3).
        origins: origin of each region in the world, (R, 3) [m].
    """

    vertices: Array
    ring_starts: NDArray[np.int64]
    ring_regions: NDArray[np.int64]
    rotations: Array
    origins: Array

    @classmethod
    def of(cls, regions: list[PlanarRegion]) -> Outlines:
        """The outlines of some regions, in their order."""
        rings = [(i, ring) for i, region in enumerate(regions) for ring in (region.hull_region, *region.holes_region)]
        return cls(
            vertices=np.concatenate([ring for _, ring in rings]) if rings else np.zeros((0, 2)),
            ring_starts=np.cumsum([0] + [len(ring) for _, ring in rings]),
            ring_regions=np.array([i for i, _ in rings], dtype=np.int64),
            rotations=np.array([region.T_world_region.R for region in regions]).reshape(-1, 3, 3),
            origins=np.array([region.T_world_region.p for region in regions]).reshape(-1, 3),
        )


@kernel
def edges_near(outlines: Outlines, region: int, R_world_sole: Array, p_world_sole: Array, near: float) -> Array:
    """Edges of a region that come near a sole's centre and have it inside.

    Returns:
        (N, 3) unit outward normal x, y and offset from the centre, in the sole's frame [m].
    """
    rotation, shift = np.zeros((2, 2)), np.zeros(2)
    for i in range(2):
        for k in range(3):
            shift[i] += R_world_sole[k, i] * (outlines.origins[region, k] - p_world_sole[k])
            for j in range(2):
                rotation[i, j] += R_world_sole[k, i] * outlines.rotations[region, k, j]
    first = np.searchsorted(outlines.ring_regions, region)
    last = np.searchsorted(outlines.ring_regions, region + 1)
    edges = np.empty((outlines.ring_starts[last] - outlines.ring_starts[first], 3))
    count = 0
    for ring in range(first, last):
        begin, end = outlines.ring_starts[ring], outlines.ring_starts[ring + 1]
        for v in range(begin, end):
            a, b = outlines.vertices[v], outlines.vertices[v + 1 if v + 1 < end else begin]
            ax = rotation[0, 0] * a[0] + rotation[0, 1] * a[1] + shift[0]
            ay = rotation[1, 0] * a[0] + rotation[1, 1] * a[1] + shift[1]
            dx = rotation[0, 0] * (b[0] - a[0]) + rotation[0, 1] * (b[1] - a[1])
            dy = rotation[1, 0] * (b[0] - a[0]) + rotation[1, 1] * (b[1] - a[1])
            length = np.sqrt(dx * dx + dy * dy)
            if length <= _SHORTEST:
                continue
            nx, ny = dy / length, -dx / length
            offset = nx * ax + ny * ay
            along = min(max(-(ax * dx + ay * dy) / (length * length), 0.0), 1.0)
            x, y = ax + along * dx, ay + along * dy
            if offset > 0.0 and x * x + y * y < near * near:
                edges[count, 0], edges[count, 1], edges[count, 2] = nx, ny, offset
                count += 1
    return edges[:count]
