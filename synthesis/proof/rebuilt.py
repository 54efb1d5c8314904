"""The mechanism of an answer as the analysis core drives it, built from what the answer states and nothing else."""

from __future__ import annotations

from pydantic import BaseModel, TypeAdapter, ValidationError

from kinematics.errors import MechanismError as ImpossibleMechanism
from kinematics.linkage.planar.mechanism import Mechanism
from synthesis.mechanisms import GivenMechanism, MechanismError, known_by_dimensions

_GIVEN: TypeAdapter[GivenMechanism] = TypeAdapter(GivenMechanism)


def rebuilt(mechanism: BaseModel, *, from_skeleton: bool = False) -> Mechanism | None:
    """The mechanism of an answer in its reference configuration.

    Where a type's dimensions say all, its skeleton is not looked at; every other type has its skeleton as its
    dimensions, with which the lengths beside it must agree.

    Parameters
    ----------
    mechanism : BaseModel
        Any answer's mechanism.
    from_skeleton : bool
        Drive the skeleton in any case, after a comparison with the dimensions: it has joints that dimensions do not
        speak of, such as points of a body on a rocker.

    Returns
    -------
    Mechanism or None
        None where the dimensions make no mechanism that can be assembled, or are beyond what any statement may hold.
    """
    stated = mechanism.model_dump()
    if known_by_dimensions(stated["type"]) and not from_skeleton:
        del stated["skeleton"]
    try:
        return _GIVEN.validate_python(stated).mechanism()
    except (ValidationError, MechanismError, ImpossibleMechanism):
        return None
