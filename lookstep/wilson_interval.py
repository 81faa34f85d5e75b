"""How sure a share of successes is."""

from __future__ import annotations

from math import sqrt

_Z_95 = 1.959964  # two-sided 95 % of a normal distribution


def wilson_interval(ok: int, of: int) -> tuple[float, float]:
    """95 % confidence interval of a share of successes (Wilson, 1927)."""
    if of == 0:
        return 0.0, 1.0
    share, z2 = ok / of, _Z_95**2
    middle = share + z2 / (2 * of)
    half = _Z_95 * sqrt(share * (1.0 - share) / of + z2 / (4 * of * of))
    return max(0.0, (middle - half) / (1.0 + z2 / of)), min(1.0, (middle + half) / (1.0 + z2 / of))
