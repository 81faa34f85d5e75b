"""`lookstep operate`: lead the robot from a browser."""

from __future__ import annotations

import argparse
import dataclasses
from pathlib import Path

from lookstep.commands import run
from lookstep.errors import UserError
from lookstep.options import EXECUTORS, WORLDS

NAME = "operate"
HELP = "lead the robot from a browser; takes the options of `run`"
EXAMPLE = "lookstep operate --course rough --world physics"

_LEAST_TOKEN = 16


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The options of a run, and where the panel is served."""
    run.add_arguments(parser)
    parser.set_defaults(tree="lead", speed=1.0, time_limit=float("inf"), world=WORLDS[1])
    parser.add_argument("--host", default="127.0.0.1", help="address of this machine to serve on (%(default)s)")
    parser.add_argument("--port", type=int, default=8765, help="port, the next that is free (%(default)s)")
    parser.add_argument(
        "--token-file",
        type=Path,
        metavar="FILE",
        help=f"a secret of at least {_LEAST_TOKEN} letters and digits; needed on an address that others can reach",
    )


def execute(options: argparse.Namespace) -> int:
    """Serve the panel until the run ends; 0 when the operator has ended it."""
    if options.review:
        raise UserError("--review asks in the terminal; the panel asks by itself")
    if options.executor != EXECUTORS[0] and options.speed != 1.0:
        raise UserError(f"--executor {options.executor}: runs at --speed 1, got {options.speed:g}")
    from lookstep.commands.report import print_summary
    from lookstep.operate import operate
    from lookstep.panel.address import Address, is_loopback
    from lookstep.summary import Outcome

    token = _token(options.token_file)
    if not is_loopback(options.host) and not token:
        raise UserError(
            f"--host {options.host}: others can reach this address and would lead the robot; "
            "give --token-file FILE, or serve on 127.0.0.1 and come through an SSH tunnel"
        )
    if not 0 <= options.port < 2**16:
        raise UserError(f"--port: got {options.port}, needs 0 to {2**16 - 1}")
    run_options = dataclasses.replace(run.options_of(options), review=True, operated=True)
    link = f"?token={token}" if token else ""
    print("Preparing; the panel opens in a browser once the robot stands.", flush=True)
    summary = operate(
        run_options,
        Address(options.host, options.port, token),
        served=lambda url: print(f"The panel: {url}{link}", flush=True),
        ended=lambda summary: print_summary(summary, run_options),
    )
    if options.json is not None:
        summary.write(options.json)
    return 0 if summary.outcome is Outcome.STOPPED else 1


def _token(file: Path | None) -> str:
    if file is None:
        return ""
    try:
        token = file.read_text(encoding="utf-8").strip()
    except OSError as error:
        raise UserError(f"--token-file {file}: {error.strerror}") from error
    if len(token) < _LEAST_TOKEN or not token.isascii() or not token.isalnum():
        raise UserError(f"--token-file {file}: needs at least {_LEAST_TOKEN} letters and digits, got {len(token)}")
    return token
