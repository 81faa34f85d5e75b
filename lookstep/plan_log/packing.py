"""Regions, stances, plans and searches as a few numpy arrays each, with the rest in a part of a JSON header."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from skills.footsteps import Footstep, FootstepPlan, PlanOutcome, SearchLog, Side, Stance
from skills.geometry import Array, Pose
from skills.regions import PlanarRegion, PlanarRegions

Arrays = dict[str, np.ndarray]


def pack_regions(regions: PlanarRegions, name: str, arrays: Arrays) -> dict[str, Any]:
    """Put regions into arrays whose names begin with `name`; what belongs into the header."""
    arrays[f"{name}_poses"] = _poses([region.T_world_region for region in regions.regions])
    arrays[f"{name}_figures"] = np.array([(r.area, r.time, r.sigma) for r in regions.regions]).reshape(-1, 3)
    hulls = [region.hull_region for region in regions.regions]
    holes = [hole for region in regions.regions for hole in region.holes_region]
    parts = [part for region in regions.regions for part in region.convex_parts_region]
    for kind, polygons in (("hulls", hulls), ("holes", holes), ("parts", parts)):
        arrays[f"{name}_{kind}"] = np.concatenate([np.zeros((0, 2)), *polygons])
        arrays[f"{name}_{kind}_sizes"] = np.array([len(polygon) for polygon in polygons], dtype=np.int32)
    arrays[f"{name}_counts"] = np.array(
        [(len(r.holes_region), len(r.convex_parts_region)) for r in regions.regions], dtype=np.int32
    ).reshape(-1, 2)
    return {"time": regions.time, "frame_id": regions.frame_id}


def unpack_regions(header: Mapping[str, Any], name: str, arrays: Arrays) -> PlanarRegions:
    """The regions that `pack_regions` has put away."""
    hulls, holes, parts = (
        _split(arrays[f"{name}_{kind}"], arrays[f"{name}_{kind}_sizes"]) for kind in ("hulls", "holes", "parts")
    )
    poses, figures, counts = (arrays[f"{name}_{kind}"] for kind in ("poses", "figures", "counts"))
    regions, hole, part = [], 0, 0
    for i, (T_world_region, hull) in enumerate(zip(_unpacked_poses(poses), hulls, strict=True)):
        area, time, sigma = (float(n) for n in figures[i])
        next_hole, next_part = hole + int(counts[i, 0]), part + int(counts[i, 1])
        regions.append(
            PlanarRegion(
                T_world_region, hull, tuple(parts[part:next_part]), area, time, tuple(holes[hole:next_hole]), sigma
            )
        )
        hole, part = next_hole, next_part
    return PlanarRegions(tuple(regions), header["time"], header["frame_id"])


def pack_stance(stance: Stance) -> Array:
    """The left and the right sole, (2, 12)."""
    return _poses([stance.T_world_left, stance.T_world_right])


def unpack_stance(array: Array) -> Stance:
    """The stance that `pack_stance` has put away."""
    return Stance(*_unpacked_poses(array))


def pack_plan(plan: FootstepPlan, name: str, arrays: Arrays) -> dict[str, Any]:
    """Put a plan into arrays whose names begin with `name`; what belongs into the header."""
    arrays[f"{name}_soles"] = _poses([step.T_world_sole for step in plan.steps])
    arrays[f"{name}_figures"] = np.array(
        [(s.swing_duration, s.transfer_duration, s.swing_height, s.margin) for s in plan.steps]
    ).reshape(-1, 4)
    for kind, polygons, columns in (
        ("footholds", [step.foothold_sole for step in plan.steps], 2),
        ("waypoints", [step.swing_waypoints_world for step in plan.steps], 3),
        ("landing_regions", [step.landing_region_sole for step in plan.steps], 2),
    ):
        arrays[f"{name}_{kind}"] = np.concatenate([np.zeros((0, columns)), *polygons])
        arrays[f"{name}_{kind}_sizes"] = np.array([len(polygon) for polygon in polygons], dtype=np.int32)
    return {
        "plan_id": plan.plan_id,
        "frame_id": plan.frame_id,
        "outcome": plan.outcome.value,
        "reason": plan.reason,
        "cost": plan.cost,
        "expansions": plan.expansions,
        "kept_steps": plan.kept_steps,
        "rejections": [list(item) for item in plan.rejections],
        "sequence_ids": [step.sequence_id for step in plan.steps],
        "sides": [step.side.value for step in plan.steps],
    }


def unpack_plan(header: Mapping[str, Any], name: str, arrays: Arrays) -> FootstepPlan:
    """The plan that `pack_plan` has put away."""
    footholds, waypoints, landing_regions = (
        _split(arrays[f"{name}_{kind}"], arrays[f"{name}_{kind}_sizes"])
        for kind in ("footholds", "waypoints", "landing_regions")
    )
    figures = arrays[f"{name}_figures"]
    steps = []
    for i, T_world_sole in enumerate(_unpacked_poses(arrays[f"{name}_soles"])):
        swing_duration, transfer_duration, swing_height, margin = (float(n) for n in figures[i])
        steps.append(
            Footstep(
                sequence_id=header["sequence_ids"][i],
                side=Side(header["sides"][i]),
                T_world_sole=T_world_sole,
                foothold_sole=footholds[i],
                swing_duration=swing_duration,
                transfer_duration=transfer_duration,
                swing_height=swing_height,
                swing_waypoints_world=waypoints[i],
                landing_region_sole=landing_regions[i],
                margin=margin,
            )
        )
    return FootstepPlan(
        plan_id=header["plan_id"],
        frame_id=header["frame_id"],
        outcome=PlanOutcome(header["outcome"]),
        reason=header["reason"],
        steps=tuple(steps),
        cost=header["cost"],
        expansions=header["expansions"],
        rejections=tuple((reason, count) for reason, count in header["rejections"]),
        kept_steps=header["kept_steps"],
    )


def pack_search(log: SearchLog, name: str, arrays: Arrays) -> dict[str, Any]:
    """Put the log of a search into arrays whose names begin with `name`, field by field; what belongs into the header.

    Fields of their own, and nodes as differences, compress to a third.
    """
    for column in log.edges.dtype.names or ():
        values = log.edges[column]
        arrays[f"{name}_{column}"] = np.diff(values, prepend=values[:1]) if values.dtype.kind == "i" else values
        arrays[f"{name}_{column}_first"] = values[:1]
    return {
        "first_side": log.first_side.value,
        "shape": list(log.shape),
        "start": list(log.start),
        "anchor": log.anchor_world.tolist(),
        "yaw": log.yaw,
        "spacing": log.spacing,
        "turn": log.turn,
    }


def unpack_search(header: Mapping[str, Any], name: str, arrays: Arrays) -> SearchLog:
    """The log that `pack_search` has put away."""
    count = len(arrays[f"{name}_node"])
    edges = np.zeros(count, dtype=SearchLog.LAYOUT)
    for column in edges.dtype.names or ():
        values = arrays[f"{name}_{column}"]
        first = arrays[f"{name}_{column}_first"]
        edges[column] = np.cumsum(values) + first.sum() if values.dtype.kind == "i" else values
    edges.flags.writeable = False
    return SearchLog(
        first_side=Side(header["first_side"]),
        shape=tuple(header["shape"]),
        start=tuple(header["start"]),
        anchor_world=np.array(header["anchor"]),
        yaw=header["yaw"],
        spacing=header["spacing"],
        turn=header["turn"],
        edges=edges,
    )


def _poses(poses: Sequence[Pose]) -> Array:
    """Rotation matrices row by row, then positions, (N, 12)."""
    return np.array([(*T.R.ravel(), *T.p) for T in poses], dtype=np.float64).reshape(-1, 12)


def _unpacked_poses(array: Array) -> list[Pose]:
    return [Pose(row[:9].reshape(3, 3), row[9:]) for row in array]


def _split(points: Array, sizes: NDArray[np.int32]) -> list[Array]:
    """Polygons that lie one after the other."""
    return np.split(points, np.cumsum(sizes)[:-1]) if len(sizes) else []
