"""Strict parser of SVG path data, which it converts to cubic Béziers.

fontTools interprets the commands. It skips unknown characters, which would silently change the drawing; so the numbers
are parsed here first, by the grammar of SVG 2 (section 9.3.9), and passed to it one by one.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

import numpy as np
from ezdxf.math import cubic_bezier_arc_parameters
from fontTools.svgLib.path import parse_path

from kinematics.arrays import Complex
from kinematics.message import compose
from service.outlines.curves import make_bezier, make_line, make_quadratic
from service.outlines.faults import Obstacle, UnsuitableDrawing
from service.outlines.limits import MAX_COORDINATE, MAX_PIECES

SEGMENTS_PER_TURN = 16
"""Number of cubics for a full turn; their largest deviation from the circle is 7e-8 of the radius."""

_NUMBER_PATTERN = re.compile(r"[\s,]*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)")
_FLAG_PATTERN = re.compile(r"[\s,]*([01])")
_COMMAND_PATTERN = re.compile(r"[\s,]*([A-Za-z])")
_SEPARATOR_PATTERN = re.compile(r"[\s,]*")
_ARGUMENT_COUNTS = {"M": 2, "L": 2, "H": 1, "V": 1, "C": 6, "S": 4, "Q": 4, "T": 2, "A": 7, "Z": 0}
_FLAG_POSITIONS = (3, 4)
"""Positions of the single-digit flags among the arguments of an arc; no separator needs to follow them."""


class Subpath:
    """A subpath in user units; ``pieces`` has shape (n, 4)."""

    def __init__(self, start: complex) -> None:
        self.start = self.end = start
        self.pieces: list[Complex] = []
        self.closed = False

    def add(self, pieces: Complex) -> None:
        """Append cubics of shape (k, 4)."""
        self.pieces.append(pieces)
        self.end = complex(pieces[-1, 3])


class _Pen:
    """Collects what fontTools draws; its method names are fontTools' pen protocol."""

    def __init__(self) -> None:
        self.subpaths: list[Subpath] = []

    def moveTo(self, point: tuple[float, float]) -> None:
        self.subpaths.append(Subpath(complex(*point)))

    def lineTo(self, point: tuple[float, float]) -> None:
        path = self.subpaths[-1]
        path.add(make_line(path.end, complex(*point)))

    def curveTo(self, first: tuple[float, float], second: tuple[float, float], end: tuple[float, float]) -> None:
        path = self.subpaths[-1]
        path.add(make_bezier(path.end, complex(*first), complex(*second), complex(*end)))

    def qCurveTo(self, control: tuple[float, float], end: tuple[float, float]) -> None:
        path = self.subpaths[-1]
        path.add(make_quadratic(path.end, complex(*control), complex(*end)))

    def arcTo(self, rx: float, ry: float, rotation: float, large: bool, sweep: bool, end: tuple[float, float]) -> None:
        path = self.subpaths[-1]
        path.add(make_arc(path.end, complex(rx, ry), rotation, large, sweep, complex(*end)))

    def closePath(self) -> None:
        self.subpaths[-1].closed = True

    def endPath(self) -> None:
        """Do nothing: an open subpath needs no closing piece."""


def parse_subpaths(data: str) -> list[Subpath]:
    """Parse SVG path data into subpaths.

    Raises
    ------
    ValueError
        If the data is invalid; the message gives the position.
    UnsuitableDrawing
        If the path has more pieces than a drawing may have.
    """
    pen = _Pen()
    tokens = list(_parse_tokens(data))
    # The longest command, an arc, has one letter and seven numbers.
    if len(tokens) > 8 * MAX_PIECES:
        raise UnsuitableDrawing(compose("outlines-path-too-long", limit=MAX_PIECES))
    parse_path(" ".join(tokens), pen)
    return [path for path in pen.subpaths if path.pieces]


def _parse_tokens(data: str) -> Iterator[str]:
    at, command = 0, ""
    end = len(data.rstrip())
    while (at := _skip_separators(data, at)) < end:
        if found := _COMMAND_PATTERN.match(data, at):
            command, at = found[1], found.end()
            if command.upper() not in _ARGUMENT_COUNTS:
                raise Obstacle("outlines-unknown-path-command", command=command, position=f"{at - 1}")
            yield command
            if command in "Zz":
                continue
        elif not command or command in "Zz":
            raise Obstacle("outlines-path-command-missing", position=f"{at}")
        for k in range(_ARGUMENT_COUNTS[command.upper()]):
            # A flag is a single digit and may touch the following number.
            pattern = _FLAG_PATTERN if command in "Aa" and k in _FLAG_POSITIONS else _NUMBER_PATTERN
            found = pattern.match(data, at)
            if found is None:
                raise Obstacle("outlines-path-number-missing", position=f"{at}")
            at = found.end()
            yield found[1] if pattern is _FLAG_PATTERN else _format_number(found[1])


def _skip_separators(data: str, at: int) -> int:
    found = _SEPARATOR_PATTERN.match(data, at)
    return found.end() if found else at


def _format_number(number: str) -> str:
    value = float(number)
    if not abs(value) <= MAX_COORDINATE:
        raise Obstacle("outlines-number-too-large", number=number[:20])
    return repr(value)


def make_arc(start: complex, radii: complex, rotation: float, large: bool, sweep: bool, end: complex) -> Complex:
    """Build an elliptical arc between two points as cubics, shape (k, 4); SVG 2, appendix B.2."""
    rx, ry = abs(radii.real), abs(radii.imag)
    if start == end or rx == 0.0 or ry == 0.0:
        return make_line(start, end)
    turn = np.exp(1j * np.radians(rotation))

    def to_unit_circle(z: complex) -> complex:
        turned = z * turn.conjugate()
        return complex(turned.real / rx, turned.imag / ry)

    half = to_unit_circle(0.5 * (start - end))
    # If the radii are too small for an ellipse through both points, SVG scales both by the same factor.
    grown = max(abs(half), 1.0)
    half /= grown
    across = 1j * half * np.sqrt(max(1.0 / abs(half) ** 2 - 1.0, 0.0))
    # The centre of the arc, in coordinates in which the ellipse is the unit circle.
    centre = -across if large != sweep else across
    first, last = half - centre, -half - centre
    swept = float(np.angle(last / first))
    if sweep and swept < 0.0:
        swept += 2.0 * np.pi
    elif not sweep and swept > 0.0:
        swept -= 2.0 * np.pi
    cubics = make_unit_arc(float(np.angle(first)), swept) + centre
    ellipse = grown * (cubics.real * rx + 1j * cubics.imag * ry) * turn
    placed = ellipse + 0.5 * (start + end)
    placed[0, 0], placed[-1, 3] = start, end
    return np.asarray(placed)


def make_unit_arc(start: float, swept: float) -> Complex:
    """Build an arc of the unit circle as cubics, shape (k, 4); angles in radians, ``swept`` of either sign."""
    count = max(int(np.ceil(abs(swept) / (2.0 * np.pi) * SEGMENTS_PER_TURN)), 1)
    # The library makes counter-clockwise arcs; a clockwise arc is the mirror image of one.
    way = 1.0 if swept >= 0.0 else -1.0
    found = cubic_bezier_arc_parameters(way * start, way * start + abs(swept), segments=count)
    cubics = np.array([[complex(point.x, way * point.y) for point in cubic] for cubic in found])
    return np.asarray(cubics)
