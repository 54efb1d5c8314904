"""Errors of a linkage to be balanced by springs: those of an analysis, and the additional requirements of springs."""

from __future__ import annotations

from collections.abc import Sequence

from kinematics.linkage.planar.mechanism import GROUND
from kinematics.message import compose
from synthesis.analyses.linkages.loaded_mechanism import find_driven_errors
from synthesis.kinds.spring_balancing.requested_springs import SoughtSpring
from synthesis.mechanisms.machine import locate_on_link
from synthesis.model.dynamics.request import DynamicsBlock, LengthUnit
from synthesis.model.json_object import JsonObject
from synthesis.model.linkage.input_motion import Sweep

MAX_DISTANCE = 1e4
"""Distance of an end from the linkage, in sizes of it, beyond which a typing error is assumed."""


def find_spring_errors(
    requested: JsonObject, dynamics: DynamicsBlock, unit: LengthUnit, motion: Sweep, springs: Sequence[SoughtSpring]
) -> list[tuple[str, str]]:
    """Return errors of a mechanism, its masses and loads, its motion and the requested springs, by their fields."""
    mechanism, faults = find_driven_errors(requested, dynamics, unit, motion)
    if mechanism is None:
        return faults
    weighs = any(body.shape is not None or body.mass for body in dynamics.bodies.values())
    weighs = weighs or any(mass.mass > 0.0 for mass in dynamics.point_masses)
    pulled = dynamics.gravity is not None and dynamics.gravity.magnitude > 0.0
    moved = motion.rate != 0.0 or motion.acceleration != 0.0
    if not dynamics.loads and not dynamics.springs and not (weighs and (pulled or moved)):
        detail = compose("spring_balancing-nothing-to-balance")
        faults.append(("/dynamics/gravity" if weighs else "/dynamics/bodies", detail))
    no_link = compose("spring_balancing-not-a-link", links=", ".join(mechanism.links))
    places = [complex(z) for z in mechanism.joints.values()]
    size = max(abs(a - b) for a in places for b in places) or 1.0
    for n, spring in enumerate(springs):
        ends = spring.ends
        named = [end.link for end in ends] if ends is not None else list(spring.links or ())
        paths = [f"/springs/{n}/ends/{k}/link" if ends is not None else f"/springs/{n}/links/{k}" for k in range(2)]
        missing = [path for path, link in zip(paths, named, strict=True) if link not in mechanism.links]
        faults += [(path, no_link) for path in missing]
        if missing:
            continue
        if named[0] == named[1]:
            faults.append((paths[1], compose("spring_balancing-ends-on-one-link", link=named[0])))
            continue
        for k, end in enumerate(ends or ()):
            if len(mechanism.links[end.link]) < 2 and end.link != GROUND:
                continue
            for corner in end.corners:
                if (
                    min(abs(locate_on_link(mechanism, end.link, corner) - place) for place in places)
                    > MAX_DISTANCE * size
                ):
                    field = "point" if end.point is not None else "within"
                    faults.append((f"/springs/{n}/ends/{k}/{field}", compose("spring_balancing-end-too-far")))
                    break
    return faults
