"""Dimensions on fields: where the annotation may stand, and what the JSON schema says."""

from __future__ import annotations

from typing import Annotated

import pytest

from synthesis.model.answer import Answer, Check
from synthesis.model.dimension import ANGLE, LENGTH, Angle, Length, collect_dimensions
from synthesis.verification.checks import check_minimum


class Inner(Answer):
    place: Annotated[tuple[float, float], LENGTH]


class Outer(Answer):
    plain: Length
    several: list[Length]
    perhaps: tuple[Length | None, Length | None] | None = None
    named: dict[str, Angle]
    outside: Annotated[list[float] | None, ANGLE] = None
    ratio: float
    inner: Inner


def test_dimension_of_a_field_wherever_the_annotation_stands() -> None:
    expected = {"plain": LENGTH, "several": LENGTH, "perhaps": LENGTH, "named": ANGLE, "outside": ANGLE}
    assert collect_dimensions(Outer) == expected
    assert collect_dimensions(Inner) == {"place": LENGTH}


def test_schema_says_the_dimensions_of_a_model_and_of_those_in_it() -> None:
    schema = Outer.model_json_schema()
    stated = {name: entry.get("x-dimension") for name, entry in schema["properties"].items()}
    assert stated == {
        "plain": "length",
        "several": "length",
        "perhaps": "length",
        "named": "angle",
        "outside": "angle",
        "ratio": None,
        "inner": None,
    }
    assert schema["$defs"]["Inner"]["properties"]["place"]["x-dimension"] == "length"


def test_field_of_two_dimensions_is_refused() -> None:
    class Both(Answer):
        place: Length | Angle

    with pytest.raises(TypeError, match="two fields"):
        collect_dimensions(Both)


def test_check_says_its_dimension_or_leaves_it_out() -> None:
    measured = check_minimum("transmission_angle", 41.0, 30.0, ANGLE).model_dump(mode="json")
    assert measured == {
        "name": "transmission_angle",
        "passed": True,
        "value": 41.0,
        "limit": 30.0,
        "dimension": "angle",
    }
    assert Check.model_validate(measured).dimension is ANGLE
    assert "dimension" not in check_minimum("contact_ratio", 1.6, 1.2).model_dump(mode="json")
