"""A tree that is halted at any moment: each running leaf is stopped once, no other is, and no computation is left."""

from __future__ import annotations

import random

from scripted import ScriptedRobot, Square, run, toys

from behaviors import Executor, JobOutcome, Outcome, Registry, Status, Tree, TreeSpec, parse_tree
from behaviors.leaf import LeafNode
from strict_yaml import YamlError

TREES, HALTS = 50, 20

COMPOSITES = ["sequence", "reactive_sequence", "selector", "reactive_selector", "parallel", "reactive_parallel"]
DECORATORS = {
    "inverter": "",
    "force_success": "",
    "force_failure": "",
    "retry": "attempts: 2, ",
    "repeat": "times: 2, ",
    "loop_forever": "",
    "timeout": "after: 0.5, ",
    "rate_limit": "period: 0.05, ",
    "run_while": "condition: {Scripted: {says: SSF}}, ",
    "suppress": "condition: {Scripted: {says: FSF}}, ",
    "inhibit": "condition: {Scripted: {says: FSF}}, ",
    "halt_unless": "condition: {Scripted: {says: SSF}}, ",
    "pause_on_failure": "",
    "reset": "condition: {Scripted: {says: FSF}}, ",
}

calls: list[str] = []
counted = Registry()
for _cls in toys.classes:
    if _cls.__name__ != "Square":
        counted(_cls)


@counted
class Counted(Square):
    """Squares a number, and remembers that it was started and stopped."""

    def start(self) -> None:
        calls.append("start")

    def stop(self) -> None:
        calls.append("stop")
        super().stop()


def random_tree(chance: random.Random) -> TreeSpec:
    """A tree of all kinds of nodes that passes the checks."""
    while True:
        try:
            root = f"{{loop_forever: {{child: {random_node(chance, 4, leaf='Counted')}}}}}"
            return parse_tree(f"{{tree: t, ports: {{in: {{n: float}}}}, root: {root}}}", counted)
        except YamlError as error:
            assert all("can never be" in problem.message for problem in error.problems)


def random_node(chance: random.Random, depth: int, *, key: str = "n", leaf: str = "Square") -> str:
    """A node as a tree file writes it; computing leaves read a key."""
    if depth == 0 or chance.random() < 0.2:
        latency = chance.choice([0.0, 0.02, 0.1, 0.3])
        says = "".join(chance.choice("SFRRR") for _ in range(4))
        computing = f"{{{leaf}: {{in: {{number: {key}}}, latency: {latency}}}}}"
        return chance.choice([f"{{Scripted: {{says: {says}}}}}", computing])
    below = [random_node(chance, depth - 1, key=key, leaf=leaf) for _ in range(chance.randint(1, 3))]
    if chance.random() < 0.4:
        kind, options = chance.choice(list(DECORATORS.items()))
        return f"{{{kind}: {{{options}child: {below[0]}}}}}"
    return f"{{{chance.choice(COMPOSITES)}: [{', '.join(below)}]}}"


def test_a_thousand_random_halts_stop_each_running_leaf_once_and_leave_no_job():
    chance = random.Random(0)
    halted_running = 0
    for _ in range(TREES):
        spec = random_tree(chance)
        for _ in range(HALTS):
            robot = ScriptedRobot()
            tree = Tree(spec, robot, executor=Executor(workers=1))
            calls.clear()
            tree.set_input("n", 3.0)
            run(tree, robot, chance.randint(1, 12))
            leaves = [node for node in tree.nodes if isinstance(node, LeafNode)]
            scripted = [node.leaf for node in leaves if node.kind == "Scripted"]
            running = [node for node in leaves if node.active]
            stops = {id(leaf): leaf.calls.count("stop") for leaf in scripted}  # type: ignore[attr-defined]
            stopped = calls.count("stop")
            assert tree.outcome is Outcome.RUNNING
            tree.root.stop(Status.INVALID)
            halted_running += len(running)
            for node in leaves:
                if node.kind == "Scripted":
                    more = node.leaf.calls.count("stop") - stops[id(node.leaf)]  # type: ignore[attr-defined]
                    assert more == (node in running)
            assert calls.count("stop") - stopped == sum(node.kind == "Counted" for node in running)
            assert tree.context.executor.pending == ()
            assert all(node.status is Status.INVALID and not node.active for node in leaves)
            assert not tree.faults
            tree.shutdown()
            jobs = tree.drain_jobs()
            assert len({job.job_id for job in jobs}) == len(jobs)
            assert all(job.outcome in (JobOutcome.DELIVERED, JobOutcome.CANCELLED) for job in jobs)
    assert halted_running > 500
