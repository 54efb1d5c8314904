"""Errors of a linkage to be balanced: those of an analysis, and the additional requirements of balancing."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from kinematics.linkage.planar.mechanism import GROUND
from kinematics.message import compose
from synthesis.analyses.linkages.loaded_mechanism import find_driven_errors
from synthesis.kinds.balancing.statement.counterweights import Counterweights
from synthesis.mechanisms.link_bodies import escape_pointer
from synthesis.mechanisms.machine import build_machine
from synthesis.model.dynamics.request import DynamicsBlock, LengthUnit
from synthesis.model.json_object import JsonObject
from synthesis.model.linkage.input_motion import Sweep


def find_linkage_errors(
    requested: JsonObject,
    dynamics: DynamicsBlock,
    unit: LengthUnit,
    motion: Sweep,
    weights: Counterweights,
    joints: Mapping[str, Iterable[str]],
) -> list[tuple[str, str]]:
    """Return the errors of a mechanism, its masses, its motion and its counterweights as pairs of field and message.

    ``joints`` maps each field that names joints to these names.
    """
    mechanism, faults = find_driven_errors(requested, dynamics, unit, motion)
    if mechanism is None:
        return faults
    machine, _ = build_machine(dynamics, mechanism, unit)
    masses = [*(float(part.mass) for part in machine.bodies.values()), *map(float, machine.pin_masses.values())]
    if not any(masses):
        faults.append(("/dynamics/bodies", compose("balancing-masses-missing")))
    moving = [link for link in mechanism.links if link != GROUND]
    for n, link in enumerate(weights.links or []):
        if link not in moving:
            faults.append(
                (f"/counterweights/links/{n}", compose("balancing-not-a-moving-link", links=", ".join(moving)))
            )
    known = [joint for joint in mechanism.joints if sum(joint in listed for listed in mechanism.links.values()) > 1]
    for path, named in joints.items():
        for joint in named:
            if joint not in known:
                faults.append(
                    (
                        f"{path}/{escape_pointer(joint)}",
                        compose("balancing-not-a-joint-of-two-links", joints=", ".join(known)),
                    )
                )
    return faults
