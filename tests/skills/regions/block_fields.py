"""Exact depth images of block fields, for tests: boxes, a slab test along every ray, and a noise model."""

from dataclasses import dataclass

import cv2
import numpy as np

from skills.geometry.camera import DepthImage, PinholeCamera
from skills.geometry.pose import Pose, rotation_x, rotation_y, rotation_z

L515 = PinholeCamera(1024, 768, 737.6, 737.6, 511.5, 383.5)


@dataclass(frozen=True)
class Box:
    T_world_box: Pose
    half_extents: np.ndarray

    @property
    def top(self) -> Pose:
        """The frame of the upper face."""
        return self.T_world_box @ Pose(np.eye(3), np.array([0.0, 0.0, self.half_extents[2]]))


@dataclass(frozen=True)
class View:
    """A depth image and, for every pixel, the box it sees (-1 for none) and whether that is its upper face."""

    image: DepthImage
    box: np.ndarray
    is_top: np.ndarray


def block(x: float, y: float, top: float, size=(0.37, 0.39, 0.6), roll=0.0, pitch=0.0, yaw=0.0) -> Box:
    half = 0.5 * np.array(size)
    R = rotation_z(yaw) @ rotation_y(pitch) @ rotation_x(roll)
    return Box(Pose(R, np.array([x, y, top]) - R @ np.array([0.0, 0.0, half[2]])), half)


def camera_pose(x: float, ground: float = 0.0, y=0.0, yaw=0.0, down=0.82, roll=0.0, height=1.05) -> Pose:
    """A camera above (x, y), looking along yaw and down."""
    c, s = np.cos(down), np.sin(down)
    R = np.column_stack(((0.0, -1.0, 0.0), (-s, 0.0, -c), (c, 0.0, -s)))
    return Pose(rotation_z(yaw) @ R @ rotation_z(roll), np.array([x, y, ground + height]))


def look(boxes: list[Box], T_world_camera: Pose, camera: PinholeCamera = L515, time=0.0, frame_id=0) -> View:
    """Noise-free depth of the boxes; those more than 4 m ahead are left out."""
    depth = np.full((camera.height, camera.width), np.inf)
    seen = np.full(depth.shape, -1)
    is_top = np.zeros(depth.shape, bool)
    for index, box in enumerate(boxes):
        T_camera_box = T_world_camera.inverse @ box.T_world_box
        signs = np.array(np.meshgrid((-1, 1), (-1, 1), (-1, 1))).reshape(3, -1).T
        corners = T_camera_box @ (signs * box.half_extents)
        if np.all(corners[:, 2] <= 0.05) or np.all(corners[:, 2] > 4.0):
            continue
        low, high = np.zeros(2, int), np.array([camera.width, camera.height])
        if np.all(corners[:, 2] > 0.05):
            uv = corners[:, :2] / corners[:, 2:] * (camera.fx, camera.fy) + (camera.cx, camera.cy)
            low = np.maximum(low, np.floor(uv.min(axis=0)).astype(int))
            high = np.minimum(high, np.ceil(uv.max(axis=0)).astype(int) + 1)
        if np.any(low >= high):
            continue
        window = np.s_[low[1] : high[1], low[0] : high[0]]
        u, v = np.meshgrid(np.arange(low[0], high[0]), np.arange(low[1], high[1]))
        rays = np.stack(((u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, np.ones(u.shape)), axis=-1)
        direction = rays @ T_camera_box.R
        origin = -T_camera_box.R.T @ T_camera_box.p
        with np.errstate(divide="ignore"):
            t = np.sort(((np.array([[-1.0], [1.0]]) * box.half_extents - origin) / direction[..., None, :]), axis=-2)
        enter, leave = t[..., 0, :].max(axis=-1), t[..., 1, :].min(axis=-1)
        nearer = (enter < leave) & (enter > 0.0) & (enter < depth[window])
        top_hit = (t[..., 0, :].argmax(axis=-1) == 2) & (direction[..., 2] < 0.0)
        depth[window] = np.where(nearer, enter, depth[window])
        seen[window] = np.where(nearer, index, seen[window])
        is_top[window] = np.where(nearer, top_hit, is_top[window])
    depth[(depth < camera.near) | (depth > camera.far)] = 0.0
    return View(DepthImage(depth.astype(np.float32), camera, T_world_camera, time, frame_id), seen, is_top)


def with_noise(image: DepthImage, seed: int, correlated=0.002) -> DepthImage:
    """White noise of 2.5 mm + 1.6 mm/m, noise correlated over 6 px, and half of the pixels at depth edges lost."""
    rng = np.random.default_rng(seed)
    depth = image.depth.astype(np.float64)
    valid = depth > 0.0
    smooth = cv2.GaussianBlur(rng.standard_normal(depth.shape), (0, 0), 3.0)
    noise = rng.standard_normal(depth.shape) * (0.0025 + 0.0016 * depth) + smooth / smooth.std() * correlated
    kernel = np.ones((3, 3), np.uint8)
    edge = (cv2.dilate(depth, kernel) - cv2.erode(depth, kernel)) > 0.03
    lost = edge & (rng.random(depth.shape) < 0.5)
    noisy = np.where(valid & ~lost, depth + noise, 0.0).astype(np.float32)
    return DepthImage(noisy, image.camera, image.T_world_camera, image.time, image.frame_id)
