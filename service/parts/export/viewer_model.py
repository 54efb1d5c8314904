"""The viewer model of an assembly, as defined in :mod:`service.parts.export.viewer_schema`."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from service.parts.assembly.items import list_items
from service.parts.assembly.model import SHEET_SORTS, Assembly, Carrier, Frame, Motion, Part
from service.parts.assembly.sizes import NotMade, PartFile
from service.parts.drawings.exploded_view import compute_lifts
from service.parts.export.cad_available import is_installed
from service.parts.export.viewer_schema import (
    AssemblyView,
    CarrierPlane,
    CarrierView,
    CircleEdge,
    CornersEdge,
    InputView,
    MeshShape,
    PartView,
    Point,
    PrismShape,
    Shape,
    TwistedShape,
)
from service.parts.geometry.meshed_body import MeshedBody
from service.parts.geometry.meshes import DISPLAY_SAG, read_triangles
from service.parts.geometry.regions import Disc, Outline
from service.parts.geometry.solids import Body, Prism, TwistedPrism
from service.parts.geometry.splines import Curve

DECIMALS = 6
"""Decimals of a millimetre in corners of displayed triangles."""

MIN_TRACKED_INPUTS = 2880
"""Minimum number of inputs in the tracking of angles, so that full turns are counted correctly."""

ENDLESS_TEST_DEGREES = 2000.0
"""Angle beyond the range, degrees, at which the motion is tested for being endless."""


def make_view(assembly: Assembly, positions: int) -> AssemblyView:
    """Return the view of the assembly at a number of inputs.

    Parameters
    ----------
    assembly : Assembly
    positions : int
        Number of inputs, at least 1.
    """
    carriers = list(dict.fromkeys(part.carrier for part in assembly.parts))
    names = {part.name: item.name for item in list_items(assembly) for part in item.parts}
    lifted = compute_lifts(assembly)
    level = [part for part in assembly.parts if part.name not in assembly.frames]
    return AssemblyView(
        unit=assembly.unit,
        scale=assembly.scale,
        planes=assembly.planes,
        bases=assembly.sides,
        low=min(part.low for part in level),
        high=max(part.high for part in level),
        notes=list(assembly.notes),
        input=_make_input_view(assembly, positions),
        carriers=_make_carrier_views(assembly, carriers, positions),
        parts=[
            _make_part_view(part, carriers.index(part.carrier), names[part.name], lifted[part.name])
            for part in assembly.parts
        ],
    )


def list_files(part: Part) -> list[PartFile]:
    """Return the formats available for a part: outlines of cut parts, and solids if CAD is installed."""
    flat = part.unrolled is not None or (
        part.sort in SHEET_SORTS and all(isinstance(body, Prism) for body in part.bodies)
    )
    cut: list[PartFile] = ["dxf"] if flat else []
    return cut + (["stl", "step", "3mf"] if is_installed() else [])


def _make_input_view(assembly: Assembly, positions: int) -> InputView:
    motion = assembly.motion
    slides = motion.input_field == "input_place"
    unit = assembly.unit if slides else math.pi / 180.0
    return InputView(
        quantity="place" if slides else "angle",
        reference=motion.reference / unit,
        low=motion.low / unit,
        high=motion.high / unit,
        closed=motion.closed,
        endless=_is_endless(motion),
        values=(_sample_inputs(motion, positions) / unit).tolist(),
    )


def _sample_inputs(motion: Motion, positions: int) -> NDArray[np.float64]:
    """Return inputs at equal steps over a full cycle, or over the interior of the range."""
    if motion.closed:
        return np.linspace(motion.low, motion.high, positions, endpoint=False)
    return np.linspace(motion.low, motion.high, positions + 2)[1:-1]


def _is_endless(motion: Motion) -> bool:
    """Return whether the motion continues without limit and without repetition."""
    beyond = math.degrees(motion.high) + ENDLESS_TEST_DEGREES
    try:
        converted = motion.convert_input(beyond, 1.0)
    except NotMade:
        return False
    # Endless motions accept any angle unchanged; cyclic ones reduce it.
    return not motion.closed and math.isclose(converted, math.radians(beyond))


def _make_carrier_views(assembly: Assembly, carriers: list[Carrier], positions: int) -> list[CarrierView]:
    motion = assembly.motion
    inputs = _sample_inputs(motion, positions)
    # Track angles through enough inputs to follow each turn, and return them at the requested ones.
    steps = max(1, math.ceil(MIN_TRACKED_INPUTS / positions))
    between = inputs
    if positions > 1:
        between = np.interp(np.arange((positions - 1) * steps + 1) / steps, np.arange(positions), inputs)
    state = motion.compute_state(between)
    found = []
    for carrier in carriers:
        placed = motion.compute_placement(carrier, state)
        turn, shift = (np.broadcast_to(values, between.shape) for values in (placed.turn, placed.shift))
        pivot = _find_pivot(turn, shift)
        places = (turn * pivot + shift)[::steps]
        angles = np.degrees(np.unwrap(np.angle(turn)))[::steps]
        found.append(
            CarrierView(
                link=carrier.link,
                joint=carrier.joint,
                pivot=_to_pair(pivot),
                angles=angles.tolist(),
                places=[_to_pair(place) for place in places.tolist()],
                frame=None if placed.frame is None else _make_plane(placed.frame, steps),
            )
        )
    return found


def _find_pivot(turn: NDArray[np.complex128], shift: NDArray[np.complex128]) -> complex:
    """Return the point that moves least, so that interpolation between two inputs is accurate.

    It is the p that minimizes the variation of turn · p + shift, by least squares about the mean.
    """
    turned, moved = turn - turn.mean(), shift - shift.mean()
    spread = float(np.vdot(turned, turned).real)
    # Without rotation every point moves alike.
    return 0j if spread < 1e-12 * turn.size else complex(-np.vdot(turned, moved) / spread)


def _make_plane(frame: Frame, steps: int) -> CarrierPlane:
    origins, axes = frame.origin.reshape(-1, 3), frame.axes.reshape(-1, 3, 3)
    step = slice(None, None, steps)
    return CarrierPlane(
        origins=[(x, y, z) for x, y, z in origins[step].tolist()],
        along=[(x, y, z) for x, y, z in axes[step, :, 0].tolist()],
        normals=[(x, y, z) for x, y, z in axes[step, :, 2].tolist()],
    )


def _make_part_view(part: Part, carrier: int, item: str, lift: float) -> PartView:
    return PartView(
        name=part.name,
        described=part.described,
        sort=part.sort,
        material=part.material,
        colour=part.colour,
        standard=part.standard,
        planes=part.planes,
        lift=lift,
        carrier=carrier,
        shapes=[_make_shape(body) for body in part.bodies],
        item=item,
        files=list_files(part),
    )


def _make_shape(body: Body) -> Shape:
    if isinstance(body, MeshedBody):
        corners, triangles = read_triangles(body.make_mesh(DISPLAY_SAG))
        return MeshShape(corners=np.round(corners, DECIMALS).tolist(), triangles=triangles.tolist())
    region = body.section if isinstance(body, TwistedPrism) else body.region
    low, high = body.low, body.high
    outer, holes = _make_edge(region.outer), [_make_edge(hole) for hole in region.holes]
    if isinstance(body, TwistedPrism):
        centre, twist = _to_pair(body.centre), math.degrees(body.twist)
        return TwistedShape(low=low, high=high, outer=outer, holes=holes, centre=centre, twist=twist)
    return PrismShape(low=low, high=high, outer=outer, holes=holes)


def _make_edge(outline: Outline) -> CircleEdge | CornersEdge:
    if isinstance(outline, Disc):
        return CircleEdge(centre=_to_pair(outline.centre), radius=outline.radius)
    if isinstance(outline, Curve):
        places = outline.through
        return CornersEdge(
            corners=[_to_pair(place) for place in places.tolist()], bulges=[0.0] * places.size, smooth=True
        )
    return CornersEdge(
        corners=[_to_pair(corner) for corner in outline.corners], bulges=list(outline.bulges), smooth=False
    )


def _to_pair(z: complex) -> Point:
    return z.real, z.imag
