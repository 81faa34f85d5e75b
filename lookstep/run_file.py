"""`run.json` beside a trace: all that it takes to have the same world and the same tree again.

It holds the options, every parameter of every subject, the course as it was (also where it was a file), the settings of
nodes, and the texts of the tree's files, so that later changes of config, courses or trees do not reach into it.
"""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from behaviors.faults import Fault
from behaviors.values import ValueFormatError, from_json, to_json
from lookstep.configuration import Configuration
from lookstep.errors import UserError
from lookstep.options import RunOptions
from sim_envs.courses import Course

FORMAT = 1
RUN_FILE = "run.json"
TRACE_FILE = "trace.jsonl"

_PATHS = tuple(field.name for field in dataclasses.fields(RunOptions) if "Path" in str(field.type))


@dataclass(frozen=True, slots=True, kw_only=True)
class RunFile:
    """What ran.

    Attributes:
        options: as they were given.
        configuration: the parameters of every subject.
        course: where it walked.
        goal: x [m], y [m], yaw [rad].
        nodes: settings of nodes by path and parameter.
        faults: those that were injected; the course has those of its blocks already.
        tree: path of the tree's file.
        sources: texts of the tree's files, by path.
        versions: of the packages that can change a run.
    """

    options: RunOptions
    configuration: Configuration
    course: Course
    goal: tuple[float, float, float]
    nodes: Mapping[str, Mapping[str, Any]]
    faults: tuple[Fault, ...]
    tree: str
    sources: Mapping[str, str]
    versions: Mapping[str, str]

    def write(self, path: Path) -> None:
        """Write it as JSON."""
        options = {
            field.name: str(value) if isinstance(value := getattr(self.options, field.name), Path) else to_json(value)
            for field in dataclasses.fields(self.options)
        }
        table = {
            "format": FORMAT,
            "options": options,
            "configuration": to_json(self.configuration),
            "course": to_json(self.course),
            "goal": list(self.goal),
            "nodes": {path: {key: to_json(value) for key, value in keys.items()} for path, keys in self.nodes.items()},
            "faults": to_json(self.faults),
            "tree": self.tree,
            "sources": dict(self.sources),
            "versions": dict(self.versions),
        }
        path.write_text(json.dumps(table, indent=1) + "\n", encoding="utf-8")

    @classmethod
    def read(cls, folder: Path) -> RunFile:
        """Read that of a run's folder.

        Raises:
            UserError: where there is none, or one of another version.
        """
        path = folder / RUN_FILE
        try:
            table = json.loads(path.read_text(encoding="utf-8"))
        except (OSError, ValueError) as error:
            hint = "a run writes it with --out"
            raise UserError(f"{path}: cannot read what ran ({hint}): {error}") from error
        if not isinstance(table, dict) or table.get("format") != FORMAT:
            raise UserError(f"{path}: not a run of this version, needs format {FORMAT}")
        try:
            options = {key: from_json(value) for key, value in table["options"].items()}
            for key in _PATHS:
                options[key] = None if options.get(key) is None else Path(options[key])
            known = {field.name for field in dataclasses.fields(RunOptions)}
            return cls(
                options=RunOptions(**{key: value for key, value in options.items() if key in known}),
                configuration=from_json(table["configuration"]),
                course=from_json(table["course"]),
                goal=tuple(table["goal"]),
                nodes={path: {key: from_json(v) for key, v in keys.items()} for path, keys in table["nodes"].items()},
                faults=from_json(table["faults"]),
                tree=table["tree"],
                sources=table["sources"],
                versions=table["versions"],
            )
        except (KeyError, TypeError, ValueFormatError) as error:
            raise UserError(f"{path}: written by another version of lookstep: {error}") from error
