"""What leaves see of a robot is in the world, whatever its odometry does; what they command goes back."""

from __future__ import annotations

import numpy as np
from leaves.scripted_walk import WalkingRobot, feet_at, step

from behaviors.robot_view import RobotView
from skills.geometry import Pose
from skills.walking import StepEvent, StepEventKind

T = Pose.from_xyz_rpy((0.3, -0.2, 0.1), (0.0, 0.0, 0.4))


class DriftingRobot(WalkingRobot):
    def drain_events(self) -> tuple[StepEvent, ...]:
        return (StepEvent(StepEventKind.STARTED, self.time, step(0), step(0).T_world_sole),)


def test_without_a_correction_everything_passes_as_it_is():
    robot = WalkingRobot()
    robot.frame_id = 0
    view = RobotView(robot)
    view.begin_tick()
    steps = (step(0),)
    view.send_footsteps(steps)
    assert robot.queue is steps
    assert view.status() is robot.status()


def test_state_status_events_and_images_are_moved_into_the_world():
    robot = DriftingRobot()
    robot.frame_id = 0
    robot.swing(step(2))
    view = RobotView(robot)
    view.correct(T)
    view.begin_tick()
    left = T @ feet_at(0.0).T_world_left
    np.testing.assert_allclose(view.state().stance.T_world_left.p, left.p)
    current = view.status().current_step
    assert current is not None
    np.testing.assert_allclose(current.T_world_sole.p, (T @ step(2).T_world_sole).p)
    np.testing.assert_allclose(view.events[0].T_world_sole.p, (T @ step(0).T_world_sole).p)
    image, estimated = view.depth_image("front"), robot.depth_image("front")
    assert image is not None and estimated is not None
    np.testing.assert_allclose(image.T_world_camera.p, (T @ estimated.T_world_camera).p)
    np.testing.assert_allclose(image.T_world_odometry.p, T.p)


def test_a_step_to_where_a_foot_is_seen_leaves_that_foot_where_it_is():
    robot = WalkingRobot()
    view = RobotView(robot)
    view.correct(T)
    view.begin_tick()
    seen = view.status().imminent_stance.T_world_left
    view.send_footsteps((step(0).moved(seen @ step(0).T_world_sole.inverse),))
    (sent,) = robot.queue
    np.testing.assert_allclose(sent.T_world_sole.p, feet_at(0.0).T_world_left.p, atol=1e-12)
    np.testing.assert_allclose(sent.T_world_sole.R, feet_at(0.0).T_world_left.R, atol=1e-12)


def test_a_correction_holds_at_once_for_the_tick_that_finds_it():
    robot = WalkingRobot()
    view = RobotView(robot)
    view.begin_tick()
    before = view.state()
    view.correct(T)
    np.testing.assert_allclose(view.state().stance.T_world_left.p, (T @ before.stance.T_world_left).p)
