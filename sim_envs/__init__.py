"""Simulated worlds: the robot model, courses, sensors, and the judge who knows the truth."""
