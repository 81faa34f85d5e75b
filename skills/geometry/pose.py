"""Rigid transforms, the one place where a rotation is stored and a quaternion order is chosen.

`T_a_b` maps coordinates in frame b to coordinates in frame a: `p_a = T_a_b @ p_b`, `T_a_c = T_a_b @ T_b_c`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]


def readonly(values: ArrayLike, shape: tuple[int | None, ...] | None = None) -> Array:
    """Values as a read-only float64 array; `None` in the shape stands for any length.

    Whoever made an array read-only has promised not to change it; all else is copied.

    Raises:
        ValueError: where the shape does not fit.
    """
    if isinstance(values, np.ndarray) and values.dtype == np.float64 and not values.flags.writeable:
        array = values
    else:
        array = np.array(values, dtype=np.float64)
    # Most shapes are simply equal, and this runs for every pose that is made.
    if (
        shape is not None
        and array.shape != shape
        and (array.ndim != len(shape) or any(n is not None and n != m for n, m in zip(shape, array.shape, strict=True)))
    ):
        raise ValueError(f"got an array of shape {array.shape}, needs {shape}")
    array.flags.writeable = False
    return array


@dataclass(frozen=True, slots=True, eq=False)
class Pose:
    """A rigid transform T_a_b.

    Attributes:
        R: rotation matrix R_a_b, (3, 3).
        p: origin of b in a, (3,) [m].
    """

    R: Array
    p: Array

    def __post_init__(self) -> None:
        object.__setattr__(self, "R", readonly(self.R, (3, 3)))
        object.__setattr__(self, "p", readonly(self.p, (3,)))

    @classmethod
    def identity(cls) -> Pose:
        """The transform that changes nothing."""
        return cls(np.eye(3), np.zeros(3))

    @classmethod
    def from_xyz_rpy(cls, xyz: ArrayLike, rpy: ArrayLike = (0.0, 0.0, 0.0)) -> Pose:
        """Position [m] and roll, pitch, yaw [rad], applied as Rz(yaw) Ry(pitch) Rx(roll)."""
        roll, pitch, yaw = np.asarray(rpy, dtype=np.float64)
        return cls(rotation_z(yaw) @ rotation_y(pitch) @ rotation_x(roll), np.asarray(xyz, dtype=np.float64))

    @classmethod
    def from_quaternion_wxyz(cls, wxyz: ArrayLike, p: ArrayLike) -> Pose:
        """Position [m] and quaternion in MuJoCo's order (w, x, y, z); it is normalised."""
        w, x, y, z = np.asarray(wxyz, dtype=np.float64) / np.linalg.norm(wxyz)
        R = np.array(
            [
                [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
            ]
        )
        return cls(R, np.asarray(p, dtype=np.float64))

    @classmethod
    def from_quaternion_xyzw(cls, xyzw: ArrayLike, p: ArrayLike) -> Pose:
        """Position [m] and quaternion in the order of pinocchio and rerun (x, y, z, w)."""
        x, y, z, w = np.asarray(xyzw, dtype=np.float64)
        return cls.from_quaternion_wxyz((w, x, y, z), p)

    @property
    def quaternion_wxyz(self) -> Array:
        """Unit quaternion (w, x, y, z) with w >= 0."""
        R = self.R
        # The largest of four equivalent pivots keeps the square root away from zero (Shepperd, 1978).
        pivots = np.array([np.trace(R), R[0, 0], R[1, 1], R[2, 2]])
        k = int(np.argmax(pivots))
        if k == 0:
            q = np.array([1 + pivots[0], R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]])
        else:
            i, j, m = k - 1, k % 3, (k + 1) % 3
            q = np.empty(4)
            q[0] = R[m, j] - R[j, m]
            q[1 + i] = 1 + R[i, i] - R[j, j] - R[m, m]
            q[1 + j] = R[j, i] + R[i, j]
            q[1 + m] = R[m, i] + R[i, m]
        q /= np.linalg.norm(q)
        return q if q[0] >= 0 else -q

    @property
    def quaternion_xyzw(self) -> Array:
        """Unit quaternion (x, y, z, w) with w >= 0."""
        return np.roll(self.quaternion_wxyz, -1)

    @property
    def yaw(self) -> float:
        """Heading of the x axis in the horizontal plane [rad]."""
        return float(np.arctan2(self.R[1, 0], self.R[0, 0]))

    @property
    def inverse(self) -> Pose:
        """T_b_a."""
        return Pose(self.R.T, -self.R.T @ self.p)

    @overload
    def __matmul__(self, other: Pose) -> Pose: ...
    @overload
    def __matmul__(self, other: Array) -> Array: ...
    def __matmul__(self, other: Pose | Array) -> Pose | Array:
        """T_a_b @ T_b_c, or T_a_b applied to points p_b of shape (3,) or (N, 3)."""
        if isinstance(other, Pose):
            return Pose(self.R @ other.R, self.R @ other.p + self.p)
        return other @ self.R.T + self.p


IDENTITY = Pose.identity()


def rotation_about(vector: ArrayLike) -> Array:
    """Rotation about a vector by its length [rad] (Rodrigues, 1840)."""
    x, y, z = np.asarray(vector, dtype=np.float64)
    angle = float(np.sqrt(x * x + y * y + z * z))
    K = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    # sin(a) / a and (1 - cos(a)) / a^2, which numpy's sinc knows at 0 too.
    return np.eye(3) + np.sinc(angle / np.pi) * K + 0.5 * np.sinc(0.5 * angle / np.pi) ** 2 * (K @ K)


def rotation_x(angle: float) -> Array:
    """Rotation about x by an angle [rad]."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])


def rotation_y(angle: float) -> Array:
    """Rotation about y by an angle [rad]."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])


def rotation_z(angle: float) -> Array:
    """Rotation about z by an angle [rad]."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def cross(a: Array, b: Array) -> Array:
    """Cross product of two vectors (3,), or of the columns of (3, N) with one; much faster than numpy's for one."""
    return np.array((a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]))


def wrap_angle(angle: float) -> float:
    """The same angle within [-pi, pi)."""
    return float((angle + np.pi) % (2 * np.pi) - np.pi)
