"""XML text -> elements that remember their line, within limits on size and depth; no entities, no documents by name."""

from __future__ import annotations

from dataclasses import dataclass, field
from xml.parsers import expat

from strict_yaml import Location, Problem, YamlError

MAXIMUM_BYTES = 1_000_000
MAXIMUM_ELEMENTS = 10_000
MAXIMUM_DEPTH = 100


@dataclass(slots=True)
class Element:
    """One element; its attributes are in the order of the file."""

    tag: str
    attributes: dict[str, str]
    location: Location
    children: list[Element] = field(default_factory=list)
    text: str = ""

    def all(self, tag: str) -> list[Element]:
        """The children of a tag."""
        return [child for child in self.children if child.tag == tag]


def parse_elements(text: str, file: str) -> Element:
    """The root element.

    Raises:
        YamlError: where the text is no XML, too large, too deep, or declares a document type.
    """
    if len(text) > MAXIMUM_BYTES:
        raise YamlError([Problem(Location(file, 1, 1), f"file is larger than {MAXIMUM_BYTES} bytes")])
    builder = _Builder(file)
    try:
        builder.parser.Parse(text.encode(), True)
    except expat.ExpatError as error:
        place = Location(file, error.lineno, error.offset + 1)
        raise YamlError([Problem(place, f"not XML: {expat.ErrorString(error.code)}")]) from error
    assert builder.root is not None, "XML has a root"
    return builder.root


class _Builder:
    def __init__(self, file: str) -> None:
        self.file = file
        self.root: Element | None = None
        self.stack: list[Element] = []
        self.count = 0
        self.parser = expat.ParserCreate()
        self.parser.StartElementHandler = self._start
        self.parser.EndElementHandler = self._end
        self.parser.CharacterDataHandler = self._text
        self.parser.StartDoctypeDeclHandler = self._refuse_doctype

    def _place(self) -> Location:
        return Location(self.file, self.parser.CurrentLineNumber, self.parser.CurrentColumnNumber + 1)

    def _start(self, tag: str, attributes: dict[str, str]) -> None:
        self.count += 1
        if self.count > MAXIMUM_ELEMENTS or len(self.stack) >= MAXIMUM_DEPTH:
            message = f"more than {MAXIMUM_ELEMENTS} elements, or deeper than {MAXIMUM_DEPTH}"
            raise YamlError([Problem(self._place(), message)])
        element = Element(tag, attributes, self._place())
        if self.stack:
            self.stack[-1].children.append(element)
        else:
            self.root = element
        self.stack.append(element)

    def _end(self, tag: str) -> None:
        self.stack.pop()

    def _text(self, text: str) -> None:
        self.stack[-1].text += text

    def _refuse_doctype(self, *_: object) -> None:
        raise YamlError([Problem(self._place(), "a document type is not allowed")])
