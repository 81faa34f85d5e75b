"""The executor: when results arrive, in which order, what never arrives, and what is written down."""

from __future__ import annotations

import threading
from collections.abc import Iterator

import pytest
from scripted import leaf_of, make, run

from behaviors import Executor, ExecutorMode, JobOutcome, Outcome
from behaviors.canonical import digest

SQUARE = "{tree: t, root: {sequence: [GiveNumber: {out: [number], value: 3}, Square: {in: [number], out: [square]}]}}"


@pytest.fixture
def executor() -> Iterator[Executor]:
    executor = Executor()
    yield executor
    executor.shutdown()


def submit(executor: Executor, function, *arguments, budget: float = 0.1, time: float = 0.0):
    return executor.submit(function, arguments, path="/t", time=time, budget=budget)


def test_lockstep_delivers_when_the_budget_has_passed_and_not_before(executor: Executor):
    job = submit(executor, lambda: 7, time=1.0, budget=0.1)
    job.future.result()
    for time in (1.0, 1.02, 1.0999):
        executor.deliver(time)
        assert not job.done
    executor.deliver(1.0 + 5 * 0.02)
    assert job.done and job.result == 7


def test_lockstep_waits_for_a_slow_computation(executor: Executor):
    release = threading.Event()
    job = submit(executor, release.wait)
    threading.Timer(0.01, release.set).start()
    executor.deliver(0.1)
    assert job.done and job.result is True


def test_delivery_is_in_the_order_of_due_time_and_then_of_submission(executor: Executor):
    budgets = (0.3, 0.1, 0.2, 0.1)
    jobs = [submit(executor, lambda: 0, budget=budget) for budget in budgets]
    executor.deliver(1.0)
    assert all(job.done for job in jobs)
    assert [record.job_id for record in executor.drain_records()] == [1, 3, 2, 0]


def test_a_cancelled_result_never_arrives(executor: Executor):
    release = threading.Event()
    job = submit(executor, release.wait)
    executor.cancel(job, 0.05)
    release.set()
    executor.deliver(10.0)
    assert not job.done
    (record,) = executor.drain_records()
    assert record.outcome is JobOutcome.CANCELLED
    assert record.compute_seconds is None and not record.missed


def test_realtime_delivers_what_is_ready_and_nothing_else():
    executor = Executor(ExecutorMode.REALTIME)
    release = threading.Event()
    slow = submit(executor, release.wait, budget=0.0)
    fast = submit(executor, lambda: 1, budget=100.0)
    fast.future.result()
    executor.deliver(5.0)
    assert fast.done and not slow.done
    release.set()
    slow.future.result()
    executor.deliver(5.0)
    assert slow.done
    executor.shutdown()


def test_the_record_tells_budget_margin_and_misses(executor: Executor):
    executor.submit(lambda: 0, (), path="/t/plan", time=1.0, budget=0.5, deadline=1.6)
    executor.deliver(1.5)
    (record,) = executor.drain_records()
    assert (record.path, record.submitted, record.due, record.ended, record.budget) == ("/t/plan", 1.0, 1.5, 1.5, 0.5)
    assert record.compute_seconds is not None and record.margin == 0.5 - record.compute_seconds
    assert record.deadline_margin == pytest.approx(0.1)
    assert record.missed == (record.compute_seconds > 0.5)


def test_a_compute_time_over_budget_is_a_miss_although_lockstep_delivers_in_time(executor: Executor):
    submit(executor, lambda: sum(range(1000)), budget=0.0)
    executor.deliver(0.0)
    assert executor.drain_records()[0].missed


def test_shutdown_leaves_no_worker_behind():
    before = threading.active_count()
    for _ in range(20):
        tree, robot = make(SQUARE)
        run(tree, robot, 2)
        tree.shutdown()
    assert threading.active_count() == before


def test_a_skill_leaf_runs_for_its_latency_and_publishes_then():
    tree, robot = make(SQUARE)
    run(tree, robot, 10)
    assert tree.outcome is Outcome.RUNNING and tree.root.reason == "computing"
    assert tree.blackboard["square"] is None
    run(tree, robot, 1)
    assert tree.outcome is Outcome.SUCCESS and tree.blackboard["square"] == 9.0
    assert [record.path for record in tree.drain_jobs()] == ["/t/square"]
    tree.shutdown()


def test_a_preempted_skill_leaf_cancels_and_its_old_result_never_arrives():
    tree, robot = make(
        """
        tree: t
        ports: {in: {number: float}}
        root:
          reactive_selector:
            - sequence: [Scripted: {says: FFSF}, Scripted]
            - Square: {in: [number], out: [square], latency: 0.1}
        """
    )
    tree.set_input("number", 2.0)
    run(tree, robot, 3)
    (record,) = tree.drain_jobs()
    assert record.outcome is JobOutcome.CANCELLED
    assert tree.blackboard["square"] is None
    tree.shutdown()


def test_an_exception_in_the_computation_is_a_fault_of_its_leaf(monkeypatch: pytest.MonkeyPatch):
    tree, robot = make(SQUARE)
    leaf = leaf_of(tree, "/t/square")
    monkeypatch.setattr(leaf, "request", lambda: leaf.call(lambda: 1 / 0))  # type: ignore[attr-defined]
    run(tree, robot, 11)
    assert tree.outcome is Outcome.ERROR
    assert tree.reason == "/t/square: ZeroDivisionError in tick: division by zero"
    assert tree.drain_jobs()[0].outcome is JobOutcome.RAISED
    tree.shutdown()


def test_the_hash_made_beside_a_computation_is_that_of_the_result(executor: Executor):
    job = submit(executor, lambda: (1.0, "x"))
    changing = submit(executor, lambda: [1.0])
    without = submit(executor, object)
    assert executor.deliver(0.1) == (job, changing, without)
    assert job.digest == digest((1.0, "x"))[0]
    assert changing.digest is None and without.digest is None


def test_an_alarm_rings_in_realtime_alone():
    lockstep, realtime = Executor(ExecutorMode.LOCKSTEP), Executor(ExecutorMode.REALTIME)
    assert lockstep.alarm(0.0) is None
    rings, silent = realtime.alarm(-1.0), realtime.alarm(1e6)
    assert rings is not None and rings()
    assert silent is not None and not silent()
    for executor in (lockstep, realtime):
        executor.shutdown()
