"""Writes the footstep plans of a run into a folder, one file each, beside the run and not in its way.

A plan is a function of its request, so the search is made again for the log, to the same bits; the run itself carries
nothing for it. Where a realtime search was ended by the clock, the log holds the search that the clock cut short.
"""

from __future__ import annotations

from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path

from behaviors import JobRecord
from lookstep.moment import Moment
from lookstep.plan_log.plan_file import PLAN_SUFFIX, LoggedPlan, write_plan
from skills.footsteps import FootstepPlan, PlanRequest, SearchLog, plan_on_request


class PlanRecorder:
    """An observer that writes a plan log for every plan delivered."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._worker = ThreadPoolExecutor(1, thread_name_prefix="plan-log")
        self._writing: list[Future[None]] = []

    def observe(self, moment: Moment) -> None:
        """Have the plans of one tick written."""
        for job in moment.jobs:
            if isinstance(job.result, FootstepPlan) and isinstance(job.arguments[0], PlanRequest):
                self._writing.append(self._worker.submit(self._write, job, job.arguments[0], job.result))

    def close(self) -> None:
        """Wait until all is written.

        Raises:
            OSError: where a file could not be.
        """
        self._worker.shutdown(wait=True)
        for written in self._writing:
            written.result()

    def _write(self, job: JobRecord, request: PlanRequest, plan: FootstepPlan) -> None:
        searches: list[SearchLog] = []
        plan_on_request(request, logs=searches)
        milliseconds = float("nan") if job.compute_seconds is None else 1e3 * job.compute_seconds
        logged = LoggedPlan(request, plan, tuple(searches), job.ended, milliseconds)
        write_plan(self._folder / f"{plan.plan_id:04d}{PLAN_SUFFIX}", logged)
