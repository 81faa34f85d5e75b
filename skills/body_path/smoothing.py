"""From the points of a search to a smooth way: fewer corners, then downhill on the same cost plus that of curvature.

First the points that are needed are chosen: of all ways that join points of the search by straight motions, the
cheapest. Then points at equal distances move sideways, one after another, each down the gradient of the cost of its two
motions and of the curvature at it and its neighbours. A move that costs more, or on which the body does not fit, is not
made, so that the way only becomes better. It is done at a wide spacing first, where a few moves bend the whole way.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from skills.body_path.path_cost import density, first_collision, motion_cost, motion_fits
from skills.footsteps.records import Records
from skills.geometry.pose import Array
from skills.kernels import kernel

_JOIN = 20  # Straight motions are tried over so many points of the search.
_TRIES = 3  # A move that makes it worse is halved so often.
_FIRST_MOVE, _LONGEST_MOVE, _SHORTEST_MOVE = 0.2, 0.5, 0.01  # in spacings


@kernel
def choose_points(layers: Array, cells: NDArray[np.float32], scale: Records, points: Array) -> Array:
    """The cheapest way over some of the points (N, 2), from the first to the last, by dynamic programming."""
    n = len(points)
    costs, parents = np.full(n, np.inf), np.zeros(n, np.int64)
    costs[0] = 0.0
    for k in range(1, n):
        # The motion from the point before is part of the way, also where a start is left that is not free.
        costs[k] = costs[k - 1] + motion_cost(layers, scale, *_both(points, k - 1, k))
        parents[k] = k - 1
        for i in range(max(k - _JOIN, 0), k - 1):
            ends = _both(points, i, k)
            through = costs[i] + motion_cost(layers, scale, *ends)
            if through < costs[k] and motion_fits(layers, cells, scale, *ends):
                costs[k], parents[k] = through, i
    count, k = 1, n - 1
    while k > 0:
        count += 1
        k = parents[k]
    chosen = np.empty((count, 2))
    k = n - 1
    for index in range(count - 1, -1, -1):
        chosen[index] = points[k]
        k = parents[k]
    return chosen


@kernel
def _both(points: Array, i: int, k: int) -> tuple[float, float, float, float]:
    return points[i, 0], points[i, 1], points[k, 0], points[k, 1]


@kernel
def smooth(
    layers: Array,
    cells: NDArray[np.float32],
    scale: Records,
    points: Array,
    curvature_weight: float,
    spacing: float,
    sweeps: int,
) -> Array:
    """A smooth way with the ends of another (N, 2).

    Args:
        layers: of the ground.
        cells: of the height map.
        scale: one `SCALE`.
        points: the way.
        curvature_weight: cost of a metre with a curvature of 1/m [m^2].
        spacing: of the points at the end [m]; it is begun at four times that.
        sweeps: over all points at each spacing.
    """
    way = points
    for widening in (4.0, 2.0, 1.0):
        way = resample(layers, cells, scale, way, widening * spacing)
        moves = np.full(len(way), _FIRST_MOVE * spacing)
        for _ in range(sweeps):
            for k in range(1, len(way) - 1):
                moves[k] = _move(layers, cells, scale, way, k, curvature_weight, moves[k], spacing)
    return way


@kernel
def resample(layers: Array, cells: NDArray[np.float32], scale: Records, points: Array, spacing: float) -> Array:
    """Points on a way (N, 2) at equal distances near a spacing; corners that cannot be cut stay points."""
    out = np.empty((0, 2))
    first = 0
    while first < len(points) - 1:
        last = len(points) - 1
        while True:
            piece = _equally_spaced(points[first : last + 1], spacing)
            if last == first + 1 or _fits_everywhere(layers, cells, scale, piece):
                break
            last = first + (last - first) // 2
        out = piece if len(out) == 0 else np.concatenate((out[:-1], piece))
        first = last
    return out


@kernel
def _equally_spaced(points: Array, spacing: float) -> Array:
    lengths = np.zeros(len(points))
    for k in range(1, len(points)):
        lengths[k] = lengths[k - 1] + np.sqrt(
            (points[k, 0] - points[k - 1, 0]) ** 2 + (points[k, 1] - points[k - 1, 1]) ** 2
        )
    count = max(1, int(np.ceil(lengths[-1] / spacing - 1e-6)))
    out = np.empty((count + 1, 2))
    out[0], out[count] = points[0], points[-1]
    at = 1
    for k in range(1, count):
        along = lengths[-1] * k / count
        while lengths[at] < along:
            at += 1
        share = (along - lengths[at - 1]) / (lengths[at] - lengths[at - 1])
        for axis in range(2):
            out[k, axis] = points[at - 1, axis] + share * (points[at, axis] - points[at - 1, axis])
    return out


@kernel
def _fits_everywhere(layers: Array, cells: NDArray[np.float32], scale: Records, points: Array) -> bool:
    return first_collision(layers, cells, scale, points) == len(points) - 1


@kernel
def _move(
    layers: Array,
    cells: NDArray[np.float32],
    scale: Records,
    way: Array,
    k: int,
    curvature_weight: float,
    move: float,
    spacing: float,
) -> float:
    """Move one point sideways, down the gradient; how far it may move next time."""
    chord_x, chord_y = way[k + 1, 0] - way[k - 1, 0], way[k + 1, 1] - way[k - 1, 1]
    chord = np.sqrt(chord_x * chord_x + chord_y * chord_y)
    if chord < 1e-6:
        return move
    side_x, side_y = -chord_y / chord, chord_x / chord
    cost, by_x, by_y = cost_around(layers, scale, way, k, curvature_weight)
    slope = by_x * side_x + by_y * side_y
    if slope == 0.0:
        return move
    x, y = way[k, 0], way[k, 1]
    was_free = _free_around(layers, cells, scale, way, k)
    for _ in range(_TRIES):
        step = -np.sign(slope) * move
        way[k, 0], way[k, 1] = x + step * side_x, y + step * side_y
        now, _, _ = cost_around(layers, scale, way, k, curvature_weight)
        if now < cost and (not was_free or _free_around(layers, cells, scale, way, k)):
            return min(1.5 * move, _LONGEST_MOVE * spacing)
        move *= 0.4
    way[k, 0], way[k, 1] = x, y
    return max(move, _SHORTEST_MOVE * spacing)


@kernel
def _free_around(layers: Array, cells: NDArray[np.float32], scale: Records, way: Array, k: int) -> bool:
    return motion_fits(layers, cells, scale, *_both(way, k - 1, k)) and motion_fits(
        layers, cells, scale, *_both(way, k, k + 1)
    )


@kernel
def cost_around(
    layers: Array, scale: Records, way: Array, k: int, curvature_weight: float
) -> tuple[float, float, float]:
    """What of a way's cost depends on point k between its ends, and its derivatives by x and y of the point."""
    before, _, _, before_x, before_y = _motion_gradient(layers, scale, *_both(way, k - 1, k))
    after, after_x, after_y, _, _ = _motion_gradient(layers, scale, *_both(way, k, k + 1))
    cost, by_x, by_y = before + after, before_x + after_x, before_y + after_y
    for corner in range(max(k - 1, 1), min(k + 2, len(way) - 1)):
        bend, bend_x, bend_y = _curvature(way, corner, k)
        cost += curvature_weight * bend
        by_x += curvature_weight * bend_x
        by_y += curvature_weight * bend_y
    return cost, by_x, by_y


@kernel
def _motion_gradient(
    layers: Array, scale: Records, x: float, y: float, to_x: float, to_y: float
) -> tuple[float, float, float, float, float]:
    """Cost of a straight motion, as `motion_cost` has it, and its derivatives by x and y of both ends."""
    dx, dy = to_x - x, to_y - y
    length = np.sqrt(dx * dx + dy * dy)
    if length < 1e-9:
        return 0.0, 0.0, 0.0, 0.0, 0.0
    cos, sin = dx / length, dy / length
    pieces = int(np.ceil(length / scale.piece - 1e-9))
    mean, by_turn = 0.0, 0.0
    from_x, from_y, end_x, end_y = 0.0, 0.0, 0.0, 0.0
    for k in range(pieces + 1):
        share = k / pieces
        weight = (0.5 if k == 0 or k == pieces else 1.0) / pieces
        there, by_x, by_y, by_heading = density(layers, scale, x + dx * share, y + dy * share, cos, sin)
        mean += weight * there
        by_turn += weight * by_heading
        from_x += weight * (1.0 - share) * by_x
        from_y += weight * (1.0 - share) * by_y
        end_x += weight * share * by_x
        end_y += weight * share * by_y
    # A shift of the end turns the motion by its part across, over the length; both cancel in the cost.
    turn_x, turn_y = -sin * by_turn, cos * by_turn
    return (
        length * mean,
        length * from_x - cos * mean - turn_x,
        length * from_y - sin * mean - turn_y,
        length * end_x + cos * mean + turn_x,
        length * end_y + sin * mean + turn_y,
    )


@kernel
def _curvature(way: Array, corner: int, k: int) -> tuple[float, float, float]:
    """Integral of the squared curvature around a corner, and its derivatives by x and y of point k.

    The curvature is the second difference over the squared mean length of both motions.
    """
    ax, ay = way[corner, 0] - way[corner - 1, 0], way[corner, 1] - way[corner - 1, 1]
    bx, by = way[corner + 1, 0] - way[corner, 0], way[corner + 1, 1] - way[corner, 1]
    a, b = np.sqrt(ax * ax + ay * ay), np.sqrt(bx * bx + by * by)
    if a < 1e-6 or b < 1e-6:
        return 0.0, 0.0, 0.0
    mean = 0.5 * (a + b)
    # The difference of the two directions.
    turn_x, turn_y = bx / b - ax / a, by / b - ay / a
    value = (turn_x * turn_x + turn_y * turn_y) / mean
    # How the directions and lengths change with the point: +1 where a motion ends at it, -1 where it begins there.
    ends_a, ends_b = 0.0, 0.0
    if k == corner:
        ends_a, ends_b = 1.0, -1.0
    elif k == corner - 1:
        ends_a = -1.0
    else:
        ends_b = 1.0
    across_a, across_b = (turn_x * -ay + turn_y * ax) / a, (turn_x * -by + turn_y * bx) / b
    by_x = 2.0 / mean * (ends_b * across_b * -by / (b * b) - ends_a * across_a * -ay / (a * a))
    by_y = 2.0 / mean * (ends_b * across_b * bx / (b * b) - ends_a * across_a * ax / (a * a))
    shrink = -0.5 * value / mean
    by_x += shrink * (ends_a * ax / a + ends_b * bx / b)
    by_y += shrink * (ends_a * ay / a + ends_b * by / b)
    return value, by_x, by_y
