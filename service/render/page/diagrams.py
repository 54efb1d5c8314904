"""Diagrams of a quantity over an angle or another quantity: frame, ticks at round numbers, curve, marks and limits."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from kinematics.arrays import Complex, Real
from service.render.page.numbers import format_angle as written_angle
from service.render.page.numbers import format_length
from service.render.page.svg import Box, Element, draw_circle, draw_line, draw_path, draw_text, make_element
from service.render.page.symbols import GREY, INK, PALE, TARGET_COLOUR

MARGIN_LEFT, MARGIN_BELOW, MARGIN_ABOVE, MARGIN_RIGHT = 62.0, 22.0, 20.0, 4.0
"""Margins of the frame: numbers at the left and below, heading above, and the right margin; pixels."""

MAX_TICK_INTERVALS = 5
"""Maximum number of intervals of the vertical axis."""

AXIS_SHARES = (0.0, 0.25, 0.5, 0.75, 1.0)
"""Shares of the horizontal axis that get numbers."""

FONT_SIZE = 10.0

FLATNESS_TOLERANCE = 1e-9
"""Range of values, as a share of their magnitude, below which they are drawn as a level line in the middle."""


@dataclass(frozen=True)
class Diagram:
    """One quantity over another.

    Parameters
    ----------
    heading : str
        The quantity with its unit.
    name : str
        Marks the group as ``data-diagram``.
    at, values : float, shape (n,)
        Abscissa (degrees if it is an angle), whose range is that of the diagram, and the quantity; NaN interrupts the
        curve.
    colour : str
    limits : sequence of float
        Levels drawn as dashed lines.
    turned : bool
        Whether the abscissa is an angle: its quarters are numbered, otherwise round numbers.
    from_zero : bool
        Whether the range always includes zero.
    stems : bool
        Whether to draw separate values, each on a line from zero, instead of a curve.
    dots, rings : sequence of complex
        Marked points: values of the curve, and required values.
    height : float
        Height in pixels in a stack of diagrams.
    """

    heading: str
    name: str
    at: Real
    values: Real
    colour: str
    limits: Sequence[float] = ()
    turned: bool = True
    from_zero: bool = True
    stems: bool = False
    dots: Sequence[complex] | Complex = ()
    rings: Sequence[complex] | Complex = ()
    height: float = 170.0

    def draw(self, box: Box, joints: Sequence[float] = ()) -> Element:
        """Draw the diagram in a box of the sheet, with the segments' joints as vertical lines."""
        frame = Box(box.left + MARGIN_LEFT, box.low + MARGIN_ABOVE, box.right - MARGIN_RIGHT, box.high - MARGIN_BELOW)
        # The vertical range includes limits and marks, not only the curve.
        levels = [*self.limits, *(point.imag for point in (*self.dots, *self.rings)), *([0.0] * self.from_zero)]
        marks = find_ticks([*self.values[np.isfinite(self.values)].tolist(), *levels])
        first, last = self.interval

        def place(at: float | Real, values: float | Real) -> Complex:
            x = frame.left + frame.width * (at - first) / (last - first)
            y = frame.high - frame.height * (values - marks[0]) / (marks[-1] - marks[0])
            return np.asarray(x + 1j * y)

        group = make_element("g", data_diagram=self.name)
        group.add(draw_text(frame.left, box.low + MARGIN_ABOVE - 6.0, self.heading, 11.5, font_weight="bold", fill=INK))
        for at, words in self._label_axis():
            foot = complex(float(place(at, marks[0]).real), frame.high)
            group.add(draw_line(foot, foot + 4j, stroke=GREY, stroke_width=1.0))
            group.add(draw_text(foot.real, foot.imag + 15.0, words, FONT_SIZE, text_anchor="middle", fill=GREY))
        for joint in joints:
            x = float(place(joint, marks[0]).real)
            group.add(draw_line(complex(x, frame.low), complex(x, frame.high), stroke=PALE, stroke_width=0.7))
        for mark in marks:
            y = float(place(first, mark).imag)
            weight = 1.0 if mark == 0.0 else 0.4
            group.add(draw_line(complex(frame.left, y), complex(frame.right, y), stroke=PALE, stroke_width=weight))
            words = format_length(mark, marks[-1] - marks[0], digits=4)
            group.add(draw_text(frame.left - 5.0, y + 3.5, words, FONT_SIZE, text_anchor="end", fill=GREY))
        for limit in self.limits:
            ends = complex(place(first, limit)), complex(place(last, limit))
            group.add(draw_line(*ends, stroke=TARGET_COLOUR, stroke_width=1.2, stroke_dasharray="5 3"))
        size = {"x": frame.left, "y": frame.low, "width": frame.width, "height": frame.height}
        group.add(make_element("rect", **size, fill="none", stroke=GREY, stroke_width=0.8))
        points = place(self.at, self.values)
        if self.stems:
            feet = place(self.at, np.zeros_like(self.values))
            for foot, point in zip(feet.tolist(), points.tolist(), strict=True):
                group.add(draw_line(foot, point, stroke=self.colour, stroke_width=1.6))
        else:
            # Split the curve at undefined values.
            known = np.isfinite(self.values)
            runs = np.split(np.arange(len(self.values)), np.flatnonzero(np.diff(known)) + 1)
            curve = [points[run] for run in runs if len(run) and known[run[0]]]
            group.add(draw_path(curve, stroke=self.colour, stroke_width=1.6, stroke_linejoin="round"))
        for dot in self.dots:
            group.add(
                draw_circle(complex(place(dot.real, dot.imag)), 2.6, fill=self.colour, data_dot=repr(float(dot.real)))
            )
        for ring in self.rings:
            style = {"fill": "none", "stroke": TARGET_COLOUR, "data_target": repr(float(ring.real))}
            group.add(draw_circle(complex(place(ring.real, ring.imag)), 4.5, stroke_width=1.5, **style))
        return group

    @property
    def interval(self) -> tuple[float, float]:
        """First and last abscissa."""
        return float(self.at.min()), float(self.at.max())

    def _label_axis(self) -> list[tuple[float, str]]:
        """Return the numbered places of the horizontal axis with their labels."""
        first, last = self.interval
        span = last - first
        # Angles are numbered at quarters of the range.
        if self.turned:
            return [
                (first + share * span, written_angle(share * span, 1 if span >= FONT_SIZE else 3))
                for share in AXIS_SHARES
            ]
        inside = [
            at
            for at in find_ticks([first, last])
            if first - FLATNESS_TOLERANCE * span <= at <= last + FLATNESS_TOLERANCE * span
        ]
        return [(at, format_length(at, span, digits=5)) for at in inside]


def find_ticks(values: Sequence[float]) -> list[float]:
    """Return round numbers (steps of 1, 2 or 5 times a power of ten) that enclose the values."""
    low, high = min(values), max(values)
    spread = high - low
    # Constant values get an interval of their own size.
    if spread <= FLATNESS_TOLERANCE * max(abs(low), abs(high)):
        spread = max(abs(low), abs(high)) or 1.0
        low, high = low - 0.5 * spread, high + 0.5 * spread
    power = 10.0 ** math.floor(math.log10(spread / MAX_TICK_INTERVALS))
    # The smallest round step that needs no more than the maximum number of intervals.
    step = next(
        step * power
        for step in (1.0, 2.0, 5.0, 10.0)
        if spread <= step * power * MAX_TICK_INTERVALS * (1.0 + FLATNESS_TOLERANCE)
    )
    # Tolerate rounding, so that a round limit adds no extra tick.
    first, last = math.floor(low / step + FLATNESS_TOLERANCE), math.ceil(high / step - FLATNESS_TOLERANCE)
    return [k * step for k in range(first, last + 1)]
