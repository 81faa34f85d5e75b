"""Look at the ground: depth image -> regions -> map of the ground around the robot."""

from __future__ import annotations

from py_trees.common import Status

from behaviors.leaf import Call, SkillLeaf, SkillParameters
from behaviors.ports import Input, Output
from behaviors.registry import leaf
from skills.parameters import parameter, parameters
from skills.regions import (
    GroundUpdate,
    MapParameters,
    PlanarRegions,
    RegionExtraction,
    RegionMemory,
    examine_regions,
    remember,
)


@parameters
class ExtractRegionsParameters(SkillParameters):
    """When to look."""

    latency: float = parameter(
        0.1, unit="s", meaning="robot time until the regions of an image are delivered", minimum=0.0, maximum=60.0
    )


@leaf
class ExtractRegions(SkillLeaf):
    """Finds the planar regions of the newest depth image of the camera whose turn it is.

    It is the turn of the camera that has taken most images since it was last looked through, so that a robot is free to
    say which way it looks more often; of equals, of the one that has waited longest.
    """

    Parameters = ExtractRegionsParameters
    extraction = Output(RegionExtraction, "regions of one depth image, and what was rejected and why")

    def setup(self) -> None:
        """No image has been used yet."""
        self._used: dict[str, tuple[int, float]] = {}

    def request(self) -> Call | Status:
        """Take the newest image of the next camera, each only once."""
        frames = self.context.robot.depth_frames()
        if not frames:
            return self.running("waits for the first depth image")
        camera = max(frames, key=lambda name: self._turn(name, frames[name]))
        image = self.context.robot.depth_image(camera)
        if image is None or image.frame_id == self._used.get(camera, (-1, 0.0))[0]:
            return self.running("waits for the next depth image")
        self._used[camera] = image.frame_id, self.context.time
        return self.call(examine_regions, image, self.context.parameters["regions"])

    def _turn(self, camera: str, frame_id: int) -> tuple[bool, int, float]:
        """The greatest of these is the camera's whose turn it is."""
        if camera not in self._used:
            return True, 0, 0.0
        used, time = self._used[camera]
        return False, frame_id - used, -time

    def receive(self, result: RegionExtraction) -> Status:
        """Hand the regions on."""
        self.extraction = result
        return self.succeeded()


@parameters
class RememberGroundParameters(SkillParameters):
    """How long joining a frame may take."""

    latency: float = parameter(
        0.02, unit="s", meaning="robot time until the map is delivered", minimum=0.0, maximum=60.0
    )


@leaf
class RememberGround(SkillLeaf):
    """Joins the regions of recent images into one map, and takes the drift of the robot's estimate out."""

    Parameters = RememberGroundParameters
    extraction = Input(RegionExtraction, "regions of one depth image")
    ground = Output(PlanarRegions, "planar regions around the robot")
    update = Output(GroundUpdate, "what the newest image changed in the map, and how far the estimate had drifted")

    def setup(self) -> None:
        """Nothing is remembered yet."""
        self._memory = RegionMemory()

    def request(self) -> Call | Status:
        """Join the newest regions to the map."""
        subjects = self.context.parameters
        parameters = MapParameters.of(subjects["region_memory"], subjects["registration"], subjects["footsteps"])
        stance = self.context.robot.status().imminent_stance
        extraction = self.extraction
        return self.call(remember, self._memory, extraction.regions, stance, extraction.image, parameters)

    def receive(self, result: RegionMemory) -> Status:
        """Hand the map on; from now on the robot is where the map says it is."""
        self._memory = result
        self.ground, self.update = result.ground, result.update
        assert result.update is not None, "a frame has just been joined"
        self.context.robot.correct(result.update.T_world_odometry)
        return self.succeeded(result.update.summary)
