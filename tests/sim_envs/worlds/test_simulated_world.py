"""A simulated world drives like a robot, sees what is there, and falls where a real robot would."""

import inspect
from dataclasses import replace

import numpy as np
import pytest
from small_worlds import slab, steps, world

from behaviors.robot import Robot, World
from sim_envs.courses import Box, BoxEvent
from sim_envs.worlds import PhysicsParameters, SimulatedWorld, StateDriftParameters, WorldKind
from skills.footsteps.footstep import Side
from skills.geometry.pose import Pose
from skills.walking import StepEventKind, WalkingPhase


def _robot(it: SimulatedWorld) -> Robot:
    return it  # The type checker proves the structure.


def _world(it: SimulatedWorld) -> World:
    return it


def _walk(it, footsteps, duration):
    it.send_footsteps(footsteps)
    it.advance(duration)
    return it.status()


def test_it_is_a_robot_and_a_world_by_structure_alone():
    it = world()
    assert _robot(it) is _world(it) is it
    for protocol in (Robot, World):
        for name, member in inspect.getmembers(protocol, lambda m: inspect.isfunction(m) or isinstance(m, property)):
            if not name.startswith("_"):
                assert hasattr(it, name)
                if inspect.isfunction(member):
                    assert list(inspect.signature(member).parameters)[1:] == list(
                        inspect.signature(getattr(it, name)).parameters
                    )


def test_a_walk_over_level_ground_ends_standing_on_the_last_footholds():
    it = world()
    status = _walk(it, steps(5), 8.0)
    assert (status.phase, status.failure) == (WalkingPhase.STANDING, "")
    np.testing.assert_allclose(it.state().stance.T_world_left.p, (1.2, 0.12, 0.0), atol=6e-3)
    np.testing.assert_allclose(it.state().stance.T_world_right.p, (1.2, -0.12, 0.0), atol=6e-3)
    events = it.drain_events()
    assert [(e.kind, e.step.sequence_id) for e in events] == [
        (kind, i) for i in range(5) for kind in (StepEventKind.STARTED, StepEventKind.COMPLETED)
    ]
    assert it.drain_events() == ()
    assert len(it.drain_log()) == 800


def test_mujoco_shows_the_soles_where_the_walker_says_they_are():
    it = world()
    it.send_footsteps(steps(5))
    for _ in range(20):
        it.advance(0.13)
        for side in Side:
            site = it.physics.data.ptr.site(f"atlas_class/{side.value}_sole")
            np.testing.assert_allclose(site.xpos, it.true_state().stance.sole(side).p, atol=2e-3)


def test_robot_time_runs_by_whole_control_steps_and_loses_nothing():
    it = world()
    for _ in range(300):
        it.advance(1 / 300)
    assert it.time == 1.0
    assert it.state().time == pytest.approx(it.time, abs=1e-9)


def test_frames_come_by_robot_time_and_do_not_depend_on_which_are_read():
    read, unread = world(seed=3), world(seed=3)
    first = read.depth_image("front")
    assert first is not None
    assert (first.frame_id, first.time) == (0, 0.0)
    for _ in range(10):
        read.advance(0.1)
        image = read.depth_image("front")
        assert image is read.depth_image("front")
    unread.advance(1.0)
    last, same = read.depth_image("front"), unread.depth_image("front")
    assert last is not None and same is not None
    assert last.frame_id == same.frame_id == 30
    np.testing.assert_array_equal(last.depth, same.depth)
    other = world(seed=4)
    other.advance(1.0)
    different = other.depth_image("front")
    assert different is not None
    assert np.any(different.depth != last.depth)


def test_an_image_shows_the_ground_where_it_is_and_the_robots_own_swinging_leg():
    it = world()
    standing = _seen_heights(it.depth_image("front"))
    np.testing.assert_allclose(standing, 0.0, atol=0.03)
    it.send_footsteps(steps(4))
    seen = []
    for _ in range(12):
        it.advance(0.2)
        seen.append(_seen_heights(it.depth_image("front")))
    assert np.mean(np.concatenate(seen) > 0.2) > 0.002


def _seen_heights(image):
    v, u = np.nonzero(image.depth)
    rays = np.column_stack(((u - image.camera.cx) / image.camera.fx, (v - image.camera.cy) / image.camera.fy, u**0))
    return (image.T_world_camera @ (rays * image.depth[v, u][:, None]))[:, 2]


def test_equal_seeds_walk_and_see_to_the_last_bit_alike():
    ends = []
    for _ in range(2):
        it = world(seed=7)
        _walk(it, steps(4), 2.5)
        image = it.depth_image("front")
        assert image is not None
        ends.append((it.physics.data.ptr.qpos.copy(), image.depth, it.state().dcm_world))
    for first, second in zip(*ends, strict=True):
        np.testing.assert_array_equal(first, second)


def test_a_step_into_a_block_is_a_fall_and_stays_one():
    block = Box("block", (0.6, 0.5, 0.2), Pose.from_xyz_rpy((0.75, 0.25, 0.1)), "block")
    it = world(slab(), block)
    status = _walk(it, steps(4), 6.0)
    assert status.phase is WalkingPhase.FALLEN
    assert "left sole swung" in status.failure
    fallen_at = it.true_state().T_world_pelvis.p
    again = _walk(it, steps(4), 2.0)
    assert (again.phase, again.failure) == (WalkingPhase.FALLEN, status.failure)
    np.testing.assert_array_equal(it.true_state().T_world_pelvis.p, fallen_at)
    assert it.time == pytest.approx(8.0)


def test_a_step_on_air_is_a_fall():
    it = world(slab(x_end=0.4))
    status = _walk(it, steps(4), 6.0)
    assert status.phase is WalkingPhase.FALLEN
    assert status.failure


@pytest.mark.parametrize("kind", WorldKind)
def test_a_foot_that_finds_no_ground_at_its_foothold_sinks_until_it_does(kind):
    it = world(kind=kind)
    status = _walk(it, steps(4, height=0.03), 6.0)
    assert (status.phase, status.failure) == (WalkingPhase.STANDING, "")
    assert abs(it.true_state().stance.T_world_left.p[2]) < 3e-3


def test_a_foothold_out_of_reach_is_a_fall():
    status = _walk(world(), steps(3, length=1.6), 6.0)
    assert status.phase is WalkingPhase.FALLEN
    assert status.failure


def test_a_standing_robot_falls_when_the_ground_is_taken_away():
    it = world()
    it.move_box("slab", Pose.from_xyz_rpy((0.0, 0.0, -1.0)))
    it.advance(1.0)
    assert "stood on ground" in it.status().failure


def test_a_scripted_box_moves_when_the_robot_comes_near_and_is_seen_there():
    lid = Box("lid", (0.4, 0.4, 0.02), Pose.from_xyz_rpy((1.6, 0.0, -0.3)), "block")
    away = BoxEvent("lid", Pose.from_xyz_rpy((1.6, 0.0, 0.3), (0.0, 0.0, 0.5)), duration=0.5, distance=1.2)
    it = world(slab(), lid, events=(away,))
    it.advance(1.0)
    assert it.box_poses()["lid"][0] == (1.6, 0.0, -0.3)
    _walk(it, steps(4), 5.0)
    position, quaternion = it.box_poses()["lid"]
    np.testing.assert_allclose(position, (1.6, 0.0, 0.3))
    np.testing.assert_allclose(quaternion, away.T_world_box.quaternion_wxyz)
    np.testing.assert_allclose(it.ground.ground_height(np.array([[1.6, 0.0]])), 0.31)
    geom = it.model.geom("lid").id
    np.testing.assert_allclose(it.geom_poses()[0][geom], (1.6, 0.0, 0.3))


def test_moving_an_unknown_box_names_those_that_exist():
    with pytest.raises(ValueError, match=r"got box 'wall', small has slab"):
        world().move_box("wall", Pose.identity())


def test_a_start_beside_the_ground_is_refused():
    with pytest.raises(ValueError, match="no ground under the left foot"):
        world(start=(50.0, 0.0, 0.0))


def test_the_robot_starts_on_both_feet_with_the_heading_of_the_course():
    state = world(start=(0.5, 0.2, 0.6)).state()
    assert state.stance.yaw == pytest.approx(0.6)
    np.testing.assert_allclose(state.stance.mid_feet, (0.5, 0.2, 0.0), atol=1e-8)
    assert state.T_world_pelvis.yaw == pytest.approx(0.6, abs=1e-3)


def test_a_drifting_estimate_leaves_the_truth_and_commands_follow_the_estimate():
    it = world(drift=StateDriftParameters(velocity=(0.01, 0.0, 0.0), yaw_jump=0.1, yaw_jump_time=0.5))
    it.advance(2.0)
    true, estimated = it.true_state(), it.state()
    assert estimated.T_world_pelvis.p[0] - true.T_world_pelvis.p[0] == pytest.approx(0.02, abs=1e-3)
    assert estimated.T_world_pelvis.yaw - true.T_world_pelvis.yaw == pytest.approx(0.1)
    image = it.depth_image("front")
    assert image is not None
    p_pelvis_camera = estimated.T_world_pelvis.inverse @ image.T_world_camera.p
    true_camera = it.physics.data.ptr.camera("atlas_class/front").xpos
    np.testing.assert_allclose(p_pelvis_camera, true.T_world_pelvis.inverse @ true_camera, atol=1e-9)

    # A step to where the robot believes its left foot to be leaves the foot where it truly is.
    stay = replace(steps(1)[0], T_world_sole=estimated.stance.T_world_left)
    it.send_footsteps((stay,))
    it.advance(3.0)
    np.testing.assert_allclose(it.true_state().stance.T_world_left.p, true.stance.T_world_left.p, atol=3e-3)
    assert it.status().failure == ""


def test_physics_gets_what_its_parameters_say_and_the_robot_does_not_know():
    physics = PhysicsParameters(friction=0.55, time_step=0.0005, torso_mass_error=0.1)
    it, plain = (SimulatedWorld(world().course, WorldKind.PHYSICS, physics=p) for p in (physics, PhysicsParameters()))
    assert it.model.opt.timestep == 0.0005
    assert it.model.geom("atlas_class/left_foot_collision").friction[0] == 0.55
    assert it.model.body("atlas_class/torso").mass[0] == pytest.approx(
        1.1 * plain.model.body("atlas_class/torso").mass[0]
    )


def test_a_push_moves_the_dcm_by_its_impulse():
    it = SimulatedWorld(world().course, WorldKind.PHYSICS)
    it.advance(0.5)
    before = it.true_state().dcm_world
    it.push(np.array((0.0, 3000.0, 0.0)))
    it.advance(0.01)
    it.push(np.zeros(3))
    mass, omega = float(it.model.body_mass.sum()), np.sqrt(9.81 / 1.12)
    assert (it.true_state().dcm_world - before)[1] == pytest.approx(30.0 / mass / omega, rel=0.1)
    with pytest.raises(ValueError, match="knows no forces"):
        world().push(np.zeros(3))


def test_the_feet_feel_the_forces_that_the_controller_commands():
    it = SimulatedWorld(world().course, WorldKind.PHYSICS)
    it.send_footsteps(steps(2))
    it.advance(2.0)
    samples = it.drain_log()[1:]  # Before the first step nothing has been felt.
    assert np.median([sample.cop_error for sample in samples]) < 5e-3
    for side in Side:
        loads = np.array([(sample.load(side), sample.wrenches_sole[side][2]) for sample in samples])
        assert np.median(np.abs(loads[:, 0] - loads[:, 1])) < 50.0
    single = [sample for sample in samples if not all(sample.stands_on(side) for side in Side)]
    assert len(single) > 100
