"""A picture of an assembly in isometric projection, assembled and exploded.

All bodies are upright prisms on one plane, so that no general hidden-line removal is needed. All prisms are cut at all
heights at which one of them starts or ends. Bodies of a lower slab never hide those of a higher one. Within a slab the
walls of holes are drawn first, then the outer walls from back to front, and finally the upper faces, which do not hide
one another. Circles and arcs become arcs of ellipses with horizontal axes, because their planes are horizontal.

Glossary:

view     the plane of the picture: x to the right, y upwards, millimetres;
toward   the horizontal direction to the viewer;
band     a piece of a wall that is drawn in one shade.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator, Sequence
from functools import lru_cache
from itertools import combinations, groupby, pairwise
from typing import NamedTuple

import numpy as np
import shapely

from kinematics.arrays import Complex
from service.parts.assembly.model import SHEET_SORTS, Assembly, Part, Placement
from service.parts.drawings.exploded_view import compute_lifts
from service.parts.geometry.regions import Disc, Loop, Outline, Region, find_arc, make_polygon
from service.parts.geometry.solids import Prism
from service.parts.geometry.splines import Curve
from service.render.page.sheet import BORDER, INNER_WIDTH, TOP, draw_caption, draw_panel, write_sheet
from service.render.page.svg import Box, Element, Viewport, draw_line, draw_text, estimate_text_width, make_element
from service.render.page.symbols import GREY, INK, draw_scale_bar

RIGHT_DIRECTION = cmath.exp(0.25j * math.pi)
"""The horizontal direction that points to the right in the view."""

VIEWER_DIRECTION = -1j * RIGHT_DIRECTION
SINE, COSINE = math.sqrt(1.0 / 3.0), math.sqrt(2.0 / 3.0)
"""Sine and cosine of the elevation at which all three axes are shortened equally."""

LIGHT_DIRECTION = cmath.exp(math.radians(-38.0) * 1j)
"""Direction of the light, seen from above, relative to the direction to the viewer."""

BAND_ANGLES = ((20.0, math.radians(15.0)), (7.0, math.radians(30.0)), (0.0, math.radians(45.0)))
"""Angle of the normal within one band, by minimum radius of the arc in pixels."""

MIN_CORNERS_TO_THIN, MIN_CORNER_SIZE = 60, 0.5
"""Minimum number of corners of an outline that is simplified, and maximum change by the simplification, pixels."""

MIN_SLAB_HEIGHT = 0.5
"""Minimum height of a slab, pixels, unless a piece is thinner."""

BASE_OPACITY = 0.3
"""Opacity of a second base, so that the parts below it remain visible."""

SHADE_COUNT = 16
"""Number of shades of a wall."""

MIN_CREASE_ANGLE = math.radians(50.0)
"""Minimum angle between normals at which an edge is drawn."""

MIN_FILL_RATIO = 0.8
"""Minimum radius of a part that fills a hole, as a share of the hole's."""

SECTION_COUNT = 8
"""Number of prisms that approximate a body of another kind."""

PICTURE_HEIGHT, ASSEMBLED_SHARE, MARGIN = 470.0, 0.46, 22.0
"""Height of the picture, share of its width for the assembled view, and margin; pixels."""

FONT_SIZE, LINE_HEIGHT = 10.5, 14.0
"""Font size of the names next to the plates, and their minimum line spacing, pixels."""

LINE_STYLE: dict[str, str | float] = {
    "stroke": INK,
    "stroke_width": 0.6,
    "stroke_linejoin": "round",
    "stroke_linecap": "round",
}


class Piece(NamedTuple):
    """The piece of a part within a slab: a placed region from one height to another; ``ends`` if it is the top.

    For bodies other than prisms only the first section ``begins`` and the last ``ends``, so that no lines appear
    between.
    """

    part: Part
    region: Region
    low: float
    high: float
    begins: bool
    ends: bool


class Stretch(NamedTuple):
    """A piece of an outline from ``start`` to ``end`` in one band: ``bulge`` of the arc, ``normal`` of its wall."""

    start: complex
    end: complex
    bulge: float
    normal: float

    @property
    def is_visible(self) -> bool:
        """Whether its wall faces the viewer."""
        return math.cos(self.normal) > 1e-9


def draw_isometric_sheet(assembly: Assembly, title: str, at: float) -> str:
    """Draw the picture as an SVG document.

    Parameters
    ----------
    assembly : Assembly
    title : str
        Title without characters that XML forbids.
    at : float
        Input at which it is shown, radians or millimetres along the slide.
    """
    width = ASSEMBLED_SHARE * INNER_WIDTH
    together = Box(BORDER, TOP, BORDER + width, TOP + PICTURE_HEIGHT)
    apart = Box(BORDER + width + 12.0, TOP, BORDER + INNER_WIDTH, TOP + PICTURE_HEIGHT)
    lifted = compute_lifts(assembly)
    parts = [
        *_draw_panel(assembly, at, dict.fromkeys(lifted, 0.0), together, "Assembled", named=False),
        *_draw_panel(assembly, at, lifted, apart, "Exploded", named=True),
    ]
    words = f"{len(assembly.parts)} parts, isometric; lengths in millimetres"
    if assembly.scale != 1.0:
        words += f"; {assembly.scale:g} times the design"
    described = f"An assembly of {len(assembly.parts)} parts from above at an angle, assembled and exploded."
    return write_sheet(title, words, described, parts, TOP + PICTURE_HEIGHT)


def _draw_panel(
    assembly: Assembly, at: float, lifted: dict[str, float], panel: Box, words: str, *, named: bool
) -> list[Element]:
    pieces = place_pieces(assembly, at, lifted)
    names = [part for part in assembly.parts if part.sort in SHEET_SORTS] if named else []
    room = max((estimate_text_width(part.described, FONT_SIZE) for part in names), default=0.0)
    box = Box.enclose(np.concatenate([_project_outline(piece) for piece in pieces]))
    shown = Viewport.fit(box, Box(panel.left, panel.low, panel.right - room, panel.high), MARGIN, 22.0)
    scene = _Scene(shown, see_through=not named)
    coarse = [piece._replace(region=_simplify_region(piece.region, MIN_CORNER_SIZE / shown.scale)) for piece in pieces]
    drawn = make_element(
        "g",
        *(one for slab in divide_slabs(coarse, MIN_SLAB_HEIGHT / shown.scale) for one in scene.draw_slab(slab)),
        **LINE_STYLE,
    )
    bar, _ = draw_scale_bar(Viewport(panel, 0j, 0j, shown.scale), "mm")
    labels = _draw_names(pieces, names, shown, panel.right - room - 12.0)
    return [draw_panel(panel, "isometric"), draw_caption(panel, words), drawn, *labels, bar]


# Content


def place_pieces(assembly: Assembly, at: float, lifted: dict[str, float]) -> list[Piece]:
    """Return all bodies of an assembly in place at an input, each part lifted by a height.

    A body other than a prism is approximated by a stack of its sections.
    """
    state = assembly.motion.compute_state(np.array([at]))
    found = []
    for part in assembly.parts:
        placed = assembly.motion.compute_placement(part.carrier, state)
        for body in part.bodies:
            heights = [body.low, body.high]
            if not isinstance(body, Prism):
                heights = np.linspace(body.low, body.high, SECTION_COUNT + 1).tolist()
            for low, high in pairwise(heights):
                for region in body.cut_between(low, high):
                    moved = Region(
                        _move_outline(region.outer, placed), tuple(_move_outline(hole, placed) for hole in region.holes)
                    )
                    up = lifted[part.name]
                    found.append(Piece(part, moved, low + up, high + up, low == body.low, high == body.high))
    return found


def _simplify_region(region: Region, finest: float) -> Region:
    """Return a region without corners too close to be distinguished; teeth and contours have hundreds."""
    return Region(
        _simplify_outline(region.outer, finest), tuple(_simplify_outline(hole, finest) for hole in region.holes)
    )


def _simplify_outline(outline: Outline, finest: float) -> Outline:
    if not isinstance(outline, Loop) or len(outline.corners) < MIN_CORNERS_TO_THIN:
        return outline
    ring = make_polygon(outline, beyond=False)
    # Arcs become chords here, which is invisible at this size.
    kept = shapely.Polygon(np.column_stack([ring.real, ring.imag])).simplify(finest).exterior.coords[:-1]
    corners = tuple(complex(x, y) for x, y in kept)
    return Loop(corners, (0.0,) * len(corners))


def _move_outline(outline: Outline, placed: Placement) -> Outline:
    turn, shift = (complex(np.ravel(values)[0]) for values in (placed.turn, placed.shift))
    if isinstance(outline, Disc):
        return Disc(turn * outline.centre + shift, outline.radius)
    if isinstance(outline, Curve):
        places = turn * outline.through + shift
        return Loop(tuple(places.tolist()), (0.0,) * places.size)
    return outline._replace(corners=tuple(turn * corner + shift for corner in outline.corners))


def divide_slabs(pieces: Sequence[Piece], least: float) -> Iterator[list[Piece]]:
    """Yield the pieces cut at all heights at which one starts or ends, from below.

    Heights closer than ``least`` are merged, unless a piece is thinner than that.
    """
    size = max(piece.high for piece in pieces) - min(piece.low for piece in pieces)
    near = 1e-6 * size
    ends_of_thin = {height for piece in pieces if piece.high - piece.low <= least for height in (piece.low, piece.high)}
    heights: list[float] = []
    for height in sorted(z for piece in pieces for z in (piece.low, piece.high)):
        # Very thin pieces keep their own heights; others are merged.
        if not heights or height - heights[-1] > (near if height in ends_of_thin else least):
            heights.append(height)
    levels = np.array(heights)

    def snap_height(height: float) -> float:
        return heights[int(np.argmin(np.abs(levels - height)))]

    snapped = [piece._replace(low=snap_height(piece.low), high=snap_height(piece.high)) for piece in pieces]
    for low, high in pairwise(heights):
        yield [_cut(piece, low, high) for piece in snapped if piece.low <= low and piece.high >= high]


def _cut(piece: Piece, low: float, high: float) -> Piece:
    begins = piece.begins and piece.low == low
    ends = piece.ends and piece.high == high
    return piece._replace(low=low, high=high, begins=begins, ends=ends)


def project(place: complex, height: float) -> complex:
    """Project a point to the view."""
    across = place * RIGHT_DIRECTION.conjugate()
    return complex(across.real, SINE * across.imag + COSINE * height)


@lru_cache(maxsize=256)
def divide_outline(outline: Outline, *, hole: bool = False, scale: float = 0.0) -> tuple[Stretch, ...]:
    """Divide an outline into bands of one shade, counter-clockwise.

    The normals point out of the solid and are relative to :data:`VIEWER_DIRECTION`. The result is cached, because all
    slabs of a part have the same outline.
    """
    found = []
    for start, end, bulge in _iterate_edges(outline):
        turned = 4.0 * math.atan(bulge)
        tangent = cmath.phase((end - start) / VIEWER_DIRECTION) - 0.5 * turned
        first = tangent + (0.5 if hole else -0.5) * math.pi
        if bulge == 0.0:
            found.append(Stretch(start, end, 0.0, first))
            continue
        centre, _ = find_arc(start, end, bulge)
        # Large arcs need finer shading than small ones.
        band = next(turn for least, turn in BAND_ANGLES if scale * abs(start - centre) >= least)
        low, high = sorted((first, first + turned))
        crossed = [k * band for k in range(math.ceil(low / band), math.floor(high / band) + 1)]
        # Divide the arc where its normal crosses a band's limit.
        shares = sorted({0.0, 1.0, *((angle - first) / turned for angle in crossed)})
        for one, other in pairwise(share for share in shares if 0.0 <= share <= 1.0):
            if other - one < 1e-9:
                continue
            a, b = (centre + (start - centre) * cmath.exp(1j * turned * share) for share in (one, other))
            part = math.tan(0.25 * turned * (other - one))
            found.append(Stretch(a, b, part, first + 0.5 * (one + other) * turned))
    return tuple(found)


def _iterate_edges(outline: Outline) -> Iterator[tuple[complex, complex, float]]:
    if isinstance(outline, Disc):
        one, other = outline.centre - outline.radius, outline.centre + outline.radius
        yield from ((one, other, 1.0), (other, one, 1.0))
    else:
        assert isinstance(outline, Loop)
        yield from outline.iterate_edges()


def _project_outline(piece: Piece) -> Complex:
    """Return the outer corners of a piece in the view, below and above."""
    rim = _find_rim(piece)
    return np.concatenate([rim.real + 1j * (SINE * rim.imag + COSINE * height) for height in (piece.low, piece.high)])


def sort_back_to_front(pieces: Sequence[Piece]) -> list[Piece]:
    """Sort the pieces of one slab in the drawing order of their outer walls.

    Two pieces that share a vertical of the view are compared in the middle of their common range. A piece inside
    another's hole has its nearest point farther away there, and comes first.
    """
    rims = [_find_rim(piece) for piece in pieces]
    spans = [(float(rim.real.min()), float(rim.real.max())) for rim in rims]
    before: dict[int, set[int]] = {k: set() for k in range(len(pieces))}
    for i, j in combinations(range(len(pieces)), 2):
        # Common range of verticals.
        low, high = max(spans[i][0], spans[j][0]), min(spans[i][1], spans[j][1])
        if high <= low:
            continue
        middle = 0.5 * (low + high)
        # The farther wall must be drawn first.
        if _measure_nearness(rims[i], middle) < _measure_nearness(rims[j], middle):
            before[j].add(i)
        else:
            before[i].add(j)
    left = sorted(before, key=lambda k: _measure_nearness(rims[k], 0.5 * sum(spans[k])))
    order: list[int] = []
    while left:
        # If pieces hide one another cyclically, draw the farthest.
        at = next((k for k in left if not before[k] & set(left)), left[0])
        left.remove(at)
        order.append(at)
    return [pieces[k] for k in order]


def _find_rim(piece: Piece) -> Complex:
    """Return the outer corners of a piece: distance to the right in the view + i · distance from the viewer."""
    return np.array([stretch.start for stretch in divide_outline(piece.region.outer)]) * RIGHT_DIRECTION.conjugate()


def _measure_nearness(rim: Complex, across: float) -> float:
    """Return how close to the viewer a rim comes on a vertical of the view."""
    a, b = rim, np.roll(rim, -1)
    met = (np.minimum(a.real, b.real) <= across) & (across <= np.maximum(a.real, b.real)) & (a.real != b.real)
    a, b = a[met], b[met]
    return float(np.max(-(a.imag + (across - a.real) / (b.real - a.real) * (b.imag - a.imag)), initial=-math.inf))


# Drawing


def _find_filled(slab: Sequence[Piece]) -> Iterator[tuple[Outline, Piece]]:
    """Yield round holes with the pieces that fill them, because neither has a visible wall."""
    for hole in (hole for piece in slab for hole in piece.region.holes if isinstance(hole, Disc)):
        for piece in slab:
            outer = piece.region.outer
            if not isinstance(outer, Disc) or abs(outer.centre - hole.centre) > (1.0 - MIN_FILL_RATIO) * hole.radius:
                continue
            if MIN_FILL_RATIO <= outer.radius / hole.radius < 1.0 + 1e-9:
                yield hole, piece


class _Scene:
    def __init__(self, shown: Viewport, *, see_through: bool) -> None:
        self._shown, self._see_through = shown, see_through

    def draw_slab(self, slab: Sequence[Piece]) -> list[Element]:
        """Draw the pieces of a slab."""
        filled = {hole for hole, _ in _find_filled(slab)}
        within = {piece for _, piece in _find_filled(slab)}
        found: list[Element] = []
        for piece in slab:
            for hole in piece.region.holes:
                if hole not in filled:
                    found += self._draw_walls(piece, hole, hole=True)
        for piece in sort_back_to_front([piece for piece in slab if piece not in within]):
            found += self._draw_walls(piece, piece.region.outer, hole=False)
        found += [self._draw_top(piece) for piece in slab if piece.ends]
        return found

    def _is_transparent(self, piece: Piece) -> bool:
        """Return whether a piece is the second base, drawn transparent to show the parts below."""
        return self._see_through and piece.part.sort == "base" and piece.part.planes[0] > 0

    def _format_point(self, place: complex, height: float) -> str:
        z = self._shown.point(project(place, height))
        return f"{z.real:.1f} {z.imag:.1f}"

    def _format_stretch(self, stretch: Stretch, height: float, *, back: bool = False) -> str:
        """Return the path command that draws a stretch from the current point."""
        end = stretch.start if back else stretch.end
        if stretch.bulge == 0.0:
            return f"L{self._format_point(end, height)}"
        centre, turned = find_arc(stretch.start, stretch.end, stretch.bulge)
        radius = self._shown.scale * abs(stretch.start - centre)
        # The sheet's y axis points down, which reverses the sense of arcs.
        sweep = int((turned < 0.0) != back)
        return f"A{radius:.1f} {SINE * radius:.1f} 0 0 {sweep} {self._format_point(end, height)}"

    def _draw_top(self, piece: Piece) -> Element:
        d = ""
        for outline in (piece.region.outer, *piece.region.holes):
            own = divide_outline(outline)
            d += (
                f"M{self._format_point(own[0].start, piece.high)}"
                + "".join(self._format_stretch(one, piece.high) for one in own)
                + "Z"
            )
        fill = shade_colour(piece.part.colour, 1.0)
        opacity = BASE_OPACITY if self._is_transparent(piece) else None
        return make_element(
            "path", d=d, fill=fill, fill_rule="evenodd", fill_opacity=opacity, data_part=piece.part.name
        )

    def _draw_walls(self, piece: Piece, outline: Outline, *, hole: bool) -> list[Element]:
        low, high = piece.low, piece.high
        own = divide_outline(outline, hole=hole, scale=self._shown.scale)
        found: list[Element] = []
        edges = ""
        for fill, run in _group_shades(own, piece.part.colour, 0.8 if hole else 1.0):
            there = "".join(self._format_stretch(stretch, high) for stretch in run)
            back = "".join(self._format_stretch(stretch, low, back=True) for stretch in reversed(run))
            d = f"M{self._format_point(run[0].start, high)}{there}L{self._format_point(run[-1].end, low)}{back}Z"
            # The stroke closes the seams between bands.
            if self._is_transparent(piece):
                found.append(make_element("path", d=d, fill=fill, fill_opacity=BASE_OPACITY, stroke="none"))
            else:
                found.append(make_element("path", d=d, fill=fill, stroke=fill))
            if piece.begins and not hole:
                edges += f"M{self._format_point(run[0].start, low)}" + "".join(
                    self._format_stretch(stretch, low) for stretch in run
                )
        for before, after in zip(own, own[1:] + own[:1], strict=True):
            bent = abs(cmath.phase(cmath.exp(1j * (after.normal - before.normal))))
            if before.is_visible != after.is_visible or (before.is_visible and bent > MIN_CREASE_ANGLE):
                edges += f"M{self._format_point(after.start, high)}L{self._format_point(after.start, low)}"
        if edges:
            found.append(make_element("path", d=edges, fill="none"))
        return found


def _group_shades(own: Sequence[Stretch], colour: str, lit: float) -> Iterator[tuple[str, list[Stretch]]]:
    """Yield the visible stretches, grouped by consecutive ones of one shade."""

    def choose_shade(stretch: Stretch) -> str:
        if not stretch.is_visible:
            return ""
        steps = round(SHADE_COUNT * max(0.0, (cmath.exp(1j * stretch.normal) * LIGHT_DIRECTION.conjugate()).real))
        return shade_colour(colour, lit * (0.52 + 0.3 * steps / SHADE_COUNT))

    for fill, run in groupby(own, key=choose_shade):
        if fill:
            yield fill, list(run)


def shade_colour(colour: str, lit: float) -> str:
    """Return a colour under light: 1 for an upper face, which is slightly paler than the part."""
    channels = [int(colour[k : k + 2], 16) for k in (1, 3, 5)]
    return "#" + "".join(f"{round(min(255.0, lit * (channel + 0.22 * (255 - channel)))):02x}" for channel in channels)


def _draw_names(pieces: Sequence[Piece], named: Sequence[Part], shown: Viewport, left: float) -> list[Element]:
    """Draw the names of plates at the right, each with a line to its plate."""
    anchors = []
    for part in named:
        ends = [
            shown.point(project(stretch.start, piece.high))
            for piece in pieces
            if piece.part is part
            for stretch in divide_outline(piece.region.outer)
        ]
        anchors.append((max(ends, key=lambda z: z.real), part))
    anchors.sort(key=lambda anchor: anchor[0].imag)
    found: list[Element] = []
    y = -math.inf
    for end, part in anchors:
        # Move a name down if it would touch the previous one.
        y = max(end.imag, y + LINE_HEIGHT)
        beside = complex(left, y)
        found.append(draw_line(end + 3.0, beside - 4.0, stroke=GREY, stroke_width=0.6))
        found.append(draw_text(left, y + 0.35 * FONT_SIZE, part.described, FONT_SIZE, fill=INK))
    return found
