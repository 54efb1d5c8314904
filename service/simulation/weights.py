"""Masses of the links of a design: from its ``dynamics`` block, or those of plates of a material."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import combinations
from typing import Any, NamedTuple

from kinematics.dynamics import shapes
from kinematics.dynamics.bodies import Body
from kinematics.linkage.planar.mechanism import GROUND, Mechanism
from service.simulation.query import NotSimulated, SimulationQuery
from synthesis.mechanisms.link_bodies import BlockError
from synthesis.mechanisms.machine import machine_of, weight_faults
from synthesis.model.bodies import DENSITIES, Material
from synthesis.model.dynamics import METRES, WeighedLinkage

PIN_OF_SIZE, PIN_OF_LINK = 0.04, 0.35
"""Maximum pin diameter as a share of the mechanism's size, and of its shortest link; as in service.parts."""

WIDTH, THICKNESS = 2.5, 0.7
"""Default width and thickness of a plate in pin diameters."""

BLOCK_WIDTH, BLOCK_LENGTH = 0.6, 0.9
"""Width and length of a block in its slot, in link widths."""


SCALE = "/query/scale"


class Weights(NamedTuple):
    """Bodies of the links in the reference position, masses of pins, mass and inertia of every block; SI units."""

    links: Mapping[str, Body]
    pins: Mapping[str, float]
    block: tuple[float, float]
    gravity: complex
    width: float
    remarks: tuple[str, ...]


def weights_of(
    mechanism: Mechanism, block: WeighedLinkage | None, layout: Any, unit: Any, query: SimulationQuery
) -> Weights:
    """Return the masses of a linkage.

    Parameters
    ----------
    mechanism : Mechanism
        In length units.
    block : WeighedLinkage or None
        Masses of this mechanism's links in the problem.
    layout : LayoutSizes or None
        Sizes in the problem.
    unit : str
        Length unit.

    Raises
    ------
    NotSimulated
        The block has its own units, or does not fit the mechanism.
    """
    scale = METRES[unit] * query.built
    width, thickness = _sizes(mechanism, layout, METRES[unit], query)
    if block is not None and block.units != "si":
        raise NotSimulated(
            "The problem's `dynamics` has its own units, but simulations are in SI units; give it with `units: si`."
        )
    remarks: list[str] = []
    gravity, pins = 0j, {}
    if block is not None:
        faults = weight_faults(block, mechanism)
        # Report only the first contradiction.
        if faults:
            raise NotSimulated(f"The problem's `dynamics` does not fit this design: {faults[0][0]}: {faults[0][1]}.")
        try:
            machine, _ = machine_of(block, mechanism, unit)
        except BlockError as error:
            raise NotSimulated(f"The problem's `dynamics` does not fit this design: {error}.") from None
        gravity = machine.gravity
        pins = {joint: float(mass) for joint, mass in machine.pin_masses.items()}
        # These blocks have no counterpart in the exported formats.
        left = [name for name in ("loads", "springs", "friction") if getattr(block, name)]
        if left:
            remarks.append(f"Not included: {', '.join(left)} of the problem's dynamics.")
        # With masses in the problem, plates would count twice; only the masses are used then.
        if any(float(part.mass) > 0.0 for part in machine.bodies.values()) or any(pins.values()):
            if query.built != 1.0:
                raise NotSimulated("The problem's `dynamics` gives the masses of the links: leave out `scale`.", SCALE)
            remarks.append("Masses and gravity are those of the problem's dynamics.")
            return Weights(machine.bodies, pins, (0.0, 0.0), gravity, width, tuple(remarks))
    material: Material = query.material or "steel"
    density = DENSITIES[material]
    plates = {
        link: shapes.widened_hull([scale * complex(mechanism.joints[joint]) for joint in joints], width).body(
            density, thickness
        )
        for link, joints in mechanism.links.items()
        if link != GROUND
    }
    # Blocks have round ends about two points.
    half = 0.5 * (BLOCK_LENGTH - BLOCK_WIDTH) * width
    made = shapes.widened_hull([complex(-half), complex(half)], BLOCK_WIDTH * width).body(density, thickness)
    remarks.append(
        f"Links are {material} plates ({density:g} kg/m3), {width:.6g} m wide with round ends and {thickness:.6g} "
        "m thick; their holes are filled by pins."
    )
    remarks.append("Gravity is that of the problem's dynamics." if block is not None else "There is no gravity.")
    return Weights(plates, pins, (float(made.mass), float(made.inertia)), gravity, width, tuple(remarks))


def _sizes(mechanism: Mechanism, layout: Any, unit: float, query: SimulationQuery) -> tuple[float, float]:
    """Return width and thickness of the links, metres."""
    width = query.width or getattr(layout, "link_width", None)
    thickness = query.thickness or getattr(layout, "thickness", None)
    built = unit * width if width else unit * query.built * _width(mechanism)
    return built, unit * thickness if thickness else THICKNESS / WIDTH * built


def _width(mechanism: Mechanism) -> float:
    """Return the default link width of parts, length units."""
    places = [complex(z) for z in mechanism.joints.values()]
    # Same default as in service.parts: pins limited by size and by the shortest link.
    size = max(abs(a - b) for a, b in combinations(places, 2))
    shortest = min(
        abs(complex(mechanism.joints[a] - mechanism.joints[b]))
        for link, joints in mechanism.links.items()
        if link != GROUND
        for a, b in combinations(joints, 2)
        if complex(mechanism.joints[a]) != complex(mechanism.joints[b])
    )
    return WIDTH * min(PIN_OF_SIZE * size, PIN_OF_LINK * shortest)
