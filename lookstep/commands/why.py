"""`lookstep why`: why a node of a recorded run was not running."""

from __future__ import annotations

import argparse
from pathlib import Path

from lookstep.errors import UserError
from strict_yaml import nearest

NAME = "why"
HELP = "explain why a node of a recorded run was, or was not, running at a time"
EXAMPLE = "lookstep why runs/demo --node send_footsteps --at 12.3"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare run, node and time."""
    parser.add_argument("run", type=Path, metavar="RUN", help="folder that a run has written with --out")
    parser.add_argument("--node", required=True, metavar="PATH", help="a node's path, or the end of one")
    parser.add_argument("--at", required=True, type=float, metavar="T", help="robot time [s]")


def execute(options: argparse.Namespace) -> int:
    """Explain."""
    from behaviors.explanation import explain
    from behaviors.recorded_trace import TraceError
    from lookstep.replay import read_trace

    trace = read_trace(options.run)
    path = _path(options.node, list(trace.nodes))
    try:
        found = explain(trace, path, options.at)
    except TraceError as error:
        raise UserError(f"--at: {error}") from error
    print(f"{path} at {found.tick.time:.2f} s (tick {found.tick.tick})")
    print(f"  {'was ticked' if found.ticked else 'was not ticked'}; its status is {found.status}")
    for line in found.because:
        print(f"  {line}")
    if not found.ticked:
        print(
            "  it was never ticked before"
            if found.last_ticked is None
            else f"  last ticked at {found.last_ticked:.2f} s"
        )
    return 0


def _path(name: str, paths: list[str]) -> str:
    """The node that is meant."""
    found = [path for path in paths if path == name or path.endswith(f"/{name.lstrip('/')}")]
    if len(found) == 1:
        return found[0]
    if found:
        raise UserError(f"--node: got {name!r}, which ends {len(found)} paths: {', '.join(found)}")
    ends = [path.rpartition("/")[2] for path in paths]
    raise UserError(f"--node: no node {name!r}{nearest(name, [*paths, *ends])}")
