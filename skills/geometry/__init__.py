"""Rigid transforms, polygons and cameras."""

from skills.geometry.camera import DepthImage, PinholeCamera
from skills.geometry.polygon import clip_convex, contains_points, convex_hull, convex_parts, signed_area, simplify
from skills.geometry.pose import Array, Pose, readonly, wrap_angle

__all__ = [
    "Array",
    "DepthImage",
    "PinholeCamera",
    "Pose",
    "clip_convex",
    "contains_points",
    "convex_hull",
    "convex_parts",
    "readonly",
    "signed_area",
    "simplify",
    "wrap_angle",
]
