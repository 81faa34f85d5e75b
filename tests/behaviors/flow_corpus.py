"""Broken trees whose nodes are sound one by one but do not fit together, and what is said about them."""

from __future__ import annotations

from scripted import toys

from behaviors import Input, Leaf, Output, Registry, Status
from strict_yaml import shipped_folder

SHIPPED = sorted(path.stem for path in shipped_folder("trees").glob("*.yaml"))
measures = Registry()
for _cls in toys.classes:
    measures(_cls)


@measures
class GiveAngle(Leaf):
    """Gives an angle."""

    angle = Output(float, "an angle", unit="rad")

    def tick(self) -> Status:
        self.angle = 1.0
        return self.succeeded()


@measures
class TakeDistance(Leaf):
    """Takes a distance."""

    distance = Input(float, "a distance", unit="m", frame="world")

    def tick(self) -> Status:
        return self.succeeded()


@measures
class GiveInCamera(Leaf):
    """Gives a coordinate."""

    x = Output(float, "a coordinate", unit="m", frame="camera")

    def tick(self) -> Status:
        self.x = 1.0
        return self.succeeded()


# Text of a file, and what is said about it, one problem a line.
CORPUS: dict[str, tuple[str, str]] = {
    "read before write in a sequence": (
        """
tree: t
root:
  sequence:
    - AddOne: {in: {number: n}}
    - GiveNumber: {out: {number: n}}
""",
        't.yaml:4:29: /t/add_one: reads "n" before it is surely written, and waits for ever then; '
        "it is written by /t/give_number",
    ),
    "written on one branch of a selector alone": (
        """
tree: t
root:
  sequence:
    - selector:
        - GiveNumber: {out: {number: n}}
        - Scripted
    - AddOne: {in: {number: n}}
""",
        't.yaml:7:29: /t/add_one: reads "n" before it is surely written, and waits for ever then; '
        "it is written by /t/selector/give_number",
    ),
    "written by a child that may have failed": (
        """
tree: t
root:
  sequence:
    - force_success: {sequence: [Scripted, GiveNumber: {out: {number: n}}]}
    - AddOne: {in: {number: n}}
""",
        't.yaml:5:29: /t/add_one: reads "n" before it is surely written, and waits for ever then; '
        "it is written by /t/force_success/sequence/give_number",
    ),
    "written by one of the children of which one must succeed": (
        """
tree: t
root:
  sequence:
    - parallel: {succeed_after: 1, children: [Scripted, GiveNumber: {out: {number: n}}]}
    - AddOne: {in: {number: n}}
""",
        't.yaml:5:29: /t/add_one: reads "n" before it is surely written, and waits for ever then; '
        "it is written by /t/parallel/give_number",
    ),
    "a condition that reads what its child writes": (
        """
tree: t
root:
  run_while:
    condition: {AddOne: {in: {number: n}}}
    child: {GiveNumber: {out: {number: n}}}
""",
        't.yaml:4:39: /t/add_one: reads "n" before it is surely written, and waits for ever then; '
        "it is written by /t/give_number",
    ),
    "what an inhibited child gives": (
        """
tree: t
root:
  sequence:
    - inhibit: {condition: Scripted, child: {GiveNumber: {out: {number: n}}}}
    - AddOne: {in: {number: n}}
""",
        't.yaml:5:29: /t/add_one: reads "n" before it is surely written, and waits for ever then; '
        "it is written by /t/inhibit/give_number",
    ),
    "a safe stop that reads what a run may not have written": (
        """
tree: t
root: {GiveNumber: {out: {number: n}}}
safe_stop: {AddOne: {in: {number: n}}}
""",
        't.yaml:3:35: /safe_stop: reads "n" before it is surely written, and waits for ever then; it is written by /t',
    ),
    "a condition over a key that is written later": (
        """
tree: t
root:
  sequence:
    - check: n > 0
    - GiveNumber: {out: {number: n}}
""",
        't.yaml:4:14: /t/check: reads "n" before it is surely written, and fails then; it is written by /t/give_number',
    ),
    "nodes that nothing reaches": (
        """
tree: t
root:
  sequence:
    - loop_forever: Scripted
    - selector:
        - force_success: Scripted
        - Scripted
    - run_while: {condition: {inverter: {force_success: Scripted}}, child: Scripted}
""",
        """t.yaml:5:7: /t/selector: can never be reached: /t/loop_forever never succeeds
t.yaml:7:11: /t/selector/scripted: can never be reached: /t/selector/force_success never fails
t.yaml:8:76: /t/run_while/scripted: can never be reached: /t/run_while/inverter never succeeds""",
    ),
    "a fallback behind what never fails": (
        """
tree: t
root:
  selector:
    - retry: {attempts: 0, child: Scripted}
    - Scripted
""",
        "t.yaml:5:7: /t/scripted: can never be reached: /t/retry never fails",
    ),
    "a child whose condition never holds": (
        """
tree: t
root:
  run_while: {condition: {inverter: {force_success: Scripted}}, child: {Scripted: {name: never}}}
""",
        "t.yaml:3:73: /t/never: can never be reached: /t/inverter never succeeds",
    ),
    "more successes than children": (
        """
tree: t
root:
  sequence:
    - parallel: {succeed_after: 3, children: [Scripted, Scripted]}
    - Scripted
""",
        "t.yaml:5:7: /t/scripted: can never be reached: /t/parallel never succeeds",
    ),
    "deadlines that cannot be met": (
        """
tree: t
ports: {in: {n: float}}
root:
  sequence:
    - timeout: {after: 0.3, sequence: [Square: {in: {number: n}}, Square: {in: {number: n}, latency: 0.15}]}
    - timeout: {after: 1, repeat: {times: 4, Square: {in: {number: n}, latency: 0.3}}}
    - timeout: {after: 0.1, selector: [Square: {in: {number: n}}, Scripted]}
""",
        """t.yaml:5:7: /t/timeout: can never be met: /t/timeout/sequence takes 0.35 s at least, limit 0.3 s
t.yaml:6:7: /t/timeout_2: can never be met: /t/timeout_2/repeat takes 1.2 s at least, limit 1 s""",
    ),
    "units and frames": (
        """
tree: t
ports: {in: {far: {type: float, unit: km}, near: {type: float, unit: m, frame: pelvis}}}
root:
  sequence:
    - GiveAngle: {out: {angle: a}}
    - TakeDistance: {in: {distance: a}}
    - GiveInCamera: {out: [x]}
    - TakeDistance: {in: {distance: x}}
    - TakeDistance: {in: {distance: far}}
    - TakeDistance: {in: {distance: near}}
""",
        """t.yaml:6:37: /t/take_distance: "distance" has unit "m", but "a" has unit "rad" by "angle" of /t/give_angle
t.yaml:8:37: /t/take_distance_2: "distance" has frame "world", but "x" has frame "camera" by "x" of /t/give_in_camera
t.yaml:9:37: /t/take_distance_3: "distance" has unit "m", but "far" has unit "km" by the tree's input
t.yaml:10:37: /t/take_distance_4: "distance" has frame "world", but "near" has frame "pelvis" by the tree's input""",
    ),
    "units through a subtree": (
        """
tree: t
root:
  sequence:
    - GiveAngle: {out: {angle: a}}
    - subtree: {tree: s, in: {d: a}}
trees:
  s: {ports: {in: {d: {type: float, unit: m}}}, root: {AddOne: {in: {number: d}}}}
""",
        't.yaml:5:34: /t/s: "d" has unit "m", but "a" has unit "rad" by "angle" of /t/give_angle',
    ),
    "conditions": (
        """
tree: t
ports: {in: {n: float, on_top: bool, label: str}}
root:
  sequence:
    - check: m > 0
    - check: n > "three"
    - check: "on_top and n"
    - check: 'label == 3'
    - check: n + 1
    - check: n >
    - check: print(n)
    - check: n.real > 0
    - check: -label > 0
    - check: {}
    - check: {that: n > 0, taht: 3}
    - check: [n]
    - check: 3
    - check: n if on_top else 2
    - check: ""
""",
        """t.yaml:5:14: /t/check: nothing writes "m"
t.yaml:6:18: /t/check_2: cannot compare float with str
t.yaml:7:26: /t/check_3: needs bool, this is float
t.yaml:8:24: /t/check_4: cannot compare str with int
t.yaml:9:14: /t/check_5: a condition is true or false, this is float
t.yaml:10:14: /t/check_6: not a condition: invalid syntax
t.yaml:11:14: /t/check_7: not allowed here; a condition has keys, their fields, numbers, texts, true, false, and, or, \
not, == != < <= > >=, + - * and parentheses
t.yaml:12:16: /t/check_8: float has no field "real" (fields: none)
t.yaml:13:15: /t/check_9: needs a number, this is str
t.yaml:14:7: /t/check_10: check needs a condition, such as "check: left > 0"
t.yaml:15:28: /t/check_11: unknown key "taht"; did you mean "that"? (check: name, that)
t.yaml:16:7: /t/check_12: check needs a condition, such as "check: left > 0"
t.yaml:17:14: /t/check_13.that: got 3, needs text (quote it)
t.yaml:18:14: /t/check_14: not allowed here; a condition has keys, their fields, numbers, texts, true, false, and, or, \
not, == != < <= > >=, + - * and parentheses
t.yaml:19:15: /t/check_15: needs a condition on one line, such as left > 0""",
    ),
    "parameters that a use sets": (
        """
tree: t
root:
  sequence:
    - subtree: {tree: s, set: {nothing.value: 3}}
    - subtree: {tree: s, set: {give_number.valeu: 3}}
    - subtree: {tree: s, set: {give_number.value: 30}}
    - subtree: {tree: s, set: [3]}
    - subtree: {tree: s, sett: {}}
trees:
  s: {root: {sequence: [GiveNumber]}}
""",
        """t.yaml:4:32: /t/s: no node "nothing" below /t/s
t.yaml:5:32: /t/s_2/give_number: unknown key "valeu"; did you mean "value"? (allowed: value)
t.yaml:6:51: /t/s_3/give_number.value: got 30, allowed: -10 .. 10 m
t.yaml:7:31: /t/s_4: got a sequence, needs a mapping such as {plan/plan_footsteps.latency: 0.3}
t.yaml:8:26: /t/s_5: unknown key "sett"; did you mean "set"? (subtree: tree, name, in, out, set)""",
    ),
    "ports in long": (
        """
tree: t
ports:
  in: {a: {unit: m}, b: {type: flaot}, c: {type: float, untit: m}, D: float, e: {type: float, unit: 3}}
root: Scripted
""",
        """t.yaml:3:11: missing key "type" of port "a"
t.yaml:3:32: unknown type "flaot"; did you mean "float"? (types of ports: bool, float, int, str)
t.yaml:3:57: unknown key "untit"; did you mean "unit"? (keys of port "c": type, unit, frame)
t.yaml:3:68: got port "D"; a port is named in small letters, digits and "_"
t.yaml:3:101: got 3, needs text""",
    ),
    "an included tree that is not shipped": (
        "{tree: t, include: [look_and_stp], root: Scripted}",
        't.yaml:1:21: unknown tree "look_and_stp"; did you mean "look_and_step"? (shipped: '
        f"{', '.join(SHIPPED)}; or a .yaml file)",
    ),
}

REMARKS: dict[str, tuple[str, str]] = {
    "nobody reads it": (
        """
tree: t
root:
  sequence:
    - GiveNumber: {out: [number]}
    - subtree: {tree: s, out: {y: unread}}
    - subtree: {tree: s, name: again}
trees:
  s: {ports: {out: {y: float}}, root: {GiveNumber: {out: {number: y}}}}
""",
        """t.yaml:4:26: /t/give_number: nobody reads "number"; leave it unwired, or make it an output of the tree \
if people look at it
t.yaml:5:35: /t/s: nobody reads "unread"; leave it unwired, or make it an output of the tree if people look at it""",
    ),
    "a name of the tree around": (
        """
tree: t
root:
  sequence:
    - GiveNumber: {out: [number]}
    - AddOne: {in: [number]}
    - subtree: {tree: s}
trees:
  s: {root: {sequence: [GiveNumber: {out: [number]}, AddOne: {in: [number]}]}}
""",
        't.yaml:8:44: /t/s/give_number: "number" is a key of this subtree alone, the tree around has another: '
        "wire it, or rename it",
    ),
}
