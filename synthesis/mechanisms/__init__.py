"""Given mechanisms: their dimensions in the usual form, or their skeleton; degrees and lengths.

Each model builds the analysis core's :class:`kinematics.linkage.planar.mechanism.Mechanism`. Types with complete
dimensions are given by these; every other type is given by its skeleton.
"""

from __future__ import annotations

from typing import Annotated, get_args

from pydantic import BaseModel, Discriminator, Tag

from synthesis.mechanisms.base import MechanismError
from synthesis.mechanisms.fourbar import GivenFourbar
from synthesis.mechanisms.geared_fivebar import GivenGearedFivebar
from synthesis.mechanisms.skeleton import GivenByDimensions, GivenSkeleton
from synthesis.mechanisms.slider_crank import GivenInvertedSliderCrank, GivenQuickReturn, GivenSliderCrank

_BY_TYPE: dict[str, type[GivenByDimensions]] = {
    name: model
    for model in (GivenFourbar, GivenSliderCrank, GivenInvertedSliderCrank, GivenQuickReturn, GivenGearedFivebar)
    for name in get_args(model.model_fields["type"].annotation)
}


def is_known_by_dimensions(mechanism_type: str) -> bool:
    """Return whether the dimensions of a type are complete, so that its mechanism needs no skeleton."""
    return mechanism_type in _BY_TYPE


def _choose_model(statement: object) -> type[GivenByDimensions | GivenSkeleton]:
    """Choose the model for a mechanism: the dimensions if its type has them and they are given, else the skeleton.

    Input that is no mechanism at all goes to the skeleton, whose error messages are the most general.
    """
    # Already validated, for example a default or a mechanism that is passed on.
    if isinstance(statement, GivenByDimensions):
        return type(statement)
    if not isinstance(statement, dict) or not isinstance(statement.get("type"), str):
        return GivenSkeleton
    # A skeleton without pivots cannot be complete dimensions, so it is read as a skeleton for every type.
    if "skeleton" in statement and not {"fixed_pivots", "fixed_pivot"} & statement.keys():
        return GivenSkeleton
    return _BY_TYPE.get(statement["type"], GivenSkeleton)


def _tag_model(model: type[BaseModel]) -> str:
    """Return the model's tag in the union; the brackets keep it apart from names of fields."""
    return f"<{model.__name__}>"


GivenMechanism = Annotated[
    Annotated[GivenFourbar, Tag(_tag_model(GivenFourbar))]
    | Annotated[GivenSliderCrank, Tag(_tag_model(GivenSliderCrank))]
    | Annotated[GivenInvertedSliderCrank, Tag(_tag_model(GivenInvertedSliderCrank))]
    | Annotated[GivenQuickReturn, Tag(_tag_model(GivenQuickReturn))]
    | Annotated[GivenGearedFivebar, Tag(_tag_model(GivenGearedFivebar))]
    | Annotated[GivenSkeleton, Tag(_tag_model(GivenSkeleton))],
    Discriminator(lambda statement: _tag_model(_choose_model(statement))),
]
"""Any given mechanism, identified by its field ``type``."""

__all__ = [
    "GivenFourbar",
    "GivenGearedFivebar",
    "GivenMechanism",
    "GivenSkeleton",
    "MechanismError",
    "is_known_by_dimensions",
]
