"""`lookstep schema`: JSON Schemas, with which editors complete, explain and check our YAML."""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import Any

from lookstep.errors import UserError
from strict_yaml import nearest

NAME = "schema"
HELP = "write JSON Schemas of trees, presets and config files, for completion and hover in editors"
EXAMPLE = "lookstep schema --out .schemas"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what to write and where to."""
    parser.add_argument("what", nargs="?", metavar="WHAT", help="tree, preset or a subject of config; printed")
    parser.add_argument("--out", type=Path, metavar="DIR", help="write all of them into this folder")


def execute(options: argparse.Namespace) -> int:
    """Print one or write all."""
    if (options.what is None) == (options.out is None):
        raise UserError(
            "schema: needs either what to print (tree, preset, or a subject such as footsteps) or --out DIR"
        )
    schemas = all_schemas()
    if options.out is None:
        if options.what not in schemas:
            raise UserError(f'schema: unknown "{options.what}"{nearest(options.what, schemas)} ({", ".join(schemas)})')
        print(json.dumps(schemas[options.what], indent=2))
        return 0
    options.out.mkdir(parents=True, exist_ok=True)
    for name, schema in schemas.items():
        (options.out / f"{name}.schema.json").write_text(json.dumps(schema, indent=1) + "\n", encoding="utf-8")
    print(f"{len(schemas)} schemas in {options.out}; in a tree file, the editor reads the first line:")
    print(f"# yaml-language-server: $schema={options.out}/tree.schema.json")
    return 0


def all_schemas() -> dict[str, dict[str, Any]]:
    """The schema of trees, of presets, and of each subject's config file."""
    from behaviors import known_leaves
    from behaviors.schema import DRAFT, tree_schema
    from behaviors.text import first_line
    from lookstep.configuration import SUBJECTS
    from strict_yaml.schema import dataclass_schema

    subjects = {subject: dataclass_schema(cls, first_line(cls)) for subject, cls in SUBJECTS.items()}
    preset = {"type": "object", "properties": subjects, "additionalProperties": False}
    head = {"$schema": DRAFT}
    return {
        "tree": tree_schema(known_leaves()),
        "preset": {**head, "title": "lookstep preset", **preset},
        **{subject: {**head, "title": f"lookstep {subject}", **schema} for subject, schema in subjects.items()},
    }
