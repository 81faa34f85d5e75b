"""Rows that come with every tick, collected and sent to rerun a column at a time."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence

import numpy as np
import rerun as rr

from lookstep.recording.blueprint import TIMELINE
from skills.geometry.pose import Array


class Columns:
    """Buffers scalars, states and transforms by entity until they are flushed."""

    def __init__(self, stream: rr.RecordingStream) -> None:
        self._stream = stream
        self._scalars: dict[str, list[tuple[float, float]]] = defaultdict(list)
        self._states: dict[str, list[tuple[float, str]]] = defaultdict(list)
        self._transforms: dict[str, list[tuple[float, Array, Array]]] = defaultdict(list)

    def scalar(self, entity: str, time: float, value: float) -> None:
        """One point of a plot."""
        self._scalars[entity].append((time, value))

    def send_scalars(self, times: Sequence[float], plots: Mapping[str, Array]) -> None:
        """All points of several entities' plots at the same times, each (times, plots)."""
        # As numpy's time spans: rerun turns numbers into spans one by one.
        spans = np.round(1e9 * np.asarray(times)).astype("timedelta64[ns]")
        column = rr.TimeColumn(TIMELINE, duration=spans)
        for entity, values in plots.items():
            rr.send_columns(entity, [column], rr.Scalars.columns(scalars=values), recording=self._stream)

    def state(self, entity: str, time: float, state: str) -> None:
        """One change of a lane."""
        self._states[entity].append((time, state))

    def transform(self, entity: str, time: float, position: Array, quaternion_wxyz: Array) -> None:
        """One pose of an entity in its parent [m]."""
        self._transforms[entity].append((time, position, np.roll(quaternion_wxyz, -1)))

    def flush(self) -> None:
        """Send what has been collected."""
        for entity, rows in self._scalars.items():
            self._send(entity, [time for time, _ in rows], rr.Scalars.columns(scalars=[value for _, value in rows]))
        for entity, rows in self._states.items():
            self._send(entity, [time for time, _ in rows], rr.StateChange.columns(state=[state for _, state in rows]))
        for entity, rows in self._transforms.items():
            columns = rr.Transform3D.columns(
                translation=np.array([position for _, position, _ in rows]),
                quaternion=np.array([quaternion for _, _, quaternion in rows]),
            )
            self._send(entity, [time for time, _, _ in rows], columns)
        for buffer in (self._scalars, self._states, self._transforms):
            buffer.clear()

    def _send(self, entity: str, times: list[float], columns: rr.ComponentColumnList) -> None:
        rr.send_columns(entity, [rr.TimeColumn(TIMELINE, duration=times)], columns, recording=self._stream)
