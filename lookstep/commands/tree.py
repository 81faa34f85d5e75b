"""`lookstep tree`: a behavior tree drawn in the terminal."""

from __future__ import annotations

import argparse

from lookstep.trees import tree_path

NAME = "tree"
HELP = "draw a behavior tree in the terminal"
EXAMPLE = "lookstep tree look_and_step"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the file."""
    parser.add_argument("file", metavar="FILE", help="tree file, or the name of a shipped tree")


def execute(options: argparse.Namespace) -> int:
    """Draw it."""
    import behaviors

    print(behaviors.draw(behaviors.load_tree(tree_path(options.file))))
    return 0
