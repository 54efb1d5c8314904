"""A mechanism with masses and loads that a problem states as an analysis does: its request, and what is wrong with it.

The mechanism is read here and not in the models of the problem: it brings the analysis core with it.
"""

from __future__ import annotations

from typing import Any

from pydantic import ValidationError

from kinematics.errors import MechanismError as KinematicsError
from synthesis.analyses.linkage import LinkageAnalysisRequest
from synthesis.mechanisms import MechanismError
from synthesis.model.dynamics import DynamicsBlock, LengthUnit, WeighedLinkage


def weighed_request(mechanism: dict[str, Any], dynamics: WeighedLinkage, unit: LengthUnit) -> LinkageAnalysisRequest:
    """The request for an analysis of a mechanism with masses and loads.

    Raises
    ------
    pydantic.ValidationError
        For a mechanism that is none.
    """
    block = DynamicsBlock.model_validate(dynamics.model_dump(exclude_unset=True, by_alias=True))
    return LinkageAnalysisRequest.model_validate({"mechanism": mechanism, "dynamics": block, "length_unit": unit})


def weighed_faults(
    mechanism: dict[str, Any], dynamics: WeighedLinkage, unit: LengthUnit, *, shaft: bool = False
) -> list[tuple[str, str]]:
    """What is wrong with them: (JSON pointer, detail) below /mechanism or /dynamics; with ``shaft`` a crank drives."""
    try:
        request = weighed_request(mechanism, dynamics, unit)
    except ValidationError as error:
        return [
            ("".join(f"/{step}" for step in fault["loc"] if not str(step).startswith("<")), fault["msg"])
            for fault in error.errors(include_url=False, include_context=False, include_input=False)
        ]
    try:
        built = request.mechanism.mechanism()
    except MechanismError as error:
        return [(f"/mechanism{error.path}", error.detail)]
    except KinematicsError as error:
        return [("/mechanism", str(error))]
    if shaft and built.driven_by_slide:
        return [("/mechanism", "a slider drives this; a shaft has to")]
    return request.faults()
