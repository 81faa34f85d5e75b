"""The `TreeNodesModel` of BehaviorTree.CPP: our nodes with ports, types, defaults and meanings, for Groot2."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Iterator
from typing import Any
from xml.sax.saxutils import escape, quoteattr

from behaviors.blackboard import type_name
from behaviors.check_leaf import Check
from behaviors.composites import COMPOSITES
from behaviors.interchange.written import WrittenFile, WrittenNode, WrittenPort, WrittenTree
from behaviors.interchange.xml_names import builtin_for, category, own_tag, to_script, tree_id
from behaviors.kinds import DECORATORS
from behaviors.ports import declared_inputs, declared_outputs
from behaviors.registry import Registry
from behaviors.text import first_line, port_text

_STEP = "  "


def write_palette(registry: Registry) -> str:
    """All leaves of a registry, and all nodes of ours that BehaviorTree.CPP has not, as a file for Groot2."""
    kinds = [*COMPOSITES, *DECORATORS, "check", *registry.names]
    lines = ['<?xml version="1.0" encoding="UTF-8"?>', '<root BTCPP_format="4">', f"{_STEP}<TreeNodesModel>"]
    lines += [line for kind in sorted(kinds, key=own_tag) for line in _own_model(kind, registry)]
    return "\n".join((*lines, f"{_STEP}</TreeNodesModel>", "</root>")) + "\n"


def model_lines(file: WrittenFile, registry: Registry) -> Iterator[str]:
    """The model of all nodes of our own that a file uses, and of its trees."""
    roots = [file.tree, *file.trees, *(tree for _, tree in file.included)]
    nodes = [node for tree in roots for node in _all(tree.root)]
    nodes += [] if file.safe_stop is None else list(_all(file.safe_stop))
    yield f"{_STEP}<TreeNodesModel>"
    for kind in sorted({node.kind for node in nodes if _is_own(node)}, key=own_tag):
        yield from _own_model(kind, registry)
    main = (("include", " ".join(file.include)),) if file.include else ()
    yield from _tree_model(file.tree.name, file.tree, main)
    for tree in file.trees:
        yield from _tree_model(tree.name, tree, ())
    for name, tree in file.included:
        yield from _tree_model(name, tree, (("included", "true"),))
    yield f"{_STEP}</TreeNodesModel>"


def _all(node: WrittenNode) -> Iterator[WrittenNode]:
    yield node
    for child in node.children:
        yield from _all(child)


def _is_own(node: WrittenNode) -> bool:
    if node.kind == "check":
        return to_script(str(node.settings[0][1])) is None
    return node.kind != "subtree" and builtin_for(node.kind, node.settings) is None


def _own_model(kind: str, registry: Registry) -> Iterator[str]:
    cls: Any = COMPOSITES.get(kind) or DECORATORS.get(kind) or (Check if kind == "check" else registry.get(kind))
    ports = []
    if kind not in COMPOSITES and kind not in DECORATORS and kind != "check":
        ports += [("input_port", name, port) for name, port in declared_inputs(cls).items()]
        ports += [("output_port", name, port) for name, port in declared_outputs(cls).items()]
    yield f"{_STEP * 2}<{category(kind)} ID={quoteattr(own_tag(kind))}>"
    for tag, name, port in ports:
        yield _port(tag, name, type_name(port.type), None, port_text(port))
    for field in dataclasses.fields(cls.Parameters):
        unit = field.metadata["unit"]
        meaning = field.metadata["meaning"] + ("" if unit == "1" else f" [{unit}]")
        default = str(field.default).lower() if isinstance(field.default, bool) else str(field.default)
        yield _port("input_port", field.name, type(field.default).__name__, default, meaning)
    yield from _metadata([("description", first_line(cls))])
    yield f"{_STEP * 2}</{category(kind)}>"


def _tree_model(name: str, tree: WrittenTree, more: Iterable[tuple[str, str]]) -> Iterator[str]:
    yield f"{_STEP * 2}<SubTree ID={quoteattr(tree_id(name))}>"
    for tag, ports in (("input_port", tree.inputs), ("output_port", tree.outputs)):
        for port in ports:
            yield _port(tag, port.name, port.type, None, _about_port(port))
    yield from _metadata([*((("about", tree.about),) if tree.about else ()), *more])
    yield f"{_STEP * 2}</SubTree>"


def _about_port(port: WrittenPort) -> str:
    """Unit and frame, as `read_about_port` reads them."""
    return ("" if port.unit == "1" else f"[{port.unit}]") + (f" in frame {port.frame}" if port.frame else "")


def read_about_port(text: str) -> tuple[str, str]:
    """Unit and frame of a tree's port from its description."""
    unit, _, frame = text.partition(" in frame ")
    return unit.strip().removeprefix("[").removesuffix("]") or "1", frame.strip()


def _port(tag: str, name: str, declared: str, default: str | None, text: str) -> str:
    said = f"{_STEP * 3}<{tag} name={quoteattr(name)} type={quoteattr(declared)}"
    said += "" if default is None else f" default={quoteattr(default)}"
    return f"{said}>{escape(text)}</{tag}>" if text else f"{said}/>"


def _metadata(fields: Iterable[tuple[str, str]]) -> Iterator[str]:
    listed = list(fields)
    if listed:
        yield f"{_STEP * 3}<MetadataFields>"
        for key, value in listed:
            yield f"{_STEP * 4}<Metadata {key}={quoteattr(value)}/>"
        yield f"{_STEP * 3}</MetadataFields>"
