"""An exception in any hook of any shipped leaf ends in a safe stop in the same cycle."""

from __future__ import annotations

import pytest
from scripted_walk import PARAMETERS, WalkingRobot

from behaviors import Outcome, Status, Tree, known_leaves, parse_tree
from behaviors.leaf import LeafNode
from behaviors.ports import declared_inputs

LEAVES = sorted(cls.__name__ for cls in known_leaves().classes if cls.__module__.startswith("behaviors."))
AFTER = 60.0  # What is around the leaf stops it then [s].


@pytest.mark.parametrize("hook", ["setup", "start", "tick", "stop"])
@pytest.mark.parametrize("name", LEAVES)
def test_safe_stop_in_the_same_cycle(name: str, hook: str, monkeypatch: pytest.MonkeyPatch):
    cls = known_leaves().get(name)
    assert cls is not None
    inputs = {port: told for port, told in declared_inputs(cls).items() if told.required}
    types = ", ".join(f"{port}: {told.type.__name__}" for port, told in inputs.items())
    root = f"{{timeout: {{after: {AFTER}, {name}: {{name: broken, in: {list(inputs)}}}}}}}"
    text = f"{{tree: t, ports: {{in: {{{types}}}}}, safe_stop: PauseWalking, root: {root}}}"
    robot = WalkingRobot()
    tree = Tree(parse_tree(text), robot, parameters=dict(PARAMETERS))
    node = tree.node("/t/broken")
    assert isinstance(node, LeafNode)
    node.replace_leaf(node.leaf)  # One that stands in does not wait for inputs.
    leaf = node.leaf
    for other in ("start", "stop"):
        monkeypatch.setattr(leaf, other, lambda: None)
    monkeypatch.setattr(leaf, "tick", lambda: Status.RUNNING)

    def broken() -> None:
        raise RuntimeError(f"broken {hook}")

    monkeypatch.setattr(leaf, hook, broken)
    ticks = 0
    while tree.outcome is Outcome.RUNNING and ticks < 5:
        assert "pause_walking" not in robot.commands
        robot.time = AFTER if ticks == 2 else tree.next_tick_time
        tree.tick()
        ticks += 1
    assert tree.outcome is Outcome.ERROR
    assert tree.reason == f"/t/broken: RuntimeError in {hook}: broken {hook}"
    assert ticks == (3 if hook == "stop" else 1)
    assert robot.commands.count("pause_walking") == 1
    assert all(node.status is Status.INVALID for node in tree.root.nodes)
    tree.shutdown()
