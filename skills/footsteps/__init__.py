"""Footstep planning: where the next feet land."""
