"""When a robot that is moved without physics must be called fallen: what would have thrown a real one.

The rule for the capture point follows Pratt et al., "Capture Point: A Step toward Humanoid Push Recovery" (2006): a
DCM well outside all ground that the feet have or are about to have cannot be caught. The others are about the ground:
a swing foot that digs in would trip, a stance foot on too little ground would tip.
"""

from __future__ import annotations

import numpy as np

from sim_envs.courses import Ground
from sim_envs.robot import RobotDescription
from skills.footsteps.footstep import Side
from skills.geometry.pose import Array, Pose
from skills.parameters import parameter, parameters
from skills.walking.support_polygon import SupportPolygon
from skills.walking.walking_state import RobotState, WalkingPhase, WalkingStatus

_ROUNDING = 1e-9
_SAMPLES_ALONG, _SAMPLES_ACROSS = 9, 5  # about every 3 cm of the sole


@parameters
class FallParameters:
    """How much a walk may be off before it counts as a fall."""

    dcm_margin: float = parameter(
        0.05, unit="m", minimum=0.0, maximum=1.0, meaning="how far the DCM may leave the feet's support polygon"
    )
    swing_penetration: float = parameter(
        0.02, unit="m", minimum=0.0, maximum=0.5, meaning="how deep a swinging sole may be inside the ground"
    )
    support_share: float = parameter(
        0.25, unit="1", minimum=0.0, maximum=1.0, meaning="share of a stance sole that must have ground under it"
    )
    support_tolerance: float = parameter(
        0.02, unit="m", minimum=0.0, maximum=0.5, meaning="how far from the sole ground still supports it"
    )
    check_period: float = parameter(
        0.01, unit="s", minimum=0.001, maximum=0.1, meaning="time between looks at DCM and swing"
    )
    standing_check_period: float = parameter(
        0.5, unit="s", minimum=0.01, maximum=10.0, meaning="time between looks at the ground under a standing robot"
    )


class FallDetector:
    """Watches a walk against the true ground.

    Args:
        parameters: what counts as a fall.
        description: of the robot.
    """

    def __init__(self, parameters: FallParameters, description: RobotDescription) -> None:
        self._parameters = parameters
        self._corners_sole = np.column_stack((description.sole_corners_sole, np.zeros(4)))
        self._samples_sole = _sole_samples(description)
        self._next_check = 0.0
        self._looked_at_support: tuple[WalkingPhase, int] | None = None
        self._soles: tuple[Pose, ...] = ()
        self._polygon: SupportPolygon | None = None

    def due(self, time: float) -> bool:
        """Whether it is time for another look, at a robot time [s]."""
        if time < self._next_check - _ROUNDING:
            return False
        self._next_check = time + self._parameters.check_period
        return True

    def check(self, state: RobotState, status: WalkingStatus, ground: Ground) -> str:
        """Why the robot has fallen, in one sentence; empty while it has not.

        Args:
            state: of the robot, in the true world.
            status: what the walking controller does, its steps in the true world.
            ground: the true ground as it is now.
        """
        swing = status.current_step.side if status.phase is WalkingPhase.SWING and status.current_step else None
        return (
            self._check_dcm(state, status, swing)
            or self._check_swing(state, swing, ground)
            or self._check_support(state, status, swing, ground)
        )

    def _check_dcm(self, state: RobotState, status: WalkingStatus, swing: Side | None) -> str:
        soles = tuple(state.stance.sole(side) for side in Side if side is not swing)
        soles += tuple(status.imminent_stance.sole(side) for side in Side)
        outside = self._support_polygon(soles).distance(state.dcm_world)
        if outside <= self._parameters.dcm_margin:
            return ""
        return f"the DCM is {100 * outside:.0f} cm outside the support polygon"

    def _support_polygon(self, soles: tuple[Pose, ...]) -> SupportPolygon:
        """The hull of the soles, made anew only when one has moved: feet rest longer than a control step."""
        same = len(soles) == len(self._soles) and all(a is b for a, b in zip(soles, self._soles, strict=True))
        if self._polygon is None or not same:
            corners = [(T_world_sole @ self._corners_sole)[:, :2] for T_world_sole in soles]
            self._soles, self._polygon = soles, SupportPolygon(corners)
        return self._polygon

    def _check_swing(self, state: RobotState, swing: Side | None, ground: Ground) -> str:
        if swing is None:
            return ""
        limit = self._parameters.swing_penetration
        samples = state.stance.sole(swing) @ self._samples_sole
        # No point is deeper inside a box than it is below the ground; few are below, and only those cost time.
        below = samples[ground.ground_height(samples[:, :2]) - samples[:, 2] > limit]
        depths = ground.penetration(below)
        if np.all(depths <= limit):
            return ""
        deepest = int(np.argmax(depths))
        x, y = below[deepest, :2]
        return f"the {swing.value} sole swung {100 * depths[deepest]:.0f} cm into the ground at ({x:.2f}, {y:.2f})"

    def _check_support(self, state: RobotState, status: WalkingStatus, swing: Side | None, ground: Ground) -> str:
        """Look once in the middle of each swing, and now and then while standing."""
        if swing is not None and status.current_step is not None:
            due = status.phase_elapsed >= 0.5 * status.phase_duration
            look = (status.phase, status.current_step.sequence_id)
        else:
            due = status.phase is WalkingPhase.STANDING
            look = (status.phase, int(state.time / self._parameters.standing_check_period))
        if not due or look == self._looked_at_support:
            return ""
        self._looked_at_support = look
        for side in Side:
            share = 1.0 if side is swing else self._supported_share(state.stance.sole(side), ground)
            if share < self._parameters.support_share:
                return f"only {100 * share:.0f} % of the {side.value} sole stood on ground"
        return ""

    def _supported_share(self, T_world_sole: Pose, ground: Ground) -> float:
        samples = T_world_sole @ self._samples_sole
        gaps = np.abs(ground.ground_height(samples[:, :2]) - samples[:, 2])
        return float(np.mean(gaps <= self._parameters.support_tolerance))


def _sole_samples(description: RobotDescription) -> Array:
    """Points all over the sole, its edge included, (N, 3)."""
    x = np.linspace(-0.5, 0.5, _SAMPLES_ALONG) * description.sole_length
    y = np.linspace(-0.5, 0.5, _SAMPLES_ACROSS) * description.sole_width
    return np.stack(np.meshgrid(x, y, (0.0,), indexing="ij"), axis=-1).reshape(-1, 3)
