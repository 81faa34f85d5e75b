"""An operator's hand, where a course says how it moves: a carrot on a way, and how well the robot has followed it."""

from __future__ import annotations

import numpy as np

from behaviors import Tree
from behaviors.operator import MoveCarrot
from lookstep.moment import Moment
from sim_envs.courses import CarrotWay
from skills.body_path import Goal

_PERIOD = 0.1  # [s]


class CarrotLeader:
    """Sends the tree where the carrot is, ten times a second of robot time, until it rests at the end of its way."""

    def __init__(self, way: CarrotWay, tree: Tree) -> None:
        self._way, self._tree = way, tree
        self._sent = 0
        self._last = int(np.ceil(way.length / way.speed / _PERIOD))

    def poll(self) -> None:
        """Move on if it is time; for between two ticks."""
        if self._sent > self._last or self._tree.next_tick_time < self._sent * _PERIOD:
            return
        self._tree.send(MoveCarrot(Goal(*self._way.at(self._sent * _PERIOD))))
        self._sent += 1


class LateralError:
    """How far the true mid-feet were from the carrot's way while the robot walked."""

    def __init__(self, way: CarrotWay | None) -> None:
        self._way = way
        self._distances: list[float] = []

    def observe(self, moment: Moment) -> None:
        """Take note of one tick; all before the first step is left out."""
        if self._way is not None and moment.status.last_side is not None:
            self._distances.append(self._way.distance(moment.state.stance.mid_feet))

    @property
    def mean(self) -> float | None:
        """The mean over time [m]; None where nobody led or the robot has not moved."""
        return round(float(np.mean(self._distances)), 4) if self._distances else None
