"""`lookstep leaves`: what a tree file may name, with ports and parameters."""

from __future__ import annotations

import argparse
import re
from pathlib import Path

from lookstep.errors import UserError
from strict_yaml import nearest

NAME = "leaves"
HELP = "list the leaves that a tree file may name, with ports, parameters, units and ranges"
EXAMPLE = "lookstep leaves PlanFootsteps"

_TABLE = re.compile(r"^\| leaf \|.*?(?:\n(?!\|)|\Z)", re.MULTILINE | re.DOTALL)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the leaf and the page."""
    parser.add_argument("name", nargs="?", metavar="LEAF", help="one leaf in full (all, a line each)")
    parser.add_argument("--page", type=Path, metavar="FILE", help="write the table of leaves anew in a Markdown page")


def execute(options: argparse.Namespace) -> int:
    """Print or write."""
    from behaviors import known_leaves
    from behaviors.text import first_line, leaf_page, leaf_table

    registry = known_leaves()
    if options.page is not None:
        text = options.page.read_text(encoding="utf-8") if options.page.is_file() else ""
        if not _TABLE.search(text):
            raise UserError(f'--page {options.page}: has no table that begins with "| leaf |"')
        options.page.write_text(_TABLE.sub(lambda _: leaf_table(registry), text, count=1), encoding="utf-8")
        return 0
    if options.name is None:
        for cls in registry.classes:
            print(f"{cls.__name__:<20}{first_line(cls)}")
        return 0
    cls = registry.get(options.name)
    if cls is None:
        names = registry.names
        raise UserError(f'unknown leaf "{options.name}"{nearest(options.name, names)} (leaves: {", ".join(names)})')
    print(leaf_page(cls))
    return 0
