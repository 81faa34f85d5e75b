"""A course by the name of a generator, the name of a shipped file, or the path of a YAML file."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from sim_envs.courses.course import Course, CourseError
from sim_envs.courses.course_file import read_course
from sim_envs.courses.generators import GENERATORS, generate
from strict_yaml import load_document, nearest, shipped

_SUFFIXES = (".yaml", ".yml")


def load_course(name_or_path: str | Path, seed: int = 0, **options: Any) -> Course:
    """Make or read a course.

    Args:
        name_or_path: of a generator or shipped file (`course_names`), or a path that ends in .yaml.
        seed: of a generator; a file without a generator in it ignores it.
        options: of a generator, such as `tilted_share`; a file takes none.

    Raises:
        CourseError: where the name or an option is unknown.
        ParameterError: where an option's value is not allowed.
        YamlError: where the file is not a course; every problem with file:line:column.
    """
    name = str(name_or_path)
    if name in GENERATORS:
        return generate(name, seed, **options)
    path = _course_path(name)
    if options:
        raise CourseError(f'course "{name}" is a file and takes no options, got {", ".join(sorted(options))}')
    return read_course(load_document(path), path.stem, seed)


def course_names() -> tuple[str, ...]:
    """All generators and shipped files."""
    files = sorted(path.stem for path in shipped("config", "courses").glob("*.yaml"))
    return (*GENERATORS, *files)


def _course_path(name: str) -> Path:
    if name.endswith(_SUFFIXES):
        return Path(name)
    names = course_names()
    if name not in names:
        raise CourseError(
            f'unknown course "{name}"{nearest(name, names)} (courses: {", ".join(names)}; or the path of a .yaml file)'
        )
    return shipped("config", "courses", f"{name}.yaml")
