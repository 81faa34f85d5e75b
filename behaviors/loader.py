"""YAML -> a checked `TreeSpec`, with every problem of a file told at once: place, node, value got, what is allowed.

A file names its tree, declares what comes from outside, and describes one root node; `docs/trees.md` states the rules.
Reading goes in three steps: `definition.py` reads the frame of each file, `expansion.py` expands subtrees into one tree
of nodes, `dataflow.py` checks what flows between their ports, `order.py` in which order.
"""

from __future__ import annotations

import importlib
import sys
from collections.abc import Mapping
from importlib.metadata import entry_points
from pathlib import Path

from behaviors.dataflow import check_dataflow
from behaviors.definition import Definition, read_definition
from behaviors.expansion import expand
from behaviors.order import check_order
from behaviors.registry import Registry, leaf
from behaviors.spec import TreeSpec
from strict_yaml import Location, Node, Problem, YamlError, load_document, parse_document

ENTRY_POINTS = "lookstep.leaves"


class Sources:
    """The texts of a tree file and of those it includes, as they are read.

    Args:
        texts: to read from, by path, instead of from the disk; None for the disk.
    """

    def __init__(self, texts: Mapping[str, str] | None = None) -> None:
        self.texts: dict[str, str] = {}
        self._given = texts

    def read(self, path: Path) -> Node:
        """The content of a file.

        Raises:
            YamlError: where it cannot be read.
        """
        if self._given is None:
            document = load_document(path)
            self.texts[str(path)] = path.read_text(encoding="utf-8")
            return document
        # A shipped tree lies elsewhere on another machine.
        by_name = {Path(name).name: text for name, text in self._given.items()}
        text = self._given.get(str(path), by_name.get(path.name))
        if text is None:
            return load_document(path)
        self.texts[str(path)] = text
        return parse_document(text, str(path))


def load_tree(path: str | Path, registry: Registry | None = None, texts: Mapping[str, str] | None = None) -> TreeSpec:
    """Read a tree file.

    Args:
        path: the file.
        registry: the leaves it may name; all that are shipped or installed where None.
        texts: what the files hold, by path, where they are not to be read from the disk.

    Raises:
        YamlError: where the file or one that it includes has problems; holds all of them.
    """
    sources = Sources(texts)
    document = sources.read(Path(path))
    return _load(read_definition(document, _leaves(registry), sources.read), _leaves(registry), sources)


def parse_tree(text: str, registry: Registry | None = None, file: str = "<text>") -> TreeSpec:
    """Read a tree from text; `file` names its origin, from where included files are looked for.

    Raises:
        YamlError: as `load_tree`.
    """
    sources = Sources()
    sources.texts[file] = text
    return _load(
        read_definition(parse_document(text, file), _leaves(registry), sources.read), _leaves(registry), sources
    )


def check(path: str | Path, registry: Registry | None = None) -> tuple[Problem, ...]:
    """All problems of a tree file, in the order of the file; none where it can be run."""
    try:
        load_tree(path, registry)
    except YamlError as error:
        return error.problems
    return ()


def known_leaves() -> Registry:
    """The shipped leaves, and those of installed packages that have an entry point in the group `lookstep.leaves`.

    Raises:
        YamlError: where a package's leaves cannot be loaded.
    """
    importlib.import_module("behaviors.leaves")
    importlib.import_module("behaviors.plain_leaves")
    for entry in entry_points(group=ENTRY_POINTS):
        if entry.value.partition(":")[0] not in sys.modules:
            try:
                entry.load()
            except Exception as error:
                place = Location(f'entry point "{entry.name}" of {ENTRY_POINTS}', 0, 0)
                message = f"cannot load {entry.value}: {type(error).__name__}: {error}"
                raise YamlError([Problem(place, message)]) from error
    return leaf


def _leaves(registry: Registry | None) -> Registry:
    return known_leaves() if registry is None else registry


def _load(definition: Definition, registry: Registry, sources: Sources) -> TreeSpec:
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
        sources=sources.texts,
    )


def _distinct(problems: list[Problem]) -> list[Problem]:
    """A subtree used twice has its problems twice; the first path stands for all."""
    first: dict[tuple[object, str], Problem] = {}
    for problem in problems:
        first.setdefault((problem.location, problem.message), problem)
    return list(first.values())
