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
