"""Random ground of several kinds, anywhere in the world, with a stance and a way over it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from open_loop import random_field, rectangle

from skills.body_path import SubGoal, SubGoalParameters, straight_path, sub_goal
from skills.footsteps import FootstepParameters, Stance, TerrainParameters, stand_on
from skills.geometry.pose import Array, Pose
from skills.regions import PlanarRegion, PlanarRegions

TERRAIN = TerrainParameters()


@dataclass(frozen=True, slots=True, eq=False)
class Scene:
    """Ground, the stance on it, and the way to a goal."""

    regions: PlanarRegions
    parameters: FootstepParameters
    stance: Stance
    sub_goal: SubGoal
    goal_world: Array


def random_scene(seed: int) -> Scene:
    generator = np.random.default_rng(seed)
    kinds = (_stones, _blocks, _clutter, _stairs)
    regions = [rectangle((0.0, 0.0, 0.0), size=(0.8, 0.9)), *kinds[seed % len(kinds)](generator)]
    T_world_scene = Pose.from_xyz_rpy((*generator.uniform(-20, 20, 2), 0.3), (0.0, 0.0, generator.uniform(-3, 3)))
    ground = PlanarRegions(tuple(_moved(T_world_scene, region) for region in regions), 0.0, seed)
    parameters = FootstepParameters(share=float(generator.choice((0.97, 0.8))))
    start = _placed(T_world_scene, (*generator.uniform((0.0, -0.1), (0.2, 0.1)), 0.0), generator.uniform(-0.3, 0.3))
    goal = _placed(T_world_scene, (generator.uniform(0.8, 2.8), generator.uniform(-0.2, 0.2), 0.0), 0.0)
    stance = stand_on(ground, start, parameters, TERRAIN)
    path = straight_path(start[[0, 1, 3]], goal[[0, 1, 3]])
    return Scene(ground, parameters, stance, sub_goal(path, stance, SubGoalParameters()), goal)


def _moved(T_world_scene: Pose, region: PlanarRegion) -> PlanarRegion:
    outline = region.hull_region
    return PlanarRegion(T_world_scene @ region.T_world_region, outline, (outline,), region.area, 0.0)


def _placed(T_world_scene: Pose, xyz: tuple[float, ...], yaw: float) -> Array:
    return np.array((*(T_world_scene @ np.array(xyz)), T_world_scene.yaw + yaw))


def _stones(generator: np.random.Generator) -> list[PlanarRegion]:
    """Loose stones with gaps between them, turned and tilted a little."""
    return [
        rectangle(
            (0.5 + 0.33 * i + generator.uniform(-0.03, 0.03), 0.33 * j, generator.uniform(-0.06, 0.06)),
            (generator.normal(0, 0.08), generator.normal(0, 0.08), generator.uniform(-0.5, 0.5)),
            size=(generator.uniform(0.2, 0.36), generator.uniform(0.2, 0.36)),
        )
        for i in range(10)
        for j in range(-2, 3)
    ]


def _blocks(generator: np.random.Generator) -> list[PlanarRegion]:
    """Rows of blocks without gaps, half of them tilted."""
    return list(random_field(int(generator.integers(1 << 30)), rows=8, tilted=0.5, spread=0.08).regions)


def _clutter(generator: np.random.Generator) -> list[PlanarRegion]:
    """A floor with things of all sizes on it."""
    things = [
        rectangle(
            (generator.uniform(0.4, 3.0), generator.uniform(-0.8, 0.8), generator.uniform(0.005, 0.3)),
            (generator.normal(0, 0.1), generator.normal(0, 0.1), generator.uniform(-3, 3)),
            size=(generator.uniform(0.05, 0.5), generator.uniform(0.05, 0.5)),
        )
        for _ in range(25)
    ]
    return [rectangle((1.5, 0.0, 0.0), size=(4.0, 2.0)), *things]


def _stairs(generator: np.random.Generator) -> list[PlanarRegion]:
    """Stairs up and down, each a little askew."""
    return [
        rectangle(
            (0.53 + 0.27 * i, 0.0, 0.12 * (4 - abs(4 - i))),
            (0.0, 0.0, generator.uniform(-0.03, 0.03)),
            size=(0.28, 1.0),
        )
        for i in range(9)
    ]
