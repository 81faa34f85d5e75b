"""`lookstep plan`: one logged plan: its search in the rerun viewer, why edges were rejected, planned again."""

from __future__ import annotations

import argparse
import dataclasses
from pathlib import Path
from typing import TYPE_CHECKING

from lookstep.arguments import add_assignments
from lookstep.errors import UserError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rich.console import Console

    from skills.footsteps import FootstepPlan, PlanRequest

NAME = "plan"
HELP = "look at one logged footstep plan and its search; plan it again with other parameters"
EXAMPLE = "lookstep plan runs/plans/0003.plan --set footsteps.max_step_height=0.3"

_SUBJECTS = ("footsteps.", "terrain.")
_LOGGED, _AGAIN = "as logged", "planned again"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the file and what to change."""
    parser.add_argument("file", type=Path, metavar="FILE", help="a plan log; `lookstep plans` lists those of a folder")
    add_assignments(parser, "plan again with footsteps.key=value or terrain.key=value")
    parser.add_argument("--record", type=Path, metavar="RRD", help="write the recording here (beside the log, .rrd)")


def execute(options: argparse.Namespace) -> int:
    """Show, plan again, record; 0 whatever the plan is."""
    from lookstep.commands.tables import wide_console
    from lookstep.plan_log import read_plan
    from lookstep.recording.plan_file import write_plans
    from skills.footsteps import plan_on_request

    record = options.record or options.file.with_suffix(".rrd")
    if not record.parent.is_dir():
        raise UserError(f"--record {record}: the folder {record.parent} does not exist")
    logged = read_plan(options.file)
    request = changed(logged.request, options.assignments)
    searches: list = []
    plan = plan_on_request(request, logs=searches)
    results = {_LOGGED: (logged.request, logged.plan, logged.searches)}
    if options.assignments:
        results[_AGAIN] = (request, plan, tuple(searches))
    write_plans(record, results)
    console = wide_console()
    console.print(f"{options.file}: plan {logged.plan.plan_id} at {logged.time:.2f} s of robot time", markup=False)
    plans = [shown for _, shown, _ in results.values()]
    _print_plans(console, list(results), plans)
    _print_steps(console, list(results), plans)
    _print_rejections(console, list(results), plans)
    if not options.assignments:
        same = _same(logged.plan, plan)
        console.print("planned again: " + ("the same to the bit" if same else "differs; this is another version of it"))
    console.print(f"recording {record}   (open it: ./run rerun {record})", markup=False)
    return 0


def changed(request: PlanRequest, assignments: Sequence[str]) -> PlanRequest:
    """The request with other parameters.

    Raises:
        UserError: where an assignment is for something else; YamlError where its key or value is not allowed.
    """
    from lookstep.configuration import load_configuration, with_assignments

    for text in assignments:
        if not text.startswith(_SUBJECTS):
            raise UserError(f"--set {text}: only footsteps.KEY=VALUE and terrain.KEY=VALUE have a meaning here")
    if not assignments:
        return request
    logged = dataclasses.replace(load_configuration(), footsteps=request.footsteps, terrain=request.terrain)
    configuration = with_assignments(logged, assignments)
    return dataclasses.replace(request, footsteps=configuration.footsteps, terrain=configuration.terrain)


def _print_plans(console: Console, names: list[str], plans: list[FootstepPlan]) -> None:
    rows = {
        "outcome": [plan.outcome.value for plan in plans],
        "steps": [str(len(plan.steps)) for plan in plans],
        "kept": [str(plan.kept_steps) for plan in plans],
        "cost": [f"{plan.cost:.3f}" for plan in plans],
        "expansions": [str(plan.expansions) for plan in plans],
    }
    _print_table(console, "", names, rows)
    for name, plan in zip(names, plans, strict=True):
        if plan.reason:
            console.print(f"{name}: {plan.reason}", markup=False)


def _print_steps(console: Console, names: list[str], plans: list[FootstepPlan]) -> None:
    most = max(len(plan.steps) for plan in plans)
    rows = {}
    for i in range(most):
        cells = []
        for plan in plans:
            if i >= len(plan.steps):
                cells.append("-")
                continue
            step = plan.steps[i]
            x, y, z = step.T_world_sole.p
            cells.append(f"{step.side.value:5} {x:6.2f} {y:6.2f} {z:6.2f} m, swing {step.swing_duration:.2f} s")
        rows[f"step {i + 1}"] = cells
    _print_table(console, "", names, rows)


def _print_rejections(console: Console, names: list[str], plans: list[FootstepPlan]) -> None:
    from skills.footsteps.rejections import in_percent, sizes_in_percent

    for title, percent in (("rejected edges", in_percent), ("beyond a step's size", sizes_in_percent)):
        shares = [dict(percent(plan.rejections)) for plan in plans]
        reasons = {reason: max(share.get(reason, 0.0) for share in shares) for share in shares for reason in share}
        rows = {
            reason: [f"{share[reason]:.3g} %" if reason in share else "-" for share in shares]
            for reason in sorted(reasons, key=lambda reason: -reasons[reason])
        }
        _print_table(console, title, names, rows)


def _print_table(console: Console, title: str, names: list[str], rows: dict[str, list[str]]) -> None:
    from rich.table import Table

    table = Table(box=None, padding=(0, 1), pad_edge=False)
    for name in (title, *names):
        table.add_column(name, no_wrap=True)
    for name, cells in rows.items():
        table.add_row(name, *cells)
    console.print(table)
    console.print()


def _same(a: FootstepPlan, b: FootstepPlan) -> bool:
    if a.outcome is not b.outcome or len(a.steps) != len(b.steps):
        return False
    return all(
        x.T_world_sole.p.tobytes() == y.T_world_sole.p.tobytes()
        and x.T_world_sole.R.tobytes() == y.T_world_sole.R.tobytes()
        for x, y in zip(a.steps, b.steps, strict=True)
    )
