"""Analysis request and errors of a given mechanism with masses and loads, for problems that contain one.

The mechanism is parsed here and not in the models of the problem, because parsing needs the analysis core.
"""

from __future__ import annotations

from collections.abc import Sequence

from pydantic import ValidationError

from kinematics.errors import MechanismError as KinematicsError
from kinematics.linkage.planar.mechanism import Mechanism
from kinematics.message import compose
from synthesis.analyses.linkages.linkage import LinkageAnalysisRequest
from synthesis.mechanisms import MechanismError
from synthesis.mechanisms.link_bodies import escape_pointer
from synthesis.model.dynamics.request import DynamicsBlock, LengthUnit, LoadedLinkage
from synthesis.model.error_path import select_given_steps
from synthesis.model.json_object import JsonObject
from synthesis.model.linkage.input_motion import Sweep


def build_loaded_request(mechanism: JsonObject, dynamics: LoadedLinkage, unit: LengthUnit) -> LinkageAnalysisRequest:
    """Build the analysis request for a mechanism with masses and loads.

    Raises
    ------
    pydantic.ValidationError
        For an invalid mechanism.
    """
    block = DynamicsBlock.model_validate(dynamics.model_dump(exclude_unset=True, by_alias=True))
    return LinkageAnalysisRequest.model_validate({"mechanism": mechanism, "dynamics": block, "length_unit": unit})


def find_loaded_errors(
    mechanism: JsonObject, dynamics: LoadedLinkage, unit: LengthUnit, *, shaft: bool = False
) -> list[tuple[str, str]]:
    """Return errors as pairs (JSON pointer, detail) below /mechanism or /dynamics.

    With ``shaft``, a mechanism that a slider drives is an error.
    """
    try:
        request = build_loaded_request(mechanism, dynamics, unit)
    except ValidationError as error:
        stated = {"mechanism": mechanism, "dynamics": dynamics.model_dump(exclude_unset=True, by_alias=True)}
        found = error.errors(include_url=False, include_context=False, include_input=False)
        return [
            (
                _format_pointer(select_given_steps(fault["loc"], stated, fault["type"] == "missing")),
                _clean_message(fault["msg"]),
            )
            for fault in found
        ]
    try:
        built = request.mechanism.build_mechanism()
    except MechanismError as error:
        return [(f"/mechanism{error.path}", error.detail)]
    except KinematicsError as error:
        return [("/mechanism", str(error))]
    if shaft and built.has_slide_input:
        return [("/mechanism", compose("analyses-shaft-must-drive"))]
    return request.find_errors()


def find_driven_errors(
    mechanism: JsonObject, dynamics: LoadedLinkage, unit: LengthUnit, motion: Sweep
) -> tuple[Mechanism | None, list[tuple[str, str]]]:
    """Return the mechanism to be driven over a motion, or None if it is invalid, and the errors."""
    faults = find_loaded_errors(mechanism, dynamics, unit)
    if faults:
        return None, faults
    built = build_loaded_request(mechanism, dynamics, unit).mechanism.build_mechanism()
    if built.has_slide_input and motion.speed_rpm is not None:
        faults.append(("/motion/speed_rpm", compose("analyses-slider-speed-as-length")))
    return built, faults


def _format_pointer(steps: Sequence[str | int]) -> str:
    return "".join(f"/{escape_pointer(str(step))}" for step in steps)


def _clean_message(message: str) -> str:
    return message.removeprefix("Value error, ")
