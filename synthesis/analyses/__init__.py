"""What the analysis core knows of a given mechanism, for a client: a request and its answer, by mechanism family.

A family is a module with the models of its request and answer. It is found by the mechanism's type, so that a fault
in a request is told in the words of its family.
"""

from __future__ import annotations

from typing import Any

from synthesis.analyses import (
    barrel_cam,
    cam,
    camshaft,
    contour_cam,
    engine,
    flywheel,
    gear_pair,
    gear_train,
    gearbox,
    geneva,
    linkage,
    planetary_train,
    ratchet,
    rotor,
    running_pair,
    train_series,
    universal_joint,
)
from synthesis.analyses.base import AnalysisRequest, Family
from synthesis.model.mechanism_types import mechanism_types

FAMILIES: dict[str, Family] = {
    name: family
    for family in (
        barrel_cam.FAMILY,
        cam.FAMILY,
        camshaft.FAMILY,
        contour_cam.FAMILY,
        engine.FAMILY,
        flywheel.FAMILY,
        gear_pair.BEVEL_FAMILY,
        gear_train.FAMILY,
        gear_pair.HELICAL_FAMILY,
        gear_pair.WORM_FAMILY,
        gearbox.FAMILY,
        gearbox.LAYSHAFT_FAMILY,
        geneva.FAMILY,
        planetary_train.FAMILY,
        ratchet.FAMILY,
        rotor.FAMILY,
        running_pair.FAMILY,
        train_series.FAMILY,
        universal_joint.FAMILY,
    )
    for name in mechanism_types(family.request)
}
"""By the mechanism types that are no linkages; every other mechanism is one."""


def family(mechanism: Any) -> Family:
    """Return the family of a mechanism in JSON form; that of linkages if it is unclear."""
    kind = mechanism.get("type") if isinstance(mechanism, dict) else None
    return FAMILIES.get(kind, linkage.FAMILY) if isinstance(kind, str) else linkage.FAMILY


def families() -> list[Family]:
    """All of them, linkages first."""
    return list(dict.fromkeys([linkage.FAMILY, *FAMILIES.values()]))


def parse_request(body: Any) -> AnalysisRequest:
    """A request from the body of a call.

    Raises
    ------
    pydantic.ValidationError
        For a body that states no mechanism and its motion.
    """
    return family(body.get("mechanism") if isinstance(body, dict) else None).request.model_validate(body)


__all__ = ["FAMILIES", "AnalysisRequest", "Family", "families", "family", "parse_request"]
