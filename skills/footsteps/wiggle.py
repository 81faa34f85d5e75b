"""Wiggle: after the search each step moves inside its region, off the edges, as far as its limits allow.

The least move of the sole, two ways and a turn, that keeps its corners a margin inside the outline is a quadratic
program in three variables, solved exactly by the dual method of Goldfarb and Idnani (1983). Where the margin cannot be
had, it is the largest that can. The idea is that of Griffin et al., "Footstep planning for autonomous walking over
rough terrain" (2019).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from skills.geometry.pose import Array
from skills.kernels import kernel

# A sole's turn is weighed by this arm, so that a move and a turn count alike [m].
_ARM = 0.15
_TRIALS = 8
_TINY = 1e-10


@kernel
def sole_margin(outline: Array, sole: Array, target: float) -> float:
    """The least distance of a sole's corners from the edges of its region, at most a target; see `wiggle_sole`."""
    least = target
    for e in range(outline.shape[0]):
        for c in range(sole.shape[0]):
            least = min(least, outline[e, 2] - outline[e, 0] * sole[c, 0] - outline[e, 1] * sole[c, 1])
    return least


@kernel
def wiggle_sole(outline: Array, sole: Array, target: float, most_move: float, most_turn: float, move: Array) -> float:
    """Find the least move of a sole that keeps its corners `target` inside the outline of its region.

    Args:
        outline: (N, 3) edges that count: unit outward normal x, y and offset, in the sole's frame.
        sole: (4, 2) corners of the sole in its frame [m].
        target: margin wanted [m].
        most_move: largest move along each axis [m].
        most_turn: largest turn [rad].
        move: (3,) is filled with the move along x and y [m] and the turn [rad].

    Returns:
        The margin that the move brings, at most the target; negative where the sole stays over an edge.
    """
    count = 0
    rows = np.empty((outline.shape[0] * sole.shape[0] + 6, 3))
    offsets = np.empty(rows.shape[0])
    least = target
    for e in range(outline.shape[0]):
        for c in range(sole.shape[0]):
            nx, ny = outline[e, 0], outline[e, 1]
            rows[count, 0], rows[count, 1] = nx, ny
            rows[count, 2] = (ny * sole[c, 0] - nx * sole[c, 1]) / _ARM
            offsets[count] = outline[e, 2] - nx * sole[c, 0] - ny * sole[c, 1]
            least = min(least, offsets[count])
            count += 1
    edges = count
    for k in range(3):
        for sign in range(2):
            rows[count, 0], rows[count, 1], rows[count, 2] = 0.0, 0.0, 0.0
            rows[count, k] = 2.0 * sign - 1.0
            offsets[count] = most_move if k < 2 else most_turn * _ARM
            count += 1
    move[0], move[1], move[2] = 0.0, 0.0, 0.0
    if least >= target:
        return target
    best, low, high = least, least, target
    trial = np.empty(3)
    for k in range(_TRIALS):
        margin = target if k == 0 else 0.5 * (low + high)
        if _least_move(rows, offsets, edges, count, margin, trial):
            best = low = margin
            move[0], move[1], move[2] = trial[0], trial[1], trial[2] / _ARM
            if k == 0:
                break
        else:
            high = margin
    return best


@kernel
def _least_move(rows: Array, offsets: Array, edges: int, count: int, margin: float, x: Array) -> bool:
    """The shortest x with rows x <= offsets, less the margin for the first `edges` of them; False where none is."""
    active, weights = np.empty(3, np.int64), np.zeros(4)
    ratios, way = np.empty(3), np.empty(3)
    size = 0
    x[0], x[1], x[2] = 0.0, 0.0, 0.0
    for _ in range(10 * count):
        worst, entering = _TINY, -1
        for i in range(count):
            over = rows[i, 0] * x[0] + rows[i, 1] * x[1] + rows[i, 2] * x[2] - offsets[i]
            over += margin if i < edges else 0.0
            if over > worst:
                worst, entering = over, i
        if entering < 0:
            return True
        weights[size] = 0.0
        while True:
            _project(rows, active, size, entering, ratios, way)
            length = way[0] * way[0] + way[1] * way[1] + way[2] * way[2]
            step, leaving = np.inf, -1
            for k in range(size):
                if ratios[k] > _TINY and weights[k] / ratios[k] < step:
                    step, leaving = weights[k] / ratios[k], k
            whole = worst / length if length > _TINY else np.inf
            if step == np.inf and whole == np.inf:
                return False
            taken = min(step, whole)
            for k in range(3):
                x[k] -= taken * way[k] if length > _TINY else 0.0
            for k in range(size):
                weights[k] -= taken * ratios[k]
            weights[size] += taken
            if whole <= step:
                active[size] = entering
                size += 1
                break
            worst -= taken * length
            for k in range(leaving, size):
                weights[k] = weights[k + 1]
                if k + 1 < size:
                    active[k] = active[k + 1]
            size -= 1
    return False


@kernel
def _project(rows: Array, active: NDArray[np.int64], size: int, entering: int, ratios: Array, way: Array) -> None:
    """Split a row into what active rows span, with its ratios to them, and the rest (Gram-Schmidt and back)."""
    basis, upper, along = np.empty((3, 3)), np.zeros((3, 3)), np.empty(3)
    for k in range(3):
        way[k] = rows[entering, k]
    for k in range(size):
        for j in range(3):
            basis[k, j] = rows[active[k], j]
        for m in range(k):
            dot = basis[k, 0] * basis[m, 0] + basis[k, 1] * basis[m, 1] + basis[k, 2] * basis[m, 2]
            upper[m, k] = dot
            for j in range(3):
                basis[k, j] -= dot * basis[m, j]
        norm = np.sqrt(basis[k, 0] ** 2 + basis[k, 1] ** 2 + basis[k, 2] ** 2)
        upper[k, k] = norm
        for j in range(3):
            basis[k, j] /= norm
        along[k] = way[0] * basis[k, 0] + way[1] * basis[k, 1] + way[2] * basis[k, 2]
        for j in range(3):
            way[j] -= along[k] * basis[k, j]
    for k in range(size - 1, -1, -1):
        ratios[k] = along[k]
        for m in range(k + 1, size):
            ratios[k] -= upper[k, m] * ratios[m]
        ratios[k] /= upper[k, k]
