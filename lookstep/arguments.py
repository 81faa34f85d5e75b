"""Arguments that several commands take."""

from __future__ import annotations

import argparse


def add_assignments(parser: argparse.ArgumentParser, meaning: str) -> None:
    """Declare `--set KEY=VALUE`, which fills the list `assignments`.

    Args:
        parser: of the command.
        meaning: what may be set, for `--help`.
    """
    parser.add_argument(
        "--set",
        dest="assignments",
        action="append",
        default=[],
        metavar="KEY=VALUE",
        help=f"{meaning}; may be repeated",
    )


def positive(text: str) -> int:
    """A whole number from 1, as the `type` of an argument.

    Raises:
        ArgumentTypeError: where it is none.
    """
    if not text.isdecimal() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"got {text!r}, needs a whole number from 1")
    return int(text)
