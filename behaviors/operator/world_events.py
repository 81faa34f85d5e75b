"""What an operator does to a simulated world; whoever runs the world does it, a tree takes no notice."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from behaviors.operator.event import OperatorEvent, named
from skills.geometry import Pose

_UNIT = 1e-3  # how far a quaternion's norm may be from 1


@named(
    "box", "a box of the course, its position in m and quaternion wxyz, such as [block_3, [1, 0, 0.2], [1, 0, 0, 0]]"
)
@dataclass(frozen=True, slots=True)
class MoveBox(OperatorEvent):
    """Put a box of the course elsewhere, also while the robot walks.

    Attributes:
        box: its name.
        position: of its centre in the world, x, y, z [m].
        quaternion_wxyz: of its frame in the world, of length 1.
    """

    box: str
    position: tuple[float, float, float]
    quaternion_wxyz: tuple[float, float, float, float]

    def __post_init__(self) -> None:
        given = (self.box, self.position, self.quaternion_wxyz)
        are_numbers = _are_numbers(self.position, 3) and _are_numbers(self.quaternion_wxyz, 4)
        self.require(isinstance(self.box, str) and are_numbers, given)
        self.require(abs(math.hypot(*self.quaternion_wxyz) - 1.0) < _UNIT, given)

    @property
    def T_world_box(self) -> Pose:
        """Where it goes."""
        wxyz = np.array(self.quaternion_wxyz)
        return Pose.from_quaternion_wxyz(wxyz / np.linalg.norm(wxyz), self.position)

    @property
    def value(self) -> Any:
        """Name, position and quaternion."""
        return [self.box, list(self.position), list(self.quaternion_wxyz)]

    @classmethod
    def of(cls, value: Any) -> Self:
        """From a list of a name, three numbers and four."""
        cls.require(isinstance(value, list | tuple) and len(value) == 3, value)
        box, position, wxyz = value
        cls.require(_are_numbers(position, 3) and _are_numbers(wxyz, 4), value)
        x, y, z = map(float, position)
        qw, qx, qy, qz = map(float, wxyz)
        return cls(box, (x, y, z), (qw, qx, qy, qz))


def _are_numbers(values: Any, count: int) -> bool:
    return (
        isinstance(values, list | tuple)
        and len(values) == count
        and all(isinstance(v, int | float) and not isinstance(v, bool) and math.isfinite(v) for v in values)
    )
