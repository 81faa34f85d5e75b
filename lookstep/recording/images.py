"""Sensor images made small enough that a minute of walking stays a small file."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import cv2
import numpy as np
import rerun as rr
from numpy.typing import NDArray

from skills.geometry import DepthImage

_WIDTH = 512
_JPEG_QUALITY = 85
_MILLIMETRES_PER_METRE = 1000.0


def encoded_depth(image: DepthImage) -> rr.EncodedDepthImage:
    """A depth image as a PNG of millimetres, thinned by taking every nth pixel: depths must not be averaged."""
    stride = max(1, image.camera.width // _WIDTH)
    millimetres = np.round(image.depth[::stride, ::stride] * _MILLIMETRES_PER_METRE)
    millimetres = np.minimum(millimetres, np.iinfo(np.uint16).max).astype(np.uint16)
    return rr.EncodedDepthImage(
        _encode(".png", millimetres), media_type="image/png", meter=_MILLIMETRES_PER_METRE, colormap="turbo"
    )


def encoded_picture(picture: NDArray[np.uint8]) -> rr.EncodedImage:
    """An RGB picture, (h, w, 3), as a JPEG."""
    bgr = cv2.cvtColor(picture, cv2.COLOR_RGB2BGR)
    return rr.EncodedImage(
        contents=_encode(".jpg", bgr, [cv2.IMWRITE_JPEG_QUALITY, _JPEG_QUALITY]), media_type="image/jpeg"
    )


def encoded_drawing(picture: NDArray[np.uint8]) -> rr.EncodedImage:
    """An RGB picture of few colours, (h, w, 3), as a PNG."""
    return rr.EncodedImage(contents=_encode(".png", cv2.cvtColor(picture, cv2.COLOR_RGB2BGR)), media_type="image/png")


def pinhole_of(image: DepthImage) -> tuple[rr.Pinhole, rr.Transform3D]:
    """The camera of an image, and where it was."""
    camera, T_world_camera = image.camera, image.T_world_camera
    pinhole = rr.Pinhole(
        focal_length=(camera.fx, camera.fy),
        principal_point=(camera.cx, camera.cy),
        resolution=(camera.width, camera.height),
        image_plane_distance=0.25,
    )
    return pinhole, rr.Transform3D(translation=T_world_camera.p, mat3x3=T_world_camera.R)


def _encode(suffix: str, pixels: NDArray[Any], options: Sequence[int] = ()) -> bytes:
    ok, data = cv2.imencode(suffix, pixels, list(options))
    if not ok:
        raise ValueError(f"an image of shape {pixels.shape} cannot be encoded as {suffix}")
    return data.tobytes()
