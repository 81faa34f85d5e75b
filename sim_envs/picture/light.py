"""Light on surfaces: a sun with soft shadows, and a whole sky of lights, whose shadows make corners dark.

Each light is far away in one direction and has its own shadow map: the depth of the scene seen from there, drawn by the
depth camera's rasterizer. A pixel is drawn as several samples, and every sample sees another share of the lights: their
mean sees all (interleaved sampling; Keller & Heidrich, 2001).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sim_envs.sensors import GeomMesh, rasterize_depth
from skills.geometry.camera import PinholeCamera
from skills.geometry.pose import Array, Pose
from skills.kernels import kernel
from skills.parameters import parameter, parameters

_DISTANCE = 60.0  # of lights; far enough that their rays are all but parallel [m]
_GOLDEN_ANGLE = np.pi * (3 - np.sqrt(5))


@parameters
class LightParameters:
    """Where light comes from."""

    sun_elevation_deg: float = parameter(48.0, unit="deg", minimum=5.0, maximum=90.0, meaning="sun above the horizon")
    sun_azimuth_deg: float = parameter(
        75.0, unit="deg", minimum=-180.0, maximum=180.0, meaning="sun to the left of where the camera looks"
    )
    sun_radius_deg: float = parameter(
        2.5,
        unit="deg",
        minimum=0.0,
        maximum=20.0,
        meaning="apparent radius of the sun; a larger one has softer shadows",
    )
    sun_lights: int = parameter(48, unit="1", minimum=4, maximum=1024, meaning="lights that the sun is made of")
    sky_lights: int = parameter(160, unit="1", minimum=4, maximum=4096, meaning="lights that the sky is made of")
    map_size: int = parameter(1536, unit="px", minimum=64, maximum=8192, meaning="rows and columns of a shadow map")


@dataclass(frozen=True, slots=True, eq=False)
class Casters:
    """What casts shadows, and where shadows are looked for.

    Attributes:
        mesh, geom_positions, geom_rotations: the geoms and their poses, as the rasterizer takes them.
        center_world, radius: the sphere within which shadows fall [m].
    """

    mesh: GeomMesh
    geom_positions: Array
    geom_rotations: Array
    center_world: Array
    radius: float


def sun_directions(parameters: LightParameters, camera_yaw: float) -> Array:
    """Unit vectors to the lights of the sun, (K, 3) in the world, spread evenly over its disc."""
    azimuth = camera_yaw + np.deg2rad(parameters.sun_azimuth_deg)
    elevation = np.deg2rad(parameters.sun_elevation_deg)
    toward = np.array([np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)])
    k = np.arange(parameters.sun_lights)
    r = np.tan(np.deg2rad(parameters.sun_radius_deg)) * np.sqrt((k + 0.5) / len(k))
    right, up = _across(toward)
    disc = np.outer(r * np.cos(k * _GOLDEN_ANGLE), right) + np.outer(r * np.sin(k * _GOLDEN_ANGLE), up)
    return _unit(toward + disc)


def sky_directions(parameters: LightParameters) -> Array:
    """Unit vectors to the lights of the sky, (K, 3) in the world, spread evenly over the upper hemisphere."""
    k = np.arange(parameters.sky_lights)
    z = (k + 0.5) / len(k)
    r = np.sqrt(1 - z * z)
    return np.column_stack((r * np.cos(k * _GOLDEN_ANGLE), r * np.sin(k * _GOLDEN_ANGLE), z))


def light_on(
    points_world: NDArray[np.float32],
    normals_world: NDArray[np.float32],
    share: NDArray[np.int64],
    shares: int,
    casters: Casters,
    directions: Array,
    map_size: int,
) -> NDArray[np.float32]:
    """Mean of the cosine between normal and light over the lights that a point sees, (N,).

    Args:
        points_world: (N, 3) [m].
        normals_world: unit normals, (N, 3).
        share: which share of the lights each point sees, (N,) within 0..shares - 1.
        shares: number of shares; share k sees the lights k, k + shares, ...
        casters: what casts shadows.
        directions: unit vectors to the lights, (K, 3).
        map_size: rows and columns of a shadow map [px].
    """
    sums = np.zeros(len(points_world), dtype=np.float32)
    members = [np.flatnonzero(share == k) for k in range(shares)]
    focal = 0.5 * map_size * _DISTANCE / casters.radius
    middle = 0.5 * (map_size - 1)
    camera = PinholeCamera(map_size, map_size, focal, focal, middle, middle, 1.0, 2 * _DISTANCE)
    texel = 2 * casters.radius / map_size
    for k, direction in enumerate(directions):
        right, up = _across(direction)
        T_world_light = Pose(np.column_stack((right, -up, -direction)), casters.center_world + _DISTANCE * direction)
        shadow_map = rasterize_depth(
            casters.mesh, casters.geom_positions, casters.geom_rotations, camera, T_world_light
        )
        frame = np.vstack((T_world_light.R.T, T_world_light.p)).astype(np.float32)
        _add_light(points_world, normals_world, members[k % shares], frame, shadow_map, focal, texel, sums)
    counts = np.array([len(range(k, len(directions), shares)) for k in range(shares)], dtype=np.float32)
    return (sums / np.maximum(counts, 1)[share]).astype(np.float32)


@kernel
def _add_light(
    points: NDArray[Any],
    normals: NDArray[Any],
    members: NDArray[Any],
    frame: NDArray[Any],
    shadow_map: NDArray[Any],
    focal: float,
    texel: float,
    sums: NDArray[Any],
) -> None:
    """Add the cosine of one light to the points that see it."""
    size = shadow_map.shape[0]
    middle = np.float32(0.5 * (size - 1))
    f, lift = np.float32(focal), np.float32(texel)
    for row in members:
        cosine = np.float32(0.0)
        for i in range(3):
            cosine -= normals[row, i] * frame[2, i]
        if cosine <= 0:
            continue
        # Raised off its own surface, a point does not shade itself; the more so the more the light grazes.
        raised = lift * (np.float32(1.2) - cosine)
        x = y = z = np.float32(0.0)
        for i in range(3):
            away = points[row, i] + raised * normals[row, i] - frame[3, i]
            x += frame[0, i] * away
            y += frame[1, i] * away
            z += frame[2, i] * away
        u, v = int(middle + f * x / z + np.float32(0.5)), int(middle + f * y / z + np.float32(0.5))
        if 0 <= u < size and 0 <= v < size:
            nearest = shadow_map[v, u]
            if nearest > 0 and nearest < z - np.float32(0.5) * lift:
                continue
        sums[row] += cosine


def _across(direction: Array) -> tuple[Array, Array]:
    """Two unit vectors across a direction: to its right, and up."""
    helper = np.array([0.0, 0.0, 1.0]) if abs(direction[2]) < 0.9 else np.array([1.0, 0.0, 0.0])
    right = _unit(np.cross(helper, direction))
    return right, np.cross(direction, right)


def _unit(vectors: Array) -> Array:
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)
