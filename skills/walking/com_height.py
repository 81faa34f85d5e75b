"""The height of the CoM over the next phases: as commanded where the legs can reach, lower where they cannot.

The CoM is as low at each moment as the straightest planned leg spans from hip to ankle, and as high as the most bent
one needs; legs count as mass at their ankles, because a leg that reaches out moves the pelvis away from the CoM. The
height is a cubic B-spline whose control points keep the strictest of these bounds around them, smoothed, and it starts
in the present motion, so that planning anew moves nothing suddenly.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from skills.footsteps.footstep import Side
from skills.geometry.pose import Array, rotation_z, wrap_angle
from skills.walking.dcm_plan import DcmPlan
from skills.walking.preview import PlannedPhase
from skills.walking.robot_model import RobotModel
from skills.walking.uniform_spline import UniformSpline, controls_of_motion, minimum_jerk
from skills.walking.walking_parameters import WalkingParameters

_SMOOTHING = np.array([1.0, 4.0, 6.0, 4.0, 1.0]) / 16.0
_SAMPLES_PER_KNOT = 2
# Shares of an offset from the target that stay after each knot: a body too high for its legs must come down, one that
# is low has time, and rising fast costs balance.
_KEPT_ABOVE, _KEPT_BELOW = 0.5, 0.8


@dataclass(frozen=True, slots=True, eq=False)
class ComState:
    """The CoM when a height plan is made.

    Attributes:
        com: position, (3,) in the world [m].
        velocity, acceleration: upwards [m/s, m/s^2].
        p_pelvis_body: `body_offset`, (3,) [m].
        yaw: heading of the pelvis [rad].
    """

    com: Array
    velocity: float
    acceleration: float
    p_pelvis_body: Array
    yaw: float


def plan_height(
    phases: Sequence[PlannedPhase], dcm_plan: DcmPlan, state: ComState, model: RobotModel, parameters: WalkingParameters
) -> UniformSpline:
    """CoM height over the time from now, a spline of one dimension [s, m]."""
    spacing = parameters.height_knot
    count = int(np.ceil(parameters.height_horizon / spacing))
    times = np.arange(count * _SAMPLES_PER_KNOT + 1) * spacing / _SAMPLES_PER_KNOT
    band = reach_band(phases, dcm_plan, state, model, parameters, times)
    nominal = nominal_height(phases, float(state.com[2]), parameters, times)
    reach = 4 * _SAMPLES_PER_KNOT
    around = np.lib.stride_tricks.sliding_window_view(
        np.pad(band, ((0, 0), (reach, reach)), mode="edge"), 2 * reach + 1, 1
    )
    floor, cap = around[0].max(axis=1), around[1].min(axis=1)
    target = np.minimum(np.maximum(nominal, floor), cap)[::_SAMPLES_PER_KNOT]
    target = np.convolve(np.pad(target, 2, mode="edge"), _SMOOTHING, mode="valid")
    first = controls_of_motion(state.com[2:], np.array([state.velocity]), np.array([state.acceleration]), spacing)
    # Knots -1, 0 and 1 are the present motion; the distance of knot 1 from its target fades over those behind.
    offset = first[2, 0] - target[1]
    fading = offset * (_KEPT_BELOW if offset < 0.0 else _KEPT_ABOVE) ** np.arange(1, count)
    rest = np.append(target[2:] + fading, target[-1:])
    return UniformSpline(0.0, spacing, np.append(first[:, 0], rest)[: count + 3, None])


def nominal_height(phases: Sequence[PlannedPhase], height: float, parameters: WalkingParameters, times: Array) -> Array:
    """CoM height without regard to reach: smooth from the present height to each phase's end, (M,) [m]."""
    heights = np.empty(len(times))
    start = 0.0
    for phase in phases:
        end_height = phase.ground_end + parameters.com_height
        share = minimum_jerk((times - start) / max(phase.remaining, 1e-6))
        chosen = times >= start
        heights[chosen] = (height + (end_height - height) * share)[chosen]
        start, height = start + phase.remaining, end_height
    return heights


def reach_band(
    phases: Sequence[PlannedPhase],
    dcm_plan: DcmPlan,
    state: ComState,
    model: RobotModel,
    parameters: WalkingParameters,
    times: Array,
) -> Array:
    """Least and greatest CoM height at which both legs fit, (2, M) [m]; times (M,) increase from 0 on [s]."""
    com = dcm_plan.com(times, state.com[:2])
    band = np.empty((2, len(times)))
    start, yaw = 0.0, state.yaw
    for index, phase in enumerate(phases):
        end = start + phase.remaining if index + 1 < len(phases) else np.inf
        chosen = (times >= start) & (times < end)
        if np.any(chosen):
            local = times[chosen] - start
            turned = wrap_angle(phase.yaw_end - yaw) * np.clip(local / max(phase.remaining, 1e-6), 0.0, 1.0)
            ankles = {side: phase.points(side, model.legs[side].p_sole_ankle, phase.elapsed + local) for side in Side}
            band[:, chosen] = _legs_band(ankles, com[chosen], yaw + turned, state, model, parameters)
        start, yaw = end, phase.yaw_end
    return band


def body_offset(com: Array, ankles: Mapping[Side, Array], p_pelvis: Array, yaw: float, model: RobotModel) -> Array:
    """Place of the mass other than `mass_at_ankle` from the pelvis, along the axes of the heading, (3,) [m]."""
    share = sum(model.legs[side].mass_at_ankle for side in Side)
    pulled = sum((model.legs[side].mass_at_ankle * ankles[side] for side in Side), np.zeros(3))
    return rotation_z(-yaw) @ ((model.mass * com - pulled) / (model.mass - share) - p_pelvis)


def _legs_band(
    ankles: Mapping[Side, Array],
    com: Array,
    yaw: Array,
    state: ComState,
    model: RobotModel,
    parameters: WalkingParameters,
) -> Array:
    """Least and greatest CoM height for both legs, (2, M), from ankles (M, 3), CoM (M, 2) and heading (M,)."""
    share = sum(model.legs[side].mass_at_ankle for side in Side)
    pulled = sum((model.legs[side].mass_at_ankle * ankles[side] for side in Side), np.zeros((len(com), 3)))
    body = (model.mass * com - pulled[:, :2]) / (model.mass - share)
    c, s = np.cos(yaw), np.sin(yaw)
    spans = np.empty((2, 2, len(com)))
    for index, side in enumerate(Side):
        leg = model.legs[side]
        offset = leg.p_pelvis_hip - state.p_pelvis_body
        dx = body[:, 0] + c * offset[0] - s * offset[1] - ankles[side][:, 0]
        dy = body[:, 1] + s * offset[0] + c * offset[1] - ankles[side][:, 1]
        lengths = np.array([[leg.length(parameters.most_bent_knee)], [leg.length(parameters.straightest_knee)]])
        upright = np.sqrt(np.maximum(0.0, lengths**2 - dx * dx - dy * dy))
        spans[index] = ankles[side][:, 2] + upright - leg.p_pelvis_hip[2]
    pelvis = np.stack((spans[:, 0].max(axis=0), spans[:, 1].min(axis=0)))
    return ((pelvis + state.p_pelvis_body[2]) * (model.mass - share) + pulled[:, 2]) / model.mass
