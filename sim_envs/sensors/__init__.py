"""Simulated sensors: a depth camera with realistic noise, rendered by a rasterizer that needs no graphics library."""

from sim_envs.sensors.depth_camera import DepthCamera, DepthCameraParameters, looking
from sim_envs.sensors.depth_noise import DEPTH_NOISE_PRESETS, DepthNoise
from sim_envs.sensors.geom_mesh import GeomMesh, geom_mesh, geom_rgba
from sim_envs.sensors.rasterizer import Raster, rasterize_depth, rasterize_faces

__all__ = [
    "DEPTH_NOISE_PRESETS",
    "DepthCamera",
    "DepthCameraParameters",
    "DepthNoise",
    "GeomMesh",
    "Raster",
    "geom_mesh",
    "geom_rgba",
    "looking",
    "rasterize_depth",
    "rasterize_faces",
]
