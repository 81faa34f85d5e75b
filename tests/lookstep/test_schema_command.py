"""`lookstep schema` and `lookstep leaves`: what editors and people are told about trees and config files."""

from __future__ import annotations

import json
from pathlib import Path

import jsonschema
import pytest

from lookstep.__main__ import main
from lookstep.commands.schema import all_schemas
from lookstep.configuration import SUBJECTS
from strict_yaml import Kind, Node, load_document, shipped_folder

CONFIG = shipped_folder("config")


def plain(node: Node):
    """A document as JSON has it."""
    if node.kind is Kind.MAPPING:
        return {entry.key: plain(entry.node) for entry in node.entries}
    if node.kind is Kind.SEQUENCE:
        return [plain(element) for element in node.elements]
    return node.value


def test_every_shipped_config_file_and_preset_fits_and_others_do_not():
    schemas = all_schemas()
    files = [(subject, CONFIG / f"{subject}.yaml") for subject in SUBJECTS]
    files += [("preset", path) for path in (CONFIG / "presets").glob("*.yaml")]
    for name, path in files:
        jsonschema.Draft7Validator.check_schema(schemas[name])
        assert list(jsonschema.Draft7Validator(schemas[name]).iter_errors(plain(load_document(path)))) == [], path
    refusing = jsonschema.Draft7Validator(schemas["footsteps"])
    for broken in ({"reech": 0.5}, {"reach": 9}, {"reach": "far"}, []):
        assert list(refusing.iter_errors(broken))


def test_schemas_are_printed_or_written(tmp_path: Path, capsys):
    assert main(["schema", "footsteps"]) == 0
    assert json.loads(capsys.readouterr().out)["properties"]["reach"]["maximum"] == 1.0
    assert main(["schema", "--out", str(tmp_path / "schemas")]) == 0
    assert f"$schema={tmp_path}/schemas/tree.schema.json" in capsys.readouterr().out
    assert len(list((tmp_path / "schemas").glob("*.schema.json"))) == len(SUBJECTS) + 2
    assert main(["schema", "fotsteps"]) == 2
    assert 'did you mean "footsteps"' in capsys.readouterr().err
    assert main(["schema"]) == 2


def test_leaves_are_listed_and_explained(capsys):
    assert main(["leaves"]) == 0
    assert "PlanFootsteps" in capsys.readouterr().out
    assert main(["leaves", "PlanFootsteps"]) == 0
    assert "set latency         0.2 s, 0 .. 60: robot time until a plan is delivered" in capsys.readouterr().out
    assert main(["leaves", "PlanFootstep"]) == 2
    assert 'did you mean "PlanFootsteps"?' in capsys.readouterr().err


def test_the_table_of_a_page_is_written_anew_and_the_rest_stays(tmp_path: Path, capsys):
    page = tmp_path / "page.md"
    page.write_text("# Before\n\n| leaf | old |\n|---|---|\n| x | y |\n\nAfter.\n")
    assert main(["leaves", "--page", str(page)]) == 0
    text = page.read_text()
    assert text.startswith("# Before\n\n| leaf | does |") and text.endswith("\n\nAfter.\n") and "| x |" not in text
    page.write_text("nothing")
    assert main(["leaves", "--page", str(page)]) == 2


OWN = '''
from behaviors import Leaf, leaf


@leaf
class %s(Leaf):
    """Sings."""

    def tick(self):
        return self.succeeded()
'''


def test_leaves_of_a_file_are_known_to_every_command(tmp_path: Path, capsys):
    file, tree = tmp_path / "own_song.py", tmp_path / "song.yaml"
    file.write_text(OWN % "SingOnce")
    tree.write_text("tree: song\nroot: SingOnce\n")
    assert main(["--leaves", str(file), "check", str(tree)]) == 0
    assert main(["--leaves", str(file), "leaves", "SingOnce"]) == 0
    assert "SingOnce: Sings." in capsys.readouterr().out


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("import nothing_at_all\n", "line 1: ModuleNotFoundError"),
        ("def (:\n", "line 1: SyntaxError"),
        ("\n" + OWN % "lowercase", "line 6: RegistrationError: lowercase: a leaf is named in CamelCase"),
        (OWN % "PauseWalking", "line 5: RegistrationError: PauseWalking: already registered by behaviors.leaves.walk"),
    ],
)
def test_a_file_of_leaves_that_cannot_be_loaded_is_told_with_its_line(text, message, tmp_path: Path, capsys):
    main(["leaves"])
    file = tmp_path / "broken_leaves.py"
    file.write_text(text)
    capsys.readouterr()
    assert main(["--leaves", str(file), "leaves"]) == 2
    assert f"--leaves {file}: {message}" in capsys.readouterr().err
    assert main(["--leaves", str(tmp_path / "missing.py"), "leaves"]) == 2
