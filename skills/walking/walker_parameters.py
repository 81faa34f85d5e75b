"""All settings of a walker in one."""

from __future__ import annotations

from dataclasses import dataclass, field

from skills.walking.step_adjustment import StepAdjustmentParameters
from skills.walking.swing_parameters import SwingParameters
from skills.walking.walking_parameters import WalkingParameters
from skills.walking.whole_body_parameters import WholeBodyParameters


@dataclass(frozen=True, slots=True, kw_only=True)
class WalkerParameters:
    """All settings of a walker.

    Attributes:
        walking: phases, balance and posture.
        swing: the way of a foot through the air.
        whole_body: weights, gains and limits of the whole body.
        step_adjustment: how far steps may be changed to save the balance.
    """

    walking: WalkingParameters = field(default_factory=WalkingParameters)
    swing: SwingParameters = field(default_factory=SwingParameters)
    whole_body: WholeBodyParameters = field(default_factory=WholeBodyParameters)
    step_adjustment: StepAdjustmentParameters = field(default_factory=StepAdjustmentParameters)
