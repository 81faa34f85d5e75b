"""An executor that delivers each result in the tick in which a recording delivered it."""

from __future__ import annotations

import math
from collections import defaultdict

from behaviors.executor import Executor, ExecutorMode, Job
from behaviors.recorded_trace import RecordedTrace


class RecordedExecutor(Executor):
    """Delivers by node and count of its computations; one that the recording does not know comes after its budget."""

    def __init__(self, trace: RecordedTrace) -> None:
        super().__init__(ExecutorMode.LOCKSTEP)
        self._times: dict[str, list[float]] = defaultdict(list)
        for tick in trace.ticks():
            for path in tick.line.get("delivered", ()):
                self._times[path].append(tick.time)

    def _due_time(self, job: Job) -> float:
        """The first recorded delivery for its node that is later than the submission."""
        times = self._times.get(job.path, [])
        return next((time for time in times if time > job.submitted), math.inf if times else job.due)

    def deliver(self, time: float) -> tuple[Job, ...]:
        """Hand over what the recording handed over by this robot time."""
        for job in self._pending:
            job.due = self._due_time(job)
        return super().deliver(time)
