"""Statements of a given mechanism: its dimensions as its users know them, or its skeleton; degrees and lengths.

Each model gives the analysis core's :class:`kinematics.linkage.planar.mechanism.Mechanism`. Dimensions say it all for
the types that have them; every other type is stated by its skeleton.
"""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import Discriminator, Tag

from synthesis.mechanisms.base import MechanismError
from synthesis.mechanisms.fourbar import GivenFourbar
from synthesis.mechanisms.geared_fivebar import GivenGearedFivebar
from synthesis.mechanisms.skeleton import GivenSkeleton
from synthesis.mechanisms.slider_crank import GivenInvertedSliderCrank, GivenQuickReturn, GivenSliderCrank

BY_DIMENSIONS: dict[str, str] = {
    "fourbar": "<fourbar>",
    "slider_crank": "<slider_crank>",
    "inverted_slider_crank": "<inverted_slider_crank>",
    "crank_shaper": "<quick_return>",
    "whitworth": "<quick_return>",
    "geared_fivebar": "<geared_fivebar>",
}
"""Types whose dimensions say all, and the tag of the model that reads them."""


def _tag(statement: Any) -> str:
    """Which model reads a statement: dimensions where the type has them and they are given, else the skeleton."""
    if not isinstance(statement, dict):
        return "<skeleton>"
    kind = statement.get("type")
    if "skeleton" in statement and not {"fixed_pivots", "fixed_pivot"} & statement.keys():
        return "<skeleton>"
    return BY_DIMENSIONS.get(kind, "<skeleton>") if isinstance(kind, str) else "<skeleton>"


GivenMechanism = Annotated[
    Annotated[GivenFourbar, Tag("<fourbar>")]
    | Annotated[GivenSliderCrank, Tag("<slider_crank>")]
    | Annotated[GivenInvertedSliderCrank, Tag("<inverted_slider_crank>")]
    | Annotated[GivenQuickReturn, Tag("<quick_return>")]
    | Annotated[GivenGearedFivebar, Tag("<geared_fivebar>")]
    | Annotated[GivenSkeleton, Tag("<skeleton>")],
    Discriminator(_tag),
]
"""Any stated mechanism; the field ``type`` tells which."""

__all__ = ["BY_DIMENSIONS", "GivenFourbar", "GivenGearedFivebar", "GivenMechanism", "GivenSkeleton", "MechanismError"]
