"""Behavior trees: leaves, ports, the loader, the executor, the trace and the robot protocol.

A leaf declares its ports and parameters, a YAML file wires leaves into a tree, and a `Tree` ticks it on the clock of a
robot.
"""

from py_trees.common import Status

from behaviors.builder import SettingError
from behaviors.context import Context, Fault, LogLine
from behaviors.drawing import DrawnLine, draw, drawn_lines
from behaviors.executor import Executor, ExecutorMode, JobOutcome, JobRecord
from behaviors.leaf import Call, Leaf, SkillLeaf, SkillParameters
from behaviors.loader import check, known_leaves, load_tree, parse_tree
from behaviors.node import Node
from behaviors.operator import OperatorEvent, OperatorInbox
from behaviors.ports import Input, OptionalInput, Output
from behaviors.registry import RegistrationError, Registry, leaf
from behaviors.robot import Robot, World
from behaviors.spec import NodeSpec, TreeSpec, Wire
from behaviors.trace import ParameterChange, Trace
from behaviors.tree import Outcome, Transition, Tree

__all__ = [
    "Call",
    "Context",
    "DrawnLine",
    "Executor",
    "ExecutorMode",
    "Fault",
    "Input",
    "JobOutcome",
    "JobRecord",
    "Leaf",
    "LogLine",
    "Node",
    "NodeSpec",
    "OperatorEvent",
    "OperatorInbox",
    "OptionalInput",
    "Outcome",
    "Output",
    "ParameterChange",
    "RegistrationError",
    "Registry",
    "Robot",
    "SettingError",
    "SkillLeaf",
    "SkillParameters",
    "Status",
    "Trace",
    "Transition",
    "Tree",
    "TreeSpec",
    "Wire",
    "World",
    "check",
    "draw",
    "drawn_lines",
    "known_leaves",
    "leaf",
    "load_tree",
    "parse_tree",
]
