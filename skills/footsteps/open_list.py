"""The open list of a search: edges in a binary heap, the one with the smallest estimate first."""

from __future__ import annotations

import numpy as np

from skills.footsteps.records import Records
from skills.kernels import kernel

# An edge from a parent to a node; its cost is negative as long as it is only estimated.
EDGE = np.dtype([("estimate", np.float64), ("cost", np.float64), ("node", np.int64), ("parent", np.int64)])


@kernel
def push(edges: Records, size: int, estimate: float, cost: float, node: int, parent: int) -> int:
    """Add an edge to the heap of the first `size` edges; its new size."""
    i = size
    while i > 0 and edges[(i - 1) // 2].estimate > estimate:
        edges[i] = edges[(i - 1) // 2]
        i = (i - 1) // 2
    edge = edges[i]
    edge.estimate, edge.cost, edge.node, edge.parent = estimate, cost, node, parent
    return size + 1


@kernel
def pop(edges: Records, size: int) -> int:
    """Remove the first edge of the heap of the first `size` edges; its new size."""
    size -= 1
    estimate = edges[size].estimate
    i = 0
    while 2 * i + 1 < size:
        below = 2 * i + 1
        if below + 1 < size and edges[below + 1].estimate < edges[below].estimate:
            below += 1
        if edges[below].estimate >= estimate:
            break
        edges[i] = edges[below]
        i = below
    edges[i] = edges[size]
    return size


@kernel
def with_room(edges: Records, size: int, more: int) -> Records:
    """The same heap with room for more edges: as it is, or in twice the memory."""
    if size + more <= edges.shape[0]:
        return edges
    longer = np.empty(2 * edges.shape[0] + more, EDGE)
    # Edge by edge: the copy of a slice of records takes much longer to compile.
    for k in range(size):
        longer[k] = edges[k]
    return longer
