"""Placement of labels in a panel: next to their points, clear of links, joints and each other.

Every label tries positions on rings around its point, in a fixed order of directions, and takes the one of least cost.
The cost depends on the elements that the label's box would cover. Other labels cost most, followed by joints, links and
curves. A larger ring and a direction other than the preferred one cost little. Labels are placed in order of
importance.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Complex, Real
from service.render.page.svg import (
    FONT_ASCENT,
    FONT_DESCENT,
    SUBSCRIPT,
    Box,
    Element,
    clip_segments,
    draw_line,
    draw_text,
    estimate_text_width,
    make_element,
)

TRIAL_GAPS = (0.0, 4.0, 9.0, 16.0, 26.0, 40.0, 58.0, 80.0)
"""Trial gaps between a point's clearance and the label's box, pixels."""


HALO = {"stroke": "#fff", "stroke_width": "3", "stroke_linejoin": "round", "paint_order": "stroke"}
"""White rim of a label, so that it is legible on lines."""

DIRECTIONS = np.exp(2j * np.pi * np.arange(24) / 24)

GAP_COST, TURN_COST = 0.25, 3.0
"""Cost of a gap per pixel, and of a direction at right angles to the preferred one."""

SUBSCRIPT_DESCENT = 0.12
"""Descent of a subscript below the letters, in units of the font size."""

LABEL_PADDING = 2.0
"""Space between a label and the lines that it avoids, pixels."""

OVERLAP_COST = 1000.0
"""Cost of covering another label or leaving the panel; exceeds all other costs together."""

LEADER_GAP = 15.0
"""Minimum gap at which a leader line connects a label with its point, pixels."""

NEAR_GAPS = tuple(gap for gap in TRIAL_GAPS if gap < LEADER_GAP)
"""Trial gaps for optional labels."""

SAMPLE_STEP = 5.0
"""Distance of the sample points on lines that labels avoid, pixels; less than half the height of any label."""


class Label(NamedTuple):
    """The text of a label.

    Attributes
    ----------
    words, subscript : str
        The text.
    size : float
        Font size, pixels.
    style : mapping
        Attributes of the text.
    ring : str, optional
        Colour of a circle around the text.
    """

    words: str
    size: float
    style: Mapping[str, str]
    subscript: str = ""
    ring: str | None = None


class LabelPlacement(NamedTuple):
    """A label's box, and a leader from its point if it is far away."""

    box: Box
    leader: tuple[complex, complex] | None


class Labels:
    """The labels of one panel and the obstacles that they avoid."""

    def __init__(self, panel: Box) -> None:
        self._panel = panel
        self._boxes: list[Box] = []
        self._lines: list[tuple[Complex, float]] = []
        self._samples: tuple[Complex, Real] | None = None
        self.drawn: list[Element] = []

    def add_obstacles(self, lines: list[Complex], weight: float) -> None:
        """Add polylines of the sheet as obstacles; ``weight`` is the cost per few pixels covered."""
        self._lines.extend((polyline, weight) for polyline in lines)
        self._samples = None

    def reserve(self, box: Box) -> None:
        """Add a box of the sheet that no label may cover."""
        self._boxes.append(box)

    def place(
        self,
        point: complex,
        label: Label,
        *,
        clearance: float = 6.0,
        away: complex = 1j,
        optional: bool = False,
    ) -> None:
        """Draw a label next to a point of the sheet.

        Parameters
        ----------
        point : complex
            The labelled point; outside the panel it gets no label.
        label : Label
        clearance : float
            Radius of the mark at the point, pixels.
        away : complex
            Preferred direction from the point to the label.
        optional : bool
            Omit the label if it would cover another one or be far from its point.
        """
        if not self._panel.holds(point):
            return
        words, size, style, subscript, ring = label
        width = estimate_text_width(words, size) + estimate_text_width(subscript, SUBSCRIPT * size)
        height = (FONT_ASCENT + FONT_DESCENT) * size + (SUBSCRIPT_DESCENT * size if subscript else 0.0)
        if ring:
            width = height = max(width, height) + 4.0
        placed, cost = self._find_best(point, width, height, clearance, away, NEAR_GAPS if optional else TRIAL_GAPS)
        if optional and cost >= OVERLAP_COST:
            return
        self._boxes.append(placed.box)
        box = placed.box
        if placed.leader:
            self.drawn.append(draw_line(*placed.leader, stroke="#555", stroke_width=0.7))
        if ring:
            self.drawn.append(
                make_element("circle", cx=box.centre.real, cy=box.centre.imag, r=0.5 * width, fill="#fff", stroke=ring)
            )
        below = SUBSCRIPT_DESCENT if subscript else 0.0
        base = box.centre.imag + 0.5 * (FONT_ASCENT - FONT_DESCENT - below) * size
        self.drawn.append(
            draw_text(
                box.centre.real,
                base,
                words,
                size,
                subscript=subscript,
                text_anchor="middle",
                data_label=words + subscript,
                **({} if ring else HALO),
                **style,
            )
        )

    def _find_best(
        self, point: complex, width: float, height: float, clearance: float, away: complex, rings: tuple[float, ...]
    ) -> tuple[LabelPlacement, float]:
        """Find the cheapest place and its cost; rings that cannot beat the best place so far are skipped."""
        # Upwards if no direction is preferred.
        preferred = away / abs(away) if abs(away) > 0.0 else 1j
        turned_away = TURN_COST * (1.0 - (DIRECTIONS * preferred.conjugate()).real)
        # The box touches the circle of radius clearance + gap about the point in the label's direction.
        half = 0.5 * (width * np.abs(DIRECTIONS.real) + height * np.abs(DIRECTIONS.imag))
        reach = clearance + rings[-1] + width + height
        obstacles = self._select_near(point, reach)
        best, best_place = math.inf, None
        for gap in rings:
            # Larger gaps only cost more.
            if GAP_COST * gap >= best:
                break
            centres = point + DIRECTIONS * (clearance + gap + half)
            cost = GAP_COST * gap + turned_away + self._compute_cost(centres, width, height, *obstacles)
            k = int(np.argmin(cost))
            if cost[k] < best:
                best, best_place = float(cost[k]), (gap, complex(DIRECTIONS[k]), complex(centres[k]), float(half[k]))
        assert best_place is not None
        gap, direction, centre, radius = best_place
        leader = (point + clearance * direction, centre - direction * (radius - 1.0)) if gap >= LEADER_GAP else None
        corner = 0.5 * complex(width, height)
        low, high = centre - corner, centre + corner
        return LabelPlacement(Box(low.real, low.imag, high.real, high.imag), leader), best

    def _select_near(self, point: complex, reach: float) -> tuple[Complex, Real]:
        """Return sample points of the obstacle lines within reach of a point, and their weights."""
        if self._samples is None:
            self._samples = self._sample_lines()
        points, weights = self._samples
        # Only obstacles that some trial box could cover.
        near = (np.abs(points.real - point.real) < reach) & (np.abs(points.imag - point.imag) < reach)
        return points[near], weights[near]

    def _sample_lines(self) -> tuple[Complex, Real]:
        lines = [(polyline, weight) for polyline, weight in self._lines if polyline.size > 1 and weight > 0.0]
        if not lines:
            return np.empty(0, np.complex128), np.empty(0)
        start = np.concatenate([polyline[:-1] for polyline, _ in lines])
        end = np.concatenate([polyline[1:] for polyline, _ in lines])
        # One weight per segment of every polyline.
        weights = np.repeat([weight for _, weight in lines], [polyline.size - 1 for polyline, _ in lines])
        enter, leave = clip_segments(start, end, self._panel)
        seen = enter <= leave
        step = (end - start)[seen]
        start, step = start[seen] + enter[seen] * step, (leave - enter)[seen] * step
        count = np.ceil(np.abs(step) / SAMPLE_STEP).astype(np.int64) + 1
        order = np.arange(count.sum()) - np.repeat(np.cumsum(count) - count, count)
        share = (order + 0.5) / np.repeat(count, count)
        # A segment shorter than one sample step counts for less than a full step.
        weight = weights[seen] * np.minimum(1.0, np.abs(step) / (SAMPLE_STEP * count) + 0.25)
        return np.repeat(start, count) + share * np.repeat(step, count), np.repeat(weight, count)

    def _compute_cost(self, centres: Complex, width: float, height: float, points: Complex, weights: Real) -> Real:
        """Compute the cost of the elements that boxes at the given centres cover."""
        x, y = centres.real, centres.imag
        left, right, low, high = x - 0.5 * width, x + 0.5 * width, y - 0.5 * height, y + 0.5 * height
        panel = self._panel
        # A label outside the panel is as bad as an overlap.
        cost = OVERLAP_COST * ((left < panel.left) | (right > panel.right) | (low < panel.low) | (high > panel.high))
        for box in self._boxes:
            cost = cost + OVERLAP_COST * ((left < box.right) & (box.left < right) & (low < box.high) & (box.low < high))
        if points.size == 0:
            return np.asarray(cost, np.float64)
        inside = np.abs(points.real - x[:, None]) < 0.5 * width + LABEL_PADDING
        inside &= np.abs(points.imag - y[:, None]) < 0.5 * height + LABEL_PADDING
        return np.asarray(cost + inside @ weights)


def find_free_direction(directions: list[complex]) -> complex:
    """Return the middle of the widest gap between directions from a point, where a label has most space."""
    angles = sorted(cmath.phase(d) for d in directions if abs(d) > 0.0)
    if not angles:
        return 1j
    # The last gap wraps around the full turn.
    gaps = [(later - angle, angle) for angle, later in zip(angles, [*angles[1:], angles[0] + math.tau], strict=True)]
    gap, start = max(gaps)
    return cmath.exp(1j * (start + 0.5 * gap))
