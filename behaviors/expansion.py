"""Expands the definitions of a tree file into one tree of node specs, and notes what flows where.

A subtree is replaced by its root, under the name of its use; the keys inside get its path before them, except those
that are its ports, which become the keys that the use wires them to.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import Any

from behaviors.composites import COMPOSITES
from behaviors.decorators import Decorator
from behaviors.definition import KEY, Definition
from behaviors.kinds import DECORATORS
from behaviors.leaf import Leaf
from behaviors.ports import declared_inputs, declared_outputs
from behaviors.registry import Registry
from behaviors.spec import NodeSpec, Wire
from strict_yaml import Entry, Kind, Location, Node, Problem, nearest, read_dataclass

MAXIMUM_NODES = 5000
MAXIMUM_DEPTH = 100

_NODE_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_ -]*")
_SUBTREE_KEYS = ("tree", "name", "in", "out")


@dataclass(frozen=True, slots=True)
class Use:
    """A port at the end of a key."""

    key: str
    type: Any
    location: Location
    path: str
    port: str


@dataclass(slots=True)
class Expansion:
    """What became of a definition.

    Attributes:
        definition: what was expanded.
        root, safe_stop: the trees; None where they could not be read or are not there.
        reads, writes: the ports at the ends of all keys.
    """

    definition: Definition
    root: NodeSpec | None = None
    safe_stop: NodeSpec | None = None
    reads: list[Use] = field(default_factory=list)
    writes: list[Use] = field(default_factory=list)


def expand(definition: Definition, registry: Registry, problems: list[Problem]) -> Expansion:
    """Expand a definition; problems are appended."""
    expansion = Expansion(definition)
    expander = _Expander(registry, problems, expansion)
    scope = _Scope(definition, stack=(definition.name,))
    if definition.root is not None:
        expansion.root = expander.root(definition.root, scope, f"/{definition.name}", definition.name)
    if definition.safe_stop is not None:
        expansion.safe_stop = expander.root(definition.safe_stop, scope, "/safe_stop", "safe_stop")
    expander.check_unused(definition)
    return expansion


@dataclass(frozen=True, slots=True)
class _Scope:
    """Where a name is looked up.

    Attributes:
        definition: the tree around.
        prefix: what goes before a key that is no port, such as "recover/".
        ports: keys that the ports of the tree around are wired to, by port.
        stack: names of the trees around, the outermost first.
    """

    definition: Definition
    prefix: str = ""
    ports: dict[str, str] = field(default_factory=dict)
    stack: tuple[str, ...] = ()

    def key(self, name: str) -> str:
        return self.ports.get(name, self.prefix + name)


class _Expander:
    def __init__(self, registry: Registry, problems: list[Problem], expansion: Expansion) -> None:
        self.registry = registry
        self.problems = problems
        self.expansion = expansion
        self.used: set[int] = set()
        self.nodes = 0

    def root(self, node: Node, scope: _Scope, path: str, name: str) -> NodeSpec | None:
        """The root of a tree, under a name that it does not choose itself."""
        head = self._head(node, path)
        if head is None:
            return None
        given = _get(head.node, "name")
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
                apart.root(tree.root, _Scope(tree, "?", ports, (tree.name,)), f"/{tree.name}", tree.name)

    def _head(self, node: Node, path: str) -> Entry | None:
        """The kind and body of a node: `kind: body`, or the kind alone."""
        if node.kind is Kind.SCALAR and isinstance(node.value, str):
            return Entry(node.value, node.location, Node(Kind.MAPPING, node.location))
        if node.kind is not Kind.MAPPING or len(node.entries) != 1:
            got = f"the keys {', '.join(node.keys)}" if node.entries else node.describe()
            self._add(node, f'got {got}; a node is one key, its kind, such as "- sequence: [...]"', path)
            return None
        return node.entries[0]

    def _node(self, head: Entry, scope: _Scope, path: str, name: str, depth: int) -> NodeSpec | None:
        self.nodes += 1
        if self.nodes > MAXIMUM_NODES or depth > MAXIMUM_DEPTH:
            limit = f"more than {MAXIMUM_NODES} nodes" if self.nodes > MAXIMUM_NODES else f"deeper than {MAXIMUM_DEPTH}"
            self._add(head.location, f"the tree is {limit}, subtrees expanded", "")
            return None
        if head.key == "subtree":
            return self._subtree(head, scope, path, name, depth)
        if head.key in COMPOSITES:
            return self._composite(head, scope, path, name, depth)
        if head.key in DECORATORS:
            return self._decorator(head, scope, path, name, depth)
        cls = self.registry.get(head.key)
        if cls is not None:
            return self._leaf(cls, head, scope, path, name)
        self._unknown(head, path)
        return None

    def _unknown(self, head: Entry, path: str) -> None:
        kinds = ("subtree", *COMPOSITES, *DECORATORS)
        is_leaf = head.key[:1].isupper()
        what, names, where = ("leaf", self.registry.names, "leaves") if is_leaf else ("node", kinds, "nodes")
        hint = nearest(head.key, (*kinds, *self.registry.names))
        self._add(head.location, f'unknown {what} "{head.key}"{hint} ({where}: {", ".join(names)})', path)

    def _composite(self, head: Entry, scope: _Scope, path: str, name: str, depth: int) -> NodeSpec | None:
        cls = COMPOSITES[head.key]
        body = head.node
        if body.kind is Kind.SEQUENCE:
            body = Node(Kind.MAPPING, body.location, (Entry("children", body.location, body),))
        parameters, given = self._parameters(cls, head, body, ("name", "children"), path)
        listed = _get(body, "children")
        if listed is None or listed.kind is not Kind.SEQUENCE or not listed.elements:
            got = "nothing" if listed is None else listed.describe()
            self._add(listed or head.location, f"got {got}, needs a list of children", path)
            return None
        children = self._children([(element, "") for element in listed.elements], scope, path, depth)
        return NodeSpec(cls, head.key, name, path, head.location, parameters, given, children=children)

    def _decorator(self, head: Entry, scope: _Scope, path: str, name: str, depth: int) -> NodeSpec | None:
        cls: type[Decorator] = DECORATORS[head.key]
        parameters, given = self._parameters(cls, head, head.node, ("name", *cls.slots), path)
        missing = [slot for slot in cls.slots if _get(head.node, slot) is None]
        for slot in missing:
            self._add(head.location, f'missing key "{slot}"', path)
        slots = [(head.node.get(slot), slot) for slot in cls.slots if slot not in missing]
        children = self._children([(node, slot) for node, slot in slots if node], scope, path, depth)
        return NodeSpec(cls, head.key, name, path, head.location, parameters, given, children=children)

    def _children(self, nodes: list[tuple[Node, str]], scope: _Scope, path: str, depth: int) -> tuple[NodeSpec, ...]:
        heads = [head for node, _ in nodes if (head := self._head(node, path)) is not None]
        names = self._names(heads, scope, path)
        children = [
            self._node(head, scope, f"{path}/{_slug(name)}", name, depth + 1)
            for head, name in zip(heads, names, strict=True)
        ]
        return tuple(child for child in children if child is not None)

    def _names(self, heads: list[Entry], scope: _Scope, path: str) -> list[str]:
        """Names of siblings: those given, which must differ, and for the others one made from the kind."""
        taken: dict[str, Location] = {}
        names: list[str] = []
        for head in heads:
            node = _get(head.node, "name")
            name = node.value if node is not None else ""
            if node is not None and not (isinstance(name, str) and _NODE_NAME.fullmatch(name)):
                self._add(node, f'got {node.describe()}; a name is letters, digits, spaces, "_" and "-"', path)
                name = ""
            if node is not None and name and _slug(str(name)) in taken:
                first = taken[_slug(str(name))]
                self._add(node, f'two siblings are named "{name}", the first on line {first.line}', path)
            elif node is not None and name:
                taken[_slug(str(name))] = node.location
            names.append(str(name or ""))
        for index, head in enumerate(heads):
            if not names[index]:
                names[index] = _free_name(_default_name(head), taken)
                taken[_slug(names[index])] = head.location
        return names

    def _subtree(self, head: Entry, scope: _Scope, path: str, name: str, depth: int) -> NodeSpec | None:
        if not self._check_keys(head, head.node, _SUBTREE_KEYS, path):
            return None
        chosen = _get(head.node, "tree")
        trees = scope.definition.trees
        if chosen is None or not isinstance(chosen.value, str):
            self._add(chosen or head.location, 'missing key "tree": the name of a tree of this file', path)
            return None
        definition = trees.get(chosen.value)
        if definition is None:
            hint = nearest(chosen.value, trees)
            self._add(
                chosen, f'unknown tree "{chosen.value}"{hint} (trees: {", ".join(sorted(trees)) or "none"})', path
            )
            return None
        self.used.add(id(definition))
        if definition.name in scope.stack:
            self._add(chosen, f"a tree contains itself: {' -> '.join((*scope.stack, definition.name))}", path)
            return None
        inner = _Scope(
            definition,
            self._prefix(path),
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
        return NodeSpec(
            spec.cls,
            spec.kind,
            spec.name,
            spec.path,
            spec.location,
            spec.parameters,
            spec.given,
            spec.inputs,
            spec.outputs,
            spec.children,
            definition.name,
        )

    def _wire_tree(self, head: Entry, definition: Definition, scope: _Scope, path: str) -> dict[str, str]:
        ports: dict[str, str] = {}
        inputs = {port.name: port.type for port in definition.inputs}
        outputs = {port.name: port.type for port in definition.outputs}
        for wire, location in self._wires(_get(head.node, "in"), inputs, "input", scope, path):
            ports[wire.port] = wire.key
            self.expansion.reads.append(Use(wire.key, inputs[wire.port], location, path, wire.port))
        for name in inputs:
            if name not in ports:
                self._add(head.location, f'input "{name}" of tree "{definition.name}" is not wired', path)
        for wire, _ in self._wires(_get(head.node, "out"), outputs, "output", scope, path):
            ports[wire.port] = wire.key
        return ports

    def _leaf(self, cls: type[Leaf], head: Entry, scope: _Scope, path: str, name: str) -> NodeSpec:
        parameters, given = self._parameters(cls, head, head.node, ("name", "in", "out"), path)
        inputs, outputs = declared_inputs(cls), declared_outputs(cls)
        types = {port: declared.type for port, declared in inputs.items()}
        reads = self._wires(_get(head.node, "in"), types, "input", scope, path)
        for wire, location in reads:
            self.expansion.reads.append(Use(wire.key, inputs[wire.port].type, location, path, wire.port))
        wired = {wire.port for wire, _ in reads}
        for port, declared in inputs.items():
            if declared.required and port not in wired:
                self._add(head.location, f'input "{port}" of {head.key} is not wired', path)
        types = {port: declared.type for port, declared in outputs.items()}
        writes = self._wires(_get(head.node, "out"), types, "output", scope, path)
        for wire, location in writes:
            self.expansion.writes.append(Use(wire.key, outputs[wire.port].type, location, path, wire.port))
        return NodeSpec(
            cls,
            head.key,
            name,
            path,
            head.location,
            parameters,
            given,
            tuple(wire for wire, _ in reads),
            tuple(wire for wire, _ in writes),
        )

    def _wires(
        self, node: Node | None, ports: dict[str, Any], what: str, scope: _Scope, path: str
    ) -> list[tuple[Wire, Location]]:
        """Wires as written: `{port: key}`, or a list of ports whose keys have the same names."""
        if node is None:
            return []
        if node.kind is Kind.SEQUENCE:
            pairs = [(str(element.value), element.location, element) for element in node.elements]
        elif node.kind is Kind.MAPPING:
            pairs = list(node.entries)
        else:
            self._add(node, f"got {node.describe()}, needs a list of ports or a mapping of ports to keys", path)
            return []
        wires = []
        for port, location, key in pairs:
            if port not in ports:
                allowed = ", ".join(ports) or "none"
                self._add(location, f'unknown {what} "{port}"{nearest(port, ports)} ({what}s: {allowed})', path)
            elif not isinstance(key.value, str) or not KEY.fullmatch(key.value):
                self._add(key, f'got {key.describe()}; a key is named in small letters, digits and "_"', path)
            else:
                wires.append((Wire(port, scope.key(key.value)), key.location))
        return wires

    def _parameters(
        self, cls: type[Any], head: Entry, body: Node, structural: tuple[str, ...], path: str
    ) -> tuple[Any, tuple[str, ...]]:
        """The parameters in a body, which are all its keys that are not structural."""
        fields = tuple(cls.Parameters.__dataclass_fields__)
        if not self._check_keys(head, body, (*structural, *fields), path):
            return None, ()
        entries = tuple(entry for entry in body.entries if entry.key in fields)
        parameters = read_dataclass(Node(Kind.MAPPING, body.location, entries), cls.Parameters, self.problems, path)
        return parameters, tuple(entry.key for entry in entries)

    def _check_keys(self, head: Entry, body: Node, allowed: tuple[str, ...], path: str) -> bool:
        if body.kind is Kind.SCALAR and body.value is None:
            return True
        if body.kind is not Kind.MAPPING:
            self._add(body, f"got {body.describe()}, {head.key} takes a mapping of {', '.join(allowed)}", path)
            return False
        for entry in body.entries:
            if entry.key not in allowed:
                hint = nearest(entry.key, allowed)
                self._add(entry.location, f'unknown key "{entry.key}"{hint} ({head.key}: {", ".join(allowed)})', path)
        return True

    def _prefix(self, path: str) -> str:
        """What goes before the keys inside a subtree: its path without the name of the whole tree."""
        return path.removeprefix(f"/{self.expansion.definition.name}").lstrip("/") + "/"

    def _add(self, place: Node | Location, message: str, path: str) -> None:
        location = place.location if isinstance(place, Node) else place
        self.problems.append(Problem(location, message, path))


def _get(body: Node, key: str) -> Node | None:
    return body.get(key) if body.kind is Kind.MAPPING else None


def _default_name(head: Entry) -> str:
    if head.key == "subtree":
        tree = _get(head.node, "tree")
        return str(tree.value) if tree is not None else "subtree"
    return re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", head.key).lower()


def _free_name(name: str, taken: dict[str, Location]) -> str:
    if name not in taken:
        return name
    count = 2
    while f"{name}_{count}" in taken:
        count += 1
    return f"{name}_{count}"


def _slug(name: str) -> str:
    return name.replace(" ", "_").lower()
