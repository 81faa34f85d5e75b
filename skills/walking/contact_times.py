"""How long each sole has been pressed by the ground, or has not been: what tells landings from mere touches."""

from __future__ import annotations

from collections.abc import Mapping

from skills.footsteps.footstep import Side

_ROUNDING = 1e-9


class ContactTimes:
    """Times of contact of both soles.

    Args:
        force: normal force from which a sole counts as pressed [N].
    """

    def __init__(self, force: float) -> None:
        self._force = force
        self._pressed, self._free = dict.fromkeys(Side, 0.0), dict.fromkeys(Side, 0.0)

    def update(self, loads: Mapping[Side, float], dt: float) -> None:
        """Take note of the normal forces of one control tick [N, s]."""
        for side in Side:
            pressed = loads[side] > self._force
            self._pressed[side] = self._pressed[side] + dt if pressed else 0.0
            self._free[side] = 0.0 if pressed else self._free[side] + dt

    def pressed_for(self, side: Side, duration: float) -> bool:
        """Whether a sole has been pressed for a time without a break, now at least [s]."""
        return self._pressed[side] > 0.0 and self._pressed[side] >= duration - _ROUNDING

    def free_for(self, side: Side, duration: float) -> bool:
        """Whether a sole has not been pressed for a time [s]."""
        return self._free[side] >= duration - _ROUNDING
