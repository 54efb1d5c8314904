"""Diagrams of a quantity over the angle of a cam or crank: frame, ticks of round numbers, curve, marks and limits."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from service.render.page.numbers import angle as written_angle
from service.render.page.numbers import length
from service.render.page.svg import (
    Box,
    Element,
    element,
    line,
    path,
    text,
)
from service.render.page.symbols import (
    DEMANDED,
    GREY,
    INK,
    PALE,
)

Real = NDArray[np.float64]

LEFT, FOOT, HEAD = 62.0, 22.0, 20.0
"""Room around the frame for the numbers at its left and below, and for its heading, pixels."""

TICKS = 5
"""Intervals of the vertical axis at most."""

QUARTERS = (0.0, 0.25, 0.5, 0.75, 1.0)
"""Shares of the horizontal axis that are numbered."""

TEXT = 10.0

FLAT = 1e-9
"""A range this small beside its values is drawn as a level line in the middle."""


@dataclass(frozen=True)
class Diagram:
    """One quantity over the angle of a cam or crank.

    Parameters
    ----------
    heading : str
        What is drawn, with its unit.
    name : str
        Marks the group as ``data-diagram``.
    angle, values : float, shape (n,)
        Degrees from 0 to ``span``, and the quantity; NaN interrupts the curve.
    colour : str
    limits : sequence of float
        Levels drawn as dashed lines.
    span : float
        Degrees that the diagram is wide.
    """

    heading: str
    name: str
    angle: Real
    values: Real
    colour: str
    limits: Sequence[float] = ()
    span: float = 360.0

    def draw(self, box: Box, joints: Sequence[float]) -> Element:
        """The diagram in a box of the sheet, with the segments' joints as vertical lines."""
        frame = Box(box.left + LEFT, box.low + HEAD, box.right - 4.0, box.high - FOOT)
        marks = ticks([*self.values[np.isfinite(self.values)].tolist(), *self.limits, 0.0])
        low, high = marks[0], marks[-1]

        def at(degrees: Real, values: Real) -> NDArray[np.complex128]:
            x = frame.left + frame.width * degrees / self.span
            y = frame.high - frame.height * (values - low) / (high - low)
            return np.asarray(x + 1j * y)

        group = element("g", data_diagram=self.name)
        group.add(text(frame.left, box.low + HEAD - 6.0, self.heading, 11.5, font_weight="bold", fill=INK))
        for share in QUARTERS:
            x = frame.left + frame.width * share
            group.add(line(complex(x, frame.high), complex(x, frame.high + 4.0), stroke=GREY, stroke_width=1.0))
            words = written_angle(share * self.span, 1 if self.span >= TEXT else 3)
            group.add(text(x, frame.high + 15.0, words, TEXT, text_anchor="middle", fill=GREY))
        for joint in joints:
            x = frame.left + frame.width * joint / self.span
            group.add(line(complex(x, frame.low), complex(x, frame.high), stroke=PALE, stroke_width=0.7))
        for mark in marks:
            y = float(at(np.array(0.0), np.array(mark)).imag)
            weight = 1.0 if mark == 0.0 else 0.4
            group.add(line(complex(frame.left, y), complex(frame.right, y), stroke=PALE, stroke_width=weight))
            words = length(mark, high - low, digits=4)
            group.add(text(frame.left - 5.0, y + 3.5, words, TEXT, text_anchor="end", fill=GREY))
        for limit in self.limits:
            y = float(at(np.array(0.0), np.array(limit)).imag)
            ends = complex(frame.left, y), complex(frame.right, y)
            group.add(line(*ends, stroke=DEMANDED, stroke_width=1.2, stroke_dasharray="5 3"))
        group.add(
            element(
                "rect",
                x=frame.left,
                y=frame.low,
                width=frame.width,
                height=frame.height,
                fill="none",
                stroke=GREY,
                stroke_width=0.8,
            )
        )
        known = np.isfinite(self.values)
        runs = np.split(np.arange(len(self.values)), np.flatnonzero(np.diff(known)) + 1)
        curve = [at(self.angle[run], self.values[run]) for run in runs if len(run) and known[run[0]]]
        return group.add(path(curve, stroke=self.colour, stroke_width=1.6, stroke_linejoin="round"))


def ticks(values: Sequence[float]) -> list[float]:
    """Round numbers (steps of 1, 2 or 5 times a power of ten) from below the least value to above the greatest."""
    low, high = min(values), max(values)
    spread = high - low
    if spread <= FLAT * max(abs(low), abs(high)):
        spread = max(abs(low), abs(high)) or 1.0
        low, high = low - 0.5 * spread, high + 0.5 * spread
    power = 10.0 ** math.floor(math.log10(spread / TICKS))
    step = next(step * power for step in (1.0, 2.0, 5.0, 10.0) if spread <= step * power * TICKS * (1.0 + FLAT))
    first, last = math.floor(low / step + FLAT), math.ceil(high / step - FLAT)
    return [k * step for k in range(first, last + 1)]
