"""The cases: what the walking controller is asked to do, over how many seeds, and how often it should succeed."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from lookstep.bench.walking.known_walks import Cadence, GroundErrors, KnownWalk, block_walk, flat_walk, ridge_walk
from lookstep.bench.walking.pushes import Push, level_force, random_pushes
from lookstep.bench.walking.trial import Trial

DEFAULT, FAST, PAPER = Cadence(0.385, 0.8, 0.3), Cadence(0.4, 0.6, 0.2), Cadence(0.4, 1.2, 0.8)
_FLAT_08, _FLAT_10 = Cadence(0.48, 0.45, 0.15), Cadence(0.5, 0.45, 0.05)
_TURNING, _SHORT, _HIGH = Cadence(0.25, 0.8, 0.3), Cadence(0.3, 0.8, 0.3), Cadence(0.3, 0.8, 0.3)
_TILT, _STEEP, _LEVELS = np.deg2rad(15.0), np.deg2rad(20.0), (0.0, 0.1)
_ERRORS = GroundErrors(height=0.02, tilt=float(np.deg2rad(3.0)))
_COURSE_LENGTH = 20.0
_STEPS = 24
_ANKLE_OF_ATLAS = -1.0
_DIRECTIONS, _PHASES = 8, 4
_PUSHED_STEP = 3
# What the notes of the first prototype call sensor noise.
_STATE_NOISE = {"velocity_noise": 0.05, "joint_rate_noise": 0.1, "joint_noise": 0.002, "position_noise": 0.005}


@dataclass(frozen=True, slots=True)
class Case:
    """One row of the table of successes.

    Attributes:
        name: for programs.
        meaning: for people.
        seeds: how many trials it asks for.
        wanted: share of trials that should succeed.
        trial: makes a trial from its number and a number of steps, None for the case's own.
    """

    name: str
    meaning: str
    seeds: int
    wanted: float
    trial: Callable[[int, int | None], Trial]


def _flat(name: str, cadence: Cadence, turn: float = 0.0) -> Callable[[int, int | None], Trial]:
    def trial(seed: int, steps: int | None) -> Trial:
        rng = np.random.default_rng(seed)
        count = steps or (_STEPS if turn else round(_COURSE_LENGTH / cadence.length) + 1)
        walk = flat_walk(count, cadence, rng, turn=turn)
        return Trial(name, seed, walk, physics={"friction": rng.uniform(0.5, 1.0)})

    return trial


def _blocks(
    name: str,
    cadence: Cadence,
    *,
    tilt: float = _TILT,
    levels: tuple[float, ...] = _LEVELS,
    disturbed: bool = True,
    physics: Mapping[str, float] | None = None,
    ankle_limit: float | None = None,
) -> Callable[[int, int | None], Trial]:
    """Blocks; where disturbed, their poses are off, friction is random and the robot is pushed."""

    def trial(seed: int, steps: int | None) -> Trial:
        rng = np.random.default_rng(seed)
        errors = _ERRORS if disturbed else GroundErrors()
        walk = block_walk(steps or _STEPS, cadence, rng, levels=levels, tilt=tilt, errors=errors)
        pushes: tuple[Push, ...] = ()
        unknown: dict[str, float] = {}
        if disturbed:
            unknown["friction"] = rng.uniform(0.5, 1.0)
            pushes = random_pushes(rng, walk.duration, least=50.0, most=150.0, every=2.0)
        return Trial(name, seed, walk, pushes, unknown | dict(physics or {}), ankle_limit)

    return trial


def _ridges(name: str) -> Callable[[int, int | None], Trial]:
    def trial(seed: int, steps: int | None) -> Trial:
        return Trial(name, seed, ridge_walk(steps or _STEPS - 2, _SHORT, np.random.default_rng(seed), share=0.6))

    return trial


def _pushed(name: str, force: float) -> Callable[[int, int | None], Trial]:
    """Every direction in every phase of one step; directions are counted from the way the robot walks to its left."""

    def trial(number: int, steps: int | None) -> Trial:
        # Staggered, so that a few trials see all phases.
        phase = (number + number // _DIRECTIONS) % _PHASES
        return push_trial(name, force, number % _DIRECTIONS, phase, steps)

    return trial


def push_trial(name: str, force: float, direction: int, phase: int, steps: int | None = None) -> Trial:
    """Walk on level ground at 0.8/0.3 s and be pushed once, in one of 8 directions and one of 4 phases of a step."""
    walk = flat_walk(steps or 9, DEFAULT, np.random.default_rng(0))
    delay = phase / _PHASES * (DEFAULT.swing + DEFAULT.transfer)
    angle = 2.0 * np.pi * direction / _DIRECTIONS
    # The foot that stood on the pushed step's other side is the same in all trials; directions cover both sides.
    push = Push(level_force(force, angle), delay, after_landing=min(_PUSHED_STEP, len(walk.steps) - 3))
    return Trial(name, direction + _DIRECTIONS * phase, walk, (push,))


def _pushed_standing(name: str, force: float) -> Callable[[int, int | None], Trial]:
    def trial(number: int, steps: int | None) -> Trial:
        ground = flat_walk(2, _SHORT, np.random.default_rng(0))
        angle = 2.0 * np.pi * (number % _DIRECTIONS) / _DIRECTIONS
        return Trial(name, number, KnownWalk(ground.course, ()), (Push(level_force(force, angle), 1.0),))

    return trial


def _rows() -> Iterator[Case]:
    yield Case("flat_0.8", "level, 0.8 m/s over 20 m", 10, 1.0, _flat("flat_0.8", _FLAT_08))
    yield Case("flat_1.0", "level, 1.0 m/s over 20 m", 10, 1.0, _flat("flat_1.0", _FLAT_10))
    yield Case("turning", "level, 0.4 rad a step", 10, 1.0, _flat("turning", _TURNING, turn=0.4))
    for speed, cadence, seeds, wanted in (
        ("0.35", DEFAULT, 60, 0.97),
        ("0.5", FAST, 60, 0.9),
        ("paper", PAPER, 20, 1.0),
    ):
        timing = f"{cadence.speed:.2f} m/s, {cadence.swing:g}/{cadence.transfer:g} s"
        name = f"tilted_{speed}"
        yield Case(name, f"tilted 15 deg, {timing}", seeds, wanted, _blocks(name, cadence))
        name = f"tilted_{speed}_ankle"
        limited = _blocks(name, cadence, ankle_limit=_ANKLE_OF_ATLAS)
        yield Case(name, f"tilted 15 deg, {timing}, ankle -1.0 rad", seeds, wanted, limited)
    level = _blocks("level_0.2", _HIGH, tilt=0.0, levels=(0.0, 0.2), disturbed=False)
    yield Case("level_0.2", "level blocks, 0.2 m up and down, 0.8/0.3 s", 20, 1.0, level)
    steep = _blocks("tilted_20", _SHORT, tilt=_STEEP, disturbed=False)
    yield Case("tilted_20", "tilted 20 deg, 0.8/0.3 s", 20, 1.0, steep)
    for force, wanted in ((400, 0.9), (600, 0.75)):
        name = f"push_{force}"
        meaning = f"{force} N x 0.1 s walking, 8 directions x 4 phases"
        yield Case(name, meaning, _DIRECTIONS * _PHASES, wanted, _pushed(name, force))
    standing = _pushed_standing("push_standing_600", 600.0)
    yield Case("push_standing_600", "600 N x 0.1 s standing, 8 directions", _DIRECTIONS, 1.0, standing)
    for name, meaning, physics in (
        ("delay", "tilted 15 deg, 0.35 m/s, torques 5 ms late", {"torque_delay": 0.005}),
        ("noise", "tilted 15 deg, 0.35 m/s, noisy state", _STATE_NOISE),
        ("heavy", "tilted 15 deg, 0.35 m/s, torso 15 % heavier", {"torso_mass_error": 0.15}),
        ("light", "tilted 15 deg, 0.35 m/s, torso 15 % lighter", {"torso_mass_error": -0.15}),
    ):
        yield Case(name, meaning, 20, 0.97, _blocks(name, DEFAULT, physics=physics))
    exact = _blocks("footholds", DEFAULT, disturbed=False)
    yield Case("footholds", "tilted 15 deg, 0.35 m/s, undisturbed", 10, 1.0, exact)
    yield Case("ridges", "20 ridges of 60 % of the sole, 0.8/0.3 s", 5, 1.0, _ridges("ridges"))


CASES: Mapping[str, Case] = {case.name: case for case in _rows()}
