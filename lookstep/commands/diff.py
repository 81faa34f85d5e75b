"""`lookstep diff`: two recorded runs compared."""

from __future__ import annotations

import argparse
from pathlib import Path

NAME = "diff"
HELP = "compare two recorded runs: what ran, and the first tick in which they differ"
EXAMPLE = "lookstep diff runs/before runs/after"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the two runs."""
    parser.add_argument("first", type=Path, metavar="A", help="folder that a run has written with --out")
    parser.add_argument("second", type=Path, metavar="B", help="another one")


def execute(options: argparse.Namespace) -> int:
    """Compare; 0 where the runs are the same."""
    from rich.console import Console

    from behaviors.trace_diff import diff_traces
    from lookstep.commands.told import print_divergence
    from lookstep.replay import configuration_differences, describe_options, read_trace
    from lookstep.run_file import RunFile

    console = Console()
    runs = [RunFile.read(folder) for folder in (options.first, options.second)]
    sides = ("A", "B")
    for side, folder, run in zip(sides, (options.first, options.second), runs, strict=True):
        console.print(f"{side}: {folder}: {describe_options(run)}", highlight=False, soft_wrap=True)
    for name, one, other in configuration_differences(runs[0].configuration, runs[1].configuration):
        console.print(f"  {name}: A {one}, B {other}", highlight=False, soft_wrap=True)
    diff = diff_traces(read_trace(options.first), read_trace(options.second))
    print_divergence(console, diff, sides, applies=False)
    return 0 if diff.identical else 1
