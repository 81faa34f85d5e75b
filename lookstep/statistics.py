"""Watches a run and gathers its figures: steps and support judged on the truth, pauses, compute times, view."""

from __future__ import annotations

import dataclasses
from collections import Counter
from typing import Any

import numpy as np

from behaviors import Outcome
from behaviors.halt import HaltCause
from lookstep.carrot import LateralError
from lookstep.configuration import Configuration
from lookstep.control_health import ControlHealth
from lookstep.deadlines import DeadlineAccounts
from lookstep.moment import Moment
from lookstep.summary import Figures, PauseCounts, SkillTiming
from sim_envs.courses import Ground
from sim_envs.judge import (
    BoxMoved,
    PhaseSample,
    StepJudgement,
    TrueStep,
    count_steps,
    find_pauses,
    judge_step,
    support_fraction,
)
from sim_envs.worlds import SimulatedWorld
from skills.footsteps import FootstepPlan, PlanOutcome, Stance
from skills.geometry import Array, Pose, contains_points
from skills.regions import PlanarRegions, RegionExtraction
from skills.walking import StepEvent, StepEventKind, WalkingPhase

# A foothold is in view where points of its sole, this share of the way to its corners, lie on regions this near.
_VIEW_SHARE = 0.8
_VIEW_DISTANCE = 0.03
_FRAMES_KEPT = 30


class Statistics:
    """An observer that ends up with the figures of the run."""

    def __init__(self, world: SimulatedWorld, configuration: Configuration, health: ControlHealth) -> None:
        self._health = health
        self._course = world.course
        self._sole_size = (configuration.robot.sole_length, configuration.robot.sole_width)
        self._corners_sole = configuration.robot.sole_corners_sole
        self._judge = configuration.judge
        self._nominal_transfer = configuration.footsteps.transfer_duration
        self._box_poses = world.box_poses()
        self._ground = Ground(self._course.boxes)
        self._moves: list[BoxMoved] = []
        self._phases: list[PhaseSample] = []
        self._judgements: list[StepJudgement] = []
        self._footholds = world.true_state().stance
        self._lift_off_times: dict[int, float] = {}
        self._supports: dict[int, float] = {}
        self._foothold_errors: list[float] = []
        # Compute time and budget of each job [s]; the jobs themselves hold images.
        self._jobs: dict[str, list[tuple[float, float]]] = {"PlanFootsteps": [], "ExtractRegions": []}
        self._accounts = DeadlineAccounts()
        self._frames: dict[int, PlanarRegions] = {}
        self._last_plan: FootstepPlan | None = None
        self._lateral_error = LateralError(world.course.carrot)
        self._in_view: list[bool] = []
        self._gave_up = False
        self._first_time = self._last_time = world.time
        self._first_transfer_time: float | None = None
        # When and where (mid-feet) the first foot lifted off and the last one landed, on the truth.
        self._lift_off: tuple[float, Array] | None = None
        self._touchdown: tuple[float, Array] | None = None
        self._start_world = self._end_world = world.true_state().stance.mid_feet

    def observe(self, moment: Moment) -> None:
        """Take note of one tick."""
        self._last_time, self._end_world = moment.time, moment.state.stance.mid_feet
        self._gave_up = moment.tree.outcome is Outcome.FAILURE and moment.blocked
        self._lateral_error.observe(moment)
        self._note_moved_boxes(moment)
        self._note_phase(moment)
        for event in moment.events:
            self._note_step(event, moment.state.stance)
        self._note_support(moment)
        self._accounts.take(moment.jobs)
        for job in moment.jobs:
            kind = moment.tree.node(job.path).kind
            if kind in self._jobs and job.compute_seconds is not None:
                self._jobs[kind].append((job.compute_seconds, job.budget))
        for value in moment.tree.blackboard.values().values():
            self._note_value(value)

    def figures(self) -> Figures:
        """The figures so far."""
        duration = self._last_time - self._first_time
        distance = float(np.linalg.norm((self._end_world - self._start_world)[:2]))
        pauses = find_pauses(self._explained_phases(), self._nominal_transfer, self._judge)
        lift_off, touchdown = self._lift_off, self._touchdown
        return Figures(
            duration_s=round(duration, 3),
            distance_m=round(distance, 3),
            speed_mps=round(distance / duration, 4) if duration > 0 else 0.0,
            walking_speed_mps=None if lift_off is None or touchdown is None else _speed(lift_off, touchdown),
            steps=count_steps(self._judgements),
            pauses=PauseCounts(
                count=len(pauses),
                total_s=round(sum(pause.duration for pause in pauses), 3),
                causes=dict(sorted(Counter(pause.cause.value for pause in pauses).items())),
            ),
            first_transfer_after_s=self._after_goal(self._first_transfer_time),
            first_step_after_s=None if lift_off is None else self._after_goal(lift_off[0]),
            plan=_timing(self._jobs["PlanFootsteps"]),
            regions=_timing(self._jobs["ExtractRegions"]),
            deadlines=self._accounts.report(),
            min_support_fraction=min(self._supports.values(), default=None),
            view_fraction=round(float(np.mean(self._in_view)), 4) if self._in_view else None,
            lateral_error_m=self._lateral_error.mean,
            foothold_error_m=round(float(np.median(self._foothold_errors)), 6) if self._foothold_errors else None,
            control=self._health.figures(),
        )

    def _explained_phases(self) -> list[PhaseSample]:
        """The phases; whoever has found in the end that the way is blocked has waited for that since the last step."""
        since = self._first_time if self._touchdown is None else self._touchdown[0]
        if not self._gave_up:
            return self._phases
        return [dataclasses.replace(sample, blocked=sample.blocked or sample.time >= since) for sample in self._phases]

    def _after_goal(self, time: float | None) -> float | None:
        return None if time is None else round(time - self._first_time, 3)

    def _note_moved_boxes(self, moment: Moment) -> None:
        poses = moment.world.box_poses()
        if poses == self._box_poses:
            return
        feet = moment.state.stance.mid_feet
        for name, pose in poses.items():
            if pose != self._box_poses[name]:
                distance = float(np.hypot(*(np.array(self._box_poses[name][0][:2]) - feet[:2])))
                self._moves.append(BoxMoved(name, moment.time, distance))
        self._box_poses = poses
        placed = [Pose.from_quaternion_wxyz(wxyz, position) for position, wxyz in poses.values()]
        self._ground = Ground(self._course.boxes, placed)

    def _note_phase(self, moment: Moment) -> None:
        status = moment.status
        if status.phase is WalkingPhase.TRANSFER and self._first_transfer_time is None:
            self._first_transfer_time = moment.time
        overdue = status.phase is WalkingPhase.TRANSFER and status.phase_elapsed > status.phase_duration + 1e-6
        last = self._last_plan
        arrived = last is not None and last.outcome is PlanOutcome.GOAL_REACHED and status.current_step is None
        causes = {halt.cause for halt in moment.tree.context.halts}
        self._phases.append(
            PhaseSample(
                moment.time,
                status.phase,
                transfer_overdue=overdue,
                goal_active=not arrived,
                blocked=HaltCause.BLOCKED in causes,
                in_review=HaltCause.REVIEW in causes,
                paused=HaltCause.OPERATOR in causes,
                old_data=HaltCause.OLD_DATA in causes,
            )
        )

    def _note_step(self, event: StepEvent, true_stance: Stance) -> None:
        step = event.step
        if event.kind is StepEventKind.STARTED:
            if self._lift_off is None:
                self._lift_off = (event.time, self._footholds.mid_feet)
            self._lift_off_times[step.sequence_id] = event.time
            return
        self._foothold_errors.append(float(np.linalg.norm(event.T_world_sole.p - step.T_world_sole.p)))
        # Events are the robot's estimate, the judge takes the truth, at the end of the tick in which the foot landed.
        landed = true_stance.sole(step.side)
        # A step begins where its foot landed last: at lift-off the heel may be up already.
        true_step = TrueStep(
            sequence_id=step.sequence_id,
            side=step.side,
            start_time=self._lift_off_times.pop(step.sequence_id),
            end_time=event.time,
            T_world_stance=self._footholds.sole(step.side.opposite),
            T_world_swing_start=self._footholds.sole(step.side),
            T_world_swing_end=landed,
        )
        self._footholds = self._footholds.with_sole(step.side, landed)
        self._touchdown = (event.time, self._footholds.mid_feet)
        self._judgements.append(judge_step(true_step, self._sole_size, self._ground, self._moves, self._judge))

    def _note_support(self, moment: Moment) -> None:
        """Measure the stance sole once in the middle of each swing."""
        status = moment.status
        if status.phase is not WalkingPhase.SWING or status.current_step is None:
            return
        step = status.current_step
        if status.phase_elapsed < 0.5 * status.phase_duration or step.sequence_id in self._supports:
            return
        sole = moment.state.stance.sole(step.side.opposite)
        self._supports[step.sequence_id] = support_fraction(sole, self._sole_size, self._ground, self._judge)

    def _note_value(self, value: Any) -> None:
        if isinstance(value, RegionExtraction):
            self._frames[value.regions.frame_id] = value.regions
            while len(self._frames) > _FRAMES_KEPT:
                self._frames.pop(next(iter(self._frames)))
        elif isinstance(value, FootstepPlan) and value is not self._last_plan:
            self._last_plan = value
            frame = self._frames.get(value.frame_id)
            if frame is not None:
                self._in_view.append(all(self._is_in_view(step.T_world_sole, frame) for step in value.steps))

    def _is_in_view(self, T_world_sole: Pose, frame: PlanarRegions) -> bool:
        corners = np.column_stack((_VIEW_SHARE * self._corners_sole, np.zeros(4)))
        points = T_world_sole @ np.vstack((corners, np.zeros(3)))
        return bool(np.all(_on_regions(points, frame)))


def _on_regions(points_world: Array, regions: PlanarRegions) -> Array:
    """Which points (N, 3) lie on one of the regions, (N,) bool."""
    found = np.zeros(len(points_world), dtype=bool)
    for region in regions.regions:
        points = region.T_world_region.inverse @ points_world
        near = np.abs(points[:, 2]) <= _VIEW_DISTANCE
        found |= near & contains_points(region.hull_region, points[:, :2])
    return found


def _speed(start: tuple[float, Array], end: tuple[float, Array]) -> float:
    """Straight way over time between two (time, place)."""
    return round(float(np.linalg.norm((end[1] - start[1])[:2])) / (end[0] - start[0]), 4)


def _timing(jobs: list[tuple[float, float]]) -> SkillTiming:
    return SkillTiming.of([compute for compute, _ in jobs], [budget for _, budget in jobs])
