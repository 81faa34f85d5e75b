"""Where tables are printed."""

from __future__ import annotations

from rich.console import Console

_WIDTH = 160


def wide_console() -> Console:
    """The terminal; a pipe takes long lines, as files do."""
    console = Console(highlight=False, soft_wrap=True)
    if not console.is_terminal:
        console.width = _WIDTH
    return console
