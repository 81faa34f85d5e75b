"""`lookstep picture`: a still picture of a walk, with what the robot sees and plans."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from lookstep.errors import UserError
from lookstep.options import RunOptions

if TYPE_CHECKING:
    from lookstep.moment import Moment

NAME = "picture"
HELP = "draw the robot in the middle of a walk, with its regions and planned footsteps"
EXAMPLE = "lookstep picture docs/images/rough.png --course rough --seed 3 --at 19"

_SUFFIXES = (".png", ".jpg")
_WIDTH, _HEIGHT = 1600, 900
_JPEG_QUALITY = 88


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what to draw."""
    defaults = RunOptions()
    parser.add_argument("file", type=Path, metavar="FILE", help="picture to write, .png or .jpg")
    parser.add_argument("--course", default=defaults.course, help="as for `run` (%(default)s)")
    parser.add_argument("--seed", type=int, default=defaults.seed, help="as for `run` (%(default)s)")
    parser.add_argument("--at", type=float, default=19.0, metavar="S", help="robot time of the picture (%(default)s)")


def execute(options: argparse.Namespace) -> int:
    """Walk until the time has come, and draw."""
    if options.file.suffix not in _SUFFIXES:
        raise UserError(f"{options.file}: needs a name that ends in {' or '.join(_SUFFIXES)}")
    if not options.file.parent.is_dir():
        raise UserError(f"{options.file}: the folder {options.file.parent} does not exist")
    from lookstep.commands.report import Progress
    from lookstep.walk import walk

    camera = _LastMoment()
    with Progress() as progress:
        walk(RunOptions(course=options.course, seed=options.seed, time_limit=options.at), progress, camera)
    assert camera.moment is not None, "a walk has at least one tick"
    _write(options.file, camera.moment)
    print(f"{options.file}: {options.course}, seed {options.seed}, at {camera.moment.time:.2f} s")
    return 0


class _LastMoment:
    """An observer that keeps the last tick."""

    def __init__(self) -> None:
        self.moment: Moment | None = None

    def observe(self, moment: Moment) -> None:
        """Keep it."""
        self.moment = moment


def _write(file: Path, moment: Moment) -> None:
    import cv2

    from lookstep.recording.palette import REGION_COLORS
    from sim_envs.picture import Overlay, beside_robot, picture_camera, picture_of, planned_steps, region_outlines
    from skills.footsteps import FootstepPlan
    from skills.regions import RegionExtraction

    overlays: list[Overlay] = []
    for value in moment.tree.blackboard.values().values():
        if isinstance(value, RegionExtraction):
            colors = [(r / 255.0, g / 255.0, b / 255.0) for r, g, b in REGION_COLORS]
            overlays = [*region_outlines(value.regions.regions, colors), *overlays]
        elif isinstance(value, FootstepPlan):
            overlays += planned_steps(value.steps)
    positions, rotations = moment.world.geom_poses()
    rgb = picture_of(
        moment.world.model,
        positions,
        rotations,
        picture_camera(_WIDTH, _HEIGHT),
        beside_robot(moment.state.T_world_pelvis),
        overlays=overlays,
    )
    cv2.imwrite(str(file), cv2.cvtColor(rgb, cv2.COLOR_RGB2BGR), [cv2.IMWRITE_JPEG_QUALITY, _JPEG_QUALITY])
