"""BehaviorTree.CPP 4 XML -> `WrittenFile`, with every node and attribute that we cannot say told at its place."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from behaviors.composites import COMPOSITES
from behaviors.decorators import Decorator
from behaviors.definition import KEY, MAXIMUM_INCLUDE_DEPTH, TREE_NAME
from behaviors.interchange.read_tree import SPELLED_OUT
from behaviors.interchange.written import WrittenFile, WrittenNode, WrittenPort, WrittenTree
from behaviors.interchange.xml_elements import Element, parse_elements
from behaviors.interchange.xml_names import BUILTINS, BY_TAG, OWN, from_script, tree_name
from behaviors.interchange.xml_palette import read_about_port
from behaviors.kinds import DECORATORS
from behaviors.leaf import Leaf
from behaviors.ports import declared_inputs, declared_outputs
from behaviors.registry import Registry
from strict_yaml import Problem, Scalar, YamlError, nearest

_EXPLICIT = ("Action", "Condition", "Control", "Decorator")
_SAFE_STOP = "safe_stop"


def read_xml(text: str, registry: Registry, file: str = "<text>") -> WrittenFile:
    """Read an XML file; leaves must be in the registry.

    Raises:
        YamlError: with everything that cannot be said in a tree file of ours.
    """
    root = parse_elements(text, file)
    problems: list[Problem] = []
    written = _Reader(registry, problems).file(root, Path(file))
    if problems or written is None:
        raise YamlError(problems)
    return written


class _Reader:
    def __init__(self, registry: Registry, problems: list[Problem]) -> None:
        self.registry = registry
        self.problems = problems
        self.models: dict[str, Element] = {}

    def file(self, root: Element, path: Path) -> WrittenFile | None:
        """The whole file, with the trees of those that it includes."""
        if root.tag != "root":
            self._add(root, f'got <{root.tag}>, needs <root BTCPP_format="4">')
            return None
        if root.attributes.get("BTCPP_format", "4") != "4":
            self._add(root, f"got BTCPP_format {root.attributes['BTCPP_format']}, reads 4")
        elements: dict[str, Element] = {}
        self._gather(root, (path.resolve(),), elements)
        main = root.attributes.get("main_tree_to_execute", next(iter(elements), ""))
        if main not in elements:
            self._add(root, f'no <BehaviorTree ID="{main}">{nearest(main, elements)}')
            return None
        stop = elements.pop(_SAFE_STOP, None)
        trees = {
            name: self._tree(name, element)
            for name, element in elements.items()
            if self._metadata(name).get("included") != "true"
        }
        safe_stop = None if stop is None else self._only_child(stop)
        tree = trees.pop(main, None)
        others = tuple(found for found in trees.values() if found is not None)
        if tree is None:
            return None
        include = tuple(self._metadata(main).get("include", "").split())
        return WrittenFile(tree, include, safe_stop, others)

    def _gather(self, root: Element, including: tuple[Path, ...], elements: dict[str, Element]) -> None:
        """The trees and models of a file, then those of the files that it includes."""
        for model in root.all("TreeNodesModel"):
            self.models.update({entry.attributes.get("ID", ""): entry for entry in model.all("SubTree")})
        names = {tree_name(identity): identity for identity in elements}
        for element in root.all("BehaviorTree"):
            identity = element.attributes.get("ID", "")
            known = names.setdefault(tree_name(identity), identity)
            if identity in elements or known != identity:
                self._add(element, f'there are two trees "{tree_name(identity)}" ({known}, {identity})')
            elements[identity] = element
        for include in root.all("include"):
            path = (including[-1].parent / include.attributes.get("path", "")).resolve()
            if path in including or len(including) >= MAXIMUM_INCLUDE_DEPTH:
                self._add(include, "files include one another, or too deep")
                continue
            try:
                inner = parse_elements(path.read_text(encoding="utf-8"), str(path))
            except (OSError, UnicodeDecodeError) as error:
                self._add(include, f"cannot include {path.name}: {error}")
            except YamlError as error:
                self.problems.extend(error.problems)
            else:
                self._gather(inner, (*including, path), elements)

    def _metadata(self, identity: str) -> dict[str, str]:
        found: dict[str, str] = {}
        model = self.models.get(identity)
        for fields in [] if model is None else model.all("MetadataFields"):
            for entry in fields.all("Metadata"):
                found.update(entry.attributes)
        return found

    def _tree(self, identity: str, element: Element) -> WrittenTree | None:
        name = tree_name(identity)
        if not TREE_NAME.fullmatch(name):
            self._add(element, f'got ID "{identity}"; a tree is named in letters, digits and "_"')
        root = self._only_child(element)
        model = self.models.get(identity)
        ports = self._ports(model, "input_port"), self._ports(model, "output_port")
        return None if root is None else WrittenTree(name, root, self._metadata(identity).get("about", ""), *ports)

    def _ports(self, model: Element | None, tag: str) -> tuple[WrittenPort, ...]:
        return tuple(map(self._port, [] if model is None else model.all(tag)))

    def _port(self, element: Element) -> WrittenPort:
        unit, frame = read_about_port(element.text.strip())
        return WrittenPort(element.attributes.get("name", ""), element.attributes.get("type", ""), unit, frame)

    def _only_child(self, element: Element) -> WrittenNode | None:
        if len(element.children) != 1:
            self._add(element, f"<{element.tag}> has {len(element.children)} children, needs one")
            return None
        return self._node(element.children[0])

    def _node(self, element: Element) -> WrittenNode | None:
        tag = element.attributes.get("ID", "") if element.tag in _EXPLICIT else element.tag
        attributes = {key: value for key, value in element.attributes.items() if key not in ("ID", "name")}
        name = element.attributes.get("name", "")
        if tag == "SubTree":
            wires = self._wires(element, attributes, attributes)
            return self._subtree(element.attributes.get("ID", ""), name, wires)
        if tag == "ScriptCondition":
            self._refuse(element, attributes, ("code",))
            return WrittenNode("check", name, settings=(("that", from_script(attributes.get("code", ""))),))
        kind = BY_TAG.get(tag) or OWN.get(tag)
        leaf = self.registry.get(kind or tag)
        if kind is None and leaf is None:
            known = (*BY_TAG, *OWN, *self.registry.names)
            self._add(element, f"node <{tag}> is not supported{nearest(tag, known)}")
            for child in element.children:
                self._node(child)
            return None
        kind = kind or tag
        read = [self._node(below) for below in element.children]
        children = tuple(node for node in read if node is not None)
        self._count(element, kind)
        if tag in BY_TAG:
            return WrittenNode(kind, name, settings=self._builtin(element, kind, attributes), children=children)
        cls: Any = COMPOSITES.get(kind) or DECORATORS.get(kind) or leaf
        if cls is None:
            self._refuse(element, attributes, ("that",))
            return WrittenNode(kind, name, settings=(("that", attributes.get("that", "")),))
        if issubclass(cls, Leaf):
            return self._leaf(element, cls, kind, name, attributes)
        return WrittenNode(kind, name, settings=self._settings(element, cls, attributes), children=children)

    def _subtree(self, identity: str, name: str, wires: tuple[tuple[str, str], ...]) -> WrittenNode:
        model = self.models.get(identity)
        given = [] if model is None else [port.attributes.get("name") for port in model.all("output_port")]
        inputs = tuple(wire for wire in wires if wire[0] not in given)
        return WrittenNode("subtree", name, tree_name(identity), inputs, tuple(w for w in wires if w[0] in given))

    def _builtin(self, element: Element, kind: str, attributes: dict[str, str]) -> tuple[tuple[str, Scalar], ...]:
        builtin = BUILTINS[kind]
        ours = {theirs: ours for ours, theirs in builtin.attributes}
        self._refuse(element, attributes, ours)
        settings: dict[str, Scalar] = {}
        for key, text in attributes.items():
            if key in ours:
                try:
                    settings[ours[key]] = builtin.from_xml(text)
                except ValueError:
                    self._add(element, f'{key}: got "{text}", needs a whole number')
        cls: Any = COMPOSITES.get(kind) or DECORATORS.get(kind)
        for key in SPELLED_OUT.get(kind, ()):
            default: Any = cls.Parameters.__dataclass_fields__[key].default
            settings.setdefault(key, default)
        return tuple(settings.items())

    def _leaf(self, element: Element, cls: type[Leaf], kind: str, name: str, attributes: dict[str, str]) -> WrittenNode:
        inputs, outputs = declared_inputs(cls), declared_outputs(cls)
        rest = {key: value for key, value in attributes.items() if key not in inputs and key not in outputs}
        return WrittenNode(
            kind,
            name,
            "",
            self._wires(element, attributes, inputs),
            self._wires(element, attributes, outputs),
            self._settings(element, cls, rest),
        )

    def _wires(self, element: Element, attributes: dict[str, str], ports: Iterable[str]) -> tuple[tuple[str, str], ...]:
        wires = []
        for port in [key for key in attributes if key in ports]:
            text = attributes[port]
            key = text[1:-1] if text.startswith("{") and text.endswith("}") else ""
            key = port if key == "=" else key
            if KEY.fullmatch(key):
                wires.append((port, key))
            else:
                self._add(element, f'{port}: got "{text}", needs a key such as "{{{port}}}"')
        return tuple(wires)

    def _settings(self, element: Element, cls: Any, attributes: dict[str, str]) -> tuple[tuple[str, Scalar], ...]:
        fields = {field.name: field.default for field in dataclasses.fields(cls.Parameters)}
        self._refuse(element, attributes, fields)
        settings = []
        for key, text in attributes.items():
            if key in fields:
                try:
                    settings.append((key, _scalar(text, fields[key])))
                except ValueError:
                    self._add(element, f'{key}: got "{text}", needs {type(fields[key]).__name__}')
        return tuple(settings)

    def _count(self, element: Element, kind: str) -> None:
        """Tell where a node has too many or too few children."""
        cls: type[Decorator] | None = DECORATORS.get(kind)
        got = len(element.children)
        if cls is not None and got != len(cls.slots):
            self._add(element, f"<{element.tag}> has {got} children, needs {len(cls.slots)}")
        elif kind in COMPOSITES and not got:
            self._add(element, f"<{element.tag}> has no children")
        elif cls is None and kind not in COMPOSITES and got:
            self._add(element, f"<{element.tag}> has {got} children, it takes none")

    def _refuse(self, element: Element, attributes: Iterable[str], allowed: Iterable[str]) -> None:
        for key in attributes:
            if key not in allowed:
                names = ", ".join(("name", *allowed))
                self._add(element, f'attribute "{key}" of <{element.tag}> is not supported (attributes: {names})')

    def _add(self, element: Element, message: str) -> None:
        self.problems.append(Problem(element.location, message))


def _scalar(text: str, default: object) -> Scalar:
    """An attribute as the parameter that it is."""
    if isinstance(default, bool):
        if text not in ("true", "false", "1", "0"):
            raise ValueError(text)
        return text in ("true", "1")
    if isinstance(default, int):
        return int(text)
    return float(text) if isinstance(default, float) else text
