"""Depths out of files, and cameras out of text: what any depth sensor writes, and through which lens."""

from __future__ import annotations

import math
import os
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lookstep.errors import UserError
from skills.geometry import PinholeCamera

FORMATS = "PNG or TIFF of 16 bits, TIFF or EXR of floats, .npy"
# Any sensor is welcome; `regions.depth_max` is what limits the range.
_NEAR, _FAR = 0.01, 100.0


def read_values(path: Path) -> NDArray[Any]:
    """The numbers in an image or array file, (height, width), whatever they mean.

    Raises:
        UserError: where the file does not hold one number a pixel.
    """
    if not path.exists():
        raise UserError(f"{path}: no such file")
    if path.is_dir():
        raise UserError(f"{path}: is a folder, needs one image ({FORMATS})")
    values = _read_array(path) if path.suffix == ".npy" else _read_picture(path)
    held = f"{path}: holds {values.dtype} of shape {' x '.join(map(str, values.shape))}"
    if values.ndim == 3 or values.dtype.itemsize == 1:
        raise UserError(f"{held}, which is a picture; needs one depth a pixel ({FORMATS})")
    if values.ndim != 2 or 0 in values.shape or values.dtype.kind not in "uif":
        raise UserError(f"{held}; needs rows and columns of one depth each ({FORMATS})")
    return values


def parse_camera(text: str, width: int, height: int) -> PinholeCamera:
    """A pinhole camera from `fx,fy,cx,cy` [px], for an image of a size.

    Raises:
        UserError: where the text is not that, or the camera does not fit the image.
    """
    try:
        fx, fy, cx, cy = (float(part) for part in text.split(","))
    except ValueError:
        raise UserError(f'--camera: got "{text}", needs fx,fy,cx,cy in pixels, such as 525,525,319.5,239.5') from None
    for name, focal in (("fx", fx), ("fy", fy)):
        if not (math.isfinite(focal) and focal > 0.0):
            raise UserError(f"--camera: got {name} = {focal:g}, needs a positive number of pixels")
    for name, center, size in (("cx", cx, width), ("cy", cy, height)):
        if not 0.0 <= center <= size:
            raise UserError(
                f"--camera: got {name} = {center:g}, outside the image of {width} x {height} pixels; "
                "is the camera given for another resolution?"
            )
    return PinholeCamera(width, height, fx, fy, cx, cy, near=_NEAR, far=_FAR)


def _read_array(path: Path) -> NDArray[Any]:
    try:
        loaded = np.load(path, allow_pickle=False)
    except (ValueError, OSError, EOFError) as error:
        raise UserError(f"{path}: is no array file: {error}") from error
    return loaded


def _read_picture(path: Path) -> NDArray[Any]:
    # OpenCV reads EXR only where it is told to.
    os.environ.setdefault("OPENCV_IO_ENABLE_OPENEXR", "1")
    import cv2

    try:
        values = cv2.imread(str(path), cv2.IMREAD_UNCHANGED)
    except cv2.error:
        values = None
    if values is None:
        raise UserError(f"{path}: is not an image that can be read ({FORMATS})")
    return values
