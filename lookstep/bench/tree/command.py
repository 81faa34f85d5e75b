"""`lookstep bench tree`: one tick of a tree of 60 nodes, with ports, trace and deadlines, beside plain py_trees."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from lookstep.bench.subject import Progress, Report

NAME = "tree"
HELP = "one tick of a tree of 60 nodes with ports and trace, beside the same tree in plain py_trees"
EXAMPLE = "lookstep bench tree --quick"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Nothing besides what every subject takes."""


def measure(options: argparse.Namespace, progress: Progress) -> Report:
    """Tick both trees in turn."""
    from lookstep.bench.tree.report import bench_tree

    return bench_tree(progress, rounds=10 if options.quick else 40)
