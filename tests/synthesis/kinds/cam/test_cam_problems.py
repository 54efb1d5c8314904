"""Statements of cam problems: what is refused, and that the refusal names the field."""

from __future__ import annotations

import copy
import math

import pytest
from pydantic import ValidationError

from kinematics.cam.motion.laws import LAWS
from kinematics.cam.motion.segments import Condition, build_polynomial_segment
from synthesis.dispatch import solve
from synthesis.kinds.cam.statement.segment_ends import END_RATES, compute_polynomial_ends
from synthesis.kinds.cam.statement.segments import Law
from synthesis.registry import KINDS, parse_problem

DOUBLE_DWELL = KINDS["cam"].problem.model_config["json_schema_extra"]["examples"][0]


def stated(**changes):
    statement = copy.deepcopy(DOUBLE_DWELL)
    for path, value in changes.items():
        *way, last = path.split("__")
        place = statement
        for step in way:
            place = place[int(step) if step.isdigit() else step]
        if isinstance(place, list):
            place[int(last)] = value
        else:
            place[last] = value
    return parse_problem(statement)


def test_examples_are_sound():
    examples = KINDS["cam"].problem.model_config["json_schema_extra"]["examples"]
    assert len(examples) >= 4
    for example in examples:
        assert parse_problem(example).find_contradictions() == []


def test_laws_are_those_of_the_analysis_core():
    assert set(END_RATES) == set(LAWS)
    assert set(Law.__args__) == {"auto", "optimal", *LAWS}


@pytest.mark.parametrize("name", LAWS)
def test_rates_at_the_ends_are_the_laws_own(name):
    law = LAWS[name]
    first, last = law.pieces.motion(0.0), law.pieces.motion(1.0, before=True)
    assert (first.v, first.a, last.v, last.a) == pytest.approx(END_RATES[name], abs=1e-9)


def test_ends_of_polynomials_are_the_analysis_cores():
    conditions = [
        (0.0, 0, 1.0),
        (0.0, 1, 0.3),
        (0.0, 2, 0.0),
        (0.7, 0, 1.6),
        (1.3, 0, 2.0),
        (1.3, 1, 0.0),
        (1.3, 2, -2.0),
    ]
    first, last = compute_polynomial_ends(1.3, conditions)
    pieces = build_polynomial_segment(1.3, [Condition(*c) for c in conditions]).pieces
    assert first == pytest.approx([float(x) for x in pieces.motion(0.0)[:3]], abs=1e-12)
    assert last == pytest.approx([float(x) for x in pieces.motion(1.3, before=True)[:3]], abs=1e-11)
    assert compute_polynomial_ends(1.0, [(0.5, 1, 1.0), (0.5, 1, 1.0)]) is None


def up_and_down(lift, **fields):
    """A polynomial that rises, turns and falls between two rests of the same height, and a dwell."""
    rest = {"s": 0.0, "v": 0.0, "a": 0.0}
    conditions = [{"angle": 0.0} | rest, {"angle": 97.3, "s": lift, "v": 0.0}, {"angle": 206.281} | rest]
    segments = [
        {"motion": "polynomial", "angle": 206.281, "conditions": conditions},
        {"motion": "dwell", "angle": 153.719},
    ]
    return {"kind": "cam", "segments": segments, "follower": {"type": "translating_flat"}} | fields


@pytest.mark.parametrize("lift", [1e-6, 0.0257, 25.7, 1e6])
def test_a_polynomial_that_comes_back_joins_a_dwell(lift):
    """Rounding of its ends is small beside what it travels between them."""
    problem = parse_problem(up_and_down(lift, length_unit="m"))
    assert problem.find_contradictions() == []
    assert problem.program.travel == pytest.approx(lift, rel=0.02)


def test_the_least_radius_under_a_face_is_a_share_of_what_a_polynomial_travels():
    (design,) = solve(parse_problem(up_and_down(25.0)), lambda fraction, message: None).designs
    assert design.metrics.min_convex_radius == pytest.approx(0.02 * design.metrics.lift, rel=0.01)


FAULTS = [
    ({"segments__0__angle": 80.0}, "/segments", "350"),
    ({"segments__1__law": "simple_harmonic"}, "/segments/1", "acceleration jumps"),
    ({"segments__1__law": "constant_acceleration"}, "/segments/1", "acceleration jumps"),
    ({"segments__1__law": "half_cycloidal_start"}, "/segments/2", "velocity jumps"),
    ({"segments__3__lift": 20.0}, "/segments/0", "must end where it began"),
    ({"segments__1__lift": None}, "/segments/1/lift", "needs a lift"),
    ({"segments__1": {"motion": "fall", "angle": 90.0, "lift": 25.0}}, "/segments/3/lift", "already at zero"),
    (
        {"segments__1__conditions": [{"angle": 45.0, "s": 12.0}]},
        "/segments/1/conditions",
        "optimal",
    ),
    (
        {
            "segments__1": {
                "motion": "rise",
                "angle": 90.0,
                "lift": 25.0,
                "law": "optimal",
                "conditions": [{"angle": 95.0, "s": 1.0}],
            }
        },
        "/segments/1/conditions/0/angle",
        "within",
    ),
    (
        {
            "segments__1": {
                "motion": "rise",
                "angle": 90.0,
                "lift": 25.0,
                "law": "optimal",
                "bands": [{"start": 50.0, "end": 40.0, "upper": 1.0}],
            }
        },
        "/segments/1/bands/0/end",
        "after start",
    ),
    (
        {
            "segments__1": {
                "motion": "polynomial",
                "angle": 90.0,
                "conditions": [{"angle": 10.0, "v": 1.0}, {"angle": 10.0, "v": 2.0}],
            }
        },
        "/segments/1/conditions",
        "one polynomial",
    ),
    ({"follower__prime_radius": 8.0}, "/follower/prime_radius", "larger than the roller"),
    (
        {"follower": {"type": "translating_roller", "roller_radius": 5.0, "prime_radius": 50.0, "offset": "free"}},
        "/follower/offset",
        "free prime",
    ),
    (
        {"follower": {"type": "translating_roller", "roller_radius": {"min": 5.0, "max": 4.0}}},
        "/follower/roller_radius/max",
        "above min",
    ),
    ({"minimize": "peak_contact_force"}, "/dynamics", "mass and spring"),
    ({"limits": {"velocity": 40.0}}, "/limits/velocity", "all laws are given"),
    ({"limits": {"acceleration": 90.0}}, "/limits/acceleration", "all laws are given"),
    ({"limits": {"jerk": 2000.0}}, "/limits/jerk", "all laws are given"),
    ({"dynamics": {"mass": 1.0}, "speed_rpm": None}, "/speed_rpm", "speed"),
]


@pytest.mark.parametrize(("changes", "path", "detail"), FAULTS, ids=[f"{row[1]} {row[2]}" for row in FAULTS])
def test_faults_name_the_field(changes, path, detail):
    found = stated(**changes).find_contradictions()
    assert path in [fault.path for fault in found]
    assert any(detail in fault.detail for fault in found if fault.path == path)


FOLLOWERS = {
    "translating_roller": {"roller_radius": 5.0},
    "oscillating_roller": {"roller_radius": 5.0, "arm": 80.0, "pivot_distance": 100.0},
    "translating_flat": {},
    "oscillating_flat": {"pivot_distance": 120.0},
    "barrel_roller": {"roller_radius": 5.0},
}


def jumping(law, follower, **fields):
    """A double dwell by a law that jumps, for a follower."""
    segments = [
        {"motion": "dwell", "angle": 90.0},
        {"motion": "rise", "angle": 90.0, "lift": 10.0, "law": law},
        {"motion": "dwell", "angle": 90.0},
        {"motion": "return", "angle": 90.0, "law": "cycloidal"},
    ]
    return parse_problem(
        {
            "kind": "cam",
            "segments": segments,
            "follower": {"type": follower, **FOLLOWERS[follower]},
            "accept_discontinuity": True,
            **fields,
        }
    )


@pytest.mark.parametrize("follower", FOLLOWERS)
@pytest.mark.parametrize("law", ["simple_harmonic", "constant_acceleration"])
def test_jumps_of_acceleration_that_are_accepted_give_a_cam(law, follower):
    result = solve(jumping(law, follower), lambda fraction, message: None)
    (design,) = result.designs
    assert design.verification.passed


@pytest.mark.parametrize("follower", ["translating_flat", "oscillating_flat"])
def test_a_velocity_that_jumps_up_is_followed_by_a_face(follower):
    result = solve(jumping("half_harmonic_end", follower), lambda fraction, message: None)
    assert result.designs[0].verification.passed


@pytest.mark.parametrize(
    ("law", "follower", "fields"),
    [
        *(("constant_velocity", follower, {}) for follower in FOLLOWERS),
        *(("half_harmonic_start", follower, {}) for follower in FOLLOWERS),
        ("half_harmonic_end", "translating_roller", {"closure": "form"}),
        ("half_harmonic_end", "barrel_roller", {}),
    ],
)
def test_jumps_that_no_follower_keeps_to_are_refused(law, follower, fields):
    (fault, *_) = jumping(law, follower, **fields).find_contradictions()
    assert "edge that no follower can track" in fault.detail


@pytest.mark.parametrize("law", ["double_harmonic", "eighth_power"])
def test_a_fall_by_the_name_of_its_rise_mirrors_it(law):
    """Norton's rise-fall-dwell: the accelerations meet at the top, and both ends join the dwell."""
    named, mirrored = (
        parse_problem(
            {
                "kind": "cam",
                "segments": [
                    {"motion": "rise", "angle": 120.0, "lift": 10.0, "law": law},
                    {"motion": "fall", "angle": 120.0, "lift": 10.0, "law": fall},
                    {"motion": "dwell", "angle": 120.0},
                ],
                "follower": {"type": "translating_flat"},
            }
        )
        for fall in (law, f"{law}_reversed")
    )
    assert named.find_contradictions() == []
    assert named.program.list_laws() == [law, f"{law}_reversed", "dwell"]
    found, same = (solve(problem, lambda fraction, message: None) for problem in (named, mirrored))
    assert found.designs[0].verification.passed
    assert found.designs[0].mechanism == same.designs[0].mechanism
    assert found.designs[0].segments[1].law == f"{law}_reversed"


@pytest.mark.parametrize("law", ["double_harmonic", "eighth_power"])
def test_a_fall_that_its_neighbours_join_as_it_rises_is_taken_so(law):
    """From a dwell down to a turn at the bottom, without rest there."""
    problem = parse_problem(
        {
            "kind": "cam",
            "segments": [
                {"motion": "rise", "angle": 120.0, "lift": 10.0, "law": f"{law}_reversed"},
                {"motion": "dwell", "angle": 120.0},
                {"motion": "return", "angle": 120.0, "law": law},
            ],
            "follower": {"type": "translating_flat"},
        }
    )
    assert problem.find_contradictions() == []
    assert problem.program.list_laws() == [f"{law}_reversed", "dwell", law]


def test_an_optimal_arm_is_not_sized_with_its_motion():
    follower = {"type": "oscillating_roller", "roller_radius": 5.0, "arm": 60.0, "pivot_distance": 80.0}
    segments = [dict(segment) for segment in DOUBLE_DWELL["segments"]]
    segments[1] = {"motion": "rise", "angle": 90.0, "lift": 20.0, "law": "optimal"}
    assert stated(follower=follower, segments=segments, minimize="size").find_contradictions()[0].path == "/minimize"


@pytest.mark.parametrize(
    ("changes", "where"),
    [
        ({"segments__1__law": "unheard_of"}, "law"),
        ({"segments__1__angle": -1.0}, "angle"),
        ({"segments__1__angle": math.inf}, "angle"),
        ({"follower__type": "magnetic"}, "follower"),
        ({"limits__pressure_angle": 90.0}, "pressure_angle"),
        ({"minimize": "beauty"}, "minimize"),
        ({"follower__offst": 1.0}, "offst"),
        ({"segments": []}, "segments"),
    ],
)
def test_ill_formed_statements_are_refused(changes, where):
    with pytest.raises(ValidationError) as fault:
        stated(**changes)
    assert where in str(fault.value.errors()[0]["loc"]) + str(fault.value.errors()[0]["msg"])


@pytest.mark.slow
@pytest.mark.parametrize("law", ["simple_harmonic", "auto", "optimal"])
def test_a_spring_that_holds_more_than_is_asked_for_has_no_negative_preload(law):
    """The stiff spring alone keeps the follower on the cam: the value is the greatest force, the bound below it."""
    segments = [{"motion": motion, "angle": 180.0, "lift": 20.0, "law": law} for motion in ("rise", "fall")]
    statement = {
        "kind": "cam",
        "segments": segments,
        "follower": FOLLOWERS["translating_roller"] | {"type": "translating_roller"},
        "limits": {} if law == "simple_harmonic" else {"jerk": 200.0},
        "minimize": "peak_contact_force",
        "speed_rpm": 60.0,
        "dynamics": {"mass": 2.0, "spring_rate": 10.0},
    }
    (design,) = solve(parse_problem(statement), lambda fraction, message: None).designs
    forces, optimality = design.metrics.forces, design.optimality
    assert forces.preload == pytest.approx(0.0, abs=1e-9)
    assert optimality.value == pytest.approx(forces.max_contact_force, rel=1e-12)
    assert optimality.gap is None or 0.0 <= optimality.gap < 1e-3


@pytest.mark.parametrize("follower", ["translating_flat", "oscillating_flat"])
def test_a_face_has_a_base_circle_that_is_no_point(follower):
    """A circle that turns about a point beside its middle has curvature enough with any base circle."""
    segments = [
        {"motion": motion, "angle": 180.0, "lift": 10.0, "law": "simple_harmonic"} for motion in ("rise", "fall")
    ]
    statement = {"kind": "cam", "segments": segments, "follower": FOLLOWERS[follower] | {"type": follower}}
    (design,) = solve(parse_problem(statement), lambda fraction, message: None).designs
    travel = math.radians(10.0) * 120.0 if follower == "oscillating_flat" else 10.0
    assert design.mechanism.base_radius == pytest.approx(1e-3 * travel, rel=1e-3)


def critical_path(*, start: float | None = None) -> dict:
    """Norton, Example 8-9: 10 in/s for half of a turn of one second, and back from where the rise ends."""
    rate = 5.0 / math.pi
    back = [
        {"angle": 0, "v": rate, "a": 0} | ({} if start is None else {"s": start}),
        {"angle": 150, "s": 0, "v": 0, "a": 0},
    ]
    return {
        "kind": "cam",
        "length_unit": "in",
        "segments": [
            {
                "motion": "polynomial",
                "angle": 30,
                "conditions": [{"angle": 0, "s": 0, "v": 0, "a": 0}, {"angle": 30, "v": rate, "a": 0}],
            },
            {"motion": "constant_velocity", "angle": 180, "lift": 5},
            {"motion": "polynomial", "angle": 150, "conditions": back},
        ],
        "follower": {"type": "translating_roller", "roller_radius": 0.25},
    }


def test_a_polynomial_continues_from_the_previous_segment():
    open_start = parse_problem(critical_path())
    assert open_start.find_contradictions() == []
    # The acceleration covers half of what constant velocity would: 5/12 in. The textbook rounds it to 5.416667.
    assert open_start.program.heights()[2] == pytest.approx((5.0 + 5.0 / 12.0, 0.0), abs=1e-12)
    typed = parse_problem(critical_path(start=65.0 / 12.0))
    results = [solve(problem).designs[0].metrics for problem in (open_start, typed)]
    assert results[0].peak_acceleration == pytest.approx(results[1].peak_acceleration, rel=1e-9)
    assert results[0].lift == pytest.approx(results[1].lift, rel=1e-9)
    # A wrong height is still refused, where the segment begins.
    faults = parse_problem(critical_path(start=5.0)).find_contradictions()
    assert [fault.path for fault in faults] == ["/segments/2"]


def test_a_polynomial_with_only_its_end_stated_moves():
    statement = critical_path()
    statement["segments"] = [
        {"motion": "dwell", "angle": 90},
        {"motion": "polynomial", "angle": 90, "conditions": [{"angle": 0, "v": 0}, {"angle": 90, "s": 1, "v": 0}]},
        {"motion": "dwell", "angle": 90},
        {"motion": "polynomial", "angle": 90, "conditions": [{"angle": 0, "v": 0}, {"angle": 90, "s": 0, "v": 0}]},
    ]
    statement["accept_discontinuity"] = True
    problem = parse_problem(statement)
    assert problem.find_contradictions() == []
    heights = [height for pair in problem.program.heights() for height in pair]
    assert heights == pytest.approx([0, 0, 0, 1, 1, 1, 1, 0], abs=1e-12)


def test_a_damping_coefficient_is_that_of_its_ratio():
    """c = 2 ζ √(k m), with the mass in N s²/mm."""
    loaded = {"mass": 0.5, "spring_rate": 20.0, "preload": 100.0}
    coefficient = 2.0 * 0.2 * math.sqrt(20.0 * 0.5e-3)
    by_ratio, by_coefficient = (
        solve(stated(dynamics=loaded | damping, speed_rpm=200.0)).designs[0].metrics.forces
        for damping in ({"damping_ratio": 0.2}, {"damping": coefficient})
    )
    for name in ("min_contact_force", "max_contact_force", "max_torque", "damped_frequency"):
        assert getattr(by_coefficient, name) == pytest.approx(getattr(by_ratio, name), rel=1e-12)
    undamped = solve(stated(dynamics=loaded, speed_rpm=200.0)).designs[0].metrics.forces
    assert undamped.max_torque != pytest.approx(by_ratio.max_torque, rel=1e-3)


@pytest.mark.parametrize("more", [{"damping_ratio": 0.1}, {"spring_rate": "free"}])
def test_a_damping_coefficient_needs_a_given_spring_and_no_ratio(more):
    dynamics = {"mass": 0.5, "spring_rate": 20.0, "damping": 0.5} | more
    faults = stated(dynamics=dynamics, speed_rpm=200.0).find_contradictions()
    assert "/dynamics/damping" in [fault.path for fault in faults]
