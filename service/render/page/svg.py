"""A small SVG writer: elements, escaping, number format, and the viewport between mechanism and sheet.

Glossary:

sheet     the whole drawing, in pixels, y down;
panel     a rectangle of the sheet that shows the mechanism;
viewport  the map from mechanism coordinates (y up, any unit) to a panel; one scale for both directions.

Points are complex numbers on both sides: x + iy in the mechanism, x + iy with y down on the sheet. All styles are
attributes of the elements and no element has an ``id``, so that many drawings can stand in one page.
"""

from __future__ import annotations

import math
import unicodedata
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex

DECIMALS = 2
"""Decimals of sheet coordinates: a hundredth of a pixel."""

ESCAPES = str.maketrans({"&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;"})

GLYPH_WIDTHS = {
    character: width
    for width, characters in ((0.4, "ijl.,:;|'!()[]/ ·"), (1.0, "mwMW%@—×→"), (0.64, "0123456789−+=<>≤≥–"))
    for character in characters
}
"""Glyph widths in units of the font size, for the widest of the common sans-serif faces."""

DIRECTION_CONTROLS = frozenset((*range(0x202A, 0x202F), *range(0x2066, 0x206A)))
"""Control characters that would change the direction of all following text."""

SUBSCRIPT, SUBSCRIPT_DROP = 0.75, 0.25
"""Font size of a subscript, and its drop below the base line, in units of the font size."""

FONT_ASCENT, FONT_DESCENT = 0.78, 0.22
"""Extent of text above and below its base line, in units of the font size."""


def format_number(value: float) -> str:
    """Format a sheet coordinate; raise ``ValueError`` if it is not finite."""
    if not math.isfinite(value):
        raise ValueError(f"expected a finite coordinate, got {value}")
    text = f"{value:.{DECIMALS}f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def clean_text(text: str) -> str:
    """Return text without characters that XML 1.0 forbids and without control of the writing direction.

    Every run of white space becomes one space.
    """
    kept = "".join(c if _is_allowed(c) else " " if c.isspace() else "" for c in text)
    return " ".join(kept.split())


def _is_allowed(character: str) -> bool:
    code = ord(character)
    if code in DIRECTION_CONTROLS:
        return False
    return 0x20 <= code < 0x7F or 0xA0 <= code <= 0xD7FF or 0xE000 <= code <= 0xFFFD or code >= 0x10000


def estimate_text_width(text: str, size: float) -> float:
    """Estimate the width of a line of text in pixels, rather too wide than too narrow."""
    return size * sum(_get_glyph_width(c) for c in text)


def _get_glyph_width(character: str) -> float:
    known = GLYPH_WIDTHS.get(character)
    if known is not None:
        return known
    # Accents are drawn over the previous glyph.
    if unicodedata.combining(character):
        return 0.0
    # Wide and full-width characters fill a square.
    if unicodedata.east_asian_width(character) in "WF":
        return 1.05
    return 0.72 if character.isupper() else 0.63


def truncate_text(text: str, size: float, width: float) -> str:
    """Truncate text with an ellipsis to fit in ``width`` pixels."""
    if estimate_text_width(text, size) <= width:
        return text
    room = width - estimate_text_width("…", size)
    used = 0.0
    for count, character in enumerate(text):
        # Accumulate widths until the ellipsis would no longer fit.
        used += _get_glyph_width(character) * size
        if used > room:
            return text[:count].rstrip() + "…"
    return text


@dataclass
class Element:
    """An SVG element: attributes in the order of writing, and children that are elements or plain text."""

    tag: str
    attributes: dict[str, str | float]
    children: list[Element | str] = field(default_factory=list)

    def add(self, *children: Element | str | None) -> Element:
        """Append the children that are not None; return the element itself."""
        self.children.extend(child for child in children if child is not None)
        return self

    def write(self) -> str:
        """Return the element as XML text."""
        parts: list[str] = []
        self._write(parts)
        return "".join(parts)

    def _write(self, parts: list[str]) -> None:
        parts.append(f"<{self.tag}")
        for name, value in self.attributes.items():
            parts.append(f' {name}="{value.translate(ESCAPES) if isinstance(value, str) else format_number(value)}"')
        if not self.children:
            parts.append("/>")
            return
        parts.append(">")
        for child in self.children:
            if isinstance(child, str):
                parts.append(child.translate(ESCAPES))
            else:
                child._write(parts)
        parts.append(f"</{self.tag}>")


def make_element(tag: str, *children: Element | str, **attributes: str | float | None) -> Element:
    """Make an element with attributes by keyword: underscores stand for hyphens, None omits an attribute."""
    given = {name.rstrip("_").replace("_", "-"): value for name, value in attributes.items() if value is not None}
    return Element(tag, given, list(children))


def draw_text(
    x: float, y: float, words: str, size: float, *, subscript: str = "", **attributes: str | float | None
) -> Element:
    """Draw a line of text with its base line at ``y``, optionally followed by a subscript."""
    drawn = make_element("text", x=x, y=y, font_size=size, **attributes).add(words)
    if subscript:
        drawn.add(make_element("tspan", subscript, dy=SUBSCRIPT_DROP * size, font_size=SUBSCRIPT * size))
    return drawn


def draw_line(start: complex, end: complex, **attributes: str | float | None) -> Element:
    """Draw a straight line between two points of the sheet."""
    return make_element("line", x1=start.real, y1=start.imag, x2=end.real, y2=end.imag, **attributes)


def draw_circle(centre: complex, radius: float, **attributes: str | float | None) -> Element:
    """Draw a circle on the sheet."""
    return make_element("circle", cx=centre.real, cy=centre.imag, r=radius, **attributes)


def draw_polygon(corners: list[complex], **attributes: str | float | None) -> Element:
    """Draw a closed polygon on the sheet."""
    listed = " ".join(f"{format_number(c.real)},{format_number(c.imag)}" for c in corners)
    return make_element("polygon", points=listed, **attributes)


def draw_path(pieces: list[Complex], **attributes: str | float | None) -> Element | None:
    """Draw several open polylines as one path on the sheet; return None if there is nothing to draw."""
    drawn = []
    for piece in pieces:
        if not np.isfinite(piece).all():
            raise ValueError("expected finite coordinates in a path")
        if piece.size > 1:
            listed = zip(piece.real.tolist(), piece.imag.tolist(), strict=True)
            drawn.append("M" + "L".join([f"{x:.{DECIMALS}f} {y:.{DECIMALS}f}" for x, y in listed]))
    return make_element("path", d="".join(drawn), fill="none", **attributes) if drawn else None


@dataclass(frozen=True)
class Box:
    """A rectangle with sides along the axes; in the mechanism or on the sheet."""

    left: float
    low: float
    right: float
    high: float

    @classmethod
    def enclose(cls, points: Complex) -> Box:
        """Return the smallest box around the points that are not NaN."""
        x, y = points.real, points.imag
        return cls(float(np.nanmin(x)), float(np.nanmin(y)), float(np.nanmax(x)), float(np.nanmax(y)))

    @property
    def width(self) -> float:
        """Extent in x."""
        return self.right - self.left

    @property
    def height(self) -> float:
        """Extent in y."""
        return self.high - self.low

    @property
    def diagonal(self) -> float:
        """Length of the diagonal."""
        return math.hypot(self.width, self.height)

    @property
    def centre(self) -> complex:
        """Middle of the box."""
        return complex(self.left + 0.5 * self.width, self.low + 0.5 * self.height)

    def grow(self, margin: float) -> Box:
        """Return the box enlarged by a margin on all sides."""
        return Box(self.left - margin, self.low - margin, self.right + margin, self.high + margin)

    def merge_with(self, other: Box) -> Box:
        """Return the smallest box around both."""
        return Box(
            min(self.left, other.left),
            min(self.low, other.low),
            max(self.right, other.right),
            max(self.high, other.high),
        )

    def intersect_with(self, other: Box) -> Box:
        """Return the intersection; call it only for boxes that overlap."""
        return Box(
            max(self.left, other.left),
            max(self.low, other.low),
            min(self.right, other.right),
            min(self.high, other.high),
        )

    def overlaps(self, other: Box) -> bool:
        """Return whether the boxes share area."""
        return self.left < other.right and other.left < self.right and self.low < other.high and other.low < self.high

    def holds(self, point: complex) -> bool:
        """Return whether a point lies in the box."""
        return self.left <= point.real <= self.right and self.low <= point.imag <= self.high


@dataclass(frozen=True)
class Viewport:
    """Map from the mechanism (y up) to a panel of the sheet (y down): ``scale`` pixels per length unit."""

    panel: Box
    centre: complex
    middle: complex
    scale: float

    @classmethod
    def fit(cls, shown: Box, panel: Box, margin: float, foot: float = 0.0) -> Viewport:
        """Return the viewport that shows a box of the mechanism, centred in a panel.

        ``margin`` pixels stay free around the box, and ``foot`` more below it.
        """
        # The scale is limited by the narrower direction.
        room = panel.width - 2.0 * margin, panel.height - 2.0 * margin - foot
        scale = min(
            room[0] / shown.width if shown.width > 0.0 else math.inf,
            room[1] / shown.height if shown.height > 0.0 else math.inf,
        )
        return cls(panel, shown.centre, panel.centre - 0.5j * foot, scale)

    def point(self, point: complex) -> complex:
        """Map a mechanism point to the sheet."""
        # Conjugation flips y from upwards to downwards.
        return self.middle + self.scale * (complex(point) - self.centre).conjugate()

    def points(self, points: Complex) -> Complex:
        """Map an array of mechanism points to the sheet."""
        return np.asarray(self.middle + self.scale * (points - self.centre).conj())

    def clip_to_panel(self, points: Complex) -> list[Complex]:
        """Map a mechanism polyline to sheet polylines within the panel; NaN interrupts the line."""
        return [_drop_close_points(piece) for piece in clip_polyline(self.points(points), self.panel.grow(CLIP_MARGIN))]


CLIP_MARGIN = 20.0
"""Distance outside a panel at which lines are clipped, pixels: it hides the ends and joins of wide strokes."""


MIN_STEP = 0.8
"""Approximate minimum distance between points of a polyline, pixels; closer points are dropped."""


def _drop_close_points(line: Complex) -> Complex:
    # Number the steps along the line; keep the first point of every step.
    cells = np.floor(np.concatenate(([0.0], np.cumsum(np.abs(np.diff(line))))) / MIN_STEP)
    kept = np.concatenate(([True], np.diff(cells) > 0.0))
    kept[-1] = True
    return line[kept]


def clip_segments(start: Complex, end: Complex, box: Box) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the shares of each segment at which it enters and leaves a box; it misses the box unless enter <= leave.

    Liang and Barsky 1984, doi:10.1145/357332.357333.
    """
    step = end - start
    enter, leave = np.zeros(step.shape), np.ones(step.shape)
    sides = ((start.real, step.real, box.left, box.right), (start.imag, step.imag, box.low, box.high))
    with np.errstate(divide="ignore", invalid="ignore"):
        # Parallel sides divide by zero: such segments lie wholly inside or outside that pair of sides.
        for at, along, low, high in sides:
            first, second = (low - at) / along, (high - at) / along
            still = along == 0.0
            inside = still & (low <= at) & (at <= high)
            enter = np.maximum(enter, np.where(still, np.where(inside, 0.0, 2.0), np.minimum(first, second)))
            leave = np.minimum(leave, np.where(still, 1.0, np.maximum(first, second)))
    return enter, leave


def clip_polyline(line: Complex, box: Box) -> list[Complex]:
    """Return the parts of a polyline inside a box; NaN interrupts the line."""
    if line.size == 0:
        return []
    x, y = line.real, line.imag
    # Fast path: most lines lie inside.
    if x.min() >= box.left and x.max() <= box.right and y.min() >= box.low and y.max() <= box.high:
        return [line]
    start, end = line[:-1], line[1:]
    enter, leave = clip_segments(start, end, box)
    kept = np.flatnonzero(enter <= leave)
    starts, ends = start + enter * (end - start), start + leave * (end - start)
    # A new part starts after a gap, or if the line re-enters the box within a segment.
    breaks = np.flatnonzero((np.diff(kept) != 1) | (enter[kept[1:]] > 0.0)) + 1
    return [np.concatenate((starts[run[:1]], ends[run])) for run in np.split(kept, breaks) if run.size]


def clip_polygon(corners: list[complex], box: Box) -> list[complex]:
    """Clip a convex polygon to a box, one side after the other; return an empty list if nothing remains."""
    for turn, limit in ((1, box.left), (-1, -box.right), (1j, box.low), (-1j, -box.high)):
        kept: list[complex] = []
        for here, there in zip(corners, corners[1:] + corners[:1], strict=True):
            inside = (here * complex(turn).conjugate()).real - limit
            beyond = (there * complex(turn).conjugate()).real - limit
            if inside >= 0.0:
                kept.append(here)
            # The edge crosses the side: add the intersection.
            if (inside >= 0.0) != (beyond >= 0.0):
                kept.append(here + (there - here) * (inside / (inside - beyond)))
        corners = kept
    return corners


def write_document(title: str, description: str, size: tuple[float, float], *parts: Element) -> str:
    """Return a complete white sheet of a given size as text, with its title and description."""
    width, height = size
    sheet = make_element(
        "svg",
        make_element("title", title),
        make_element("desc", description),
        make_element("rect", x=0.0, y=0.0, width=width, height=height, fill="#fff"),
        *parts,
        xmlns="http://www.w3.org/2000/svg",
        role="img",
        width=width,
        height=height,
        viewBox=f"0 0 {width:g} {height:.0f}",
        font_family="sans-serif",
    )
    return sheet.write() + "\n"
