"""Footstep planning as a mixed-integer linear program on HiGHS: an oracle that shares nothing with a lattice search.

Heading is fixed along x, ground is level rectangles along x and y; one binary chooses the rectangle of a step. The
disc of the reach is a polygon, drawn around it or into it. After Deits and Tedrake, "Footstep planning on uneven
terrain with mixed-integer convex optimization" (2014).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import cos, pi, sin

import numpy as np
from scipy.optimize import Bounds, LinearConstraint, milp

from skills.footsteps import FootstepParameters, Side, Stance
from skills.geometry.pose import Array

_BIG = 100.0
_FACETS = 32


@dataclass(frozen=True, slots=True)
class Stone:
    """A level rectangle: centre and size along x and y, height."""

    x: float
    y: float
    z: float
    length: float
    width: float


@dataclass
class _Program:
    """Rows of a program under construction."""

    columns: int
    rows: list[Array] = field(default_factory=list)
    low: list[float] = field(default_factory=list)
    high: list[float] = field(default_factory=list)

    def require(self, terms: dict[int, float], low: float, high: float) -> None:
        row = np.zeros(self.columns)
        for column, weight in terms.items():
            row[column] += weight
        self.rows.append(row)
        self.low.append(low)
        self.high.append(high)


@dataclass(frozen=True, slots=True)
class FootholdMilp:
    """Least cost of plans on stones; `shrink` > 0 tightens every limit by what rounding to a lattice can move a foot.

    Attributes:
        stones: the ground.
        parameters: the planner's.
        goal_x: progress of the body that ends a plan [m].
        shrink: how far each coordinate of a foot may be moved afterwards [m].
        edge: what is cut off each side of a stone [m].
    """

    stones: tuple[Stone, ...]
    parameters: FootstepParameters
    goal_x: float
    shrink: float = 0.0
    edge: float = 0.0

    def cost(self, stance: Stance, first_side: Side, most_steps: int) -> float:
        """Least cost over plans of the parameters' fewest steps up to `most_steps`; infinite where there is none."""
        fewest = self.parameters.minimum_steps
        return min(self._cost(stance, first_side, count) for count in range(fewest, most_steps + 1))

    def _cost(self, stance: Stance, first_side: Side, count: int) -> float:
        p, stones = self.parameters, len(self.stones)
        # Columns of a step: x, y, |rise|, |width - ideal|, |off path|, then a binary a stone.
        block = 5 + stones
        program = _Program(count * block)
        for k in range(count):
            sign = (first_side if k % 2 == 0 else first_side.opposite).sign
            self._on_a_stone(program, k * block)
            self._step(program, k, block, stance, first_side, sign)
        sign = (first_side if count % 2 else first_side.opposite).sign
        self._at_goal(program, (count - 1) * block, sign)
        weights = np.tile((0.0, 0.0, p.height_cost, p.width_cost, p.path_cost, *np.zeros(stones)), count)
        integral = np.tile((0, 0, 0, 0, 0, *np.ones(stones)), count)
        low = np.tile((-_BIG, -_BIG, 0.0, 0.0, 0.0, *np.zeros(stones)), count)
        high = np.tile((_BIG, _BIG, _BIG, _BIG, _BIG, *np.ones(stones)), count)
        # SciPy's own stubs know bounds as single numbers.
        constraints = LinearConstraint(np.array(program.rows), program.low, program.high)  # pyright: ignore
        bounds = Bounds(low, high)  # pyright: ignore
        found = milp(weights, constraints=constraints, integrality=integral, bounds=bounds)
        return float(found.fun) + count * p.step_cost if found.success else np.inf

    def _on_a_stone(self, program: _Program, at: int) -> None:
        """The whole sole on the chosen stone."""
        p = self.parameters
        binaries = range(at + 5, at + 5 + len(self.stones))
        program.require(dict.fromkeys(binaries, 1.0), 1.0, 1.0)
        for stone, binary in zip(self.stones, binaries, strict=True):
            for column, centre, size, sole in (
                (at, stone.x, stone.length, p.sole_length),
                (at + 1, stone.y, stone.width, p.sole_width),
            ):
                half = 0.5 * (size - sole) - self.shrink - self.edge
                program.require({column: 1.0, binary: _BIG}, -np.inf, centre + half + _BIG)
                program.require({column: 1.0, binary: -_BIG}, centre - half - _BIG, np.inf)

    def _step(self, program: _Program, k: int, block: int, stance: Stance, first_side: Side, sign: float) -> None:
        """Limits between a step and the foot it is made from."""
        p, at = self.parameters, k * block
        slack = 2 * self.shrink

        def offset(column: int) -> tuple[dict[int, float], float]:
            """A coordinate of the step less that of the foot before."""
            if k > 0:
                return {at + column: 1.0, at - block + column: -1.0}, 0.0
            return {at + column: 1.0}, float(stance.sole(first_side.opposite).p[column])

        length, x0 = offset(0)
        width, y0 = offset(1)
        program.require(length, -p.back_reach + slack + x0, np.inf)
        wide = {column: sign * weight for column, weight in width.items()}
        least, most = p.minimum_width + slack, p.maximum_width - slack
        program.require(wide, least + sign * y0, most + sign * y0)
        # A polygon around the disc where the limits are as they are, into it where they are tightened.
        radius = p.reach - np.sqrt(2) * slack if self.shrink else p.reach / cos(pi / _FACETS)
        radius = radius * cos(pi / _FACETS) if self.shrink else radius
        for facet in range(_FACETS):
            c, s = cos(2 * pi * facet / _FACETS), sin(2 * pi * facet / _FACETS)
            terms = {**{i: c * w for i, w in length.items()}, **{i: s * w for i, w in wide.items()}}
            program.require(terms, -np.inf, radius + s * p.ideal_width + c * x0 + s * sign * y0)
        self._rise(program, k, block, stance, first_side)
        for direction in (-1.0, 1.0):
            terms = {i: direction * w for i, w in wide.items()}
            program.require({**terms, at + 3: -1.0}, -np.inf, direction * (p.ideal_width + sign * y0))
            body = direction * 0.5 * sign * p.ideal_width
            program.require({at + 1: direction, at + 4: -1.0}, -np.inf, body)

    def _rise(self, program: _Program, k: int, block: int, stance: Stance, first_side: Side) -> None:
        p, at = self.parameters, k * block
        heights = {at + 5 + i: stone.z for i, stone in enumerate(self.stones)}
        before = 0.0
        if k > 0:
            heights |= {at - block + 5 + i: -stone.z for i, stone in enumerate(self.stones)}
        else:
            before = float(stance.sole(first_side.opposite).p[2])
        program.require(heights, before - p.max_step_height, before + p.max_step_height)
        for direction in (-1.0, 1.0):
            terms = {i: direction * w for i, w in heights.items()}
            program.require({**terms, at + 2: -1.0}, -np.inf, direction * before)

    def _at_goal(self, program: _Program, at: int, sign: float) -> None:
        """The body inside a polygon around, or into, the half ellipse of the tolerances."""
        p = self.parameters
        scale = cos(pi / _FACETS)
        along, across = p.along_tolerance, p.across_tolerance
        if self.shrink:
            along, across = along * scale - self.shrink, across * scale - self.shrink
        else:
            along, across = along / scale, across / scale
        body = 0.5 * sign * p.ideal_width
        for facet in range(_FACETS + 1):
            angle = pi / 2 + pi * facet / _FACETS
            c, s = cos(angle), sin(angle)
            terms = {at: c / along, at + 1: s / across}
            program.require(terms, -np.inf, 1.0 + c * self.goal_x / along + s * body / across)
