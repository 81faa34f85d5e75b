"""The tab "Parameters": every typed parameter that can change while the robot walks, with unit, range and meaning."""

from __future__ import annotations

import dataclasses
import math
import time as wall
from collections.abc import Mapping
from typing import Any

from behaviors.operator import ChangeParameter, OperatorEventError
from lookstep.panel.desk import Desk
from lookstep.panel.snapshot import Snapshot

_SETTLE = 1.0  # A widget that was changed shows what the robot has only after so long [s].
_STEPS = 200  # of a slider, about


class ParameterTab:
    """One widget a parameter; made inside the tab's context.

    Args:
        desk: where they put what they say.
    """

    def __init__(self, desk: Desk) -> None:
        self._desk = desk
        self._widgets: dict[tuple[str, str], Any] = {}
        self._touched: dict[tuple[str, str], float] = {}
        self._seen: Mapping[str, Any] = {}
        subjects, nodes = {}, {}
        for target, values in desk.snapshot.parameters.items():
            if target not in desk.snapshot.stage.fixed and dataclasses.fields(values):
                (nodes if target.startswith("/") else subjects)[target] = values
        gui = desk.server.gui
        gui.add_markdown("A change is applied at the next tick and recorded. *Reject and plan again* plans with it.")
        for subject, values in subjects.items():
            with gui.add_folder(subject.replace("_", " "), expand_by_default=False):
                self._add_fields(subject, values)
        with gui.add_folder("nodes of the tree", expand_by_default=False):
            for path, values in nodes.items():
                with gui.add_folder(path.rpartition("/")[2], expand_by_default=False):
                    self._add_fields(path, values)

    def update(self, snapshot: Snapshot) -> None:
        """Show what the robot has, also where another has changed it, or a change was refused."""
        now = wall.monotonic()
        settled = [key for key, since in self._touched.items() if now - since > _SETTLE]
        if snapshot.parameters is self._seen and not settled:
            return
        self._seen = snapshot.parameters
        for key in settled:
            del self._touched[key]
        for (target, name), widget in self._widgets.items():
            if (target, name) not in self._touched and target in snapshot.parameters:
                widget.value = _shown(getattr(snapshot.parameters[target], name))

    def _add_fields(self, target: str, values: Any) -> None:
        for field in dataclasses.fields(values):
            value = getattr(values, field.name)
            if not field.metadata or not _is_editable(value):
                continue
            widget = self._add_widget(field, value)
            self._widgets[(target, field.name)] = widget
            self._desk.on_change(
                widget, lambda given, target=target, field=field: self._change(target, field.name, field.default, given)
            )

    def _add_widget(self, field: dataclasses.Field[Any], value: Any) -> Any:
        gui, data = self._desk.server.gui, field.metadata
        label, hint = field.name.replace("_", " "), describe(field)
        if isinstance(field.default, bool):
            return gui.add_checkbox(label, value, hint=hint)
        if data["choices"] is not None:
            return gui.add_dropdown(label, tuple(data["choices"]), initial_value=value, hint=hint)
        if isinstance(value, str | tuple):
            return gui.add_text(label, _shown(value), hint=hint)
        unit = "" if data["unit"] == "1" else f" [{data['unit']}]"
        kind = int if isinstance(field.default, int) else float
        low, high = data["minimum"], data["maximum"]
        if low is None or high is None or (high / max(low, 1e-9) > 1e4 and high > 100):
            step = 1 if kind is int else _rounded(max(abs(value), 0.1) / 100)
            return gui.add_number(label + unit, kind(value), step=step, hint=hint)
        step = 1 if kind is int else _rounded((high - low) / _STEPS)
        return gui.add_slider(label + unit, kind(low), kind(high), kind(step), kind(value), hint=hint)

    def _change(self, target: str, name: str, default: Any, given: Any) -> None:
        self._touched[(target, name)] = wall.monotonic()
        try:
            value = tuple(float(part) for part in str(given).split(",")) if isinstance(default, tuple) else given
            self._desk.send_event(ChangeParameter(target, name, value))
        except (ValueError, OperatorEventError) as error:
            self._desk.notify("Not changed", str(error))


def describe(field: dataclasses.Field[Any]) -> str:
    """Meaning, unit, range and default of a parameter."""
    data = field.metadata
    unit = "" if data["unit"] == "1" else f" {data['unit']}"
    low = "" if data["minimum"] is None else f"from {data['minimum']:g} "
    high = "" if data["maximum"] is None else f"to {data['maximum']:g}"
    allowed = f"; {(low + high).strip()}{unit}" if low or high else ""
    return f"{data['meaning']}{allowed}; default {_shown(field.default)}{unit}"


def _is_editable(value: Any) -> bool:
    return not (isinstance(value, tuple) and any(not isinstance(part, int | float) for part in value))


def _shown(value: Any) -> Any:
    return ", ".join(f"{part:g}" for part in value) if isinstance(value, tuple) else value


def _rounded(step: float) -> float:
    """A power of ten, or twice or five times one, not above a step."""
    power = 10.0 ** math.floor(math.log10(step))
    return next(factor * power for factor in (5.0, 2.0, 1.0) if factor * power <= step * (1.0 + 1e-9))
