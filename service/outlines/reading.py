"""From a drawing in any format to its closed outlines."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any

import numpy as np
import shapely

from service.outlines import dxf, svg
from service.outlines.answer import DrawingUnit, DrawnCircle, LeftOut, Outline, Outlines
from service.outlines.curves import Circle, Complex, Curve, Source, flattened, steps
from service.outlines.drawing import Drawing
from service.outlines.faults import ForeignFormat, NoOutline, Unsuitable
from service.outlines.joining import joined
from service.outlines.limits import (
    DEFAULT_TOLERANCE,
    FARTHEST,
    JOINED,
    LONGEST_NAME,
    MOST_CORNERS,
    MOST_OUTLINES,
    MOST_POINTS,
    MOST_TOLD,
)

MILLIMETRES: dict[DrawingUnit, float] = {"mm": 1.0, "cm": 10.0, "m": 1000.0, "in": 25.4}

FLAT = 1e-9
"""Area of a polygon, as a share of the square of its extent, that is none; as in statements."""

SAME = 1e-12
"""Points this share of the greatest coordinate apart are one, which rounding has made two."""

ROUND = 5e-4
"""A closed curve is a circle where it lies this near to one, as a share of the radius: four cubics do."""

_TEXT_DXF = re.compile(rb"\s*(?:0|999)[ \t]*\r?\n")
_COMPRESSED = (b"\x1f\x8b", b"PK\x03\x04")


def outlines_of(content: bytes, *, tolerance: float | None = None, length_unit: DrawingUnit | None = None) -> Outlines:
    """The closed outlines of a drawing.

    Parameters
    ----------
    content : bytes
        SVG, or the text form of DXF.
    tolerance : float, optional
        Greatest distance of a curve from its polygon, in the unit of the answer; a share of the drawing's extent if it
        is left out.
    length_unit : optional
        The unit of the answer, where the drawing states its own; otherwise, and by default, it is the drawing's.

    Raises
    ------
    DrawingError
        One of its kinds says why there are no outlines.
    """
    # Numbers that overflow are looked for where they come out.
    with np.errstate(all="ignore"):
        return _found(_read(content), tolerance, length_unit)


def _found(drawing: Drawing, tolerance: float | None, length_unit: DrawingUnit | None) -> Outlines:
    scale, unit = 1.0, None
    if length_unit is not None and drawing.millimetres is not None:
        scale, unit = drawing.millimetres / MILLIMETRES[length_unit], length_unit
    left_out = list(drawing.left_out)
    curves = []
    for one in drawing.curves:
        curve = one.scaled(scale)
        if curve.finite:
            curves.append(curve)
        else:
            left_out.append((one.source, f"its coordinates go beyond {FARTHEST:g}, or are no numbers"))
    if tolerance is None:
        tolerance = DEFAULT_TOLERANCE * (_extent(curves) or 1.0)
    found, open_ = _closed(curves, JOINED * tolerance)
    left_out += open_
    if len(found) > MOST_OUTLINES:
        raise Unsuitable(f"The drawing has {len(found)} closed outlines, more than {MOST_OUTLINES}.")
    if sum(_vertices(members, tolerance) for members in found) > MOST_POINTS:
        raise Unsuitable(
            f"The outlines have more than {MOST_POINTS} vertices together at a tolerance of {tolerance:.4g}; "
            "give a larger one."
        )
    outlines = []
    for members in found:
        try:
            outlines.append(_outline(members, tolerance))
        except ValueError as error:
            left_out.append((members[0].source, str(error)))
    if not outlines:
        raise _none(left_out)
    return Outlines(
        format=drawing.format,
        millimetres_per_unit=drawing.millimetres,
        length_unit=unit,
        scale=scale,
        tolerance=tolerance,
        outlines=outlines,
        left_out=[LeftOut(**_told(source), reason=_sentence(reason)) for source, reason in left_out[:MOST_TOLD]],
        left_out_count=len(left_out),
    )


def _read(content: bytes) -> Drawing:
    if content.startswith(b"AutoCAD Binary DXF"):
        raise ForeignFormat("The body is a binary DXF file; save it as text (ASCII) DXF.")
    if content.startswith(b"AC10"):
        raise ForeignFormat("The body is a DWG file; save it as text (ASCII) DXF.")
    if content.startswith(_COMPRESSED):
        raise ForeignFormat("The body is compressed; send the drawing itself.")
    bare = content.removeprefix(b"\xef\xbb\xbf")
    if content[:2] in (b"\xff\xfe", b"\xfe\xff") or bare.lstrip()[:1] == b"<":
        return svg.curves_of(content)
    if _TEXT_DXF.match(bare):
        return dxf.curves_of(bare)
    raise ForeignFormat("The body is neither SVG nor the text form of DXF.")


def _extent(curves: Sequence[Curve]) -> float:
    """The greater side of the box around all curves."""
    if not curves:
        return 0.0
    low, high = np.array([one.corners for one in curves]).T
    return float(max(high.real.max() - low.real.min(), high.imag.max() - low.imag.min()))


def _closed(curves: Sequence[Curve], reach: float) -> tuple[list[list[Curve]], list[tuple[Source, str]]]:
    """What is closed by itself or by joining, in the order of the drawing; and the sources of what stays open."""
    closed = [[one] for one in curves if one.closed]
    # What is shorter than that reach lies in the gap between two others.
    open_ = [one for one in curves if not one.closed and _extent([one]) > reach]
    chains, alone = joined(open_, reach)
    place = {id(one): k for k, one in enumerate(curves)}
    first = {id(one.source): place[id(one)] for one in reversed(curves)}
    found = sorted(closed + chains, key=lambda members: first[id(members[0].source)])
    return found, [(one.source, reason) for one, reason in alone]


def _vertices(members: Sequence[Curve], tolerance: float) -> int:
    return sum(int(steps(one.pieces, tolerance).sum()) for one in members if one.circle is None)


def _outline(members: Sequence[Curve], tolerance: float) -> Outline:
    """Raises ValueError with what keeps the curves from being an outline."""
    told: dict[str, Any] = {**_told(members[0].source), "joined": len(members)}
    circle = members[0].circle or _circle(np.concatenate([one.pieces for one in members]), tolerance)
    if circle is not None:
        if not circle.radius > 0.0:
            raise ValueError("it encloses no area")
        centre = (circle.centre.real, circle.centre.imag)
        return Outline(
            **told, circle=DrawnCircle(center=centre, radius=circle.radius), area=float(np.pi * circle.radius**2)
        )
    shape = _polygon(members, tolerance)
    if len(shape.exterior.coords) > MOST_CORNERS + 1:
        shape = _polygon(members, 0.5 * tolerance).simplify(0.5 * tolerance)
    corners = np.array(shapely.geometry.polygon.orient(shape).exterior.coords)[:-1]
    if len(corners) > MOST_CORNERS:
        raise ValueError(f"its polygon has {len(corners)} vertices, more than {MOST_CORNERS}; give a larger tolerance")
    return Outline(**told, polygon=[(float(x), float(y)) for x, y in corners], area=float(shape.area))


def _polygon(members: Sequence[Curve], tolerance: float) -> shapely.Polygon:
    points = np.concatenate([flattened(one.pieces, tolerance)[:-1] for one in members])
    points = points[np.abs(points - np.roll(points, 1)) > SAME * np.abs(points).max()]
    if len(points) < 3:
        raise ValueError("it encloses no area")
    shape = shapely.Polygon(np.stack([points.real, points.imag], axis=1))
    if shape.convex_hull.area <= FLAT * _extent(members) ** 2:
        raise ValueError("it encloses no area")
    if not shape.is_valid:
        raise ValueError(f"it meets itself ({shapely.is_valid_reason(shape)})")
    return shape


def _circle(pieces: Complex, tolerance: float) -> Circle | None:
    """The circle that a closed curve is, if it is one: of two bulges, of arcs, of four cubics."""
    chord = pieces[:, 3] - pieces[:, 0]
    bent = np.abs(pieces[:, 1] - pieces[:, 0] - chord / 3.0)
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
    away = np.abs(np.abs(z - complex(x, y)) - radius).max()
    if not away <= min(ROUND * radius, tolerance) or abs(abs(_turns(z - complex(x, y))) - 1.0) > 1e-6:
        return None
    return Circle(complex(origin + complex(x, y)), radius)


def _turns(points: Complex) -> float:
    """How often a ring of points goes around the origin."""
    return float(np.angle(np.roll(points, -1) / points).sum() / (2.0 * np.pi))


def _none(left_out: Sequence[tuple[Source, str]]) -> NoOutline:
    reasons = [(_short(source.id or source.element) or "", _sentence(reason)) for source, reason in left_out]
    if not reasons:
        return NoOutline("The drawing has no closed outline: it draws nothing.", [])
    count = "One element is" if len(reasons) == 1 else f"{len(reasons)} elements are"
    return NoOutline(f"The drawing has no closed outline; {count} not one, `errors` says why.", reasons)


def _told(source: Source) -> dict[str, str | None]:
    return {name: _short(getattr(source, name)) for name in ("element", "id", "name", "layer")}


def _short(text: str | None) -> str | None:
    """A text of the drawing, which may have anything in it, as one that can be told."""
    if text is None:
        return None
    told = text.encode("utf-8", "replace").decode()
    return told if len(told) <= LONGEST_NAME else f"{told[: LONGEST_NAME - 1]}…"


def _sentence(reason: str) -> str:
    return f"{reason[:1].upper()}{reason[1:]}."
