"""`lookstep convert`: trees to and from BehaviorTree.CPP's XML, and runs to Groot2's logs."""

from __future__ import annotations

import argparse
from pathlib import Path

from lookstep.errors import UserError

NAME = "convert"
HELP = "convert a tree between YAML and BehaviorTree.CPP 4 XML, tidy its YAML, or a run into a Groot2 log"
EXAMPLE = "lookstep convert look_and_step look_and_step.xml"

_YAML = (".yaml", ".yml")
_LOGS = (".db3", ".btdb")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare from what and into what."""
    parser.add_argument(
        "source", help="tree file (.yaml, .xml), the name of a shipped tree, a run's folder, or `leaves`"
    )
    parser.add_argument("target", type=Path, help=".yaml, .xml, or .db3 for a run; `leaves` into .xml is the palette")


def execute(options: argparse.Namespace) -> int:
    """Convert; nothing is written where something cannot be said in the other form."""
    target: Path = options.target
    if not target.parent.is_dir():
        raise UserError(f"{target}: the folder {target.parent} does not exist")
    source = Path(options.source)
    if source.is_dir():
        return _convert_run(source, target)
    text = _converted(options.source, target)
    target.write_text(text, encoding="utf-8")
    print(f"{options.source} -> {target}")
    return 0


def _converted(source: str, target: Path) -> str:
    from behaviors import known_leaves
    from behaviors.interchange import read_written, read_xml, write_palette, write_xml, write_yaml
    from lookstep.trees import tree_path
    from strict_yaml import load_document

    registry = known_leaves()
    if target.suffix not in (*_YAML, ".xml"):
        raise UserError(f"{target}: got {target.suffix or 'no suffix'}, needs .yaml or .xml; .db3 for a run's folder")
    if source == "leaves" and target.suffix == ".xml":
        return write_palette(registry)
    if Path(source).suffix == ".xml":
        try:
            text = Path(source).read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError) as error:
            raise UserError(f"{source}: cannot read the file: {error}") from error
        written = read_xml(text, registry, source)
    else:
        path = tree_path(source)
        load_document(path)  # Tells a missing file as every command does.
        written = read_written(path.read_text(encoding="utf-8"), str(path), registry)
    return write_xml(written, registry, source) if target.suffix == ".xml" else write_yaml(written)


def _convert_run(folder: Path, target: Path) -> int:
    from behaviors.interchange import write_groot_log
    from lookstep.replay import read_trace

    if target.suffix not in _LOGS:
        raise UserError(f"{target}: got {target.suffix or 'no suffix'}, a run becomes a log, .db3 or .btdb")
    count = write_groot_log(read_trace(folder), target)
    print(f"{folder} -> {target}: {count} transitions")
    return 0
