"""Look around: lidar scan -> height map between robot and goal."""

from __future__ import annotations

from py_trees.common import Status

from behaviors.leaf import Call, SkillLeaf, SkillParameters
from behaviors.ports import OptionalInput, Output
from behaviors.registry import leaf
from skills.body_path import Goal
from skills.height_map import HeightMap, HeightMapper
from skills.parameters import parameter, parameters


@parameters
class UpdateHeightMapParameters(SkillParameters):
    """When to look around."""

    latency: float = parameter(
        0.02, unit="s", meaning="robot time until the map with a scan is delivered", minimum=0.0, maximum=60.0
    )


@leaf
class UpdateHeightMap(SkillLeaf):
    """Adds the newest lidar scan to the height map, which lies around the robot and on the way to its goal."""

    Parameters = UpdateHeightMapParameters
    goal = OptionalInput(Goal, "where the robot is sent; without it the map lies around the robot")
    height_map = Output(HeightMap, "heights of the ground, cell by cell")

    def setup(self) -> None:
        """Nothing has been seen yet."""
        self._mapper = HeightMapper(self.context.parameters["height_map"])
        self._last_scan_id = -1

    def request(self) -> Call | Status:
        """Take the newest scan, each only once."""
        scan = self.context.robot.lidar_scan()
        if scan is None:
            return self.running("waits for the first lidar scan")
        if scan.scan_id == self._last_scan_id:
            return self.running("waits for the next lidar scan")
        self._last_scan_id = scan.scan_id
        feet = self.context.robot.status().imminent_stance.mid_feet
        goal = None if self.goal is None else self.goal.xyyaw_world[:2]
        return self.call(self._mapper.update, scan, feet, goal)

    def receive(self, result: HeightMap) -> Status:
        """Hand the map on."""
        self.height_map = result
        return self.succeeded()

    def stop(self) -> None:
        """Begin a new map: nobody knows how far the update has come that is dropped."""
        super().stop()
        self._mapper = HeightMapper(self.context.parameters["height_map"])
