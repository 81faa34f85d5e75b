"""`lookstep check` on broken files of every kind: all problems at once, each at its place, exit status 2."""

from __future__ import annotations

import random
import resource
import time
from pathlib import Path

import pytest

from lookstep.__main__ import main
from strict_yaml import shipped_folder

# Name of the file, its text, and what is said about it; MARK stands where each problem is written.
CORPUS: dict[str, tuple[str, str, tuple[str, ...]]] = {
    "unknown parameter": ("footsteps.yaml", "§reech: 0.5\n", ('unknown key "reech"; did you mean "reach"?',)),
    "parameter out of range": ("footsteps.yaml", "reach: §9\n", ("footsteps.reach: got 9, allowed: 0.1 .. 1 m",)),
    "parameter of the wrong type": ("footsteps.yaml", "reach: §far\n", ('got "far", needs a number',)),
    "no parameter at all": ("regions.yaml", "§- 3\n", ("got a sequence, needs a mapping with the keys",)),
    "parameter without a value": ("walking.yaml", "mass_scale:\n§swing_heigth: 1\n", ('unknown key "swing_heigth"',)),
    "not a number": ("footsteps.yaml", "reach: §.nan\n", ("needs a finite number",)),
    "infinite": ("footsteps.yaml", "reach: §.inf\n", ("got inf, needs a finite number",)),
    "duplicate": ("footsteps.yaml", "reach: 0.5\n§reach: 0.6\n", ('duplicate key "reach", first given on line 1',)),
    "boolean for a number": ("footsteps.yaml", "reach: §true\n", ("got true, needs a number",)),
    "list for a number": ("footsteps.yaml", "reach: §[0.5]\n", ("got a sequence, needs a number",)),
    "two problems": (
        "footsteps.yaml",
        "reach: §7\n§nothing: 3\n",
        ("got 7, allowed: 0.1 .. 1 m", 'unknown key "nothing"'),
    ),
    "preset of an unknown subject": (
        "mine.yaml",
        "footsteps: {reach: 0.5}\n§fotsteps: {}\n",
        ('unknown subject "fotsteps"; did you mean "footsteps"?',),
    ),
    "preset out of range": (
        "mine.yaml",
        "footsteps: {reach: §9}\nregions: {§nothing: 3}\n",
        ("footsteps.reach: got 9", 'unknown key "nothing"'),
    ),
    "preset that is a list": ("mine.yaml", "walking: §[1]\n", ("got a sequence, needs a mapping",)),
    "course without objects": ("mine.yaml", "start: {x: 0, y: 0}\n", ()),
    "course with a box of no size": (
        "mine.yaml",
        "start: {x: 0, y: 0}\ngoal: {x: 1, y: 0}\nobjects:\n  - {size: §[1, 1], position: [0, 0, 0]}\n",
        ("got a list of 2 values, needs a list of 3 values",),
    ),
    "course with an unknown key": (
        "mine.yaml",
        "start: {x: 0, y: 0}\ngoal: {x: 1, y: 0, §z: 3}\nobjects:\n  - {size: [9, 9, 1], position: [0, 0, -0.5]}\n",
        ('unknown key "z"',),
    ),
    "empty": ("mine.yaml", "§", ("the file is empty",)),
    "only a comment": ("mine.yaml", "§# nothing\n", ("the file is empty",)),
    "unclosed bracket": ("mine.yaml", "tree: t\nroot: {sequence: [Succeed\n§", ("expected ',' or ']'",)),
    "tab": ("mine.yaml", "tree: t\nroot:\n§\tsequence: []\n", ("",)),
    "tag": ("mine.yaml", "tree: t\nroot: §!!python/object:os.system {}\n", ("tags are not supported",)),
    "merge key": ("mine.yaml", "tree: &a t\nroot: {§<<: *a}\n", ('merge keys ("<<") are not supported',)),
    "alias without anchor": ("mine.yaml", "tree: t\nroot: §*nothing\n", ('alias "*nothing" has no anchor before it',)),
    "alias inside its anchor": ("mine.yaml", "tree: t\nroot: &a {sequence: [§*a]}\n", ("lies inside its own anchor",)),
    "second document": ("mine.yaml", "tree: t\nroot: Succeed\n§---\ntree: u\n", ("a second document begins here",)),
    "old version": ("mine.yaml", "%YAML 1.1\n§---\ntree: t\nroot: Succeed\n", ("YAML version 1.1 is not supported",)),
    "control character": ("mine.yaml", "tree: t§\x07\n", ("character U+0007 is not allowed",)),
    "tree of unknown leaves": (
        "mine.yaml",
        "tree: t\nroot:\n  sequence:\n    - §PlanFootstep\n    - §SendFootstep\n",
        ('did you mean "PlanFootsteps"?', 'did you mean "SendFootsteps"?'),
    ),
    "tree without a root": ("mine.yaml", "§tree: t\n", ('missing key "root" of a tree file',)),
    "tree whose plan is never in time": (
        "mine.yaml",
        "tree: t\nports: {in: {g: PlanarRegions, s: SubGoal}}\nroot:\n  sequence:\n"
        "    - §PlanFootsteps: {in: {ground: g, sub_goal: s}, out: [plan], latency: 0.7}\n"
        "    - WaitForSwing: {in: [plan], fraction: 0.5}\n",
        ("can never be in time: a plan takes 0.7 s, and /t/wait_for_swing leaves 0.4 s of a swing of 0.8 s",),
    ),
    "tree that includes nothing": (
        "mine.yaml",
        "tree: t\ninclude: [§missing.yaml]\nroot: Succeed\n",
        ('cannot include "missing.yaml"',),
    ),
    "tree that includes itself": (
        "mine.yaml",
        "tree: t\ninclude: [§mine.yaml]\nroot: Succeed\n",
        ("files include one another: mine.yaml -> mine.yaml",),
    ),
    "tree with a condition over a field that is not there": (
        "mine.yaml",
        "tree: t\nports: {in: {plan: FootstepPlan}}\nroot:\n  check: plan.§stepps == 3\n",
        ('FootstepPlan has no field "stepps"; did you mean "steps"?',),
    ),
    "tree with a condition that is never so": (
        "mine.yaml",
        'tree: t\nports: {in: {plan: FootstepPlan}}\nroot:\n  check: plan.outcome == §"goal_reachd"\n',
        ('PlanOutcome is never "goal_reachd"; did you mean "goal_reached"?',),
    ),
}


@pytest.mark.parametrize("name", CORPUS)
def test_check_tells_every_problem_at_its_place(name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    file, marked, expected = CORPUS[name]
    places = [_place(marked, index) for index, letter in enumerate(marked) if letter == "§"]
    path = tmp_path / file
    path.write_text(marked.replace("§", ""))
    assert main(["check", str(path)]) == 2
    told = [line for line in capsys.readouterr().err.splitlines() if line.startswith(f"{path}:")]
    assert len(told) >= max(1, len(expected))
    for (line, column), message in zip(places, expected, strict=True):
        assert any(text.startswith(f"{path}:{line}:{column}: ") and message in text for text in told), told


def _place(marked: str, index: int) -> tuple[int, int]:
    """Line and column of a mark, the marks before it not counted."""
    before = marked[:index].replace("§", "")
    return before.count("\n") + 1, len(before) - (before.rfind("\n") + 1) + 1


@pytest.mark.parametrize(
    ("file", "data", "message"),
    [
        ("mine.yaml", b"tree: \xff\n", ":1:7: not UTF-8 text: byte 0xff"),
        ("mine.yaml", b"#" * 1_000_001, ":1:1: file is larger than 1000000 bytes"),
        ("mine.yaml", b"a: [" * 120, "nested deeper than 100 levels"),
        ("mine.yaml", b"".join(b"a%d: &a%d [%s]\n" % (i, i, b"*a%d, " % (i - 1) * 9 if i else b"1") for i in range(9)),
         "more than 10000 nodes, with aliases expanded"),
        ("mine.yaml", b"tree: t\nroot: {Wait: {duration: " + b"9" * 200 + b"}}", "number of more than 100 digits"),
    ],
)  # fmt: skip
def test_files_that_would_cost_too_much_are_refused(file, data, message, tmp_path, capsys):
    (tmp_path / file).write_bytes(data)
    assert main(["check", str(tmp_path / file)]) == 2
    assert message in capsys.readouterr().err


def test_remarks_are_problems_where_one_is_strict(tmp_path, capsys):
    tree = tmp_path / "mine.yaml"
    tree.write_text("tree: t\nroot:\n  sequence:\n    - WaitForGoal: {out: [goal]}\n")
    assert main(["check", str(tree)]) == 0
    assert 'nobody reads "goal"' in capsys.readouterr().err
    assert main(["check", "--strict", str(tree)]) == 2


def test_all_shipped_trees_and_presets_are_sound_without_remarks(capsys):
    trees = sorted(map(str, shipped_folder("trees").glob("*.yaml")))
    config = sorted(map(str, shipped_folder("config").rglob("*.yaml")))
    assert main(["check", "--strict", *trees, *config]) == 0
    assert capsys.readouterr().err == ""


PIECES = [*"[]{}:-,3~#'\"&*!|>%@", "\n", "  ", "- ", "&a ", "*a", "!!set", "1e999", "null", "sequence", "subtree",
          "in", "out", "latency", "SendFootsteps", "loop_forever", "goal", "check: plan.steps > 1",
          "include: [look_and_step]"]  # fmt: skip


def mutated(text: str, chance: random.Random) -> str:
    """A text with up to six small wounds."""
    for _ in range(chance.randint(1, 6)):
        place = chance.randrange(len(text) + 1)
        cut = chance.choice([0, 0, 1, 3, 20])
        piece = chance.choice(["", chance.choice(PIECES), text[(start := chance.randrange(len(text))) : start + 30]])
        text = text[:place] + piece + text[place + cut :]
    return text


def wound(count: int, folder: Path, capsys: pytest.CaptureFixture[str]) -> tuple[int, float]:
    """Check mutated shipped trees; returns how many were refused, and the longest time of one in seconds."""
    chance = random.Random(0)
    texts = [path.read_text() for path in sorted(shipped_folder("trees").glob("*.yaml"))]
    refused, longest = 0, 0.0
    for index in range(count):
        path = folder / f"tree_{index}.yaml"
        path.write_text(mutated(chance.choice(texts), chance))
        started = time.thread_time()
        status = main(["check", str(path)])
        longest = max(longest, time.thread_time() - started)
        path.unlink()
        told = capsys.readouterr().err
        assert status in (0, 2)
        assert status == 0 or f"{path}:" in told, told
        refused += status == 2
    return refused, longest


def test_mutated_trees_are_read_or_refused_with_places(tmp_path, capsys):
    refused, _ = wound(60, tmp_path, capsys)
    assert 30 < refused < 60


@pytest.mark.sweep
@pytest.mark.timeout(3600)
def test_ten_thousand_mutated_trees_are_read_or_refused_with_places(tmp_path, capsys):
    wound(50, tmp_path, capsys)  # Loads what takes memory once.
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    refused, longest = wound(10_000, tmp_path, capsys)
    grown = (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before) / 1024
    with capsys.disabled():
        print(f"\n{refused} of 10000 refused, longest {longest:.2f} s, memory grew by {grown:.0f} MB")
    assert longest < 5.0 and grown < 100
