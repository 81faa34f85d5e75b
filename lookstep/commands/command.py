"""What a module must offer to be a command."""

from __future__ import annotations

import argparse
from typing import Protocol


class Command(Protocol):
    """A module under `lookstep/commands`."""

    @property
    def NAME(self) -> str:
        """How it is called."""
        ...

    @property
    def HELP(self) -> str:
        """One line, in small letters."""
        ...

    @property
    def EXAMPLE(self) -> str:
        """One command line that works."""
        ...

    def add_arguments(self, parser: argparse.ArgumentParser, /) -> None:
        """Declare the command's options."""
        ...

    def execute(self, options: argparse.Namespace, /) -> int:
        """Do it; returns the exit status."""
        ...
