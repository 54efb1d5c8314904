"""Parser for untrusted XML: it expands no entities, fetches nothing, and bounds the size of the tree."""

from __future__ import annotations

from dataclasses import dataclass, field
from xml.parsers import expat

from kinematics.message import compose
from service.outlines.faults import MalformedDrawing, UnsuitableDrawing
from service.outlines.limits import MAX_DEPTH, MAX_ELEMENTS

MAX_NESTING = 4 * MAX_DEPTH
"""Maximum nesting depth of elements of all kinds."""

MAX_ATTRIBUTES = 64
"""Maximum number of attributes of an element."""


@dataclass(frozen=True)
class Node:
    """An element; its name and those of its attributes are ``namespace name``, separated by a space."""

    name: str
    attributes: dict[str, str]
    children: list[Node] = field(default_factory=list)
    text: list[str] = field(default_factory=list)


def parse_xml(content: bytes) -> Node:
    """Parse a document and return its root.

    Raises
    ------
    MalformedDrawing
        If the document is not well-formed, or declares entities.
    UnsuitableDrawing
        If the document has too many elements, or nests them too deeply.
    """
    parser = expat.ParserCreate(namespace_separator=" ")
    # Without buffering, text arrives in arbitrary pieces.
    parser.buffer_text = True
    # Entity expansion can grow exponentially and read local files.
    parser.SetParamEntityParsing(expat.XML_PARAM_ENTITY_PARSING_NEVER)
    open_: list[Node] = []
    roots: list[Node] = []
    count = 0

    def start_element(name: str, attributes: dict[str, str]) -> None:
        nonlocal count
        count += 1
        if count > MAX_ELEMENTS:
            raise UnsuitableDrawing(compose("outlines-too-many-elements", limit=MAX_ELEMENTS))
        if len(open_) >= MAX_NESTING:
            raise UnsuitableDrawing(compose("outlines-elements-nested-too-deep", limit=MAX_NESTING))
        if len(attributes) > MAX_ATTRIBUTES:
            raise UnsuitableDrawing(compose("outlines-too-many-attributes", limit=MAX_ATTRIBUTES))
        node = Node(name, attributes)
        (open_[-1].children if open_ else roots).append(node)
        open_.append(node)

    def finish_element(name: str) -> None:
        open_.pop()

    def add_text(text: str) -> None:
        if open_:
            open_[-1].text.append(text)

    def refuse_entity(*_: object) -> None:
        raise MalformedDrawing(compose("outlines-xml-entities"))

    parser.StartElementHandler = start_element
    parser.EndElementHandler = finish_element
    parser.CharacterDataHandler = add_text
    parser.EntityDeclHandler = refuse_entity
    parser.UnparsedEntityDeclHandler = refuse_entity
    try:
        parser.Parse(content, True)
    except expat.ExpatError as error:
        # The message is the parser's own, "mismatched tag: line 3, column 5"; it holds nothing of the drawing.
        raise MalformedDrawing(compose("outlines-malformed-xml", reason=str(error))) from None
    except (ValueError, LookupError) as error:
        if isinstance(error, (MalformedDrawing, UnsuitableDrawing)):
            raise
        raise MalformedDrawing(compose("outlines-unknown-encoding")) from None
    return roots[0]
