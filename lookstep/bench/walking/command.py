"""`lookstep bench walking`: success over known footsteps in physics, compute times, solvers side by side."""

from __future__ import annotations

import argparse
import dataclasses
import os
from typing import TYPE_CHECKING

from lookstep.arguments import add_assignments, positive
from lookstep.errors import UserError

if TYPE_CHECKING:
    from lookstep.bench.subject import Progress, Report

NAME = "walking"
HELP = "walks over known footsteps in physics, the time of a control tick by part, solvers side by side"
EXAMPLE = "lookstep bench walking --cases tilted_0.5 push_400 --seeds 10"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what is tried, how often, and with which parameters."""
    parser.add_argument("--cases", nargs="+", default=[], metavar="CASE", help="only these; an unknown name lists all")
    parser.add_argument("--seeds", type=positive, metavar="N", help="at most so many trials a case (--quick: 1)")
    parser.add_argument("--workers", type=positive, metavar="N", help="processes that walk at the same time (cores)")
    parser.add_argument("--push-map", action="store_true", help="also pushes by force and direction, over four phases")
    parser.add_argument("--speed-map", action="store_true", help="also step lengths by timing")
    parser.add_argument("--preset", help="shipped preset or YAML file, as for `run`")
    add_assignments(parser, "one parameter, such as walking.dcm_gain=4")


def measure(options: argparse.Namespace, progress: Progress) -> Report:
    """Walk and time."""
    # Loading the simulation takes seconds; whoever asks for help need not wait for it.
    from lookstep.bench.walking.cases import CASES
    from lookstep.bench.walking.measure import FULL, QUICK, bench_walking
    from lookstep.configuration import load_configuration

    unknown = [name for name in options.cases if name not in CASES]
    if unknown:
        raise UserError(f"--cases: got {unknown[0]!r}, needs some of {', '.join(CASES)}")
    extent = QUICK if options.quick else FULL
    if options.seeds is not None:
        extent = dataclasses.replace(extent, seeds=options.seeds)
    return bench_walking(
        extent,
        load_configuration(options.preset, options.assignments),
        progress,
        cases=options.cases,
        workers=options.workers or len(os.sched_getaffinity(0)),
        push_map=options.push_map,
        speed_map=options.speed_map,
    )
