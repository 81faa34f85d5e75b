"""`lookstep check`: is a tree or a course file sound, and if not, where."""

from __future__ import annotations

import argparse
import sys

from lookstep.trees import tree_path
from strict_yaml import Kind, YamlError, load_document

NAME = "check"
HELP = "check tree and course files and print every problem with file:line:column"
EXAMPLE = "lookstep check look_and_step my_course.yaml"

_COURSE_KEYS = {"generator", "objects", "start", "goal"}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the files."""
    parser.add_argument("files", nargs="+", metavar="FILE", help="tree or course file, or the name of a shipped tree")


def execute(options: argparse.Namespace) -> int:
    """Check every file; 0 when all are sound, 2 otherwise."""
    problems = 0
    for name in options.files:
        try:
            kind = _check(name)
            print(f"{name}: sound ({kind})")
        except YamlError as error:
            problems += len(error.problems)
            print(error, file=sys.stderr)
    if problems:
        print(f"{problems} problem{'s' if problems > 1 else ''}", file=sys.stderr)
    return 2 if problems else 0


def _check(name: str) -> str:
    import behaviors
    from sim_envs.courses import load_course

    path = tree_path(name)
    document = load_document(path)
    if document.kind is Kind.MAPPING and "tree" not in document.keys and _COURSE_KEYS.intersection(document.keys):
        load_course(str(path))
        return "course"
    problems = behaviors.check(path)
    if problems:
        raise YamlError(problems)
    return "tree"
