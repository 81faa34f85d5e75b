from dataclasses import dataclass, field
from enum import Enum

import pytest

from skills.parameters import parameter, parameters
from strict_yaml import Node, Problem, dump_parameters, parse_document, read_dataclass


class Gait(Enum):
    WALK = "walk"
    TROT = "trot"


@dataclass(frozen=True, slots=True)
class Foot:
    length: float
    width: float = 0.138


@dataclass(frozen=True, slots=True)
class OneOfEverything:
    name: str
    count: int = 1
    weight: float = field(default=1.0, metadata={"minimum": 0.0, "maximum": 9.0, "unit": "kg"})
    active: bool = False
    gait: Gait = Gait.WALK
    position: tuple[float, float, float] = (0.0, 0.0, 0.0)
    tags: tuple[str, ...] = ()
    limit: float | None = None
    foot: Foot = field(default_factory=lambda: Foot(0.26))
    feet: tuple[Foot, ...] = ()
    raw: Node | None = None
    mode: str = field(default="fast", metadata={"choices": ("fast", "careful")})


@parameters
class Reach:
    """How far a step goes."""

    length: float = parameter(0.5, unit="m", minimum=0.1, maximum=0.7, meaning="longest step")
    tilt: float = parameter(1e-5, unit="rad", minimum=0.0, meaning="steepest ground")
    steps: int = parameter(3, unit="1", minimum=1, meaning="steps a plan")
    mirrored: bool = parameter(False, unit="1", meaning="left for right")
    order: str = parameter("on", unit="1", choices=("on", "by: name"), meaning="which step first")
    window: tuple[float, float] = parameter((2.0, 1.6), unit="m", minimum=0.0, meaning="planned area")


def read(text, cls):
    problems: list[Problem] = []
    instance = read_dataclass(parse_document(text, "f.yaml"), cls, problems)
    assert (instance is None) == bool(problems)
    return instance, "\n".join(str(problem) for problem in sorted(problems))


def test_defaults():
    instance, problems = read("name: a", OneOfEverything)
    assert problems == ""
    assert instance == OneOfEverything("a")


def test_one_of_everything():
    text = """
name: atlas
count: 3
weight: 2
active: true
gait: trot
position: [1, 2.5, -3e-1]
tags: [x, "1"]
limit: ~
foot: {length: 0.3}
feet: [{length: 0.1, width: 0.2}, {length: 1}]
raw: {any: [thing]}
mode: careful
"""
    instance, problems = read(text, OneOfEverything)
    assert problems == ""
    assert instance is not None
    assert instance.raw is not None
    assert instance.raw.keys == ("any",)
    assert instance == OneOfEverything(
        "atlas", 3, 2.0, True, Gait.TROT, (1.0, 2.5, -0.3), ("x", "1"), None, Foot(0.3),
        (Foot(0.1, 0.2), Foot(1.0)), instance.raw, "careful",
    )  # fmt: skip
    assert isinstance(instance.weight, float)


BROKEN = {
    "weight: 99\ncout: 3\ngait: trott\nfeet: [{width: 1}, 3]\nactive: on\n": """\
f.yaml:1:1: missing key "name"
f.yaml:1:9: weight: got 99, allowed: 0 .. 9 kg
f.yaml:2:1: unknown key "cout"; did you mean "count"? (allowed: name, count, weight, active, gait, position, tags, \
limit, foot, feet, raw, mode)
f.yaml:3:7: gait: got "trott"; did you mean "trot"? (allowed: walk, trot)
f.yaml:4:8: feet[0]: missing key "length"
f.yaml:4:20: feet[1]: got 3, needs a mapping with the keys length, width
f.yaml:5:9: active: got "on", needs true or false""",
    "name: 3": "f.yaml:1:7: name: got 3, needs text (quote it)",
    "name:": "f.yaml:1:6: name: got nothing, needs text",
    "name: a\ncount: 1.5": "f.yaml:2:8: count: got 1.5, needs a whole number",
    "name: a\ncount: true": "f.yaml:2:8: count: got true, needs a whole number",
    "name: a\nweight: .nan": "f.yaml:2:9: weight: got nan, needs a finite number",
    "name: a\nposition: [1, 2]": "f.yaml:2:11: position: got a list of 2 values, needs a list of 3 values",
    "name: a\nposition: 7": "f.yaml:2:11: position: got 7, needs a list of 3 values",
    "name: a\nposition: [1, x, 2]": 'f.yaml:2:15: position[1]: got "x", needs a number',
    "name: a\ntags: {a: 1}": "f.yaml:2:7: tags: got a mapping, needs a list",
    "name: a\nmode: fats": 'f.yaml:2:7: mode: got "fats"; did you mean "fast"? (allowed: fast, careful)',
    "[1]": "f.yaml:1:1: got a sequence, needs a mapping with the keys name, count, weight, active, gait, position, "
    "tags, limit, foot, feet, raw, mode",
}


@pytest.mark.parametrize("text", BROKEN)
def test_every_problem_is_told_at_its_own_place(text):
    assert read(text, OneOfEverything)[1] == BROKEN[text]


def test_parameter_ranges_point_at_the_value():
    _, problems = read("length: 0.9\nwindow: [1.0, -2.0]\nsteps: 0\n", Reach)
    assert problems == (
        "f.yaml:1:9: length: got 0.9, allowed: 0.1 .. 0.7 m\n"
        "f.yaml:2:15: window[1]: got -2.0, allowed: 0 .. inf m\n"
        "f.yaml:3:8: steps: got 0, allowed: 1 .. inf"
    )


def test_a_class_that_refuses_its_values_points_at_the_key():
    class Refusal(ValueError):
        key, message = "low", "must lie below high"

    @dataclass(frozen=True)
    class Band:
        low: float
        high: float

        def __post_init__(self) -> None:
            if self.low >= self.high:
                raise Refusal("low: must lie below high")

    assert read("high: 1\nlow: 2\n", Band)[1] == "f.yaml:2:6: low: must lie below high"


def test_dumped_parameters_read_back_the_same():
    for instance in (Reach(), Reach(length=0.3, order="by: name", window=(1.0, 3.0), steps=7)):
        text = dump_parameters(Reach, instance)
        assert read(text, Reach) == (instance, "")


def test_dumped_parameters_tell_unit_range_and_meaning():
    assert dump_parameters(Reach).splitlines() == [
        "length: 0.5         # [m] 0.1 .. 0.7: longest step",
        "tilt: 1e-05         # [rad] 0 .. inf: steepest ground",
        "steps: 3            # 1 .. inf: steps a plan",
        "mirrored: false     # left for right",
        "order: on           # on | by: name: which step first",
        "window: [2.0, 1.6]  # [m] 0 .. inf: planned area",
    ]
