"""An independent judge of footstep plans: slow, plain, and knowing nothing of how plans are made.

It takes regions as polygons in the world, never a raster, and measures every limit on the poses of the plan. Ground is
the highest region over a point; a gap counts as ground where regions of one height lie on both sides of it.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skills.footsteps import Footstep, FootstepParameters, FootstepPlan, PlanOutcome, Side, Stance, TerrainParameters
from skills.geometry.pose import Array, Pose
from skills.regions import PlanarRegion, PlanarRegions

ROUNDING = 1e-9
GRID = 0.004
# Planners feel the ground at points 1 cm apart; ground tilted against the sole may rise a little between them.
BETWEEN_SAMPLES = 0.0015


@dataclass
class Surface:
    """A region as a polygon seen from above, with its height as a function of x and y."""

    rings: list[Array]
    a: float
    b: float
    c: float

    def height(self, xy: Array) -> Array:
        return self.a * xy[:, 0] + self.b * xy[:, 1] + self.c

    def holds(self, xy: Array) -> NDArray[np.bool_]:
        inside = np.zeros(len(xy), dtype=bool)
        for ring in self.rings:
            for (x0, y0), (x1, y1) in zip(ring, np.roll(ring, -1, axis=0), strict=True):
                crossed = (y0 <= xy[:, 1]) != (y1 <= xy[:, 1])
                if y0 != y1:
                    inside ^= crossed & (xy[:, 0] < x0 + (xy[:, 1] - y0) / (y1 - y0) * (x1 - x0))
        return inside


class PlanJudge:
    """Judges plans on one map."""

    def __init__(
        self, regions: PlanarRegions, parameters: FootstepParameters, terrain: TerrainParameters | None = None
    ) -> None:
        self.p, self.t = parameters, terrain or TerrainParameters()
        surfaces = [self.surface(region) for region in regions.regions]
        self.surfaces = [surface for surface in surfaces if surface is not None]

    def surface(self, region: PlanarRegion) -> Surface | None:
        nx, ny, nz = region.normal_world
        if not (np.all(np.isfinite(region.T_world_region.p)) and nz > math.cos(self.t.steepest_region)):
            return None
        a, b = -nx / nz, -ny / nz
        x, y, z = region.T_world_region.p
        rings = [ring for ring in (region.hull_region, *region.holes_region) if len(ring) >= 3]
        in_world = [(region.T_world_region @ np.column_stack((ring, np.zeros(len(ring)))))[:, :2] for ring in rings]
        return Surface(in_world, a, b, z - a * x - b * y) if in_world else None

    def violations(
        self, plan: FootstepPlan, stance: Stance, first_side: Side | None, goal_xyyaw: Array | None = None
    ) -> list[str]:
        """Everything that is wrong with a plan, each with the number of its step."""
        found = self.sequence(plan, first_side)
        for number, step in enumerate(plan.steps):
            wrong = [*self.step_limits(step, stance), *self.foothold(step), *self.swing(step, stance)]
            found += [f"step {number}: {text}" for text in wrong]
            stance = stance.with_sole(step.side, step.T_world_sole)
        if plan.outcome is PlanOutcome.GOAL_REACHED and goal_xyyaw is not None:
            found += self.at_goal(stance, goal_xyyaw)
        return found

    def sequence(self, plan: FootstepPlan, first_side: Side | None) -> list[str]:
        found = []
        if plan.steps and first_side is not None and plan.steps[0].side is not first_side:
            found.append("the wrong foot first")
        if any(a.side is b.side for a, b in itertools.pairwise(plan.steps)):
            found.append("one foot twice in a row")
        if any(b.sequence_id != a.sequence_id + 1 for a, b in itertools.pairwise(plan.steps)):
            found.append("sequence ids do not count on")
        if plan.outcome is PlanOutcome.BLOCKED and plan.steps:
            found.append("steps of a blocked plan")
        return found

    def step_limits(self, step: Footstep, stance: Stance) -> list[str]:
        p, landing = self.p, step.T_world_sole
        support, start = stance.sole(step.side.opposite), stance.sole(step.side)
        dx, dy, rise = landing.p - support.p
        c, s = math.cos(support.yaw), math.sin(support.yaw)
        sign = 1.0 if step.side is Side.LEFT else -1.0
        length, width = c * dx + s * dy, sign * (c * dy - s * dx)
        outward = sign * wrapped(landing.yaw - support.yaw)
        reach = math.hypot(length, width - p.ideal_width)
        uphill = math.asin(support.R[2, 0])
        swing = landing.p - start.p
        checks = {
            f"reach {reach:.3f}": reach > p.reach + ROUNDING,
            f"reach up {reach:.3f}": rise > p.reach_up_height and reach > p.reach_up + ROUNDING,
            f"reach down {reach:.3f}": rise < -p.reach_down_height and reach > p.reach_down + ROUNDING,
            f"back {length:.3f}": length < -p.back_reach - ROUNDING,
            f"width {width:.3f}": not p.minimum_width - ROUNDING <= width <= p.maximum_width + ROUNDING,
            f"rise {rise:.3f}": abs(rise) > p.max_step_height + ROUNDING,
            f"outward yaw {outward:.3f}": not -p.inward_yaw - 1e-6 <= outward <= p.outward_yaw + 1e-6,
            f"drop {rise:.3f} off an uphill foot": rise < -p.uphill_drop and uphill > p.uphill_slope + 1e-6,
            "swing too long": math.hypot(*swing[:2]) > p.swing_reach + ROUNDING,
            "swing too high": abs(swing[2]) > p.swing_height_change + ROUNDING,
            "tilt": math.acos(min(landing.R[2, 2], 1.0)) > p.tilt + 1e-6,
            "soles too near": rectangle_distance(self.sole(landing), self.sole(support)) < p.sole_gap - ROUNDING,
            "frame not orthonormal": not np.allclose(landing.R @ landing.R.T, np.eye(3), atol=1e-9),
        }
        return [name for name, wrong in checks.items() if wrong]

    def foothold(self, step: Footstep) -> list[str]:
        p, T, found = self.p, step.T_world_sole, []
        x, y = 0.5 * p.sole_length, 0.5 * p.sole_width
        xy_sole = grid((-x, x), (-y, y))
        on_plane = T @ np.column_stack((xy_sole, np.zeros(len(xy_sole))))
        ground = self.ground(on_plane[:, :2], self.t.seam_width)
        rise = ground - on_plane[:, 2]
        supported = (rise >= -p.support_below - 1e-6) & (rise <= p.ground_above + BETWEEN_SAMPLES)
        share = float(np.mean(supported))
        if share < p.share - self.share_tolerance:
            found.append(f"supported share {share:.3f}")
        # A gap that counts as ground carries nothing; the polygon need not hold it.
        on_regions = self.ground(on_plane[:, :2], 0.0) - on_plane[:, 2]
        carried = supported & (on_regions >= -p.support_below - 1e-6)
        highest = float(np.nanmax(on_regions, initial=-np.inf))
        if highest > p.ground_above + BETWEEN_SAMPLES:
            found.append(f"ground {1e3 * highest:.0f} mm above the sole")
        beside = self.beside(T)
        cliff = float(np.nanmax(self.ground(beside[:, :2], 0.0) - beside[:, 2], initial=-np.inf))
        if cliff > p.cliff_height + BETWEEN_SAMPLES:
            found.append(f"cliff of {1e3 * cliff:.0f} mm beside the sole")
        if not any(abs(s.height(T.p[None])[0] - T.p[2]) < 1e-6 and plane_fits(s, T) for s in self.surfaces):
            found.append("the sole lies in the plane of no region")
        return [*found, *self.foothold_polygon(step, xy_sole, supported, carried)]

    share_tolerance = 0.0
    polygon_tolerance = 0.06
    cell = 0.01

    def foothold_polygon(
        self, step: Footstep, xy_sole: Array, supported: NDArray[np.bool_], carried: NDArray[np.bool_]
    ) -> list[str]:
        """The polygon must lie in the sole, be convex and hold what regions carry of it, but for a cell."""
        polygon, p = step.foothold_sole, self.p
        found = []
        if np.any(np.abs(polygon) > (0.5 * p.sole_length + ROUNDING, 0.5 * p.sole_width + ROUNDING)):
            found.append("foothold larger than the sole")
        edges = np.roll(polygon, -1, axis=0) - polygon
        following = np.roll(edges, -1, axis=0)
        if np.any(edges[:, 0] * following[:, 1] - edges[:, 1] * following[:, 0] < -ROUNDING):
            found.append("foothold not convex")
        normals = np.column_stack((edges[:, 1], -edges[:, 0])) / np.linalg.norm(edges, axis=1)[:, None]
        inside = np.all(np.einsum("pkd,kd->pk", xy_sole[:, None] - polygon, normals) <= ROUNDING, axis=1)
        if np.mean(inside & carried) < np.mean(carried) - self.polygon_tolerance:
            found.append("foothold leaves out sole that is carried")
        if np.mean(inside) > np.mean(supported) + 1.0 - self.p.share + self.polygon_tolerance:
            found.append("foothold holds more than the supported sole")
        return found

    def swing(self, step: Footstep, stance: Stance) -> list[str]:
        """While it crosses, the level sole clears what it passes over."""
        start = stance.sole(step.side)
        first, last = step.swing_waypoints_world
        x, y = 0.5 * self.p.sole_length, 0.5 * self.p.sole_width
        sole = grid((-x, x), (-y, y), 0.01)
        smallest = np.inf
        whole = np.linalg.norm(step.T_world_sole.p[:2] - start.p[:2])
        for f in np.linspace(0.0, 1.0, 12):
            centre = first + f * (last - first)
            done = float(np.linalg.norm(centre[:2] - start.p[:2]) / whole) if whole > 1e-6 else 0.0
            yaw = start.yaw + done * wrapped(step.T_world_sole.yaw - start.yaw)
            points = Pose.from_xyz_rpy(centre, (0.0, 0.0, yaw)) @ np.column_stack((sole, np.zeros(len(sole))))
            ground = self.ground(points[:, :2], 0.0)
            smallest = min(smallest, float(np.nanmin(points[:, 2] - ground, initial=np.inf)))
        return [f"swing {1e3 * smallest:.0f} mm above ground"] if smallest < self.p.swing_clearance - 0.005 else []

    def at_goal(self, stance: Stance, goal_xyyaw: Array) -> list[str]:
        off = math.hypot(*(stance.mid_feet[:2] - goal_xyyaw[:2]))
        # Each foot has its own place within the tolerance, and may be turned against the other.
        turned = 0.25 * self.p.ideal_width * 2 * self.p.goal_yaw_tolerance
        found = [] if off <= self.p.goal_tolerance + turned else [f"{off:.3f} m from the goal"]
        for side in Side:
            turn = abs(wrapped(stance.sole(side).yaw - goal_xyyaw[2]))
            if turn > self.p.goal_yaw_tolerance + ROUNDING:
                found.append(f"{side.value} foot turned {turn:.3f} from the goal")
        return found

    def sole(self, T_world_sole: Pose) -> Array:
        """Corners of a sole held level at its place and heading, (4, 2)."""
        x, y = 0.5 * self.p.sole_length, 0.5 * self.p.sole_width
        level = Pose.from_xyz_rpy(T_world_sole.p, (0.0, 0.0, T_world_sole.yaw))
        return (level @ np.array(((-x, -y, 0.0), (x, -y, 0.0), (x, y, 0.0), (-x, y, 0.0))))[:, :2]

    def beside(self, T_world_sole: Pose) -> Array:
        """Points in the sole's plane around it as far as cliffs count, but for a cell of the planner's raster."""
        p = self.p
        x, y = 0.5 * p.sole_length, 0.5 * p.sole_width
        side = max(p.cliff_side - self.cell, 0.0)
        points = grid((-x - side, x + max(p.cliff_toe - self.cell, 0.0)), (-y - side, y + side), 0.005)
        return T_world_sole @ np.column_stack((points, np.zeros(len(points))))

    def ground(self, xy: Array, seam: float) -> Array:
        """Height of the highest region over each point, (N,); NaN where there is none and no seam."""
        xy = np.ascontiguousarray(xy)
        heights = np.full(len(xy), -np.inf)
        for surface in self.surfaces:
            over = near(surface, xy)
            if np.any(over):
                inside = np.flatnonzero(over)[surface.holds(xy[over])]
                heights[inside] = np.maximum(heights[inside], surface.height(xy[inside]))
        heights[np.isinf(heights)] = np.nan
        missing = np.flatnonzero(np.isnan(heights))
        if seam > 0.0 and len(missing):
            heights[missing] = self.seam_heights(xy[missing], seam)
        return heights

    def seam_heights(self, xy: Array, seam: float) -> Array:
        """Ground on both sides along x or along y, no further apart than a seam and of one height there."""
        heights = np.full(len(xy), np.nan)
        reach = np.arange(1, 8) / 7 * seam
        for axis in np.eye(2):
            sides = []
            for sign in (-1.0, 1.0):
                probes = (xy[:, None] + sign * reach[None, :, None] * axis).reshape(-1, 2)
                sides.append(self.ground(probes, 0.0).reshape(len(xy), -1))
            for i in np.flatnonzero(np.isnan(heights)):
                before, after = (np.flatnonzero(~np.isnan(side[i])) for side in sides)
                if len(before) and len(after) and reach[before[0]] + reach[after[0]] <= seam + 2 * self.cell:
                    pair = (sides[0][i, before[0]], sides[1][i, after[0]])
                    if abs(pair[0] - pair[1]) <= self.t.seam_step + 0.005:
                        heights[i] = 0.5 * sum(pair)
        return heights


def near(surface: Surface, xy: Array) -> NDArray[np.bool_]:
    outline = surface.rings[0]
    return np.all((xy >= outline.min(axis=0)) & (xy <= outline.max(axis=0)), axis=1)


def plane_fits(surface: Surface, T: Pose) -> bool:
    normal = np.array((-surface.a, -surface.b, 1.0))
    return bool(np.allclose(T.R[:, 2], normal / np.linalg.norm(normal), atol=1e-9))


def grid(x: tuple[float, float], y: tuple[float, float], spacing: float = GRID) -> Array:
    """Centres of equal cells that fill a rectangle, so that their mean is an area."""
    sides = []
    for low, high in (x, y):
        count = max(1, round((high - low) / spacing))
        sides.append(low + (np.arange(count) + 0.5) / count * (high - low))
    return np.stack(np.meshgrid(*sides), axis=-1).reshape(-1, 2)


def wrapped(angle: float) -> float:
    return (angle + math.pi) % (2 * math.pi) - math.pi


def rectangle_distance(a: Array, b: Array) -> float:
    """Distance of two convex polygons; 0 where they overlap."""
    for polygon, other in ((a, b), (b, a)):
        for corner, edge in zip(polygon, np.roll(polygon, -1, axis=0) - polygon, strict=True):
            outward = np.array((edge[1], -edge[0]))
            if np.min((other - corner) @ outward) >= 0.0:
                return min(point_distance(p, q) for p, q in ((a, b), (b, a)))
    return 0.0


def point_distance(points: Array, polygon: Array) -> float:
    """Smallest distance of points to a polygon's edges."""
    smallest = np.inf
    for start, end in zip(polygon, np.roll(polygon, -1, axis=0), strict=True):
        span = end - start
        t = np.clip((points - start) @ span / (span @ span), 0.0, 1.0)
        smallest = min(smallest, float(np.min(np.linalg.norm(points - start - t[:, None] * span, axis=1))))
    return smallest
