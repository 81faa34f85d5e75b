"""What to run: the options of one walk, as the command line and Python give them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

DEFAULT_ROBOT = "atlas_class"
WORLDS = ("physics", "kinematic")
EXECUTORS = ("lockstep", "realtime")


@dataclass(frozen=True, slots=True, kw_only=True)
class RunOptions:
    """What to run.

    Attributes:
        tree: name of a shipped tree, or a YAML file.
        course: name of a generator or shipped course, or a YAML file.
        seed: of the course and of the sensor noise.
        world: kind of simulation.
        executor: how long-running skills are run, `lockstep` or `realtime`.
        speed: robot time per wall time; as fast as possible where None, which realtime does not allow.
        goal: x [m], y [m], yaw [rad]; the course's own where None.
        time_limit: robot time after which the run ends [s].
        robot: name of a shipped robot, or a YAML file.
        preset: name of a shipped preset, or a YAML file.
        assignments: `subject.key=value`, `course.option=value` or `/node/path.key=value`.
        live: file of parameters that is read again whenever it is saved; none where None.
        reload: whether a tree file that is saved meanwhile takes over at the next goal.
        record: recording file to write.
        film: pictures a second of a film in the recording; none where None.
        review: whether checkpoints ask the operator, who must be there to answer.
        operated: whether an operator leads: no goal is sent but `goal`, and the run shows how it ends.
        faults: file of faults to inject; none where None.
        plans: folder for the log of every footstep plan.
        out: folder for `summary.json`, `trace.jsonl` and `run.json`, from which the run can be replayed.
    """

    tree: str = "look_and_step"
    course: str = "rough"
    seed: int = 0
    world: str = "physics"
    executor: str = "lockstep"
    speed: float | None = None
    goal: tuple[float, float, float] | None = None
    time_limit: float = 180.0
    robot: str = DEFAULT_ROBOT
    preset: str | None = None
    assignments: tuple[str, ...] = ()
    live: Path | None = None
    reload: bool = False
    record: Path | None = None
    film: float | None = None
    review: bool = False
    operated: bool = False
    faults: Path | None = None
    plans: Path | None = None
    out: Path | None = None
