"""`lookstep bench footsteps`: whole plans over planar-region maps, and the plans of walks."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from lookstep.arguments import add_assignments

if TYPE_CHECKING:
    from lookstep.bench.subject import Progress, Report

NAME = "footsteps"
HELP = "plans over planar-region maps: solved or why not, steps, cost, time and expansions"
EXAMPLE = "lookstep bench footsteps --data ~/planar_regions --pictures plans"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare where the maps are and what to draw."""
    parser.add_argument(
        "--data",
        type=Path,
        metavar="DIR",
        help="folder with maps, *.json or planar_regions/*.json (the one that LOOKSTEP_DATA names)",
    )
    parser.add_argument("--pictures", type=Path, metavar="DIR", help="draw each plan from above into this folder")
    add_assignments(parser, "one parameter: footsteps.key=value or terrain.key=value")


def measure(options: argparse.Namespace, progress: Progress) -> Report:
    """Plan and time."""
    # Loading the simulation takes seconds; whoever asks for help need not wait for it.
    from lookstep.bench.footsteps.report import bench_footsteps
    from lookstep.configuration import load_configuration

    configuration = load_configuration(None, options.assignments)
    return bench_footsteps(
        options.data,
        configuration,
        tuple(options.assignments),
        progress,
        quick=options.quick,
        pictures=options.pictures,
    )
