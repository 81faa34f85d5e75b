"""Courses: what the robot walks over, made by seeded generators or written in YAML, and the true ground under it."""

from sim_envs.courses.course import Box, BoxEvent, CarrotWay, Course, CourseError
from sim_envs.courses.ground import Ground
from sim_envs.courses.loading import course_names, load_course

__all__ = [
    "Box",
    "BoxEvent",
    "CarrotWay",
    "Course",
    "CourseError",
    "Ground",
    "course_names",
    "load_course",
]
