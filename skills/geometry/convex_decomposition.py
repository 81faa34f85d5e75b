"""Approximate convex decomposition of polygons with holes.

After Lien and Amato, "Approximate convex decomposition of polygons" (2006), with diagonals as cuts: holes are joined to
the outline by doubled edges, and pieces are cut at their deepest notch until what is left of notches is shallow and
small. The hulls of the pieces are the parts: they cover all of the polygon and hardly more.
"""

from __future__ import annotations

from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from skills.geometry.polygon import turn
from skills.geometry.pose import Array
from skills.kernels import leaf_kernel

Indices = NDArray[np.int64]

# Notches of a piece may be filled up to this share of its own area, and of a tenth of the whole polygon's: what all
# parts cover too much stays below a hundredth of the polygon.
_FILLED_SHARE = 0.005
_SMALL_PIECE = 0.1


def convex_parts(polygon: Array, tolerance: float, holes: tuple[Array, ...] = ()) -> tuple[Array, ...]:
    """Convex polygons that together cover a simple polygon.

    A notch no deeper than the tolerance and of little area is filled rather than cut, so the parts cover all of the
    polygon, stay within the tolerance of it, and overlap no more than that.

    Args:
        polygon: outline, (N, 2) counter-clockwise.
        tolerance: greatest depth of a notch that is filled [m].
        holes: outlines of holes, each (M, 2) clockwise, inside the polygon and apart from each other.
    """
    rings = (polygon, *holes)
    vertices = np.array(np.concatenate(rings), dtype=np.float64)
    room = decomposing_room(len(vertices), len(rings))
    corners, ends = np.empty((len(room.stack), 2)), np.empty(len(room.sizes), np.int64)
    count = decompose(vertices, np.cumsum([len(ring) for ring in rings]), tolerance, room, 0, corners, ends)
    return tuple(corners[a:b] for a, b in pairwise((0, *ends[:count].tolist())))


class DecomposingRoom(NamedTuple):
    """Room for work: pieces, their sizes, the piece at hand and its hull, and which holes are joined to the outline."""

    stack: Indices
    sizes: Indices
    piece: Indices
    hull: Indices
    joined: NDArray[np.bool_]


def decomposing_room(vertices: int, rings: int) -> DecomposingRoom:
    """Room for a polygon of so many vertices and rings.

    Its parts have no more corners than the stack has places, and no more ends than the sizes.
    """
    # Every bridge and every cut repeats two vertices, and there are fewer cuts than vertices.
    capacity = vertices + 2 * rings
    return DecomposingRoom(
        np.empty(4 * capacity + 8, np.int64),
        np.empty(2 * capacity + 8, np.int64),
        np.empty(capacity, np.int64),
        np.empty(capacity, np.int64),
        np.empty(rings, np.bool_),
    )


@leaf_kernel
def decompose(
    vertices: Array,
    ring_ends: Indices,
    tolerance: float,
    room: DecomposingRoom,
    begin: int,
    corners: Array,
    ends: Indices,
) -> int:
    """Convex parts of an outline and its holes.

    Args:
        vertices: of the outline and then of the holes, (N, 2).
        ring_ends: the end of each, (R,); rings without vertices are no holes.
        tolerance: greatest depth of a notch that is filled [m].
        room: for at least N vertices in R rings.
        begin: where the parts begin in `corners`.
        corners: out, of the parts, stacked.
        ends: out, the end of each part in `corners`.

    Returns:
        How many parts there are.
    """
    stack, sizes, piece, hull = room.stack, room.sizes, room.piece, room.hull
    sizes[0] = _bridged(vertices, ring_ends, stack, hull, room.joined)
    whole = 0.5 * _doubled_area(vertices, stack, sizes[0])
    top, depth, written, parts = sizes[0], 1, begin, 0
    while depth > 0:
        depth -= 1
        m = sizes[depth]
        top -= m
        for k in range(m):
            piece[k] = stack[top + k]
        count = _hull_of_piece(vertices, piece, m, hull)
        spare = _spare_area(vertices, piece, m, hull, count)
        shallow = tolerance if spare <= _FILLED_SHARE * _SMALL_PIECE * whole else 0.0
        notch = _deepest_notch(vertices, piece, m, hull, count, shallow)
        other = _best_cut(vertices, piece, m, notch) if notch >= 0 else -1
        if other < 0:
            for k in range(count):
                corners[written, 0] = vertices[piece[hull[k]], 0]
                corners[written, 1] = vertices[piece[hull[k]], 1]
                written += 1
            ends[parts] = written
            parts += 1
            continue
        for first, last in ((notch, other), (other, notch)):
            size = (last - first) % m + 1
            for k in range(size):
                stack[top + k] = piece[(first + k) % m]
            top += size
            sizes[depth] = size
            depth += 1
    return parts


@leaf_kernel
def _bridged(vertices: Array, ring_ends: Indices, outline: Indices, loop: Indices, joined: NDArray[np.bool_]) -> int:
    """Write one outline that runs around the polygon and, over doubled edges, around its holes; how many places.

    Loop and joined are room for a number of each vertex and a mark of each ring.
    """
    count = ring_ends[0]
    for k in range(count):
        outline[k] = k
    rings = ring_ends.shape[0]
    for ring in range(rings):
        joined[ring] = False
    for k in range(ring_ends[rings - 1]):
        loop[k] = k
    for _ in range(1, rings):
        # Rightmost holes go first: what is to the right of a hole then belongs to the outline already.
        hole, rightmost = -1, -1
        for ring in range(1, rings):
            for v in range(ring_ends[ring - 1], ring_ends[ring]):
                if not joined[ring] and (rightmost < 0 or vertices[v, 0] > vertices[rightmost, 0]):
                    hole, rightmost = ring, v
        if hole < 0:
            break
        joined[hole] = True
        begin, size = ring_ends[hole - 1], ring_ends[hole] - ring_ends[hole - 1]
        place, least = -1, np.inf
        for k in range(count):
            square = _squared(vertices, outline[k], rightmost)
            if square >= least or not _opens_to(vertices, outline, count, k, rightmost):
                continue
            hidden = _blocked(vertices, outline, count, outline[k], rightmost)
            for ring in range(1, rings):
                if hidden:
                    break
                if not joined[ring] or ring == hole:
                    first = ring_ends[ring - 1]
                    hidden = _blocked(vertices, loop[first:], ring_ends[ring] - first, outline[k], rightmost)
            if not hidden:
                place, least = k, square
        if place < 0:
            continue
        for k in range(count - 1, place - 1, -1):
            outline[k + size + 2] = outline[k]
        for k in range(size + 1):
            outline[place + 1 + k] = begin + (rightmost - begin + k) % size
        count += size + 2
    return count


@leaf_kernel
def _squared(vertices: Array, a: int, b: int) -> float:
    return (vertices[a, 0] - vertices[b, 0]) ** 2 + (vertices[a, 1] - vertices[b, 1]) ** 2


@leaf_kernel
def _doubled_area(vertices: Array, piece: Indices, m: int) -> float:
    area = 0.0
    for k in range(m):
        a, b = piece[k], piece[(k + 1) % m]
        area += vertices[a, 0] * vertices[b, 1] - vertices[b, 0] * vertices[a, 1]
    return area


@leaf_kernel
def _spare_area(vertices: Array, piece: Indices, m: int, hull: Indices, count: int) -> float:
    """How much more a piece's hull covers than the piece and its allowance of filled notches."""
    covered = 0.0
    for k in range(count):
        a, b = piece[hull[k]], piece[hull[(k + 1) % count]]
        covered += vertices[a, 0] * vertices[b, 1] - vertices[b, 0] * vertices[a, 1]
    return float(0.5 * (covered - (1.0 + _FILLED_SHARE) * _doubled_area(vertices, piece, m)))


@leaf_kernel
def _hull_of_piece(vertices: Array, piece: Indices, m: int, hull: Indices) -> int:
    """Places in a piece of its hull's vertices, in its own order (gift wrapping from the lowest x); how many."""
    start = 0
    for i in range(1, m):
        x, least = vertices[piece[i], 0], vertices[piece[start], 0]
        if x < least or (x == least and vertices[piece[i], 1] < vertices[piece[start], 1]):
            start = i
    count, here = 0, start
    while count < m:
        hull[count] = here
        count += 1
        best = -1
        for i in range(m):
            if _squared(vertices, piece[i], piece[here]) == 0.0:
                continue
            side = -1.0 if best < 0 else turn(vertices, piece[here], piece[best], piece[i])
            reach = 0.0 if best < 0 else _squared(vertices, piece[here], piece[best])
            if side < 0.0 or (side == 0.0 and _squared(vertices, piece[here], piece[i]) > reach):
                best = i
        if best < 0 or _squared(vertices, piece[best], piece[start]) == 0.0:
            break
        here = best
    return count


@leaf_kernel
def _deepest_notch(vertices: Array, piece: Indices, m: int, hull: Indices, corners: int, tolerance: float) -> int:
    """Place of the vertex furthest behind the hull edge that bridges its pocket; -1 where none is beyond tolerance."""
    deepest, notch = tolerance, -1
    for k in range(corners):
        i, j = int(hull[k]), int(hull[(k + 1) % corners])
        length = np.sqrt(_squared(vertices, piece[i], piece[j]))
        v = (i + 1) % m
        while v != j:
            depth = turn(vertices, piece[i], piece[j], piece[v]) / length
            if depth > deepest and turn(vertices, piece[(v - 1) % m], piece[v], piece[(v + 1) % m]) < 0.0:
                deepest, notch = depth, v
            v = (v + 1) % m
    return notch


@leaf_kernel
def _best_cut(vertices: Array, piece: Indices, m: int, v: int) -> int:
    """Place of the vertex to cut to from notch v: near, opposite, best another notch; -1 where none is in sight."""
    best, least = -1, np.inf
    before, after = piece[(v - 1) % m], piece[(v + 1) % m]
    for j in range(m):
        if j == v or piece[j] == before or piece[j] == after:
            continue
        cost = _squared(vertices, piece[v], piece[j])
        # A cut outside the cone of the two prolonged edges leaves a notch at v.
        if turn(vertices, before, piece[v], piece[j]) < 0.0 or turn(vertices, piece[v], after, piece[j]) < 0.0:
            cost *= 16.0
        if turn(vertices, piece[(j - 1) % m], piece[j], piece[(j + 1) % m]) < 0.0:
            cost *= 0.25
        if cost < least and _in_sight(vertices, piece, m, v, j):
            best, least = j, cost
    return best


@leaf_kernel
def _in_sight(vertices: Array, piece: Indices, m: int, v: int, w: int) -> bool:
    """Whether the segment between two places of a piece runs inside it without touching an edge or another vertex."""
    p, q = piece[v], piece[w]
    if not (_opens_to(vertices, piece, m, v, q) and _opens_to(vertices, piece, m, w, p)):
        return False
    return not _blocked(vertices, piece, m, p, q)


@leaf_kernel
def _blocked(vertices: Array, piece: Indices, m: int, p: int, q: int) -> bool:
    """Whether a piece's outline crosses or touches the open segment between two vertices."""
    length = np.sqrt(_squared(vertices, p, q))
    for i in range(m):
        a, b = piece[i], piece[(i + 1) % m]
        if min(_squared(vertices, a, p), _squared(vertices, a, q)) == 0.0:
            continue
        side_a, side_b = turn(vertices, p, q, a), turn(vertices, p, q, b)
        if abs(side_a) <= 1e-9 * length:
            # A vertex on the line of the segment blocks it where it lies between the ends.
            if _squared(vertices, a, p) + _squared(vertices, a, q) < length * length:
                return True
        elif side_a * side_b < 0.0 and turn(vertices, a, b, p) * turn(vertices, a, b, q) < 0.0:
            return True
    return False


@leaf_kernel
def _opens_to(vertices: Array, piece: Indices, m: int, v: int, p: int) -> bool:
    """Whether vertex p lies in the open wedge of the interior at a place of the piece, or on its sides at a bridge."""
    before, here, after = piece[(v - 1) % m], piece[v], piece[(v + 1) % m]
    left, right = turn(vertices, here, after, p) > 0.0, turn(vertices, before, here, p) > 0.0
    return (left and right) if turn(vertices, before, here, after) >= 0.0 else (left or right)
