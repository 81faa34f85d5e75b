"""One walk: a world, a robot in it, a tree that drives it, and those who watch, ticked on the robot's clock.

world.advance(tick period) -> tree.tick() -> recording, statistics and progress observe
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from behaviors import Executor, ExecutorMode, OperatorInbox, Robot, SettingError, Trace, Tree, TreeSpec, load_tree
from behaviors import Outcome as TreeOutcome
from behaviors.faults import Fault
from behaviors.operator import ReviewParameters, SendGoal
from lookstep.carrot import CarrotLeader
from lookstep.configuration import FIXED_SUBJECTS, Assignments, Configuration, load_configuration, split_assignments
from lookstep.control_health import ControlHealth
from lookstep.errors import UserError
from lookstep.faults import break_leaves, faulty_course, faulty_inbox, faulty_robot, load_faults
from lookstep.live import LiveParameters
from lookstep.moment import Moment, Observer
from lookstep.options import RunOptions
from lookstep.pace import Pace
from lookstep.plan_log import PlanRecorder
from lookstep.run_file import RUN_FILE, TRACE_FILE, RunFile
from lookstep.statistics import Statistics
from lookstep.summary import Outcome, Summary, installed_versions
from lookstep.tree_reload import TreeReload
from lookstep.trees import tree_path
from lookstep.warm_up import warm_up
from lookstep.world import build_world, change_world
from sim_envs.courses import Course, CourseError, load_course
from sim_envs.worlds import SimulatedWorld
from skills.body_path import Goal
from skills.parameters import ParameterError
from skills.walking import WalkingPhase

TICK_RATE = 50.0
# Why a run has ended that somebody has broken off.
INTERRUPTED = "stopped by the operator"
_FILM_MOST = 50.0  # [Hz]
_AFTERMATH = 2.0  # An operated run goes on so long after its end: the robot finishes its step, or its fall [s].


def walk(
    options: RunOptions, *observers: Observer, inbox: OperatorInbox | None = None, pace: Pace | None = None
) -> Summary:
    """Walk once.

    Args:
        options: what to run.
        observers: watch besides recording and statistics.
        inbox: takes events of the operator, from any thread.
        pace: holds robot time back; by the options' speed where None.

    Raises:
        YamlError, UserError: where the input is not usable; nothing has been written then.
    """
    assignments, configuration, spec, course = _inputs(options)
    faults = () if options.faults is None else load_faults(options.faults, course)
    course = faulty_course(course, faults)
    inbox = inbox or OperatorInbox()
    world = build_world(course, configuration, options.world, options.seed)
    tree = _tree(spec, faulty_robot(world, faults), configuration, assignments, options, faulty_inbox(inbox, faults))
    break_leaves(tree, faults)
    # From here on the input is known to be good.
    for folder in filter(None, (options.out, options.plans, options.record and options.record.parent)):
        folder.mkdir(parents=True, exist_ok=True)
    if options.out is not None:
        tree.trace = Trace(options.out / TRACE_FILE)
        run_file = RunFile(
            options=options,
            configuration=configuration,
            course=course,
            goal=options.goal or course.goal,
            nodes=assignments.nodes,
            faults=faults,
            tree=spec.file,
            sources=spec.sources,
            versions=installed_versions(),
        )
        run_file.write(options.out / RUN_FILE)
    warm_up(configuration)
    health = ControlHealth(configuration.control_health)
    statistics = Statistics(world, configuration, health)
    watching: list[Observer] = [statistics, *observers]
    recording = None
    if options.record is not None:
        from lookstep.recording import Recording

        about = _about(options)
        recording = Recording(options.record, world, tree, configuration.robot, about, options.seed, options.film)
        watching.append(recording)
    plans = None
    if options.plans is not None:
        plans = PlanRecorder(options.plans)
        watching.append(plans)
    try:
        pace = pace or Pace(_speed(options))
        ending = _loop(world, tree, health, watching, options, pace, configuration.judge.goal_distance, faults)
    finally:
        tree.shutdown()
        if recording is not None:
            recording.close()
        if plans is not None:
            plans.close()
    summary = _summarise(ending, statistics, tree, options, course)
    if options.out is not None:
        summary.write(options.out / "summary.json")
    return summary


def check_options(options: RunOptions) -> None:
    """See whether a walk has all it needs before one of many is made.

    Raises:
        YamlError, UserError: where the options, a file or a name are not usable.
    """
    _inputs(options)


def _inputs(options: RunOptions) -> tuple[Assignments, Configuration, TreeSpec, Course]:
    """What the options name, read."""
    _check(options)
    assignments = split_assignments(options.assignments)
    configuration = load_configuration(options.preset, (*_review(options), *assignments.subjects), options.robot)
    return assignments, configuration, load_tree(tree_path(options.tree)), _course(options, assignments.course)


@dataclass(frozen=True, slots=True)
class _Ending:
    outcome: Outcome
    reason: str
    wall_s: float


def _loop(
    world: SimulatedWorld,
    tree: Tree,
    health: ControlHealth,
    watching: list[Observer],
    options: RunOptions,
    pace: Pace,
    goal_distance: float,
    faults: Sequence[Fault],
) -> _Ending:
    goal = Goal(*(options.goal or world.course.goal))
    watches: list[LiveParameters | TreeReload | CarrotLeader] = []
    if world.course.carrot is not None:
        watches.append(CarrotLeader(world.course.carrot, tree))
    if options.live is not None:
        watches.append(LiveParameters(options.live, tree))
    if options.reload:
        watches.append(TreeReload(tree, lambda reloaded: break_leaves(reloaded, faults)))
    if options.goal is not None or not options.operated:
        tree.send(SendGoal(goal))
    outcome, reason, ended = None, "", float("inf")
    try:
        while outcome is None or (options.operated and world.time < ended + _AFTERMATH):
            pace.wait_to_go()
            world.advance(tree.next_tick_time - world.time)
            pace.wait_until(world.time)
            for watch in watches:
                watch.poll()
            tree.tick()
            change_world(world, tree.context)
            moment = _moment(world, tree, health)
            for observer in watching:
                observer.observe(moment)
            if outcome is None:
                outcome, reason = _ending(moment, options.time_limit)
                ended = world.time
    except KeyboardInterrupt:
        return _Ending(Outcome.STOPPED, INTERRUPTED, pace.elapsed)
    rest = _distance_to_goal(world, tree, goal)
    if outcome is Outcome.GOAL_REACHED and rest > goal_distance:
        outcome, reason = Outcome.STOPPED, f"the tree has succeeded {rest:.2f} m from the goal"
    return _Ending(outcome, reason, pace.elapsed)


def _distance_to_goal(world: SimulatedWorld, tree: Tree, sent: Goal) -> float:
    """How far the robot is from the nearest goal that the tree holds; from the one it was sent where it holds none."""
    feet = world.true_state().stance.mid_feet[:2]
    goals = [value for value in tree.blackboard.values().values() if isinstance(value, Goal)] or [sent]
    return min(float(np.hypot(*(feet - (goal.x, goal.y)))) for goal in goals)


def _moment(world: SimulatedWorld, tree: Tree, health: ControlHealth) -> Moment:
    samples = world.drain_log()
    return Moment(
        time=world.time,
        world=world,
        tree=tree,
        state=world.true_state(),
        status=world.status(),
        events=tree.context.events,
        samples=samples,
        jobs=tree.drain_jobs(),
        log=(*tree.drain_log(), *health.watch(samples)),
    )


def _ending(moment: Moment, time_limit: float) -> tuple[Outcome | None, str]:
    """Whether the run ends with this tick, and why."""
    tree = moment.tree
    if tree.outcome is TreeOutcome.ERROR:
        return Outcome.ERROR, tree.reason
    if moment.status.phase is WalkingPhase.FALLEN:
        return Outcome.FELL, moment.status.failure
    if tree.outcome is TreeOutcome.SUCCESS:
        return Outcome.GOAL_REACHED, "the robot stands at the goal"
    if tree.outcome in (TreeOutcome.FAILURE, TreeOutcome.STOPPED):
        return (Outcome.BLOCKED if moment.blocked else Outcome.STOPPED), tree.reason
    if moment.time >= time_limit:
        return Outcome.TIMEOUT, f"{time_limit:g} s are over; last: {tree.root.reason or 'walking'}"
    return None, ""


def _speed(options: RunOptions) -> float | None:
    if options.speed is None and options.executor == ExecutorMode.REALTIME.value:
        return 1.0
    return options.speed


def _check(options: RunOptions) -> None:
    if options.speed is not None and not options.speed > 0.0:
        raise UserError(f"--speed: got {options.speed}, needs a positive number")
    if options.film is not None and (options.record is None or not 0.0 < options.film <= _FILM_MOST):
        raise UserError(f"--film: got {options.film}, needs a rate up to {_FILM_MOST:g} pictures a second and --record")
    if not options.time_limit > 0.0:
        raise UserError(f"--time-limit: got {options.time_limit}, needs a positive number of seconds")
    if options.seed < 0:
        raise UserError(f"--seed: got {options.seed}, needs a whole number from 0")
    for name, folder in (("out", options.out), ("plans", options.plans)):
        if folder is not None and folder.exists() and not folder.is_dir():
            raise UserError(f"--{name} {folder}: is a file, needs a folder")


def _review(options: RunOptions) -> tuple[str, ...]:
    """Checkpoints ask by default, as on a robot; in a simulated run only where somebody is there to answer."""
    return (
        () if options.review else tuple(f"review.{field.name}=false" for field in dataclasses.fields(ReviewParameters))
    )


def _course(options: RunOptions, course_options: Mapping[str, Any]) -> Course:
    try:
        return load_course(options.course, seed=options.seed, **course_options)
    except (CourseError, ParameterError) as error:
        raise UserError(f"course: {error}") from error


def _tree(
    spec: TreeSpec,
    robot: Robot,
    configuration: Configuration,
    assignments: Assignments,
    options: RunOptions,
    inbox: OperatorInbox,
) -> Tree:
    executor = Executor(ExecutorMode(options.executor))
    try:
        return Tree(
            spec,
            robot,
            rate=TICK_RATE,
            executor=executor,
            parameters=configuration.by_subject(),
            fixed=FIXED_SUBJECTS,
            settings=assignments.nodes,
            inbox=inbox,
        )
    except (SettingError, ParameterError) as error:
        executor.shutdown()
        raise UserError(f"--set: {error}") from error


def _about(options: RunOptions) -> str:
    """The page of a recording that says what ran."""
    rows = [f"| {field.name} | {getattr(options, field.name)} |" for field in dataclasses.fields(options)]
    return "\n".join(("# What ran", "", "| option | value |", "|---|---|", *rows))


def _summarise(ending: _Ending, statistics: Statistics, tree: Tree, options: RunOptions, course: Course) -> Summary:
    figures = statistics.figures()
    return Summary(
        outcome=ending.outcome,
        reason=ending.reason,
        course=course.name,
        tree=tree.spec.name,
        world=options.world,
        executor=options.executor,
        robot=options.robot,
        preset=options.preset,
        seed=options.seed,
        wall_s=round(ending.wall_s, 3),
        versions=installed_versions(),
        trace_hash=tree.trace.hash,
        **{field.name: getattr(figures, field.name) for field in dataclasses.fields(figures)},
    )
