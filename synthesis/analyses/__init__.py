"""Analyses of given mechanisms, each with a request and an answer, by family of mechanisms.

Each family is a module with the models of its request and its answer. The type of a mechanism determines its family, so
that errors in a request refer to the fields of that family.
"""

from __future__ import annotations

from synthesis.analyses.base import AnalysisRequest, Family
from synthesis.analyses.cams import barrel_cam, cam, camshaft, contour_cam
from synthesis.analyses.gears import (
    gear_pair,
    gear_train,
    gearbox,
    planetary_train,
    rack_pinion,
    running_pair,
    train_series,
)
from synthesis.analyses.linkages import linkage
from synthesis.analyses.machines import engine, flywheel, geneva, ratchet, rotor, universal_joint
from synthesis.model.mechanism_types import list_mechanism_types

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
        rack_pinion.FAMILY,
        ratchet.FAMILY,
        rotor.FAMILY,
        running_pair.FAMILY,
        train_series.FAMILY,
        universal_joint.FAMILY,
    )
    for name in list_mechanism_types(family.request)
}
"""Families by type of mechanism, except linkages: every type that is not listed is a linkage."""


def get_family(mechanism: object) -> Family:
    """Return the family of a mechanism in JSON form; the family of linkages if the type is unknown or missing."""
    kind = mechanism.get("type") if isinstance(mechanism, dict) else None
    # Even invalid requests need a family, whose model then reports the error.
    return FAMILIES.get(kind, linkage.FAMILY) if isinstance(kind, str) else linkage.FAMILY


def list_families() -> list[Family]:
    """Return all families, linkages first."""
    return list(dict.fromkeys([linkage.FAMILY, *FAMILIES.values()]))


def list_types() -> list[str]:
    """Return all types of mechanism that can be analysed, linkages first."""
    return [*dict.fromkeys(list_mechanism_types(linkage.FAMILY.request)), *FAMILIES]


def parse_request(body: object) -> AnalysisRequest:
    """Parse a request from the body of a call.

    Raises
    ------
    pydantic.ValidationError
        For an ill-formed request.
    """
    return get_family(body.get("mechanism") if isinstance(body, dict) else None).request.model_validate(body)


__all__ = ["FAMILIES", "AnalysisRequest", "Family", "get_family", "list_families", "list_types", "parse_request"]
