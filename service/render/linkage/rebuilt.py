"""The mechanism of a design, built from what the design states, as anybody who has only that would build it."""

from __future__ import annotations

from collections.abc import Set
from typing import Any

from pydantic import TypeAdapter, ValidationError

from kinematics import errors as kinematics
from kinematics.linkage.planar.mechanism import Mechanism
from service.render import NotBuilt
from synthesis.mechanisms import GivenMechanism, MechanismError

_GIVEN: TypeAdapter[GivenMechanism] = TypeAdapter(GivenMechanism)


def rebuilt(design: Any, without: Set[str] = frozenset()) -> Mechanism:
    """The mechanism of a design, from its dimensions and its skeleton; ``without`` are members that are left out.

    Raises
    ------
    NotBuilt
        Where it is none that the analysis core would be given.
    """
    try:
        return _GIVEN.validate_python(design.mechanism.model_dump(exclude=set(without))).mechanism()
    except (ValidationError, MechanismError, kinematics.MechanismError) as error:
        raise NotBuilt(type(error).__name__) from error
