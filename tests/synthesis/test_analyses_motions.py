"""What every family of analyses refuses of a motion."""

import pytest

from synthesis.analyses import families

DRIVEN = [family.request for family in families() if "motion" in family.request.model_fields]
LONG = {"time": {"end": 1e9, "step": 1e-25}}
BACKWARDS = {"time": {"start": 1.0, "end": 0.0, "step": 0.1}}
TWO_SPEEDS = {"from": 0.0, "to": 90.0, "speed": 1.0, "speed_rpm": 60.0}


def test_nearly_all_families_are_driven():
    assert len(DRIVEN) >= 10


@pytest.mark.parametrize("request_", DRIVEN, ids=lambda model: model.__name__)
@pytest.mark.parametrize(
    ("motion", "path"),
    [(LONG, "/motion/time/step"), (BACKWARDS, "/motion/time/end"), (TWO_SPEEDS, "/motion/speed_rpm")],
    ids=["long", "backwards", "two speeds"],
)
def test_a_motion_that_cannot_be_meant_is_refused_at_its_field(request_, motion, path):
    stated = {**request_.model_json_schema()["examples"][0], "motion": motion}
    assert path in [place for place, _ in request_.model_validate(stated).faults()]


@pytest.mark.parametrize("request_", DRIVEN, ids=lambda model: model.__name__)
def test_the_documented_example_has_no_faults(request_):
    assert request_.example().faults() == []
