"""Registration: how far the robot's estimate has drifted since the ground was mapped, seen by the ground itself.

The regions of the newest frame and those of earlier ones are painted into rasters of heights; the shift in x, y, z and
the turn about the vertical that bring the new ground onto the old are found by Gauss-Newton on blurred heights, coarse
to fine (Lucas and Kanade, 1981), with weights that fall off for what does not fit (Geman and McClure), so that a block
that was moved does not pull. Roll and pitch are left alone: gravity is known. What the ground does not show, such as a
shift along a floor without features, is up to a prior: the drift goes on as it did. The prior yields to a jump. What
a camera mounted askew makes of the robot's own motion is told from drift, and is not booked as such.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import cv2
import numpy as np

from skills.geometry.camera import DepthImage
from skills.geometry.pose import IDENTITY, Array, Pose, readonly, rotation_z
from skills.kernels import kernel
from skills.regions.apparent_motion import ApparentMotion, causes_of, shift_by
from skills.regions.camera_error import CameraError
from skills.regions.height_reference import HeightReference
from skills.regions.planar_region import PlanarRegions
from skills.regions.region_cells import T_RASTER_WORLD, Raster, Window, cells_of
from skills.regions.registration_parameters import RegistrationParameters

# Of each level: width of the blur [m], residual at which the weight is a quarter [m], cells from one to the next that
# is compared, and the change [m, rad] below which the next level takes over.
_LEVELS = ((0.08, 0.10, 2, 2e-3), (0.04, 0.04, 2, 5e-4), (0.02, 0.02, 1, 1e-4))
_ITERATIONS = 6
# A blurred cell is used where this share of its surroundings is known, about as much in both rasters.
_KNOWN_MIN, _KNOWN_CHANGE = 0.4, 0.15
_CELLS_MIN = 100
_PRIOR_MIN = 1e-4
_SHORTEST = 1e-3  # [s]
# A larger surprise in one frame is a jump, which says nothing about what goes on steadily [m] and [rad].
_STEADY = 5e-3


@dataclass(frozen=True, slots=True, eq=False)
class Drift:
    """How a frame lies to the ground known before.

    Attributes:
        T_world_frame: what brings the frame's ground onto the ground known before.
        shift_turn: the same as a shift of the ground in view and a turn about its middle, (4,) [m, m, m, rad].
        apparent_world: the part of the shift that the camera is to blame for, (3,) [m].
        motion: what is known of drift and camera.
        corrected: what of the camera's error has been made good in the frame.
        turn_rate: steady part of the turn [rad/s].
        time: robot time of the frame [s].
        camera_odometry: where the robot estimated the camera, (3,) [m].
        overlap: share of the frame's ground that could be compared.
        reason: why the frame could not say where it is; empty where it could.
    """

    T_world_frame: Pose
    shift_turn: Array
    apparent_world: Array
    motion: ApparentMotion
    corrected: CameraError
    turn_rate: float
    time: float
    camera_odometry: Array
    overlap: float = 0.0
    reason: str = ""

    def __post_init__(self) -> None:
        for name, count in (("shift_turn", 4), ("apparent_world", 3), ("camera_odometry", 3)):
            object.__setattr__(self, name, readonly(getattr(self, name), (count,)))


@dataclass(frozen=True, slots=True, eq=False)
class Corrections:
    """What several frames have corrected, one after the other.

    Attributes:
        T_world: what they have moved all later frames by.
        apparent_world: the part of it that their cameras are to blame for, (3,) [m].
    """

    T_world: Pose = IDENTITY
    apparent_world: Array = field(default_factory=lambda: np.zeros(3))

    def then(self, drift: Drift) -> Corrections:
        """With one more frame."""
        return Corrections(drift.T_world_frame @ self.T_world, self.apparent_world + drift.apparent_world)


def register(
    regions: PlanarRegions,
    image: DepthImage,
    reference: HeightReference | None,
    before: Drift | None,
    since: Corrections,
    corrected: CameraError,
    parameters: RegistrationParameters,
) -> Drift:
    """Find how far the estimate has drifted between the reference and a frame.

    Args:
        regions: of the frame.
        image: the frame; it tells where the camera was believed to be.
        reference: the ground known before; None where there is none.
        before: the drift of the camera's frame before; None where this is its first.
        since: what frames of other cameras have corrected since then.
        corrected: what has been made good in the frame.
        parameters: how far to trust the frame.
    """
    camera = image.T_world_odometry.inverse @ image.T_world_camera.p
    if reference is None or before is None:
        unknown, still = ApparentMotion.unknown(), np.zeros(4)
        reason = "no ground is known yet"
        before = Drift(IDENTITY, still, np.zeros(3), unknown, corrected, 0.0, image.time, camera, 0.0, reason)
    if reference is None:
        return before
    dt = image.time - before.time
    moved = image.T_world_odometry.R @ (camera - before.camera_odometry)
    causes = causes_of(dt, moved, image.T_world_camera.R)
    made_good = causes[:, 3:] @ corrected.vector
    expected = causes @ before.motion.estimate - made_good
    window = _window_of(regions, image, parameters)
    known_already = _as_shift_turn(since.T_world, window)
    predicted = np.append(T_RASTER_WORLD.R @ expected, before.turn_rate * dt) - known_already
    newest, known = window.paint(cells_of(regions.regions, parameters.cell)), reference.cut(window)
    found, overlap, reason = _fit(newest, known, window, predicted, parameters)
    kept = float(np.exp(-dt / parameters.rate_memory))
    surprise = found - predicted
    steady = not reason and dt > 0.0 and bool(np.abs(surprise).max() < _STEADY)
    turn_rate = kept * before.turn_rate + parameters.rate_gain * steady * float(surprise[3]) / max(dt, _SHORTEST)
    seen = T_RASTER_WORLD.R.T @ (found[:3] + known_already[:3]) + made_good
    motion = before.motion.learned(causes, seen, float(steady), kept, parameters)
    apparent = shift_by(motion.camera.less(corrected), causes, parameters) - since.apparent_world
    T_world_frame = _as_pose(found, window)
    return Drift(T_world_frame, found, apparent, motion, corrected, turn_rate, image.time, camera, overlap, reason)


def _window_of(regions: PlanarRegions, image: DepthImage, parameters: RegistrationParameters) -> Window:
    """The part of the raster that a frame shows, within reach of its camera, with a margin for the blur."""
    camera = (T_RASTER_WORLD @ image.T_world_camera.p)[:2]
    points = [(T_RASTER_WORLD @ region.hull_world)[:, :2] for region in regions.regions]
    seen = np.concatenate((*points, camera[None]))
    margin = _LEVELS[0][0]
    low = np.maximum(seen.min(axis=0), camera - parameters.reach) - margin
    high = np.minimum(seen.max(axis=0), camera + parameters.reach) + margin
    return Window.between(low, high, parameters.cell)


def _fit(
    newest: tuple[Raster, Raster],
    known: tuple[Raster, Raster],
    window: Window,
    predicted: Array,
    parameters: RegistrationParameters,
) -> tuple[Array, float, str]:
    """Shift and turn that bring the newest heights onto the known ones, the share compared, and why they do not."""
    shift_turn, A, b = predicted, np.empty((4, 4)), np.empty(4)
    prior = parameters.prior * np.array((1.0, 1.0, 1.0, parameters.prior_turn))
    overlap = 0.0
    for width, scale, stride, converged in _LEVELS:
        rasters = (*_blurred(newest, width / window.cell), *_blurred(known, width / window.cell))
        for _ in range(_ITERATIONS):
            compared, painted, weight, _ = _sum_up(*rasters, window.cell, stride, shift_turn, scale, A, b)
            overlap = compared / max(painted, 1.0)
            if compared * stride**2 < _CELLS_MIN or overlap <= parameters.overlap_min:
                return predicted, overlap, "too little of the ground in view was known before"
            surprise = shift_turn - predicted
            stiff = weight * (prior * _trust(surprise, parameters) + _PRIOR_MIN)
            change = -np.linalg.solve(A + np.diag(stiff), b + stiff * surprise)
            shift_turn = shift_turn + change
            if np.abs(change).max() < converged:
                break
    if np.linalg.norm(shift_turn[:3]) > parameters.shift_max or abs(shift_turn[3]) > parameters.turn_max:
        return predicted, overlap, "the ground in view seems to have moved further than an estimate drifts"
    return shift_turn, overlap, ""


def _trust(surprise: Array, parameters: RegistrationParameters) -> Array:
    """How much each of shift and turn is like drift, (4,): 1 where nothing surprises, less and less for a jump."""
    expected = np.array((*3 * (parameters.prior_shift,), parameters.prior_yaw))
    return 1.0 / (1.0 + (surprise / expected) ** 2) ** 2


def _blurred(raster: tuple[Raster, Raster], width: float) -> tuple[Raster, Raster]:
    """Mean of the known heights around each cell, and how much of its surroundings is known; width in cells."""
    heights, counts = raster
    mask = np.minimum(counts, np.float32(1.0))
    known = cv2.GaussianBlur(mask, (0, 0), width)
    heights = cv2.GaussianBlur(heights * mask, (0, 0), width) / np.maximum(known, np.float32(1e-6))
    return np.asarray(heights, np.float32), np.asarray(known, np.float32)


def _as_pose(shift_turn: Array, window: Window) -> Pose:
    """T_world_frame of a shift and a turn about the middle of the window."""
    if not shift_turn.any():
        return IDENTITY
    R, middle = rotation_z(shift_turn[3]), window.middle
    T_raster = Pose(R, middle - R @ middle + shift_turn[:3])
    return T_RASTER_WORLD.inverse @ T_raster @ T_RASTER_WORLD


def _as_shift_turn(T_world: Pose, window: Window) -> Array:
    """The shift of the middle of the window and the turn that are a pose, (4,)."""
    if T_world is IDENTITY:
        return np.zeros(4)
    T_raster = T_RASTER_WORLD @ T_world @ T_RASTER_WORLD.inverse
    middle = window.middle
    return np.append(T_raster @ middle - middle, T_raster.yaw)


def camera_to_correct(drift: Drift, parameters: RegistrationParameters) -> CameraError | None:
    """What is wrong with the camera, as far as it is known well enough; None where all of it has been made good."""
    smallest = np.repeat((parameters.mount_min, parameters.scale_min), (3, 1))
    known = drift.motion.doubt(parameters) <= parameters.camera_doubt * smallest
    sure = np.repeat((known[:3].all(), known[3]), (3, 1))
    error, before = drift.motion.camera.vector, drift.corrected.vector
    if not parameters.correct_camera or not (sure & (np.abs(error - before) > smallest)).any():
        return None
    error = np.where(sure, error, before)
    return CameraError(error[:3], float(error[3]))


@kernel
def _sum_up(
    newest: Raster,
    newest_known: Raster,
    reference: Raster,
    reference_known: Raster,
    cell: float,
    stride: int,
    shift_turn: Array,
    scale: float,
    A: Array,
    b: Array,
) -> tuple[float, float, float, float]:
    """Normal equations A change = -b of the residuals; cells compared, cells of the frame, sum of weights, cost."""
    ny, nx = newest.shape
    A[:, :] = 0.0
    b[:] = 0.0
    J = np.empty(4)
    compared, painted, weights, cost = 0.0, 0.0, 0.0, 0.0
    cos, sin = np.cos(shift_turn[3]), np.sin(shift_turn[3])
    middle_x, middle_y = 0.5 * nx * cell, 0.5 * ny * cell
    for row in range(1, ny - 1, stride):
        for column in range(1, nx - 1, stride):
            known = newest_known[row, column]
            if known < _KNOWN_MIN:
                continue
            painted += 1.0
            x, y = (column + 0.5) * cell - middle_x, (row + 0.5) * cell - middle_y
            turned_x, turned_y = cos * x - sin * y, sin * x + cos * y
            u = (turned_x + shift_turn[0] + middle_x) / cell - 0.5
            v = (turned_y + shift_turn[1] + middle_y) / cell - 0.5
            i, j = int(np.floor(v)), int(np.floor(u))
            if i < 0 or j < 0 or i >= ny - 1 or j >= nx - 1:
                continue
            beside = min(newest_known[row, column - 1], newest_known[row, column + 1])
            beside = min(beside, newest_known[row - 1, column], newest_known[row + 1, column])
            k00, k01 = reference_known[i, j], reference_known[i, j + 1]
            k10, k11 = reference_known[i + 1, j], reference_known[i + 1, j + 1]
            if min(beside, k00, k01, k10, k11) < _KNOWN_MIN:
                continue
            f, g = u - j, v - i
            there = (k00 * (1 - f) + k01 * f) * (1 - g) + (k10 * (1 - f) + k11 * f) * g
            # Where one raster knows more than the other, as at the edge of a shadow, blurred heights differ by that.
            if abs(there - known) > _KNOWN_CHANGE:
                continue
            h00, h01 = reference[i, j], reference[i, j + 1]
            h10, h11 = reference[i + 1, j], reference[i + 1, j + 1]
            height = (h00 * (1 - f) + h01 * f) * (1 - g) + (h10 * (1 - f) + h11 * f) * g
            own_x = (newest[row, column + 1] - newest[row, column - 1]) / (2 * cell)
            own_y = (newest[row + 1, column] - newest[row - 1, column]) / (2 * cell)
            # The mean of both rasters' slopes converges faster than either.
            slope_x = 0.5 * (((h01 - h00) * (1 - g) + (h11 - h10) * g) / cell + cos * own_x - sin * own_y)
            slope_y = 0.5 * (((h10 - h00) * (1 - f) + (h11 - h01) * f) / cell + sin * own_x + cos * own_y)
            residual = newest[row, column] + shift_turn[2] - height
            square = (residual / scale) ** 2
            weight = 1.0 / (1.0 + square) ** 2
            J[0], J[1], J[2], J[3] = -slope_x, -slope_y, 1.0, slope_x * turned_y - slope_y * turned_x
            for k in range(4):
                b[k] += weight * J[k] * residual
                for m in range(4):
                    A[k, m] += weight * J[k] * J[m]
            compared += 1.0
            weights += weight
            cost += square / (1.0 + square)
    return compared, painted, weights, cost
