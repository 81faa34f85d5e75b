import pytest

from sim_envs.judge import PauseCause, PhaseSample, find_pauses
from skills.walking.walking_state import WalkingPhase

TICK = 0.02


def timeline(*spans):
    """Samples at 50 Hz of (phase, duration, flags) one after the other."""
    samples: list[PhaseSample] = []
    for phase, duration, *flags in spans:
        for _ in range(round(duration / TICK)):
            samples.append(PhaseSample(len(samples) * TICK, phase, **(flags[0] if flags else {})))
    return samples


STAND, TRANSFER, SWING = WalkingPhase.STANDING, WalkingPhase.TRANSFER, WalkingPhase.SWING


def test_a_walk_without_waiting_has_no_pause():
    walk = [(TRANSFER, 0.8), (SWING, 1.2)] * 5
    assert find_pauses(timeline((STAND, 2.0), *walk, (TRANSFER, 0.8)), 0.8) == ()


def test_only_more_than_the_limit_is_a_pause():
    for extra, count in ((0.40, 0), (0.42, 1)):
        samples = timeline((SWING, 1.2), (STAND, extra), (TRANSFER, 0.8), (SWING, 1.2))
        pauses = find_pauses(samples, 0.8)
        assert len(pauses) == count
    assert pauses[0].start == pytest.approx(1.2)
    assert pauses[0].duration == pytest.approx(1.22)


@pytest.mark.parametrize(
    ("phase", "flags", "cause"),
    [
        (STAND, {}, PauseCause.NO_PLAN),
        (STAND, {"in_review": True}, PauseCause.REVIEW),
        (STAND, {"blocked": True}, PauseCause.BLOCKED),
        (STAND, {"paused": True}, PauseCause.OPERATOR),
        (STAND, {"old_data": True}, PauseCause.OLD_DATA),
        (TRANSFER, {"transfer_overdue": True}, PauseCause.DCM_HOLD),
    ],
)
def test_every_pause_has_its_cause(phase, flags, cause):
    samples = timeline((SWING, 1.2), (TRANSFER, 0.8), (phase, 1.0, flags), (SWING, 1.2))
    assert [pause.cause for pause in find_pauses(samples, 0.8)] == [cause]


def test_the_longest_wait_names_the_pause():
    samples = timeline((SWING, 1.0), (STAND, 0.5), (STAND, 2.0, {"blocked": True}), (TRANSFER, 0.8), (SWING, 1.0))
    assert [pause.cause for pause in find_pauses(samples, 0.8)] == [PauseCause.BLOCKED]


def test_waiting_for_the_first_step_or_without_a_goal_is_no_pause():
    idle = {"goal_active": False}
    samples = timeline((STAND, 5.0), (SWING, 1.2), (STAND, 5.0, idle), (STAND, 3.0), (SWING, 1.2))
    assert find_pauses(samples, 0.8) == ()


def test_standing_until_the_end_is_a_pause():
    (pause,) = find_pauses(timeline((SWING, 1.2), (STAND, 5.0)), 0.8)
    assert pause.duration == pytest.approx(5.0, abs=1.5 * TICK)
    assert pause.cause is PauseCause.NO_PLAN


def test_no_samples_have_no_pause():
    assert find_pauses((), 0.8) == ()
