"""The curves of a DXF drawing in top view."""

from __future__ import annotations

import io
import logging
import re
from dataclasses import replace

import numpy as np
from ezdxf import path, recover, units
from ezdxf.audit import AuditError, Auditor
from ezdxf.entities.dxfentity import DXFEntity
from ezdxf.entities.dxfgfx import DXFGraphic
from ezdxf.entities.insert import Insert
from ezdxf.entities.spline import Spline
from ezdxf.enums import InsertUnits
from ezdxf.lldxf.const import DXFError
from ezdxf.path import Curve3To, Curve4To

from kinematics.arrays import Complex
from kinematics.message import Message, compose
from service.outlines.curves import NO_PIECES, Circle, Curve, Source, make_line, make_quadratic
from service.outlines.drawing import Drawing
from service.outlines.faults import MalformedDrawing, Obstacle, UnsuitableDrawing, get_reason
from service.outlines.limits import MAX_COORDINATE, MAX_DEPTH, MAX_ELEMENTS, MAX_PIECES
from service.outlines.path_data import SEGMENTS_PER_TURN
from service.outlines.references import grid_of, require_countable
from service.outlines.splines import convert_spline

PATH_TYPES = {"LINE", "ARC", "CIRCLE", "ELLIPSE", "LWPOLYLINE", "POLYLINE", "SOLID", "TRACE"}
"""Entity types that are read as curves."""

TEXT_TYPES = {"TEXT", "MTEXT", "ATTRIB", "ATTDEF"}

MAX_FIT_POINTS = 500
"""Maximum number of fit points of a spline: its control points are the solution of a linear system of that size."""

FLATNESS_TOLERANCE = 1e-6
"""Maximum difference of the heights of an entity, as a share of its extent, for which it counts as flat."""

# Faults of a file are reported to the client by this module, not in the server's log.
logging.getLogger("ezdxf").setLevel(logging.CRITICAL)

_GUESS_ERROR_CODES = {AuditError.INVALID_INTEGER_VALUE, AuditError.INVALID_FLOATING_POINT_VALUE}
_LINE_PATTERN = re.compile(r"near line (\d+)")


class DxfReader:
    """Walks through the entities of a drawing and collects its curves."""

    def __init__(self, layers: dict[str, bool]) -> None:
        self.hidden = {name for name, shown in layers.items() if not shown}
        self.found: list[Curve] = []
        self.left_out: list[tuple[Source, Message]] = []
        self.visited = self.pieces = 0

    def shows(self, entity: DXFEntity) -> bool:
        """Return whether an entity and its own layer are visible.

        An entity on layer 0 of a block takes the layer of the insert, which :meth:`visit` checks.
        """
        layer, invisible = _get_attribute(entity, "layer"), _get_attribute(entity, "invisible")
        return not invisible and str(layer).lower() not in self.hidden

    def visit(self, entity: DXFEntity, above: Source, depth: int) -> None:
        """Read an entity; ``above`` is the insert that contains it, or an empty source."""
        self.visited += 1
        if self.visited > MAX_ELEMENTS:
            raise UnsuitableDrawing(compose("outlines-too-many-entities", limit=MAX_ELEMENTS))
        type_ = entity.dxftype()
        layer, handle, invisible = (_get_attribute(entity, name) for name in ("layer", "handle", "invisible"))
        # Entities on layer 0 of a block take the layer of the insert (AutoCAD's rule).
        if layer in (None, "0") and above.layer:
            layer = above.layer
        if str(layer).lower() in self.hidden or invisible:
            return
        source = Source(type_, str(handle) if handle else above.id, above.name, str(layer or "0"))
        try:
            if isinstance(entity, Insert):
                self.insert(entity, replace(source, name=str(_get_attribute(entity, "name") or "")), depth)
            elif isinstance(entity, Spline):
                self.add(Curve(source, _read_spline(entity), bool(entity.closed)))
            elif type_ in PATH_TYPES:
                self.add(_read_curve(entity, source))
            else:
                raise Obstacle(
                    "outlines-element-is-dxf-text" if type_ in TEXT_TYPES else "outlines-entity-without-outline"
                )
        except UnsuitableDrawing:
            raise
        except ValueError as error:
            self.left_out.append((source, get_reason(error)))
        except (DXFError, TypeError, AttributeError, ArithmeticError, LookupError):
            # ezdxf raises any of these for an entity that lacks attributes of its type.
            self.left_out.append((source, Message("outlines-entity-incomplete", {})))

    def insert(self, entity: Insert, source: Source, depth: int) -> None:
        """Read the entities of a block at every place where it is inserted."""
        if depth >= MAX_DEPTH:
            raise UnsuitableDrawing(compose("outlines-blocks-nested-too-deep", limit=MAX_DEPTH))
        rows, columns = grid_of(entity)
        if rows * columns > MAX_ELEMENTS:
            raise UnsuitableDrawing(
                compose("outlines-block-inserted-too-often", rows=rows, columns=columns, limit=MAX_ELEMENTS)
            )
        if entity.block() is None:
            raise Obstacle("outlines-block-missing")
        for one in entity.multi_insert() if rows * columns > 1 else (entity,):
            for inner in one.virtual_entities():
                self.visit(inner, source, depth + 1)

    def add(self, curve: Curve) -> None:
        """Append a curve; refuse the drawing if it has too many pieces."""
        self.pieces += max(len(curve.pieces), 1)
        if self.pieces > MAX_PIECES:
            raise UnsuitableDrawing(compose("outlines-too-many-pieces", limit=MAX_PIECES))
        self.found.append(curve)


def read_curves(content: bytes) -> Drawing:
    """Read the curves of the model space.

    Raises
    ------
    MalformedDrawing
        If the content is not DXF.
    UnsuitableDrawing
        If the drawing exceeds the limits.
    """
    if b"\0" in content:
        raise MalformedDrawing(compose("outlines-dxf-with-nul"))
    if not content.rstrip().endswith(b"EOF"):
        raise MalformedDrawing(compose("outlines-dxf-without-eof"))
    # The recovery reader also accepts files of programs that do not follow the format strictly. Unreadable numbers,
    # which it replaces by guesses, are refused below.
    try:
        document, auditor = recover.read(io.BytesIO(content))
        entities = list(document.modelspace())
        layers = {layer.dxf.name.lower(): not (layer.is_off() or layer.is_frozen()) for layer in document.layers}
        unit = document.header.get("$INSUNITS", 0)
    except Exception as error:  # a broken file can cause any exception in the library
        raise MalformedDrawing(compose("outlines-dxf-unreadable", error=type(error).__name__)) from None
    _refuse_guesses(auditor)
    reader = DxfReader(layers)
    require_countable(entities, reader.shows)
    for entity in entities:
        reader.visit(entity, Source(""), 0)
    return Drawing("dxf", reader.found, reader.left_out, _get_millimetres_per_unit(unit))


def _get_attribute(entity: DXFEntity, name: str) -> object:
    """Return an attribute of an entity, or None if the entity lacks it or its type has no such attribute."""
    return entity.dxf.get(name) if entity.dxf.is_supported(name) else None


def _refuse_guesses(auditor: Auditor) -> None:
    """Refuse a file in which ezdxf replaced unreadable numbers, such as `i.5`, by guesses."""
    for fault in auditor.errors:
        if fault.code in _GUESS_ERROR_CODES:
            line = _LINE_PATTERN.search(fault.message)
            if line is None:
                raise MalformedDrawing(compose("outlines-number-unreadable"))
            raise MalformedDrawing(compose("outlines-number-unreadable-near-line", line=line[1]))


def _get_millimetres_per_unit(unit: int) -> float | None:
    """Return the millimetres in a drawing unit according to the header's $INSUNITS; None if unitless."""
    try:
        return float(units.conversion_factor(InsertUnits(unit), InsertUnits.Millimeters))
    except (TypeError, ValueError, LookupError):
        return None


def _read_curve(entity: DXFEntity, source: Source) -> Curve:
    if (
        isinstance(entity, DXFGraphic)
        and entity.dxftype() == "CIRCLE"
        and abs(entity.dxf.extrusion.normalize().z) > 1.0 - 1e-9
    ):
        centre = entity.ocs().to_wcs(entity.dxf.center)
        # Circles seen from above or below stay exact circles.
        if not 0.0 < entity.dxf.radius <= MAX_COORDINATE:
            raise Obstacle("outlines-radius-unsuitable")
        return Curve(source, NO_PIECES, True, Circle(complex(centre.x, centre.y), float(entity.dxf.radius)))
    drawn = path.make_path(entity, segments=_count_requested_segments(entity))
    if not len(drawn):
        raise Obstacle("outlines-length-zero")
    if drawn.has_sub_paths:
        raise Obstacle("outlines-several-parts")
    at = complex(drawn.start.x, drawn.start.y)
    heights, pieces = [drawn.start.z], []
    for command in drawn.commands():
        end = complex(command.end.x, command.end.y)
        heights += [point.z for point in command]
        if isinstance(command, Curve4To):
            controls = [complex(point.x, point.y) for point in (command.ctrl1, command.ctrl2)]
            pieces.append(np.array([[at, *controls, end]]))
        elif isinstance(command, Curve3To):
            pieces.append(make_quadratic(at, complex(command.ctrl.x, command.ctrl.y), end))
        else:
            pieces.append(make_line(at, end))
        at = end
    return Curve(source, _check_flat(np.concatenate(pieces), heights), drawn.is_closed)


def _count_requested_segments(entity: DXFEntity) -> int:
    """Return the segment count to request from ezdxf, which uses a third of it for a bulge."""
    return 3 * SEGMENTS_PER_TURN if entity.dxftype() in ("LWPOLYLINE", "POLYLINE") else SEGMENTS_PER_TURN


def _read_spline(entity: Spline) -> Complex:
    # Control points, if present, make solving the linear system unnecessary.
    if entity.fit_point_count() > MAX_FIT_POINTS and not entity.control_point_count():
        raise Obstacle("outlines-too-many-fit-points", limit=MAX_FIT_POINTS)
    tool = entity.construction_tool()
    points = np.array([complex(point.x, point.y) for point in tool.control_points])
    if not np.all(np.abs(points) <= MAX_COORDINATE):
        raise Obstacle("outlines-coordinates-unsuitable")
    weights = tool.weights() or [1.0] * len(points)
    return _check_flat(
        convert_spline(tool.degree, tool.knots(), points, weights), [point.z for point in tool.control_points]
    )


def _check_flat(pieces: Complex, heights: list[float]) -> Complex:
    rise = max(heights) - min(heights)
    if not rise <= FLATNESS_TOLERANCE * float(np.abs(pieces - pieces[0, 0]).max()):
        raise Obstacle("outlines-not-parallel-to-xy")
    return pieces
