"""Rigid transforms, polygons, and what cameras and lidars deliver."""

from skills.geometry.camera import DepthImage, PinholeCamera, looking
from skills.geometry.capsule import Capsule
from skills.geometry.convex_decomposition import convex_parts
from skills.geometry.lidar import LidarScan, SpinningLidar
from skills.geometry.polygon import clip_convex, contains_points, convex_hull, signed_area
from skills.geometry.pose import Array, Pose, readonly, wrap_angle
from skills.geometry.simplification import simplify

__all__ = [
    "Array",
    "Capsule",
    "DepthImage",
    "LidarScan",
    "PinholeCamera",
    "Pose",
    "SpinningLidar",
    "clip_convex",
    "contains_points",
    "convex_hull",
    "convex_parts",
    "looking",
    "readonly",
    "signed_area",
    "simplify",
    "wrap_angle",
]
