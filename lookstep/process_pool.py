"""Runs one function over many arguments in processes of their own, one thread each."""

from __future__ import annotations

import multiprocessing
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from typing import TypeVar

from skills.kernels import prepare_runtime

A = TypeVar("A")
R = TypeVar("R")


def run_in_processes(function: Callable[[A], R], arguments: Sequence[A], workers: int) -> Iterator[R]:
    """Results as they come, in no order.

    Args:
        function: one that another process finds by its name, or a partial of one.
        arguments: it is called with one of these each time.
        workers: processes that run at the same time; one is this process itself.
    """
    if workers == 1:
        yield from map(function, arguments)
        return
    # Forking would copy locks that other threads hold.
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(workers, mp_context=context, initializer=prepare_runtime) as pool:
        running = [pool.submit(function, argument) for argument in arguments]
        try:
            for ended in as_completed(running):
                yield ended.result()
        finally:
            pool.shutdown(wait=True, cancel_futures=True)
