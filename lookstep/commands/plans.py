"""`lookstep plans`: the plan logs of a folder."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from lookstep.errors import UserError

if TYPE_CHECKING:
    from lookstep.plan_log import LoggedPlan

NAME = "plans"
HELP = "list the footstep plans that a run has logged"
EXAMPLE = "lookstep run --course rough --plans runs/plans && lookstep plans runs/plans"

_TEXTS = ("file", "first", "outcome", "most rejected")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the folder."""
    parser.add_argument("folder", type=Path, metavar="DIR", help="folder that `run --plans` has written")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the list here as well")


def execute(options: argparse.Namespace) -> int:
    """List; 0 where every file could be read."""
    import json

    from rich.table import Table

    from lookstep.commands.tables import wide_console
    from lookstep.plan_log import PLAN_SUFFIX, read_plan

    if not options.folder.is_dir():
        raise UserError(f"{options.folder}: is not a folder; needs one that `lookstep run --plans` has written")
    files = sorted(options.folder.glob(f"*{PLAN_SUFFIX}"))
    if not files:
        raise UserError(
            f"{options.folder}: holds no *{PLAN_SUFFIX}; `lookstep run --plans {options.folder}` writes them"
        )
    if options.json is not None and not options.json.parent.is_dir():
        raise UserError(f"--json {options.json}: the folder {options.json.parent} does not exist")
    rows = [_row(file, read_plan(file)) for file in files]
    table = Table(box=None, padding=(0, 1), pad_edge=False)
    for name in rows[0]:
        table.add_column(name, justify="left" if name in _TEXTS else "right", no_wrap=True)
    for row in rows:
        table.add_row(*(_text(value) for value in row.values()))
    wide_console().print(table)
    if options.json is not None:
        options.json.write_text(json.dumps({"plans": rows}, indent=2) + "\n", encoding="utf-8")
    return 0


def _row(file: Path, logged: LoggedPlan) -> dict[str, str | int | float | None]:
    from skills.footsteps.rejections import most_frequent

    plan, side = logged.plan, logged.request.first_side
    return {
        "file": file.name,
        "time s": round(logged.time, 2),
        "first": "either" if side is None else side.value,
        "outcome": plan.outcome.value,
        "steps": len(plan.steps),
        "kept": plan.kept_steps,
        "cost": round(plan.cost, 3),
        "expansions": plan.expansions,
        "ms": round(logged.compute_ms, 1) if logged.compute_ms == logged.compute_ms else None,
        "most rejected": most_frequent(plan.rejections),
    }


def _text(value: str | float | None) -> str:
    return "-" if value is None or value == "" else str(value)
