"""The commands of the command line, in the order in which `lookstep --help` lists them."""

from lookstep.commands import bench, check, demo, picture, regions, run, tree
from lookstep.commands.command import Command

COMMANDS: tuple[Command, ...] = (demo, run, check, tree, picture, regions, bench)

__all__ = ["COMMANDS", "Command"]
