"""Whether the walking controller is well: figures of a run, and lines for the operator at the moment it is not.

A quadratic program without a solution has a fallback in the controller; here it gets its event. The measured centre of
pressure strays from the commanded one where a sole does not stand on what the controller takes it to stand on.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from behaviors import LogLine
from skills.geometry import Array
from skills.parameters import parameter, parameters
from skills.walking import ControlSample, QpStatus

_WALKER = "walker"


@parameters
class ControlHealthParameters:
    """When the operator hears of the walking controller."""

    cop_error: float = parameter(
        0.05, unit="m", minimum=0.005, maximum=1.0, meaning="measured from commanded CoP, more is an alarm"
    )
    cop_error_duration: float = parameter(
        0.1, unit="s", minimum=0.0, maximum=10.0, meaning="for so long without a break"
    )


@dataclass(frozen=True, slots=True)
class ControlFigures:
    """How well the walking controller did.

    Attributes:
        ticks: control ticks.
        qp_inaccurate: ticks whose program ended at the iteration limit, with its best iterate.
        qp_failed: ticks whose program had no solution: the fallback commanded.
        dcm_error_max_m: largest distance of the DCM from its reference.
        cop_error_median_m, cop_error_p99_m: measured from commanded CoP; None where nothing measures it.
        cop_alarms: times that it strayed too far for too long.
        torque_share_max: largest commanded torque by its limit.
    """

    ticks: int
    qp_inaccurate: int
    qp_failed: int
    dcm_error_max_m: float
    cop_error_median_m: float | None
    cop_error_p99_m: float | None
    cop_alarms: int
    torque_share_max: float


class ControlHealth:
    """Goes through the samples of a run as they come."""

    def __init__(self, parameters: ControlHealthParameters) -> None:
        self._parameters = parameters
        self._statuses = dict.fromkeys(QpStatus, 0)
        self._last_status = QpStatus.SOLVED
        self._dcm_error_max = self._torque_share_max = 0.0
        self._cop_errors: list[Array] = []
        self._astray_since: float | None = None
        self._alarmed = False
        self._alarms = 0

    def watch(self, samples: tuple[ControlSample, ...]) -> tuple[LogLine, ...]:
        """Count what is in new samples, and say what the operator should hear."""
        if not samples:
            return ()
        lines: list[LogLine] = []
        cop_errors = np.array([sample.cop_error for sample in samples])
        self._cop_errors.append(cop_errors[np.isfinite(cop_errors)])
        self._dcm_error_max = max(self._dcm_error_max, *(sample.dcm_error for sample in samples))
        torque_share = float(np.abs([sample.torque_shares for sample in samples]).max())
        self._torque_share_max = max(self._torque_share_max, torque_share)
        for sample, cop_error in zip(samples, cop_errors.tolist(), strict=True):
            self._statuses[sample.qp_status] += 1
            lines += self._program(sample)
            lines += self._pressure(sample.time, cop_error)
        return tuple(lines)

    def figures(self) -> ControlFigures:
        """The figures so far."""
        cop = np.concatenate(self._cop_errors) if self._cop_errors else np.zeros(0)
        return ControlFigures(
            ticks=sum(self._statuses.values()),
            qp_inaccurate=self._statuses[QpStatus.INACCURATE],
            qp_failed=self._statuses[QpStatus.FAILED],
            dcm_error_max_m=round(self._dcm_error_max, 4),
            cop_error_median_m=round(float(np.median(cop)), 4) if len(cop) else None,
            cop_error_p99_m=round(float(np.percentile(cop, 99)), 4) if len(cop) else None,
            cop_alarms=self._alarms,
            torque_share_max=round(self._torque_share_max, 3),
        )

    def _program(self, sample: ControlSample) -> list[LogLine]:
        """One line when programs begin to fail, not one a tick."""
        began = sample.qp_status is QpStatus.FAILED and self._last_status is not QpStatus.FAILED
        self._last_status = sample.qp_status
        if not began:
            return []
        text = f"the whole-body program has no solution in {sample.phase.value}: the fallback commands"
        return [LogLine(sample.time, _WALKER, "warning", text)]

    def _pressure(self, time: float, cop_error: float) -> list[LogLine]:
        """One line when the CoP has been astray for long enough."""
        limits = self._parameters
        # Not a number, where no foot is loaded or nothing measures it, is no error.
        if not cop_error > limits.cop_error:
            self._astray_since, self._alarmed = None, False
            return []
        self._astray_since = time if self._astray_since is None else self._astray_since
        lasted = time - self._astray_since
        if self._alarmed or lasted < limits.cop_error_duration:
            return []
        self._alarmed = True
        self._alarms += 1
        text = (
            f"the measured CoP has been more than {limits.cop_error:g} m from the commanded one for {lasted:.2f} s: "
            "a sole does not stand on what it is taken to stand on"
        )
        return [LogLine(time, _WALKER, "warning", text)]
