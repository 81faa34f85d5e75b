"""The kinds of nodes that a tree file may name: composites, decorators, subtrees, and the leaves of a registry."""

from behaviors.check_leaf import Check
from behaviors.composites import COMPOSITES
from behaviors.decorators import (
    Decorator,
    ForceFailure,
    ForceSuccess,
    Inverter,
    LoopForever,
    RateLimit,
    Repeat,
    Retry,
    RunWhile,
    Timeout,
)
from behaviors.halting import HaltUnless, PauseOnFailure
from behaviors.registry import Registry
from behaviors.subsumption import Inhibit, Reset, Suppress
from strict_yaml import nearest

DECORATORS: dict[str, type[Decorator]] = {
    cls.kind: cls
    for cls in (
        Inverter,
        ForceSuccess,
        ForceFailure,
        Retry,
        Repeat,
        LoopForever,
        Timeout,
        RateLimit,
        RunWhile,
        Suppress,
        Inhibit,
        Reset,
        HaltUnless,
        PauseOnFailure,
    )
}


def is_kind(key: str, registry: Registry) -> bool:
    """Whether a key names a kind of node."""
    return key in ("subtree", Check.kind) or key in COMPOSITES or key in DECORATORS or registry.get(key) is not None


def unknown_kind(key: str, registry: Registry) -> str:
    """What to say of a key that names no kind of node."""
    kinds = ("subtree", Check.kind, *COMPOSITES, *DECORATORS)
    is_leaf = key[:1].isupper()
    what, names, where = ("leaf", registry.names, "leaves") if is_leaf else ("node", kinds, "nodes")
    return f'unknown {what} "{key}"{nearest(key, (*kinds, *registry.names))} ({where}: {", ".join(names)})'
