"""The commands of the command line, in the order in which `lookstep --help` lists them."""

from lookstep.commands import bench, check, demo, diff, picture, regions, replay, run, tree, why
from lookstep.commands.command import Command

COMMANDS: tuple[Command, ...] = (demo, run, check, tree, replay, diff, why, picture, regions, bench)

__all__ = ["COMMANDS", "Command"]
