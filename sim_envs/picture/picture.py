"""A shaded picture of a scene: what the camera's rasterizer sees, under a sun and a sky, with overlays painted on.

The picture is drawn with several samples a pixel. Each sample's surface is lit (`light.py`), its colour is the light it
throws back, and where nothing is seen a plain backdrop takes the shadows that fall on the floor.
"""

# mujoco keeps its types in binary modules without stubs.
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

import cv2
import mujoco
import numpy as np
from numpy.typing import NDArray

from sim_envs.picture.light import Casters, LightParameters, light_on, sky_directions, sun_directions
from sim_envs.picture.overlays import Layer, Overlay, project
from sim_envs.picture.surfaces import FLOOR, Surfaces, floor_under, linear, srgb, surfaces_of, together
from sim_envs.sensors import GeomMesh, geom_mesh, rasterize_faces
from skills.geometry.camera import PinholeCamera
from skills.geometry.pose import Array, Pose
from skills.parameters import parameter, parameters

Image = NDArray[np.float32]

_SEGMENTS, _CASTER_SEGMENTS = 96, 24  # around a round shape, seen and as a caster of shadows
_SUN_COLOR, _SKY_COLOR, _BOUNCE_COLOR = (1.0, 0.94, 0.85), (0.84, 0.92, 1.0), (1.0, 0.97, 0.92)
_EXPOSURE = np.float32(1.6)
_SHADOW_REACH = 9.0  # shadows are looked for this far around the middle of what is seen [m]
_SHININESS, _HIGHLIGHT, _RIM = 40, 8.0, 2.0
_JUMP = 0.04  # relative jump in depth that is a silhouette
_CLOSE = 0.03  # an overlay this close to a surface is painted on it; others float before it [m]


@parameters
class PictureStyle:
    """How a picture looks."""

    samples: int = parameter(2, unit="1", minimum=1, maximum=4, meaning="samples a pixel, along rows and columns each")
    floor_height: float = parameter(-0.25, unit="m", minimum=-10.0, maximum=10.0, meaning="floor below the scene")
    backdrop_top: tuple[float, float, float] = parameter(
        (0.80, 0.86, 0.92), unit="1", minimum=0.0, maximum=1.0, meaning="backdrop at the top: red, green, blue"
    )
    backdrop_bottom: tuple[float, float, float] = parameter(
        (0.965, 0.97, 0.975), unit="1", minimum=0.0, maximum=1.0, meaning="backdrop at the bottom: red, green, blue"
    )
    sun: float = parameter(1.15, unit="1", minimum=0.0, maximum=10.0, meaning="brightness of the sun")
    sky: float = parameter(0.42, unit="1", minimum=0.0, maximum=10.0, meaning="brightness of the sky")
    bounce: float = parameter(0.14, unit="1", minimum=0.0, maximum=10.0, meaning="brightness of light from below")
    gloss: float = parameter(0.10, unit="1", minimum=0.0, maximum=1.0, meaning="strength of highlights")
    outline: float = parameter(0.22, unit="1", minimum=0.0, maximum=1.0, meaning="how much silhouettes are darkened")


def picture_of(
    model: mujoco.MjModel,
    geom_positions: Array,
    geom_rotations: Array,
    camera: PinholeCamera,
    T_world_camera: Pose,
    *,
    overlays: Sequence[Overlay] = (),
    style: PictureStyle | None = None,
    light: LightParameters | None = None,
) -> NDArray[np.uint8]:
    """Draw a picture of a snapshot of a simulation.

    Args:
        model: the compiled model.
        geom_positions: snapshot of `MjData.geom_xpos`, (ngeom, 3) [m].
        geom_rotations: snapshot of `MjData.geom_xmat`, (ngeom, 3, 3).
        camera: intrinsics of the picture; see `picture_camera`.
        T_world_camera: camera frame, x right, y down, z forward; see `orbit_view`.
        overlays: painted on in this order.
        style: how the picture looks.
        light: where light comes from.

    Returns:
        Red, green, blue, (height, width, 3) uint8.
    """
    style, light = style or PictureStyle(), light or LightParameters()
    fine = camera.scaled(style.samples)
    mesh = _mesh_of(model, _SEGMENTS)
    raster = rasterize_faces(mesh, geom_positions, geom_rotations, fine, T_world_camera)
    scene = surfaces_of(model, mesh, raster, geom_positions, geom_rotations, fine, T_world_camera)
    center = np.median(scene.points_world, axis=0).astype(np.float64) if len(scene.pixels) else T_world_camera.p
    floor = floor_under(raster.depth, style.floor_height, fine, T_world_camera)
    surfaces = together(scene, floor)

    layers = [(overlay, project(overlay, fine, T_world_camera)) for overlay in overlays]
    depths = _depths(surfaces, fine, T_world_camera)
    for overlay, layer in layers:
        _paint(surfaces, depths, overlay, layer)
    shadow_mesh = _mesh_of(model, _CASTER_SEGMENTS)
    casters = Casters(shadow_mesh, geom_positions, geom_rotations, center, _reach(scene, center))
    image = _backdrop(fine, style)
    _shade(image, surfaces, casters, T_world_camera, style, light)
    for overlay, layer in layers:
        _float(image, depths, overlay, layer)
    _darken_silhouettes(image, depths, style.outline)
    small = cv2.resize(image, (camera.width, camera.height), interpolation=cv2.INTER_AREA)
    return np.round(255 * np.clip(small, 0, 1)).astype(np.uint8)


@lru_cache(maxsize=4)
def _mesh_of(model: mujoco.MjModel, segments: int) -> GeomMesh:
    """The faces of a model, which stay the same from one picture of a film to the next."""
    return geom_mesh(model, segments=segments)


def _reach(scene: Surfaces, center: Array) -> float:
    """Radius of the sphere in which shadows are looked for."""
    if not len(scene.pixels):
        return 1.0
    return min(float(np.linalg.norm(scene.points_world - center, axis=1).max()) + 0.1, _SHADOW_REACH)


def _shade(
    image: Image,
    surfaces: Surfaces,
    casters: Casters,
    T_world_camera: Pose,
    style: PictureStyle,
    light: LightParameters,
) -> None:
    """Put lit surfaces into the image; the floor only shades the backdrop, so that it has no end."""
    v, u = np.divmod(surfaces.pixels, image.shape[1])
    share, shares = (v % style.samples) * style.samples + u % style.samples, style.samples**2
    forward = T_world_camera.R[:, 2]
    suns = sun_directions(light, float(np.arctan2(forward[1], forward[0])))
    points, normals = surfaces.points_world, surfaces.normals_world
    sun = light_on(points, normals, share, shares, casters, suns, light.map_size)
    sky = light_on(points, normals, share, shares, casters, sky_directions(light), light.map_size // 2)
    flat, floor = image.reshape(-1, 3), surfaces.geoms == FLOOR
    incoming = _incoming(sun, sky, normals[:, 2], style)

    level = np.ones(1, dtype=np.float32)
    unshaded = _incoming(level * suns[:, 2].mean(), 0.5 * level, level, style)
    flat[surfaces.pixels[floor]] *= srgb(incoming[floor] / unshaded)

    scene = ~floor
    shine = style.gloss * _shine(
        points[scene], normals[scene], sun[scene], sky[scene], suns.mean(axis=0), T_world_camera.p
    )
    leaving = surfaces.colors[scene] * incoming[scene] + shine[:, None]
    flat[surfaces.pixels[scene]] = srgb(_tone(leaving.astype(np.float32)))


def _incoming(sun: Image, sky: Image, upward: Image, style: PictureStyle) -> Image:
    """Light that falls on surfaces, (N, 3), from what they see of sun and sky and how far they face up, (N,) each."""
    # Twice: a level plane under the whole sky has a mean cosine of one half.
    below = style.bounce * (0.5 - 0.5 * upward)
    return sum(
        amount[:, None] * np.array(color, dtype=np.float32)
        for amount, color in ((style.sun * sun, _SUN_COLOR), (2 * style.sky * sky, _SKY_COLOR), (below, _BOUNCE_COLOR))
    ).astype(np.float32)


def _shine(points: Image, normals: Image, sun: Image, sky: Image, toward_sun: Array, eye: Array) -> Image:
    """Light mirrored by surfaces, (N,): the sun's highlight (Blinn, 1977), and the sky where seen at a glance."""
    toward_eye = eye.astype(np.float32) - points
    toward_eye /= np.linalg.norm(toward_eye, axis=1, keepdims=True)
    half = toward_eye + toward_sun.astype(np.float32)
    half /= np.linalg.norm(half, axis=1, keepdims=True)
    highlight = np.maximum((normals * half).sum(axis=1), 0) ** _SHININESS
    glance = (1 - np.clip((normals * toward_eye).sum(axis=1), 0, 1)) ** 4
    return (_HIGHLIGHT * sun * highlight + _RIM * sky * glance).astype(np.float32)


def _tone(light: Image) -> Image:
    """Squeeze light without bound into what a screen can show; dark tones stay in proportion."""
    return 1 - np.exp(-_EXPOSURE * light)


def _backdrop(camera: PinholeCamera, style: PictureStyle) -> Image:
    down = np.linspace(0, 1, camera.height, dtype=np.float32)[:, None]
    row = (1 - down) * np.array(style.backdrop_top, dtype=np.float32) + down * np.array(
        style.backdrop_bottom, dtype=np.float32
    )
    return np.repeat(row[:, None], camera.width, axis=1).astype(np.float32)


def _depths(surfaces: Surfaces, camera: PinholeCamera, T_world_camera: Pose) -> Image:
    """Depth of the surface in each pixel, (height, width); infinite where there is none."""
    depths = np.full((camera.height, camera.width), np.inf, dtype=np.float32)
    away = surfaces.points_world - T_world_camera.p.astype(np.float32)
    depths.reshape(-1)[surfaces.pixels] = away @ T_world_camera.R[:, 2].astype(np.float32)
    return depths


def _paint(surfaces: Surfaces, depths: Image, overlay: Overlay, layer: Layer) -> None:
    """Give surfaces the colour of an overlay that lies on them."""
    on_surface = np.abs(layer.depth - depths.reshape(-1)[layer.pixels]) <= _CLOSE
    rows = np.searchsorted(surfaces.pixels, layer.pixels[on_surface])
    cover = layer.cover[on_surface][:, None]
    color = linear(np.array(overlay.color)).astype(np.float32)
    surfaces.colors[rows] = (1 - cover) * surfaces.colors[rows] + cover * color


def _float(image: Image, depths: Image, overlay: Overlay, layer: Layer) -> None:
    """Draw the part of an overlay that is in the air before what is behind it."""
    before = layer.depth < depths.reshape(-1)[layer.pixels] - _CLOSE
    pixels, cover = layer.pixels[before], layer.cover[before][:, None]
    flat = image.reshape(-1, 3)
    flat[pixels] = (1 - cover) * flat[pixels] + cover * np.array(overlay.color, dtype=np.float32)


def _darken_silhouettes(image: Image, depths: Image, strength: float) -> None:
    """Darken the nearer side of jumps in depth, which are bends of inverse depth: on a plane it runs straight."""
    inverse = 1 / depths
    bend = np.zeros_like(inverse)
    bend[:, 1:-1] = 2 * inverse[:, 1:-1] - inverse[:, :-2] - inverse[:, 2:]
    bend[1:-1] = np.maximum(bend[1:-1], 2 * inverse[1:-1] - inverse[:-2] - inverse[2:])
    image *= 1 - np.float32(strength) * np.clip(bend / np.maximum(_JUMP * inverse, np.float32(1e-9)), 0, 1)[..., None]
