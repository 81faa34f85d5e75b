import re
from pathlib import Path

import numpy as np
import pytest

from sim_envs.courses import Ground, load_course
from sim_envs.courses.stock import STOCK
from strict_yaml import YamlError

DOCS = Path(__file__).resolve().parents[3] / "docs" / "courses.md"


def load_text(text, tmp_path, monkeypatch, **arguments):
    monkeypatch.chdir(tmp_path)
    Path("c.yaml").write_text(text)
    return load_course("c.yaml", **arguments)


def test_the_documented_course_is_read_as_documented(tmp_path, monkeypatch):
    blocks = re.findall(r"```yaml\n(.*?)```", DOCS.read_text(), re.S)
    assert len(blocks) == 1
    course = load_text(blocks[0], tmp_path, monkeypatch)
    by_name = {box.name: box for box in course.boxes}
    assert course.name == "c"
    assert course.goal == (3.0, 0.0, 0.0)
    assert len(course.boxes) == 18
    assert by_name["row_0"].size == STOCK["large_block"]
    np.testing.assert_allclose(by_name["row_4"].T_world_box.p, (1.2, 0.0, 0.10 - 0.096), atol=1e-12)
    np.testing.assert_allclose(by_name["row_3"].T_world_box.p, (1.2, -0.4, 0.10 - 0.096), atol=1e-12)
    height = Ground(course.boxes).ground_height(np.array([[0.0, 0.0], [2.1, 0.0], [3.1, 0.0], [0.0, 0.7]]))
    np.testing.assert_allclose(height, [0.0, 0.10, 0.0, -np.inf], atol=1e-7)
    near, timed = course.events
    assert (near.box, near.distance, near.time, near.duration) == ("tilted", 1.0, None, 0.5)
    assert (timed.box, timed.distance, timed.time) == ("row_0", None, 4.0)
    np.testing.assert_allclose(near.T_world_box.R, np.eye(3), atol=1e-12)
    np.testing.assert_allclose(near.T_world_box.p - by_name["tilted"].T_world_box.p, (0.0, 0.0, 0.05), atol=1e-12)


def test_the_table_of_types_in_the_docs_is_complete():
    text = DOCS.read_text()
    for name, size in STOCK.items():
        written = re.search(rf"`{name}` ([0-9.]+) x ([0-9.]+) x ([0-9.]+)", text)
        assert written is not None
        assert tuple(float(value) for value in written.groups()) == size


def test_events_of_one_box_follow_each_other(tmp_path, monkeypatch):
    course = load_text(
        "start: {x: 0, y: 0}\ngoal: {x: 0, y: 0}\nobjects: [{name: a, size: [1, 1, 1], top: [0, 0, 0]}]\n"
        "events:\n- {box: a, time: 1, move_by: [0, 0, 1]}\n- {box: a, time: 2, move_by: [0, 0, 2]}\n",
        tmp_path,
        monkeypatch,
    )
    assert [event.T_world_box.p[2] for event in course.events] == [0.5, 2.5]


def test_a_generator_in_a_file_takes_the_seed_of_the_run(tmp_path, monkeypatch):
    text = "generator: {name: rough}\nevents:\n- {box: block_r04_c1, distance: 1.0, move_by: [0, 0, 0.08]}\n"
    course, plain = load_text(text, tmp_path, monkeypatch, seed=5), load_course("rough", 5)
    assert [box.T_world_box.p.tolist() for box in course.boxes] == [box.T_world_box.p.tolist() for box in plain.boxes]
    assert course.goal == plain.goal
    assert course.name == "c"
    assert [event.box for event in course.events] == ["block_r04_c1"]


GOOD_ENDS = "start: {x: 0, y: 0}\ngoal: {x: 0, y: 0}\n"
PAD = "objects:\n- {name: pad, size: [1, 1, 1], top: [0, 0, 0]}\n"
BROKEN = {
    "strat: {x: 0, y: 0}\ngoal: {x: 0}": (
        'c.yaml:1:1: unknown key "strat"; did you mean "start"? (allowed: start, goal, generator, objects, events)\n'
        'c.yaml:2:7: goal: missing key "y"'
    ),
    "objects: []": 'c.yaml:1:1: missing key "goal"\nc.yaml:1:1: missing key "start"',
    GOOD_ENDS + "objects: []": (
        "c.yaml:1:8: start: no box lies under the point (0, 0)\nc.yaml:2:7: goal: no box lies under the point (0, 0)"
    ),
    GOOD_ENDS + "objects:\n- {type: larg_block, top: [0, 0, 0]}\n- {size: [1, 1, 0], top: [0, 0, 0]}": (
        'c.yaml:4:10: objects[0].type: got "larg_block"; did you mean "large_block"? '
        "(allowed: small_block, medium_block, large_block, cinder_block, pallet, person)\n"
        "c.yaml:5:17: objects[1].size[2]: got 0, allowed: 0.001 .. 1000 m"
    ),
    GOOD_ENDS + "objects:\n- {top: [0, 0, 0], position: [0, 0, 0], yaw_deg: 1, rpy_deg: [1, 2, 3]}": (
        'c.yaml:4:3: objects[0]: needs either "position" or "top"\n'
        'c.yaml:4:3: objects[0]: needs either "type" or "size"\n'
        'c.yaml:4:3: objects[0]: takes "rpy_deg" or "yaw_deg", not both'
    ),
    GOOD_ENDS + "objects:\n- {type: ~, top: [0, 0, 0]}": ('c.yaml:4:3: objects[0]: needs either "type" or "size"'),
    GOOD_ENDS + "objects:\n- {name: a/b, type: pallet, top: [0, 0, 0]}": (
        'c.yaml:4:10: objects[0].name: got "a/b", allowed: letters, digits, _ and -'
    ),
    GOOD_ENDS + PAD + "- {name: pad, type: pallet, top: [0, 0, 0]}": (
        'c.yaml:5:3: objects[1]: the name "pad" is taken by another box'
    ),
    GOOD_ENDS + "objects:\n- {type: pallet, top: [0, 0, 0], repeat: [{count: 50, offset: [1, 0, 0]}, "
    "{count: 50, offset: [0, 1, 0]}]}": "c.yaml:4:3: objects[0]: more than 2000 boxes",
    GOOD_ENDS + PAD + "events:\n- {box: pad, after: 1}\n- {box: pad, after: 1}\n": (
        'c.yaml:6:3: events[0]: no event before it moves "pad", after which it could'
    ),
    GOOD_ENDS + PAD + "events:\n- {box: pda, time: 1}\n- {box: pad}\n- {box: pad, time: 1, distance: 2}\n"
    "- {box: pad, distance: -2}": (
        'c.yaml:6:9: events[0].box: no box "pda"; did you mean "pad"?\n'
        'c.yaml:7:3: events[1]: needs one of "distance", "time" and "after"\n'
        'c.yaml:8:3: events[2]: needs one of "distance", "time" and "after"\n'
        "c.yaml:9:24: events[3].distance: got -2, allowed: 0.001 .. 1000 m"
    ),
    "generator: {name: ruogh}": (
        'c.yaml:1:1: missing key "goal"\n'
        'c.yaml:1:1: missing key "start"\n'
        'c.yaml:1:19: generator.name: got "ruogh"; did you mean "rough"? '
        "(generators: flat, uneven_flat, uneven_field, rough, rough_wide, moved_blocks, detour)"
    ),
    "generator: {name: flat, width: 99, lenght: 3}": (
        'c.yaml:1:1: missing key "goal"\n'
        'c.yaml:1:1: missing key "start"\n'
        "c.yaml:1:32: generator.width: got 99, allowed: 0.6 .. 20 m\n"
        'c.yaml:1:36: generator: unknown key "lenght"; did you mean "length"? (allowed: length, width)'
    ),
    "generator: {name: rough, goal_y: 3}\n" + GOOD_ENDS: (
        "c.yaml:1:12: generator: goal_y: got 3, the pad reaches from -0.585 to 0.585 m"
    ),
    "generator: rough\n" + GOOD_ENDS: 'c.yaml:1:12: generator: needs a mapping with the key "name"',
}


@pytest.mark.parametrize("text", BROKEN)
def test_broken_courses_say_where_and_what(text, tmp_path, monkeypatch):
    with pytest.raises(YamlError) as caught:
        load_text(text, tmp_path, monkeypatch)
    assert str(caught.value) == BROKEN[text]


def test_a_missing_file_is_a_yaml_error():
    with pytest.raises(YamlError, match=r"nowhere\.yaml:1:1: cannot read the file: no such file"):
        load_course("nowhere.yaml")
