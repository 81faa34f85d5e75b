"""`lookstep evaluate`: courses by seeds by worlds, success with intervals, failures, the paper's tables and ours."""

from __future__ import annotations

import argparse
import os
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from lookstep.arguments import add_assignments, positive
from lookstep.commands.figures import FigureBar, add_figure_options, check_folders, publish
from lookstep.errors import UserError
from lookstep.options import WORLDS

if TYPE_CHECKING:
    from lookstep.evaluation.suite import Case, Suite

NAME = "evaluate"
HELP = "walk courses over many seeds and print success, failures and the paper's tables beside ours"
EXAMPLE = "lookstep evaluate --courses rough moved_blocks --seeds 10 --preset fast --jsonl walks.jsonl"

_SUITE, _QUICK_SUITE = "paper", "quick"
_SEEDS = 5  # of a course that is named here


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare which walks, and where their figures go."""
    which = parser.add_mutually_exclusive_group()
    which.add_argument("--suite", metavar="NAME", help=f"shipped suite or YAML file of cases ({_SUITE})")
    which.add_argument("--courses", nargs="+", metavar="COURSE", help="generators, shipped courses or YAML files")
    parser.add_argument("--cases", nargs="+", default=[], metavar="CASE", help="only these of the suite")
    parser.add_argument(
        "--seeds", type=_seeds, metavar="SEEDS", help=f"how many (10), or which (3-7,12); the suite's own, or {_SEEDS}"
    )
    parser.add_argument("--world", nargs="+", choices=WORLDS, default=[], help="the suite's own, or physics")
    parser.add_argument(
        "--preset", metavar="NAMES", help="in place of the suite's: presets joined by commas (fast,drift)"
    )
    add_assignments(parser, "one parameter of every walk, as for `run`")
    parser.add_argument("--workers", type=positive, metavar="N", help="processes that walk at the same time (cores)")
    parser.add_argument(
        "--jsonl", type=Path, metavar="FILE", help="one row a walk; walks that the file has are not made again"
    )
    add_figure_options(parser, quick="two short walks, in under 45 s")


def execute(options: argparse.Namespace) -> int:
    """Walk; 0 where no case has more failures than its suite allows."""
    check_folders(options, "json", "table", "jsonl")
    if options.quick and (options.suite or options.courses):
        raise UserError("--quick: has walks of its own, takes neither --suite nor --courses")
    from lookstep.evaluation.evaluate import evaluate
    from lookstep.evaluation.suite import chosen

    suite = chosen(
        _suite(options),
        names=options.cases,
        worlds=options.world,
        preset=options.preset,
        assignments=options.assignments,
    )
    workers = options.workers or len(os.sched_getaffinity(0))

    def seeds_of(case: Case) -> Sequence[int]:
        return range(case.seeds) if options.seeds is None else options.seeds

    with FigureBar() as bar:
        report = evaluate(suite, seeds_of, bar, workers=workers, jsonl=options.jsonl)
    publish(report, options)
    return 1 if report.missed else 0


def _suite(options: argparse.Namespace) -> Suite:
    from lookstep.evaluation.suite import load_suite, suite_of_courses

    if options.courses:
        return suite_of_courses(options.courses, _SEEDS)
    return load_suite(options.suite or (_QUICK_SUITE if options.quick else _SUITE))


def _seeds(text: str) -> Sequence[int]:
    """`10` is the first ten; with a comma or a dash it is a list: `3-7,12`, `5,`."""
    if text.isdecimal():
        return range(positive(text))
    seeds: list[int] = []
    for part in filter(None, text.split(",")):
        first, dash, last = part.partition("-")
        if not first.isdecimal() or (dash and (not last.isdecimal() or int(last) < int(first))):
            raise argparse.ArgumentTypeError(f"got {text!r}, needs a number such as 10, or seeds such as 3-7,12")
        seeds += range(int(first), int(last or first) + 1)
    if not seeds:
        raise argparse.ArgumentTypeError(f"got {text!r}, needs at least one seed")
    return sorted(set(seeds))
