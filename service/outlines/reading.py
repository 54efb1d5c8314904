"""Extraction of the closed outlines from a drawing of any supported format."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import shapely

from kinematics.arrays import Complex
from kinematics.message import Message, compose
from service.outlines.answer import (
    DrawingUnit,
    DrawnCircle,
    Outline,
    Outlines,
    describe_source,
    list_left_out,
    list_reasons,
)
from service.outlines.curves import Circle, Curve, Source, count_chords, flatten_pieces
from service.outlines.drawing import Drawing
from service.outlines.faults import ForeignFormat, NoOutline, Obstacle, UnsuitableDrawing, get_reason
from service.outlines.formats import convert_units, measure_extent, read_drawing
from service.outlines.joining import join_curves
from service.outlines.limits import (
    DEFAULT_TOLERANCE,
    JOIN_GAP_SHARE,
    MAX_CORNERS,
    MAX_OUTLINES,
    MAX_POINTS,
)
from synthesis.model.json_object import JsonObject

AREA_TOLERANCE = 1e-9
"""Minimum area of a polygon as a share of the square of its extent. A smaller area counts as zero, as in problem
statements.
"""

DUPLICATE_TOLERANCE = 1e-12
"""Relative distance up to which consecutive points are merged, because they differ only by rounding."""

ROUNDNESS_TOLERANCE = 5e-4
"""Maximum deviation of a closed curve from a circle, as a share of the radius, for which it is read as a circle. The
usual approximation by four cubics satisfies it.
"""


def read_outlines(
    content: bytes, *, tolerance: float | None = None, length_unit: DrawingUnit | None = None
) -> Outlines:
    """Read the closed outlines of a drawing.

    Parameters
    ----------
    content : bytes
        SVG, or the text form of DXF.
    tolerance : float, optional
        Maximum distance of a curve from its polygon, in the unit of the answer; by default a share of the drawing's
        extent.
    length_unit : optional
        Unit of the answer, if the drawing gives its own; otherwise, and by default, the drawing's unit.

    Raises
    ------
    DrawingError
        If the drawing has no outlines; the subclass gives the reason.
    """
    # Overflow is detected in the results (`Curve.finite`), so warnings would be noise.
    with np.errstate(all="ignore"):
        drawing = read_drawing(content)
        if drawing is None:
            raise ForeignFormat(compose("outlines-foreign-format"))
        return _collect_outlines(drawing, tolerance, length_unit)


def _collect_outlines(drawing: Drawing, tolerance: float | None, length_unit: DrawingUnit | None) -> Outlines:
    curves, left_out, scale, unit = convert_units(drawing, length_unit)
    if tolerance is None:
        tolerance = DEFAULT_TOLERANCE * (measure_extent(curves) or 1.0)
    found, open_ = _find_closed(curves, JOIN_GAP_SHARE * tolerance)
    left_out += open_
    if len(found) > MAX_OUTLINES:
        raise UnsuitableDrawing(compose("outlines-too-many-outlines", count=len(found), limit=MAX_OUTLINES))
    if sum(_count_vertices(members, tolerance) for members in found) > MAX_POINTS:
        raise UnsuitableDrawing(compose("outlines-too-many-vertices", limit=MAX_POINTS, tolerance=f"{tolerance:.4g}"))
    outlines = []
    for members in found:
        try:
            outlines.append(_make_outline(members, tolerance))
        except ValueError as error:
            left_out.append((members[0].source, get_reason(error)))
    if not outlines:
        raise _describe_failure(left_out)
    return Outlines(
        format=drawing.format,
        millimetres_per_unit=drawing.millimetres,
        length_unit=unit,
        scale=scale,
        tolerance=tolerance,
        outlines=outlines,
        left_out=list_left_out(left_out),
        left_out_count=len(left_out),
    )


def _find_closed(curves: Sequence[Curve], reach: float) -> tuple[list[list[Curve]], list[tuple[Source, Message]]]:
    """Return curves closed alone or by joining, in drawing order, and the sources of those that stay open."""
    closed = [[one] for one in curves if one.closed]
    # Elements shorter than the reach are left out, because they lie in gaps that joining closes.
    open_ = [one for one in curves if not one.closed and measure_extent([one]) > reach]
    chains, alone = join_curves(open_, reach)
    # Joined outlines take the place of their first element.
    place = {id(one): k for k, one in enumerate(curves)}
    first = {id(one.source): place[id(one)] for one in reversed(curves)}
    found = sorted(closed + chains, key=lambda members: first[id(members[0].source)])
    return found, [(one.source, reason) for one, reason in alone]


def _count_vertices(members: Sequence[Curve], tolerance: float) -> int:
    return sum(int(count_chords(one.pieces, tolerance).sum()) for one in members if one.circle is None)


def _make_outline(members: Sequence[Curve], tolerance: float) -> Outline:
    """Build the outline of closed curves; raise ValueError with the obstacle if they form none."""
    named: JsonObject = {**describe_source(members[0].source), "joined": len(members)}
    circle = members[0].circle or _fit_circle(np.concatenate([one.pieces for one in members]), tolerance)
    if circle is not None:
        if not circle.radius > 0.0:
            raise Obstacle("outlines-no-area")
        centre = (circle.centre.real, circle.centre.imag)
        return Outline(
            **named, circle=DrawnCircle(center=centre, radius=circle.radius), area=float(np.pi * circle.radius**2)
        )
    shape = _make_polygon(members, tolerance)
    # Too many corners: spend half the tolerance on flattening and half on simplification.
    if len(shape.exterior.coords) > MAX_CORNERS + 1:
        shape = _make_polygon(members, 0.5 * tolerance).simplify(0.5 * tolerance)
    corners = np.array(shapely.geometry.polygon.orient(shape).exterior.coords)[:-1]
    if len(corners) > MAX_CORNERS:
        raise Obstacle("outlines-too-many-corners", count=len(corners), limit=MAX_CORNERS)
    return Outline(**named, polygon=[(float(x), float(y)) for x, y in corners], area=float(shape.area))


def _make_polygon(members: Sequence[Curve], tolerance: float) -> shapely.Polygon:
    points = np.concatenate([flatten_pieces(one.pieces, tolerance)[:-1] for one in members])
    points = points[np.abs(points - np.roll(points, 1)) > DUPLICATE_TOLERANCE * np.abs(points).max()]
    if len(points) < 3:
        raise Obstacle("outlines-no-area")
    shape = shapely.Polygon(np.stack([points.real, points.imag], axis=1))
    if shape.convex_hull.area <= AREA_TOLERANCE * measure_extent(members) ** 2:
        raise Obstacle("outlines-no-area")
    if not shape.is_valid:
        raise Obstacle("outlines-meets-itself", place=shapely.is_valid_reason(shape))
    return shape


def _fit_circle(pieces: Complex, tolerance: float) -> Circle | None:
    """Return the circle that a closed curve traces (two bulges, arcs or four cubics), or None."""
    chord = pieces[:, 3] - pieces[:, 0]
    bent = np.abs(pieces[:, 1] - pieces[:, 0] - chord / 3.0)
    # A circle has at least two pieces, and no straight one.
    if len(pieces) < 2 or np.any(bent <= 1e-6 * np.abs(chord)):
        return None
    t = np.linspace(0.0, 1.0, 8, endpoint=False)
    weights = np.stack([(1.0 - t) ** 3, 3.0 * (1.0 - t) ** 2 * t, 3.0 * (1.0 - t) * t**2, t**3])
    points = (pieces @ weights).ravel()
    # |z|² = 2 Re(c̄ z) + (r² - |c|²), linear in the centre c.
    origin = points.mean()
    z = points - origin
    rows = np.stack([2.0 * z.real, 2.0 * z.imag, np.ones(len(z))], axis=1)
    (x, y, rest), *_ = np.linalg.lstsq(rows, np.abs(z) ** 2, rcond=None)
    radius = float(np.sqrt(max(rest + x**2 + y**2, 0.0)))
    # The fit must match in radius and go around exactly once.
    away = np.abs(np.abs(z - complex(x, y)) - radius).max()
    if (
        not away <= min(ROUNDNESS_TOLERANCE * radius, tolerance)
        or abs(abs(_count_turns(z - complex(x, y))) - 1.0) > 1e-6
    ):
        return None
    return Circle(complex(origin + complex(x, y)), radius)


def _count_turns(points: Complex) -> float:
    """Return the winding number of a ring of points about the origin."""
    return float(np.angle(np.roll(points, -1) / points).sum() / (2.0 * np.pi))


def _describe_failure(left_out: Sequence[tuple[Source, Message]]) -> NoOutline:
    if not left_out:
        return NoOutline(compose("outlines-nothing-drawn"), [])
    return NoOutline(compose("outlines-none-closed", count=len(left_out)), list_reasons(left_out))
