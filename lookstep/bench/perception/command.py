"""`lookstep bench perception`: how good regions are, and how fast every stage from the sensors to the map is."""

from __future__ import annotations

import argparse
import dataclasses
from typing import TYPE_CHECKING

from lookstep.arguments import positive

if TYPE_CHECKING:
    from lookstep.bench.subject import Progress, Report

NAME = "perception"
HELP = "quality of regions against ground truth, and the time of every stage of perception"
EXAMPLE = "lookstep bench perception --quick --json perception.json"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the number of frames."""
    parser.add_argument(
        "--frames",
        type=positive,
        metavar="N",
        help="scenes of each kind that are judged with each noise (50; --quick: 3)",
    )


def measure(options: argparse.Namespace, progress: Progress) -> Report:
    """Judge and time."""
    # Loading the simulation takes seconds; whoever asks for help need not wait for it.
    from lookstep.bench.perception.report import FULL, QUICK, bench_perception

    extent = QUICK if options.quick else FULL
    if options.frames is not None:
        extent = dataclasses.replace(extent, scenes=options.frames)
    return bench_perception(extent, progress)
