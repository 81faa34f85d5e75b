"""How the differences of two traces are told in the terminal."""

from __future__ import annotations

from pathlib import Path
from types import TracebackType

from rich.console import Console

from behaviors.trace_diff import Difference, DivergentTick, TraceDiff

_MOST = 12
_WIDTH = 110


class Bar:
    """Shows how much of a run has been replayed."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._status = Console(stderr=True).status(f"{folder}")

    def __enter__(self) -> Bar:
        self._status.start()
        return self

    def __call__(self, done: float, total: float) -> None:
        """So much robot time of so much [s]."""
        self._status.update(f"{self._folder}: {done:.0f} of {total:.0f} s")

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._status.stop()


def print_divergence(console: Console, diff: TraceDiff, sides: tuple[str, str], *, applies: bool) -> None:
    """Say where two runs part.

    Args:
        console: where to.
        diff: what was found.
        sides: names of the two runs.
        applies: whether the second was driven by what the first sensed, and stops to be where their commands part.
    """
    if diff.tree:
        _say(console, "the trees differ:")
        _list(console, diff.tree, sides)
    if diff.lengths[0] != diff.lengths[1]:
        _say(console, f"{sides[0]} has {diff.lengths[0]} ticks, {sides[1]} {diff.lengths[1]}")
    if diff.first is None:
        _say(console, "nothing was decided differently" if not diff.identical else "the traces are equal to the bit")
        return
    _say(console, f"first divergent tick {diff.first.tick} at {diff.first.time:.2f} s:")
    _list(console, diff.first.differences, sides)
    if diff.first_command is not None:
        _tell_command(console, diff.first_command, sides, applies=applies)
    if diff.nodes:
        _say(console, "nodes that went otherwise, and in how many ticks:")
        for path, count in diff.nodes[:_MOST]:
            _say(console, f"  {count:5d}  {path}")


def _tell_command(console: Console, tick: DivergentTick, sides: tuple[str, str], *, applies: bool) -> None:
    after = "; from here on the recording no longer applies" if applies else ""
    _say(console, f"the robot is told something else in tick {tick.tick} at {tick.time:.2f} s{after}:")
    _list(console, [difference for difference in tick.differences if difference.what == "command"], sides)


def _list(console: Console, differences: tuple[Difference, ...] | list[Difference], sides: tuple[str, str]) -> None:
    for difference in differences[:_MOST]:
        _say(console, f"  {difference.what} {difference.subject}")
        for side, value in zip(sides, (difference.first, difference.second), strict=True):
            _say(console, f"    {side}: {value[:_WIDTH]}")
    if len(differences) > _MOST:
        _say(console, f"  and {len(differences) - _MOST} more")


def _say(console: Console, text: str) -> None:
    console.print(f"  {text}", highlight=False, markup=False, soft_wrap=True)
