"""The schema of an assembly for three-dimensional viewers: shapes, and their positions at inputs.

All lengths are in millimetres; heights point upwards along the shafts, with 0 at the upper face of the base. Outlines
are exact: arcs remain arcs, and viewers divide them as finely as needed.
"""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

from service.parts.assembly.sizes import PartFile

Point = tuple[float, float]
Place = tuple[float, float, float]


class CircleEdge(BaseModel):
    """A circle."""

    model_config = ConfigDict(title="Circle of a part")

    form: Literal["circle"] = "circle"
    centre: Point
    radius: float


class CornersEdge(BaseModel):
    """A closed outline of straight lines and arcs."""

    model_config = ConfigDict(title="Outline of a part")

    form: Literal["corners"] = "corners"
    corners: list[Point] = Field(description="Corners, counter-clockwise.")
    bulges: list[float] = Field(
        description="Bulge of the edge from each corner to the next: 0 for a line; for an arc the tangent of a "
        "quarter of "
        "its angle, positive for a left turn, as in DXF."
    )
    smooth: bool = Field(description="Whether the corners are points of a smooth curve instead of corners of the part.")


Edge = Annotated[CircleEdge | CornersEdge, Field(discriminator="form")]


class UprightShape(BaseModel):
    """An outline with its holes, from one height to another."""

    low: float
    high: float
    outer: Edge
    holes: list[Edge]


class PrismShape(UprightShape):
    """An outline with its holes, from one height to another."""

    model_config = ConfigDict(title="Prism of a part")

    form: Literal["prism"] = "prism"


class TwistedShape(UprightShape):
    """A prism that rotates evenly with height, as helical teeth do."""

    model_config = ConfigDict(title="Twisted prism of a part")

    form: Literal["twisted"] = "twisted"
    twist: float = Field(description="Rotation of the outline at `high` relative to that at `low`, degrees.")
    centre: Point = Field(description="Centre of the rotation.")


class MeshShape(BaseModel):
    """A body given by its surface."""

    model_config = ConfigDict(title="Mesh of a part")

    form: Literal["mesh"] = "mesh"
    corners: list[Place]
    triangles: list[tuple[int, int, int]] = Field(
        description="Indices of corners, from 0, counter-clockwise as seen from outside."
    )


Shape = Annotated[PrismShape | TwistedShape | MeshShape, Field(discriminator="form")]


class PartView(BaseModel):
    """A part in the reference configuration."""

    model_config = ConfigDict(title="Part of an assembly")

    name: str = Field(description="Name, unique in the assembly.")
    described: str = Field(description="Description in words.")
    sort: str = Field(
        description="Kind of part: `base`, `link`, `block`, `pin`, `ring`, `washer`, `spacer` or another."
    )
    material: str
    colour: str = Field(description="Colour as `#rrggbb`.")
    standard: str = Field(description="Designation of a bought part; empty if it is made.")
    planes: tuple[int, int] = Field(
        description="The lowest and the highest plane that it occupies; the base is in plane 0."
    )
    lift: float = Field(description="Lift in the exploded view, along the normal of a `frame` if there is one.")
    carrier: int = Field(description="Index of its carrier in `carriers`, from 0.")
    shapes: list[Shape] = Field(description="Shapes whose union is the part.")
    item: str = Field(description="Item name in files and in the bill of materials; identical parts share it.")
    files: list[PartFile] = Field(description="Available files, at `/v1/jobs/{id}/designs/{n}/parts/{item}.{file}`.")


class CarrierPlane(BaseModel):
    """The plane in which a carrier moves whose axis is not parallel to the others.

    A point with coordinates x, y and height z in it is at origin + x along + y (normal × along) + z normal. Each list
    has one entry, or one per input if the plane itself moves.
    """

    model_config = ConfigDict(title="Plane of a carrier")

    origins: list[Place]
    along: list[Place] = Field(description="Unit vectors.")
    normals: list[Place] = Field(description="Unit vectors, normal to those.")


class CarrierView(BaseModel):
    """A body that parts move with, and its position at each input.

    A point q of the reference configuration moves to `places[k]` + R(`angles[k]`) (q − `pivot`) at input k, where R is
    a counter-clockwise rotation in the plane; heights are constant.
    """

    model_config = ConfigDict(title="Carrier of parts")

    link: str
    joint: str | None = Field(
        description="Joint of the link with which it translates; null if it moves with the whole link."
    )
    pivot: Point
    angles: list[float] = Field(description="Rotation from the reference configuration, degrees, without jumps.")
    places: list[Point] = Field(description="Places of the pivot.")
    frame: CarrierPlane | None = Field(description="Plane of these quantities; null for that of the assembly.")


class InputView(BaseModel):
    """The inputs at which positions are given."""

    model_config = ConfigDict(title="Inputs of an assembly")

    quantity: Literal["angle", "place"] = Field(description="Whether the input is an angle, or the place of a slide.")
    reference: float = Field(description="The input of the reference configuration.")
    low: float = Field(description="Start of the range for which the parts were made.")
    high: float = Field(description="End of that range.")
    closed: bool = Field(description="Whether the range is one full cycle, after which all parts are back in place.")
    endless: bool = Field(
        description="Whether the motion continues beyond the range: every carrier turns and revolves at a constant "
        "rate."
    )
    values: list[float] = Field(
        description="Degrees, or the place of a driving slide in the unit of the design at its original size."
    )


class AssemblyView(BaseModel):
    """The parts of a design, and how they move; all lengths of parts are in millimetres."""

    model_config = ConfigDict(title="Assembly")

    length_unit: Literal["mm"] = "mm"
    unit: float = Field(description="Millimetres per length unit of the design, at the built size.")
    scale: float = Field(description="Ratio of the built size to that of the design.")
    planes: int = Field(
        description="Number of planes with moving links. The base is plane 0; a second base lies above them, or "
        "between "
        "them if a link is divided into two plates on either side of it."
    )
    bases: int = Field(description="1, or 2 if the shafts are held by two bases.")
    low: float = Field(description="Height of the lowest face of the parts in the assembly's plane.")
    high: float = Field(description="Height of their highest face.")
    notes: list[str] = Field(description="Notes for assembly.")
    input: InputView
    carriers: list[CarrierView]
    parts: list[PartView]
