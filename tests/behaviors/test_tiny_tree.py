from scripted import make, run

from behaviors import Outcome

TINY = """
tree: tiny
about: Squares a number, and adds one.
safe_stop: PauseWalking
root:
  sequence:
    - GiveNumber: {out: [number], value: 3.0}
    - Square: {in: [number], out: {square: result}, latency: 0.1}
    - subtree: {tree: increment, in: {start: result}, out: {end: answer}}

trees:
  increment:
    ports: {in: {start: float}, out: {end: float}}
    root:
      sequence:
        - AddOne: {in: {number: start}, out: {sum: larger}}
        - AddOne: {in: {number: larger}, out: {sum: end}}
"""


def test_a_tree_reads_ticks_and_ends():
    tree, robot = make(TINY)
    run(tree, robot, 5)
    assert tree.outcome is Outcome.RUNNING
    run(tree, robot, 1)
    assert tree.outcome is Outcome.SUCCESS, tree.reason
    assert tree.blackboard.values() == {"answer": 11.0, "increment/larger": 10.0, "number": 3.0, "result": 9.0}
    tree.shutdown()
