"""Alarms and figures of the walking controller, from samples that are made up."""

import numpy as np
import pytest

from lookstep.control_health import ControlHealth, ControlHealthParameters
from skills.footsteps import Side, Stance
from skills.geometry import Pose
from skills.walking import ControlSample, QpStatus, WalkingPhase

LOAD = 800.0
PERIOD = 0.002


def sample(tick: int, *, cop_error: float = 0.0, qp_status: QpStatus = QpStatus.SOLVED, loaded: bool = True):
    """One tick on level ground; a pitch moment moves the measured CoP forward by `cop_error`."""
    soles = {side: Pose.from_xyz_rpy((0.0, 0.1 * side.sign, 0.0), (0.0, 0.0, 0.0)) for side in Side}
    commanded = {side: np.array((0.0, 0.0, LOAD, 0.0, 0.0, 0.0)) for side in Side}
    force = LOAD if loaded else 0.0
    measured = {side: np.array((0.0, 0.0, force, 0.0, -force * cop_error, 0.0)) for side in Side}
    return ControlSample(
        time=tick * PERIOD,
        phase=WalkingPhase.STANDING,
        com_world=np.zeros(3),
        dcm_world=np.zeros(3),
        dcm_reference_world=np.zeros(3),
        cmp_world=np.zeros(3),
        dcm_error=0.001 * tick,
        angular_momentum_world=np.zeros(3),
        stance=Stance(soles[Side.LEFT], soles[Side.RIGHT]),
        wrenches_sole=commanded,
        measured_wrenches_sole=measured,
        torque_shares=np.array((0.2, -0.001 * tick)),
        support_world=np.zeros((3, 2)),
        qp_status=qp_status,
        qp_iterations=10,
        qp_time=0.0,
    )


def test_every_run_of_failed_programs_gets_one_line_and_every_failure_is_counted():
    health = ControlHealth(ControlHealthParameters())
    statuses = [QpStatus.SOLVED, QpStatus.FAILED, QpStatus.FAILED, QpStatus.INACCURATE, QpStatus.FAILED]
    lines = [line for k, status in enumerate(statuses) for line in health.watch((sample(k, qp_status=status),))]
    assert [line.time for line in lines] == [pytest.approx(PERIOD), pytest.approx(4 * PERIOD)]
    assert all(line.level == "warning" and "no solution in standing" in line.text for line in lines)
    figures = health.figures()
    assert (figures.ticks, figures.qp_failed, figures.qp_inaccurate) == (5, 3, 1)


def test_cop_that_strays_for_long_is_told_once_and_a_short_stray_is_not():
    health = ControlHealth(ControlHealthParameters(cop_error=0.03, cop_error_duration=0.009))
    errors = [0.0, 0.05, 0.05, 0.0, *[0.05] * 12, 0.0, *[0.05] * 6]
    lines = [line for k, error in enumerate(errors) for line in health.watch((sample(k, cop_error=error),))]
    assert [round(line.time / PERIOD) for line in lines] == [9, 22]
    assert "more than 0.03 m" in lines[0].text
    assert health.figures().cop_alarms == 2


def test_figures_are_those_of_the_samples():
    health = ControlHealth(ControlHealthParameters())
    health.watch(tuple(sample(k, cop_error=0.001 * k) for k in range(11)))
    figures = health.figures()
    assert figures.cop_error_median_m == pytest.approx(0.005)
    assert figures.cop_error_p99_m == pytest.approx(0.0099, abs=1e-4)
    assert figures.dcm_error_max_m == pytest.approx(0.01)
    assert figures.torque_share_max == pytest.approx(0.2)


def test_feet_in_the_air_have_no_cop_error():
    health = ControlHealth(ControlHealthParameters(cop_error_duration=0.0))
    assert health.watch(tuple(sample(k, loaded=False) for k in range(3))) == ()
    assert health.figures().cop_error_median_m is None
