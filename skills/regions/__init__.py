"""Planar regions out of depth images."""

from skills.regions.debug_image import debug_image
from skills.regions.extraction import Capsule, RegionExtraction, RejectedRegion, examine_regions, extract_regions
from skills.regions.parameters import MemoryParameters, RegionParameters
from skills.regions.planar_region import PlanarRegion, PlanarRegions
from skills.regions.region_memory import RegionMemory

__all__ = [
    "Capsule",
    "MemoryParameters",
    "PlanarRegion",
    "PlanarRegions",
    "RegionExtraction",
    "RegionMemory",
    "RegionParameters",
    "RejectedRegion",
    "debug_image",
    "examine_regions",
    "extract_regions",
]
