"""The frame of a tree file: its name, its ports, the trees it brings along, and where its nodes are written."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from behaviors.blackboard import type_name
from behaviors.leaf import declared_ports
from behaviors.registry import Registry
from strict_yaml import Kind, Location, Node, Problem, YamlError, load_document, nearest

TREE_NAME = re.compile(r"[a-z][a-z0-9_]*")
KEY = re.compile(r"[a-z][a-z0-9_]*")

_FILE_KEYS = ("tree", "about", "include", "ports", "root", "safe_stop", "trees")
_TREE_KEYS = ("about", "ports", "root")


@dataclass(frozen=True, slots=True)
class PortDeclaration:
    """A value that goes into a tree or comes out of it."""

    name: str
    type: Any
    location: Location


@dataclass(slots=True)
class Definition:
    """A tree that a file defines, not yet expanded.

    Attributes:
        name: its name.
        about: one line for people; may be empty.
        location: where it is defined.
        inputs, outputs: its ports.
        root: its root node as written; None where that is missing.
        safe_stop: its safe stop as written; None where there is none.
        trees: the trees that it may use as subtrees, by name.
        problems: what is wrong with this definition's frame and, for that of a file, with those below it.
    """

    name: str
    location: Location
    about: str = ""
    inputs: tuple[PortDeclaration, ...] = ()
    outputs: tuple[PortDeclaration, ...] = ()
    root: Node | None = None
    safe_stop: Node | None = None
    trees: dict[str, Definition] = field(default_factory=dict)
    problems: list[Problem] = field(default_factory=list)


def read_definition(document: Node, registry: Registry, including: tuple[Path, ...] = ()) -> Definition:
    """Read the frame of a file and of those it includes.

    Args:
        document: the file.
        registry: whose ports name the types that ports may have.
        including: the files that led here, to notice a cycle.
    """
    reader = _FrameReader(registry, (*including, Path(document.location.file).resolve()))
    return reader.read_file(document)


class _FrameReader:
    def __init__(self, registry: Registry, including: tuple[Path, ...]) -> None:
        self.registry = registry
        self.including = including
        self.types = port_types(registry)
        self.problems: list[Problem] = []

    def read_file(self, document: Node) -> Definition:
        definition = Definition("", document.location, problems=self.problems)
        if not self._check_keys(document, _FILE_KEYS, ("tree", "root"), "a tree file"):
            return definition
        name = self._text(document.get("tree"))
        if name and not TREE_NAME.fullmatch(name):
            self._add(document.get("tree"), f'got "{name}"; a tree is named in small letters, digits and "_"')
        if name == "safe_stop":
            self._add(document.get("tree"), '"safe_stop" names the branch that is ticked after a fault, not a tree')
        definition.name = name
        self._read_tree(document, definition)
        definition.safe_stop = document.get("safe_stop")
        self._include(document.get("include"), definition)
        self._read_local_trees(document.get("trees"), definition)
        return definition

    def _read_tree(self, node: Node, definition: Definition) -> None:
        definition.about = self._text(node.get("about"))
        definition.root = node.get("root")
        ports = node.get("ports")
        if ports is not None and self._check_keys(ports, ("in", "out"), (), "ports"):
            definition.inputs = self._read_ports(ports.get("in"))
            definition.outputs = self._read_ports(ports.get("out"))

    def _read_ports(self, node: Node | None) -> tuple[PortDeclaration, ...]:
        if node is None:
            return ()
        if node.kind is not Kind.MAPPING:
            self._add(node, f"got {node.describe()}, needs a mapping of port names to types, such as {{goal: Pose}}")
            return ()
        ports = []
        for entry in node.entries:
            declared = self._text(entry.node)
            if not KEY.fullmatch(entry.key):
                self._add(entry.location, f'got port "{entry.key}"; a port is named in small letters, digits and "_"')
            elif declared and declared not in self.types:
                allowed = ", ".join(sorted(self.types))
                hint = nearest(declared, self.types)
                self._add(entry.node, f'unknown type "{declared}"{hint} (types of ports: {allowed})')
            elif declared:
                ports.append(PortDeclaration(entry.key, self.types[declared], entry.location))
        return tuple(ports)

    def _read_local_trees(self, node: Node | None, parent: Definition) -> None:
        if node is None:
            return
        if node.kind is not Kind.MAPPING:
            self._add(node, f"got {node.describe()}, needs a mapping of tree names to trees")
            return
        for entry in node.entries:
            if not TREE_NAME.fullmatch(entry.key):
                self._add(entry.location, f'got "{entry.key}"; a tree is named in small letters, digits and "_"')
            if entry.key in parent.trees:
                self._add(entry.location, f'tree "{entry.key}" is already included from another file')
            if self._check_keys(entry.node, _TREE_KEYS, ("root",), f'tree "{entry.key}"'):
                # Trees of one file see one another; a cycle is noticed when they are expanded.
                definition = Definition(entry.key, entry.location, trees=parent.trees)
                self._read_tree(entry.node, definition)
                parent.trees[entry.key] = definition

    def _include(self, node: Node | None, parent: Definition) -> None:
        if node is None:
            return
        if node.kind is not Kind.SEQUENCE:
            self._add(node, f"got {node.describe()}, needs a list of files")
            return
        for element in node.elements:
            name = self._text(element)
            if name:
                self._include_file(element, name, parent)

    def _include_file(self, node: Node, name: str, parent: Definition) -> None:
        path = Path(node.location.file).parent / name
        if path.resolve() in self.including:
            cycle = " -> ".join(file.name for file in (*self.including, path.resolve()))
            self._add(node, f"files include one another: {cycle}")
            return
        try:
            included = read_definition(load_document(path), self.registry, self.including)
        except YamlError as error:
            self.problems.extend(error.problems)
            self._add(node, f'cannot include "{name}"')
            return
        self.problems.extend(included.problems)
        if included.name in parent.trees:
            self._add(node, f'tree "{included.name}" is already included from another file')
        parent.trees[included.name] = included

    def _check_keys(self, node: Node, allowed: Iterable[str], required: Iterable[str], what: str) -> bool:
        if node.kind is not Kind.MAPPING:
            self._add(node, f"got {node.describe()}, {what} is a mapping with the keys {', '.join(allowed)}")
            return False
        for entry in node.entries:
            if entry.key not in allowed:
                hint = nearest(entry.key, allowed)
                self._add(entry.location, f'unknown key "{entry.key}"{hint} (keys of {what}: {", ".join(allowed)})')
        for key in required:
            if node.get(key) is None:
                self._add(node, f'missing key "{key}" of {what}')
        return True

    def _text(self, node: Node | None) -> str:
        if node is None:
            return ""
        if isinstance(node.value, str) and node.value:
            return node.value
        self._add(node, f"got {node.describe()}, needs text")
        return ""

    def _add(self, place: Node | Location | None, message: str) -> None:
        location = place.location if isinstance(place, Node) else place
        assert location is not None
        self.problems.append(Problem(location, message))


def port_types(registry: Registry) -> dict[str, Any]:
    """The types that a tree's ports may have, by name: plain ones, and those of the leaves' ports."""
    types: dict[str, Any] = {cls.__name__: cls for cls in (bool, int, float, str)}
    for cls in registry.classes:
        for port in declared_ports(cls).values():
            types[type_name(port.type)] = port.type
    return types
