"""The commands of the command line, in the order in which `lookstep --help` lists them."""

from lookstep.commands import (
    bench,
    check,
    convert,
    demo,
    diff,
    evaluate,
    leaves,
    operate,
    picture,
    plan,
    plans,
    regions,
    replay,
    run,
    schema,
    tree,
    why,
)
from lookstep.commands.command import Command

COMMANDS: tuple[Command, ...] = (
    demo,
    run,
    evaluate,
    operate,
    check,
    tree,
    leaves,
    schema,
    convert,
    replay,
    diff,
    why,
    picture,
    regions,
    plans,
    plan,
    bench,
)

__all__ = ["COMMANDS", "Command"]
