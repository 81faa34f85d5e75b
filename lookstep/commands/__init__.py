"""The commands of the command line, in the order in which `lookstep --help` lists them."""

from lookstep.commands import bench, check, demo, picture, run, tree
from lookstep.commands.command import Command

COMMANDS: tuple[Command, ...] = (demo, run, check, tree, picture, bench)

__all__ = ["COMMANDS", "Command"]
