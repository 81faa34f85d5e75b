"""When a robot that is moved without physics must be called fallen: what would have thrown a real one.

The rule for the capture point follows Pratt et al., "Capture Point: A Step toward Humanoid Push Recovery" (2006): a
DCM well outside all ground that the feet have or are about to have cannot be caught. The others are about the ground:
a swing foot that digs in would trip, a stance foot on too little ground would tip.
"""

from __future__ import annotations

import numpy as np

from sim_envs.robot import RobotDescription
from sim_envs.worlds.true_ground import TrueGround
from skills.footsteps.footstep import Side
from skills.geometry.pose import Array, Pose
from skills.parameters import parameter, parameters
from skills.walking.kinematic_walker import WalkerOutput
from skills.walking.walking_state import WalkingPhase, WalkingStatus

_SAMPLES_ALONG, _SAMPLES_ACROSS = 14, 8  # about every 2 cm of the sole
_ANGLES = np.linspace(-np.pi, np.pi, 64, endpoint=False)
_DIRECTIONS = np.column_stack((np.cos(_ANGLES), np.sin(_ANGLES)))  # distances are short by 0.12 % at most


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
    standing_check_period: float = parameter(
        0.5, unit="s", minimum=0.01, maximum=10.0, meaning="time between looks at the ground under a standing robot"
    )


class FallDetector:
    """Watches a walk against the true ground."""

    def __init__(self, parameters: FallParameters, description: RobotDescription, ground: TrueGround) -> None:
        self._parameters = parameters
        self._ground = ground
        self._corners_sole = np.column_stack((description.sole_corners_sole, np.zeros(4)))
        self._samples_sole = _sole_samples(description)
        self._looked_at_support: tuple[WalkingPhase, int] | None = None

    def check(self, output: WalkerOutput, status: WalkingStatus) -> str:
        """Why the robot has fallen, in one sentence; empty while it has not.

        Args:
            output: what the robot does now, in the true world.
            status: what the walking controller does, its steps in the true world.
        """
        swing = status.current_step.side if status.phase is WalkingPhase.SWING and status.current_step else None
        return (
            self._check_dcm(output, status, swing)
            or (swing is not None and self._check_swing(swing, output.stance.sole(swing)))
            or self._check_support(output, status, swing)
        )

    def _check_dcm(self, output: WalkerOutput, status: WalkingStatus, swing: Side | None) -> str:
        soles = [output.stance.sole(side) for side in Side if side is not swing]
        soles += [status.imminent_stance.sole(side) for side in Side]
        corners = np.concatenate([T_world_sole @ self._corners_sole for T_world_sole in soles])
        # The hull is as far as the direction in which its nearest corner is farthest.
        offsets = (corners - output.dcm_world)[:, :2]
        outside = float(np.max(np.min(_DIRECTIONS @ offsets.T, axis=1)))
        if outside <= self._parameters.dcm_margin:
            return ""
        return f"the DCM is {100 * outside:.0f} cm outside the support polygon"

    def _check_swing(self, side: Side, T_world_sole: Pose) -> str:
        samples = T_world_sole @ self._samples_sole
        depths = self._ground.heights(samples) - samples[:, 2]
        deepest = int(np.argmax(depths))
        if depths[deepest] <= self._parameters.swing_penetration:
            return ""
        x, y = samples[deepest, :2]
        return f"the {side.value} sole swung {100 * depths[deepest]:.0f} cm into the ground at ({x:.2f}, {y:.2f})"

    def _check_support(self, output: WalkerOutput, status: WalkingStatus, swing: Side | None) -> str:
        """Look once in the middle of each swing, and now and then while standing."""
        if swing is not None and status.current_step is not None:
            due = status.phase_elapsed >= 0.5 * status.phase_duration
            look = (status.phase, status.current_step.sequence_id)
        else:
            due = status.phase is WalkingPhase.STANDING
            look = (status.phase, int(output.time / self._parameters.standing_check_period))
        if not due or look == self._looked_at_support:
            return ""
        self._looked_at_support = look
        for side in Side:
            share = 1.0 if side is swing else self._supported_share(output.stance.sole(side))
            if share < self._parameters.support_share:
                return f"only {100 * share:.0f} % of the {side.value} sole stood on ground"
        return ""

    def _supported_share(self, T_world_sole: Pose) -> float:
        samples = T_world_sole @ self._samples_sole
        gaps = np.abs(self._ground.heights(samples) - samples[:, 2])
        return float(np.mean(gaps <= self._parameters.support_tolerance))


def _sole_samples(description: RobotDescription) -> Array:
    """Points all over the sole, its edge included, (N, 3)."""
    x = np.linspace(-0.5, 0.5, _SAMPLES_ALONG) * description.sole_length
    y = np.linspace(-0.5, 0.5, _SAMPLES_ACROSS) * description.sole_width
    return np.stack(np.meshgrid(x, y, (0.0,), indexing="ij"), axis=-1).reshape(-1, 3)
