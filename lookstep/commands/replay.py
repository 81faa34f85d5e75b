"""`lookstep replay`: recorded runs driven again through their trees."""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import Any

from lookstep.arguments import add_assignments
from lookstep.errors import UserError

NAME = "replay"
HELP = "drive a tree again through recorded runs and name the first tick in which it decides otherwise"
EXAMPLE = "lookstep replay runs/demo --set /look_and_step/walk/sequence/go/walk_to/on_the_way/follow_path.attempts=3"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the runs and what may be edited."""
    parser.add_argument("runs", nargs="+", type=Path, metavar="RUN", help="folder that a run has written with --out")
    parser.add_argument("--tree", help="another tree: what would it have decided? (the recorded one)")
    add_assignments(parser, "another parameter: subject.key=value or /node/path.key=value")
    parser.add_argument(
        "--outputs", action="store_true", help="leaves say again what they said, instead of computing everything anew"
    )
    parser.add_argument("--json", type=Path, metavar="FILE", help="write what was found for programs")


def execute(options: argparse.Namespace) -> int:
    """Replay each run; 0 where none diverges."""
    if options.json is not None and not options.json.parent.is_dir():
        raise UserError(f"--json {options.json}: the folder {options.json.parent} does not exist")
    from rich.console import Console

    from lookstep.commands.told import Bar, print_divergence
    from lookstep.replay import ReplayOptions, replay

    console = Console()
    how = ReplayOptions(options.tree, tuple(options.assignments), options.outputs)
    found: list[dict[str, Any]] = []
    for folder in options.runs:
        with Bar(folder) as bar:
            replayed = replay(folder, how, bar)
        diff = replayed.diff
        console.print(f"[bold]{folder}[/]: {diff.ticks} ticks, {diff.divergent} divergent", highlight=False)
        print_divergence(console, diff, ("recorded", "now"), applies=True)
        for path, time in replayed.strayed.items():
            console.print(f"  the recording does not say what {path} does at {time:.2f} s", highlight=False)
        found.append(
            {
                "run": str(folder),
                "ticks": diff.ticks,
                "divergent": diff.divergent,
                "identical": diff.identical,
                "first_divergent_time": None if diff.first is None else diff.first.time,
                "applies_until": None if diff.first_command is None else diff.first_command.time,
            }
        )
    if options.json is not None:
        options.json.write_text(json.dumps(found, indent=2) + "\n")
    return 1 if any(run["divergent"] for run in found) else 0
