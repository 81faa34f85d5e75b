"""What the sensors see on a walk over the rough course: moments all along the way, the robot's own body in view."""

from __future__ import annotations

from dataclasses import dataclass

from lookstep.bench.subject import Progress
from lookstep.moment import Moment
from lookstep.options import RunOptions
from lookstep.walk import walk
from sim_envs.sensors import DepthCamera, Lidar, Snapshot
from skills.footsteps.footstep import Stance
from skills.geometry.pose import Array, Pose

_CAMERA = "front"
_TOGETHER = 1e-6  # Sensors that fired this close to one another saw the same [s].


@dataclass(frozen=True, slots=True, eq=False)
class WalkFrame:
    """One moment of a walk.

    Attributes:
        depth, lidar: what each sensor met.
        stance: where the feet are going to be.
    """

    depth: Snapshot
    lidar: Snapshot
    stance: Stance


@dataclass(frozen=True, slots=True, eq=False)
class WalkFrames:
    """Moments of a walk, oldest first, and the sensors that were there."""

    frames: tuple[WalkFrame, ...]
    camera: DepthCamera
    lidar: Lidar
    goal: tuple[float, float, float]
    seed: int


def walk_frames(count: int, duration: float, seed: int, progress: Progress) -> WalkFrames:
    """Walk the rough course for a duration of robot time [s] and take moments evenly spread over it."""
    watcher = _Watcher(duration, progress)
    walk(RunOptions(course="rough", seed=seed, time_limit=duration), watcher)
    assert watcher.last is not None, "a walk has at least one tick"
    every = max(len(watcher.frames) / count, 1.0)
    chosen = tuple(watcher.frames[int(k * every)] for k in range(min(count, len(watcher.frames))))
    world = watcher.last.world
    return WalkFrames(chosen, world.depth_cameras[_CAMERA], world.lidar, world.course.goal, seed)


class _Watcher:
    """An observer that keeps the moments in which camera and lidar fired together."""

    def __init__(self, duration: float, progress: Progress) -> None:
        self.frames: list[WalkFrame] = []
        self.last: Moment | None = None
        self._duration = duration
        self._progress = progress

    def observe(self, moment: Moment) -> None:
        """Keep the moment, if it is one."""
        self.last = moment
        self._progress("walking the rough course", round(moment.time), round(self._duration))
        # The lidar is the slower of the two: asking it first renders no image in vain.
        scan = moment.world.lidar_scan()
        if scan is None or moment.time - scan.time > _TOGETHER:
            return
        image = moment.world.depth_image(_CAMERA)
        if image is None or moment.time - image.time > _TOGETHER:
            return
        poses = moment.world.geom_poses()
        self.frames.append(
            WalkFrame(
                _snapshot(moment.time, image.frame_id, poses, image.T_world_camera),
                _snapshot(moment.time, scan.scan_id, poses, scan.T_world_lidar),
                moment.status.imminent_stance,
            )
        )


def _snapshot(time: float, number: int, poses: tuple[Array, Array], T_world_sensor: Pose) -> Snapshot:
    return Snapshot(time, number, *poses, T_world_sensor)
