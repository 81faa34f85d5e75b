"""A run that an operator leads from a browser: the walk, paced, with the panel beside it."""

from __future__ import annotations

from collections.abc import Callable
from importlib.util import find_spec

from behaviors import OperatorInbox
from lookstep.configuration import load_configuration, split_assignments
from lookstep.errors import UserError
from lookstep.options import RunOptions
from lookstep.pace import Pace
from lookstep.panel.address import Address
from lookstep.panel.link import PanelLink
from lookstep.panel.photographer import Photographer
from lookstep.summary import Summary
from lookstep.walk import walk


def operate(
    options: RunOptions,
    address: Address,
    served: Callable[[str], None] = print,
    ended: Callable[[Summary], None] = lambda summary: None,
) -> Summary:
    """Run until the operator stops it, the robot falls or the tree ends.

    Args:
        options: what to run, `operated`.
        address: where the panel is served.
        served: is told where to open it.
        ended: is told how the run has ended, while the panel still shows it.

    Raises:
        UserError: where the panel cannot be served, or the input is not usable.
    """
    if find_spec("viser") is None:
        raise UserError("the panel needs viser: ./run --extra panel lookstep operate, or pip install 'lookstep[panel]'")
    assignments = split_assignments(options.assignments)
    robot = load_configuration(options.preset, assignments.subjects, options.robot).robot
    inbox, pace = OperatorInbox(), Pace(options.speed)
    title = f"{options.tree} on {options.course}, seed {options.seed}, {options.world}"
    plans = "" if options.plans is None else str(options.plans)
    link = PanelLink(inbox, pace, Photographer(title, robot, pace, plans), address)
    try:
        served(link.start())
        summary = walk(options, link, inbox=inbox, pace=pace)
        link.end(f"{summary.outcome.value}: {summary.reason}")
        ended(summary)
        return summary
    finally:
        link.close()
