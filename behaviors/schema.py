"""JSON Schema of tree files, made from the registered leaves: completion, hover and red lines in editors.

Draft 7, which the YAML language server and the editors built on it read. Descriptions stand both in plain text and in
Markdown, which editors show on hover. What a schema cannot say (types of keys, order, deadlines) `lookstep check` says.
"""

from __future__ import annotations

import dataclasses
from typing import Any

from behaviors.check_leaf import Check
from behaviors.composites import COMPOSITES
from behaviors.decorators import Decorator
from behaviors.definition import KEY, TREE_NAME, port_types
from behaviors.kinds import DECORATORS
from behaviors.leaf import Leaf
from behaviors.naming import NODE_NAME
from behaviors.ports import declared_inputs, declared_outputs
from behaviors.registry import Registry
from behaviors.text import first_line, port_text
from strict_yaml.schema import property_schema

Schema = dict[str, Any]

DRAFT = "http://json-schema.org/draft-07/schema#"
_NODE = {"$ref": "#/definitions/node"}
_NODES = {"type": "array", "items": _NODE, "minItems": 1}


def tree_schema(registry: Registry) -> Schema:
    """The schema of a tree file that may name the leaves of a registry."""
    bodies = {
        "subtree": _subtree(),
        Check.kind: _check(),
        **{kind: _composite(cls) for kind, cls in COMPOSITES.items()},
        **{kind: _decorator(cls) for kind, cls in DECORATORS.items()},
        **{cls.__name__: _leaf(cls) for cls in registry.classes},
    }
    refs = {kind: {"$ref": f"#/definitions/{kind}"} for kind in bodies}
    one_kind = {"type": "object", "properties": refs, "additionalProperties": False}
    node = {
        "description": "A node: one key, its kind, and a body; or the kind alone.",
        "anyOf": [
            {"enum": sorted(kind for kind in bodies if kind in registry.names)},
            {**one_kind, "minProperties": 1, "maxProperties": 1},
        ],
    }
    for kind, cls in DECORATORS.items():
        # The child may stand beside the parameters, under its kind.
        bodies[kind]["anyOf"][0]["properties"] |= refs
        if len(cls.slots) == 1:
            bodies[kind]["anyOf"].append({"enum": sorted(registry.names)})
    return {
        "$schema": DRAFT,
        "title": "lookstep behavior tree",
        **_file(registry),
        "definitions": {"node": node, "ports": _ports(registry), **bodies},
    }


def _file(registry: Registry) -> Schema:
    tree = {
        "about": _text("One line for people."),
        "ports": {"$ref": "#/definitions/ports"},
        "root": _NODE,
    }
    return {
        "type": "object",
        "properties": {
            "tree": {**_text("The tree's name."), "pattern": f"^{TREE_NAME.pattern}$"},
            "include": {
                **_described("Files with trees that this one uses, relative to it, or names of shipped trees."),
                "type": "array",
                "items": {"type": "string"},
            },
            "safe_stop": {**_NODE, **_described("Ticked after a fault.")},
            "trees": {
                **_described("Trees that this file uses as subtrees."),
                "type": "object",
                "propertyNames": {"pattern": f"^{TREE_NAME.pattern}$"},
                "additionalProperties": _object(tree, required=("root",)),
            },
            **tree,
        },
        "required": ["tree", "root"],
        "additionalProperties": False,
    }


def _ports(registry: Registry) -> Schema:
    names = {"enum": sorted(port_types(registry))}
    long = _object({"type": names, "unit": _text("Unit."), "frame": _text("Frame of coordinates.")}, ("type",))
    ports = {"type": "object", "propertyNames": {"pattern": f"^{KEY.pattern}$"}, "additionalProperties": {
        "anyOf": [names, long]}}  # fmt: skip
    return {**_described("What goes into the tree and comes out of it."), **_object({"in": ports, "out": ports})}


def _subtree() -> Schema:
    wires = {
        "anyOf": [
            {"type": "array", "items": {"type": "string", "pattern": f"^{KEY.pattern}$"}},
            {"type": "object", "additionalProperties": {"type": "string", "pattern": f"^{KEY.pattern}$"}},
        ]
    }
    properties = {
        "tree": _text("Name of a tree of this file or of one it includes."),
        "name": _name(),
        "in": wires,
        "out": wires,
        "set": {
            **_described("Parameters inside the subtree: path.parameter: value."),
            "type": "object",
        },
    }
    return {**_described("Another tree as a node of this one."), **_object(properties, ("tree",))}


def _check() -> Schema:
    that = _text("Condition over keys, such as left > 0 and not blocked.")
    return {**_about(Check), "anyOf": [that, _object({"name": _name(), "that": that}, ("that",))]}


def _composite(cls: type[Any]) -> Schema:
    properties = {"name": _name(), "children": _NODES, **_parameters(cls)}
    return {**_about(cls), "anyOf": [_NODES, _object(properties, ("children",))]}


def _decorator(cls: type[Decorator]) -> Schema:
    slots = {slot: _NODE for slot in cls.slots}
    conditions = tuple(slot for slot in cls.slots if slot != "child")
    return {
        **_about(cls),
        "anyOf": [_object({"name": _name(), **slots, **_parameters(cls)}, conditions)],
    }


def _leaf(cls: type[Leaf]) -> Schema:
    properties = {"name": _name()}
    required = []
    for direction, ports in (("in", declared_inputs(cls)), ("out", declared_outputs(cls))):
        if ports:
            properties[direction] = _wires(ports)
    if any(port.required for port in declared_inputs(cls).values()):
        required.append("in")
    body = _object({**properties, **_parameters(cls)}, tuple(required))
    return {**_about(cls), **(body if required else {"anyOf": [{"type": "null"}, body]})}


def _wires(ports: dict[str, Any]) -> Schema:
    key = {"type": "string", "pattern": f"^{KEY.pattern}$"}
    described = {name: {**_described(port_text(port)), **key} for name, port in ports.items()}
    return {
        "anyOf": [
            {"type": "array", "items": {"enum": list(ports)}, "uniqueItems": True},
            {"type": "object", "properties": described, "additionalProperties": False},
        ]
    }


def _parameters(cls: type[Any]) -> Schema:
    return {field.name: property_schema(field) for field in dataclasses.fields(cls.Parameters)}


def _object(properties: Schema, required: tuple[str, ...] = ()) -> Schema:
    schema: Schema = {"type": "object", "properties": dict(properties), "additionalProperties": False}
    return {**schema, "required": list(required)} if required else schema


def _about(cls: type) -> Schema:
    return _described(first_line(cls))


def _described(text: str) -> Schema:
    return {"description": text, "markdownDescription": text}


def _text(description: str) -> Schema:
    return {**_described(description), "type": "string"}


def _name() -> Schema:
    return {**_text("Name of the node, part of its path."), "pattern": f"^{NODE_NAME.pattern}$"}
