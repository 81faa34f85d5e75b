"""`lookstep demo`: the main job, a recorded walk over the rough course."""

from __future__ import annotations

import argparse
from pathlib import Path

from lookstep.commands import run

NAME = "demo"
HELP = "walk the rough course and record it; takes the options of `run`"
EXAMPLE = "lookstep demo && rerun runs/demo/walk.rrd"

_FOLDER = Path("runs/demo")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The options of a run, with the demo's defaults."""
    run.add_arguments(parser)
    parser.set_defaults(course="rough", out=_FOLDER, record=_FOLDER / "walk.rrd")


def execute(options: argparse.Namespace) -> int:
    """Walk and record."""
    return run.execute(options)
