"""YAML text -> one `Node`, after YAML 1.2 with the core schema, and nothing that surprises.

`on`, `off`, `yes`, `no` and dates are text, `1e-3` is a number, `010` is ten. Duplicate keys, tags, merge keys, several
documents in a file and keys that are not plain scalars are refused. Anchors and aliases are read, within limits on the
expanded size and depth that no honest file meets, so that no file can make its reader run out of time or memory.

The parser's event stream is read rather than its node graph: it never recurses, knows which scalars are plain, and
lets problems that do not stop the parser be collected.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ruamel.yaml import YAML
from ruamel.yaml.error import MarkedYAMLError
from ruamel.yaml.events import (
    AliasEvent,
    DocumentStartEvent,
    MappingEndEvent,
    MappingStartEvent,
    ScalarEvent,
    SequenceEndEvent,
    SequenceStartEvent,
)

from strict_yaml.node import Entry, Kind, Node, Scalar
from strict_yaml.problem import Location, Problem, YamlError

MAXIMUM_FILE_BYTES = 1_000_000
MAXIMUM_NODES = 10_000
MAXIMUM_DEPTH = 100
MAXIMUM_DIGITS = 100

_BOOLEANS = {"true": True, "True": True, "TRUE": True, "false": False, "False": False, "FALSE": False}
_NULLS = ("", "~", "null", "Null", "NULL")
_DECIMAL = re.compile(r"[-+]?[0-9]+")
_OCTAL = re.compile(r"0o[0-7]+")
_HEXADECIMAL = re.compile(r"0x[0-9a-fA-F]+")
_FLOAT = re.compile(r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?")
_INFINITY = re.compile(r"([-+]?)\.(inf|Inf|INF)")
_NOT_A_NUMBER = (".nan", ".NaN", ".NAN")
_UNPRINTABLE = re.compile("[^\t\n\r\x20-\x7e\x85\xa0-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


def load_document(path: str | Path) -> Node:
    """Read a YAML file.

    Raises:
        YamlError: where the file is missing, too large, not UTF-8, empty or not strict YAML; holds every problem found.
    """
    file = str(path)
    start = Location(file, 1, 1)
    try:
        with Path(path).open("rb") as stream:
            data = stream.read(MAXIMUM_FILE_BYTES + 1)
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        raise YamlError([Problem(start, f"cannot read the file: {reason[:1].lower()}{reason[1:]}")]) from error
    try:
        text = data.decode("utf-8")
    except UnicodeDecodeError as error:
        if len(data) <= MAXIMUM_FILE_BYTES:
            before = data[: error.start].decode("utf-8")
            place = _place(before, len(before), file)
            raise YamlError([Problem(place, f"not UTF-8 text: byte 0x{data[error.start]:02x}")]) from error
        text = ""
    if len(data) > MAXIMUM_FILE_BYTES:
        raise YamlError([Problem(start, f"file is larger than {MAXIMUM_FILE_BYTES} bytes")])
    return parse_document(text, file)


def parse_document(text: str, file: str = "<text>") -> Node:
    """Read YAML text; `file` names its origin in locations.

    Raises:
        YamlError: where the text is too long, empty or not strict YAML; holds every problem found.
    """
    start = Location(file, 1, 1)
    if len(text) > MAXIMUM_FILE_BYTES:
        raise YamlError([Problem(start, f"text is longer than {MAXIMUM_FILE_BYTES} characters")])
    text = text.removeprefix("\ufeff")
    unprintable = _UNPRINTABLE.search(text)
    if unprintable:
        place = _place(text, unprintable.start(), file)
        raise YamlError([Problem(place, f"character U+{ord(unprintable.group()):04X} is not allowed in YAML")])
    reader = _Reader(file)
    root = reader.read(text)
    if root is None and not reader.problems:
        reader.problems.append(Problem(start, "the file is empty"))
    if reader.problems or root is None:
        raise YamlError(reader.problems)
    return root


def _place(text: str, index: int, file: str) -> Location:
    before = text[:index]
    return Location(file, before.count("\n") + 1, index - (before.rfind("\n") + 1) + 1)


class _LimitExceededError(Exception):
    """Reading on would only cost time; the reason is in the problems."""


@dataclass(slots=True)
class _Open:
    """A mapping or sequence whose end has not been read."""

    location: Location
    is_mapping: bool
    anchor: str | None
    entries: list[Entry] = field(default_factory=list)
    elements: list[Node] = field(default_factory=list)
    pending_key: tuple[str, Location] | None = None
    first_place: dict[str, Location] = field(default_factory=dict)
    height: int = 1
    nodes: int = 1


@dataclass(slots=True)
class _Reader:
    """Builds the nodes of one document from parser events, collecting problems."""

    file: str
    problems: list[Problem] = field(default_factory=list)
    root: Node | None = None
    stack: list[_Open] = field(default_factory=list)
    anchors: dict[str, tuple[Node, int, int]] = field(default_factory=dict)
    documents: int = 0
    nodes: int = 0

    def read(self, text: str) -> Node | None:
        last = Location(self.file, 1, 1)
        try:
            for event in self._events(text):
                last = self._location(event.start_mark)
                self._take(event, last)
        except MarkedYAMLError as error:
            self._add_syntax_error(error, last)
        except _LimitExceededError:
            pass
        except Exception as error:  # The parser stumbles with all kinds of exceptions over malformed escapes.
            self.problems.append(Problem(last, f"not valid YAML: {error}"))
        return self.root

    def _events(self, text: str) -> Iterator[Any]:
        return YAML(typ="safe", pure=True).parse(text)

    def _location(self, mark: Any) -> Location:
        return Location(self.file, mark.line + 1, mark.column + 1)

    def _add_syntax_error(self, error: MarkedYAMLError, last: Location) -> None:
        mark = error.problem_mark or error.context_mark
        place = last if mark is None else self._location(mark)
        message = error.problem or str(error.context)
        if error.context and error.problem:
            message += f" ({error.context}"
            if error.context_mark is not None and error.context_mark.line + 1 != place.line:
                message += f" that begins on line {error.context_mark.line + 1}"
            message += ")"
        self.problems.append(Problem(place, message.replace("\n", " ")))

    def _take(self, event: Any, location: Location) -> None:
        if isinstance(event, DocumentStartEvent):
            self._begin_document(event, location)
        elif isinstance(event, AliasEvent):
            self._add_alias(event.anchor, location)
        elif isinstance(event, ScalarEvent):
            self._refuse_tag(event, location)
            value = self._resolve(event.value, location) if event.style is None else event.value
            column = {None: location.column, "'": location.column + 1, '"': location.column + 1}.get(event.style, 0)
            node = Node(Kind.SCALAR, location, value=value, text_column=column)
            self._count(1, location)
            self._add(node, event.anchor, nodes=1, height=1, key_text=event.value)
        elif isinstance(event, MappingStartEvent | SequenceStartEvent):
            self._refuse_tag(event, location)
            self.stack.append(_Open(location, isinstance(event, MappingStartEvent), event.anchor))
            self._count(1, location)
            self._check_depth(0, location)
        elif isinstance(event, MappingEndEvent | SequenceEndEvent):
            done = self.stack.pop()
            kind = Kind.MAPPING if done.is_mapping else Kind.SEQUENCE
            node = Node(kind, done.location, entries=tuple(done.entries), elements=tuple(done.elements))
            self._add(node, done.anchor, done.nodes, done.height)

    def _begin_document(self, event: Any, location: Location) -> None:
        self.documents += 1
        if self.documents > 1:
            self.problems.append(Problem(location, "a second document begins here; a file holds one"))
            raise _LimitExceededError
        if event.version is not None and tuple(event.version) != (1, 2):
            version = ".".join(str(part) for part in event.version)
            self.problems.append(Problem(location, f"YAML version {version} is not supported, allowed: 1.2"))

    def _refuse_tag(self, event: Any, location: Location) -> None:
        if event.tag is not None:
            tag = str(event.tag).replace("tag:yaml.org,2002:", "!!")
            self.problems.append(
                Problem(location, f'tags are not supported, got "{tag}"; quote a value to make it text')
            )

    def _add_alias(self, name: str, location: Location) -> None:
        if name in self.anchors:
            node, nodes, height = self.anchors[name]
            key_text = str(node.value) if node.kind is Kind.SCALAR else None
            self._count(nodes, location)
            self._add(node, None, nodes, height, key_text, key_location=location)
            return
        inside = any(level.anchor == name for level in self.stack)
        reason = "lies inside its own anchor" if inside else "has no anchor before it"
        self.problems.append(Problem(location, f'alias "*{name}" {reason}'))
        self._add(Node(Kind.SCALAR, location), None, nodes=1, height=1, key_text=f"*{name}")

    def _add(
        self,
        node: Node,
        anchor: str | None,
        nodes: int,
        height: int,
        key_text: str | None = None,
        key_location: Location | None = None,
    ) -> None:
        """Put a finished node of so many expanded nodes and levels where it belongs."""
        place = key_location or node.location
        self._check_depth(height, place)
        if anchor is not None:
            self.anchors[anchor] = (node, nodes, height)
        if not self.stack:
            self.root = node
            return
        parent = self.stack[-1]
        parent.nodes += nodes
        parent.height = max(parent.height, height + 1)
        if not parent.is_mapping:
            parent.elements.append(node)
        elif parent.pending_key is None:
            parent.pending_key = (self._key(node, key_text, place), place)
        else:
            key, location = parent.pending_key
            parent.pending_key = None
            self._add_entry(parent, Entry(key, location, node))

    def _key(self, node: Node, text: str | None, location: Location) -> str:
        if node.kind is not Kind.SCALAR:
            self.problems.append(Problem(location, f"a key must be text, got {node.describe()}"))
        elif node.value is None or text == "":
            self.problems.append(Problem(location, "empty key"))
        elif text == "<<":
            self.problems.append(Problem(location, 'merge keys ("<<") are not supported; write the keys out'))
        return text or ""

    def _add_entry(self, parent: _Open, entry: Entry) -> None:
        first = parent.first_place.setdefault(entry.key, entry.location)
        if first is not entry.location:
            where = f"line {first.line}" if first.line != entry.location.line else f"column {first.column}"
            self.problems.append(Problem(entry.location, f'duplicate key "{entry.key}", first given on {where}'))
            return
        parent.entries.append(entry)

    def _count(self, nodes: int, location: Location) -> None:
        self.nodes += nodes
        if self.nodes > MAXIMUM_NODES:
            self.problems.append(Problem(location, f"more than {MAXIMUM_NODES} nodes, with aliases expanded"))
            raise _LimitExceededError

    def _check_depth(self, height: int, location: Location) -> None:
        if len(self.stack) + height > MAXIMUM_DEPTH:
            self.problems.append(Problem(location, f"nested deeper than {MAXIMUM_DEPTH} levels"))
            raise _LimitExceededError

    def _resolve(self, text: str, location: Location) -> Scalar:
        """The value of a plain scalar after the YAML 1.2 core schema."""
        if text in _NULLS:
            return None
        if text in _BOOLEANS:
            return _BOOLEANS[text]
        for pattern, base in ((_DECIMAL, 10), (_OCTAL, 8), (_HEXADECIMAL, 16)):
            if pattern.fullmatch(text):
                if len(text) > MAXIMUM_DIGITS:
                    self.problems.append(Problem(location, f"number of more than {MAXIMUM_DIGITS} digits"))
                    return 0
                return int(text, base)
        if _FLOAT.fullmatch(text):
            return float(text)
        infinity = _INFINITY.fullmatch(text)
        if infinity:
            return float(infinity.group(1) + "inf")
        return float("nan") if text in _NOT_A_NUMBER else text
