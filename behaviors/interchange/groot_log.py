"""The trace of a run -> the SQLite log that BehaviorTree.CPP's `SqliteLogger` writes and Groot2 opens.

Tables and meanings are those of BehaviorTree.CPP 4 (`src/loggers/bt_sqlite_logger.cpp`): a definition of the tree as
XML whose nodes carry their uid, the full path of each node, and one row for each change of a status, with timestamps
in microseconds that never repeat.
"""

from __future__ import annotations

import sqlite3
from collections.abc import Iterator
from pathlib import Path
from xml.sax.saxutils import quoteattr

from behaviors.interchange.xml_names import BUILTINS, category, own_tag
from behaviors.kinds import DECORATORS
from behaviors.recorded_trace import RecordedNode, RecordedTrace

# NodeStatus of BehaviorTree.CPP.
STATES = {"INVALID": 0, "RUNNING": 1, "SUCCESS": 2, "FAILURE": 3}

_SCHEMA = """
CREATE TABLE Transitions (timestamp INTEGER PRIMARY KEY NOT NULL, session_id INTEGER NOT NULL, uid INTEGER NOT NULL,
    duration INTEGER, state INTEGER NOT NULL, metadata VARCHAR);
CREATE TABLE Nodes (session_id INTEGER NOT NULL, fullpath VARCHAR, uid INTEGER NOT NULL);
CREATE TABLE Definitions (session_id INTEGER PRIMARY KEY AUTOINCREMENT, date TEXT NOT NULL, xml_tree TEXT NOT NULL);
"""


def write_groot_log(trace: RecordedTrace, path: Path) -> int:
    """Write a log; returns the number of its transitions.

    Args:
        trace: of a run.
        path: ends in `.db3` or `.btdb`, as Groot2 asks for; what is there is replaced.
    """
    partial = path.with_name(path.name + ".partial")
    partial.unlink(missing_ok=True)
    uids = {node: index for index, node in enumerate(trace.nodes, 1)}
    with sqlite3.connect(partial) as log:
        log.executescript(_SCHEMA)
        text = "\n".join(_definition(trace, uids)) + "\n"
        log.execute("INSERT INTO Definitions (date, xml_tree) VALUES (datetime('now', 'localtime'), ?)", (text,))
        rows = ((1, node.removeprefix(f"/{trace.tree}").lstrip("/") or trace.tree, uid) for node, uid in uids.items())
        log.executemany("INSERT INTO Nodes VALUES (?, ?, ?)", rows)
        count = log.executemany("INSERT INTO Transitions VALUES (?, ?, ?, ?, ?, ?)", _transitions(trace, uids)).rowcount
    log.close()
    partial.replace(path)
    return count


def _transitions(trace: RecordedTrace, uids: dict[str, int]) -> Iterator[tuple[int, int, int, int, int, str]]:
    """Children before parents within a tick: a parent ends because its children have."""
    statuses = dict.fromkeys(uids, "INVALID")
    started: dict[str, int] = {}
    stamp = -1
    for tick in trace.ticks():
        changed = tick.line.get("status", {})
        for path in sorted((path for path in changed if path in uids), key=lambda path: -uids[path]):
            before, after = statuses[path], changed[path]
            if before == after:
                continue
            statuses[path] = after
            stamp = max(stamp + 1, round(1e6 * tick.time))
            if after == "RUNNING":
                started[path] = stamp
            duration = stamp - started.get(path, stamp) if before == "RUNNING" else 0
            yield stamp, 1, uids[path], duration, STATES[after], tick.reason.get(path, "")


def _definition(trace: RecordedTrace, uids: dict[str, int]) -> Iterator[str]:
    """The tree as it ran, subtrees expanded, under the names of the library where it has the node."""
    roots = [path for path in trace.nodes if path.count("/") == 1]
    yield f'<root BTCPP_format="4" main_tree_to_execute={quoteattr(trace.tree)}>'
    for root in roots:
        yield f"  <BehaviorTree ID={quoteattr(root.lstrip('/'))}>"
        yield from _element(trace, uids, root, "    ")
        yield "  </BehaviorTree>"
    yield "  <TreeNodesModel>"
    for tag, kind in sorted({(_tag(node), node.kind) for node in trace.nodes.values() if node.kind not in BUILTINS}):
        group = "Control" if kind in DECORATORS and len(DECORATORS[kind].slots) > 1 else category(kind)
        yield f"    <{group} ID={quoteattr(tag)}/>"
    yield "  </TreeNodesModel>"
    yield "</root>"


def _element(trace: RecordedTrace, uids: dict[str, int], path: str, indent: str) -> Iterator[str]:
    node = trace.nodes[path]
    tag = _tag(node)
    head = f'{indent}<{tag} name={quoteattr(path.rpartition("/")[2])} _uid="{uids[path]}"'
    wires = (*node.inputs.items(), *node.outputs.items())
    head += "".join(f" {port}={quoteattr('{' + key + '}')}" for port, key in wires)
    below = [child for child in trace.nodes if child.rpartition("/")[0] == path]
    if not below:
        yield f"{head}/>"
        return
    yield f"{head}>"
    for child in below:
        yield from _element(trace, uids, child, indent + "  ")
    yield f"{indent}</{tag}>"


def _tag(node: RecordedNode) -> str:
    return BUILTINS[node.kind].tag if node.kind in BUILTINS else own_tag(node.kind)
