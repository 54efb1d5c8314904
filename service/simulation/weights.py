"""Masses of the links of a design: from its ``dynamics`` block, or those of plates of a material."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import combinations
from typing import NamedTuple

from kinematics.dynamics import shapes
from kinematics.dynamics.bodies import Body
from kinematics.linkage.planar.mechanism import GROUND, Mechanism
from kinematics.message import compose
from service.simulation.query import NotSimulated, SimulationQuery
from synthesis.mechanisms.link_bodies import BlockError
from synthesis.mechanisms.machine import build_machine, find_weight_errors
from synthesis.model.dynamics.bodies import DENSITIES, Material
from synthesis.model.dynamics.request import METRES_PER_UNIT, LengthUnit, LoadedLinkage

MAX_PIN_PER_SIZE, MAX_PIN_PER_LINK = 0.04, 0.35
"""Maximum pin diameter as a share of the mechanism's size, and of its shortest link; as in service.parts."""

WIDTH_PER_PIN, THICKNESS_PER_PIN = 2.5, 0.7
"""Default width and thickness of a plate in pin diameters."""

BLOCK_WIDTH_SHARE, BLOCK_LENGTH_SHARE = 0.6, 0.9
"""Width and length of a block in its slot, in link widths."""


SCALE_PATH = "/query/scale"


class Weights(NamedTuple):
    """Bodies of the links in the reference position, masses of pins, mass and inertia of every block; SI units."""

    links: Mapping[str, Body]
    pins: Mapping[str, float]
    block: tuple[float, float]
    gravity: complex
    width: float
    remarks: tuple[str, ...]


def compute_weights(
    mechanism: Mechanism, block: LoadedLinkage | None, layout: object, unit: LengthUnit, query: SimulationQuery
) -> Weights:
    """Return the masses of a linkage.

    Parameters
    ----------
    mechanism : Mechanism
        In length units.
    block : LoadedLinkage or None
        Masses of this mechanism's links.
    layout : object
        Sizes of the links in the problem, or None.
    unit : str
        Length unit.

    Raises
    ------
    NotSimulated
        If the block has its own units, or does not fit the mechanism.
    """
    scale = METRES_PER_UNIT[unit] * query.built
    width, thickness = _get_sizes(mechanism, layout, METRES_PER_UNIT[unit], query)
    if block is not None and block.units != "si":
        raise NotSimulated(compose("simulation-dynamics-not-in-si"))
    remarks: list[str] = []
    gravity, pins = 0j, {}
    if block is not None:
        faults = find_weight_errors(block, mechanism)
        # Report only the first contradiction.
        if faults:
            place, reason = faults[0]
            raise NotSimulated(compose("simulation-dynamics-field-does-not-fit", place=place, reason=reason))
        try:
            machine, _ = build_machine(block, mechanism, unit)
        except BlockError as error:
            raise NotSimulated(compose("simulation-dynamics-does-not-fit", reason=str(error))) from None
        gravity = machine.gravity
        pins = {joint: float(mass) for joint, mass in machine.pin_masses.items()}
        # These blocks have no counterpart in the exported formats.
        left = [name for name in ("loads", "springs", "friction") if getattr(block, name)]
        if left:
            remarks.append(compose("simulation-dynamics-not-included", fields=", ".join(left)))
        # With masses in the problem, plates would count twice; only the masses are used then.
        if any(float(part.mass) > 0.0 for part in machine.bodies.values()) or any(pins.values()):
            if query.built != 1.0:
                raise NotSimulated(compose("simulation-scale-with-masses"), SCALE_PATH)
            remarks.append(compose("simulation-masses-of-problem"))
            return Weights(machine.bodies, pins, (0.0, 0.0), gravity, width, tuple(remarks))
    material: Material = query.material or "steel"
    density = DENSITIES[material]
    plates = {
        link: shapes.make_widened_hull([scale * complex(mechanism.joints[joint]) for joint in joints], width).body(
            density, thickness
        )
        for link, joints in mechanism.links.items()
        if link != GROUND
    }
    # Blocks have round ends about two points.
    half = 0.5 * (BLOCK_LENGTH_SHARE - BLOCK_WIDTH_SHARE) * width
    made = shapes.make_widened_hull([complex(-half), complex(half)], BLOCK_WIDTH_SHARE * width).body(density, thickness)
    remarks.append(
        compose(
            "simulation-links-as-plates",
            material=material,
            density=f"{density:g}",
            width=f"{width:.6g}",
            thickness=f"{thickness:.6g}",
        )
    )
    remarks.append(compose("simulation-gravity-of-problem" if block is not None else "simulation-no-gravity"))
    return Weights(plates, pins, (float(made.mass), float(made.inertia)), gravity, width, tuple(remarks))


def _get_sizes(mechanism: Mechanism, layout: object, unit: float, query: SimulationQuery) -> tuple[float, float]:
    """Return width and thickness of the links, metres."""
    width = query.width or getattr(layout, "link_width", None)
    thickness = query.thickness or getattr(layout, "thickness", None)
    built = unit * width if width else unit * query.built * _compute_default_width(mechanism)
    return built, unit * thickness if thickness else THICKNESS_PER_PIN / WIDTH_PER_PIN * built


def _compute_default_width(mechanism: Mechanism) -> float:
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
    return WIDTH_PER_PIN * min(MAX_PIN_PER_SIZE * size, MAX_PIN_PER_LINK * shortest)
