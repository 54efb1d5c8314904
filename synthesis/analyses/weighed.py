"""A mechanism with masses and loads that a problem states as an analysis does: its request, and what is wrong with it.

The mechanism is read here and not in the models of the problem: it brings the analysis core with it.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from pydantic import ValidationError

from kinematics.errors import MechanismError as KinematicsError
from kinematics.linkage.planar.mechanism import Mechanism
from synthesis.analyses.linkage import LinkageAnalysisRequest
from synthesis.mechanisms import MechanismError
from synthesis.mechanisms.link_bodies import token
from synthesis.model.dynamics import DynamicsBlock, LengthUnit, WeighedLinkage
from synthesis.model.motions import Sweep
from synthesis.model.stated_path import stated_steps


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
        stated = {"mechanism": mechanism, "dynamics": dynamics.model_dump(exclude_unset=True, by_alias=True)}
        found = error.errors(include_url=False, include_context=False, include_input=False)
        return [
            (_pointer(stated_steps(fault["loc"], stated, fault["type"] == "missing")), _said(fault["msg"]))
            for fault in found
        ]
    try:
        built = request.mechanism.mechanism()
    except MechanismError as error:
        return [(f"/mechanism{error.path}", error.detail)]
    except KinematicsError as error:
        return [("/mechanism", str(error))]
    if shaft and built.driven_by_slide:
        return [("/mechanism", "a slider drives this mechanism; a shaft must drive it")]
    return request.faults()


def driven_faults(
    mechanism: dict[str, Any], dynamics: WeighedLinkage, unit: LengthUnit, motion: Sweep
) -> tuple[Mechanism | None, list[tuple[str, str]]]:
    """The mechanism that is to be driven over a motion, None where it is none, and what is wrong with them."""
    faults = weighed_faults(mechanism, dynamics, unit)
    if faults:
        return None, faults
    built = weighed_request(mechanism, dynamics, unit).mechanism.mechanism()
    if built.driven_by_slide and motion.speed_rpm is not None:
        faults.append(
            ("/motion/speed_rpm", "a slider drives this mechanism; give its speed as `speed`, length units per second")
        )
    return built, faults


def _pointer(steps: Sequence[str | int]) -> str:
    return "".join(f"/{token(str(step))}" for step in steps)


def _said(message: str) -> str:
    return message.removeprefix("Value error, ")
