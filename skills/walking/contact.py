"""The contact of one sole with the ground: forces at the corners of its foothold within friction pyramids.

At every contact point four rays span a pyramid around the normal of the sole; a contact force is a sum of rays with
weights that are not negative. The rays lie on the axes of the sole, so that the full friction is there along x and y;
with rays on the diagonals a pyramid of the same four rays holds 30 % less where a tilted block needs it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from skills.geometry.pose import Array, Mask

CONTACT_POINTS = 4
RAYS = 4 * CONTACT_POINTS


@dataclass(frozen=True, slots=True, eq=False)
class Contact:
    """Where one sole may be pushed by the ground.

    Attributes:
        points_sole: contact points, (4, 2) in the sole's plane [m].
        loaded: whether each point may carry force, (4,) boolean.
        rays_wrench: wrench in the sole frame by the weights of the rays, (6, 16), force first.
    """

    points_sole: Array
    loaded: Mask
    rays_wrench: Array

    @classmethod
    def at(cls, points_sole: Array, friction: float, loaded: Mask | None = None) -> Contact:
        """A contact at four points with a coefficient of friction."""
        directions = np.array([[friction, 0, 1], [0, friction, 1], [-friction, 0, 1], [0, -friction, 1]])
        forces = np.tile(directions, (CONTACT_POINTS, 1))
        arms = np.repeat(np.column_stack((points_sole, np.zeros(CONTACT_POINTS))), 4, axis=0)
        wrenches = np.hstack((forces, np.cross(arms, forces)))
        if loaded is None:
            loaded = np.ones(CONTACT_POINTS, dtype=bool)
        return cls(np.asarray(points_sole), loaded, wrenches.T.copy())

    def cop_sole(self, weights: Array) -> Array | None:
        """Centre of pressure in the sole's plane (2,) [m] of ray weights (16,); None without force."""
        wrench = self.rays_wrench @ weights
        return None if wrench[2] <= 1e-6 else np.array((-wrench[4], wrench[3])) / wrench[2]


def contact_points(foothold_sole: Array) -> Array:
    """Four points that span a convex foothold (N, 2) best, (4, 2) [m].

    A foothold of more corners keeps the four whose quadrangle is largest; one of three has a corner twice.
    """
    count = len(foothold_sole)
    if count <= CONTACT_POINTS:
        return foothold_sole[np.minimum(np.arange(CONTACT_POINTS), count - 1)]
    best, largest = foothold_sole[:CONTACT_POINTS], -1.0
    for a in range(count - 3):
        for b in range(a + 1, count - 2):
            for c in range(b + 1, count - 1):
                for d in range(c + 1, count):
                    chosen = foothold_sole[[a, b, c, d]]
                    area = _cross(chosen[2] - chosen[0], chosen[3] - chosen[1])
                    if area > largest:
                        best, largest = chosen, area
    return best


def _cross(a: Array, b: Array) -> float:
    return float(a[0] * b[1] - a[1] * b[0])
