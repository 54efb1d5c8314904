"""Affine maps of the plane in complex numbers, and the parser of SVG's ``transform`` attribute."""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np

from kinematics.arrays import Complex
from service.outlines.faults import Obstacle

NUMBER_PATTERN = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?"
_FUNCTION_PATTERN = re.compile(r"[\s,]*(matrix|translate|scale|rotate|skewX|skewY)\s*\(([^()]*)\)")
_NUMBER_LIST_PATTERN = re.compile(rf"[\s,]*+(?:{NUMBER_PATTERN}[\s,]*+)*+")
_ARGUMENT_COUNTS = {
    "matrix": (6,),
    "translate": (1, 2),
    "scale": (1, 2),
    "rotate": (1, 3),
    "skewX": (1,),
    "skewY": (1,),
}

CONFORMAL_TOLERANCE = 1e-9
"""Relative difference of the two principal stretches up to which a map is considered to keep circles circular."""


@dataclass(frozen=True)
class Affine:
    """An affine map of the plane, z ↦ turn·z + flip·z̄ + shift."""

    turn: complex = 1.0
    flip: complex = 0.0
    shift: complex = 0.0

    def __call__(self, points: Complex) -> Complex:
        """Return the mapped points, of any shape."""
        return np.asarray(self.turn * points + self.flip * np.conj(points) + self.shift)

    def __matmul__(self, first: Affine) -> Affine:
        """Return the composition: ``first`` is applied first, then this map."""
        return Affine(
            self.turn * first.turn + self.flip * first.flip.conjugate(),
            self.turn * first.flip + self.flip * first.turn.conjugate(),
            self.turn * first.shift + self.flip * first.shift.conjugate() + self.shift,
        )

    @property
    def enlargement(self) -> float | None:
        """Factor by which circles grow, or None if the map turns circles into ellipses."""
        # Principal stretches are |turn| + |flip| and |turn| - |flip|: circles stay circles if one part vanishes.
        larger, smaller = sorted((abs(self.turn), abs(self.flip)), reverse=True)
        return larger if smaller <= CONFORMAL_TOLERANCE * larger else None

    @classmethod
    def from_matrix(cls, a: float, b: float, c: float, d: float, e: float, f: float) -> Affine:
        """Return the map (x, y) ↦ (ax + cy + e, bx + dy + f)."""
        # Images of the unit vectors x and y.
        along, across = complex(a, b), complex(c, d)
        return cls(0.5 * (along - 1j * across), 0.5 * (along + 1j * across), complex(e, f))


def parse_transform(text: str) -> Affine:
    """Parse the attribute ``transform``, a list of functions that apply from right to left.

    Raises
    ------
    ValueError
        If the text is not a list of transforms.
    """
    whole, at = Affine(), 0
    text = text.strip()
    while at < len(text):
        found = _FUNCTION_PATTERN.match(text, at)
        if found is None or not _NUMBER_LIST_PATTERN.fullmatch(found[2]):
            raise Obstacle("outlines-transform-unreadable")
        numbers = [float(number) for number in re.findall(NUMBER_PATTERN, found[2])]
        if len(numbers) not in _ARGUMENT_COUNTS[found[1]]:
            raise Obstacle("outlines-transform-number-count", count=len(numbers), function=found[1])
        # Functions apply from right to left: the last one maps first.
        whole = whole @ _make_affine(found[1], numbers)
        at = found.end()
        while at < len(text) and text[at] in ", \t\r\n":
            at += 1
    return whole


def _make_affine(name: str, numbers: list[float]) -> Affine:
    first = numbers[0]
    if name == "matrix":
        return Affine.from_matrix(*numbers)
    if name == "translate":
        return Affine(shift=complex(first, numbers[1] if len(numbers) == 2 else 0.0))
    if name == "scale":
        return Affine.from_matrix(first, 0.0, 0.0, numbers[-1], 0.0, 0.0)
    if name == "rotate":
        turn = complex(np.exp(1j * np.radians(first)))
        centre = complex(numbers[1], numbers[2]) if len(numbers) == 3 else 0.0
        return Affine(turn=turn, shift=centre - turn * centre)
    slope = float(np.tan(np.radians(first)))
    return Affine.from_matrix(1.0, slope if name == "skewY" else 0.0, slope if name == "skewX" else 0.0, 1.0, 0.0, 0.0)
