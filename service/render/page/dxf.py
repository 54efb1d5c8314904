"""DXF documents (R2010): creation in the problem's unit, primitive entities, and text output."""

from __future__ import annotations

import io
from collections.abc import Iterable, Mapping

import ezdxf
import numpy as np
from ezdxf import units
from ezdxf.document import Drawing
from ezdxf.enums import TextEntityAlignment
from ezdxf.filemanagement import new
from ezdxf.layouts.layout import Modelspace
from numpy.typing import NDArray

# Omit timestamps and random identifiers, so that the same design gives the same file.
ezdxf.options.write_fixed_meta_data_for_testing = True  # type: ignore[attr-defined]  # ezdxf documents it, and does not export it

DXF_UNITS = {"mm": units.MM, "cm": units.CM, "m": units.M, "in": units.IN}


def create_drawing(
    title: str, unit: str, layers: Mapping[str, tuple[int, str]], *, frozen: str = "", dimensions: bool = False
) -> Drawing:
    """Create an empty drawing.

    Parameters
    ----------
    title : str
        Free text.
    unit : str
        Length unit.
    layers : mapping of str to (int, str)
        Colour index and line type of each layer.
    frozen : str
        A layer that is hidden initially.
    dimensions : bool
        Whether the drawing will contain dimensions, which need a style.
    """
    document = new("R2010", setup=["linetypes", "dimstyles"] if dimensions else ["linetypes"])
    document.units = DXF_UNITS[unit]
    document.header.custom_vars.append("Title", title)
    for name, (colour, linetype) in layers.items():
        document.layers.add(name, color=colour, linetype=linetype)
    if frozen:
        document.layers.get(frozen).freeze()
    return document


def write_document(document: Drawing) -> str:
    """Return the drawing as text, identical in every process."""
    # ezdxf lists classes in the order of a set, which varies between processes; classes listed before keep their order.
    for name in sorted(document.entitydb.dxf_types_in_use()):
        document.classes.add_class(name)
    text = io.StringIO()
    document.write(text)
    return text.getvalue()


def add_circle(space: Modelspace, at: complex, radius: float, layer: str) -> None:
    """Add a circle."""
    space.add_circle((at.real, at.imag), radius, dxfattribs={"layer": layer})


def add_arc(space: Modelspace, at: complex, radius: float, start: complex, end: complex, layer: str) -> None:
    """Add an arc about a point, counter-clockwise from the direction of one point to that of another."""
    first, last = (float(np.degrees(np.angle(z - at))) for z in (start, end))
    space.add_arc((at.real, at.imag), radius, first, last, dxfattribs={"layer": layer})


def add_outline(space: Modelspace, corners: Iterable[complex], layer: str) -> None:
    """Add a closed polygon."""
    space.add_lwpolyline([(z.real, z.imag) for z in corners], close=True, dxfattribs={"layer": layer})


def add_cross(space: Modelspace, at: complex, arm: float, layer: str) -> None:
    """Add a cross at a shaft."""
    for end in (complex(arm), 1j * arm):
        add_line(space, at - end, at + end, layer)


def add_line(space: Modelspace, start: complex, end: complex, layer: str) -> None:
    """Add a straight line."""
    space.add_line((start.real, start.imag), (end.real, end.imag), dxfattribs={"layer": layer})


def add_words(space: Modelspace, at: complex, words: str, height: float, layer: str = "TEXT") -> None:
    """Add a line of text centred on a point."""
    entity = space.add_text(words, height=height, dxfattribs={"layer": layer})
    entity.set_placement((at.real, at.imag), align=TextEntityAlignment.MIDDLE_CENTER)


def add_spline(space: Modelspace, points: NDArray[np.complex128], tangents: NDArray[np.complex128], layer: str) -> None:
    """Add cubic pieces between points with given unit tangents, as one spline with double knots."""
    # Chord length approximates the parameter of each cubic piece.
    chords = np.abs(np.diff(points))
    ahead = points[:-1] + tangents[:-1] * chords / 3.0
    behind = points[1:] - tangents[1:] * chords / 3.0
    control = np.concatenate([points[:1], np.stack([ahead, behind], axis=1).reshape(-1), points[-1:]])
    along = np.concatenate([[0.0], np.cumsum(chords)])
    # Double inner knots: the tangent is continuous, the curvature need not be.
    knots = np.concatenate([[0.0] * 4, np.repeat(along[1:-1], 2), [along[-1]] * 4])
    spline = space.add_spline(degree=3, dxfattribs={"layer": layer})
    spline.control_points = [(z.real, z.imag, 0.0) for z in control]
    spline.knots = knots.tolist()
    spline.closed = bool(points[0] == points[-1])
