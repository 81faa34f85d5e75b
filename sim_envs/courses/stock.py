"""Building blocks by type: what courses are made of in the laboratory."""

from __future__ import annotations

STOCK: dict[str, tuple[float, float, float]] = {
    "small_block": (0.393, 0.192, 0.0884),
    "medium_block": (0.393, 0.1885, 0.1415),
    "large_block": (0.393, 0.190, 0.192),
    "cinder_block": (0.390, 0.190, 0.190),
    "pallet": (1.210, 1.013, 0.155),
    "person": (0.300, 0.500, 1.750),
}
"""Full lengths along x, y and z by type [m]."""
