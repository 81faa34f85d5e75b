import math
import random
from pathlib import Path

import pytest

from strict_yaml import Kind, Location, YamlError, load_document, nearest, parse_document

BROKEN = {
    "": "f.yaml:1:1: the file is empty",
    "# only a comment\n": "f.yaml:1:1: the file is empty",
    "a: 1\nb: [1,\n": "f.yaml:3:1: expected the node content, but found '<stream end>' (while parsing a flow node)",
    "a: {x: 1\nb: 2\n": (
        "f.yaml:2:2: expected ',' or '}', but got ':' (while parsing a flow mapping that begins on line 1)"
    ),
    "a: b: c": "f.yaml:1:5: mapping values are not allowed here",
    "\ta: 1": "f.yaml:1:1: found character '\\t' that cannot start any token (while scanning for the next token)",
    'a: "x': ("f.yaml:1:6: found unexpected end of stream (while scanning a quoted scalar)"),
    "a: 1\n  b: 2": "f.yaml:2:4: mapping values are not allowed here",
    "a: 1\nb: 2\na: 3": 'f.yaml:3:1: duplicate key "a", first given on line 1',
    "{a: 1, a: 2}": 'f.yaml:1:8: duplicate key "a", first given on column 2',
    "a: 1\na: 1\nb: !x 3\nb: 2": (
        'f.yaml:2:1: duplicate key "a", first given on line 1\n'
        'f.yaml:3:4: tags are not supported, got "!x"; quote a value to make it text\n'
        'f.yaml:4:1: duplicate key "b", first given on line 3'
    ),
    "a: !!int 3": 'f.yaml:1:4: tags are not supported, got "!!int"; quote a value to make it text',
    "a: !!python/object/apply:os.system [ls]": (
        'f.yaml:1:4: tags are not supported, got "!!python/object/apply:os.system"; quote a value to make it text'
    ),
    "a: 1\n---\nb: 1": "f.yaml:2:1: a second document begins here; a file holds one",
    "%YAML 1.1\n---\na: on": "f.yaml:2:1: YAML version 1.1 is not supported, allowed: 1.2",
    "a: *b": 'f.yaml:1:4: alias "*b" has no anchor before it',
    "a: &b [1, *b]": 'f.yaml:1:11: alias "*b" lies inside its own anchor',
    "[1, 2]: x": "f.yaml:1:1: a key must be text, got a sequence",
    ": x": "f.yaml:1:1: empty key",
    "a: &a {x: 1}\nb:\n  <<: *a": 'f.yaml:3:3: merge keys ("<<") are not supported; write the keys out',
    "a: x\x01": "f.yaml:1:5: character U+0001 is not allowed in YAML",
    "a: " + "9" * 200: "f.yaml:1:4: number of more than 100 digits",
    "a: 1\nb: @x": "f.yaml:2:4: found character '@' that cannot start any token (while scanning for the next token)",
}


@pytest.mark.parametrize("text", BROKEN)
def test_broken_text_says_where_and_what(text):
    with pytest.raises(YamlError) as caught:
        parse_document(text, "f.yaml")
    assert str(caught.value) == BROKEN[text]


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("on", "on"),
        ("no", "no"),
        ("12:30:45", "12:30:45"),
        ("2020-01-01", "2020-01-01"),
        ("1_000", "1_000"),
        ("=", "="),
        ("true", True),
        ("FALSE", False),
        ("~", None),
        ("1e-3", 1e-3),
        (".5", 0.5),
        ("-1.", -1.0),
        ("-.inf", -math.inf),
        ("010", 10),
        ("0o17", 15),
        ("0x1F", 31),
        ("+12", 12),
        ('"12"', "12"),
        ("'true'", "true"),
        ("''", ""),
    ],
)
def test_scalars_follow_the_core_schema(text, value):
    got = parse_document(f"a: {text}").get("a")
    assert got is not None
    assert (got.value, type(got.value)) == (value, type(value))


def test_every_node_knows_its_place():
    root = parse_document("a: 1\nb:\n  - x\n  - {c: 2}\n", "f.yaml")
    assert root.kind is Kind.MAPPING
    assert root.keys == ("a", "b")
    assert [entry.location.line for entry in root.entries] == [1, 2]
    b = root.get("b")
    assert b is not None
    assert b.elements[0].location == Location("f.yaml", 3, 5)
    c = b.elements[1].get("c")
    assert c is not None
    assert str(c.location) == "f.yaml:4:9"


def test_an_alias_is_the_anchored_node():
    root = parse_document("a: &x {k: 1}\nb: *x\n")
    assert root.get("b") == root.get("a")


def test_alias_bomb_is_refused():
    levels = ["a0: &a0 [x, x]"] + [f"a{i}: &a{i} [{', '.join([f'*a{i - 1}'] * 9)}]" for i in range(1, 30)]
    with pytest.raises(YamlError, match="more than 10000 nodes, with aliases expanded"):
        parse_document("\n".join(levels))


@pytest.mark.parametrize("text", ["[" * 5000, "- " * 5000, "{a: " * 5000, "&a " * 3 + "[" * 101])
def test_deep_nesting_is_refused(text):
    with pytest.raises(YamlError):
        parse_document(text)


def test_depth_hidden_in_aliases_is_refused():
    nest = "[" * 40 + "1" + "]" * 40
    text = f"a: &a {nest}\nb: &b {nest.replace('1', '*a')}\nc: {nest.replace('1', '*b')}"
    with pytest.raises(YamlError, match="nested deeper than 100 levels"):
        parse_document(text)


def test_many_nodes_are_refused_wherever_they_hide():
    with pytest.raises(YamlError, match="more than 10000 nodes"):
        parse_document("[" + "[]," * 20_000 + "]")


def test_unusable_files_give_one_clean_line(tmp_path: Path):
    cases = {
        "missing.yaml": (None, ":1:1: cannot read the file: no such file or directory"),
        "latin.yaml": ("a: 1\nb: caf\xe9\n".encode("latin-1"), ":2:7: not UTF-8 text: byte 0xe9"),
        "utf16.yaml": ("a: 1".encode("utf-16"), ":1:1: not UTF-8 text: byte 0xff"),
        "large.yaml": (b"#" * 1_000_001, ":1:1: file is larger than 1000000 bytes"),
        "empty.yaml": (b"", ":1:1: the file is empty"),
    }
    for name, (data, message) in cases.items():
        path = tmp_path / name
        if data is not None:
            path.write_bytes(data)
        with pytest.raises(YamlError) as caught:
            load_document(path)
        assert str(caught.value) == f"{path}{message}"
    with pytest.raises(YamlError, match="cannot read the file"):
        load_document(tmp_path)
    with pytest.raises(YamlError, match="cannot read the file"):
        load_document("a\0b")


def test_byte_order_mark_is_skipped(tmp_path: Path):
    path = tmp_path / "bom.yaml"
    path.write_bytes("\ufeffa: 1\n".encode())
    assert load_document(path).keys == ("a",)


def test_nearest_suggests_only_what_is_near():
    assert nearest("horizn", ("horizon", "weight")) == '; did you mean "horizon"?'
    assert nearest("zzz", ("horizon", "weight")) == ""


SEED_TEXT = """
# a tree
root: &r
  - name: "walk \\u00e9 \\x41"
    ports: {swing: 1.2, sides: [left, right]}
    note: |
      two
      lines
  - name: 'look'
    ports: {<<: 3, swing: 1e-3}
other: *r
"""
SNIPPETS = [
    "&a ",
    "*a",
    "!",
    "!!str ",
    "%YAML ",
    "\\U99999999",
    '"',
    "'",
    "[",
    "]",
    "{",
    "}",
    ":",
    "- ",
    "? ",
    "|",
    ">-",
]
SNIPPETS += [
    "\t",
    "\r",
    "\n",
    "\x85",
    "\u2028",
    "...",
    "---",
    "#",
    ",",
    "<<: ",
    "~",
    "0x",
    "1e999",
    "\x00",
    "\ud800",
    "@",
]


def test_no_mutation_gets_past_yaml_error():
    generator = random.Random(0)
    refused = 0
    for _ in range(1500):
        text = SEED_TEXT
        for _ in range(generator.randint(1, 6)):
            i, j = sorted(generator.randrange(len(text) + 1) for _ in range(2))
            how = generator.randrange(4)
            if how == 0:
                text = text[:i] + text[min(j, i + 5) :]
            elif how == 1:
                text = text[:i] + generator.choice(SNIPPETS) + text[i:]
            elif how == 2:
                text = text[:i] + chr(generator.randrange(0x110000)) + text[i + 1 :]
            else:
                text = text[:j] + text[i : i + 20] + text[j:]
        try:
            parse_document(text)
        except YamlError as error:
            refused += 1
            assert error.problems
            assert all(p.location.line >= 1 and p.location.column >= 1 for p in error.problems)
            assert "\n" not in "".join(p.message for p in error.problems)
    assert 500 < refused < 1500
