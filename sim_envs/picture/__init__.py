"""Shaded pictures of a simulation, drawn by the depth camera's rasterizer and needing no graphics library."""

from sim_envs.picture.light import LightParameters
from sim_envs.picture.overlays import Overlay, line, outline, planned_steps, region_outlines
from sim_envs.picture.picture import PictureStyle, picture_of
from sim_envs.picture.views import beside_robot, orbit_view, picture_camera

__all__ = [
    "LightParameters",
    "Overlay",
    "PictureStyle",
    "beside_robot",
    "line",
    "orbit_view",
    "outline",
    "picture_camera",
    "picture_of",
    "planned_steps",
    "region_outlines",
]
