"""The recording of a run as one `.rrd` file for the rerun viewer; the only place that imports rerun."""

from lookstep.recording.recording import Recording

__all__ = ["Recording"]
