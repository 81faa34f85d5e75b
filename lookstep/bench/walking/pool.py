"""Runs trials in processes of their own, one thread each."""

from __future__ import annotations

import multiprocessing
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed

from lookstep.bench.walking.trial import Trial, TrialResult, run_trial
from lookstep.configuration import Configuration
from skills.kernels import prepare_runtime


def run_trials(trials: Sequence[Trial], configuration: Configuration, workers: int) -> Iterator[TrialResult]:
    """Results as they come; one worker is this process itself."""
    if workers == 1:
        yield from (run_trial(trial, configuration) for trial in trials)
        return
    # Forking would copy locks that other threads hold.
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(workers, mp_context=context, initializer=prepare_runtime) as pool:
        running = [pool.submit(run_trial, trial, configuration) for trial in trials]
        try:
            for ended in as_completed(running):
                yield ended.result()
        finally:
            pool.shutdown(wait=True, cancel_futures=True)
