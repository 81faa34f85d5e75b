"""Boxes that move by script: each event of a course carries one box along a straight line to its new pose, once."""

from __future__ import annotations

import numpy as np

from sim_envs.courses import BoxEvent
from skills.geometry.pose import Array, Pose


class BoxMotions:
    """Plays the events of a course by robot time."""

    def __init__(self, events: tuple[BoxEvent, ...]) -> None:
        self._events = events
        self._began: list[float | None] = [None] * len(events)
        self._running: list[tuple[float, Pose, BoxEvent]] = []

    def advance(self, time: float, robot_world: Array, box_poses: dict[str, Pose]) -> dict[str, Pose]:
        """New poses T_world_box of the boxes that move now, by name.

        Args:
            time: robot time [s].
            robot_world: where the robot is, of which x and y count [m].
            box_poses: T_world_box of all boxes now, by name.
        """
        for i, event in enumerate(self._events):
            if self._began[i] is None and self._begins(i, time, robot_world, box_poses):
                self._began[i] = time
                self._running.append((time, box_poses[event.box], event))
        moved = {event.box: _pose_at(time - start, T_start, event) for start, T_start, event in self._running}
        self._running = [motion for motion in self._running if time - motion[0] < motion[2].duration]
        return moved

    def _begins(self, i: int, time: float, robot_world: Array, box_poses: dict[str, Pose]) -> bool:
        event = self._events[i]
        if event.time is not None:
            return time >= event.time
        if event.after is not None:
            before = self._before(i)
            return before is not None and time >= before + event.after
        distance = np.linalg.norm(robot_world[:2] - box_poses[event.box].p[:2])
        return event.distance is not None and bool(distance <= event.distance)

    def _before(self, i: int) -> float | None:
        """When the event before it of the same box began; None where it has not begun."""
        earlier = [j for j in range(i) if self._events[j].box == self._events[i].box]
        return self._began[earlier[-1]] if earlier else None


def _pose_at(elapsed: float, T_start: Pose, event: BoxEvent) -> Pose:
    if elapsed >= event.duration:
        return event.T_world_box
    share = elapsed / event.duration
    first, last = T_start.quaternion_wxyz, event.T_world_box.quaternion_wxyz
    if first @ last < 0.0:
        last = -last  # The shorter way round.
    blended = (1.0 - share) * first + share * last
    return Pose.from_quaternion_wxyz(blended, (1.0 - share) * T_start.p + share * event.T_world_box.p)
