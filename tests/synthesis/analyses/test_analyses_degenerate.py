"""Mechanisms at the edge of what each type is: the answer is right, or it is refused and said why; soon either way.

Right means: links stay rigid, joints on their slides and gears in mesh wherever a position is given, in every unit of
length and far from the origin; numbers are finite where they are given, and null where they are not.
"""

import copy
import json
import math
import time
from itertools import combinations

import numpy as np
import pytest
from pydantic import ValidationError
from pydantic_core import to_json

from kinematics.errors import MechanismError as KinematicsError
from kinematics.linkage.planar.limits import find_branches
from kinematics.linkage.planar.mechanism import GROUND
from synthesis.analyses import parse_request
from synthesis.analyses.linkages.linkage import LinkageAnalysis
from synthesis.mechanisms import MechanismError
from tests.kinematics.mechanism_sampling import EVERY
from tests.support.kinematics.branches import on_whole_numbers

REFUSED = (ValidationError, MechanismError, KinematicsError)

SOON_S = 3.0
"""Processor time of an answer at most; the ordinary ones take a hundredth of it."""

RIGID = 1e-9
"""Change of a distance as a share of the size and of the distance from the origin, beside rounding there."""


def on_pivots(kind, ground, **fields):
    return {"type": kind, "fixed_pivots": {"input": [0.0, 0.0], "output": [ground, 0.0]}, **fields}


def fourbar(a, b, c, d, distance=1.0, angle=20.0, **fields):
    point = {"distance": distance, "angle": angle}
    links = {"input": a, "coupler": b, "output": c}
    return on_pivots("fourbar", d, links=links, coupler_point=point, **fields)


def slider_crank(crank, coupler, offset, **fields):
    slide = {"point": [0.5, offset], "angle": 0.0}
    links = {"crank": crank, "coupler": coupler}
    return {"type": "slider_crank", "fixed_pivot": [0.0, 0.0], "links": links, "slide": slide, **fields}


def inverted(crank, output, angle, ground, **fields):
    links = {"input": crank, "output": output}
    return on_pivots("inverted_slider_crank", ground, links=links, slide={"angle": angle}, **fields)


def quick_return(kind, crank, rocker, coupler, ground, height, angle=0.0):
    links = {"crank": crank, "rocker": rocker, "coupler": coupler}
    return on_pivots(kind, ground, links=links, slide={"point": [0.0, height], "angle": angle})


def fivebar(a, b, c, d, ground, ratio, phase, **fields):
    links = {"input": a, "coupler_1": b, "coupler_2": c, "output": d}
    return on_pivots("geared_fivebar", ground, links=links, gear_ratio=ratio, phase=phase, **fields)


STATED = {
    "parallelogram": fourbar(2.0, 6.0, 2.0, 6.0),
    "parallelogram, at a change point": fourbar(2.0, 6.0, 2.0, 6.0, reference_input_angle=0.0),
    "antiparallelogram": fourbar(2.0, 6.0, 2.0, 6.0, assembly="crossed"),
    "parallelogram with a long crank": fourbar(6.0, 2.0, 6.0, 2.0),
    "rhombus": fourbar(1.0, 1.0, 1.0, 1.0),
    "kite": fourbar(2.0, 2.0, 6.0, 6.0),
    "kite with equal crank and ground": fourbar(2.0, 5.0, 5.0, 2.0),
    "crank as long as its coupler": fourbar(2.0, 2.0, 3.0, 2.5),
    "S + L = P + Q": fourbar(2.0, 5.0, 3.0, 6.0),
    "pivots on each other": fourbar(2.0, 2.5, 3.0, 0.0),
    "point on A": fourbar(2.0, 7.0, 9.0, 6.0, 0.0, 0.0),
    "point on B": fourbar(2.0, 7.0, 9.0, 6.0, 7.0, 0.0),
    "point on the coupler's line": fourbar(2.0, 7.0, 9.0, 6.0, 3.0, 180.0),
    "just one position": fourbar(1.0, 2.0, 3.0, 6.0),
    "too short to close": fourbar(1.0, 1.0, 1.0, 6.0),
    "a coupler without length": fourbar(2.0, 0.0, 2.0, 6.0),
    "a coupler of a hair": fourbar(2.0, 1e-9, 5.0, 6.0),
    "an output of a hair": fourbar(2.0, 5.0, 1e-9, 6.0),
    "a crank of a hair": fourbar(1e-9, 5.0, 4.0, 6.0),
    **{
        f"slider-crank, {name}{', driven by its slider' if driver == 'slider' else ''}": slider_crank(
            *lengths, driven_by=driver
        )
        for driver in ("crank", "slider")
        for name, lengths in {
            "crank as long as its coupler": (2.0, 2.0, 0.0),
            "crank as long as its coupler, offset": (2.0, 2.0, 0.5),
            "offset equal to the difference": (2.0, 5.0, 3.0),
            "offset equal to the other difference": (5.0, 2.0, 3.0),
            "offset equal to the sum": (2.0, 5.0, 7.0),
            "offset equal to the crank": (2.0, 5.0, 2.0),
            "offset beyond the sum": (2.0, 5.0, 7.5),
            "no crank": (0.0, 5.0, 1.0),
            "no coupler": (2.0, 0.0, 1.0),
            "a crank of a hair": (1e-9, 5.0, 0.0),
            "a coupler of a hair": (5.0, 1e-9, 0.0),
        }.items()
    },
    "inverted, crank as long as the ground": inverted(3.0, 0.0, 0.0, 3.0),
    "inverted, crank as long as the ground, offset": inverted(3.0, 1.0, 90.0, 3.0),
    "inverted, offset equal to the difference": inverted(2.0, 1.0, 90.0, 3.0),
    "inverted, offset equal to the sum": inverted(2.0, 5.0, 90.0, 3.0),
    "inverted, offset beyond the sum": inverted(2.0, 6.0, 90.0, 3.0),
    "inverted, slide along the output": inverted(2.0, 1.0, 0.0, 3.0),
    "inverted, pivots on each other": inverted(2.0, 1.0, 60.0, 0.0),
    "inverted, a crank of a hair": inverted(1e-9, 1.0, 60.0, 3.0),
    "crank-shaper, crank as long as the ground": quick_return("crank_shaper", 3.0, 5.0, 4.0, 3.0, 2.0),
    "crank-shaper, crank nearly as long": quick_return("crank_shaper", 3.0 * (1.0 - 1e-12), 5.0, 4.0, 3.0, 2.0),
    "crank-shaper, ram through the pivot": quick_return("crank_shaper", 1.0, 4.0, 4.0, 3.0, 0.0),
    "crank-shaper, ram reached by no angle of its rocker": quick_return("crank_shaper", 1.0, 3.0, 2.0, 3.0, 5.0),
    "crank-shaper, ram just reached": quick_return("crank_shaper", 1.0, 3.0, 2.0, 3.0, 3.0 * (1 - 1e-9)),
    "crank-shaper, ram beyond reach": quick_return("crank_shaper", 1.0, 3.0, 2.0, 3.0, 5.5),
    "crank-shaper, no rocker": quick_return("crank_shaper", 1.0, 0.0, 2.0, 3.0, 1.0),
    "Whitworth, pivots on each other": quick_return("whitworth", 1.0, 3.0, 4.0, 0.0, 1.0),
    "Whitworth, rocker as long as the coupler": quick_return("whitworth", 3.0, 4.0, 4.0, 2.0, 0.0),
    "Whitworth, crank hardly longer": quick_return("whitworth", 2.0 * (1.0 + 1e-12), 3.0, 4.0, 2.0, 1.0),
    "fivebar, all equal": fivebar(2.0, 2.0, 2.0, 2.0, 2.0, 1.0, 60.0),
    "fivebar, cranks in parallel": fivebar(1.0, 3.0, 3.0, 1.0, 4.0, 1.0, 0.0),
    "fivebar, always in line": fivebar(1.0, 2.0, 2.0, 1.0, 4.0, 1.0, 0.0),
    "fivebar, pins that meet": fivebar(2.0, 3.0, 3.0, 2.0, 4.0, -1.0, 180.0),
    "fivebar, couplers that fold": fivebar(1.0, 2.0, 4.0, 1.0, 4.0, -1.0, 0.0),
    "fivebar, pivots on each other": fivebar(1.0, 2.0, 4.0, 1.0, 0.0, -1.0, 0.0),
    "fivebar, gears that stand": fivebar(1.0, 3.0, 3.0, 1.0, 4.0, 0.0, 0.0),
    "fivebar, never closed": fivebar(1.0, 1.0, 1.0, 1.0, 9.0, 2.0, 0.0),
    "fivebar, a wild ratio": fivebar(1.0, 3.0, 3.0, 1.0, 4.0, 1e6, 0.0),
}
"""By their dimensions: equal lengths, lengths that just reach, none, and hairs."""

PLACES = {"as it is": (1.0, 0j), "small": (1e-6, 0j), "large": (1e6, 0j), "far": (1.0, complex(3e5, -4e5))}


def placed(statement, factor, origin):
    """The same mechanism in another unit of length and elsewhere: lengths are what is not an angle or a ratio."""
    moved = copy.deepcopy(statement)

    def point(z):
        return [factor * z[0] + origin.real, factor * z[1] + origin.imag]

    for name in ("fixed_pivots",):
        if name in moved:
            moved[name] = {key: point(z) for key, z in moved[name].items()}
    if "fixed_pivot" in moved:
        moved["fixed_pivot"] = point(moved["fixed_pivot"])
    if "slide" in moved and "point" in moved["slide"]:
        moved["slide"]["point"] = point(moved["slide"]["point"])
    if "coupler_point" in moved:
        moved["coupler_point"]["distance"] *= factor
    moved["links"] = {key: factor * length for key, length in moved.get("links", {}).items()}
    if "skeleton" in moved:
        skeleton = moved["skeleton"]
        skeleton["joints"] = {key: point(z) for key, z in skeleton["joints"].items()}
        for slide in skeleton["slides"]:
            slide["point"] = point(slide["point"])
    return moved


def by_skeleton(mechanism):
    def pair(z):
        return [complex(z).real, complex(z).imag]

    return {
        "type": "skeleton",
        "skeleton": {
            "joints": {name: pair(z) for name, z in mechanism.joints.items()},
            "links": [{"name": name, "joints": list(listed)} for name, listed in mechanism.links.items()],
            "slides": [
                {"joint": s.joint, "link": s.link, "point": pair(s.point), "angle": math.degrees(s.angle)}
                for s in mechanism.slides
            ],
            "gears": [{"links": [g.first, g.second], "ratio": g.ratio} for g in mechanism.gears],
            "input_link": mechanism.input,
        },
    }


def moved_rigidly(mechanism, found):
    """Distances on every link, along every slide and turns of every gear at the positions that are given."""
    valid = np.array(found["valid"])
    z = {n: np.array(t["x"], float)[valid] + 1j * np.array(t["y"], float)[valid] for n, t in found["joints"].items()}
    reference = {n: complex(joint) for n, joint in mechanism.joints.items()}
    size = max(abs(one - other) for one in reference.values() for other in reference.values())
    slack = RIGID * size + 1e-14 * max(map(abs, reference.values()))
    for listed in mechanism.links.values():
        for one, other in combinations(listed, 2):
            off = np.abs(z[one] - z[other]) - abs(reference[one] - reference[other])
            assert np.abs(off).max(initial=0.0) < slack, (one, other)
        one, other = max(
            combinations(listed, 2), key=lambda pair: abs(reference[pair[0]] - reference[pair[1]]), default=("", "")
        )
        if len(listed) > 2 and reference[one] != reference[other]:
            unit, there = reference[other] - reference[one], z[other] - z[one]
            for joint in listed:
                off = (z[joint] - z[one]) * unit - (reference[joint] - reference[one]) * there
                assert np.abs(off / unit).max(initial=0.0) < slack, "the same side"
    turned = {name: np.radians(np.array(link["angle"], float)[valid]) for name, link in found["links"].items()}
    for slide in mechanism.slides:
        along = complex(math.cos(slide.angle), math.sin(slide.angle))
        if slide.link == GROUND:
            across = ((z[slide.joint] - complex(slide.point)) / along).imag
        else:
            pin = mechanism.links[slide.link][0]
            turn = np.exp(1j * (turned[slide.link] - float(mechanism.link_angle(slide.link))))
            line = z[pin] + (complex(slide.point) - reference[pin]) * turn
            across = ((z[slide.joint] - line) / (along * turn)).imag
        assert np.abs(across).max(initial=0.0) < slack + 1e-6 * size * (not valid.any()), slide.joint
    for gear in mechanism.gears:
        first, second = (turned[n] - float(mechanism.link_angle(n)) for n in (gear.first, gear.second))
        if mechanism.input == gear.first:
            first = np.radians(np.array(found["input_angle"])[valid]) - float(mechanism.reference_input)
        off = np.exp(1j * (second - gear.ratio * first)) - 1.0
        assert np.abs(off).max(initial=0.0) < 1e-9 * (1.0 + abs(gear.ratio)), gear


def numbers(value):
    """Every list of numbers in an answer."""
    if isinstance(value, dict):
        for one in value.values():
            yield from numbers(one)
    elif isinstance(value, list) and value and not isinstance(value[0], dict | list):
        yield value


def right_or_refused(statement, steps=72):
    """Whether it was answered; by then the answer is known to be sound, or what was raised says why."""
    body = {"mechanism": statement, "motion": {"from": -180.0, "to": 180.0, "steps": steps}}
    begun = time.process_time()
    try:
        request = parse_request(body)
        mechanism = request.mechanism.build_mechanism()
        if mechanism.has_slide_input:
            request = parse_request({"mechanism": statement})
        found = request.build_answer()
    except REFUSED:
        assert time.process_time() - begun < SOON_S
        return False
    assert time.process_time() - begun < SOON_S
    text = to_json(found, inf_nan_mode="null")
    LinkageAnalysis.model_validate(json.loads(text))
    valid = np.array(found["valid"])
    for track in found["joints"].values():
        for field in ("x", "y"):
            np.testing.assert_array_equal(np.isfinite(np.array(track[field], float)), valid)
    for link in found["links"].values():
        np.testing.assert_array_equal(np.isfinite(np.array(link["angle"], float)), valid)
    for listed in (found["input_angle"], found["toggles"]):
        assert np.isfinite(listed).all()
    for circuit in found["circuits"]:
        for branch in circuit["branches"]:
            assert math.isfinite(branch["from"])
            assert math.isfinite(branch["to"])
    for span in found["limits"].values():
        assert span is None or np.isfinite(span).all()
    moved_rigidly(mechanism, found)
    return True


NONE = (
    "too short to close",
    "a coupler without length",
    "pivots on each other",
    "slider-crank, offset beyond the sum",
    "slider-crank, no crank",
    "slider-crank, no coupler",
    "inverted, offset beyond the sum",
    "crank-shaper, ram reached by no angle of its rocker",
    "crank-shaper, ram beyond reach",
    "crank-shaper, no rocker",
    "fivebar, pivots on each other",
    "fivebar, never closed",
)
"""What is refused in any unit: lengths that nowhere close, and none. All others are mechanisms, and are answered."""


@pytest.mark.parametrize("name", STATED)
def test_at_the_edge_of_a_type_only_what_does_not_exist_is_refused(name):
    answered = {place: right_or_refused(placed(STATED[name], *PLACES[place])) for place in PLACES}
    assert set(answered.values()) == {name.removesuffix(", driven by its slider") not in NONE}, answered


@pytest.mark.parametrize("name", EVERY)
def test_joints_on_whole_numbers(name):
    """Pins on each other, links of one length, all in line: the same verdict in every unit, and some are answered."""
    rng = np.random.default_rng([81, list(EVERY).index(name)])
    verdicts = []
    for _ in range(5):
        try:
            statement = by_skeleton(on_whole_numbers(name, rng))
        except KinematicsError:
            continue
        verdicts.append({right_or_refused(placed(statement, *PLACES[place]), 24) for place in PLACES})
    assert all(len(verdict) == 1 for verdict in verdicts)
    assert {True} in verdicts


def test_a_reference_is_found_in_less_than_a_degree():
    """Where the lengths close in a small part of a turn that holds no whole degree, it is not said that they do not."""
    for name, at in (("a coupler of a hair", 5.0), ("an output of a hair", 5.0)):
        found = parse_request({"mechanism": STATED[name], "motion": {"at": 0.0}}).build_answer()
        (limits,) = [span for circuit in found["circuits"] for span in circuit["branches"] if span["reference"]]
        assert 0.0 < limits["to"] - limits["from"] < 1e-6
        # Pins on each other: the law of cosines in the triangle of input, ground and the long link.
        crank, ground = 2.0, 6.0
        angle = math.degrees(math.acos((crank**2 + ground**2 - at**2) / (2.0 * crank * ground)))
        middle = 0.5 * (limits["from"] + limits["to"])
        assert min(abs(middle - angle), abs(middle - 360.0 + angle)) < 1e-6


@pytest.mark.parametrize("reference", [None, 30.0, 200.0, -160.0, 390.0, -500.0])
@pytest.mark.parametrize("with_skeleton", [False, True])
def test_gears_count_full_turns_of_the_stated_input(reference, with_skeleton):
    """θ5 = λ θ2 + φ at whatever absolute input angle, also where the reference's is beyond half a turn."""
    statement = fivebar(1.0, 7.0, 9.0, 4.0, 6.0, 0.5, 60.0)
    if reference is not None:
        statement["reference_input_angle"] = reference
    if with_skeleton and reference is not None:
        bare = parse_request({"mechanism": statement}).mechanism.build_mechanism()
        statement["skeleton"] = by_skeleton(bare)["skeleton"]
    for at in (30.0, 200.0, 390.0, -160.0, 1000.0):
        found = parse_request({"mechanism": statement, "motion": {"at": at}}).build_answer()
        arm = complex(found["joints"]["B"]["x"][0] - 6.0, found["joints"]["B"]["y"][0]) / 4.0
        assert arm == pytest.approx(np.exp(1j * math.radians(0.5 * at + 60.0)), abs=1e-12)


def test_a_wild_gear_ratio_is_driven_but_not_searched():
    found = parse_request({"mechanism": STATED["fivebar, a wild ratio"]}).build_answer()
    assert found["circuits"] == []
    assert any(note.startswith("circuits, toggles, limits: ") for note in found["notes"])
    mechanism = parse_request({"mechanism": STATED["fivebar, a wild ratio"]}).mechanism.build_mechanism()
    with pytest.raises(KinematicsError, match="more than 1000 times"):
        find_branches(mechanism)
