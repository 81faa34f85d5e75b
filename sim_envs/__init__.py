"""Simulated worlds: the robot model, courses, sensors, and the judge who knows the truth."""

import warnings

# dm_control looks for a window system when it is imported; nothing here opens a window.
warnings.filterwarnings("ignore", message=".*(X11|Wayland|DISPLAY)", module="glfw")
