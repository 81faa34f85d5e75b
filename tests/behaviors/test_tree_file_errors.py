"""What a broken tree file is told: every problem at once, each at its place, with what is allowed."""

from __future__ import annotations

import random
import re
from pathlib import Path

import pytest
from scripted import make, run, toys

from behaviors import check, parse_tree
from strict_yaml import YamlError

LEAVES = "(leaves: AddOne, GiveNumber, GiveText, PauseWalking, Scripted, Square)"
NODES = (
    "(nodes: subtree, check, sequence, reactive_sequence, selector, reactive_selector, parallel, reactive_parallel, "
    "inverter, force_success, force_failure, retry, repeat, loop_forever, timeout, rate_limit, run_while, suppress, "
    "inhibit, reset, halt_unless, pause_on_failure)"
)
FILE_KEYS = "(keys of a tree file: tree, about, include, ports, root, safe_stop, trees)"

# Text of a file, and what is said about it, one problem a line.
CORPUS: dict[str, tuple[str, str]] = {
    "unknown leaf": (
        """
tree: t
root:
  sequence:
    - GiveNumbr: {out: [number]}
""",
        f't.yaml:4:7: /t/give_numbr: unknown leaf "GiveNumbr"; did you mean "GiveNumber"? {LEAVES}',
    ),
    "what an unknown node hides": (
        """
tree: t
root:
  sequnce:
    - GiveNumbr: {out: [number]}
    - AddOne: {in: [number], out: [sum], valeu: 2}
    - AddOne: {in: {number: smu}}
""",
        f"""t.yaml:3:3: /t: unknown node "sequnce"; did you mean "sequence"? {NODES}
t.yaml:4:7: /t/give_numbr: unknown leaf "GiveNumbr"; did you mean "GiveNumber"? {LEAVES}
t.yaml:5:42: /t/add_one: unknown key "valeu" (AddOne: name, in, out)
t.yaml:6:29: /t/add_one_2: nothing writes "smu"; did you mean "sum"?""",
    ),
    "unknown node": (
        """
tree: t
root:
  sequnce:
    - Scripted
""",
        f't.yaml:3:3: /t: unknown node "sequnce"; did you mean "sequence"? {NODES}',
    ),
    "unknown file key and missing ones": (
        """
tre: t
rot: Scripted
""",
        't.yaml:1:1: missing key "root" of a tree file\nt.yaml:1:1: missing key "tree" of a tree file\n'
        f't.yaml:1:1: unknown key "tre"; did you mean "tree"? {FILE_KEYS}\n'
        f't.yaml:2:1: unknown key "rot"; did you mean "root"? {FILE_KEYS}',
    ),
    "file is a list": (
        "- tree",
        "t.yaml:1:1: got a sequence, a tree file is a mapping with the keys tree, about, include, ports, root, "
        "safe_stop, trees",
    ),
    "two kinds in one node": (
        """
tree: t
root:
  sequence: [Scripted]
  selector: [Scripted]
""",
        't.yaml:3:3: /t: got the keys sequence, selector; a node is one key, its kind, such as "- sequence: [...]"',
    ),
    "no children": (
        """
tree: t
root:
  sequence:
    - selector: []
    - parallel: {name: p}
    - sequence: 3
""",
        """t.yaml:4:17: /t/selector: got none, needs a list of children
t.yaml:5:7: /t/p: got nothing, needs a list of children
t.yaml:6:17: /t/sequence: got 3, sequence takes a mapping of name, children""",
    ),
    "decorators without and with too many children": (
        """
tree: t
root:
  sequence:
    - retry: {attempts: 2}
    - inverter: {sequence: [Scripted], selector: [Scripted]}
    - timeout: {after: 1, child: Scripted, sequence: [Scripted]}
    - run_while: {child: Scripted}
""",
        """t.yaml:4:7: /t/retry: retry needs a child
t.yaml:5:40: /t/inverter: inverter has one child, which is sequence already
t.yaml:6:44: /t/timeout: timeout has one child, which is given already
t.yaml:7:7: /t/run_while: run_while needs a condition""",
    ),
    "parameters": (
        """
tree: t
root:
  sequence:
    - GiveNumber: {out: [number], value: 11}
    - GiveNumber: {out: [number], value: three}
    - GiveNumber: {out: [number], valeu: 3}
    - Scripted: {breaks: strat}
    - retry: {attempts: 2.5, child: Scripted}
""",
        """t.yaml:4:42: /t/give_number.value: got 11, allowed: -10 .. 10 m
t.yaml:5:42: /t/give_number_2.value: got "three", needs a number
t.yaml:6:35: /t/give_number_3: unknown key "valeu"; did you mean "value"? (GiveNumber: name, in, out, value)
t.yaml:7:26: /t/scripted.breaks: got "strat"; did you mean "start"? (allowed: , setup, start, tick, stop)
t.yaml:8:25: /t/retry.attempts: got 2.5, needs a whole number""",
    ),
    "ports": (
        """
tree: t
root:
  sequence:
    - GiveNumber: {out: {nubmer: number}}
    - AddOne: {out: [sum]}
    - AddOne: {in: {number: 3}, out: [sum]}
    - AddOne: {in: number}
""",
        """t.yaml:4:26: /t/give_number: unknown output "nubmer"; did you mean "number"? (outputs: number)
t.yaml:5:7: /t/add_one: input "number" of AddOne is not wired
t.yaml:6:29: /t/add_one_2: got 3; a key is named in small letters, digits and "_"
t.yaml:7:20: /t/add_one_3: got "number", needs a list of ports or a mapping of ports to keys""",
    ),
    "what flows": (
        """
tree: t
ports: {in: {goal: float}, out: {answer: float}}
root:
  sequence:
    - GiveNumber: {out: {number: distance}}
    - AddOne: {in: {number: distanse}, out: [sum]}
    - GiveText: {out: [text]}
    - AddOne: {in: {number: text}, out: {sum: text}}
    - GiveText: {out: {text: goal}}
""",
        """t.yaml:2:34: nothing writes the output "answer"
t.yaml:6:29: /t/add_one: nothing writes "distanse"; did you mean "distance"?
t.yaml:8:29: /t/add_one_2: "number" takes float, but "text" is str of /t/give_text
t.yaml:8:47: /t/add_one_2: "sum" gives float, but "text" is str of /t/give_text
t.yaml:9:30: /t/give_text_2: "text" gives str, but "goal" comes from outside as float""",
    ),
    "names": (
        """
tree: t
root:
  sequence:
    - Scripted: {name: twin}
    - Scripted: {name: twin}
    - Scripted: {name: "a/b"}
    - Scripted: {name: 3}
""",
        """t.yaml:5:24: /t: two siblings are named "twin", the first on line 4
t.yaml:6:24: /t: got "a/b"; a name is letters, digits, spaces, "_" and "-"
t.yaml:7:24: /t: got 3; a name is letters, digits, spaces, "_" and "-\"""",
    ),
    "name of a root": (
        "{tree: t, root: {Scripted: {name: x}}}",
        "t.yaml:1:35: /t: a root takes the name of its tree",
    ),
    "subtrees": (
        """
tree: t
root:
  sequence:
    - subtree: {tree: lok}
    - subtree: {}
    - subtree: {tree: look, in: {depth: x}}
trees:
  look:
    ports: {in: {scale: float}, out: {size: flaot}}
    root: Scripted
""",
        """t.yaml:4:23: /t/lok: unknown tree "lok"; did you mean "look"? (trees: look)
t.yaml:5:7: /t/subtree: missing key "tree": the name of a tree of this file
t.yaml:6:7: /t/look: input "scale" of tree "look" is not wired
t.yaml:6:34: /t/look: unknown input "depth" (inputs: scale)
t.yaml:9:45: unknown type "flaot"; did you mean "float"? (types of ports: bool, float, int, str)""",
    ),
    "a tree that contains itself": (
        """
tree: t
root: {subtree: {tree: a}}
trees:
  a: {root: {inverter: {subtree: {tree: b}}}}
  b: {root: {sequence: [subtree: {tree: a}]}}
""",
        "t.yaml:5:41: /t/b/a: a tree contains itself: t -> a -> b -> a",
    ),
    "problems of a tree that nothing uses": (
        """
tree: t
root: Scripted
trees:
  spare: {root: {sequence: [Nothing]}}
""",
        f't.yaml:4:29: /spare/nothing: unknown leaf "Nothing" {LEAVES}',
    ),
    "names of trees": (
        """
tree: Look And Step
root: Scripted
trees: {Bad: {root: Scripted}}
""",
        """t.yaml:1:7: got "Look And Step"; a tree is named in small letters, digits and "_"
t.yaml:3:9: got "Bad"; a tree is named in small letters, digits and "_\"""",
    ),
    "scalars where nodes belong": (
        """
tree: t
root:
  sequence:
    - 3
    - [Scripted]
    -
""",
        """t.yaml:4:7: /t: got 3; a node is one key, its kind, such as "- sequence: [...]"
t.yaml:5:7: /t: got a sequence; a node is one key, its kind, such as "- sequence: [...]"
t.yaml:6:6: /t: got nothing; a node is one key, its kind, such as "- sequence: [...]\"""",
    ),
    "frame of the wrong kind": (
        """
tree: t
about: 3
ports: [goal]
include: other.yaml
root: Scripted
trees: [a]
""",
        """t.yaml:2:8: got 3, needs text
t.yaml:3:8: got a sequence, ports is a mapping with the keys in, out
t.yaml:4:10: got "other.yaml", needs a list of files
t.yaml:6:8: got a sequence, needs a mapping of tree names to trees""",
    ),
    "yaml itself": (
        "tree: t\nroot: {sequence: [Scripted}",
        "t.yaml:2:27: expected ',' or ']', but got '}' (while parsing a flow sequence)",
    ),
}


@pytest.mark.parametrize("name", CORPUS)
def test_a_broken_file_is_told_all_its_problems(name: str):
    text, expected = CORPUS[name]
    with pytest.raises(YamlError) as error:
        parse_tree(text.lstrip("\n"), toys, "t.yaml")
    assert str(error.value) == expected


def test_check_gives_problems_and_none_for_a_good_file(tmp_path: Path):
    good, bad = tmp_path / "good.yaml", tmp_path / "bad.yaml"
    good.write_text("{tree: t, root: Scripted}")
    bad.write_text("{tree: t, root: Skripted}")
    assert check(good, toys) == ()
    (problem,) = check(bad, toys)
    assert str(problem).startswith(f'{bad}:1:17: /t: unknown leaf "Skripted"; did you mean "Scripted"?')
    assert len(check(tmp_path / "missing.yaml", toys)) == 1


def test_a_tree_that_multiplies_beyond_all_bounds_is_refused_at_once():
    trees = "\n".join(
        f"  t{i}: {{root: {{sequence: [{', '.join(f'subtree: {{tree: t{i + 1}, name: n{k}}}' for k in range(9))}]}}}}"
        for i in range(8)
    )
    text = f"tree: t\nroot: {{subtree: {{tree: t0}}}}\ntrees:\n{trees}\n  t8: {{root: Scripted}}\n"
    with pytest.raises(YamlError, match="the tree is more than 5000 nodes, subtrees expanded"):
        parse_tree(text, toys)


def test_a_tree_deeper_than_a_hundred_nodes_is_refused():
    trees = "".join(f"  t{i}: {{root: {{inverter: {{subtree: {{tree: t{i + 1}}}}}}}}}\n" for i in range(120))
    text = f"tree: t\nroot: {{subtree: {{tree: t0}}}}\ntrees:\n{trees}  t120: {{root: Scripted}}\n"
    with pytest.raises(YamlError, match="the tree is deeper than 100"):
        parse_tree(text, toys)


def test_the_deepest_tree_allowed_can_be_ticked():
    trees = "".join(f"  t{i}: {{root: {{inverter: {{subtree: {{tree: t{i + 1}}}}}}}}}\n" for i in range(99))
    tree, robot = make(f"tree: t\nroot: {{subtree: {{tree: t0}}}}\ntrees:\n{trees}  t99: {{root: Scripted}}\n")
    run(tree, robot, 1)
    assert len(tree.nodes) == 100 and not tree.faults


def test_a_mutilated_file_is_read_or_refused_with_places_but_never_crashes():
    chance = random.Random(0)
    texts = [text for text, _ in CORPUS.values()]
    pieces = [*"[]{}:-,3~", "\n", "  ", "&a ", "*a", "!!set", *re.findall(r"[a-z_]+", NODES), "child", "in", "out"]
    for _ in range(300):
        text = chance.choice(texts)
        for _ in range(chance.randint(1, 4)):
            place = chance.randrange(len(text) + 1)
            text = text[:place] + chance.choice(["", chance.choice(pieces)]) + text[place + chance.randrange(6) :]
        try:
            parse_tree(text, toys, "t.yaml")
        except YamlError as error:
            assert error.problems
            assert all(problem.location.line >= 1 for problem in error.problems)
