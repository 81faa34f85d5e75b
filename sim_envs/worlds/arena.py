"""The arena: the boxes of a course over a pit, as bodies that can be put elsewhere while the robot walks."""

from __future__ import annotations

from typing import Any

from dm_control import composer, mjcf

from sim_envs.courses import Box, Course
from skills.geometry.pose import Pose

# Contact and integration settings of the physics world; measured to walk at 1 ms with four contact points a foot.
_OPTIONS = {"timestep": 0.001, "cone": "elliptic", "impratio": 10.0, "integrator": "implicitfast", "iterations": 20}
_BOX_COLOURS = {"ground": (0.56, 0.58, 0.60, 1.0)}
_BLOCK_COLOUR = (0.74, 0.70, 0.64, 1.0)


class CourseArena(composer.Arena):
    """A course without a floor: a fall is a fall."""

    def _build(self, course: Course) -> None:
        self._mjcf_root = mjcf.RootElement(model="course")
        root: Any = self._mjcf_root
        # The free joint's frame has no mass of its own.
        root.compiler.angle = "radian"
        for name, value in _OPTIONS.items():
            setattr(root.option, name, value)
        self._bodies = {box.name: self._add_box(box) for box in course.boxes}

    def _add_box(self, box: Box) -> Any:
        pose = box.T_world_box
        root: Any = self._mjcf_root
        # A mocap body is static to the physics, yet may be moved.
        body = root.worldbody.add("body", name=box.name, pos=pose.p, quat=pose.quaternion_wxyz, mocap=True)
        colour = _BOX_COLOURS.get(box.kind, _BLOCK_COLOUR)
        body.add("geom", name=box.name, type="box", size=[0.5 * s for s in box.size], rgba=colour, mass=0)
        return body

    @property
    def box_bodies(self) -> dict[str, Any]:
        """Body of each box by name, in the order of the course."""
        return self._bodies

    def move_box(self, physics: mjcf.Physics, name: str, T_world_box: Pose) -> None:
        """Put one box elsewhere; it is there after the next kinematics or step."""
        bound: Any = physics.bind(self._bodies[name])
        bound.mocap_pos = T_world_box.p
        bound.mocap_quat = T_world_box.quaternion_wxyz
