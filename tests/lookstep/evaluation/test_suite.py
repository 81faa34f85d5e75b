"""Suites are read strictly, and say which walks they are."""

from __future__ import annotations

import pytest

from lookstep.errors import UserError
from lookstep.evaluation.suite import Case, Suite, chosen, load_suite, suite_names
from lookstep.summary import Outcome
from lookstep.walk import check_options
from strict_yaml import YamlError


@pytest.mark.parametrize("name", suite_names())
def test_every_walk_of_a_shipped_suite_can_be_made(name):
    suite = load_suite(name)
    for case in chosen(suite).cases:
        check_options(case.options(case.seeds - 1, suite.worlds[0]))


def test_the_suite_of_promises_has_the_walks_that_were_promised():
    cases = {case.name: case for case in chosen(load_suite("promises")).cases}
    assert cases["rough"].seeds == 100 and cases["moved_blocks"].least_reactive == 2
    assert cases["drift"].preset == "fast,drift" and cases["rough"].preset == "fast"
    assert cases["missing_rows"].ends == (Outcome.BLOCKED,)
    failing = {name: (case.may_fail.kinematic, case.may_fail.physics) for name, case in cases.items()}
    assert failing["rough"] == (1, 4) and failing["drift"] == (1, 2)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("cases: []", ":1:8: cases: needs at least one case"),
        (
            "cases: [{name: a, course: flat, seed: 3}]",
            ':1:33: cases[0]: unknown key "seed"; did you mean "seeds"?',
        ),
        ("cases: [{name: a, course: flat, seeds: 0}]", ":1:40: cases[0].seeds: got 0, allowed: 1 .. 100000"),
        ("cases: [{name: a, course: flat, ends: [lost]}]", ":1:40: cases[0].ends[0]: got"),
        ("worlds: [moon]\ncases: [{name: a, course: flat}]", ":1:10: worlds[0]: got"),
        (
            "cases: [{name: a, course: flat}, {name: a, course: rough}]",
            ':1:8: cases: the name "a" is taken by two cases',
        ),
    ],
)
def test_a_suite_that_is_none_is_told_with_its_place(text, told, tmp_path):
    file = tmp_path / "mine.yaml"
    file.write_text(text)
    with pytest.raises(YamlError) as error:
        load_suite(str(file))
    assert str(error.value).startswith(f"{file}{told}")


def test_an_unknown_suite_is_told_with_those_that_there_are():
    with pytest.raises(YamlError, match='unknown suite "promise"; did you mean "promises"'):
        load_suite("promise")


def test_some_cases_are_chosen_and_get_what_all_walks_get():
    suite = Suite(
        preset="fast",
        cases=(Case(name="a", course="flat", set=("course.length=3",)), Case(name="b", course="rough", preset="drift")),
    )
    one = chosen(suite, names=["b"], worlds=["kinematic"], preset="paper", assignments=["footsteps.reach=0.4"])
    (case,) = one.cases
    options = case.options(4, *one.worlds)
    assert (options.course, options.seed, options.world, options.preset) == ("rough", 4, "kinematic", "paper,drift")
    assert options.assignments == ("footsteps.reach=0.4",)
    assert [case.preset for case in chosen(suite).cases] == ["fast", "fast,drift"]
    with pytest.raises(UserError, match=r'--cases: no case "c" \(cases: a, b\)'):
        chosen(suite, names=["c"])
