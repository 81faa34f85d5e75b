"""Which walks an evaluation makes: cases, each a course, its options and a number of seeds, as YAML or from options.

The dataclasses are the format of the files in `config/evaluations/`.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from lookstep.errors import UserError
from lookstep.options import WORLDS, RunOptions
from lookstep.summary import Outcome
from strict_yaml import Location, Problem, YamlError, load_document, nearest, read_dataclass, shipped_folder

_RUN = RunOptions()


@dataclass(frozen=True, slots=True, kw_only=True)
class Failures:
    """How many runs of a case may fail, by world; None where nothing is promised."""

    kinematic: int | None = field(default=None, metadata={"minimum": 0})
    physics: int | None = field(default=None, metadata={"minimum": 0})

    def in_world(self, world: str) -> int | None:
        """Of one world."""
        return getattr(self, world)


@dataclass(frozen=True, slots=True, kw_only=True)
class Case:
    """Walks that differ in nothing but the seed.

    Attributes:
        name: unique in its suite.
        course: name or file, as of a run.
        about: one line for people.
        seeds: 0, 1, ... up to this number.
        tree: name or file.
        preset: names or files, joined by commas; over the preset of the suite.
        set: assignments as of a run.
        time_limit: robot time after which a walk ends [s].
        ends: how a walk of this case may end.
        least_reactive: reactive steps that each walk should have.
        may_fail: most runs that may end otherwise.
    """

    name: str
    course: str
    about: str = ""
    seeds: int = field(default=1, metadata={"minimum": 1, "maximum": 100_000})
    tree: str = _RUN.tree
    preset: str | None = None
    set: tuple[str, ...] = ()
    time_limit: float = field(default=_RUN.time_limit, metadata={"unit": "s", "minimum": 1.0, "maximum": 3600.0})
    ends: tuple[Outcome, ...] = (Outcome.GOAL_REACHED,)
    least_reactive: int = field(default=0, metadata={"minimum": 0, "maximum": 1000})
    may_fail: Failures = Failures()

    def options(self, seed: int, world: str) -> RunOptions:
        """One of its walks."""
        return RunOptions(
            tree=self.tree,
            course=self.course,
            seed=seed,
            world=world,
            time_limit=self.time_limit,
            preset=self.preset,
            assignments=self.set,
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class Suite:
    """Cases that belong together.

    Attributes:
        about: one line for people.
        preset: of all cases.
        worlds: each case is walked in each of these.
        cases: at least one.
    """

    cases: tuple[Case, ...]
    about: str = ""
    preset: str | None = None
    worlds: tuple[str, ...] = field(default=("physics",), metadata={"choices": WORLDS})


def load_suite(name: str) -> Suite:
    """Read a shipped suite by its name, or the file that the name says.

    Raises:
        YamlError: with every problem found, each at its place.
    """
    names = suite_names()
    path = _folder() / f"{name}.yaml" if name in names else Path(name)
    if name not in names and path.suffix != ".yaml":
        message = f'unknown suite "{name}"{nearest(name, names)} (suites: {", ".join(names)}; or a .yaml file)'
        raise YamlError([Problem(Location("--suite", 0, 0), message)])
    problems: list[Problem] = []
    document = load_document(path)
    suite = read_dataclass(document, Suite, problems)
    if suite is None:
        raise YamlError(problems)
    cases = document.get("cases")
    place = document.location if cases is None else cases.location
    if not suite.cases:
        raise YamlError([Problem(place, "needs at least one case", "cases")])
    taken = [case.name for case in suite.cases]
    twice = sorted({name for name in taken if taken.count(name) > 1})
    if twice:
        raise YamlError([Problem(place, f'the name "{twice[0]}" is taken by two cases', "cases")])
    return suite


def suite_names() -> tuple[str, ...]:
    """The shipped suites."""
    return tuple(sorted(path.stem for path in _folder().glob("*.yaml")))


def suite_of_courses(courses: Sequence[str], seeds: int) -> Suite:
    """A case for each course."""
    return Suite(cases=tuple(Case(name=Path(course).stem, course=course, seeds=seeds) for course in courses))


def chosen(
    suite: Suite,
    *,
    names: Sequence[str] = (),
    worlds: Sequence[str] = (),
    preset: str | None = None,
    assignments: Sequence[str] = (),
) -> Suite:
    """A suite with only some of its cases, in other worlds, with another preset, with more assignments.

    Raises:
        UserError: where it has no such case.
    """
    known = [case.name for case in suite.cases]
    for name in names:
        if name not in known:
            raise UserError(f'--cases: no case "{name}"{nearest(name, known)} (cases: {", ".join(known)})')
    preset = preset or suite.preset
    cases = tuple(
        dataclasses.replace(
            case,
            preset=",".join(filter(None, (preset, case.preset))) or None,
            set=(*case.set, *assignments),
        )
        for case in suite.cases
        if not names or case.name in names
    )
    return dataclasses.replace(suite, cases=cases, worlds=tuple(worlds) or suite.worlds, preset=None)


def _folder() -> Path:
    return shipped_folder("config") / "evaluations"
