"""The commands of the command line, in the order in which `lookstep --help` lists them."""

from lookstep.commands import check, demo, picture, run, tree
from lookstep.commands.command import Command

COMMANDS: tuple[Command, ...] = (demo, run, check, tree, picture)

__all__ = ["COMMANDS", "Command"]
