"""What became of each pixel: the region or rejected piece that it is in, or why it is in none.

Labels say on which plane a pixel is. Flat pieces of one label may lie apart, and each is a region or rejected by
itself; here every pixel gets the piece that it is in.
"""

from __future__ import annotations

from collections import Counter
from enum import IntEnum

import cv2
import numpy as np
from numpy.typing import NDArray

from skills.geometry.camera import DepthImage
from skills.geometry.pose import Array
from skills.regions.extraction import RegionExtraction
from skills.regions.planar_region import PlanarRegion

_BODY_STRIDE = 4  # the own body is looked for at every nth pixel of every nth row


class PixelKind(IntEnum):
    """What became of a pixel."""

    REGION = 0
    REJECTED = 1
    NO_PLANE = 2
    OWN_BODY = 3
    OUT_OF_RANGE = 4
    NO_DEPTH = 5


def piece_of_pixels(extraction: RegionExtraction, stride: int = 1) -> NDArray[np.int16]:
    """The piece of every nth pixel of every nth row.

    Returns:
        k for region k, -2 - k for rejected piece k, -1 for neither: (ceil(height / stride), ceil(width / stride)).
    """
    labels = extraction.labels[::stride, ::stride]
    pieces = [(label, k) for k, label in enumerate(extraction.region_labels)]
    pieces += [(piece.label, -2 - k) for k, piece in enumerate(extraction.rejected)]
    counts = Counter(label for label, _ in pieces)
    # The last entry is that of label -1; specks have a label and are no piece.
    alone = np.full(max([int(labels.max(initial=-1)), *counts]) + 2, -1, dtype=np.int16)
    shared = []
    for label, piece in pieces:
        alone[label] = piece
        if counts[label] > 1:
            outline = np.round(_outline(extraction, piece) / stride).astype(np.int32)
            shared.append((cv2.contourArea(outline), outline, label, piece))
    result = alone[labels]
    # Large ones first: a small one may lie in the hole of a large one.
    for _, outline, label, piece in sorted(shared, key=lambda entry: -entry[0]):
        low, high = np.maximum(outline.min(axis=0), 0), outline.max(axis=0) + 1
        window = np.s_[low[1] : high[1], low[0] : high[0]]
        inside = np.zeros(labels[window].shape, dtype=np.uint8)
        cv2.fillPoly(inside, [outline - low], 1)
        np.copyto(result[window], np.int16(piece), where=(inside > 0) & (labels[window] == label))
    return result


def kind_of_pixels(extraction: RegionExtraction, pieces: NDArray[np.int16], stride: int = 1) -> NDArray[np.uint8]:
    """The kind of every nth pixel of every nth row, as values of `PixelKind`, from what `piece_of_pixels` found."""
    image = extraction.image
    depth = image.depth[::stride, ::stride]
    far = min(image.camera.far, extraction.parameters.depth_max)
    kinds = np.full(depth.shape, PixelKind.OUT_OF_RANGE, dtype=np.uint8)
    kinds[(depth >= image.camera.near) & (depth <= far)] = PixelKind.NO_PLANE
    kinds[~(depth > 0.0)] = PixelKind.NO_DEPTH
    if image.body_world:
        kinds[own_body(image, stride) & (depth > 0.0)] = PixelKind.OWN_BODY
    kinds[pieces >= 0] = PixelKind.REGION
    kinds[pieces < -1] = PixelKind.REJECTED
    return kinds


def own_body(image: DepthImage, stride: int = 1) -> NDArray[np.bool_]:
    """Which of every nth pixel of every nth row are on the robot's own body, told for small blocks of them."""
    camera, coarse = image.camera, stride * _BODY_STRIDE
    depth = image.depth[::coarse, ::coarse].astype(np.float64)
    v, u = np.indices(depth.shape) * coarse
    points = np.stack(((u - camera.cx) / camera.fx * depth, (v - camera.cy) / camera.fy * depth, depth), axis=-1)
    T_camera_world = image.T_world_camera.inverse
    inside = np.zeros(depth.shape, dtype=bool)
    for capsule in image.body_world:
        start, end = T_camera_world @ capsule.start_world, T_camera_world @ capsule.end_world
        axis = end - start
        along = np.clip((points - start) @ axis / max(float(axis @ axis), 1e-12), 0.0, 1.0)
        off = points - (start + along[..., None] * axis)
        inside |= np.einsum("vui,vui->vu", off, off) < capsule.radius**2
    shape = (-(-camera.height // stride), -(-camera.width // stride))
    blocks = inside.repeat(_BODY_STRIDE, axis=0).repeat(_BODY_STRIDE, axis=1)
    return blocks[: shape[0], : shape[1]]


def homography(image: DepthImage, region: PlanarRegion) -> Array:
    """What maps (x, y, 1) of a region's plane to (u, v, 1) of the image, up to scale, (3, 3)."""
    camera, R_camera_world = image.camera, image.T_world_camera.R.T
    R, p = region.T_world_region.R, region.T_world_region.p - image.T_world_camera.p
    in_camera = R_camera_world @ np.column_stack((R[:, 0], R[:, 1], p))
    return np.array([(camera.fx, 0.0, camera.cx), (0.0, camera.fy, camera.cy), (0.0, 0.0, 1.0)]) @ in_camera


def in_image(polygon: Array, H_image_plane: Array) -> Array:
    """A polygon of a plane, (N, 2) [m], as pixels of the image, (N, 2)."""
    points = polygon @ H_image_plane[:, :2].T + H_image_plane[:, 2]
    return points[:, :2] / points[:, 2:]


def _outline(extraction: RegionExtraction, piece: int) -> Array:
    if piece >= 0:
        region = extraction.regions.regions[piece]
        return in_image(region.hull_region, homography(extraction.image, region))
    return extraction.rejected[-2 - piece].outline_image
