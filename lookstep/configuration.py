"""Every parameter of a run, gathered from the classes, the config files, the robot, a preset and the command line.

Precedence, weakest first: default of the class < `config/<subject>.yaml` < `config/robots/<robot>.yaml` < preset <
`--set subject.key=value`. Tree nodes and `--set /node/path.key=value` override parameters of single leaves; the tree
loader applies those.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, get_type_hints

from behaviors.operator import ReviewParameters
from lookstep.control_health import ControlHealthParameters
from lookstep.operator_link import OperatorLinkParameters
from lookstep.options import DEFAULT_ROBOT
from sim_envs.judge import JudgeParameters
from sim_envs.robot import SHIPPED_ROBOTS, RobotDescription
from sim_envs.sensors import DepthCameraParameters, DepthNoise, LidarNoise, LidarParameters
from sim_envs.worlds import (
    FallParameters,
    KinematicParameters,
    PhysicsParameters,
    StateDriftParameters,
    WorldParameters,
)
from skills.body_path import BodyPathParameters, ImpassabilityParameters, SubGoalParameters
from skills.footsteps import FootstepParameters, TerrainParameters
from skills.height_map import HeightMapParameters
from skills.regions import MemoryParameters, RegionParameters, RegistrationParameters
from skills.walking import (
    StepAdjustmentParameters,
    SwingParameters,
    WalkerParameters,
    WalkingParameters,
    WholeBodyParameters,
)
from strict_yaml import (
    Entry,
    Kind,
    Location,
    Node,
    Problem,
    YamlError,
    dump_parameters,
    load_document,
    nearest,
    parse_document,
    read_dataclass,
    shipped_folder,
)

_COURSE = "course."


@dataclass(frozen=True)
class Configuration:
    """The parameters of every subject, validated.

    Attributes: one typed class a subject; each states default, unit, range and meaning of its parameters.
    """

    robot: RobotDescription
    camera: DepthCameraParameters
    noise: DepthNoise
    lidar: LidarParameters
    lidar_noise: LidarNoise
    world: WorldParameters
    physics: PhysicsParameters
    kinematic: KinematicParameters
    drift: StateDriftParameters
    falls: FallParameters
    judge: JudgeParameters
    walking: WalkingParameters
    swing: SwingParameters
    whole_body: WholeBodyParameters
    step_adjustment: StepAdjustmentParameters
    control_health: ControlHealthParameters
    regions: RegionParameters
    region_memory: MemoryParameters
    height_map: HeightMapParameters
    registration: RegistrationParameters
    body_path: BodyPathParameters
    sub_goal: SubGoalParameters
    footsteps: FootstepParameters
    terrain: TerrainParameters
    impassability: ImpassabilityParameters
    review: ReviewParameters
    operator_link: OperatorLinkParameters

    @property
    def walker(self) -> WalkerParameters:
        """All settings of the walking controller."""
        return WalkerParameters(
            walking=self.walking,
            swing=self.swing,
            whole_body=self.whole_body,
            step_adjustment=self.step_adjustment,
        )

    def by_subject(self) -> dict[str, Any]:
        """The typed parameters by the name of their subject."""
        return {subject: getattr(self, subject) for subject in SUBJECTS}


@dataclass(frozen=True, slots=True)
class Assignments:
    """What `--set` was given, by what it is for.

    Attributes:
        subjects: `subject.key=value`.
        course: options of the course's generator by name.
        nodes: values of `/node/path.key=value` by path and key.
    """

    subjects: tuple[str, ...] = ()
    course: Mapping[str, Any] = dataclasses.field(default_factory=dict)
    nodes: Mapping[str, Mapping[str, Any]] = dataclasses.field(default_factory=dict)


SUBJECTS: Mapping[str, type] = get_type_hints(Configuration)
# Those that are taken when a run begins: of the simulated world, and of what is under way since then.
FIXED_SUBJECTS = (
    *("robot", "camera", "noise", "lidar", "lidar_noise", "world", "physics", "kinematic", "drift", "falls", "judge"),
    *("walking", "swing", "whole_body", "height_map"),
)


def load_configuration(
    preset: str | None = None, assignments: Iterable[str] = (), robot: str = DEFAULT_ROBOT
) -> Configuration:
    """Read the shipped config, a robot, presets and `subject.key=value` assignments; later ones win.

    Args:
        preset: shipped names or files, joined by commas.
        assignments: each `subject.key=value`.
        robot: a shipped name or a file.

    Raises:
        YamlError: with every problem found, each at its place; an assignment's place is `--set`.
    """
    problems: list[Problem] = []
    layers = [
        _config_files(),
        _robot(robot, problems),
        *(_named_layer("preset", name, problems)[1] for name in (preset.split(",") if preset else ())),
        _assignments(assignments, problems),
    ]
    instances = {}
    for subject, cls in SUBJECTS.items():
        merged = _merge([layer[subject] for layer in layers if subject in layer], subject)
        instances[subject] = read_dataclass(merged, cls, problems, subject)
    if problems:
        raise YamlError(problems)
    return Configuration(**instances)


def with_assignments(configuration: Configuration, assignments: Iterable[str]) -> Configuration:
    """A configuration with `subject.key=value` assignments over it.

    Raises:
        YamlError: with every problem found.
    """
    problems: list[Problem] = []
    instances = configuration.by_subject()
    for subject, node in _assignments(assignments, problems).items():
        read = read_dataclass(node, SUBJECTS[subject], problems, subject)
        if read is not None:
            given = {key: getattr(read, key) for key in node.keys}
            instances[subject] = dataclasses.replace(instances[subject], **given)
    if problems:
        raise YamlError(problems)
    return Configuration(**instances)


def split_assignments(assignments: Iterable[str]) -> Assignments:
    """Sort `--set` assignments by what they are for."""
    subjects: list[str] = []
    course: dict[str, Any] = {}
    nodes: dict[str, dict[str, Any]] = {}
    for text in assignments:
        target, _, value = text.partition("=")
        if not target.startswith((_COURSE, "/")):
            subjects.append(text)
            continue
        owner, _, key = target.strip().rpartition(".")
        parsed = parse_document(value, f"--set {text}").value
        if target.startswith("/"):
            nodes.setdefault(owner, {})[key] = parsed
        else:
            course[key] = parsed
    return Assignments(tuple(subjects), course, nodes)


def preset_names() -> tuple[str, ...]:
    """The shipped presets."""
    return _names("preset")


def robot_names() -> tuple[str, ...]:
    """The shipped robots."""
    return _names("robot")


def _names(kind: str) -> tuple[str, ...]:
    return tuple(sorted(path.stem for path in _folder(kind).glob("*.yaml")))


def _folder(kind: str) -> Path:
    return shipped_folder("config") / f"{kind}s"


def _config_files() -> dict[str, Node]:
    folder = shipped_folder("config")
    return {subject: load_document(folder / f"{subject}.yaml") for subject in SUBJECTS}


def _robot(robot: str, problems: list[Problem]) -> dict[str, Node]:
    """The layer of a robot, its MJCF file beside the YAML file where it is not a shipped one."""
    path, layer = _named_layer("robot", robot, problems)
    table = layer.get("robot")
    mjcf = None if table is None else table.get("mjcf")
    if table is None or mjcf is None or not isinstance(mjcf.value, str):
        return layer
    beside = path.parent / mjcf.value
    if beside.is_file():
        there = Entry("mjcf", mjcf.location, dataclasses.replace(mjcf, value=str(beside.resolve())))
        layer["robot"] = _merge([table, _mapping(table.location, (there,))], "robot")
    elif not (SHIPPED_ROBOTS / mjcf.value).is_file():
        message = f"there is no MJCF file {mjcf.value!r}, neither beside this file nor in {SHIPPED_ROBOTS}"
        problems.append(Problem(mjcf.location, message, "robot.mjcf"))
    return layer


def _named_layer(kind: str, name: str, problems: list[Problem]) -> tuple[Path, dict[str, Node]]:
    """The file of a preset or robot, and what it says of each subject."""
    names = _names(kind)
    path = _folder(kind) / f"{name}.yaml" if name in names else Path(name)
    if name not in names and path.suffix != ".yaml":
        place = Location(f"--{kind}", 0, 0)
        message = f'unknown {kind} "{name}"{nearest(name, names)} ({kind}s: {", ".join(names)}, or a .yaml file)'
        raise YamlError([Problem(place, message)])
    layer = {}
    for subject, location, node in load_document(path).entries:
        if subject in SUBJECTS:
            layer[subject] = node
        else:
            problems.append(_unknown_subject(subject, location))
    return path, layer


def _assignments(assignments: Iterable[str], problems: list[Problem]) -> dict[str, Node]:
    layer: dict[str, Node] = {}
    for text in assignments:
        place = Location(f"--set {text}", 0, 0)
        key, equals, value = text.partition("=")
        subject, dot, name = key.strip().partition(".")
        if not (equals and dot and name):
            problems.append(Problem(place, "needs the form subject.key=value, such as footsteps.max_step_height=0.3"))
        elif subject not in SUBJECTS:
            problems.append(_unknown_subject(subject, place))
        else:
            entry = Entry(name, place, dataclasses.replace(parse_document(value, place.file), location=place))
            layer[subject] = (
                _merge([layer[subject], _mapping(place, (entry,))], subject)
                if subject in layer
                else (_mapping(place, (entry,)))
            )
    return layer


def _unknown_subject(subject: str, location: Location) -> Problem:
    allowed = ", ".join(SUBJECTS)
    return Problem(location, f'unknown subject "{subject}"{nearest(subject, SUBJECTS)} (subjects: {allowed})')


def _mapping(location: Location, entries: tuple[Entry, ...]) -> Node:
    return Node(Kind.MAPPING, location, entries=entries)


def _merge(nodes: list[Node], subject: str) -> Node:
    """One mapping in which later nodes win key by key; a node that is no mapping stands alone, to be told as wrong."""
    entries: dict[str, Entry] = {}
    for node in nodes:
        if node.kind is not Kind.MAPPING:
            return node
        entries.update({entry.key: entry for entry in node.entries})
    location = nodes[-1].location if nodes else Location(subject, 0, 0)
    return _mapping(location, tuple(entries.values()))


def config_files() -> dict[str, str]:
    """The text of every shipped config file by its name, as the classes make it."""
    return {f"{subject}.yaml": f"# {_first_line(cls)}\n{dump_parameters(cls)}" for subject, cls in SUBJECTS.items()}


def _first_line(cls: type) -> str:
    return (cls.__doc__ or "").strip().splitlines()[0]


if __name__ == "__main__":
    # Writes config/*.yaml anew after a parameter class has changed; a test holds the files to the classes.
    for _name, _text in config_files().items():
        (shipped_folder("config") / _name).write_text(_text)
