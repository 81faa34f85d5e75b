"""The arena: the boxes of a course over a pit, as bodies that can be put elsewhere while the robot walks."""

from __future__ import annotations

from typing import Any

from dm_control import composer, mjcf

from sim_envs.courses import Box, Course
from skills.geometry.pose import Pose

_BLOCK_COLOR = (0.76, 0.70, 0.62, 1.0)
_COLORS = {"pad": (0.60, 0.62, 0.64, 1.0), "base": (0.48, 0.47, 0.46, 1.0), "pallet": (0.74, 0.60, 0.42, 1.0)}


class CourseArena(composer.Arena):
    """A course without a floor: a fall is a fall."""

    def _build(self, course: Course) -> None:
        self._mjcf_root = mjcf.RootElement(model="course")
        root: Any = self._mjcf_root
        root.compiler.angle = "radian"
        # Elliptic friction cones and a stiff tangential direction: feet that push off must not creep.
        root.option.cone, root.option.impratio = "elliptic", 10
        root.option.integrator, root.option.iterations = "implicitfast", 20
        self._bodies = {box.name: self._add_box(box) for box in course.boxes}

    def _add_box(self, box: Box) -> Any:
        pose = box.T_world_box
        root: Any = self._mjcf_root
        # A mocap body is static to the physics, yet may be moved.
        body = root.worldbody.add("body", name=box.name, pos=pose.p, quat=pose.quaternion_wxyz, mocap=True)
        color = _COLORS.get(box.kind, _BLOCK_COLOR)
        body.add("geom", name=box.name, type="box", size=[0.5 * s for s in box.size], rgba=color, mass=0)
        return body

    def move_box(self, physics: mjcf.Physics, name: str, T_world_box: Pose) -> None:
        """Put one box elsewhere; it is there after the next kinematics or step."""
        bound: Any = physics.bind(self._bodies[name])
        bound.mocap_pos = T_world_box.p
        bound.mocap_quat = T_world_box.quaternion_wxyz
