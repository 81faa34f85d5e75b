"""`WrittenFile` -> YAML text in one layout, with its comments."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator

from behaviors.decorators import Decorator
from behaviors.interchange.written import Comments, WrittenFile, WrittenNode, WrittenPort, WrittenTree
from behaviors.kinds import DECORATORS
from strict_yaml import Scalar, YamlError, parse_document

_STEP = "  "


def write_yaml(file: WrittenFile) -> str:
    """The text of a tree file; reading it gives an equal `WrittenFile`, and its comments."""
    comments = dict(file.comments)
    blocks = [
        _key_lines("tree", file.tree.name, comments)
        + (_key_lines("about", _text(file.tree.about), comments) if file.tree.about else [])
        + (_key_lines("include", _flow_list(file.include), comments) if file.include else [])
    ]
    ports = list(_ports(file.tree, ""))
    if ports:
        blocks.append(_with_comments(ports, comments.get("ports", Comments()), ""))
    blocks.append(_block("root", file.tree.root, "", comments))
    if file.safe_stop is not None:
        blocks.append(_block("safe_stop", file.safe_stop, "", comments))
    if file.trees:
        first = _with_comments(["trees:"], comments.get("trees", Comments()), "")
        for index, tree in enumerate(file.trees):
            blocks.append([*(first if index == 0 else []), *_tree(tree)])
    end = list(comments.get("", Comments()).above)
    return "\n\n".join("\n".join(block) for block in (*blocks, *([end] if end else []))) + "\n"


def _tree(tree: WrittenTree) -> list[str]:
    inside = _STEP * 2
    lines = [f"{_STEP}{tree.name}:"]
    if tree.about:
        lines.append(f"{inside}about: {_text(tree.about)}")
    lines += _ports(tree, inside)
    lines += _block("root", tree.root, inside, {})
    return _with_comments(lines, tree.comments, _STEP)


def _ports(tree: WrittenTree, indent: str) -> Iterator[str]:
    listed = [(way, ports) for way, ports in (("in", tree.inputs), ("out", tree.outputs)) if ports]
    if listed:
        yield f"{indent}ports:"
    for way, ports in listed:
        yield f"{indent}{_STEP}{way}: {{{', '.join(map(_port, ports))}}}"


def _port(port: WrittenPort) -> str:
    parts = [("type", port.type), ("unit", "" if port.unit == "1" else port.unit), ("frame", port.frame)]
    said = [f"{key}: {_flow(value)}" for key, value in parts if value]
    return f"{port.name}: {port.type}" if len(said) == 1 else f"{port.name}: {{{', '.join(said)}}}"


def _block(key: str, node: WrittenNode, indent: str, comments: dict[str, Comments]) -> list[str]:
    """A node under a key: on one line where it is a bare leaf."""
    about = comments.get(key, Comments())
    if _is_bare(node) and not (node.comments.above or node.comments.behind):
        return _with_comments([f"{indent}{key}: {node.kind}"], about, indent)
    return _with_comments([f"{indent}{key}:"], about, indent) + _node(node, indent + _STEP)


def _node(node: WrittenNode, indent: str) -> list[str]:
    """A node as a key with its body."""
    return _with_comments(list(_bare_node(node, indent)), node.comments, indent)


def _item(node: WrittenNode, indent: str) -> list[str]:
    """A node as an element of a list."""
    lines = [f"- {node.kind}"] if _is_bare(node) else list(_bare_node(node, ""))
    if not _is_bare(node):
        lines = [("- " if index == 0 else "  ") + line for index, line in enumerate(lines)]
    return _with_comments([indent + line for line in lines], node.comments, indent)


def _bare_node(node: WrittenNode, indent: str) -> Iterator[str]:
    inside = indent + _STEP
    cls = DECORATORS.get(node.kind)
    if node.kind == "check" and not node.name:
        yield f"{indent}check: {_text(str(node.settings[0][1]))}"
    elif _is_short(node, cls):
        yield f"{indent}{node.kind}: {node.children[0].kind}"
    elif not node.children:
        yield f"{indent}{node.kind}: {{{', '.join(_body(node))}}}"
    elif cls is None and not node.name and not node.settings:
        yield f"{indent}{node.kind}:"
        for child in node.children:
            yield from _item(child, inside)
    else:
        yield f"{indent}{node.kind}:"
        if node.name:
            yield f"{inside}name: {_text(node.name)}"
        for key, value in node.settings:
            yield f"{inside}{key}: {_value(value)}"
        yield from _below(node, cls, inside)


def _below(node: WrittenNode, cls: type[Decorator] | None, inside: str) -> Iterator[str]:
    if cls is None:
        yield f"{inside}children:"
        for child in node.children:
            yield from _item(child, inside + _STEP)
        return
    for slot, child in zip(cls.slots, node.children, strict=True):
        if slot == "condition" or _is_bare(child):
            yield from _block(slot, child, inside, {})
        else:
            # A child that is no bare leaf stands beside the parameters, under its kind.
            yield from _node(child, inside)


def _is_short(node: WrittenNode, cls: type[Decorator] | None) -> bool:
    """Whether it is a decorator that says nothing but its child, and that is a bare leaf: `inverter: RobotFallen`."""
    if cls is None or len(cls.slots) > 1 or node.name or node.settings:
        return False
    (child,) = node.children
    return _is_bare(child) and not (child.comments.above or child.comments.behind)


def _is_bare(node: WrittenNode) -> bool:
    """Whether its kind says it all."""
    return not (node.name or node.tree or node.inputs or node.outputs or node.settings or node.children)


def _body(node: WrittenNode) -> Iterator[str]:
    """The inside of a flow mapping of a node without children."""
    if node.tree:
        yield f"tree: {_flow(node.tree)}"
    if node.name:
        yield f"name: {_flow(node.name)}"
    for way, wires in (("in", node.inputs), ("out", node.outputs)):
        if wires:
            yield f"{way}: {_wires(wires)}"
    settings = [f"{_flow(key)}: {_value(value)}" for key, value in node.settings]
    if node.kind == "subtree" and settings:
        yield f"set: {{{', '.join(settings)}}}"
    else:
        yield from settings


def _wires(wires: tuple[tuple[str, str], ...]) -> str:
    if all(port == key for port, key in wires):
        return f"[{', '.join(port for port, _ in wires)}]"
    return f"{{{', '.join(f'{port}: {key}' for port, key in wires)}}}"


def _with_comments(lines: list[str], comments: Comments, indent: str) -> list[str]:
    above = [indent + comment for comment in comments.above]
    if not comments.behind:
        return above + lines
    return [*above, f"{lines[0]} {comments.behind}", *lines[1:]]


def _key_lines(key: str, value: str, comments: dict[str, Comments]) -> list[str]:
    return _with_comments([f"{key}: {value}"], comments.get(key, Comments()), "")


def _flow_list(values: Iterable[str]) -> str:
    return f"[{', '.join(map(_flow, values))}]"


def _value(value: Scalar) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if value is None:
        return "null"
    return _flow(value) if isinstance(value, str) else repr(value)


def _text(value: str) -> str:
    """Plain where YAML reads it back as the same text, else quoted."""
    return value if _reads_back(f"k: {value}", value) else json.dumps(value, ensure_ascii=False)


def _flow(value: str) -> str:
    """The same within brackets."""
    return value if _reads_back(f"{{k: {value}}}", value) else json.dumps(value, ensure_ascii=False)


def _reads_back(text: str, value: str) -> bool:
    if not value or value != value.strip() or "\n" in value or '"' in value[:1]:
        return False
    try:
        document = parse_document(text)
    except YamlError:
        return False
    node = document.get("k")
    return node is not None and len(document.entries) == 1 and node.value == value and isinstance(node.value, str)
