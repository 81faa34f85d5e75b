"""A tree file as it is written, short forms resolved: two files with equal values say the same.

Unlike `TreeSpec`, subtrees are not expanded and names that the file does not give are not made. Comments are kept
beside and do not count.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from strict_yaml import Scalar


@dataclass(frozen=True, slots=True)
class Comments:
    """What people wrote about something: lines above it, and behind it on its own line."""

    above: tuple[str, ...] = ()
    behind: str = ""


@dataclass(frozen=True, slots=True)
class WrittenNode:
    """A node.

    Attributes:
        kind: such as "sequence", "subtree", "check" or "PlanFootsteps".
        name: that the file gives; empty where it does not.
        tree: of a subtree.
        inputs, outputs: keys by port.
        settings: parameters that the file gives; of a subtree those inside it, by path and parameter.
        children: a condition before the child.
        comments: about it.
    """

    kind: str
    name: str = ""
    tree: str = ""
    inputs: tuple[tuple[str, str], ...] = ()
    outputs: tuple[tuple[str, str], ...] = ()
    settings: tuple[tuple[str, Scalar], ...] = ()
    children: tuple[WrittenNode, ...] = ()
    comments: Comments = field(default=Comments(), compare=False)


@dataclass(frozen=True, slots=True)
class WrittenPort:
    """A port of a tree."""

    name: str
    type: str
    unit: str = "1"
    frame: str = ""


@dataclass(frozen=True, slots=True)
class WrittenTree:
    """A tree of a file."""

    name: str
    root: WrittenNode
    about: str = ""
    inputs: tuple[WrittenPort, ...] = ()
    outputs: tuple[WrittenPort, ...] = ()
    comments: Comments = field(default=Comments(), compare=False)


@dataclass(frozen=True, slots=True)
class WrittenFile:
    """A file.

    Attributes:
        tree: the one that the file is about.
        include: files whose trees it uses.
        safe_stop: ticked after a fault; None where there is none.
        trees: the others, in the order of the file.
        included: trees of included files by the name under which this file knows them; not part of this file.
        comments: of parts of the file, by key such as "ports"; "" for the end.
    """

    tree: WrittenTree
    include: tuple[str, ...] = ()
    safe_stop: WrittenNode | None = None
    trees: tuple[WrittenTree, ...] = ()
    included: tuple[tuple[str, WrittenTree], ...] = field(default=(), compare=False)
    comments: tuple[tuple[str, Comments], ...] = field(default=(), compare=False)
