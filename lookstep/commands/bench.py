"""`lookstep bench`: figures of one part, beside ground truth, baselines and peers."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from lookstep.bench.body_path import command as body_path
from lookstep.bench.footsteps import command as footsteps
from lookstep.bench.perception import command as perception
from lookstep.bench.tree import command as tree
from lookstep.bench.walking import command as walking
from lookstep.commands.figures import FigureBar, add_figure_options, check_folders, publish

if TYPE_CHECKING:
    from lookstep.bench.subject import Subject

NAME = "bench"
HELP = "measure one part beside ground truth, baselines and peers"
EXAMPLE = "lookstep bench perception --quick"

SUBJECTS: tuple[Subject, ...] = (perception, footsteps, body_path, walking, tree)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the subjects and what each of them takes."""
    subparsers = parser.add_subparsers(title="subjects", metavar="SUBJECT", required=True)
    for subject in SUBJECTS:
        subparser = subparsers.add_parser(
            subject.NAME,
            help=subject.HELP,
            description=subject.HELP[0].upper() + subject.HELP[1:] + ".",
            epilog=f"example:\n  {subject.EXAMPLE}",
            formatter_class=argparse.RawDescriptionHelpFormatter,
        )
        add_figure_options(subparser, quick="the same figures from less, in under 45 s")
        subject.add_arguments(subparser)
        subparser.set_defaults(subject=subject)


def execute(options: argparse.Namespace) -> int:
    """Measure, print and write."""
    check_folders(options, "json", "table")
    with FigureBar() as bar:
        report = options.subject.measure(options, bar)
    publish(report, options)
    return 0
