"""The curves of an SVG drawing, with y upwards from the lower edge of the page."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from kinematics.arrays import Complex
from kinematics.message import Message, compose
from service.outlines.affine import NUMBER_PATTERN, Affine, parse_transform
from service.outlines.curves import NO_PIECES, Circle, Curve, Source, make_polyline
from service.outlines.drawing import Drawing
from service.outlines.faults import DrawingError, MalformedDrawing, Obstacle, UnsuitableDrawing, get_reason
from service.outlines.limits import MAX_DEPTH, MAX_ELEMENTS, MAX_PIECES
from service.outlines.path_data import make_unit_arc, parse_subpaths
from service.outlines.xml_tree import Node, parse_xml

SVG_NAMESPACE = "http://www.w3.org/2000/svg"
INKSCAPE_NAMESPACE = "http://www.inkscape.org/namespaces/inkscape"
XLINK_NAMESPACE = "http://www.w3.org/1999/xlink"

MILLIMETRES_PER_UNIT = {"mm": 1.0, "cm": 10.0, "in": 25.4, "pt": 25.4 / 72.0, "pc": 25.4 / 6.0, "Q": 0.25}
"""Millimetres per absolute unit. Pixels are omitted, because drawings in pixels have no physical size."""

PIXELS_PER_UNIT = {"px": 1.0, "": 1.0, **{unit: length * 96.0 / 25.4 for unit, length in MILLIMETRES_PER_UNIT.items()}}
"""User units in each length unit."""

_LENGTH_PATTERN = re.compile(rf"\s*({NUMBER_PATTERN})\s*([A-Za-z%]*)\s*")
_NUMBER_LIST_PATTERN = re.compile(rf"[\s,]*+(?:{NUMBER_PATTERN}[\s,]*+)*+")
_HIDDEN_PATTERN = re.compile(r"(?:^|;)\s*display\s*:\s*none\b")

_ALIGNMENT_SHARES = {"xMin": 0.0, "YMin": 0.0, "xMax": 1.0, "YMax": 1.0}
"""Share of the free space that lies before a view box, by alignment keyword; the default is 0.5 (centred)."""

GROUP_ELEMENTS = {"svg", "g", "a", "switch"}
INVISIBLE_ELEMENTS = {
    "defs",
    "symbol",
    "clipPath",
    "mask",
    "marker",
    "pattern",
    "style",
    "script",
    "title",
    "desc",
    "metadata",
}
"""Elements that draw nothing in place. Gradients, filters and the like contain no shapes."""

UNSUPPORTED_ELEMENTS = {
    "text": "outlines-element-is-text",
    "image": "outlines-element-is-picture",
    "foreignObject": "outlines-element-is-no-shape",
}
"""Elements that are not read, with the messages that say why."""


class SvgReader:
    """Walks through the elements of a drawing and collects its curves."""

    def __init__(self, root: Node) -> None:
        self.root = root
        self.found: list[Curve] = []
        self.left_out: list[tuple[Source, Message]] = []
        self.visited = self.pieces = 0
        self.by_id: dict[str, Node] = {}
        # An explicit stack: the depth of the file must not exhaust Python's recursion.
        pending = [root]
        while pending:
            node = pending.pop()
            if "id" in node.attributes:
                # Browsers resolve duplicate ids to the first element, too.
                self.by_id.setdefault(node.attributes["id"], node)
            pending += node.children

    def visit(self, node: Node, above: Affine, layer: str | None, depth: int) -> None:
        """Read an element and its children; ``above`` maps the coordinates of its parent to the drawing."""
        self.visited += 1
        if self.visited > MAX_ELEMENTS:
            raise UnsuitableDrawing(compose("outlines-too-many-svg-elements", limit=MAX_ELEMENTS))
        if depth > MAX_DEPTH:
            raise UnsuitableDrawing(compose("outlines-groups-nested-too-deep", limit=MAX_DEPTH))
        space, _, name = node.name.rpartition(" ")
        if space not in (SVG_NAMESPACE, "") or name in INVISIBLE_ELEMENTS or _is_hidden(node):
            return
        source = Source(name, node.attributes.get("id"), _get_name(node), layer)
        try:
            place = above @ parse_transform(node.attributes.get("transform", ""))
            if name in GROUP_ELEMENTS:
                if name == "svg" and depth:
                    place = place @ _map_inner(node, node)
                below = _get_layer(node) or layer
                for child in node.children:
                    self.visit(child, place, below, depth + 1)
            elif name == "use":
                self.use(node, place, layer, depth)
            elif name in UNSUPPORTED_ELEMENTS:
                raise Obstacle(UNSUPPORTED_ELEMENTS[name])
            elif name in SHAPE_READERS:
                for curve in SHAPE_READERS[name](node):
                    self.add(replace(curve, source=source), place)
        except DrawingError:
            raise
        except ValueError as error:
            self.left_out.append((source, get_reason(error)))

    def use(self, node: Node, place: Affine, layer: str | None, depth: int) -> None:
        """Read the element that a ``use`` refers to."""
        link = node.attributes.get("href", node.attributes.get(f"{XLINK_NAMESPACE} href", ""))
        used = self.by_id.get(link[1:]) if link.startswith("#") else None
        if used is None:
            raise Obstacle("outlines-use-of-missing-element")
        place = place @ Affine(shift=complex(_read_length(node, "x"), _read_length(node, "y")))
        if used.name.rpartition(" ")[2] != "symbol":
            return self.visit(used, place, layer, depth + 1)
        place = place @ _map_inner(used, node, used)
        for child in used.children:
            self.visit(child, place, layer, depth + 1)
        return None

    def add(self, curve: Curve, place: Affine) -> None:
        """Append a curve given in the coordinates of its element; ``place`` maps them to the drawing."""
        self.pieces += max(len(curve.pieces), 1)
        if self.pieces > MAX_PIECES:
            raise UnsuitableDrawing(compose("outlines-too-many-pieces", limit=MAX_PIECES))
        # A circle stays an exact circle under similarities; otherwise it becomes cubics.
        if curve.circle is not None:
            centre, radius = curve.circle.centre, curve.circle.radius
            if (larger := place.enlargement) is not None:
                circle = Circle(complex(place(np.array(centre))), larger * radius)
                return self.found.append(replace(curve, circle=circle))
            curve = replace(curve, circle=None, pieces=centre + radius * make_unit_arc(0.0, 2.0 * np.pi))
        return self.found.append(replace(curve, pieces=place(curve.pieces)))


def read_curves(content: bytes) -> Drawing:
    """Read the curves of the drawing.

    Raises
    ------
    MalformedDrawing
        If the content is not SVG.
    UnsuitableDrawing
        If the drawing exceeds the limits.
    """
    root = parse_xml(content)
    if root.name not in (f"{SVG_NAMESPACE} svg", "svg"):
        raise MalformedDrawing(compose("outlines-root-not-svg"))
    place, unit = _map_page(root)
    reader = SvgReader(root)
    reader.visit(root, place, None, 0)
    return Drawing("svg", reader.found, reader.left_out, unit)


def _map_page(root: Node) -> tuple[Affine, float | None]:
    """Return the map from user units to the drawing, and the millimetres in a user unit (None if unknown).

    The drawing keeps user units, with the origin at the lower left corner of the page. If the page is stretched by
    different factors in x and y, the smaller factor defines the unit.
    """
    width, height = (_parse_length(root.attributes.get(name, "")) for name in ("width", "height"))
    try:
        box = _parse_numbers(root.attributes.get("viewBox", ""), "outlines-view-box-unreadable")
    except Obstacle:
        raise MalformedDrawing(compose("outlines-page-view-box-unreadable")) from None
    if box and (len(box) != 4 or min(box[2:]) <= 0.0):
        raise MalformedDrawing(compose("outlines-page-view-box-invalid"))
    tall = box[3] if box else height[0] * PIXELS_PER_UNIT[height[1]] if height else 0.0
    left, top = box[:2] if box else (0.0, 0.0)
    if not box:
        # Without a view box a user unit is a pixel; its physical size is unknown.
        return Affine.from_matrix(1.0, 0.0, 0.0, -1.0, 0.0, tall), None
    spans = ((width, box[2]), (height, box[3]))
    scales = [stated[0] * PIXELS_PER_UNIT[stated[1]] / span if stated else None for stated, span in spans]
    known = [scale for scale in scales if scale]
    least = min(known, default=1.0)
    across, up = 1.0, 1.0
    # Only "none" stretches the view box; otherwise the smaller scale applies to both directions.
    if len(known) == 2 and root.attributes.get("preserveAspectRatio", "").split()[:1] == ["none"]:
        across, up = known[0] / least, known[1] / least
    absolute = [stated for stated in (width, height) if stated and stated[1] in MILLIMETRES_PER_UNIT]
    # CSS defines 96 px per inch.
    unit = least * 25.4 / 96.0 if absolute else None
    return Affine.from_matrix(across, 0.0, 0.0, -up, -across * left, up * (top + tall)), unit


def _map_inner(node: Node, *sized: Node) -> Affine:
    """Return the map from a nested drawing or a symbol to the coordinates around it.

    Its view box is fitted into a rectangle with the first width and the first height that ``sized`` give (SVG 2,
    section 8.2). Content outside the rectangle is not clipped.
    """
    corner = Affine(shift=complex(_read_length(node, "x"), _read_length(node, "y")))
    box = _parse_numbers(node.attributes.get("viewBox", ""), "outlines-view-box-unreadable")
    if not box:
        return corner
    if len(box) != 4 or min(box[2:]) <= 0.0:
        raise Obstacle("outlines-view-box-invalid")
    width, height = (
        next((_read_length(one, name) for one in sized if name in one.attributes), 0.0) for name in ("width", "height")
    )
    if width <= 0.0 or height <= 0.0:
        raise Obstacle("outlines-view-box-without-size")
    align, _, way = node.attributes.get("preserveAspectRatio", "").strip().partition(" ")
    across, down = width / box[2], height / box[3]
    if align != "none":
        across = down = max(across, down) if way.strip() == "slice" else min(across, down)
    left = _ALIGNMENT_SHARES.get(align[:4], 0.5) * (width - across * box[2])
    top = _ALIGNMENT_SHARES.get(align[4:], 0.5) * (height - down * box[3])
    return corner @ Affine.from_matrix(across, 0.0, 0.0, down, left - across * box[0], top - down * box[1])


def _parse_length(text: str) -> tuple[float, str] | None:
    """Parse a length with its unit; return None if it is missing or relative to the window."""
    found = _LENGTH_PATTERN.fullmatch(text)
    if not found or found[2] not in PIXELS_PER_UNIT or not 0.0 < float(found[1]) < float("inf"):
        return None
    return float(found[1]), found[2]


def _read_length(node: Node, name: str, default: float = 0.0) -> float:
    """Return an attribute in user units."""
    if name not in node.attributes:
        return default
    found = _LENGTH_PATTERN.fullmatch(node.attributes[name])
    if not found or found[2] not in PIXELS_PER_UNIT:
        raise Obstacle("outlines-length-unreadable", attribute=name)
    return float(found[1]) * PIXELS_PER_UNIT[found[2]]


def _parse_numbers(text: str, message_id: str) -> list[float]:
    """Parse a list of numbers; raise an obstacle with a message for anything else."""
    if not _NUMBER_LIST_PATTERN.fullmatch(text):
        raise Obstacle(message_id)
    return [float(number) for number in re.findall(NUMBER_PATTERN, text)]


def _is_hidden(node: Node) -> bool:
    return node.attributes.get("display") == "none" or bool(_HIDDEN_PATTERN.search(node.attributes.get("style", "")))


def _get_name(node: Node) -> str | None:
    title = next((child for child in node.children if child.name.rpartition(" ")[2] == "title"), None)
    told = node.attributes.get(f"{INKSCAPE_NAMESPACE} label") or "".join(title.text if title else []).strip()
    return told or None


def _get_layer(node: Node) -> str | None:
    """Return the layer name of a group: its own name or id."""
    return _get_name(node) or node.attributes.get("id")


_BLANK_SOURCE = Source("")


def _read_path(node: Node) -> Iterator[Curve]:
    try:
        subpaths = parse_subpaths(node.attributes.get("d", ""))
    except DrawingError:
        raise
    except ValueError as error:
        raise Obstacle("outlines-path-data-wrong", reason=get_reason(error)) from None
    for subpath in subpaths:
        yield Curve(_BLANK_SOURCE, np.concatenate(subpath.pieces), subpath.closed)


def _read_polygon(node: Node) -> Iterator[Curve]:
    numbers = _parse_numbers(node.attributes.get("points", ""), "outlines-points-unreadable")
    if len(numbers) % 2 or len(numbers) < 4:
        raise Obstacle("outlines-points-not-pairs")
    points = np.array(numbers[::2]) + 1j * np.array(numbers[1::2])
    closed = node.name.endswith("polygon")
    yield Curve(_BLANK_SOURCE, make_polyline(np.append(points, points[0]) if closed else points), closed)


def _read_line(node: Node) -> Iterator[Curve]:
    ends = [complex(_read_length(node, f"x{k}"), _read_length(node, f"y{k}")) for k in (1, 2)]
    yield Curve(_BLANK_SOURCE, make_polyline(np.array(ends)), False)


def _read_circle(node: Node) -> Iterator[Curve]:
    radius = _read_length(node, "r")
    if radius > 0.0:
        yield Curve(
            _BLANK_SOURCE, NO_PIECES, True, Circle(complex(_read_length(node, "cx"), _read_length(node, "cy")), radius)
        )


def _read_ellipse(node: Node) -> Iterator[Curve]:
    rx = _read_length(node, "rx", _read_length(node, "ry"))
    ry = _read_length(node, "ry", rx)
    centre = complex(_read_length(node, "cx"), _read_length(node, "cy"))
    if rx > 0.0 and rx == ry:
        yield Curve(_BLANK_SOURCE, NO_PIECES, True, Circle(centre, rx))
    elif rx > 0.0 and ry > 0.0:
        turn = make_unit_arc(0.0, 2.0 * np.pi)
        yield Curve(_BLANK_SOURCE, centre + rx * turn.real + 1j * ry * turn.imag, True)


def _read_rect(node: Node) -> Iterator[Curve]:
    corner = complex(_read_length(node, "x"), _read_length(node, "y"))
    width, height = _read_length(node, "width"), _read_length(node, "height")
    if width <= 0.0 or height <= 0.0:
        return
    rx = _read_length(node, "rx", _read_length(node, "ry"))
    ry = _read_length(node, "ry", rx)
    rx, ry = min(max(rx, 0.0), 0.5 * width), min(max(ry, 0.0), 0.5 * height)
    if rx == 0.0 or ry == 0.0:
        corners = corner + np.array([0.0, width, complex(width, height), 1j * height, 0.0])
        yield Curve(_BLANK_SOURCE, make_polyline(corners), True)
        return
    # Quarter turns about the centres of its corners, and sides between them.
    centres = [complex(width - rx, ry), complex(width - rx, height - ry), complex(rx, height - ry), complex(rx, ry)]
    pieces: list[Complex] = []
    for k, centre in enumerate(centres):
        quarter = make_unit_arc((k - 1) * 0.5 * np.pi, 0.5 * np.pi)
        rounded = corner + centre + rx * quarter.real + 1j * ry * quarter.imag
        if pieces:
            pieces.append(make_polyline(np.array([pieces[-1][-1, 3], rounded[0, 0]])))
        pieces.append(rounded)
    pieces.append(make_polyline(np.array([pieces[-1][-1, 3], pieces[0][0, 0]])))
    yield Curve(_BLANK_SOURCE, np.concatenate(pieces), True)


SHAPE_READERS = {
    "path": _read_path, "polygon": _read_polygon, "polyline": _read_polygon, "line": _read_line,
    "circle": _read_circle, "ellipse": _read_ellipse, "rect": _read_rect,
}  # fmt: skip
