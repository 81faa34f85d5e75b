"""Trees in other forms say the same: YAML in one layout with all comments, and BehaviorTree.CPP's XML and logs."""

from __future__ import annotations

import random
import re
import sqlite3
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest
from scripted import make, run, toys
from test_halts import random_node

from behaviors import Registry, Trace, known_leaves, parse_tree
from behaviors.interchange import read_written, read_xml, write_groot_log, write_palette, write_xml, write_yaml
from behaviors.interchange.comments import _comments
from behaviors.recorded_trace import RecordedTrace
from strict_yaml import YamlError, shipped_folder

SHIPPED = sorted(shipped_folder("trees").glob("*.yaml"))


def shipped_leaves() -> Registry:
    registry = Registry()
    for cls in known_leaves().classes:
        if cls.__module__.startswith("behaviors."):
            registry(cls)
    return registry


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_shipped_trees_come_back_from_yaml_and_from_xml(path: Path):
    text, registry = path.read_text(), shipped_leaves()
    written = read_written(text, str(path), registry)
    again = write_yaml(written)
    assert read_written(again, str(path.with_name("copy.yaml")), registry) == written
    assert sorted(comment.text for comment in _comments(again)) == sorted(comment.text for comment in _comments(text))
    assert read_xml(write_xml(written, registry), registry) == written


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_shipped_trees_are_written_in_the_one_layout(path: Path):
    assert write_yaml(read_written(path.read_text(), str(path), shipped_leaves())) == path.read_text()


def generated(chance: random.Random) -> str:
    """A sound tree file of all kinds of nodes, with subtrees, conditions, ports, parameters, names and comments."""
    while True:
        comments = iter(f'# {index}: say "#{index}"' for index in range(1000))
        text = f"""{next(comments)}
tree: t
about: "A tree: {chance.randrange(100)}, or # another"
ports: {{in: {{n: {{type: float, unit: m, frame: world}}, near: bool}}, out: {{}}}} {next(comments)}
root:
  sequence:
    {next(comments)}
    - {random_node(chance, 4)} {next(comments)}
    - subtree: {{tree: a, name: Use {chance.randrange(9)}, in: {{x: n}}}}
    - {random_node(chance, 2)}
    - check: {chance.choice(["n > 0 and not near", "near or n * 2 <= 3.5", "not (near and n == 1)"])}
safe_stop: {chance.choice(["PauseWalking", "{sequence: [PauseWalking]}"])}
trees:
  {next(comments)}
  a: {{about: Inside., ports: {{in: {{x: float}}}}, root: {{retry: {{attempts: {chance.randrange(4)},
    child: {random_node(chance, 2, key="x")}}}}}}}
"""
        try:
            read_written(text, registry=toys)
            return text
        except YamlError as error:
            assert all("can never be" in problem.message for problem in error.problems), error


def check_generated(count: int) -> None:
    chance = random.Random(1)
    for _ in range(count):
        text = generated(chance)
        written = read_written(text, registry=toys)
        again = write_yaml(written)
        assert read_written(again, registry=toys) == written
        assert write_yaml(read_written(again, registry=toys)) == again
        assert sorted(c.text for c in _comments(again)) == sorted(c.text for c in _comments(text))
        assert read_xml(write_xml(written, toys), toys) == written


def test_generated_trees_come_back_from_yaml_with_their_comments_and_from_xml():
    check_generated(10)


@pytest.mark.sweep
@pytest.mark.timeout(1200)
def test_a_thousand_generated_trees_come_back():
    check_generated(1000)


def test_xml_uses_the_names_of_the_library_where_it_has_the_node():
    text = """
tree: t
root:
  selector:
    - retry: {attempts: 0, child: Scripted}
    - timeout: {after: 0.5, child: {Scripted: {name: The second, says: RF}}}
    - parallel: {succeed_after: 1, fail_after: 0, children: [Scripted, {inverter: Scripted}]}
    - rate_limit: {period: 0.1, child: Scripted}
    - Succeed
"""
    registry = Registry()
    for cls in (*toys.classes, *(cls for cls in shipped_leaves().classes if cls.__name__ == "Succeed")):
        registry(cls)
    try:
        xml = write_xml(read_written(text.replace("attempts: 0", "attempts: 2").lstrip(), registry=registry), registry)
    except YamlError as error:
        pytest.fail(str(error))
    root = ElementTree.fromstring(xml)
    assert root.attrib == {"BTCPP_format": "4", "main_tree_to_execute": "t"}
    fallback = root.find("BehaviorTree/Fallback")
    assert fallback is not None
    said = [(element.tag, dict(element.attrib)) for element in fallback]
    assert said == [
        ("RetryUntilSuccessful", {"num_attempts": "2"}),
        ("Timeout", {"msec": "500"}),
        ("Parallel", {"success_count": "1", "failure_count": "-1"}),
        ("RateLimit", {"period": "0.1"}),
        ("AlwaysSuccess", {}),
    ]
    models = {element.attrib["ID"]: element.tag for element in root.findall("TreeNodesModel/*")}
    assert models == {"RateLimit": "Decorator", "Scripted": "Action", "t": "SubTree"}


# The first three are the shapes of BehaviorTree.CPP's own examples and fuzzing corpus.
COMMON = {
    "one leaf": '<root main_tree_to_execute="a"><BehaviorTree ID="a"><AlwaysSuccess /></BehaviorTree></root>',
    "a sequence": '<root BTCPP_format="4"><BehaviorTree ID="main"><Sequence name="root"><AlwaysSuccess name="success"/>'
    "</Sequence></BehaviorTree></root>",
    "decorators": '<root BTCPP_format="4"><BehaviorTree ID="main"><Fallback><Inverter><AlwaysSuccess/></Inverter>'
    '<RetryUntilSuccessful num_attempts="3"><AlwaysFailure/></RetryUntilSuccessful><Repeat num_cycles="-1">'
    '<Sleep msec="250"/></Repeat></Fallback></BehaviorTree></root>',
    "explicit tags": '<root BTCPP_format="4"><BehaviorTree ID="main"><Control ID="Sequence">'
    '<Action ID="AlwaysSuccess"/>'
    '<Decorator ID="ForceSuccess"><Action ID="Sleep" msec="10"/></Decorator></Control></BehaviorTree></root>',
    "a subtree": '<root BTCPP_format="4" main_tree_to_execute="main"><BehaviorTree ID="main"><Sequence>'
    '<SubTree ID="inner" name="first"/><ScriptCondition code="x &gt; 1 &amp;&amp; !y"/></Sequence></BehaviorTree>'
    '<BehaviorTree ID="inner"><AlwaysSuccess/></BehaviorTree></root>',
}


@pytest.mark.parametrize("name", COMMON)
def test_xml_of_common_nodes_alone_is_read(name: str):
    written = read_xml(COMMON[name], shipped_leaves())
    assert read_xml(write_xml(written, shipped_leaves()), shipped_leaves()) == written
    if name == "a subtree":
        assert written.tree.root.children[1].settings == (("that", "x > 1 and not y"),)


def test_xml_of_others_becomes_a_sound_tree_with_names_of_ours(tmp_path: Path):
    (tmp_path / "parts").mkdir()
    (tmp_path / "parts" / "rest.xml").write_text(
        '<root BTCPP_format="4"><BehaviorTree ID="SleepAWhile"><Sequence name="SleepSequence"><Sleep msec="300"/>'
        "<AlwaysSuccess/></Sequence></BehaviorTree></root>"
    )
    main = tmp_path / "main.xml"
    main.write_text(
        """<?xml version="1.0"?>
<root BTCPP_format="4" main_tree_to_execute = "Main">
  <include path="parts/rest.xml"/>
  <BehaviorTree ID="Main">
    <Sequence>
      <SubTree ID="SleepAWhile" name="FirstSubtree"/>
      <SubTree ID="SleepAWhile" name="SecondSubtree"/>
    </Sequence>
  </BehaviorTree>
  <!-- Models as Groot writes them. -->
  <TreeNodesModel><Action ID="Sleep" editable="true"><input_port name="msec"/></Action></TreeNodesModel>
</root>
"""
    )
    yaml = write_yaml(read_xml(main.read_text(), shipped_leaves(), str(main)))
    spec = parse_tree(yaml, shipped_leaves())
    assert [node.path for node in spec][:4] == [
        "/main",
        "/main/firstsubtree",
        "/main/firstsubtree/wait",
        "/main/firstsubtree/succeed",
    ]
    assert next(node.parameters.duration for node in spec if node.kind == "Wait") == 0.3
    (tmp_path / "parts" / "rest.xml").write_text('<root><include path="../main.xml"/></root>')
    with pytest.raises(YamlError, match="files include one another") as error:
        read_xml(main.read_text(), shipped_leaves(), str(main))
    assert error.value.problems[0].location.file.endswith("rest.xml")


FOREIGN = {
    "<SaySomething message='hello'/>": ["1:55: node <SaySomething> is not supported"],
    "<Sequence><OpenDoor/><CloseDoor/></Sequence>": [
        "1:65: node <OpenDoor> is not supported",
        "1:76: node <CloseDoor> is not supported",
    ],
    '<Sequence _skipIf="x"><AlwaysSuccess/></Sequence>': [
        '1:55: attribute "_skipIf" of <Sequence> is not supported (attributes: name)'
    ],
    "<Switch2 variable='{x}'><AlwaysSuccess/><AlwaysSuccess/></Switch2>": ["1:55: node <Switch2> is not supported"],
    "<Inverter><AlwaysSuccess/><AlwaysSuccess/></Inverter>": ["1:55: <Inverter> has 2 children, needs 1"],
    "<Sequence/>": ["1:55: <Sequence> has no children"],
    "<Repeat num_cycles='{n}'><AlwaysSuccess/></Repeat>": ['1:55: num_cycles: got "{n}", needs a whole number'],
    "<PlanBodyPath goal='near the door'/>": ['1:55: goal: got "near the door", needs a key such as "{goal}"'],
    "<PlanBodyPath latency='soon'/>": ['1:55: latency: got "soon", needs float'],
    "<RecoveryNode number_of_retries='6'><PlanBodyPth/></RecoveryNode>": [
        "1:55: node <RecoveryNode> is not supported",
        '1:91: node <PlanBodyPth> is not supported; did you mean "PlanBodyPath"?',
    ],
}


@pytest.mark.parametrize("body", FOREIGN)
def test_xml_that_says_more_is_refused_with_every_place(body: str):
    xml = f'<root BTCPP_format="4"><BehaviorTree ID="main_tree_1">{body}</BehaviorTree></root>'
    with pytest.raises(YamlError) as error:
        read_xml(xml, shipped_leaves(), "f.xml")
    told = [str(problem).removeprefix("f.xml:") for problem in error.value.problems]
    assert [line.replace('; did you mean "Sequence"?', "") for line in told] == FOREIGN[body] or all(
        line.startswith(start) for line, start in zip(told, FOREIGN[body], strict=True)
    )


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("<root><BehaviorTree", "not XML"),
        ("<tree/>", 'got <tree>, needs <root BTCPP_format="4">'),
        ('<root BTCPP_format="3"><BehaviorTree ID="a"><AlwaysSuccess/></BehaviorTree></root>', "reads 4"),
        ('<!DOCTYPE x [<!ENTITY a "b">]><root/>', "a document type is not allowed"),
        ("<root>" * 200, "deeper than 100"),
        (
            '<root><include path="a.xml"/><BehaviorTree ID="a"><AlwaysSuccess/></BehaviorTree></root>',
            "cannot include a.xml",
        ),
        (
            '<root><BehaviorTree ID="AB"><AlwaysSuccess/></BehaviorTree><BehaviorTree ID="ab"><AlwaysSuccess/>'
            "</BehaviorTree></root>",
            'there are two trees "ab"',
        ),
    ],
)
def test_what_is_no_tree_in_xml_is_refused(text: str, message: str):
    with pytest.raises(YamlError, match=re.escape(message)):
        read_xml(text, shipped_leaves())


def test_what_xml_cannot_say_is_told():
    text = "{tree: t, root: {sequence: [subtree: {tree: s, set: {scripted.says: F}}]}, trees: {s: {root: {sequence: [Scripted]}}}}"  # noqa: E501
    with pytest.raises(YamlError, match=r'subtree "s": BehaviorTree.CPP has nothing like `set`'):
        write_xml(read_written(text, registry=toys), toys)


def test_the_palette_describes_every_leaf_and_every_node_of_ours():
    root = ElementTree.fromstring(write_palette(shipped_leaves()))
    models = {element.attrib["ID"]: element for element in root.findall("TreeNodesModel/*")}
    assert {"PlanFootsteps", "RateLimit", "RunWhile", "ReactiveParallel"} <= set(models)
    ports = {port.attrib["name"]: (port.tag, port.attrib["type"], port.text) for port in models["PlanFootsteps"]
             if port.tag.endswith("port")}  # fmt: skip
    assert ports["plan"] == ("output_port", "FootstepPlan", "FootstepPlan: the next footsteps")
    assert ports["latency"] == ("input_port", "float", "robot time until a plan is delivered [s]")
    assert models["RunWhile"].tag == "Control" and models["RateLimit"].tag == "Decorator"


def test_a_run_becomes_a_log_with_the_tables_of_behaviortree_cpp(tmp_path: Path):
    tree, robot = make(
        "{tree: t, root: {sequence: [Scripted: {says: RRS}, GiveNumber: {out: [number]}, Scripted: {says: R}]}}",
        trace=Trace(tmp_path / "trace.jsonl"),
    )
    run(tree, robot, 5)
    tree.shutdown()
    log = tmp_path / "run.db3"
    count = write_groot_log(RecordedTrace(tmp_path / "trace.jsonl"), log)
    with sqlite3.connect(log) as database:
        definitions = database.execute("SELECT session_id, xml_tree FROM Definitions").fetchall()
        nodes = database.execute("SELECT fullpath, uid FROM Nodes ORDER BY uid").fetchall()
        rows = database.execute("SELECT timestamp, session_id, uid, duration, state FROM Transitions").fetchall()
    database.close()
    ((session, xml),) = definitions
    assert session == 1
    uids = {
        element.attrib["_uid"]: element.attrib["name"]
        for element in ElementTree.fromstring(xml).iter()
        if "_uid" in element.attrib
    }
    assert uids == {"1": "t", "2": "scripted", "3": "give_number", "4": "scripted_2"}
    assert nodes == [("t", 1), ("scripted", 2), ("give_number", 3), ("scripted_2", 4)]
    assert len(rows) == count and [row[0] for row in rows] == sorted({row[0] for row in rows})
    # Scripted runs from 0 ms, succeeds in the third tick at 40 ms; the others follow in the same tick.
    assert [(uid, state, duration) for _, _, uid, duration, state in rows] == [
        (2, 1, 0),
        (1, 1, 0),
        (4, 1, 0),
        (3, 2, 0),
        (2, 2, 40_002),
    ]
    assert write_groot_log(RecordedTrace(tmp_path / "trace.jsonl"), log) == count
