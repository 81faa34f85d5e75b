"""Measures the planners of the body path on random maps, and judges that no path leads through a wall."""
