from collections.abc import Callable
from dataclasses import replace

import pytest

from skills.footsteps.footstep import Footstep, Side
from skills.walking.step_queue import accepted_steps

Maker = Callable[..., tuple[Footstep, ...]]


def test_steps_that_began_are_dropped(make_steps: Maker) -> None:
    steps = make_steps(4)
    assert accepted_steps(steps, 1, Side.RIGHT) == steps[2:]
    assert accepted_steps(steps, None, None) == steps
    assert accepted_steps(steps, 9, Side.LEFT) == ()


def test_feet_take_turns(make_steps: Maker) -> None:
    with pytest.raises(ValueError, match="step 0 is left after a left step"):
        accepted_steps(make_steps(3), None, Side.LEFT)
    left, right, _ = make_steps(3)
    with pytest.raises(ValueError, match="step 5 is right after a right step"):
        accepted_steps((left, right, replace(right, sequence_id=5)), None, Side.RIGHT)


def test_sequence_ids_increase(make_steps: Maker) -> None:
    left, right, _ = make_steps(3)
    with pytest.raises(ValueError, match="step 0 comes after step 0"):
        accepted_steps((left, replace(right, sequence_id=0)), None, None)


@pytest.mark.parametrize("change", ({"swing_duration": 0.0}, {"transfer_duration": float("nan")}))
def test_steps_that_take_no_time_are_refused(make_steps: Maker, change: dict[str, float]) -> None:
    steps = make_steps(2)
    with pytest.raises(ValueError, match=r"step 1: got .* needs more than 0"):
        accepted_steps((steps[0], replace(steps[1], **change)), None, None)
