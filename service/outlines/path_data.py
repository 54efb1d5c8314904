"""The data of an SVG path, read strictly and turned into cubic Béziers.

fontTools interprets the commands. It skips unknown characters, which would silently change the drawing; so the numbers
are parsed here first, by the grammar of SVG 2 (section 9.3.9), and passed to it one by one.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

import numpy as np
from ezdxf.math import cubic_bezier_arc_parameters
from fontTools.svgLib.path import parse_path

from service.outlines.curves import Complex, bezier, line, quadratic
from service.outlines.faults import Unsuitable
from service.outlines.limits import FARTHEST, MOST_PIECES

ARC_SEGMENTS = 16
"""Number of cubics for a full turn; their largest deviation from the circle is 7e-8 of the radius."""

_NUMBER = re.compile(r"[\s,]*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)")
_FLAG = re.compile(r"[\s,]*([01])")
_COMMAND = re.compile(r"[\s,]*([A-Za-z])")
_REST = re.compile(r"[\s,]*")
_COUNTS = {"M": 2, "L": 2, "H": 1, "V": 1, "C": 6, "S": 4, "Q": 4, "T": 2, "A": 7, "Z": 0}
_FLAGS = (3, 4)
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
        path.add(line(path.end, complex(*point)))

    def curveTo(self, first: tuple[float, float], second: tuple[float, float], end: tuple[float, float]) -> None:
        path = self.subpaths[-1]
        path.add(bezier(path.end, complex(*first), complex(*second), complex(*end)))

    def qCurveTo(self, control: tuple[float, float], end: tuple[float, float]) -> None:
        path = self.subpaths[-1]
        path.add(quadratic(path.end, complex(*control), complex(*end)))

    def arcTo(self, rx: float, ry: float, rotation: float, large: bool, sweep: bool, end: tuple[float, float]) -> None:
        path = self.subpaths[-1]
        path.add(arc(path.end, complex(rx, ry), rotation, large, sweep, complex(*end)))

    def closePath(self) -> None:
        self.subpaths[-1].closed = True

    def endPath(self) -> None:
        """Do nothing: an open subpath needs no closing piece."""


def subpaths_of(data: str) -> list[Subpath]:
    """Parse SVG path data into subpaths.

    Raises
    ------
    ValueError
        The data is invalid; the message gives the position.
    Unsuitable
        The path has more pieces than a drawing may have.
    """
    pen = _Pen()
    tokens = list(_tokens(data))
    # The longest command, an arc, has one letter and seven numbers.
    if len(tokens) > 8 * MOST_PIECES:
        raise Unsuitable(f"A path has more than {MOST_PIECES} pieces.")
    parse_path(" ".join(tokens), pen)
    return [path for path in pen.subpaths if path.pieces]


def _tokens(data: str) -> Iterator[str]:
    at, command = 0, ""
    end = len(data.rstrip())
    while (at := _skipped(data, at)) < end:
        if found := _COMMAND.match(data, at):
            command, at = found[1], found.end()
            if command.upper() not in _COUNTS:
                raise ValueError(f"it has no command “{command}”, at character {at - 1}")
            yield command
            if command in "Zz":
                continue
        elif not command or command in "Zz":
            raise ValueError(f"a command is missing at character {at}")
        for k in range(_COUNTS[command.upper()]):
            # A flag is a single digit and may touch the following number.
            pattern = _FLAG if command in "Aa" and k in _FLAGS else _NUMBER
            found = pattern.match(data, at)
            if found is None:
                raise ValueError(f"a number is missing at character {at}")
            at = found.end()
            yield found[1] if pattern is _FLAG else _spelt(found[1])


def _skipped(data: str, at: int) -> int:
    found = _REST.match(data, at)
    return found.end() if found else at


def _spelt(number: str) -> str:
    value = float(number)
    if not abs(value) <= FARTHEST:
        raise ValueError(f"the number {number[:20]} is too large")
    return repr(value)


def arc(start: complex, radii: complex, rotation: float, large: bool, sweep: bool, end: complex) -> Complex:
    """Build an elliptical arc between two points as cubics, shape (k, 4); SVG 2, appendix B.2."""
    rx, ry = abs(radii.real), abs(radii.imag)
    if start == end or rx == 0.0 or ry == 0.0:
        return line(start, end)
    turn = np.exp(1j * np.radians(rotation))

    def unit(z: complex) -> complex:
        turned = z * turn.conjugate()
        return complex(turned.real / rx, turned.imag / ry)

    half = unit(0.5 * (start - end))
    # Radii that do not reach are made larger by one factor.
    grown = max(abs(half), 1.0)
    half /= grown
    across = 1j * half * np.sqrt(max(1.0 / abs(half) ** 2 - 1.0, 0.0))
    # From the centre, on the unit circle.
    centre = -across if large != sweep else across
    first, last = half - centre, -half - centre
    swept = float(np.angle(last / first))
    if sweep and swept < 0.0:
        swept += 2.0 * np.pi
    elif not sweep and swept > 0.0:
        swept -= 2.0 * np.pi
    cubics = unit_arc(float(np.angle(first)), swept) + centre
    ellipse = grown * (cubics.real * rx + 1j * cubics.imag * ry) * turn
    placed = ellipse + 0.5 * (start + end)
    placed[0, 0], placed[-1, 3] = start, end
    return np.asarray(placed)


def unit_arc(start: float, swept: float) -> Complex:
    """Build an arc of the unit circle as cubics, shape (k, 4); angles in radians, ``swept`` of either sign."""
    count = max(int(np.ceil(abs(swept) / (2.0 * np.pi) * ARC_SEGMENTS)), 1)
    # The library goes counter-clockwise; the mirror image goes the other way.
    way = 1.0 if swept >= 0.0 else -1.0
    found = cubic_bezier_arc_parameters(way * start, way * start + abs(swept), segments=count)
    cubics = np.array([[complex(point.x, way * point.y) for point in cubic] for cubic in found])
    return np.asarray(cubics)
