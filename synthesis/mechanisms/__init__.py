"""Given mechanisms, described by their usual dimensions or by their skeleton, in degrees and length units.

Each model builds a :class:`kinematics.linkage.planar.mechanism.Mechanism` of the analysis core. If the usual dimensions
of a type are complete, they describe the mechanism; every other type is described by its skeleton.
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
    """Choose the model of a given mechanism: its dimensions if its type has them and they are given, else its skeleton.

    Input that is not a mechanism is parsed as a skeleton, whose error messages are the most general.
    """
    # The mechanism may already be validated, for example if it is a default or is passed on.
    if isinstance(statement, GivenByDimensions):
        return type(statement)
    if not isinstance(statement, dict) or not isinstance(statement.get("type"), str):
        return GivenSkeleton
    # Without fixed pivots the dimensions are incomplete, so the skeleton is used for every type.
    if "skeleton" in statement and not {"fixed_pivots", "fixed_pivot"} & statement.keys():
        return GivenSkeleton
    return _BY_TYPE.get(statement["type"], GivenSkeleton)


def _tag_model(model: type[BaseModel]) -> str:
    """Return the tag of a model in the union; its brackets distinguish it from names of fields."""
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
