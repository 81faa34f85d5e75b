"""The walking controller at its own rate: balance, forces, momentum, torques, contacts and the quadratic program."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import rerun as rr

from lookstep import palette
from lookstep.recording.columns import Columns
from skills.footsteps import Side
from skills.walking import ControlSample
from skills.walking.quadratic_program import QpStatus

_PLANE_PERIOD = 0.1  # Points and support are drawn in the scene this often [s].
_LIFT = 0.02  # over the ground, so that they are seen [m]
_POINT_RADIUS = 0.018
_POINTS = {"CoM": palette.COM, "DCM": palette.DCM, "DCM planned": palette.DCM_PLANNED, "CoP": palette.COP}
_MEASURED = {"CoP measured": palette.COP_MEASURED}
_LEGS = 12  # joints of both legs come first in the plots of torques
_LANES = {"free": (70, 74, 82, 255), "loaded": (70, 170, 90, 255), "pressed in the air": (240, 180, 50, 255)}
_PHASES = {
    "standing": (120, 124, 130, 255),
    "transfer": (90, 150, 210, 255),
    "swing": (240, 180, 50, 255),
    "fallen": (214, 69, 65, 255),
}
_QP = {
    QpStatus.SOLVED.value: (70, 170, 90, 255),
    QpStatus.INACCURATE.value: (240, 180, 50, 255),
    QpStatus.FAILED.value: (214, 69, 65, 255),
}
_TOUCH = 80.0  # normal force of a loaded foot [N]

# Entity -> its curves; each is one column of what `_curves` returns.
_BALANCE_CURVES = tuple(_POINTS | _MEASURED)
_CURVES: dict[str, tuple[str, ...]] = {
    "control/lateral": _BALANCE_CURVES,
    "control/forward": tuple(name for name in _BALANCE_CURVES if name != "CoM"),
    "control/errors": ("DCM from its plan", "CoP measured from commanded"),
    "control/momentum": ("about x", "about y", "about z"),
    "control/forces": ("left, measured", "left, commanded", "right, measured", "right, commanded"),
    "control/qp": ("iterations", "time [us]"),
}
_COLORS: dict[str, tuple[palette.RGBA, ...]] = {
    "control/lateral": (*_POINTS.values(), *_MEASURED.values()),
    "control/forward": (*tuple(_POINTS.values())[1:], *_MEASURED.values()),
    "control/errors": (palette.DCM, palette.COP_MEASURED),
    "control/momentum": ((220, 80, 70, 255), (80, 170, 90, 255), (80, 130, 220, 255)),
    "control/forces": (palette.LEFT, palette.LEFT_TENTATIVE, palette.RIGHT, palette.RIGHT_TENTATIVE),
    "control/qp": (palette.MEASURED, palette.BUDGET),
}


class ControlViews:
    """Logs control samples to a recording.

    Args:
        stream: the recording.
        columns: takes lanes.
        joint_names: of the robot, in the order of its torques.
    """

    def __init__(self, stream: rr.RecordingStream, columns: Columns, joint_names: Sequence[str]) -> None:
        self._stream, self._columns = stream, columns
        self._samples: list[ControlSample] = []
        self._states: dict[str, str] = {}
        self._next_plane = 0.0
        for entity, names in _CURVES.items():
            style = rr.SeriesLines(colors=_COLORS[entity], names=list(names), widths=[1.5] * len(names))
            stream.log(entity, style, static=True)
        self._torques = {"control/torques/legs": slice(0, _LEGS), "control/torques/body": slice(_LEGS, None)}
        for entity, part in self._torques.items():
            stream.log(entity, rr.SeriesLines(names=list(joint_names[part])), static=True)
        for lane, states in (("phase", _PHASES), ("qp", _QP), *((side.value, _LANES) for side in Side)):
            colors = np.array(list(states.values()), dtype=np.uint8)
            configuration = rr.StateConfiguration(values=list(states), labels=list(states), colors=colors)
            stream.log(f"contacts/{lane}", configuration, static=True)

    def log(self, samples: Sequence[ControlSample]) -> None:
        """Take the samples of one tick of the tree."""
        self._samples += samples
        if samples and samples[-1].time >= self._next_plane:
            self._next_plane = samples[-1].time + _PLANE_PERIOD
            self._log_scene(samples[-1])

    def flush(self) -> None:
        """Send the curves of all samples since the last time."""
        if not self._samples:
            return
        samples, self._samples = self._samples, []
        times = [sample.time for sample in samples]
        torques = 100.0 * np.array([sample.torque_shares for sample in samples])
        parts = {entity: torques[:, part] for entity, part in self._torques.items()}
        self._columns.send_scalars(times, _curves(samples) | parts)
        self._lane("phase", times, [sample.phase.value for sample in samples])
        self._lane("qp", times, [sample.qp_status.value for sample in samples])
        for side in Side:
            self._lane(side.value, times, _contacts(samples, side))

    def _lane(self, name: str, times: Sequence[float], states: Sequence[str]) -> None:
        """Tell the changes of a lane."""
        for time, state in zip(times, states, strict=True):
            if self._states.get(name) != state:
                self._states[name] = state
                self._columns.state(f"contacts/{name}", time, state)

    def _log_scene(self, sample: ControlSample) -> None:
        """Support and points on the ground, as seen from above."""
        height = float(sample.cmp_world[2]) + _LIFT
        corners = sample.support_world
        outline = np.column_stack((corners, np.full(len(corners), height)))
        strip = np.vstack((outline, outline[:1]))
        self._stream.log("world/balance/support", rr.LineStrips3D([strip], colors=[palette.SUPPORT], radii=0.006))
        points = [sample.com_world, sample.dcm_world, sample.dcm_reference_world, sample.cop_world]
        points.append(sample.cop_measured_world)
        known = [index for index, point in enumerate(points) if np.all(np.isfinite(point))]
        colors = [*_POINTS.values(), *_MEASURED.values()]
        positions = [(points[index][0], points[index][1], height) for index in known]
        shown = rr.Points3D(positions, colors=[colors[index] for index in known], radii=_POINT_RADIUS)
        self._stream.log("world/balance/points", shown)


def _contacts(samples: Sequence[ControlSample], side: Side) -> list[str]:
    """What is under a foot: as measured, or as commanded where nothing measures it."""
    commanded = np.array([sample.wrenches_sole[side][2] for sample in samples]) > 0.0
    loads = np.array([sample.load(side) for sample in samples])
    unknown = np.isnan(loads)
    loaded = np.where(unknown, commanded, loads > _TOUCH)
    return np.where(loaded, "loaded", np.where(commanded, "pressed in the air", "free")).tolist()


def _curves(samples: Sequence[ControlSample]) -> dict[str, np.ndarray]:
    """What is plotted, by entity, (samples, curves): metres, millimetres, N m s, N."""
    com, dcm, planned, cop, measured = (
        np.array([getattr(sample, name) for sample in samples])
        for name in ("com_world", "dcm_world", "dcm_reference_world", "cop_world", "cop_measured_world")
    )
    forces = [
        (sample.load(side), sample.wrenches_sole[side][2]) for sample in samples for side in (Side.LEFT, Side.RIGHT)
    ]
    return {
        "control/lateral": np.column_stack([points[:, 1] for points in (com, dcm, planned, cop, measured)]),
        "control/forward": np.column_stack([points[:, 0] - com[:, 0] for points in (dcm, planned, cop, measured)]),
        "control/errors": 1e3
        * np.column_stack(([sample.dcm_error for sample in samples], np.linalg.norm(measured - cop, axis=1))),
        "control/momentum": np.array([sample.angular_momentum_world for sample in samples]),
        "control/forces": np.array(forces).reshape(len(samples), 4),
        "control/qp": np.array([(sample.qp_iterations, 1e6 * sample.qp_time) for sample in samples]),
    }
