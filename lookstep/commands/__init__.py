"""The commands of the command line, in the order in which `lookstep --help` lists them."""

from lookstep.commands import bench, check, demo, diff, leaves, picture, regions, replay, run, schema, tree, why
from lookstep.commands.command import Command

COMMANDS: tuple[Command, ...] = (demo, run, check, tree, leaves, schema, replay, diff, why, picture, regions, bench)

__all__ = ["COMMANDS", "Command"]
