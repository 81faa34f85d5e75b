"""Computes for leaves that take longer than a tick, in one of two modes with the same contract.

`lockstep` delivers a result when robot time has advanced by the job's budget: at that moment it waits for the worker
if it must, so the same seed gives the same trace at any simulation speed. `realtime` delivers what is ready. In both,
results arrive only in `deliver`, which the tree calls at the start of a tick, in the order of due time and then of
submission; a cancelled job's result arrives never. Wall time is measured for the record and decides nothing in
lockstep: a deadline miss is a compute time over budget.
"""

from __future__ import annotations

import time as wall
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, field, replace
from enum import Enum
from typing import Any

from behaviors.canonical import CanonicalError, digest

# Robot times are multiples of the control period up to rounding; a job due at a tick must not slip to the next.
_TIME_TOLERANCE = 1e-9


class ExecutorMode(Enum):
    """When results are delivered."""

    LOCKSTEP = "lockstep"
    REALTIME = "realtime"


class JobOutcome(Enum):
    """How a job ended."""

    DELIVERED = "delivered"
    RAISED = "raised"
    CANCELLED = "cancelled"


@dataclass(frozen=True, slots=True)
class JobRecord:
    """The account of one job.

    Attributes:
        job_id: counts submissions from 0.
        path: the node that submitted it.
        submitted, due, ended: robot times of submission, of the end of the budget, and of delivery or cancelling [s].
        budget: robot time that the result may take [s].
        deadline: robot time at which the result is needed; None where there is no such time [s].
        compute_seconds: wall time of the computation; None for a job cancelled before it ended [s].
        cpu_seconds: processor time of its thread alone; None likewise [s].
        outcome: delivered, raised or cancelled.
        arguments: what was computed from.
        result: what came out; None where nothing was delivered.
    """

    job_id: int
    path: str
    submitted: float
    due: float
    ended: float
    budget: float
    deadline: float | None
    compute_seconds: float | None
    cpu_seconds: float | None
    outcome: JobOutcome
    arguments: tuple[Any, ...] = field(default=(), repr=False)
    result: Any = field(default=None, repr=False)

    @property
    def margin(self) -> float | None:
        """Budget less compute time [s]."""
        return None if self.compute_seconds is None else self.budget - self.compute_seconds

    @property
    def bare(self) -> JobRecord:
        """The account without arguments and result, which may be images: for those who keep it."""
        return replace(self, arguments=(), result=None)

    @property
    def missed(self) -> bool:
        """Whether the computation took longer than its budget."""
        return self.compute_seconds is not None and self.compute_seconds > self.budget

    @property
    def deadline_margin(self) -> float | None:
        """Robot time between delivery and deadline; negative where it came too late [s]."""
        return None if self.deadline is None else self.deadline - self.ended


class Job:
    """A computation under way.

    Attributes:
        done: whether it was delivered, with a result or an error.
        digest: hash of the result for the trace, where the result is immutable; made beside the computation, because
            hashing an image takes longer than a tick should.
    """

    __slots__ = (
        "arguments",
        "budget",
        "deadline",
        "digest",
        "done",
        "due",
        "error",
        "future",
        "job_id",
        "path",
        "result",
        "submitted",
    )

    def __init__(
        self,
        job_id: int,
        path: str,
        arguments: tuple[Any, ...],
        submitted: float,
        budget: float,
        deadline: float | None,
    ) -> None:
        self.job_id = job_id
        self.path = path
        self.arguments = arguments
        self.submitted = submitted
        self.budget = budget
        self.deadline = deadline
        self.due = submitted + budget
        self.future: Future[_Computed]
        self.done = False
        self.result: Any = None
        self.error: Exception | None = None
        self.digest: bytes | None = None


@dataclass(frozen=True, slots=True)
class _Computed:
    result: Any
    error: Exception | None
    digest: bytes | None
    compute_seconds: float
    cpu_seconds: float


class Executor:
    """A few worker threads for one tree."""

    def __init__(self, mode: ExecutorMode = ExecutorMode.LOCKSTEP, *, workers: int = 2) -> None:
        self.mode = mode
        self._pool = ThreadPoolExecutor(workers, thread_name_prefix="skill")
        self._pending: list[Job] = []
        self._submissions = 0
        self._records: list[JobRecord] = []

    def submit(
        self,
        function: Callable[..., Any],
        arguments: tuple[Any, ...],
        *,
        path: str,
        time: float,
        budget: float,
        deadline: float | None = None,
        late: float = 0.0,
    ) -> Job:
        """Begin a computation of a pure function of immutable arguments.

        Args:
            function: what to compute.
            arguments: its positional arguments.
            path: the node that asks.
            time: robot time now [s].
            budget: robot time after which a lockstep result is delivered [s].
            deadline: robot time at which the result is needed, for the record [s].
            late: robot time by which a lockstep result comes after its budget; of an injected fault [s].
        """
        job = Job(self._submissions, path, arguments, time, budget, deadline)
        job.due += late
        self._submissions += 1
        job.future = self._pool.submit(_compute, function, arguments)
        self._pending.append(job)
        self._pending.sort(key=lambda pending: (pending.due, pending.job_id))
        return job

    def alarm(self, seconds: float) -> Callable[[], bool] | None:
        """Whether so much wall time has passed since now; None in lockstep, where wall time decides nothing."""
        if self.mode is ExecutorMode.LOCKSTEP:
            return None
        end = wall.perf_counter() + seconds
        return lambda: wall.perf_counter() > end

    def deliver(self, time: float) -> tuple[Job, ...]:
        """Hand over the results that are due at this robot time, in order."""
        delivered = []
        for job in tuple(self._pending):
            if self._is_due(job, time):
                self._pending.remove(job)
                computed = job.future.result()
                job.result, job.error, job.digest = computed.result, computed.error, computed.digest
                job.done = True
                delivered.append(job)
                self._record(job, time, JobOutcome.DELIVERED if job.error is None else JobOutcome.RAISED)
        return tuple(delivered)

    def cancel(self, job: Job, time: float) -> None:
        """Drop a job: its result never arrives. A job that is delivered stays so."""
        if job in self._pending:
            self._pending.remove(job)
            job.future.cancel()
            self._record(job, time, JobOutcome.CANCELLED)

    def cancel_all(self, path: str, time: float) -> None:
        """Drop all that a node has under way."""
        for job in self.pending:
            if job.path == path:
                self.cancel(job, time)

    @property
    def pending(self) -> tuple[Job, ...]:
        """What is under way, in the order in which it is due."""
        return tuple(self._pending)

    def drain_records(self) -> tuple[JobRecord, ...]:
        """The jobs that ended since the last call, in the order in which they ended."""
        records, self._records = tuple(self._records), []
        return records

    def shutdown(self) -> None:
        """Drop what is under way and end the workers."""
        self._pending.clear()
        self._pool.shutdown(wait=True, cancel_futures=True)

    def _is_due(self, job: Job, time: float) -> bool:
        if self.mode is ExecutorMode.REALTIME:
            return job.future.done()
        return job.due <= time + _TIME_TOLERANCE

    def _record(self, job: Job, time: float, outcome: JobOutcome) -> None:
        finished = job.future.done() and not job.future.cancelled()
        computed = job.future.result() if finished and outcome is not JobOutcome.CANCELLED else None
        self._records.append(
            JobRecord(
                job_id=job.job_id,
                path=job.path,
                submitted=job.submitted,
                due=job.due,
                ended=time,
                budget=job.budget,
                deadline=job.deadline,
                compute_seconds=computed and computed.compute_seconds,
                cpu_seconds=computed and computed.cpu_seconds,
                outcome=outcome,
                arguments=job.arguments,
                result=job.result,
            )
        )


def _compute(function: Callable[..., Any], arguments: tuple[Any, ...]) -> _Computed:
    started, cpu_started = wall.perf_counter(), wall.thread_time()
    result, error = None, None
    try:
        result = function(*arguments)
    except Exception as raised:
        error = raised
    compute_seconds, cpu_seconds = wall.perf_counter() - started, wall.thread_time() - cpu_started
    return _Computed(result, error, _digest(result), compute_seconds, cpu_seconds)


def _digest(result: Any) -> bytes | None:
    try:
        hashed, immutable = digest(result)
    except CanonicalError:
        # Where such a result goes to a port, the trace says so.
        return None
    return hashed if immutable else None
