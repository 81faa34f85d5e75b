"""The problem that every planner of the body path solves: from a pose to a goal over the layers of one height map.

It is posed in the terms of OMPL: states are poses in the plane, a state is valid where the body's box is free, and the
objective is the cost of the way. `path_cost` computes both, whoever asks.
"""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass, field

import numpy as np

from skills.body_path.body_path import BodyPath
from skills.body_path.ground_layers import AWAY, DISTANCE, GROUND, GroundLayers
from skills.body_path.path_cost import body_fits, first_collision, look_up, way_cost
from skills.body_path.path_parameters import BodyPathParameters
from skills.footsteps.records import Records
from skills.geometry.pose import Array, readonly
from skills.kernels import kernel


@dataclass(frozen=True, slots=True, eq=False)
class PathProblem:
    """From where to where, and what the ground is like.

    Attributes:
        ground: layers of the height map.
        start, goal: (3,) x, y [m] and heading [rad] in the world.
        parameters: of cost, body and planners.
        away_weight: by which share ground costs more that is away from the path that is walked.
        scale: one `SCALE` for the kernels; made from the others.
    """

    ground: GroundLayers
    start: Array
    goal: Array
    parameters: BodyPathParameters
    away_weight: float = 0.0
    scale: Records = field(init=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "start", readonly(self.start, (3,)))
        object.__setattr__(self, "goal", readonly(self.goal, (3,)))
        scale = self.ground.scale(self.parameters, self._nominal_incline())
        scale["away_weight"] = self.away_weight
        object.__setattr__(self, "scale", scale)

    def staying_near(self, path: BodyPath) -> PathProblem:
        """The same problem, but ground away from a path costs more, by what another way must be cheaper."""
        p, layers = self.parameters, np.array(self.ground.layers)
        _measure_away(layers[AWAY], self.scale, path.waypoints_world[:, :2].copy(), p.same_way)
        layers.flags.writeable = False
        ground = dataclasses.replace(self.ground, layers=layers)
        return dataclasses.replace(self, ground=ground, away_weight=p.better_by / (1.0 - p.better_by))

    @property
    def goal_is_on_map(self) -> bool:
        """Whether the goal lies on the layers, not beyond their border."""
        rows, columns = self.ground.layers.shape[1:]
        u, v = (self.goal[:2] - (self.ground.x, self.ground.y)) / self.ground.spacing
        return bool(0.0 <= u <= columns - 1 and 0.0 <= v <= rows - 1)

    @property
    def goal_is_free(self) -> bool:
        """Whether the body fits at the goal, with its heading, and does not stand on an obstacle there."""
        x, y, yaw = self.goal
        layers, (u, v) = self.ground.layers, (self.goal[:2] - (self.ground.x, self.ground.y)) / self.ground.spacing
        if look_up(layers, DISTANCE, u, v)[0] < 0.5 * self.ground.spacing:
            return False
        return body_fits(layers, self.ground.cells, self.scale, x, y, np.cos(yaw), np.sin(yaw))

    @property
    def beyond(self) -> float:
        """Cost of a metre beyond the map: that of level ground that nobody has seen."""
        p = self.parameters
        return 1.0 + (p.stance_weight + p.step_weight) * (1.0 - p.unseen_quality)

    def cost(self, points: Array) -> float:
        """Cost of walking over points (N, 2) [m of good ground]; being away from a path costs nothing here."""
        scale = self.scale.copy()
        scale["away_weight"] = 0.0
        return float(way_cost(self.ground.layers, scale, np.array(points, dtype=np.float64)))

    def fits(self, points: Array) -> bool:
        """Whether the body fits all along points (N, 2)."""
        way = np.array(points, dtype=np.float64)
        return int(first_collision(self.ground.layers, self.ground.cells, self.scale, way)) == len(way) - 1

    def _nominal_incline(self) -> float:
        """Slope from the ground at the start to that at the goal; level where the goal lies beyond the map."""
        if not self.goal_is_on_map:
            return 0.0
        u, v = ((place[:2] - (self.ground.x, self.ground.y)) / self.ground.spacing for place in (self.start, self.goal))
        rise = look_up(self.ground.layers, GROUND, *v)[0] - look_up(self.ground.layers, GROUND, *u)[0]
        return float(rise / max(float(np.hypot(*(self.goal[:2] - self.start[:2]))), self.ground.spacing))


@kernel
def _measure_away(away: Array, scale: Records, way: Array, near: float) -> None:
    """0 on a way (N, 2) and up to half as far as `near`, 1 from there on."""
    for i in range(away.shape[0]):
        y = scale.y + i * scale.spacing
        for j in range(away.shape[1]):
            x = scale.x + j * scale.spacing
            least = np.inf
            for k in range(len(way) - 1):
                span_x, span_y = way[k + 1, 0] - way[k, 0], way[k + 1, 1] - way[k, 1]
                squared = max(span_x * span_x + span_y * span_y, 1e-12)
                t = min(max(((x - way[k, 0]) * span_x + (y - way[k, 1]) * span_y) / squared, 0.0), 1.0)
                off_x, off_y = x - way[k, 0] - t * span_x, y - way[k, 1] - t * span_y
                least = min(least, off_x * off_x + off_y * off_y)
            away[i, j] = min(max(2.0 * np.sqrt(least) / near - 1.0, 0.0), 1.0)
