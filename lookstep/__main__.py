"""The command line: one entry point, one module a command under `lookstep/commands`."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Sequence
from importlib.metadata import version

from lookstep.commands import COMMANDS
from lookstep.errors import UserError
from lookstep.own_leaves import load_leaves
from strict_yaml import YamlError

BAD_INPUT = 2

_DESCRIPTION = (
    "A biped walks over rough ground without stopping to think: look, plan three steps, take one, look again."
)
_EPILOG = """\
start here:
  lookstep demo                          walk the rough course and record it
  lookstep run --course rough --seed 3   one walk, figures at the end
  lookstep tree look_and_step            see how the robot decides
  lookstep --leaves mine.py run --tree mine.yaml
                                         your own tree with your own leaf

exit status: 0 done, 1 the run ended otherwise (fell, timed out), 2 bad input
"""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command; returns the exit status."""
    parser = _parser()
    options = parser.parse_args(arguments)
    try:
        for leaves in options.leaves:
            load_leaves(leaves)
        return options.execute(options)
    except (YamlError, UserError) as error:
        print(error, file=sys.stderr)
        return BAD_INPUT
    except BrokenPipeError:
        # Whoever read our output has read enough; nothing more can be said, not even by Python when it ends.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 1
    except KeyboardInterrupt:
        print("stopped by the operator", file=sys.stderr)
        return 1


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="lookstep",
        description=_DESCRIPTION,
        epilog=_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--version", action="version", version=f"lookstep {version('lookstep')}")
    parser.add_argument(
        "--leaves",
        action="append",
        default=[],
        metavar="FILE",
        help="a Python file (or module) that registers leaves of your own; before the command, may be repeated",
    )
    subparsers = parser.add_subparsers(title="commands", metavar="COMMAND", required=True)
    for command in COMMANDS:
        subparser = subparsers.add_parser(
            command.NAME,
            help=command.HELP,
            description=command.HELP[0].upper() + command.HELP[1:] + ".",
            epilog=f"example:\n  {command.EXAMPLE}",
            formatter_class=argparse.RawDescriptionHelpFormatter,
        )
        command.add_arguments(subparser)
        subparser.set_defaults(execute=command.execute)
    return parser


if __name__ == "__main__":
    sys.exit(main())
