"""A `TreeSpec` -> nodes that can be ticked, with the parameters that hold for each."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import Any

from behaviors.blackboard import Blackboard, Slot
from behaviors.context import Context
from behaviors.leaf import Leaf, LeafNode
from behaviors.node import Node
from behaviors.ports import declared_inputs, declared_outputs
from behaviors.spec import NodeSpec, TreeSpec
from skills.parameters import ParameterError
from strict_yaml import nearest

Settings = Mapping[str, Mapping[str, Any]]


class SettingError(ValueError):
    """A parameter setting that no node of the tree takes."""


def build_node(spec: NodeSpec, context: Context, blackboard: Blackboard, tree: TreeSpec, layers: Layers) -> Node:
    """Make a node and all below it.

    Raises:
        ParameterError: where a setting is out of range.
    """
    parameters = layers.parameters(spec)
    if issubclass(spec.cls, Leaf):
        ports = _ports(spec, blackboard, tree)
        return LeafNode(spec.path, context, spec.cls(spec.path, context, parameters, ports))
    children = tuple(build_node(child, context, blackboard, tree, layers) for child in spec.children)
    return spec.cls(spec.path, context, parameters, children)


def _ports(spec: NodeSpec, blackboard: Blackboard, tree: TreeSpec) -> dict[str, Slot]:
    """The slots of a leaf's wired ports; an output that is not wired gets a slot of its own."""
    ports = {name: Slot(name, port.type) for name, port in declared_outputs(spec.cls).items()}
    for wire in (*spec.inputs, *spec.outputs):
        ports[wire.port] = blackboard.slot(wire.key, tree.keys[wire.key])
    unwired = {name for name in declared_inputs(spec.cls) if name not in ports}
    return {name: slot for name, slot in ports.items() if name not in unwired}


@dataclasses.dataclass(frozen=True, slots=True)
class Layers:
    """Where the parameters of a node come from, later ones before earlier: class, defaults, tree file, settings.

    Attributes:
        defaults: values by kind of node, such as {"PlanFootsteps": {"latency": 0.3}}.
        settings: values by node path.
    """

    defaults: Settings
    settings: Settings

    def parameters(self, spec: NodeSpec) -> Any:
        """The parameters of one node.

        Raises:
            SettingError: where a key is unknown.
            ParameterError: where a value is out of range.
        """
        values = dict(self.defaults.get(spec.kind, {}))
        values.update({key: getattr(spec.parameters, key) for key in spec.given})
        values.update(self.settings.get(spec.path, {}))
        return replaced(spec.parameters, values, spec.path)

    def check_targets(self, tree: TreeSpec) -> None:
        """Refuse settings for nodes that are not there.

        Raises:
            SettingError: where a path is unknown.
        """
        paths = [node.path for node in tree]
        for path in self.settings:
            if path not in paths:
                raise SettingError(f'no node "{path}"{nearest(path, paths)}')


def replaced(parameters: Any, values: Mapping[str, Any], target: str) -> Any:
    """Parameters with some values replaced.

    Raises:
        SettingError: where a key is unknown.
        ParameterError: where a value is out of range; the key names the target as well.
    """
    allowed = [field.name for field in dataclasses.fields(parameters)]
    for key in values:
        if key not in allowed:
            raise SettingError(
                f'{target}: no parameter "{key}"{nearest(key, allowed)} (parameters: {", ".join(allowed)})'
            )
    values = {key: _as_declared(value, getattr(parameters, key)) for key, value in values.items()}
    try:
        return dataclasses.replace(parameters, **values)
    except ParameterError as error:
        raise ParameterError(f"{target}.{error.key}", error.message) from error


def _as_declared(value: Any, current: Any) -> Any:
    """A whole number as the float that its parameter is, so that 1 and 1.0 leave the same trace."""
    return float(value) if isinstance(current, float) and type(value) is int else value
