"""Expands the definitions of a tree file into one tree of node specs, and notes what flows where.

A subtree is replaced by its root, under the name of its use; the keys inside get its path before them, except those
that are its ports, which become the keys that the use wires them to.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Sequence
from typing import Any

from behaviors.bodies import check_keys, get, is_scalar, read_parameters, seen_below, with_child
from behaviors.check_leaf import Check
from behaviors.composites import COMPOSITES
from behaviors.decorators import Decorator
from behaviors.definition import Definition
from behaviors.expression import ExpressionError, parse_expression
from behaviors.kinds import DECORATORS, unknown_kind
from behaviors.leaf import Leaf
from behaviors.naming import sibling_names, slug
from behaviors.overrides import override
from behaviors.ports import declared_inputs, declared_outputs
from behaviors.registry import Registry
from behaviors.scope import Condition, Expansion, Scope, Use
from behaviors.spec import NodeSpec, Wire
from behaviors.wiring import named_ports, read_wires, written_keys
from strict_yaml import Entry, Kind, Location, Node, Problem, nearest

MAXIMUM_NODES = 5000
MAXIMUM_DEPTH = 100

_SUBTREE_KEYS = ("tree", "name", "in", "out", "set")


def place_in(node: Node, offset: int) -> Location:
    """Where a character of a scalar's text is written."""
    if not node.text_column:
        return node.location
    return dataclasses.replace(node.location, column=node.text_column + offset)


def expand(definition: Definition, registry: Registry, problems: list[Problem]) -> Expansion:
    """Expand a definition; problems are appended."""
    expansion = Expansion(definition)
    expander = _Expander(registry, problems, expansion)
    scope = Scope(definition, stack=(definition.name,))
    if definition.root is not None:
        expansion.root = expander.root(definition.root, scope, f"/{definition.name}", definition.name)
    if definition.safe_stop is not None:
        expansion.safe_stop = expander.root(definition.safe_stop, scope, "/safe_stop", "safe_stop")
    expander.check_unused(definition)
    return expansion


class _Expander:
    def __init__(self, registry: Registry, problems: list[Problem], expansion: Expansion) -> None:
        self.registry = registry
        self.problems = problems
        self.expansion = expansion
        self.used: set[int] = set()
        self.nodes = 0

    def root(self, node: Node, scope: Scope, path: str, name: str) -> NodeSpec | None:
        """The root of a tree, under a name that it does not choose itself."""
        head = self._head(node, path)
        if head is None:
            return None
        given = get(head.node, "name")
        if given is not None:
            self._add(given, "a root takes the name of its tree", path)
        return self._node(head, scope, path, name, depth=1)

    def check_unused(self, definition: Definition) -> None:
        """Expand trees that nothing uses, so that their problems are told as well."""
        for tree in tuple(definition.trees.values()):
            if id(tree) not in self.used and tree.root is not None:
                self.used.add(id(tree))
                ports = {port.name: f"?{port.name}" for port in (*tree.inputs, *tree.outputs)}
                apart = _Expander(self.registry, self.problems, Expansion(tree))
                apart.used = self.used
                apart.root(tree.root, Scope(tree, "?", ports, (tree.name,)), f"/{tree.name}", tree.name)
            if tree.trees is not definition.trees:
                self.check_unused(tree)

    def _head(self, node: Node, path: str) -> Entry | None:
        """The kind and body of a node: `kind: body`, or the kind alone."""
        if node.kind is Kind.SCALAR and isinstance(node.value, str):
            return Entry(node.value, node.location, Node(Kind.MAPPING, node.location))
        if node.kind is not Kind.MAPPING or len(node.entries) != 1:
            got = f"the keys {', '.join(node.keys)}" if node.entries else node.describe()
            self._add(node, f'got {got}; a node is one key, its kind, such as "- sequence: [...]"', path)
            return None
        return node.entries[0]

    def _node(self, head: Entry, scope: Scope, path: str, name: str, depth: int) -> NodeSpec | None:
        self.nodes += 1
        if self.nodes > MAXIMUM_NODES or depth > MAXIMUM_DEPTH:
            limit = f"more than {MAXIMUM_NODES} nodes" if self.nodes > MAXIMUM_NODES else f"deeper than {MAXIMUM_DEPTH}"
            self._add(head.location, f"the tree is {limit}, subtrees expanded", "")
            return None
        if head.key == "subtree":
            return self._subtree(head, scope, path, name, depth)
        if head.key == Check.kind:
            return self._check(head, scope, path, name)
        if head.key in COMPOSITES:
            return self._composite(head, scope, path, name, depth)
        if head.key in DECORATORS:
            return self._decorator(head, scope, path, name, depth)
        cls = self.registry.get(head.key)
        if cls is not None:
            return self._leaf(cls, head, scope, path, name)
        self._add(head.location, unknown_kind(head.key, self.registry), path)
        self._doubt(head, scope)
        self._children(seen_below(head.node, self.registry), scope, path, depth)
        return None

    def _doubt(self, head: Entry, scope: Scope) -> None:
        """Do not say of the outputs of a node that cannot be read that nothing writes them."""
        keys = written_keys(get(head.node, "out"))
        self.expansion.doubtful.update(scope.key(key) for key in keys)

    def _composite(self, head: Entry, scope: Scope, path: str, name: str, depth: int) -> NodeSpec | None:
        cls = COMPOSITES[head.key]
        body = head.node
        if body.kind is Kind.SEQUENCE:
            body = Node(Kind.MAPPING, body.location, (Entry("children", body.location, body),))
        parameters, given = self._parameters(cls, head, body, ("name", "children"), path)
        if is_scalar(body):
            return None
        listed = get(body, "children")
        if listed is None or listed.kind is not Kind.SEQUENCE or not listed.elements:
            got = "nothing" if listed is None else listed.describe() if listed.elements else "none"
            self._add(listed or head.location, f"got {got}, needs a list of children", path)
            return None
        children = self._children(listed.elements, scope, path, depth)
        return NodeSpec(cls, head.key, name, path, head.location, parameters, given, children=children)

    def _decorator(self, head: Entry, scope: Scope, path: str, name: str, depth: int) -> NodeSpec | None:
        cls: type[Decorator] = DECORATORS[head.key]
        body = with_child(head, self.registry, path, self.problems)
        parameters, given = self._parameters(cls, head, body, ("name", *cls.slots), path)
        if is_scalar(body):
            return None
        slots = [(slot, get(body, slot)) for slot in cls.slots]
        for slot, node in slots:
            if node is None:
                self._add(head.location, f"{head.key} needs a {slot}", path)
        children = self._children([node for _, node in slots if node is not None], scope, path, depth)
        return NodeSpec(cls, head.key, name, path, head.location, parameters, given, children=children)

    def _children(self, nodes: Sequence[Node], scope: Scope, path: str, depth: int) -> tuple[NodeSpec, ...]:
        heads = [head for node in nodes if (head := self._head(node, path)) is not None]
        names = sibling_names(heads, path, self.problems)
        children = [
            self._node(head, scope, f"{path}/{slug(name)}", name, depth + 1)
            for head, name in zip(heads, names, strict=True)
        ]
        return tuple(child for child in children if child is not None)

    def _subtree(self, head: Entry, scope: Scope, path: str, name: str, depth: int) -> NodeSpec | None:
        if not check_keys(head, _SUBTREE_KEYS, path, self.problems):
            return None
        chosen = get(head.node, "tree")
        trees = scope.definition.trees
        if chosen is None or not isinstance(chosen.value, str):
            self._add(chosen or head.location, 'missing key "tree": the name of a tree of this file', path)
            return None
        definition = trees.get(chosen.value)
        if definition is None:
            self._doubt(head, scope)
            hint = nearest(chosen.value, trees)
            self._add(
                chosen, f'unknown tree "{chosen.value}"{hint} (trees: {", ".join(sorted(trees)) or "none"})', path
            )
            return None
        self.used.add(id(definition))
        if definition.name in scope.stack:
            self._add(chosen, f"a tree contains itself: {' -> '.join((*scope.stack, definition.name))}", path)
            return None
        inner = Scope(
            definition,
            self.expansion.prefix(path),
            self._wire_tree(head, definition, scope, path),
            (*scope.stack, definition.name),
        )
        if definition.root is None:
            return None
        root = self._head(definition.root, path)
        if root is None:
            return None
        spec = self._node(root, inner, path, name, depth)
        if spec is None:
            return None
        return override(dataclasses.replace(spec, subtree=definition.name), get(head.node, "set"), self.problems)

    def _wire_tree(self, head: Entry, definition: Definition, scope: Scope, path: str) -> dict[str, str]:
        ports: dict[str, str] = {}
        inputs = {port.name: port for port in definition.inputs}
        outputs = {port.name: port for port in definition.outputs}
        for wire, location in self._wires(head, "in", inputs, scope, path):
            port = inputs[wire.port]
            ports[wire.port] = wire.key
            self.expansion.reads.append(Use(wire.key, port.type, location, path, wire.port, port.unit, port.frame))
        for name in inputs:
            if name not in named_ports(get(head.node, "in")):
                self._add(head.location, f'input "{name}" of tree "{definition.name}" is not wired', path)
        for wire, location in self._wires(head, "out", outputs, scope, path):
            port = outputs[wire.port]
            ports[wire.port] = wire.key
            self.expansion.handed_out.append(Use(wire.key, port.type, location, path, wire.port, port.unit, port.frame))
        self.expansion.dropped.update(self.expansion.prefix(path) + name for name in outputs if name not in ports)
        return ports

    def _leaf(self, cls: type[Leaf], head: Entry, scope: Scope, path: str, name: str) -> NodeSpec:
        parameters, given = self._parameters(cls, head, head.node, ("name", "in", "out"), path)
        inputs, outputs = declared_inputs(cls), declared_outputs(cls)
        reads = self._wires(head, "in", inputs, scope, path)
        for wire, location in reads:
            port = inputs[wire.port]
            self.expansion.reads.append(Use(wire.key, port.type, location, path, wire.port, port.unit, port.frame))
        named = named_ports(get(head.node, "in"))
        for port, declared in inputs.items():
            if declared.required and port not in named:
                self._add(head.location, f'input "{port}" of {head.key} is not wired', path)
        writes = self._wires(head, "out", outputs, scope, path)
        for wire, location in writes:
            port = outputs[wire.port]
            self.expansion.writes.append(Use(wire.key, port.type, location, path, wire.port, port.unit, port.frame))
        wires = (tuple(wire for wire, _ in reads), tuple(wire for wire, _ in writes))
        return NodeSpec(cls, head.key, name, path, head.location, parameters, given, *wires)

    def _check(self, head: Entry, scope: Scope, path: str, name: str) -> NodeSpec | None:
        """A condition: `check: left > 0`, or a mapping with the condition under `that`."""
        body = head.node
        if body.kind is Kind.SCALAR and body.value is not None:
            body = Node(Kind.MAPPING, body.location, (Entry("that", body.location, body),))
        if get(body, "that") is None:
            self._add(head.location, 'check needs a condition, such as "check: left > 0"', path)
            return None
        parameters, given = self._parameters(Check, head, body, ("name",), path)
        if parameters is None:
            return None
        written = get(body, "that")
        assert written is not None
        try:
            names = parse_expression(parameters.that).names
        except ExpressionError as error:
            self._add(place_in(written, error.offset), error.message, path)
            return None
        wires = tuple(Wire(key, scope.key(key)) for key, _ in names)
        for wire, (_, offset) in zip(wires, names, strict=True):
            self.expansion.reads.append(Use(wire.key, Any, place_in(written, offset), path, wire.port))
        self.expansion.conditions.append(Condition(path, parameters.that, wires, written))
        return NodeSpec(Check, head.key, name, path, head.location, parameters, given, wires)

    def _wires(
        self, head: Entry, direction: str, ports: Iterable[str], scope: Scope, path: str
    ) -> list[tuple[Wire, Location]]:
        """The wires of a body, with keys as the whole tree knows them."""
        node = get(head.node, direction)
        written = read_wires(node, ports, direction, path, self.problems)
        if direction == "out" and len(written) < len(named_ports(node)):
            self._doubt(head, scope)
        return [(Wire(wire.port, scope.key(wire.key)), location) for wire, location in written]

    def _parameters(self, cls: type[Any], head: Entry, body: Node, structural: tuple[str, ...], path: str) -> Any:
        return read_parameters(cls.Parameters, Entry(head.key, head.location, body), structural, path, self.problems)

    def _add(self, place: Node | Location, message: str, path: str) -> None:
        location = place.location if isinstance(place, Node) else place
        self.problems.append(Problem(location, message, path))
