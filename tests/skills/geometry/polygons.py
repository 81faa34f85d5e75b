"""Polygons to try things on, and brute-force judges of them that share no code with what they judge."""

import numpy as np

SQUARE = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
L_SHAPE = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]])
U_SHAPE = np.array([[0, 0], [3, 0], [3, 2], [2, 2], [2, 1], [1, 1], [1, 2], [0, 2]], dtype=np.float64)


def star(points: int, inner: float, phase: float = 0.1) -> np.ndarray:
    angle = np.arange(2 * points) * np.pi / points + phase
    radius = np.where(np.arange(2 * points) % 2 == 1, inner, 1.0)
    return np.column_stack((radius * np.cos(angle), radius * np.sin(angle)))


def circle(x: float, y: float, radius: float, corners: int = 24) -> np.ndarray:
    angle = np.arange(corners) * 2.0 * np.pi / corners
    return np.column_stack((x + radius * np.cos(angle), y + radius * np.sin(angle)))


def random_blob(rng: np.random.Generator) -> np.ndarray:
    angle = np.sort(rng.uniform(0.0, 2.0 * np.pi, rng.integers(12, 40)))
    return (rng.uniform(0.3, 1.0, len(angle)) * np.array([np.cos(angle), np.sin(angle)])).T.copy()


def area(polygon: np.ndarray) -> float:
    x, y = polygon.T
    return 0.5 * float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))


def inside(polygon: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Even-odd rule, a ray to the right of each point."""
    (ax, ay), (bx, by) = polygon.T, np.roll(polygon, -1, axis=0).T
    x, y = points[:, :1], points[:, 1:]
    with np.errstate(divide="ignore", invalid="ignore"):
        crossed = ((ay > y) != (by > y)) & (x < ax + (y - ay) / (by - ay) * (bx - ax))
    return crossed.sum(axis=1) % 2 == 1


def distance(rings: list[np.ndarray], points: np.ndarray) -> np.ndarray:
    """Distance of each point from the nearest edge of rings."""
    least = np.full(len(points), np.inf)
    for ring in rings:
        for a, b in zip(ring, np.roll(ring, -1, axis=0), strict=True):
            t = np.clip((points - a) @ (b - a) / max((b - a) @ (b - a), 1e-300), 0.0, 1.0)
            least = np.minimum(least, np.linalg.norm(a + t[:, None] * (b - a) - points, axis=1))
    return least


def is_convex(polygon: np.ndarray) -> bool:
    edges = np.roll(polygon, -1, axis=0) - polygon
    following = np.roll(edges, -1, axis=0)
    return bool(np.all(edges[:, 0] * following[:, 1] - edges[:, 1] * following[:, 0] > -1e-12))


def are_simple(rings: list[np.ndarray]) -> bool:
    """Whether no two edges of rings touch, but for neighbours at the vertex that they share."""
    edges = [
        (k, i, len(ring), ring[i], ring[(i + 1) % len(ring)]) for k, ring in enumerate(rings) for i in range(len(ring))
    ]
    for m, (k, i, n, a, b) in enumerate(edges):
        for other, j, _, c, d in edges[m + 1 :]:
            if k == other and (j == (i + 1) % n or i == (j + 1) % n):
                tail, joint, head = (a, b, d) if j == (i + 1) % n else (c, a, b)
                u, v = joint - tail, head - joint
                if u[0] * v[1] - u[1] * v[0] == 0.0 and u @ v <= 0.0:
                    return False
            elif _touch(a, b, c, d):
                return False
    return True


def _touch(a: np.ndarray, b: np.ndarray, c: np.ndarray, d: np.ndarray) -> bool:
    if np.any(np.maximum(a, b) < np.minimum(c, d)) or np.any(np.maximum(c, d) < np.minimum(a, b)):
        return False
    return _side(a, b, c) * _side(a, b, d) <= 0 and _side(c, d, a) * _side(c, d, b) <= 0


def _side(a: np.ndarray, b: np.ndarray, p: np.ndarray) -> float:
    return float(np.sign((b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])))
