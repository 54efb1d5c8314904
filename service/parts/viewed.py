"""The viewer model of an assembly, as defined in :mod:`service.parts.answer`."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from service.parts.answer import (
    AssemblyView,
    Carried,
    CircleEdge,
    CornersEdge,
    Driven,
    MeshShape,
    Point,
    PrismShape,
    Shape,
    Standing,
    TurnedShape,
    TwistedShape,
    ViewedPart,
)
from service.parts.bodies import Body, Mesh, Prism, Tapered, Turned, Twisted
from service.parts.carved import Carved
from service.parts.curves import Curve
from service.parts.exploded import lifts
from service.parts.extra import installed
from service.parts.items import items
from service.parts.model import FLAT, Assembly, Carrier, Frame, Motion, Part
from service.parts.shapes import Disc, Outline
from service.parts.sizes import NotMade, PartFile

ROUNDED = 6
"""Decimals of a millimetre to which corners of displayed triangles are merged."""

FINE = 2880
"""Minimum number of inputs in the tracking of angles, so that full turns are counted correctly."""

BEYOND = 2000.0
"""Degrees beyond the range at which the motion is tested for continuing."""


def viewed(assembly: Assembly, positions: int) -> AssemblyView:
    """Return the view of the assembly at a number of inputs.

    Parameters
    ----------
    assembly : Assembly
    positions : int
        Number of inputs, at least 1.
    """
    carriers = list(dict.fromkeys(part.carrier for part in assembly.parts))
    names = {part.name: item.name for item in items(assembly) for part in item.parts}
    lifted = lifts(assembly)
    level = [part for part in assembly.parts if part.name not in assembly.frames]
    return AssemblyView(
        unit=assembly.unit,
        scale=assembly.scale,
        planes=assembly.planes,
        bases=assembly.sides,
        low=min(part.low for part in level),
        high=max(part.high for part in level),
        notes=list(assembly.notes),
        input=_driven(assembly, positions),
        carriers=_carried(assembly, carriers, positions),
        parts=[
            _part(part, carriers.index(part.carrier), names[part.name], lifted[part.name]) for part in assembly.parts
        ],
    )


def files_of(part: Part) -> list[PartFile]:
    """Return the formats available for a part: outlines of cut parts, and solids if CAD is installed."""
    flat = part.unrolled is not None or (part.sort in FLAT and all(isinstance(body, Prism) for body in part.bodies))
    cut: list[PartFile] = ["dxf"] if flat else []
    return cut + (["stl", "step", "3mf"] if installed() else [])


def _driven(assembly: Assembly, positions: int) -> Driven:
    motion = assembly.motion
    slides = motion.input_field == "input_place"
    unit = assembly.unit if slides else math.pi / 180.0
    return Driven(
        quantity="place" if slides else "angle",
        reference=motion.reference / unit,
        low=motion.low / unit,
        high=motion.high / unit,
        closed=motion.closed,
        endless=_endless(motion),
        values=(_spread(motion, positions) / unit).tolist(),
    )


def _spread(motion: Motion, positions: int) -> NDArray[np.float64]:
    """Return inputs at equal steps over a full cycle, or over the interior of the range."""
    if motion.closed:
        return np.linspace(motion.low, motion.high, positions, endpoint=False)
    return np.linspace(motion.low, motion.high, positions + 2)[1:-1]


def _endless(motion: Motion) -> bool:
    """Return whether the motion continues without limit and without repetition."""
    beyond = math.degrees(motion.high) + BEYOND
    try:
        stated = motion.stated(beyond, 1.0)
    except NotMade:
        return False
    # Endless motions accept any angle unchanged; cyclic ones reduce it.
    return not motion.closed and math.isclose(stated, math.radians(beyond))


def _carried(assembly: Assembly, carriers: list[Carrier], positions: int) -> list[Carried]:
    motion = assembly.motion
    inputs = _spread(motion, positions)
    # Track angles through as many inputs as needed, and return them at the requested ones.
    steps = max(1, math.ceil(FINE / positions))
    between = inputs
    if positions > 1:
        between = np.interp(np.arange((positions - 1) * steps + 1) / steps, np.arange(positions), inputs)
    state = motion.at(between)
    found = []
    for carrier in carriers:
        placed = motion.placed(carrier, state)
        turn, shift = (np.broadcast_to(values, between.shape) for values in (placed.turn, placed.shift))
        pivot = _pivot(turn, shift)
        places = (turn * pivot + shift)[::steps]
        angles = np.degrees(np.unwrap(np.angle(turn)))[::steps]
        found.append(
            Carried(
                link=carrier.link,
                joint=carrier.joint,
                pivot=_pair(pivot),
                angles=angles.tolist(),
                places=[_pair(place) for place in places.tolist()],
                frame=None if placed.frame is None else _standing(placed.frame, steps),
            )
        )
    return found


def _pivot(turn: NDArray[np.complex128], shift: NDArray[np.complex128]) -> complex:
    """Return the point that moves least, so that interpolation between two inputs is accurate.

    It is the p that minimizes the variation of turn · p + shift, by least squares about the mean.
    """
    turned, moved = turn - turn.mean(), shift - shift.mean()
    spread = float(np.vdot(turned, turned).real)
    # Without rotation every point moves alike.
    return 0j if spread < 1e-12 * turn.size else complex(-np.vdot(turned, moved) / spread)


def _standing(frame: Frame, steps: int) -> Standing:
    origins, axes = frame.origin.reshape(-1, 3), frame.axes.reshape(-1, 3, 3)
    step = slice(None, None, steps)
    return Standing(
        origins=[(x, y, z) for x, y, z in origins[step].tolist()],
        along=[(x, y, z) for x, y, z in axes[step, :, 0].tolist()],
        normals=[(x, y, z) for x, y, z in axes[step, :, 2].tolist()],
    )


def _part(part: Part, carrier: int, item: str, lift: float) -> ViewedPart:
    return ViewedPart(
        name=part.name,
        described=part.described,
        sort=part.sort,
        material=part.material,
        colour=part.colour,
        standard=part.standard,
        planes=part.planes,
        lift=lift,
        carrier=carrier,
        shapes=[_shape(body) for body in part.bodies],
        item=item,
        files=files_of(part),
    )


def _shape(body: Body) -> Shape:
    if isinstance(body, Turned):
        return TurnedShape(centre=_pair(body.centre), profile=[_pair(corner) for corner in body.profile])
    if isinstance(body, Carved):
        found, numbers = np.unique(np.round(body.facets.reshape(-1, 3), ROUNDED), axis=0, return_inverse=True)
        return MeshShape(corners=found.tolist(), triangles=numbers.reshape(-1, 3).tolist())
    if isinstance(body, Tapered):
        body = body.mesh
    if isinstance(body, Mesh):
        corners: Any = body.corners.tolist()
        return MeshShape(corners=corners, triangles=body.triangles.tolist())
    region = body.section if isinstance(body, Twisted) else body.region
    upright: dict[str, Any] = {
        "low": body.low,
        "high": body.high,
        "outer": _edge(region.outer),
        "holes": [_edge(hole) for hole in region.holes],
    }
    if isinstance(body, Twisted):
        return TwistedShape(centre=_pair(body.centre), twist=math.degrees(body.twist), **upright)
    return PrismShape(**upright)


def _edge(outline: Outline) -> CircleEdge | CornersEdge:
    if isinstance(outline, Disc):
        return CircleEdge(centre=_pair(outline.centre), radius=outline.radius)
    if isinstance(outline, Curve):
        places = outline.through
        return CornersEdge(corners=[_pair(place) for place in places.tolist()], bulges=[0.0] * places.size, smooth=True)
    return CornersEdge(corners=[_pair(corner) for corner in outline.corners], bulges=list(outline.bulges), smooth=False)


def _pair(z: complex) -> Point:
    return z.real, z.imag
