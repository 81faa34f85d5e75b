"""`lookstep picture`: a still picture of a walk, with what the robot sees and plans."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from lookstep.errors import UserError
from lookstep.options import RunOptions

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from lookstep.moment import Moment

NAME = "picture"
HELP = "draw the robot in the middle of a walk, or what it sees and knows there"
EXAMPLE = "lookstep picture docs/images/rough.png --course rough --seed 3 --at 19"

VIEWS = ("robot", "depth", "regions", "map", "heights")
_SUFFIXES = (".png", ".jpg")
_WIDTH, _HEIGHT = 1600, 900
_JPEG_QUALITY = 88


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what to draw."""
    defaults = RunOptions()
    parser.add_argument("file", type=Path, metavar="FILE", help="picture to write, .png or .jpg")
    parser.add_argument("--course", default=defaults.course, help="as for `run` (%(default)s)")
    parser.add_argument("--seed", type=int, default=defaults.seed, help="as for `run` (%(default)s)")
    parser.add_argument("--show", choices=VIEWS, default=VIEWS[0], help="what to draw (%(default)s)")
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
    _write(options.file, options.show, camera.moment)
    print(f"{options.file}: {options.course}, seed {options.seed}, at {camera.moment.time:.2f} s")
    return 0


class _LastMoment:
    """An observer that keeps the last tick."""

    def __init__(self) -> None:
        self.moment: Moment | None = None

    def observe(self, moment: Moment) -> None:
        """Keep it."""
        self.moment = moment


def _write(file: Path, view: str, moment: Moment) -> None:
    import cv2

    rgb = _robot(moment) if view == "robot" else _known(view, moment)
    cv2.imwrite(str(file), cv2.cvtColor(rgb, cv2.COLOR_RGB2BGR), [cv2.IMWRITE_JPEG_QUALITY, _JPEG_QUALITY])


def _known(view: str, moment: Moment) -> NDArray[np.uint8]:
    """A picture of the newest value on the blackboard that the view shows."""
    from lookstep import perception_pictures
    from lookstep.shapes import colors_by_place
    from skills.footsteps import Side
    from skills.height_map import HeightMap
    from skills.regions import PlanarRegions, RegionExtraction, debug_image

    for value in moment.tree.blackboard.values().values():
        match view, value:
            case "depth", RegionExtraction():
                return perception_pictures.depth_picture(value.image)
            case "regions", RegionExtraction():
                return debug_image(value, colors=colors_by_place(value.regions))
            case "map", PlanarRegions():
                soles = [moment.state.stance.sole(side) for side in Side]
                corners = moment.world.robot.sole_corners_sole
                return perception_pictures.map_picture(value, colors_by_place(value), soles, corners)
            case "heights", HeightMap():
                return perception_pictures.height_picture(value)
    raise UserError(f"--show {view}: nothing of that kind is known at {moment.time:.2f} s; try a later --at")


def _robot(moment: Moment) -> NDArray[np.uint8]:
    from lookstep.palette import REGION_COLORS
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
    return picture_of(
        moment.world.model,
        positions,
        rotations,
        picture_camera(_WIDTH, _HEIGHT),
        beside_robot(moment.state.T_world_pelvis),
        overlays=overlays,
    )
