"""YAML -> a checked `TreeSpec`, with every problem of a file told at once: place, node, value got, what is allowed.

A file names its tree, declares what comes from outside, and describes one root node; `docs/trees.md` states the rules.
Reading goes in three steps: `definition.py` reads the frame of each file, `expansion.py` expands subtrees into one tree
of nodes, `dataflow.py` checks what flows between their ports, `order.py` in which order.
"""

from __future__ import annotations

import importlib
from pathlib import Path

from behaviors.dataflow import check_dataflow
from behaviors.definition import Definition, read_definition
from behaviors.expansion import expand
from behaviors.order import check_order
from behaviors.registry import Registry, leaf
from behaviors.spec import TreeSpec
from strict_yaml import Problem, YamlError, load_document, parse_document


def load_tree(path: str | Path, registry: Registry | None = None) -> TreeSpec:
    """Read a tree file.

    Args:
        path: the file.
        registry: the leaves it may name; all that are shipped where None.

    Raises:
        YamlError: where the file or one that it includes has problems; holds all of them.
    """
    return _load(read_definition(load_document(path), _leaves(registry)), _leaves(registry))


def parse_tree(text: str, registry: Registry | None = None, file: str = "<text>") -> TreeSpec:
    """Read a tree from text; `file` names its origin, from where included files are looked for.

    Raises:
        YamlError: as `load_tree`.
    """
    return _load(read_definition(parse_document(text, file), _leaves(registry)), _leaves(registry))


def check(path: str | Path, registry: Registry | None = None) -> tuple[Problem, ...]:
    """All problems of a tree file, in the order of the file; none where it can be run."""
    try:
        load_tree(path, registry)
    except YamlError as error:
        return error.problems
    return ()


def _leaves(registry: Registry | None) -> Registry:
    if registry is not None:
        return registry
    importlib.import_module("behaviors.leaves")
    importlib.import_module("behaviors.plain_leaves")
    return leaf


def _load(definition: Definition, registry: Registry) -> TreeSpec:
    problems, remarks = list(definition.problems), list[Problem]()
    expansion = expand(definition, registry, problems)
    keys = check_dataflow(expansion, problems, remarks)
    check_order(expansion, problems)
    if problems or expansion.root is None:
        raise YamlError(_distinct(problems))
    return TreeSpec(
        name=definition.name,
        about=definition.about,
        file=definition.location.file,
        inputs={port.name: port.type for port in definition.inputs},
        outputs={port.name: port.type for port in definition.outputs},
        keys=keys,
        root=expansion.root,
        safe_stop=expansion.safe_stop,
        remarks=tuple(sorted(_distinct(remarks))),
    )


def _distinct(problems: list[Problem]) -> list[Problem]:
    """A subtree used twice has its problems twice; the first path stands for all."""
    first: dict[tuple[object, str], Problem] = {}
    for problem in problems:
        first.setdefault((problem.location, problem.message), problem)
    return list(first.values())
