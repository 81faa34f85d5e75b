"""Planar regions out of depth images."""

from skills.regions.debug_image import debug_image, region_colors
from skills.regions.extraction import RegionExtraction, RejectedRegion, examine_regions, extract_regions
from skills.regions.memory_parameters import MemoryParameters
from skills.regions.noise_level import NoiseLevel
from skills.regions.parameters import RegionParameters
from skills.regions.pieces import PixelKind, kind_of_pixels, piece_of_pixels
from skills.regions.planar_region import PlanarRegion, PlanarRegions
from skills.regions.region_memory import Forgotten, GroundUpdate, MapParameters, RegionMemory, remember
from skills.regions.registration import Drift
from skills.regions.registration_parameters import RegistrationParameters

__all__ = [
    "Drift",
    "Forgotten",
    "GroundUpdate",
    "MapParameters",
    "MemoryParameters",
    "NoiseLevel",
    "PixelKind",
    "PlanarRegion",
    "PlanarRegions",
    "RegionExtraction",
    "RegionMemory",
    "RegionParameters",
    "RegistrationParameters",
    "RejectedRegion",
    "debug_image",
    "examine_regions",
    "extract_regions",
    "kind_of_pixels",
    "piece_of_pixels",
    "region_colors",
    "remember",
]
