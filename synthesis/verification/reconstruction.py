"""Reconstruction of an answer's mechanism for the analysis core, from the answer's dimensions alone."""

from __future__ import annotations

from pydantic import TypeAdapter, ValidationError

from kinematics.errors import MechanismError as ImpossibleMechanism
from kinematics.linkage.planar.mechanism import Mechanism
from synthesis.mechanisms import GivenMechanism, MechanismError, is_known_by_dimensions
from synthesis.model.protocols import SkeletonMechanism

_GIVEN_ADAPTER: TypeAdapter[GivenMechanism] = TypeAdapter(GivenMechanism)


def rebuild_mechanism(mechanism: SkeletonMechanism, *, from_skeleton: bool = False) -> Mechanism | None:
    """Rebuild the mechanism of an answer in its reference configuration.

    If the dimensions of a type are complete, its skeleton is ignored. Every other type is rebuilt from its skeleton,
    with which its lengths must agree.

    Parameters
    ----------
    mechanism : SkeletonMechanism
        Any answer's mechanism.
    from_skeleton : bool
        Use the skeleton in any case, after a comparison with the dimensions: it has joints that the dimensions lack,
        such as points of a body on a rocker.

    Returns
    -------
    Mechanism or None
        None if the mechanism cannot be assembled, or if its dimensions exceed the limits of any statement.
    """
    stated = mechanism.model_dump()
    if is_known_by_dimensions(stated["type"]) and not from_skeleton:
        # The dimensions are sufficient: building from them proves that they are complete and correct.
        del stated["skeleton"]
    try:
        return _GIVEN_ADAPTER.validate_python(stated).build_mechanism()
    # A design that cannot be rebuilt is dropped by the caller, so the reason does not matter here.
    except (ValidationError, MechanismError, ImpossibleMechanism):
        return None
