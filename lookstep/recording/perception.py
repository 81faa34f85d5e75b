"""What the robot sees, as it sees it: images, what became of their pixels, what the map forgot, the heights around."""

from __future__ import annotations

from collections import Counter

import cv2
import numpy as np
import rerun as rr

from lookstep import palette, shapes
from lookstep.lidar_points import scan_points
from lookstep.perception_pictures import colored, height_picture
from lookstep.recording.columns import Columns
from lookstep.recording.images import encoded_depth, encoded_drawing, encoded_picture, pinhole_of
from skills.geometry import LidarScan
from skills.height_map import HeightMap
from skills.regions import GroundUpdate, RegionExtraction, debug_image

_PICTURE_WIDTH = 640
_METRE = 1.0  # noise is told at this depth [m]
_UPDATE_PERIOD = 1.0
_SHOWN_REASONS = ("seen differently", "seen through")  # the others are everyday


class PerceptionViews:
    """Logs what perception found to a recording.

    Args:
        stream: the recording, whose time the caller sets.
        columns: takes what comes often.
    """

    def __init__(self, stream: rr.RecordingStream, columns: Columns) -> None:
        self._stream = stream
        self._columns = columns
        self._forgotten: Counter[str] = Counter()
        self._next_update = 0.0

    def log_extraction(self, extraction: RegionExtraction) -> None:
        """The depth image, what became of its pixels, and why pieces of it were rejected."""
        log = self._stream.log
        camera = f"camera/{extraction.image.camera_name}"
        log(f"{camera}/depth", encoded_depth(extraction.image))
        stride = 2 if extraction.image.camera.width > _PICTURE_WIDTH else 1
        colors = shapes.colors_by_place(extraction.regions)
        log(f"{camera}/regions", encoded_picture(debug_image(extraction, stride, colors)))
        log(f"{camera}/rejected", rr.TextDocument(rejections(extraction), media_type="text/markdown"))
        log(f"world/{camera}", *pinhole_of(extraction.image))
        time, noise = extraction.image.time, extraction.noise
        self._columns.scalar("noise/own", time, 1e3 * noise.own(_METRE))
        self._columns.scalar("noise/shared", time, 1e3 * noise.shared(_METRE))

    def log_update(self, update: GroundUpdate, time: float) -> None:
        """What the map has forgotten so far, and by how much each image has corrected the robot's estimate."""
        self._forgotten.update(dict(update.reasons))
        if not update.drift.reason:
            self._columns.scalar("drift/shift", time, 1e3 * float(np.linalg.norm(update.drift.shift_turn[:3])))
        shown = [forgotten for forgotten in update.forgotten if forgotten.reason in _SHOWN_REASONS]
        if shown:
            self._stream.log(
                "world/forgotten",
                rr.LineStrips3D(
                    [shapes.closed(forgotten.region.hull_world) for forgotten in shown],
                    labels=[forgotten.reason for forgotten in shown],
                    colors=[palette.FORGOTTEN],
                    radii=0.006,
                ),
            )
        if time >= self._next_update:
            self._next_update = time + _UPDATE_PERIOD
            if not shown:
                self._stream.log("world/forgotten", rr.Clear(recursive=False))
            rows = [f"| {reason} | {count} |" for reason, count in self._forgotten.most_common()]
            text = "\n".join((update.summary, "", "| forgotten since the start | regions |", "|---|---|", *rows))
            self._stream.log("map", rr.TextDocument(text, media_type="text/markdown"))

    def log_heights(self, heights: HeightMap, scan: LidarScan | None) -> None:
        """The height map as a picture and as points, and the scan."""
        known = ~np.isnan(heights.heights)
        if not known.any():
            return
        self._stream.log("height_map", encoded_drawing(height_picture(heights)))
        colors = colored(heights.heights)[known]
        cells = rr.Points3D(heights.points_world, colors=colors, radii=0.5 * heights.resolution)
        self._stream.log("world/around/height_map", cells)
        if scan is not None:
            points = scan_points(scan)
            self._stream.log("world/around/scan", rr.Points3D(points, colors=[palette.SCAN], radii=0.008))


def rejections(extraction: RegionExtraction) -> str:
    """What an extraction rejected and why, as Markdown: a row for each cause with its largest piece."""
    count, noise = len(extraction.regions.regions), extraction.noise
    causes = Counter(piece.cause for piece in extraction.rejected)
    lines = [
        f"{count} regions; {len(extraction.rejected)} rejected",
        "",
        f"noise at {_METRE:g} m: {1e3 * noise.own(_METRE):.1f} mm a pixel, "
        f"{1e3 * noise.shared(_METRE):.1f} mm shared by neighbours",
        "",
        "| cause | pieces | the largest |",
        "|---|---|---|",
    ]
    for cause, pieces in causes.most_common():
        alike = [piece for piece in extraction.rejected if piece.cause == cause]
        largest = max(alike, key=lambda piece: cv2.contourArea(piece.outline_image.astype(np.float32)))
        lines.append(f"| {cause} | {pieces} | {largest.reason} |")
    return "\n".join(lines)
