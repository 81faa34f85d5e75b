"""A tree file -> `WrittenFile`, comments kept."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import Any

from behaviors.blackboard import type_name
from behaviors.bodies import get, with_child
from behaviors.check_leaf import Check
from behaviors.composites import COMPOSITES
from behaviors.definition import Definition, PortDeclaration, read_definition
from behaviors.interchange.comments import CommentTable
from behaviors.interchange.written import WrittenFile, WrittenNode, WrittenPort, WrittenTree
from behaviors.kinds import DECORATORS
from behaviors.leaf import Leaf
from behaviors.loader import known_leaves, load_tree, parse_tree
from behaviors.node import Node as TreeNode
from behaviors.registry import Registry
from behaviors.wiring import read_wires
from strict_yaml import Entry, Kind, Node, Scalar, parse_document

# What BehaviorTree.CPP asks for and we have a default for: always written out, so that both forms say the same.
SPELLED_OUT = {"retry": ("attempts",), "repeat": ("times",), "timeout": ("after",)}


def read_written(text: str, file: str = "<text>", registry: Registry | None = None) -> WrittenFile:
    """Read a tree file.

    Args:
        text: of the file.
        file: its path, from where included files are looked for.
        registry: the leaves it may name; all that are known where None.

    Raises:
        YamlError: where the file has problems.
    """
    leaves = registry or known_leaves()
    if Path(file).is_file():
        load_tree(file, leaves)
    else:
        parse_tree(text, leaves, file)
    document = parse_document(text, file)
    definition = read_definition(document, leaves)
    reader = _Reader(leaves, CommentTable(text, _lines(document, file)), file)
    return reader.file(document, definition)


def _lines(node: Node, file: str) -> list[int]:
    """The lines on which keys and plain nodes are written."""
    lines = [entry.location.line for entry in node.entries]
    for below in (*(entry.node for entry in node.entries), *node.elements):
        lines += _lines(below, file)
    if node.kind is Kind.SCALAR:
        lines.append(node.location.line)
    return lines


class _Reader:
    def __init__(self, registry: Registry, comments: CommentTable, file: str) -> None:
        self.registry = registry
        self.comments = comments
        self.main_file = file

    def file(self, document: Node, definition: Definition) -> WrittenFile:
        """The whole file, in the order in which it is written, so that each comment finds its owner."""
        comments = []
        parts: dict[str, object] = {}
        for entry in document.entries:
            if entry.key not in ("root", "safe_stop"):
                comments.append((entry.key, self.comments.take(entry.location.line)))
            else:
                at = entry.location.line
                comments.append((entry.key, self.comments.take(at)))
                parts[entry.key] = self.node(entry.node)
            if entry.key == "trees":
                parts["trees"] = tuple(
                    self._local_tree(tree, definition.trees[tree.key]) for tree in entry.node.entries
                )
        comments.append(("", dataclasses.replace(self.comments.take(-1), above=self.comments.end)))
        root, stop, trees = parts["root"], parts.get("safe_stop"), parts.get("trees", ())
        assert isinstance(root, WrittenNode) and (stop is None or isinstance(stop, WrittenNode))
        assert isinstance(trees, tuple)
        listed = document.get("include")
        include = () if listed is None else tuple(str(element.value) for element in listed.elements)
        local = {tree.name for tree in trees}
        included = [
            (name, self._tree(found, root=None)) for name, found in definition.trees.items() if name not in local
        ]
        return WrittenFile(self._tree(definition, root), include, stop, trees, tuple(included), tuple(comments))

    def _local_tree(self, entry: Entry, definition: Definition) -> WrittenTree:
        comments = self.comments.take(entry.location.line)
        return dataclasses.replace(self._tree(definition, None), comments=comments)

    def _tree(self, definition: Definition, root: WrittenNode | None) -> WrittenTree:
        assert definition.root is not None
        return WrittenTree(
            name=definition.name,
            root=root or self.node(definition.root),
            about=definition.about,
            inputs=_ports(definition.inputs),
            outputs=_ports(definition.outputs),
        )

    def node(self, node: Node) -> WrittenNode:
        """A node with all below it."""
        if node.kind is Kind.SCALAR:
            head = Entry(str(node.value), node.location, Node(Kind.MAPPING, node.location))
        else:
            head = node.entries[0]
        is_here = head.location.file == self.main_file
        comments = self.comments.take(head.location.line) if is_here else WrittenNode("").comments
        return dataclasses.replace(self._bare(head), comments=comments)

    def _bare(self, head: Entry) -> WrittenNode:
        body = head.node
        name = get(body, "name")
        given_name = "" if name is None else str(name.value)
        if head.key == "subtree":
            tree, settings = get(body, "tree"), get(body, "set")
            assert tree is not None
            inputs, outputs = self._wires(body, "in"), self._wires(body, "out")
            values = () if settings is None else tuple((entry.key, entry.node.value) for entry in settings.entries)
            return WrittenNode("subtree", given_name, str(tree.value), inputs, outputs, values)
        if head.key == Check.kind:
            if body.kind is Kind.SCALAR:
                return WrittenNode("check", settings=(("that", body.value),))
            that = get(body, "that")
            assert that is not None
            return WrittenNode("check", given_name, settings=(("that", that.value),))
        if head.key in COMPOSITES:
            if body.kind is Kind.SEQUENCE:
                return WrittenNode(head.key, children=tuple(map(self.node, body.elements)))
            children = get(body, "children")
            assert children is not None
            settings = self._settings(COMPOSITES[head.key], body, head.key)
            return WrittenNode(
                head.key, given_name, settings=settings, children=tuple(map(self.node, children.elements))
            )
        if head.key in DECORATORS:
            cls = DECORATORS[head.key]
            whole = with_child(head, self.registry, "", [])
            below = tuple(self.node(child) for slot in cls.slots if (child := get(whole, slot)) is not None)
            name = get(whole, "name")
            given_name = "" if name is None else str(name.value)
            return WrittenNode(head.key, given_name, settings=self._settings(cls, whole, head.key), children=below)
        leaf = self.registry.get(head.key)
        assert leaf is not None, "the file has been checked"
        inputs, outputs = self._wires(body, "in"), self._wires(body, "out")
        return WrittenNode(head.key, given_name, "", inputs, outputs, self._settings(leaf, body, head.key))

    def _wires(self, body: Node, way: str) -> tuple[tuple[str, str], ...]:
        written = read_wires(get(body, way), _ANY_PORT, way, "", [])
        return tuple((wire.port, wire.key) for wire, _ in written)

    def _settings(self, cls: type[TreeNode] | type[Leaf], body: Node, kind: str) -> tuple[tuple[str, Scalar], ...]:
        fields: dict[str, Any] = {field.name: field.default for field in dataclasses.fields(cls.Parameters)}
        given = {entry.key: entry.node.value for entry in body.entries if entry.key in fields}
        for key in SPELLED_OUT.get(kind, ()):
            given.setdefault(key, fields[key])
        return tuple((key, declared(value, fields[key])) for key, value in given.items())


class _AnyPort(tuple[str, ...]):
    """Holds every name: the ports have been checked."""

    __slots__ = ()

    def __contains__(self, name: object) -> bool:
        return True


_ANY_PORT = _AnyPort()


def declared(value: Scalar, default: object) -> Scalar:
    """A whole number as the float that its parameter is."""
    return float(value) if isinstance(default, float) and type(value) is int else value


def _ports(ports: tuple[PortDeclaration, ...]) -> tuple[WrittenPort, ...]:
    return tuple(WrittenPort(port.name, type_name(port.type), port.unit, port.frame) for port in ports)
