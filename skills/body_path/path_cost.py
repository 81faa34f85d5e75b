"""What a way of the body costs and whether the body fits: the one source that all planners and the smoothing ask.

The cost of a way is its length, each metre weighed by the ground there: by the footholds to the left and the right,
the roll that the ground asks of the body, the incline beyond that from start to goal (McCrory et al., 2022), and the
distance from obstacles. The body walks forward, so its heading is that of the way. A motion is straight; it is cut
into pieces, and the cost of a piece is its length times the mean of the density at both ends.

The body fits where nothing in its box rises further above the ground under it than the box clears.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from skills.body_path.ground_layers import AWAY, DISTANCE, FOOTHOLD, GROUND, SLOPE_X, SLOPE_Y, TOP
from skills.footsteps.records import Records
from skills.geometry.pose import Array
from skills.kernels import kernel, leaf_kernel

_LEAST_BOTH = 1e-4  # Below this the geometric mean of two footholds has no useful slope.


@leaf_kernel
def look_up(layers: Array, layer: int, u: float, v: float) -> tuple[float, float, float]:
    """A layer between the centres of four cells, and how it changes along u and v.

    Args:
        layers: all layers.
        layer: which one.
        u: column, with a fraction; what lies outside has the value at the border.
        v: row, likewise.
    """
    rows, columns = layers.shape[1], layers.shape[2]
    u_in, v_in = min(max(u, 0.0), columns - 1.0), min(max(v, 0.0), rows - 1.0)
    j, i = min(int(u_in), columns - 2), min(int(v_in), rows - 2)
    s, t = u_in - j, v_in - i
    low_left, low_right = layers[layer, i, j], layers[layer, i, j + 1]
    high_left, high_right = layers[layer, i + 1, j], layers[layer, i + 1, j + 1]
    low, high = low_left + s * (low_right - low_left), high_left + s * (high_right - high_left)
    along_u = (1.0 - t) * (low_right - low_left) + t * (high_right - high_left)
    return low + t * (high - low), along_u if u_in == u else 0.0, high - low if v_in == v else 0.0


@leaf_kernel
def density(
    layers: Array, scale: Records, x: float, y: float, cos: float, sin: float
) -> tuple[float, float, float, float]:
    """Cost of a metre at a place with a heading, and its derivatives by x, y and the heading.

    Args:
        layers: of the ground.
        scale: one `SCALE`.
        x: of the body's middle [m].
        y: likewise.
        cos: of the heading.
        sin: likewise.
    """
    per_metre = 1.0 / scale.spacing
    u, v = (x - scale.x) * per_metre, (y - scale.y) * per_metre
    half = scale.half_stance * per_metre
    cost, by_u, by_v, by_heading = 1.0, 0.0, 0.0, 0.0

    # The feet stand to both sides, half a stance from the middle.
    left, left_u, left_v = look_up(layers, FOOTHOLD, u - half * sin, v + half * cos)
    right, right_u, right_v = look_up(layers, FOOTHOLD, u + half * sin, v - half * cos)
    left_turn, right_turn = -half * (cos * left_u + sin * left_v), half * (cos * right_u + sin * right_v)
    if left >= right:
        better, better_u, better_v, better_turn = left, left_u, left_v, left_turn
    else:
        better, better_u, better_v, better_turn = right, right_u, right_v, right_turn
    both = np.sqrt(max(left * right, _LEAST_BOTH))
    by_left, by_right = (0.5 * right / both, 0.5 * left / both) if left * right > _LEAST_BOTH else (0.0, 0.0)
    cost += scale.stance_weight * (1.0 - better) + scale.step_weight * (1.0 - both)
    by_u -= scale.stance_weight * better_u + scale.step_weight * (by_left * left_u + by_right * right_u)
    by_v -= scale.stance_weight * better_v + scale.step_weight * (by_left * left_v + by_right * right_v)
    by_heading -= scale.stance_weight * better_turn + scale.step_weight * (by_left * left_turn + by_right * right_turn)

    a, a_u, a_v = look_up(layers, SLOPE_X, u, v)
    b, b_u, b_v = look_up(layers, SLOPE_Y, u, v)
    roll, incline = -sin * a + cos * b, cos * a + sin * b
    steep = (abs(roll) - scale.roll_deadband) / (scale.roll_most - scale.roll_deadband)
    if steep > 0.0:
        cost += scale.roll_weight * min(steep, 1.0)
        if steep < 1.0:
            weight = np.sign(roll) * scale.roll_weight / (scale.roll_most - scale.roll_deadband)
            by_u += weight * (-sin * a_u + cos * b_u)
            by_v += weight * (-sin * a_v + cos * b_v)
            by_heading -= weight * incline
    if incline > scale.incline_free:
        cost += scale.incline_weight * (incline - scale.incline_free)
        by_u += scale.incline_weight * (cos * a_u + sin * b_u)
        by_v += scale.incline_weight * (cos * a_v + sin * b_v)
        by_heading += scale.incline_weight * roll

    distance, distance_u, distance_v = look_up(layers, DISTANCE, u, v)
    if distance < scale.far:
        closeness = min((scale.far - distance) / (scale.far - scale.near), 1.0)
        cost += scale.clearance_weight * closeness * closeness
        if closeness < 1.0:
            weight = -2.0 * scale.clearance_weight * closeness / (scale.far - scale.near)
            by_u += weight * distance_u
            by_v += weight * distance_v

    away, away_u, away_v = look_up(layers, AWAY, u, v)
    dearer = 1.0 + scale.away_weight * away
    by_u, by_v = dearer * by_u + cost * scale.away_weight * away_u, dearer * by_v + cost * scale.away_weight * away_v
    return cost * dearer, by_u * per_metre, by_v * per_metre, by_heading * dearer


@leaf_kernel
def motion_cost(layers: Array, scale: Records, x: float, y: float, to_x: float, to_y: float) -> float:
    """Cost of walking straight from one place to another [m of good ground]."""
    dx, dy = to_x - x, to_y - y
    length = np.sqrt(dx * dx + dy * dy)
    if length < 1e-9:
        return 0.0
    cos, sin = dx / length, dy / length
    pieces = int(np.ceil(length / scale.piece - 1e-9))
    total = 0.0
    for k in range(pieces + 1):
        there, _, _, _ = density(layers, scale, x + dx * k / pieces, y + dy * k / pieces, cos, sin)
        total += 0.5 * there if k == 0 or k == pieces else there
    return total * length / pieces


@leaf_kernel
def body_fits(
    layers: Array, cells: NDArray[np.float32], scale: Records, x: float, y: float, cos: float, sin: float
) -> bool:
    """Whether nothing is in the body's box at a place with a heading."""
    u, v = (x - scale.x) / scale.spacing, (y - scale.y) / scale.spacing
    ground, _, _ = look_up(layers, GROUND, u, v)
    limit = ground + scale.ground_clearance
    i = int(min(max(np.round(v), 0.0), layers.shape[1] - 1.0))
    j = int(min(max(np.round(u), 0.0), layers.shape[2] - 1.0))
    if layers[TOP, i, j] <= limit:
        return True
    # A cell counts when its centre lies within half a cell of the box.
    depth, width = scale.half_depth + 0.5 * scale.resolution, scale.half_width + 0.5 * scale.resolution
    reach_x, reach_y = abs(cos) * depth + abs(sin) * width, abs(sin) * depth + abs(cos) * width
    first_column = max(int(np.floor((x - reach_x - scale.cells_x) / scale.resolution)), 0)
    last_column = min(int(np.floor((x + reach_x - scale.cells_x) / scale.resolution)), cells.shape[1] - 1)
    first_row = max(int(np.floor((y - reach_y - scale.cells_y) / scale.resolution)), 0)
    last_row = min(int(np.floor((y + reach_y - scale.cells_y) / scale.resolution)), cells.shape[0] - 1)
    for row in range(first_row, last_row + 1):
        dy = scale.cells_y + (row + 0.5) * scale.resolution - y
        for column in range(first_column, last_column + 1):
            if cells[row, column] > limit:
                dx = scale.cells_x + (column + 0.5) * scale.resolution - x
                if abs(cos * dx + sin * dy) <= depth and abs(cos * dy - sin * dx) <= width:
                    return False
    return True


@leaf_kernel
def motion_fits(
    layers: Array, cells: NDArray[np.float32], scale: Records, x: float, y: float, to_x: float, to_y: float
) -> bool:
    """Whether the body can walk straight from one place to another.

    It is looked at twice as often as the cost. The box is longer than the way between two looks, so that together they
    cover all that it sweeps.
    """
    dx, dy = to_x - x, to_y - y
    length = np.sqrt(dx * dx + dy * dy)
    if length < 1e-9:
        return True
    cos, sin = dx / length, dy / length
    looks = int(np.ceil(2.0 * length / scale.piece - 1e-9))
    for k in range(looks + 1):
        if not body_fits(layers, cells, scale, x + dx * k / looks, y + dy * k / looks, cos, sin):
            return False
    return True


@kernel
def way_cost(layers: Array, scale: Records, points: Array) -> float:
    """Cost of a polyline (N, 2)."""
    total = 0.0
    for k in range(len(points) - 1):
        total += motion_cost(layers, scale, points[k, 0], points[k, 1], points[k + 1, 0], points[k + 1, 1])
    return total


@kernel
def first_collision(layers: Array, cells: NDArray[np.float32], scale: Records, points: Array) -> int:
    """The first piece of a polyline (N, 2) on which the body does not fit; N - 1 where it fits everywhere."""
    for k in range(len(points) - 1):
        if not motion_fits(layers, cells, scale, points[k, 0], points[k, 1], points[k + 1, 0], points[k + 1, 1]):
            return k
    return len(points) - 1
