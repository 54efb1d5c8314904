"""Reconstruction of an answer's mechanism for the analysis core, from the answer's dimensions alone."""

from __future__ import annotations

from typing import Protocol

from pydantic import TypeAdapter, ValidationError

from kinematics.errors import MechanismError as ImpossibleMechanism
from kinematics.linkage.planar.mechanism import Mechanism
from synthesis.mechanisms import GivenMechanism, MechanismError, is_known_by_dimensions
from synthesis.model.json_object import JsonObject

_GIVEN_ADAPTER: TypeAdapter[GivenMechanism] = TypeAdapter(GivenMechanism)


class Dimensions(Protocol):
    """A model of the dimensions of a mechanism."""

    def model_dump(self) -> JsonObject:
        """Return the fields by name."""


def rebuild_mechanism(mechanism: Dimensions, *, from_skeleton: bool = False) -> Mechanism | None:
    """Rebuild the mechanism of an answer in its reference configuration.

    If the dimensions of its type are complete, its skeleton is ignored. A mechanism of any other type is rebuilt from
    its skeleton, with which its lengths must agree.

    Parameters
    ----------
    mechanism : Dimensions
        Mechanism of any answer.
    from_skeleton : bool
        Whether to use the skeleton in any case, after comparing it with the dimensions. The skeleton has joints that
        the dimensions lack, such as points of a body on a rocker.

    Returns
    -------
    Mechanism or None
        None if the mechanism cannot be assembled, or if its dimensions exceed the limits of statements.
    """
    stated = mechanism.model_dump()
    if is_known_by_dimensions(stated["type"]) and not from_skeleton:
        # Building from the dimensions alone proves that they are complete and correct.
        del stated["skeleton"]
    try:
        return _GIVEN_ADAPTER.validate_python(stated).build_mechanism()
    # A design that cannot be rebuilt is dropped by the caller, so the reason does not matter here.
    except (ValidationError, MechanismError, ImpossibleMechanism):
        return None
