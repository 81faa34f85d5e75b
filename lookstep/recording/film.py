"""A film of the walk from a camera that follows the robot, drawn by our own rasterizer on the recording's clock."""

from __future__ import annotations

import rerun as rr

from lookstep.moment import Moment
from lookstep.recording.images import encoded_picture
from sim_envs.picture import LightParameters, PictureStyle, beside_robot, picture_camera, picture_of

_CAMERA = picture_camera(480, 270)
# Hard shadows of few lights: a picture of a film must be cheap, and is seen for a moment.
_LIGHT = LightParameters(sun_lights=4, sky_lights=8, map_size=512)
_STYLE = PictureStyle(samples=1)


class Film:
    """Logs pictures to a recording.

    Args:
        stream: the recording, whose time the caller sets.
        rate: pictures a second of robot time.
    """

    def __init__(self, stream: rr.RecordingStream, rate: float) -> None:
        self._stream, self._period = stream, 1.0 / rate
        self._next = 0.0

    def log(self, moment: Moment) -> None:
        """Draw the moment if a picture is due."""
        if moment.time < self._next:
            return
        self._next = moment.time + self._period
        positions, rotations = moment.world.geom_poses()
        view = beside_robot(moment.state.T_world_pelvis)
        picture = picture_of(moment.world.model, positions, rotations, _CAMERA, view, style=_STYLE, light=_LIGHT)
        self._stream.log("film", encoded_picture(picture))
