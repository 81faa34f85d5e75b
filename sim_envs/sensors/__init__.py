"""Simulated sensors with realistic noise: a depth camera and a lidar, neither of which needs a graphics library."""

from sim_envs.sensors.depth_camera import DepthCamera, DepthCameraParameters
from sim_envs.sensors.depth_noise import DEPTH_NOISE_PRESETS, DepthNoise
from sim_envs.sensors.geom_mesh import GeomMesh, geom_mesh, geom_rgba
from sim_envs.sensors.lidar import Lidar, LidarParameters
from sim_envs.sensors.lidar_noise import LIDAR_NOISE_PRESETS, LidarNoise
from sim_envs.sensors.own_body import OwnBody, own_body
from sim_envs.sensors.rasterizer import Raster, rasterize_depth, rasterize_faces
from sim_envs.sensors.snapshot import Snapshot

__all__ = [
    "DEPTH_NOISE_PRESETS",
    "LIDAR_NOISE_PRESETS",
    "DepthCamera",
    "DepthCameraParameters",
    "DepthNoise",
    "GeomMesh",
    "Lidar",
    "LidarNoise",
    "LidarParameters",
    "OwnBody",
    "Raster",
    "Snapshot",
    "geom_mesh",
    "geom_rgba",
    "own_body",
    "rasterize_depth",
    "rasterize_faces",
]
