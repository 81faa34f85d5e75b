"""Look at the ground: depth image -> regions -> map of the ground around the robot."""

from __future__ import annotations

from py_trees.common import Status

from behaviors.leaf import Call, Leaf, SkillLeaf, SkillParameters
from behaviors.ports import Input, Output
from behaviors.registry import leaf
from skills.parameters import parameter, parameters
from skills.regions import PlanarRegions, RegionExtraction, RegionMemory, examine_regions


@parameters
class ExtractRegionsParameters(SkillParameters):
    """When to look."""

    latency: float = parameter(
        0.1, unit="s", meaning="robot time until the regions of an image are delivered", minimum=0.0, maximum=60.0
    )


@leaf
class ExtractRegions(SkillLeaf):
    """Finds the planar regions of the newest depth image."""

    Parameters = ExtractRegionsParameters
    extraction = Output(RegionExtraction, "regions of one depth image, and what was rejected and why")

    def setup(self) -> None:
        """No image has been used yet."""
        self._last_frame_id = -1

    def request(self) -> Call | Status:
        """Take the newest image, each only once."""
        image = self.context.robot.depth_image()
        if image is None:
            return self.running("waits for the first depth image")
        if image.frame_id == self._last_frame_id:
            return self.running("waits for the next depth image")
        self._last_frame_id = image.frame_id
        return self.call(examine_regions, image, self.context.parameters["regions"])

    def receive(self, result: RegionExtraction) -> Status:
        """Hand the regions on."""
        self.extraction = result
        return self.succeeded()


@leaf
class RememberGround(Leaf):
    """Joins the regions of recent images into one map, with support under feet that the camera cannot see."""

    extraction = Input(RegionExtraction, "regions of one depth image")
    ground = Output(PlanarRegions, "planar regions around the robot")

    def setup(self) -> None:
        """Nothing is remembered yet."""
        self._memory = RegionMemory(self.context.parameters["region_memory"])

    def tick(self) -> Status:
        """Add the newest regions to the map."""
        stance = self.context.robot.status().imminent_stance
        self.ground = self._memory.update(self.extraction.regions, stance, self.extraction.image)
        return self.succeeded()
