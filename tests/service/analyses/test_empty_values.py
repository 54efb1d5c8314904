"""Values that are not defined are null, and an empty value always says why."""

import math

import numpy as np
import pytest

from synthesis.analyses import parse_request

CRANK_ROCKER = {
    "type": "fourbar",
    "fixed_pivots": {"input": [0.0, 0.0], "output": [6.0, 0.0]},
    "links": {"input": 2.0, "coupler": 7.0, "output": 9.0},
    "assembly": "open",
}
SLIDER_CRANK = {
    "type": "slider_crank",
    "fixed_pivot": [0.0, 0.0],
    "links": {"crank": 2.0, "coupler": 7.0},
    "slide": {"point": [0.0, 0.0], "angle": 0.0},
}
PLANETARY = {"type": "planetary_train", "arrangement": "simple", "teeth": {"sun": 30, "planet": 20, "ring": 70}}
NAMED = {**PLANETARY, "input": "sun", "output": "carrier", "fixed": "ring"}
FOLDED = math.degrees(math.acos((6.0**2 + 9.0**2 - 9.0**2) / (2.0 * 6.0 * 9.0)))
"""Crank angle at which crank and coupler of the crank-rocker lie in line: the rocker is at rest."""


def analyse(mechanism, **more):
    return parse_request({"mechanism": mechanism, **more}).build_answer()


@pytest.mark.parametrize(
    ("mechanism", "at", "field", "name"),
    [(CRANK_ROCKER, FOLDED, "torque_ratio", "output"), (SLIDER_CRANK, 0.0, "force_ratio", "B"),
     (SLIDER_CRANK, 180.0, "force_ratio", "B")],
)  # fmt: skip
def test_a_ratio_at_a_dead_centre_is_null_with_a_reason(mechanism, at, field, name):
    answer = analyse(mechanism, motion={"at": at})
    assert np.isnan(answer[field][name]).all()
    assert answer["notes"] == [f"{field}: null for {name} where the output is at rest (a dead centre)"]
    beside = analyse(mechanism, motion={"at": at + 1e-3})
    assert np.isfinite(beside[field][name]).all()
    assert beside["notes"] == []


@pytest.mark.parametrize("lengths", [(6.0, 2.0, 6.0, 2.0), (4.0, 2.0, 4.0, 2.0), (5.0, 3.0, 4.0, 4.0)])
@pytest.mark.parametrize("assembly", ["open", "crossed"])
def test_limits_at_a_change_point_are_those_of_the_folded_linkage(lengths, assembly):
    ground, crank, coupler, output = lengths
    answer = analyse(
        {
            "type": "fourbar",
            "fixed_pivots": {"input": [0.0, 0.0], "output": [ground, 0.0]},
            "links": {"input": crank, "coupler": coupler, "output": output},
            "assembly": assembly,
        }
    )
    # Where all links lie in line, the output has a multiple of 180°.
    off = [abs(math.remainder(limit, 180.0)) for limit in answer["limits"]["output"]]
    assert min(off) < 1e-6
    if ground == coupler:
        assert max(off) < 1e-6
    assert any(note.startswith("limits: at a change point") for note in answer["notes"])


def test_instant_centres_over_a_range_say_what_to_do():
    answer = analyse(CRANK_ROCKER)
    assert answer["instant_centers"] == {}
    assert answer["notes"] == ["instant_centers: listed for a single position only; give it as `motion.at`"]
    assert analyse(CRANK_ROCKER, motion={"at": 40.0})["instant_centers"]


@pytest.mark.parametrize(
    ("mechanism", "more"),
    [
        (PLANETARY, {"speeds": {"sun": 10}}),
        (PLANETARY, {"speeds": {"sun": 10, "ring": 0}}),
        (PLANETARY, {"speeds": {"sun": 10, "ring": 0, "carrier": 1}}),
        (PLANETARY, {"speeds": {"sun": 10, "ring": 1, "carrier": 3.7}}),
        (PLANETARY, {"speeds": {"sun": 10}, "locked": [["sun", "carrier"]]}),
        ({**PLANETARY, "input": "sun"}, {}),
        ({**PLANETARY, "input": "sun", "output": "carrier"}, {}),
        ({**NAMED, "output": "ring", "fixed": "ring"}, {}),
        (NAMED, {"locked": [["sun", "carrier"]], "speeds": {"sun": 1}}),
        (NAMED, {"loads": ["sun"]}),
        (NAMED, {}),
    ],
)
def test_every_empty_value_of_a_planetary_train_has_a_reason(mechanism, more):
    answer = analyse(mechanism, motion={"steps": 4}, **more)
    said = {name.strip() for note in answer["notes"] for name in note.partition(":")[0].split(",")}
    members = [body for body in answer["bodies"] if not body["planet"]]
    empty = {name for name in ("ratio", "exact_ratio", "efficiency") if answer[name] is None}
    empty |= {name for name in ("angle", "omega", "alpha") if any(body[name] is None for body in members)}
    empty |= {f"{name}s" for name in ("torque", "power") if any(body[name] is None for body in members)}
    empty |= {"speeds"} if any(body["speed"] is None for body in answer["bodies"]) else set()
    if "speeds" in said:
        # Without speeds nothing else follows; one reason is enough.
        empty -= {"efficiency", "ratio", "exact_ratio", "angle", "omega", "alpha"}
    assert empty <= said
    assert bool(answer["notes"]) == bool(empty)


def test_rates_at_a_toggle_are_no_dead_centre():
    rocker = {**CRANK_ROCKER, "links": {"input": 9.0, "coupler": 7.0, "output": 2.0}}
    (toggle, *_) = analyse(rocker, motion={"at": 20.0})["toggles"]
    assert analyse(rocker, motion={"at": toggle})["notes"] == []
