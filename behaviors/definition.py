"""The frame of a tree file: its name, its ports, the trees it brings along, and where its nodes are written."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from behaviors.blackboard import type_name
from behaviors.leaf import declared_ports
from behaviors.registry import Registry
from strict_yaml import (
    Entry,
    Kind,
    Location,
    Node,
    Problem,
    YamlError,
    load_document,
    nearest,
    shipped_folder,
)

TREE_NAME = re.compile(r"[a-z][a-z0-9_]*")
KEY = re.compile(r"[a-z][a-z0-9_]*")

_FILE_KEYS = ("tree", "about", "include", "ports", "root", "safe_stop", "trees")
_TREE_KEYS = ("about", "ports", "root")
_PORT_KEYS = ("type", "unit", "frame")

MAXIMUM_INCLUDE_DEPTH = 20
MAXIMUM_FILES = 100


@dataclass(frozen=True, slots=True)
class PortDeclaration:
    """A value that goes into a tree or comes out of it; unit and frame as for the ports of leaves."""

    name: str
    type: Any
    location: Location
    unit: str = "1"
    frame: str = ""


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


def read_definition(document: Node, registry: Registry, read: Callable[[Path], Node] = load_document) -> Definition:
    """Read the frame of a file and of those it includes.

    Args:
        document: the file.
        registry: whose ports name the types that ports may have.
        read: gives the content of an included file; raises YamlError where that is not possible.
    """
    return _FrameReader(registry, (_identity(Path(document.location.file)),), {}, read).read_file(document)


def _identity(path: Path) -> Path:
    """One path for a file that can be named in several ways."""
    return path.resolve()


class _FrameReader:
    """Reads one file.

    Args:
        registry: names the types of ports.
        including: the files that led here, this one last, to notice a cycle.
        read_already: what became of the files that were read before, by path.
        read: gives the content of a file.
    """

    def __init__(
        self,
        registry: Registry,
        including: tuple[Path, ...],
        read_already: dict[Path, Definition],
        read: Callable[[Path], Node],
    ) -> None:
        self.registry = registry
        self.including = including
        self.read_already = read_already
        self.read = read
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
        ports = [self._read_port(entry) for entry in node.entries]
        return tuple(port for port in ports if port is not None)

    def _read_port(self, entry: Entry) -> PortDeclaration | None:
        """A port as `goal: Goal`, or in long as `distance: {type: float, unit: m, frame: world}`."""
        if not KEY.fullmatch(entry.key):
            self._add(entry.location, f'got port "{entry.key}"; a port is named in small letters, digits and "_"')
            return None
        declared, unit, frame = entry.node, "", ""
        if declared.kind is Kind.MAPPING:
            if not self._check_keys(declared, _PORT_KEYS, ("type",), f'port "{entry.key}"'):
                return None
            unit, frame = self._text(declared.get("unit")), self._text(declared.get("frame"))
            declared = declared.get("type")
        name = self._text(declared)
        if not name or declared is None:
            return None
        if name not in self.types:
            allowed = ", ".join(sorted(self.types))
            self._add(declared, f'unknown type "{name}"{nearest(name, self.types)} (types of ports: {allowed})')
            return None
        return PortDeclaration(entry.key, self.types[name], entry.location, unit or "1", frame)

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
        path = self._included_path(node, name)
        if path is None:
            return
        file = _identity(path)
        if file in self.including:
            cycle = " -> ".join(file.name for file in (*self.including, file))
            self._add(node, f"files include one another: {cycle}")
            return
        if file not in self.read_already:
            if len(self.including) >= MAXIMUM_INCLUDE_DEPTH or len(self.read_already) >= MAXIMUM_FILES:
                self._add(node, f"files are included {MAXIMUM_INCLUDE_DEPTH} deep or {MAXIMUM_FILES} in all at most")
                return
            reader = _FrameReader(self.registry, (*self.including, file), self.read_already, self.read)
            try:
                self.read_already[file] = reader.read_file(self.read(path))
            except YamlError as error:
                self.problems.extend(error.problems)
                self._add(node, f'cannot include "{name}"')
                return
        included = self.read_already[file]
        self.problems.extend(included.problems)
        if included.name in parent.trees:
            self._add(node, f'tree "{included.name}" is already included from another file')
        parent.trees[included.name] = included
        for inner, definition in included.trees.items():
            # The trees of an included file go by its name: look_and_step/follow_path.
            if "/" not in inner:
                parent.trees[f"{included.name}/{inner}"] = definition

    def _included_path(self, node: Node, name: str) -> Path | None:
        """The file of a path from here, or of the bare name of a shipped tree."""
        if Path(name).suffix in (".yaml", ".yml"):
            return Path(node.location.file).parent / name
        names = sorted(path.stem for path in shipped_folder("trees").glob("*.yaml"))
        if name in names:
            return shipped_folder("trees") / f"{name}.yaml"
        self._add(node, f'unknown tree "{name}"{nearest(name, names)} (shipped: {", ".join(names)}; or a .yaml file)')
        return None

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
