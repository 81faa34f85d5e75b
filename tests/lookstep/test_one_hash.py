"""One seed, one trace, whatever the machine is busy with: workers, recording, speed of the simulation."""

from __future__ import annotations

from functools import partial
from pathlib import Path

import pytest

import lookstep
from behaviors import Executor
from lookstep import walk

SMALL_CAMERA = ("camera.resolution=0.3125",)


def trace_hash(seconds: float, course: str = "flat", **options) -> str:
    options = {"world": "kinematic", **options}
    return lookstep.run(course=course, time_limit=seconds, assignments=SMALL_CAMERA, **options).trace_hash


def test_one_worker_and_two_and_any_speed_give_one_hash(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    hashes = {trace_hash(0.6, speed=4.0), trace_hash(0.6, out=tmp_path / "out")}
    monkeypatch.setattr(walk, "Executor", partial(Executor, workers=1))
    hashes.add(trace_hash(0.6))
    assert len(hashes) == 1


@pytest.mark.sweep
@pytest.mark.timeout(1800)
def test_twenty_walks_of_one_seed_have_one_hash(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    hashes = []
    for workers in (1, 2):
        monkeypatch.setattr(walk, "Executor", partial(Executor, workers=workers))
        for speed in (None, 0.25, 1.0, 10.0):
            hashes.append(trace_hash(4.0, "rough", speed=speed))
        hashes += [trace_hash(4.0, "rough", out=tmp_path / f"{workers}_{index}") for index in range(3)]
        record = tmp_path / f"{workers}.rrd"
        hashes += [trace_hash(4.0, "rough", record=record) for _ in range(3)]
    assert len(hashes) == 20 and len(set(hashes)) == 1
