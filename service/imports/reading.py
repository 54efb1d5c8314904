"""Reading of a file in any supported format to its curves as points."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from kinematics.arrays import Complex
from kinematics.message import Message, compose
from service.imports.answer import Format, ImportedCurve, ImportedPoint, Imports
from service.imports.curve_points import (
    PointRequest,
    Points,
    find_straight,
    measure_length,
    measure_polyline,
    select_piece_points,
    select_polyline_points,
)
from service.imports.limits import DEFAULT_POINTS, MAX_CURVES, MAX_DENSE_POINTS, MAX_POINTS, PNG_SIGNATURE
from service.imports.picture import COARSE_TOLERANCE, FINE_TOLERANCE, read_picture
from service.imports.table import read_table
from service.outlines.answer import DrawingUnit, describe_source, list_left_out, list_reasons
from service.outlines.curves import Curve, Source, make_line
from service.outlines.drawing import Drawing
from service.outlines.faults import ForeignFormat, NoOutline, UnsuitableDrawing, get_reason
from service.outlines.formats import MILLIMETRES_PER_UNIT, convert_units, measure_extent, read_drawing
from service.outlines.joining import find_chains
from service.outlines.limits import DEFAULT_TOLERANCE, JOIN_GAP_SHARE, MAX_COORDINATE
from service.outlines.path_data import make_unit_arc


@dataclass(frozen=True)
class FoundCurve:
    """A curve before the selection of its points; ``drawn`` has cubics, shape (n, 4), or points, shape (n,)."""

    source: Source
    drawn: Complex
    closed: bool
    joined: int = 1
    tolerance: float = 0.0

    def choose_points(self, request: PointRequest) -> Points:
        """Select the requested points."""
        if self.drawn.ndim == 2:
            return select_piece_points(self.drawn, self.closed, request)
        return select_polyline_points(self.drawn, self.closed, request, self.tolerance)

    def compute_length(self, points: Complex) -> float:
        """Return the length; for a curve of points that of the chords, since a contour wavers within a pixel."""
        return measure_length(self.drawn) if self.drawn.ndim == 2 else measure_polyline(points, self.closed)


LeftOut = list[tuple[Source, Message]]


def read_curves(
    content: bytes,
    *,
    length_unit: DrawingUnit = "mm",
    tolerance: float | None = None,
    max_points: int = DEFAULT_POINTS,
    pixel_size: float | None = None,
    tables: bool = True,
) -> Imports:
    """Read the curves of a file.

    Parameters
    ----------
    content : bytes
        SVG, DXF as text, PNG, or a table of points.
    length_unit : optional
        Unit of the answer if the file has a unit; otherwise the numbers stay as in the file.
    tolerance : float, optional
        Chord tolerance in the unit of the answer; by default a share of each curve's extent, with points given in the
        file kept.
    max_points : int
        Maximum number of points of a curve, which takes precedence over the tolerance.
    pixel_size : float, optional
        Side of a pixel in the unit of the answer, instead of the value in a picture.
    tables : bool
        Whether text of no other format may be a table.

    Raises
    ------
    DrawingError
        One of its subclasses, if there are no curves.
    """
    requested = PointRequest(tolerance, max_points)
    # Overflows are checked in the resulting coordinates.
    with np.errstate(all="ignore"):
        if content.startswith(PNG_SIGNATURE):
            return _read_picture(content, length_unit, pixel_size, requested)
        drawing = read_drawing(content)
        if drawing is not None:
            return _read_drawing(drawing, length_unit, requested)
        if not tables:
            raise ForeignFormat(compose("imports-format-or-table-type"))
        return _read_table(content, length_unit, requested)


def _read_drawing(drawing: Drawing, length_unit: DrawingUnit, request: PointRequest) -> Imports:
    curves, left_out, scale, unit = convert_units(drawing, length_unit)
    reach = JOIN_GAP_SHARE * (
        request.tolerance if request.tolerance is not None else DEFAULT_TOLERANCE * measure_extent(curves)
    )
    found, tiny = _connect_curves(curves, reach)
    return _build_answer(drawing.format, found, [*left_out, *tiny], drawing.millimetres, unit, scale, request)


def _connect_curves(curves: Sequence[Curve], reach: float) -> tuple[list[FoundCurve], LeftOut]:
    """Return closed curves and chains of joined open curves, in the order of the drawing, and curves too short."""
    place: dict[int, int] = {}
    for k, one in enumerate(curves):
        place.setdefault(id(one.source), k)
    open_: list[Curve] = []
    tiny: LeftOut = []
    for one in curves:
        if not one.closed and measure_extent([one]) > reach:
            open_.append(one)
        elif not one.closed:
            tiny.append((one.source, Message("imports-shorter-than-gap", {})))
    found = [([one], True) for one in curves if one.closed]
    found += [(chain.members, chain.closed) for chain in find_chains(open_, reach)]
    found.sort(key=lambda one: min(place[id(each.source)] for each in one[0]))
    return [
        FoundCurve(members[0].source, _join_pieces(members, closed), closed, len(members)) for members, closed in found
    ], tiny


def _read_picture(content: bytes, length_unit: DrawingUnit, pixel_size: float | None, request: PointRequest) -> Imports:
    picture = read_picture(content)
    pixel_millimetres = picture.millimetres
    if pixel_size is not None:
        across = up = pixel_size
        unit: DrawingUnit | None = length_unit
    elif pixel_millimetres is not None:
        across, up = (side / MILLIMETRES_PER_UNIT[length_unit] for side in pixel_millimetres)
        unit = length_unit
    else:
        across, up, unit = 1.0, 1.0, None
    found = [
        FoundCurve(
            Source("contour"),
            across * one.real + 1j * up * one.imag,
            closed=True,
            tolerance=(COARSE_TOLERANCE if steps else FINE_TOLERANCE) * max(across, up),
        )
        for one, steps in zip(picture.contours, picture.stepped, strict=True)
    ]
    left_out: LeftOut = [(Source("contour"), Message("imports-few-pixels", {}))] * picture.specks
    millimetres = None if unit is None else across * MILLIMETRES_PER_UNIT[unit]
    return _build_answer("png", found, left_out, millimetres, unit, across, request)


def _read_table(content: bytes, length_unit: DrawingUnit, request: PointRequest) -> Imports:
    table = read_table(content)
    scale = 1.0 if table.millimetres is None else table.millimetres / MILLIMETRES_PER_UNIT[length_unit]
    name = None if table.names is None else ", ".join(table.names)
    found = []
    for points in table.curves:
        closed = len(points) > 3 and bool(points[0] == points[-1])
        found.append(FoundCurve(Source("points", name=name), scale * (points[:-1] if closed else points), closed))
    unit = None if table.millimetres is None else length_unit
    return _build_answer("csv", found, [], table.millimetres, unit, scale, request)


def _build_answer(
    format_: Format,
    found: Sequence[FoundCurve],
    left_out: LeftOut,
    millimetres: float | None,
    unit: DrawingUnit | None,
    scale: float,
    request: PointRequest,
) -> Imports:
    curves = []
    found, shorter = _select_largest(found)
    left_out = [*left_out, *shorter]
    total = looked = 0
    for one in found:
        try:
            points, tolerance, looked_at = one.choose_points(request)
        except ValueError as error:
            if isinstance(error, UnsuitableDrawing):
                raise
            left_out.append((one.source, get_reason(error)))
            continue
        if not np.all(np.abs(points) <= MAX_COORDINATE):
            left_out.append((one.source, Message("imports-coordinates-out-of-range", {"limit": f"{MAX_COORDINATE:g}"})))
            continue
        total, looked = total + len(points), looked + looked_at
        if total > MAX_POINTS or looked > MAX_DENSE_POINTS:
            raise UnsuitableDrawing(compose("imports-too-many-points", limit=MAX_POINTS))
        named: dict[str, Any] = describe_source(one.source)
        curves.append(
            ImportedCurve(
                **named,
                points=[ImportedPoint.model_construct(x=z.real, y=z.imag) for z in points.tolist()],
                closed=one.closed,
                length=one.compute_length(points),
                tolerance=tolerance,
                joined=one.joined,
            )
        )
    if not curves:
        reasons = list_reasons(left_out)
        raise NoOutline(compose("imports-no-curve") if reasons else compose("imports-nothing-drawn"), reasons)
    return Imports(
        format=format_,
        millimetres_per_unit=millimetres,
        length_unit=unit,
        scale=scale,
        curves=curves,
        left_out=list_left_out(left_out),
        left_out_count=len(left_out),
    )


def _select_largest(found: Sequence[FoundCurve]) -> tuple[Sequence[FoundCurve], LeftOut]:
    """Return the largest curves up to the limit of an answer, in their order, and the smaller ones as left out."""
    if len(found) <= MAX_CURVES:
        return found, []
    size = np.array([max(np.ptp(one.drawn.real), np.ptp(one.drawn.imag)) for one in found])
    kept = set(np.argsort(-size, kind="stable")[:MAX_CURVES].tolist())
    reason = Message("imports-smaller-than-listed", {"count": MAX_CURVES})
    return (
        [one for k, one in enumerate(found) if k in kept],
        [(one.source, reason) for k, one in enumerate(found) if k not in kept],
    )


def _join_pieces(members: Sequence[Curve], closed: bool) -> Complex:
    """Join the cubics of consecutive curves, moving the start of each to the end of the previous one."""
    (first, *_) = members
    if first.circle is not None:
        return np.asarray(first.circle.centre + first.circle.radius * make_unit_arc(0.0, 2.0 * np.pi))
    parts = [one.pieces.copy() for one in members]
    if not first.closed:
        for before, after in zip(parts if closed else parts[:-1], [*parts[1:], parts[0]], strict=False):
            gap = before[-1, 3] - after[0, 0]
            if gap and find_straight(after[:1])[0]:
                after[:1] = make_line(before[-1, 3], after[0, 3])
            else:
                after[0, :2] += gap
    return np.concatenate(parts)
