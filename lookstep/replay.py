"""Drives a tree again through a recorded run: the same sensors and operator, all skills computed anew, or played back.

The simulated world is built as it was and moved by the recorded commands, so that what the tree senses is what it
sensed then, to the bit; what the tree says now is written to a second trace and compared. Where an edited tree says
something else to its robot, the recording stops to apply: the recorded robot did not do it.
"""

from __future__ import annotations

import dataclasses
import tempfile
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from behaviors import Executor, ExecutorMode, SettingError, Trace, Tree, TreeSpec, load_tree
from behaviors.following_robot import FollowingRobot
from behaviors.leaf import LeafNode
from behaviors.operator import read_event
from behaviors.played_leaf import Playback, play_back
from behaviors.ports import declared_inputs
from behaviors.recorded_executor import RecordedExecutor
from behaviors.recorded_trace import RecordedTick, RecordedTrace, TraceError
from behaviors.trace_diff import TraceDiff, diff_traces
from behaviors.trace_file import LARGEST_VALUE
from behaviors.values import from_json
from lookstep.configuration import FIXED_SUBJECTS, Configuration, split_assignments, with_assignments
from lookstep.errors import UserError
from lookstep.faults import break_leaves, faulty_robot
from lookstep.run_file import TRACE_FILE, RunFile
from lookstep.trees import tree_path
from lookstep.world import build_world, change_world
from skills.parameters import ParameterError

Progress = Callable[[float, float], None]


@dataclass(frozen=True, slots=True)
class ReplayOptions:
    """How to replay.

    Attributes:
        tree: another tree, by name or file; the recorded one where None.
        assignments: `subject.key=value` and `/node/path.key=value`, over what was recorded.
        outputs: whether leaves say again what they said, instead of computing.
    """

    tree: str | None = None
    assignments: tuple[str, ...] = ()
    outputs: bool = False


@dataclass(frozen=True, slots=True)
class Replayed:
    """What came of it.

    Attributes:
        diff: the recording (first) beside the replay (second).
        strayed: leaves that were asked when the recording did not ask them, and when first [s]; only with `outputs`.
        edited: whether tree or parameters are others than recorded.
    """

    diff: TraceDiff
    strayed: dict[str, float]
    edited: bool


def replay(folder: Path, options: ReplayOptions, progress: Progress = lambda done, total: None) -> Replayed:
    """Replay one run.

    Args:
        folder: where the run has written `run.json` and `trace.jsonl`.
        options: how.
        progress: is told the robot time that is replayed, and that of the whole run [s].

    Raises:
        YamlError, UserError: where recording, tree or settings are not usable.
    """
    recorded = RunFile.read(folder)
    trace = read_trace(folder)
    assignments = split_assignments(options.assignments)
    if assignments.course:
        raise UserError("--set: a replay walks the recorded course; course.* cannot be set")
    configuration = with_assignments(recorded.configuration, assignments.subjects)
    if options.tree is None:
        spec = load_tree(recorded.tree, texts=recorded.sources)
    else:
        spec = load_tree(tree_path(options.tree))
    world = build_world(recorded.course, recorded.configuration, recorded.options.world, recorded.options.seed)
    robot = FollowingRobot(world)
    settings = {**recorded.nodes}
    for path, values in assignments.nodes.items():
        settings[path] = {**settings.get(path, {}), **values}
    with tempfile.TemporaryDirectory() as scratch:
        file = Path(scratch) / TRACE_FILE
        tree = _tree(spec, robot, configuration, settings, trace, recorded, file)
        playback = _play_back(tree, trace, folder) if options.outputs else None
        try:
            fixed = {(change, key) for change, values in assignments.nodes.items() for key in values}
            _drive(tree, robot, world, trace, playback, fixed, progress, follows=options.tree is None)
        finally:
            tree.shutdown()
        diff = diff_traces(trace, RecordedTrace(file))
    edited = options.tree is not None or bool(options.assignments)
    return Replayed(diff, {} if playback is None else playback.strayed, edited)


def read_trace(folder: Path) -> RecordedTrace:
    """The trace of a run's folder.

    Raises:
        UserError: where there is none that can be read.
    """
    try:
        return RecordedTrace(folder / TRACE_FILE)
    except TraceError as error:
        raise UserError(str(error)) from error


def _tree(
    spec: TreeSpec,
    robot: FollowingRobot,
    configuration: Configuration,
    settings: dict[str, Any],
    trace: RecordedTrace,
    recorded: RunFile,
    file: Path,
) -> Tree:
    in_real_time = ExecutorMode(recorded.options.executor) is ExecutorMode.REALTIME
    executor = RecordedExecutor(trace) if in_real_time else Executor()
    try:
        tree = Tree(
            spec,
            faulty_robot(robot, recorded.faults),
            rate=trace.rate,
            executor=executor,
            parameters=configuration.by_subject(),
            fixed=FIXED_SUBJECTS,
            settings=settings,
            trace=Trace(file),
        )
    except (SettingError, ParameterError) as error:
        executor.shutdown()
        raise UserError(f"--set: {error}") from error
    break_leaves(tree, [fault for fault in recorded.faults if fault.at in {node.path for node in tree.nodes}])
    return tree


def _play_back(tree: Tree, trace: RecordedTrace, folder: Path) -> Playback:
    playback = Playback()
    play_back(tree, _outputs(trace), playback)
    written: set[str] = set()
    for tick in trace.ticks():
        written |= {key for key, hashed in tick.ports.items() if hashed is not None and key not in tick.values}
    for node in tree.nodes:
        if not isinstance(node, LeafNode) or node.path in trace.nodes:
            continue
        keys = [slot.key for name, slot in node.leaf.ports.items() if name in declared_inputs(type(node.leaf))]
        for key in written.intersection(keys):
            raise UserError(
                f'{folder}: {node.path} is not in the recording and reads "{key}", whose values are not written out '
                f"(larger than {LARGEST_VALUE} bytes); replay without --outputs"
            )
    return playback


def _outputs(trace: RecordedTrace) -> dict[str, Mapping[str, str]]:
    return {path: node.outputs for path, node in trace.nodes.items()}


def _drive(
    tree: Tree,
    robot: FollowingRobot,
    world: Any,
    trace: RecordedTrace,
    playback: Playback | None,
    fixed: set[tuple[str, str]],
    progress: Progress,
    *,
    follows: bool,
) -> None:
    """Tick the tree through all recorded ticks; where it `follows`, trees take over as they did."""
    end = max((tick.time for tick in trace.ticks()), default=0.0)
    for tick in trace.ticks():
        world.advance(tree.next_tick_time - world.time)
        if follows and tick.taken_over is not None:
            file, texts = tick.taken_over
            tree.reload(load_tree(file, texts=texts))
            if playback is not None:
                play_back(tree, _outputs(trace), playback)
        if playback is not None:
            playback.tick = tick
        _apply(tree, tick, fixed)
        robot.expect(tick.happened("commands"))
        tree.tick()
        change_world(world, tree.context)
        robot.catch_up()
        world.drain_log()
        tree.drain_jobs()
        tree.drain_log()
        progress(tick.time, end)


def _apply(tree: Tree, tick: RecordedTick, fixed: set[tuple[str, str]]) -> None:
    """Let happen what came from outside, apart from changes of what is set otherwise now."""
    for event in tick.happened("operator"):
        tree.send(read_event(event["name"], event["value"]))
    for given in tick.happened("inputs"):
        tree.set_input(given["key"], from_json(given["value"]))
    for change in tick.happened("parameters"):
        if (change["target"], change["key"]) not in fixed:
            try:
                tree.set_parameter(change["target"], change["key"], from_json(change["value"]))
            except SettingError:
                continue  # The edited tree has no such node any more.


def describe_options(recorded: RunFile) -> str:
    """What ran, in one line."""
    options = recorded.options
    return f"{options.tree} on {options.course}, seed {options.seed}, {options.world}, {options.executor}"


def configuration_differences(first: Configuration, second: Configuration) -> list[tuple[str, Any, Any]]:
    """The parameters in which two configurations differ."""
    found = []
    for subject, values in first.by_subject().items():
        others = second.by_subject()[subject]
        for field in dataclasses.fields(values):
            one, other = getattr(values, field.name), getattr(others, field.name)
            if one != other:
                found.append((f"{subject}.{field.name}", one, other))
    return found
