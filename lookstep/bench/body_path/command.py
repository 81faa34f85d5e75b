"""`lookstep bench body_path`: planners of the body path side by side on random maps with obstacles."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from lookstep.bench.subject import Progress, Report

NAME = "body_path"
HELP = "planners of the body path on maps of 10 x 10 m with obstacles: cost and time; no path through a wall"
EXAMPLE = "lookstep bench body_path --quick --planners RRTstar,BITstar"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare which planners are compared and how long."""
    parser.add_argument("--planners", metavar="NAME,...", help="planners of OMPL (all of config/body_path.yaml)")
    parser.add_argument(
        "--seconds", type=float, metavar="S", help="that each of them may search on a map (10; 0.5 with --quick)"
    )
    parser.add_argument("--maps", type=int, metavar="N", help="on which they are compared (5; 1 with --quick)")


def measure(options: argparse.Namespace, progress: Progress) -> Report:
    """Plan and time."""
    from lookstep.bench.body_path import report
    from lookstep.errors import UserError
    from skills.body_path.path_parameters import OMPL_PLANNERS

    planners = OMPL_PLANNERS if options.planners is None else tuple(options.planners.split(","))
    unknown = [name for name in planners if name not in OMPL_PLANNERS]
    if unknown:
        raise UserError(f"--planners: unknown {', '.join(unknown)} (planners: {', '.join(OMPL_PLANNERS)})")
    usual = report.QUICK if options.quick else report.FULL
    seconds = usual.seconds if options.seconds is None else options.seconds
    maps = usual.maps if options.maps is None else options.maps
    if not seconds > 0.0 or maps < 1:
        raise UserError(f"--seconds, --maps: got {seconds:g} and {maps}, need positive numbers")
    return report.bench_body_path(planners, report.Extent(maps, seconds, usual.walls), progress)
