"""What every family of analyses refuses of a motion, and where rates end."""

import math

import numpy as np
import pytest
from pydantic_core import to_json

from kinematics.errors import MechanismError
from kinematics.linkage import Fourbar, catalogue
from kinematics.linkage.planar.drive import drive
from synthesis.analyses import list_families, parse_request
from synthesis.analyses.linkages.cycle import find_cycle

DRIVEN = [family.request for family in list_families() if "motion" in family.request.model_fields]
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
    stated = {**request_.get_example(), "motion": motion}
    assert path in [place for place, _ in request_.model_validate(stated).find_errors()]


@pytest.mark.parametrize("request_", DRIVEN, ids=lambda model: model.__name__)
def test_the_documented_example_has_no_faults(request_):
    assert request_.build_example().find_errors() == []


@pytest.mark.parametrize("family", list_families(), ids=lambda family: family.request.__name__)
def test_a_default_that_is_written_out_states_nothing(family):
    request = family.request.build_example()
    written = family.request.model_validate(request.model_dump(mode="json", by_alias=True))
    assert written == request
    assert written.find_errors() == request.find_errors() == []
    assert to_json(written.build_answer()) == to_json(request.build_answer())


@pytest.mark.parametrize(
    ("motion", "ends"),
    [({}, (15.0, 25.0)), ({"speed": 2.0, "steps": 8}, (15.0, 25.0)), ({"from": 17.0}, (17.0, 25.0))],
    ids=["default", "without ends", "one end"],
)
def test_an_end_that_is_left_out_is_a_toggle_of_a_slider(motion, ends):
    slider_crank = {
        "type": "slider_crank",
        "fixed_pivot": [0.0, 0.0],
        "links": {"crank": 5.0, "coupler": 20.0},
        "slide": {"point": [0.0, 0.0], "angle": 0.0},
        "driven_by": "slider",
    }
    stated = {"mechanism": slider_crank, "motion": motion}
    places = parse_request(stated).build_answer()["input_angle"]
    assert (places[0], places[-1]) == pytest.approx(ends)


def test_rates_end_where_a_cycle_ends_at_toggles():
    """The angle of a toggle is rounded: what a rate would be there is made of rounding, and there is none."""
    drawn, ended = np.random.default_rng(3), 0
    while ended < 40:
        lengths, at = 10.0 ** drawn.uniform(-1.0, 1.0, 4), drawn.uniform(0.0, 2.0 * math.pi)
        try:
            fourbar = catalogue.make_fourbar(Fourbar.from_lengths(*lengths), input_angle=at)
        except MechanismError:
            continue
        low, high = find_cycle(fourbar)
        if math.isclose(high - low, 2.0 * math.pi):
            continue
        motion = drive(fourbar, np.radians(np.degrees([low, 0.5 * (low + high), high])))
        assert motion.valid.all()
        assert motion.smooth.tolist() == [False, True, False]
        ended += 1
