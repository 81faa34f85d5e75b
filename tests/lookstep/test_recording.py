"""What a recording holds, read back from the file."""

import pytest
from rerun.chunk import RrdReader

import lookstep


@pytest.fixture(scope="module")
def chunks(tmp_path_factory):
    path = tmp_path_factory.mktemp("recording") / "walk.rrd"
    lookstep.run(course="rough", time_limit=2.5, record=path, film=1.0, assignments=("camera.resolution=0.3125",))
    return list(RrdReader(path).stream().to_chunks())


def entities(chunks):
    return {chunk.entity_path for chunk in chunks}


def test_recording_shows_robot_course_regions_steps_and_goal(chunks):
    assert entities(chunks) >= {
        "/world/course",
        "/world/robot/pelvis",
        "/world/robot/left_shin",
        "/world/ground/outlines",
        "/world/ground/surfaces",
        "/world/plan/steps",
        "/world/path",
        "/world/sub_goal",
        "/world/goal",
        "/world/camera/front",
    }


def test_recording_shows_what_the_camera_saw_and_what_became_of_it(chunks):
    assert entities(chunks) >= {
        *(f"/camera/front/{name}" for name in ("depth", "regions", "rejected")),
        "/noise/own",
        "/noise/shared",
    }


def test_recording_shows_the_heights_around_and_what_the_map_forgot(chunks):
    assert entities(chunks) >= {"/height_map", "/world/around/height_map", "/world/around/scan", "/map", "/drift/shift"}


def test_recording_has_a_lane_for_every_node_of_the_tree(chunks):
    from behaviors import load_tree
    from lookstep.trees import tree_path

    lanes = {entity for entity in entities(chunks) if entity.startswith("/tree/")}
    assert len(lanes) == len(list(load_tree(tree_path("look_and_step"))))


def test_recording_has_timing_control_signals_and_reasons(chunks):
    assert entities(chunks) >= {
        "/timing/PlanFootsteps/used",
        "/timing/PlanFootsteps/budget",
        "/timing/ExtractRegions/used",
        "/control/errors",
        "/control/lateral",
        "/control/torques/legs",
        "/contacts/phase",
        "/world/balance/support",
        "/film",
        "/deadlines/plan_footsteps",
        "/deadlines/remember_ground",
        "/margins/extract_regions",
        "/margins/plan_footsteps/before_landing",
        "/log",
        "/about",
    }


def test_links_move_on_the_robots_clock(chunks):
    rows = sum(
        chunk.num_rows
        for chunk in chunks
        if chunk.entity_path == "/world/robot/pelvis" and "robot_time" in chunk.timeline_names
    )
    assert rows >= 40
