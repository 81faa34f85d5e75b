"""`WrittenFile` -> BehaviorTree.CPP 4 XML, complete with the trees of included files and a model of all own nodes."""

from __future__ import annotations

from collections.abc import Iterator
from xml.sax.saxutils import quoteattr

from behaviors.interchange.written import WrittenFile, WrittenNode, WrittenTree
from behaviors.interchange.xml_names import BUILTINS, BY_TAG, OWN, builtin_for, own_tag, to_script, tree_id
from behaviors.interchange.xml_palette import model_lines
from behaviors.registry import Registry
from strict_yaml import Location, Problem, Scalar, YamlError

_STEP = "  "


def write_xml(file: WrittenFile, registry: Registry, origin: str = "<text>") -> str:
    """The XML of a tree file.

    Args:
        file: what it says.
        registry: describes the leaves for the model.
        origin: names the file in problems.

    Raises:
        YamlError: where XML cannot say it; names every such node.
    """
    problems = [
        Problem(Location(origin, 0, 0), message) for tree in _own_trees(file) for message in _unsayable(tree.root)
    ]
    if problems:
        raise YamlError(problems)
    return "\n".join(_lines(file, registry)) + "\n"


def _own_trees(file: WrittenFile) -> Iterator[WrittenTree]:
    yield file.tree
    yield from file.trees


def _unsayable(node: WrittenNode) -> Iterator[str]:
    if node.kind == "subtree" and node.settings:
        yield f'subtree "{node.tree}": BehaviorTree.CPP has nothing like `set`, parameters inside a subtree'
    both = {port for port, _ in node.inputs} & {port for port, _ in node.outputs}
    if both:
        yield f'subtree "{node.tree}": port {", ".join(sorted(both))} goes in and comes out, by one attribute in XML'
    if node.kind[:1].isupper() and node.kind not in BUILTINS and (node.kind in BY_TAG or node.kind in OWN):
        yield f'leaf "{node.kind}": BehaviorTree.CPP or we have another node of this name'
    for child in node.children:
        yield from _unsayable(child)


def _lines(file: WrittenFile, registry: Registry) -> Iterator[str]:
    main = file.tree.name
    yield '<?xml version="1.0" encoding="UTF-8"?>'
    yield f'<root BTCPP_format="4" main_tree_to_execute={quoteattr(main)}>'
    trees = [(tree.name, tree, "") for tree in _own_trees(file)]
    trees += [(name, tree, name.rpartition("/")[0] or name) for name, tree in file.included]
    for name, tree, scope in trees:
        yield f"{_STEP}<BehaviorTree ID={quoteattr(tree_id(name))}>"
        yield from _node(tree.root, scope, _STEP * 2)
        yield f"{_STEP}</BehaviorTree>"
    if file.safe_stop is not None:
        yield f'{_STEP}<BehaviorTree ID="safe_stop">'
        yield from _node(file.safe_stop, "", _STEP * 2)
        yield f"{_STEP}</BehaviorTree>"
    yield from model_lines(file, registry)
    yield "</root>"


def _node(node: WrittenNode, scope: str, indent: str) -> Iterator[str]:
    tag, attributes = _element(node, scope)
    if node.name:
        attributes = [("name", node.name), *attributes]
    said = "".join(f" {key}={quoteattr(value)}" for key, value in attributes)
    if not node.children:
        yield f"{indent}<{tag}{said}/>"
        return
    yield f"{indent}<{tag}{said}>"
    for child in node.children:
        yield from _node(child, scope, indent + _STEP)
    yield f"{indent}</{tag}>"


def _element(node: WrittenNode, scope: str) -> tuple[str, list[tuple[str, str]]]:
    """The tag of a node, and its attributes without the name."""
    wires = [(port, f"{{{key}}}") for port, key in (*node.inputs, *node.outputs)]
    if node.kind == "subtree":
        # The trees of an included file go by its name.
        name = f"{scope}/{node.tree}" if scope else node.tree
        return "SubTree", [("ID", tree_id(name)), *wires]
    if node.kind == "check":
        script = to_script(str(node.settings[0][1]))
        if script is not None:
            return "ScriptCondition", [("code", script)]
    builtin = builtin_for(node.kind, node.settings)
    if builtin is not None:
        names = dict(builtin.attributes)
        return builtin.tag, [(names[key], builtin.to_xml(value)) for key, value in node.settings]
    return own_tag(node.kind), [*wires, *((key, scalar_text(value)) for key, value in node.settings)]


def scalar_text(value: Scalar) -> str:
    """A parameter as an attribute says it."""
    if isinstance(value, bool):
        return "true" if value else "false"
    return value if isinstance(value, str) else repr(value)
