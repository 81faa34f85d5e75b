"""The schema of tree files: it takes every sound tree, refuses what it can see, and explains every key."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import jsonschema
import pytest
from scripted import toys
from test_flow_errors import SOUND
from test_tree_file_errors import CORPUS

from behaviors import Registry, known_leaves
from behaviors.schema import tree_schema
from strict_yaml import Kind, Node, YamlError, load_document, parse_document, shipped_folder

TOYS = jsonschema.Draft7Validator(tree_schema(toys))
# What only `lookstep check` can see: which keys flow, which trees there are, names, limits of the expanded tree.
BEYOND = ("what flows", "a tree that contains itself", "names", "name of a root", "yaml itself")


def shipped_schema() -> dict[str, Any]:
    registry = Registry()
    for cls in known_leaves().classes:
        if cls.__module__.startswith("behaviors."):
            registry(cls)
    return tree_schema(registry)


def plain(node: Node) -> Any:
    """A document as JSON has it."""
    if node.kind is Kind.MAPPING:
        return {entry.key: plain(entry.node) for entry in node.entries}
    if node.kind is Kind.SEQUENCE:
        return [plain(element) for element in node.elements]
    return node.value


def test_the_schema_is_one():
    jsonschema.Draft7Validator.check_schema(tree_schema(toys))
    jsonschema.Draft7Validator.check_schema(shipped_schema())


@pytest.mark.parametrize("path", sorted(shipped_folder("trees").glob("*.yaml")), ids=lambda path: path.stem)
def test_every_shipped_tree_fits(path: Path):
    assert [
        error.message for error in jsonschema.Draft7Validator(shipped_schema()).iter_errors(plain(load_document(path)))
    ] == []


@pytest.mark.parametrize("name", SOUND)
def test_sound_trees_fit(name: str):
    document = plain(parse_document(f"{{tree: t, root: {{{SOUND[name]}}}}}"))
    assert list(TOYS.iter_errors(document)) == []


@pytest.mark.parametrize("name", [name for name in CORPUS if name not in BEYOND])
def test_broken_trees_do_not_fit(name: str):
    try:
        document = plain(parse_document(CORPUS[name][0].lstrip("\n")))
    except YamlError:
        pytest.skip("no YAML at all")
    assert list(TOYS.iter_errors(document))


def test_every_key_of_a_leaf_is_explained():
    leaf = shipped_schema()["definitions"]["PlanFootsteps"]
    assert leaf["description"].startswith("Plans at least three steps")
    assert leaf["properties"]["latency"] == {
        "type": "number",
        "minimum": 0.0,
        "maximum": 60.0,
        "default": 0.2,
        "description": "[s] robot time until a plan is delivered",
        "markdownDescription": "[s] robot time until a plan is delivered",
    }
    wires = leaf["properties"]["in"]["anyOf"]
    assert wires[0]["items"] == {"enum": ["ground", "sub_goal"]}
    assert wires[1]["properties"]["ground"]["description"] == "PlanarRegions: planar regions around the robot"
    assert leaf["required"] == ["in"]


def test_kinds_are_completed_where_a_node_belongs():
    names, bodies = shipped_schema()["definitions"]["node"]["anyOf"]
    assert {"PauseWalking", "Succeed"} <= set(names["enum"])
    assert {"sequence", "subtree", "check", "PlanFootsteps", "rate_limit"} <= set(bodies["properties"])
