"""What the numbers of designs measure is told by their names, as the models say it."""

import pytest

from service.api.http.metric_units import collect_measures
from synthesis.registry import KINDS


@pytest.mark.parametrize(
    ("kind", "name", "dimension"),
    [
        ("motion", "min_transmission_angle", "angle"),
        ("motion", "size", "length"),
        ("cam", "base_radius", "length"),
        ("gear_train", "centre_distance", "length"),
        ("engine", "rod", "length"),
        ("spring_balancing", "rate", "stiffness"),
    ],
)
def test_a_number_measures_what_its_field_says(client, kind, name, dimension):
    told = {one["kind"]: one for one in client.get("/v1/problems").json()["problems"]}
    assert told[kind]["measures"][name] == dimension


def test_pure_numbers_and_names_of_two_meanings_are_left_out():
    assert "quality" not in collect_measures(KINDS["motion"].result)
    assert "rms_residual" not in collect_measures(KINDS["motion"].result)
    assert "driver" not in collect_measures(KINDS["gear_train"].result), (
        "teeth of a pinion, or the angle of a bevel gear"
    )


@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_measures_something(kind):
    assert len(collect_measures(KINDS[kind].result)) >= 3
