"""Analyses of helical, bevel and worm pairs: printed dimensions through the request that a client posts."""

import math

import pytest

from kinematics.errors import MechanismError
from synthesis.analyses import FAMILIES, parse_request
from synthesis.mechanisms.base import MechanismError as StatedError
from tests.cases import cases

TYPES = ["helical_pair", "bevel_pair", "worm_set"]


def analysed(type_, **fields):
    request = parse_request({"mechanism": {"type": type_, **fields}, "speed_rpm": 60.0 / (2.0 * math.pi)})
    assert request.find_errors() == []
    found = request.build_answer()
    FAMILIES[type_].analysis.model_validate(found)
    return found


@pytest.mark.parametrize("type_", TYPES)
def test_the_example_is_answered(type_):
    family = FAMILIES[type_]
    family.analysis.model_validate(family.request.build_example().build_answer())


@pytest.mark.parametrize("case", cases("helical_pair", "gear"))
def test_helical_pairs(case):
    """The helix angle is found by bisection on the distance that the analysis gives."""
    x = case.inputs
    low, high = 0.0, 80.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        found = analysed("helical_pair", teeth=[x["t"], x["T"]], normal_module=1.0 / x["pnd"], helix_angle=middle)
        low, high = (middle, high) if found["centre_distance"] < x["C"] else (low, middle)
    one, other = found["gears"]
    case.check(
        C=found["centre_distance"],
        R=found["ratio"],
        ptd=math.pi / one["circular_pitch"],
        psi=one["helix_angle"],
        D2=one["pitch_diameter"],
        D3=other["pitch_diameter"],
        pnd=2.25 / found["whole_depth"],
        pt=one["circular_pitch"],
        F_min=found["least_face_width"],
    )
    assert other["helix_angle"] == -one["helix_angle"]


def test_crossed_gears_share_the_shaft_angle_and_slide():
    found = analysed("helical_pair", teeth=[20, 30], normal_module=2.0, helix_angle=60.0, shaft_angle=90.0)
    one, other = found["gears"]
    assert one["helix_angle"] + other["helix_angle"] == pytest.approx(90.0)
    assert found["transverse_contact_ratio"] is None
    # speeds in the ratio of teeth, though the diameters have another one
    assert one["speed"] / other["speed"] == pytest.approx(1.5)
    assert other["pitch_diameter"] / one["pitch_diameter"] != pytest.approx(1.5)


@pytest.mark.parametrize("case", cases("bevel_set", "gear"))
@pytest.mark.parametrize("unit", [("cm", 1.0), ("mm", 10.0), ("in", 1.0 / 2.54)])
def test_bevel_teeth_of_the_book(case, unit):
    """The default is the book's system, and the depth that it adds as a length follows the unit."""
    name, centimetre = unit
    x = case.inputs
    request = parse_request(
        {
            "mechanism": {
                "type": "bevel_pair",
                "teeth": [x["Tp"], x["Tg"]],
                "module": centimetre / x["pd"],
                "pressure_angle": float(x["phi"]),
            },
            "length_unit": name,
        }
    )
    found = request.build_answer()
    pinion, gear = found["gears"]
    assert found["tooth_system"] == "rao"
    case.check(
        working=(pinion["addendum"] + gear["addendum"]) / centimetre,
        whole=found["whole_depth"] / centimetre,
        aP=pinion["addendum"] / centimetre,
        aG=gear["addendum"] / centimetre,
        dP=pinion["dedendum"] / centimetre,
        dG=gear["dedendum"] / centimetre,
        pc=gear["circular_pitch"] / centimetre,
        tP=pinion["tooth_thickness"] / centimetre,
        tG=gear["tooth_thickness"] / centimetre,
        gamma2=pinion["pitch_cone_angle"],
        gamma3=gear["pitch_cone_angle"],
        r2=0.5 * pinion["pitch_diameter"] / centimetre,
        r3=0.5 * gear["pitch_diameter"] / centimetre,
        re2=0.5 * pinion["virtual_teeth"] / x["pd"],
        re3=0.5 * gear["virtual_teeth"] / x["pd"],
    )


def test_gleasons_bevel_teeth_by_name():
    found = analysed("bevel_pair", teeth=[20, 40], module=3.0, tooth_system="gleason")
    assert found["tooth_system"] == "gleason"
    assert [gear["addendum"] for gear in found["gears"]] == [pytest.approx(4.035), pytest.approx(1.965)]


def test_equal_bevel_gears_have_equal_cones_of_45_degrees():
    one, other = analysed("bevel_pair", teeth=[30, 30], module=3.0)["gears"]
    assert one["pitch_cone_angle"] == pytest.approx(45.0)
    assert one["addendum"] + one["dedendum"] == pytest.approx(2.188 * 3.0)
    assert one["outside_diameter"] == pytest.approx(90.0 + 2.0 * one["addendum"] * math.sqrt(0.5))
    assert other["virtual_teeth"] == pytest.approx(30.0 * math.sqrt(2.0))


def test_a_worm_locks_below_the_angle_of_friction():
    given = {"threads": 1, "gear_teeth": 40, "axial_pitch": 10.0, "worm_diameter": 60.0}
    found = analysed("worm_set", **given, friction=0.1)
    assert found["ratio"] == 40.0
    assert math.tan(math.radians(found["lead_angle"])) == pytest.approx(10.0 / (math.pi * 60.0))
    assert found["self_locking"] is True
    assert analysed("worm_set", **given, friction=0.04)["self_locking"] is False
    assert found["centre_distance"] == pytest.approx(30.0 + 200.0 / math.pi)


def test_what_cannot_be_is_refused_with_its_field():
    with pytest.raises((StatedError, MechanismError)) as caught:
        analysed("helical_pair", teeth=[20, 30], normal_module=2.0, helix_angle=-20.0, shaft_angle=80.0)
    assert caught.value.path == "/helix_angle"
    request = parse_request({"mechanism": {"type": "bevel_pair", "teeth": [40, 20], "module": 2.0}})
    assert [path for path, _ in request.find_errors()] == ["/mechanism/teeth"]


def test_a_diametral_pitch_replaces_the_module():
    by_module, by_pitch = (
        analysed("gear_pair", teeth=[20, 50], face_width=1.0, **size)
        for size in ({"module": 1.0 / 8.0}, {"diametral_pitch": 8.0})
    )
    assert by_pitch == by_module
    assert by_pitch["standard_distance"] == pytest.approx(70.0 / 16.0)
    # Both may be posted again together, but must agree.
    analysed("gear_pair", teeth=[20, 50], module=0.125, diametral_pitch=8.0)
    with pytest.raises(ValueError, match="either module or diametral_pitch"):
        analysed("gear_pair", teeth=[20, 50], module=2.0, diametral_pitch=8.0)
