"""What our nodes are called in BehaviorTree.CPP 4, and how their parameters are said there.

Nodes that its library has are written under its names; all others are nodes of our own, which a `TreeNodesModel` in the
file declares, so that Groot2 shows them with their ports.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass

from behaviors.composites import COMPOSITES
from behaviors.kinds import DECORATORS
from behaviors.naming import snake_case
from strict_yaml import Scalar


@dataclass(frozen=True, slots=True)
class Builtin:
    """A node of BehaviorTree.CPP's library.

    Attributes:
        tag: its name there.
        attributes: names of parameters there, by ours.
        to_xml, from_xml: how values of parameters are said.
    """

    tag: str
    attributes: tuple[tuple[str, str], ...] = ()
    to_xml: Callable[[Scalar], str] = str
    from_xml: Callable[[str], Scalar] = int


def _count(value: Scalar) -> str:
    """All is 0 with us, -1 there."""
    return "-1" if value == 0 else str(value)


def _from_count(text: str) -> Scalar:
    return 0 if int(text) < 0 else int(text)


def _milliseconds(value: Scalar) -> str:
    assert isinstance(value, int | float)
    return str(round(1000 * value))


def _from_milliseconds(text: str) -> Scalar:
    return int(text) / 1000


BUILTINS: dict[str, Builtin] = {
    "sequence": Builtin("Sequence"),
    "reactive_sequence": Builtin("ReactiveSequence"),
    "selector": Builtin("Fallback"),
    "reactive_selector": Builtin("ReactiveFallback"),
    "parallel": Builtin(
        "Parallel", (("succeed_after", "success_count"), ("fail_after", "failure_count")), _count, _from_count
    ),
    "inverter": Builtin("Inverter"),
    "force_success": Builtin("ForceSuccess"),
    "force_failure": Builtin("ForceFailure"),
    "retry": Builtin("RetryUntilSuccessful", (("attempts", "num_attempts"),), _count, _from_count),
    "repeat": Builtin("Repeat", (("times", "num_cycles"),), _count, _from_count),
    "timeout": Builtin("Timeout", (("after", "msec"),), _milliseconds, _from_milliseconds),
    "Succeed": Builtin("AlwaysSuccess"),
    "Fail": Builtin("AlwaysFailure"),
    "Wait": Builtin("Sleep", (("duration", "msec"),), _milliseconds, _from_milliseconds),
}
BY_TAG = {builtin.tag: kind for kind, builtin in BUILTINS.items()}


def builtin_for(kind: str, settings: tuple[tuple[str, Scalar], ...]) -> Builtin | None:
    """The library's node that says exactly this; None where only one of our own does."""
    builtin = BUILTINS.get(kind)
    if builtin is None:
        return None
    names = dict(builtin.attributes)
    for key, value in settings:
        if key not in names or builtin.from_xml(builtin.to_xml(value)) != value:
            return None
    needs_all = kind in ("retry", "repeat", "timeout", "Wait")
    return None if needs_all and len(settings) < len(names) else builtin


def own_tag(kind: str) -> str:
    """The name of a node of our own, such as RateLimit of rate_limit; also of those that the library says otherwise."""
    name = "".join(part.capitalize() for part in kind.split("_")) if kind[:1].islower() else kind
    return f"Own{name}" if kind in BUILTINS else name


OWN = {own_tag(kind): kind for kind in (*COMPOSITES, *DECORATORS, "check", "Succeed", "Fail", "Wait")}


def category(kind: str) -> str:
    """Control, Decorator, Condition or Action; a decorator with a condition has two children, so it is a Control."""
    if kind in COMPOSITES:
        return "Control"
    if kind in DECORATORS:
        return "Control" if len(DECORATORS[kind].slots) > 1 else "Decorator"
    return "Condition" if kind == "check" else "Action"


_WORDS = (("and", "&&"), ("or", "||"))
_QUOTED = re.compile(r"""('[^']*'|"[^"]*")""")


def to_script(condition: str) -> str | None:
    """A condition in BehaviorTree.CPP's scripting language; None where it cannot say it."""
    parts = _QUOTED.split(condition)
    if len(parts) > 1 or "." in re.sub(r"\d\.\d|\d\.", "", condition):
        return None  # Its texts have other quotes, and it has no fields.
    script = condition
    for ours, theirs in _WORDS:
        script = re.sub(rf"\b{ours}\b", theirs, script)
    script = re.sub(r"\bnot\b\s*", "!", script)
    return script if from_script(script) == condition else None


def from_script(script: str) -> str:
    """The other way."""
    condition = script
    for ours, theirs in _WORDS:
        condition = condition.replace(theirs, ours)
    return re.sub(r"!(?!=)", "not ", condition)


def tree_id(name: str) -> str:
    """The ID of a tree: `look_and_step/walk_to` is `look_and_step--walk_to`, because IDs have no slash."""
    return name.replace("/", "--")


def tree_name(identity: str) -> str:
    """The other way; an ID of another's making becomes a name of ours: `MainTree` is `main_tree`."""
    name = identity.replace("--", "/")
    return name if re.fullmatch(r"[a-z0-9_/]*", name) else snake_case(name).replace("-", "_")
