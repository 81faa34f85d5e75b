"""`lookstep run`: one walk."""

from __future__ import annotations

import argparse
from pathlib import Path

from lookstep.arguments import add_assignments
from lookstep.errors import UserError
from lookstep.options import EXECUTORS, WORLDS, RunOptions

NAME = "run"
HELP = "walk one course and print the figures"
EXAMPLE = "lookstep run --course rough --seed 3 --record walk.rrd --out runs/rough_3"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options of a run."""
    defaults = RunOptions()
    parser.add_argument("--tree", default=defaults.tree, help="shipped tree or YAML file (default: %(default)s)")
    parser.add_argument(
        "--course", default=defaults.course, help="generator, shipped course or YAML file (%(default)s)"
    )
    parser.add_argument("--seed", type=int, default=defaults.seed, help="seed of course and noise (%(default)s)")
    parser.add_argument("--world", choices=WORLDS, default=defaults.world, help="simulation (%(default)s)")
    parser.add_argument("--executor", choices=EXECUTORS, default=defaults.executor, help="how skills run (%(default)s)")
    parser.add_argument("--speed", type=float, help="pace: robot time per wall time (as fast as possible; realtime: 1)")
    parser.add_argument("--goal", type=_goal, metavar="X,Y,YAW", help="goal in metres and radians (the course's own)")
    parser.add_argument("--time-limit", type=float, default=defaults.time_limit, help="robot time [s] (%(default)s)")
    parser.add_argument("--robot", default=defaults.robot, help="shipped robot or YAML file (%(default)s)")
    parser.add_argument("--preset", help="shipped presets or YAML files, joined by commas, such as fast,drift")
    add_assignments(parser, "one parameter: subject.key=value, course.option=value or /node/path.key=value")
    parser.add_argument("--review", action="store_true", help="ask in the terminal before paths and plans are walked")
    parser.add_argument("--faults", type=Path, metavar="FILE", help="inject the faults that a YAML file lists")
    parser.add_argument(
        "--live",
        type=Path,
        metavar="FILE",
        help="read target.key: value from this YAML file whenever it is saved while the robot walks",
    )
    parser.add_argument(
        "--reload", action="store_true", help="a tree file that is saved meanwhile takes over at the next goal (--live)"
    )
    parser.add_argument("--record", type=Path, metavar="RRD", help="write a recording for the rerun viewer")
    parser.add_argument("--film", type=float, metavar="FPS", help="with a film of so many pictures a second (--record)")
    parser.add_argument("--plans", type=Path, metavar="DIR", help="log every footstep plan with its search here")
    parser.add_argument("--out", type=Path, metavar="DIR", help="write summary.json and trace.jsonl into this folder")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the summary here as well")


def execute(options: argparse.Namespace) -> int:
    """Walk; 0 when the goal was reached."""
    run_options = options_of(options)
    if options.json is not None and not options.json.parent.is_dir():
        raise UserError(f"--json {options.json}: the folder {options.json.parent} does not exist")
    if options.review and options.executor != EXECUTORS[0]:
        raise UserError(f"--review: the robot's clock waits for the operator, which needs --executor {EXECUTORS[0]}")
    # Loading the simulation takes seconds; whoever asks for help need not wait for it.
    from lookstep.commands.report import Progress, print_summary
    from lookstep.commands.terminal_review import TerminalReview
    from lookstep.summary import Outcome
    from lookstep.walk import walk

    with Progress() as progress:
        observers = [progress, TerminalReview(input, print, progress.aside)] if options.review else [progress]
        summary = walk(run_options, *observers)
    print_summary(summary, run_options)
    if options.json is not None:
        summary.write(options.json)
    return 0 if summary.outcome is Outcome.GOAL_REACHED else 1


def options_of(options: argparse.Namespace) -> RunOptions:
    """What to run, from the command line."""
    return RunOptions(
        tree=options.tree,
        course=options.course,
        seed=options.seed,
        world=options.world,
        executor=options.executor,
        speed=options.speed,
        goal=options.goal,
        time_limit=options.time_limit,
        robot=options.robot,
        preset=options.preset,
        assignments=tuple(options.assignments),
        review=options.review,
        faults=options.faults,
        live=options.live,
        reload=options.reload,
        record=options.record,
        film=options.film,
        plans=options.plans,
        out=options.out,
    )


def _goal(text: str) -> tuple[float, float, float]:
    try:
        x, y, yaw = (float(part) for part in text.split(","))
    except ValueError:
        raise argparse.ArgumentTypeError(f"got {text!r}, needs X,Y,YAW such as 4.0,0,0") from None
    return x, y, yaw
