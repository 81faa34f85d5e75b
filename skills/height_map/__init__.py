"""A height map of the ground around the robot, out of lidar scans."""

from skills.height_map.height_map import HeightMap, ScanAccount
from skills.height_map.mapper import HeightMapper
from skills.height_map.parameters import HeightMapParameters

__all__ = ["HeightMap", "HeightMapParameters", "HeightMapper", "ScanAccount"]
