"""`lookstep check`: is a tree, a course, a config file, a robot or a preset sound, and if not, where."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from lookstep.trees import tree_path
from strict_yaml import Kind, Node, Problem, YamlError, load_document, read_dataclass

NAME = "check"
HELP = "check tree, course, config, robot and preset files and print every problem with file:line:column"
EXAMPLE = "lookstep check look_and_step my_course.yaml"

_COURSE_KEYS = {"generator", "objects", "start", "goal"}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the files."""
    parser.add_argument(
        "files",
        nargs="+",
        metavar="FILE",
        help="a tree, a course, a robot, a preset, or a config file that is called after its subject, such as "
        "footsteps.yaml; or the name of a shipped tree",
    )
    parser.add_argument("--strict", action="store_true", help="remarks, such as values that nobody reads, are problems")


def execute(options: argparse.Namespace) -> int:
    """Check every file; 0 when all are sound, 2 otherwise."""
    count = 0
    for name in options.files:
        try:
            kind, remarks = _check(name)
        except YamlError as error:
            count += len(error.problems)
            print(error, file=sys.stderr)
            continue
        for remark in remarks:
            print(f"{remark}" if options.strict else f"{remark} (remark)", file=sys.stderr)
        count += len(remarks) if options.strict else 0
        if not (remarks and options.strict):
            print(f"{name}: sound ({kind})")
    if count:
        print(f"{count} problem{'s' if count > 1 else ''}", file=sys.stderr)
    return 2 if count else 0


def _check(name: str) -> tuple[str, tuple[Problem, ...]]:
    """What a file is, and the remarks about it.

    Raises:
        YamlError: where it has problems.
    """
    from lookstep.configuration import SUBJECTS
    from lookstep.evaluation.suite import load_suite
    from sim_envs.courses import load_course

    path = tree_path(name)
    document = load_document(path)
    keys = set(document.keys) if document.kind is Kind.MAPPING else set()
    if "tree" not in keys:
        if path.stem in SUBJECTS and path.parent.name != "presets":
            _check_config(document, SUBJECTS[path.stem], path.stem)
            return "config", ()
        if "cases" in keys:
            load_suite(str(path))
            return "suite", ()
        if keys & _COURSE_KEYS:
            load_course(str(path))
            return "course", ()
        if keys & set(SUBJECTS):
            return _check_layer(path, document), ()
    return "tree", _check_tree(path)


def _check_layer(path: Path, document: Node) -> str:
    from lookstep.configuration import load_configuration

    table = document.get("robot")
    if table is not None and "mjcf" in table.keys:
        load_configuration(robot=str(path))
        return "robot"
    load_configuration(preset=str(path))
    return "preset"


def _check_config(document: Node, cls: type, subject: str) -> None:
    problems: list[Problem] = []
    read_dataclass(document, cls, problems, subject)
    if problems:
        raise YamlError(problems)


def _check_tree(path: Path) -> tuple[Problem, ...]:
    import behaviors
    from lookstep.configuration import load_configuration
    from lookstep.swing_deadline import check_swing_deadlines

    spec = behaviors.load_tree(path)
    late = check_swing_deadlines(spec, load_configuration().footsteps.swing_duration)
    if late:
        raise YamlError(late)
    return spec.remarks
