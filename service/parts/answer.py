"""What an assembly is told as to those who show it in three dimensions: shapes, and where they are at inputs.

All lengths are in millimetres, and heights go upwards along the shafts, with 0 on the upper face of the base. Outlines
are as exact as the parts: arcs are told as arcs, and whoever draws them divides them as finely as needed.
"""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

from service.parts.sizes import PartFile

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
    corners: list[Point] = Field(description="Counter-clockwise.")
    bulges: list[float] = Field(
        description="Of the edge from each corner to the next: 0 of a line; of an arc the tangent of a quarter of its "
        "angle, positive where it turns to the left, as in DXF."
    )
    smooth: bool = Field(description="Whether the corners are points of a smooth curve, and no corners of the part.")


Edge = Annotated[CircleEdge | CornersEdge, Field(discriminator="form")]


class Upright(BaseModel):
    """An outline with its holes, from one height to another."""

    low: float
    high: float
    outer: Edge
    holes: list[Edge]


class PrismShape(Upright):
    """An outline with its holes, from one height to another."""

    model_config = ConfigDict(title="Prism of a part")

    form: Literal["prism"] = "prism"


class TwistedShape(Upright):
    """The same, turning evenly as it goes up, as helical teeth do."""

    model_config = ConfigDict(title="Twisted prism of a part")

    form: Literal["twisted"] = "twisted"
    twist: float = Field(description="How far the outline at `high` is turned against that at `low`, degrees.")
    centre: Point = Field(description="About which it turns.")


class TurnedShape(BaseModel):
    """A body of revolution about an upright axis."""

    model_config = ConfigDict(title="Turned body of a part")

    form: Literal["turned"] = "turned"
    centre: Point
    profile: list[Point] = Field(description="Half section: radius and height of its corners, counter-clockwise.")


class MeshShape(BaseModel):
    """A body by its surface."""

    model_config = ConfigDict(title="Mesh of a part")

    form: Literal["mesh"] = "mesh"
    corners: list[Place]
    triangles: list[tuple[int, int, int]] = Field(
        description="Numbers of corners, counted from 0, counter-clockwise as seen from outside."
    )


Shape = Annotated[PrismShape | TurnedShape | TwistedShape | MeshShape, Field(discriminator="form")]


class ViewedPart(BaseModel):
    """A part in the reference configuration."""

    model_config = ConfigDict(title="Part of an assembly")

    name: str = Field(description="Unique in the assembly.")
    described: str = Field(description="What it is, in words.")
    sort: str = Field(description="`base`, `link`, `block`, `pin`, `ring`, `washer`, `spacer`, or what else it is.")
    material: str
    colour: str = Field(description="As `#rrggbb`.")
    standard: str = Field(description="What it is bought as; empty where it is made.")
    planes: tuple[int, int] = Field(description="The lowest and the highest plane in which it is; the base is in 0.")
    lift: float = Field(
        description="How far up it goes where the planes are drawn apart; along the normal of a `frame`."
    )
    carrier: int = Field(description="Which of `carriers` it moves with, counted from 0.")
    shapes: list[Shape] = Field(description="What it is made of: it is the union of these.")
    item: str = Field(description="Name of its files and in the bill; parts that are made alike have one.")
    files: list[PartFile] = Field(
        description="Which files there are of it at `/v1/jobs/{id}/designs/{n}/parts/{item}.{file}`."
    )


class Standing(BaseModel):
    """The plane in which something moves whose axis is not parallel to the others.

    A point that is at x, y and height z there is at origin + x along + y (normal × along) + z normal. Each list has one
    entry, or one for each input where the plane moves itself.
    """

    model_config = ConfigDict(title="Plane of a carrier")

    origins: list[Place]
    along: list[Place] = Field(description="Directions of length 1.")
    normals: list[Place] = Field(description="Directions of length 1, at right angles to those.")


class Carried(BaseModel):
    """What parts move with, and where it is at each input.

    A point q of the reference configuration goes to `places[k]` + R(`angles[k]`) (q − `pivot`) at input k, where R
    turns counter-clockwise in the plane; heights stay.
    """

    model_config = ConfigDict(title="Carrier of parts")

    link: str
    joint: str | None = Field(description="What it goes with where that is a joint of the link, and not all of it.")
    pivot: Point
    angles: list[float] = Field(description="Degrees, from the reference configuration on, without jumps.")
    places: list[Point] = Field(description="Where the pivot is.")
    frame: Standing | None = Field(description="The plane in which all this is; null where it is that of the assembly.")


class Driven(BaseModel):
    """The inputs at which the carriers are told."""

    model_config = ConfigDict(title="Inputs of an assembly")

    quantity: Literal["angle", "place"] = Field(description="Whether a link turns, or a slide drives.")
    reference: float = Field(description="The input of the reference configuration.")
    low: float = Field(description="Where the range begins that the parts were made for.")
    high: float = Field(description="Where it ends.")
    closed: bool = Field(description="Whether it is one whole cycle, after which the parts are where they were.")
    endless: bool = Field(
        description="Whether it goes on beyond its range: every carrier turns and goes round at a constant rate."
    )
    values: list[float] = Field(
        description="Degrees; or, where a slide drives, its place in the unit of the design, however large it is built."
    )


class AssemblyView(BaseModel):
    """The parts of a design, and how they move; all lengths of parts are in millimetres."""

    model_config = ConfigDict(title="Assembly")

    length_unit: Literal["mm"] = "mm"
    unit: float = Field(description="Millimetres to a length unit of the design, as large as it is built.")
    scale: float = Field(description="How much larger than the design it is built.")
    planes: int = Field(
        description="How many have moving links; the base is plane 0, and a second one lies above them, or amid them "
        "where a link is two plates on either side of it."
    )
    bases: int = Field(description="1, or 2 where the shafts stand between two.")
    low: float = Field(description="Height of the lowest face, of parts whose plane is that of the assembly.")
    high: float = Field(description="Height of their uppermost face.")
    notes: list[str] = Field(description="What else there is to say to who puts it together.")
    input: Driven
    carriers: list[Carried]
    parts: list[ViewedPart]
