"""Planar regions out of depth images."""

from skills.regions.extraction import Capsule, RegionExtraction, RejectedRegion, examine_regions, extract_regions
from skills.regions.parameters import MemoryParameters, RegionParameters
from skills.regions.planar_region import PlanarRegion, PlanarRegions

__all__ = [
    "Capsule",
    "MemoryParameters",
    "PlanarRegion",
    "PlanarRegions",
    "RegionExtraction",
    "RegionParameters",
    "RejectedRegion",
    "examine_regions",
    "extract_regions",
]
