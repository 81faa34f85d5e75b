"""The decorators that a tree file may name."""

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
from behaviors.subsumption import Inhibit, Reset, Suppress

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
    )
}
