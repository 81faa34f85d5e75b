"""Robot time that is halted stands still, passes tick by tick, and goes on when it is let."""

from __future__ import annotations

import threading

import pytest

from lookstep.pace import Pace, PaceState


def test_a_halted_pace_lets_one_tick_pass_for_each_step():
    pace, passed = Pace(None), []
    waiting, counted = threading.Semaphore(0), threading.Semaphore(0)

    def loop() -> None:
        for tick in range(4):
            waiting.release()
            pace.wait_to_go()
            passed.append(tick)
            counted.release()

    pace.halt()
    assert pace.state == PaceState(None, True)
    thread = threading.Thread(target=loop)
    thread.start()
    for steps in (1, 2):
        waiting.acquire()
        assert len(passed) == steps - 1
        pace.step()
        counted.acquire()
    assert passed == [0, 1]
    pace.go()
    thread.join()
    assert passed == [0, 1, 2, 3]


def test_steps_before_a_halt_do_not_count():
    pace = Pace(None)
    pace.step()
    pace.halt()
    assert pace._steps == 0


@pytest.mark.parametrize("speed", (0.0, -1.0, float("inf"), float("nan")))
def test_a_speed_that_is_none_is_refused(speed):
    with pytest.raises(ValueError, match="needs a positive number"):
        Pace(1.0).set_speed(speed)
