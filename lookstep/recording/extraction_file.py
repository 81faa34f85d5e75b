"""A recording of one extraction: the depth image, its points by region, the polygons in 3D, the debug image."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import rerun as rr
import rerun.blueprint as rrb
from numpy.typing import NDArray

from lookstep.recording import scene
from lookstep.recording.images import encoded_depth, encoded_picture, pinhole_of
from skills.regions import RegionExtraction, piece_of_pixels, region_colors

_POINTS_MAX = 320_000
_POINT_RADIUS = 0.003
_OTHER_POINTS = (96, 98, 104)


def write_extraction(path: Path, extraction: RegionExtraction, picture: NDArray[np.uint8]) -> None:
    """Write one `.rrd` file; `picture` is the debug image, which somebody has drawn already."""
    stream = rr.RecordingStream("lookstep_regions", recording_id=path.stem)
    stream.save(path, default_blueprint=_blueprint())
    colors = region_colors(len(extraction.regions.regions))
    stream.log("world", rr.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
    stream.log("world/camera", *pinhole_of(extraction.image), static=True)
    stream.log("world/points", _points(extraction, colors), static=True)
    stream.log("world/regions/outlines", scene.region_outlines(extraction.regions), static=True)
    stream.log("world/regions/surfaces", scene.region_surfaces(extraction.regions, colors), static=True)
    stream.log("depth", encoded_depth(extraction.image), static=True)
    stream.log("picture", encoded_picture(picture), static=True)
    stream.flush()
    stream.disconnect()


def _points(extraction: RegionExtraction, colors: NDArray[np.uint8]) -> rr.Points3D:
    """Every measured point in the colour of its region, thinned where there are too many."""
    image, camera = extraction.image, extraction.image.camera
    stride = int(np.ceil(np.sqrt(max(1.0, image.depth.size / _POINTS_MAX))))
    pieces = piece_of_pixels(extraction, stride)
    v, u = np.nonzero(image.depth[::stride, ::stride] > 0.0)
    depth = image.depth[v * stride, u * stride].astype(np.float64)
    x = (u * stride - camera.cx) / camera.fx * depth
    y = (v * stride - camera.cy) / camera.fy * depth
    points_world = image.T_world_camera @ np.column_stack((x, y, depth))
    table = np.vstack((colors, np.array([_OTHER_POINTS], dtype=np.uint8)))
    return rr.Points3D(points_world.astype(np.float32), colors=table[np.maximum(pieces[v, u], -1)], radii=_POINT_RADIUS)


def _blueprint() -> rrb.Blueprint:
    scene_view = rrb.Spatial3DView(
        name="Regions",
        origin="/world",
        background=rrb.Background(color=(208, 216, 226, 255)),
        line_grid=rrb.LineGrid3D(visible=False),
        # From behind the camera and a little above, so that the picture and the scene show the same side of things.
        eye_controls=rrb.EyeControls3D(
            kind=rrb.components.Eye3DKind.Orbital, position=(-0.8, 0.0, 0.6), look_target=(1.5, 0.0, -0.2)
        ),
    )
    pictures = rrb.Vertical(
        rrb.Spatial2DView(name="Regions extracted", origin="/picture"),
        rrb.Spatial2DView(name="Depth image", origin="/depth"),
    )
    return rrb.Blueprint(
        rrb.Horizontal(scene_view, pictures, column_shares=[3, 2]),
        rrb.BlueprintPanel(state="collapsed"),
        rrb.SelectionPanel(state="collapsed"),
        rrb.TimePanel(state="collapsed"),
        auto_views=False,
    )
