"""Cams from statement to verified design, and the verification held against cams that were tampered with."""

from __future__ import annotations

import math

import numpy as np
import pytest

from kinematics.cam.motion.laws import LAWS
from kinematics.cam.motion.segments import build_law_segment
from synthesis.dispatch import solve
from synthesis.kinds.cam.verification.verify import verify
from synthesis.registry import KINDS, parse_problem
from tests.campaign import further

EXAMPLES = KINDS["cam"].problem.model_config["json_schema_extra"]["examples"]
DOUBLE_DWELL, RISE_FALL_DWELL, CRITICAL_PATH, VALVE = EXAMPLES[:4]


def cam(statement=None, **changes):
    return parse_problem({**(statement or DOUBLE_DWELL), **changes})


def answered(problem):
    return solve(problem, lambda fraction, message: None)


def only(result):
    assert result.summary
    (design,) = result.designs
    assert design.verification.passed
    return design


def moves(rise_law, fall_law, lift=25.0, rise=90.0, fall=90.0):
    rest = 0.5 * (360.0 - rise - fall)
    return [
        {"motion": "dwell", "angle": rest},
        {"motion": "rise", "angle": rise, "lift": lift, "law": rise_law},
        {"motion": "dwell", "angle": rest},
        {"motion": "fall", "angle": fall, "lift": lift, "law": fall_law},
    ]


@pytest.mark.slow
@pytest.mark.parametrize("example", EXAMPLES[:4], ids=["double dwell", "rise-fall-dwell", "critical path", "valve"])
def test_examples_are_solved_and_verified(example):
    result = answered(cam(example))
    design = only(result)
    reproduced = next(c for c in design.verification.checks if c.name == "reproduces_program")
    assert reproduced.value <= 1e-6
    assert result.search.sizing_proven
    assert result.search.accepted == 1
    if design.optimality.bound is not None:
        assert design.optimality.bound <= design.optimality.value
        assert design.optimality.gap <= 2e-3


def test_critical_path_motion_of_norton():
    """Example 8-10: 190.1 in/s² under a jerk of 4800 in/s³; the polynomial of the book needs 230.9."""
    rate = 2.0 * math.pi
    design = only(answered(cam(CRITICAL_PATH)))
    assert design.optimality.value * rate**2 == pytest.approx(190.1, rel=2e-3)
    segments = [CRITICAL_PATH["segments"][0], {"motion": "return", "angle": 180.0, "law": "auto"}]
    book = only(answered(cam(CRITICAL_PATH, segments=segments, limits={"pressure_angle": 30.0})))
    assert book.segments[1].law == "polynomial"
    assert book.metrics.peak_acceleration * rate**2 == pytest.approx(230.9, abs=0.05)


@pytest.mark.parametrize(("minimize", "order"), [("peak_velocity", 0), ("peak_acceleration", 1), ("peak_jerk", 2)])
def test_auto_takes_the_best_law(minimize, order):
    design = only(answered(cam(segments=moves("auto", "auto"), minimize=minimize)))
    smooth = {
        name: law.factors[order].largest
        for name, law in LAWS.items()
        if abs(law.pieces.motion(0.0).a) < 1e-9
        and abs(law.pieces.motion(1.0, before=True).a) < 1e-9
        and law.pieces.motion(1.0, before=True).v < 1e-9
        and law.pieces.motion(0.0).v < 1e-9
    }
    best = min(smooth, key=lambda name: smooth[name])
    assert [segment.law for segment in design.segments if segment.motion != "dwell"] == [best, best]


def test_auto_rise_and_fall_without_a_dwell_match_at_the_top():
    """Norton Example 8-6: the double harmonic and its mirror meet at the top with one acceleration."""
    segments = [
        {"motion": "rise", "angle": 90.0, "lift": 1.0},
        {"motion": "fall", "angle": 90.0, "lift": 1.0},
        {"motion": "dwell", "angle": 180.0},
    ]
    design = only(answered(cam(RISE_FALL_DWELL, segments=segments, limits={"pressure_angle": 35.0, "jerk": 50.0})))
    joint = next(joint for joint in design.joints if joint.segments == (0, 1))
    assert {"s", "v", "a"} <= set(joint.continuous)
    assert design.metrics.peak_acceleration <= 2.0 * math.pi / (0.5 * math.pi) ** 2


@pytest.mark.campaign
def test_motion_and_size_together():
    """Unit lift in 60° at 20° under modified sine's own peaks: 3.647; with modified sine itself 4.142."""
    beta = math.pi / 3.0
    v, a, j = (factor.largest for factor in LAWS["modified_sine"].factors)
    sizes = {"pressure_angle": 20.0, "curvature_ratio": 0.0}
    limits = {**sizes, "acceleration": a / beta**2, "jerk": j / beta**3}
    follower = {"type": "translating_roller", "roller_radius": 0.3}
    segments = moves("optimal", "modified_sine", 1.0, 60.0, 200.0)
    design = only(answered(cam(segments=segments, follower=follower, limits=limits, minimize="size")))
    assert design.mechanism.prime_radius == pytest.approx(3.647, rel=2e-3)
    assert design.optimality.bound == pytest.approx(3.647, rel=2e-3)
    assert design.metrics.peak_velocity * beta < v
    segments = moves("modified_sine", "modified_sine", 1.0, 60.0, 200.0)
    law = only(answered(cam(segments=segments, follower=follower, limits=sizes, minimize="size")))
    assert law.mechanism.prime_radius == pytest.approx(4.142, abs=5e-4)


def test_no_motion_keeps_the_limits():
    beta = 0.5 * math.pi
    limits = {"acceleration": 3.9 * 25.0 / beta**2}
    result = answered(cam(segments=moves("optimal", "cycloidal"), limits=limits))
    assert result.designs == []
    assert result.search.complete
    assert "1.0256" in result.summary


@pytest.mark.campaign
def test_a_cam_that_must_be_small_is_proven_not_to_exist():
    result = answered(cam(limits={"pressure_angle": 30.0, "size": 40.0}))
    assert result.designs == []
    assert result.search.complete
    assert result.search.rejected == {"size": 1}
    shown = answered(cam(limits={"pressure_angle": 30.0, "size": 40.0}, include_failed=True))
    assert not shown.designs[0].verification.passed
    assert answered(cam(limits={"pressure_angle": 30.0, "size": 44.0})).search.accepted == 1


FOLLOWERS = [
    {"type": "translating_roller", "roller_radius": 8.0, "offset": 6.0},
    {"type": "translating_roller", "roller_radius": 8.0, "offset": "free"},
    {"type": "translating_roller", "roller_radius": {"min": 4.0, "max": 30.0}},
    {"type": "translating_roller", "roller_radius": 8.0, "prime_radius": 70.0},
    {"type": "oscillating_roller", "roller_radius": 8.0, "arm": 80.0, "pivot_distance": 100.0},
    {
        "type": "oscillating_roller",
        "roller_radius": 8.0,
        "arm": 80.0,
        "pivot_distance": {"min": 70.0, "max": 130.0},
        "sense": -1,
    },
    {"type": "translating_flat"},
    {"type": "oscillating_flat", "pivot_distance": 120.0, "face_offset": 5.0},
    {"type": "oscillating_flat", "pivot_distance": 120.0, "face_offset": -5.0, "sense": -1},
]


@pytest.mark.slow
@pytest.mark.parametrize("rotation", further(["ccw", "cw"], ["ccw"]))
@pytest.mark.parametrize(
    "follower", FOLLOWERS, ids=lambda f: f"{f['type']} {len(f)} {f.get('sense', '')}{f.get('offset', '')}"
)
def test_every_follower_and_sense_of_rotation(follower, rotation):
    segments = moves("modified_sine", "cycloidal", 12.0, 110.0, 120.0)
    limits = {"pressure_angle": 30.0, "pressure_angle_fall": 40.0, "curvature_ratio": 1.5, "min_radius": 2.0}
    design = only(answered(cam(segments=segments, follower=follower, limits=limits, rotation=rotation)))
    mechanism = design.mechanism
    assert mechanism.rotation == rotation
    angle = np.unwrap(np.angle(np.array(mechanism.profile.x) + 1j * np.array(mechanism.profile.y)))
    assert (angle[-1] > angle[0]) == (rotation == "cw")
    if design.metrics.max_pressure_angle_rise is not None:
        assert design.metrics.max_pressure_angle_rise <= 30.0 * 1.002
        assert design.metrics.max_pressure_angle_fall <= 40.0 * 1.002
        assert design.metrics.curvature_ratio >= 1.5 * 0.998
    else:
        assert design.metrics.min_convex_radius >= 2.0 * 0.998


@pytest.mark.slow
def test_tampering_is_found():
    """Verification measures the profile: it must not pass a cam that was changed anywhere."""
    problem = cam()
    mechanism = only(answered(problem)).mechanism
    good, _ = verify(problem, mechanism)
    assert good.passed

    def broken(**changes):
        verdict, _ = verify(problem, mechanism.model_copy(update=changes))
        return {check.name for check in verdict.checks if not check.passed}

    def curve(scale, shift=0.0):
        profile = mechanism.profile
        return profile.model_copy(
            update={"x": [scale * x + shift for x in profile.x], "y": [scale * y for y in profile.y]}
        )

    assert "reproduces_program" in broken(profile=curve(1.0001))
    assert "reproduces_program" in broken(profile=curve(1.0, 0.001))
    bump = list(mechanism.profile.x)
    bump[int(np.searchsorted(mechanism.profile.angle, 100.0))] += 0.002
    assert "reproduces_program" in broken(profile=mechanism.profile.model_copy(update={"x": bump}))
    assert "reproduces_program" in broken(prime_radius=mechanism.prime_radius * 1.0001)
    roller = mechanism.follower.model_copy(update={"roller_radius": 10.01})
    assert "reproduces_program" in broken(follower=roller)
    assert {"reproduces_program", "follower_can_be_laid_on"} <= broken(rotation="cw")
    table = mechanism.program.model_copy(update={"s": [s * 1.001 for s in mechanism.program.s]})
    assert {"keeps_the_statement", "reproduces_program"} <= broken(program=table)
    verdict, _ = verify(cam(limits={"pressure_angle": 29.0}), mechanism)
    assert [check.name for check in verdict.checks if not check.passed] == ["pressure_angle_fall"]
    verdict, _ = verify(cam(limits={"curvature_ratio": 3.6}), mechanism)
    assert "curvature_ratio" in [check.name for check in verdict.checks if not check.passed]
    other = cam(segments=moves("cycloidal", "cycloidal"))
    verdict, _ = verify(other, mechanism)
    assert "keeps_the_statement" in [check.name for check in verdict.checks if not check.passed]


def test_undercut_is_refused():
    """A small stated cam with a large roller."""
    follower = {"type": "translating_roller", "roller_radius": 14.0, "prime_radius": 20.0}
    limits = {"pressure_angle": 85.0, "curvature_ratio": 0.0}
    result = answered(cam(segments=moves("cycloidal", "cycloidal", 25.0, 60.0, 60.0), follower=follower, limits=limits))
    assert result.designs == []
    assert not result.search.complete


def test_forces_of_nortons_example_15_3():
    """The 3-4-5-6 polynomial at 15 rad/s: 53 lb, 52 lb in, and 10 lb left, with a preload of 10 lb."""
    polynomial = [
        {"angle": angle, "s": s, "v": 0.0, "a": 0.0} if angle != 90.0 else {"angle": 90.0, "s": 1.0}
        for angle, s in ((0.0, 0.0), (90.0, 1.0), (180.0, 0.0))
    ]
    problem = cam(
        segments=[
            {"motion": "polynomial", "angle": 180.0, "conditions": polynomial},
            {"motion": "dwell", "angle": 180.0},
        ],
        follower={"type": "translating_roller", "roller_radius": 0.5},
        dynamics={"mass": 0.0738, "spring_rate": 50.0, "damping_ratio": 0.15, "preload": 10.0},
        speed_rpm=15.0 * 30.0 / math.pi,
        length_unit="in",
    )
    forces = only(answered(problem)).metrics.forces
    assert forces.max_contact_force == pytest.approx(53.0, abs=0.5)
    assert forces.max_torque == pytest.approx(52.0, abs=0.5)
    assert forces.min_contact_force == pytest.approx(10.0, abs=0.5)
    assert forces.natural_frequency == pytest.approx(math.sqrt(50.0 / 0.0738))


@pytest.mark.slow
def test_units_of_force():
    """The same valve in millimetres and in metres."""
    metres = {
        **VALVE,
        "length_unit": "m",
        "segments": [{**s, **({"lift": s["lift"] / 1000.0} if "lift" in s else {})} for s in VALVE["segments"]],
        "limits": {"min_radius": 0.003, "jerk": 0.350, "face_width": 0.032},
        "dynamics": {"mass": 0.12, "spring_rate": 30000.0, "least_force": 100.0},
    }
    small, large = only(answered(cam(VALVE))), only(answered(cam(metres)))
    assert large.optimality.value == pytest.approx(small.optimality.value, rel=1e-4)
    assert large.mechanism.base_radius * 1000.0 == pytest.approx(small.mechanism.base_radius, rel=1e-3)
    assert large.metrics.forces.max_torque * 1000.0 == pytest.approx(small.metrics.forces.max_torque, rel=1e-2)


@pytest.mark.campaign
@pytest.mark.parametrize(
    "minimize",
    [
        "peak_velocity",
        "peak_acceleration",
        "peak_jerk",
        "rms_velocity",
        "rms_acceleration",
        "rms_jerk",
        "peak_torque",
        "rms_torque",
    ],
)
def test_optimal_motions_by_every_criterion(minimize):
    """Value and bound belong together, and no law is better than the bound."""
    beta = math.radians(100.0)
    limits = {"pressure_angle": 35.0, "jerk": 90.0 * 25.0 / beta**3}
    best = only(
        answered(cam(segments=moves("optimal", "optimal", 25.0, 100.0, 100.0), limits=limits, minimize=minimize))
    )
    assert best.optimality.bound <= best.optimality.value
    if not minimize.endswith("torque"):
        assert best.optimality.gap <= 2e-3
    law = only(answered(cam(segments=moves("auto", "auto", 25.0, 100.0, 100.0), limits=limits, minimize=minimize)))
    assert best.optimality.bound <= law.optimality.value
    assert best.optimality.value <= law.optimality.value * 1.001


@pytest.mark.campaign
def test_conditions_within_an_optimal_motion():
    segments = moves("optimal", "cycloidal")
    segments[1]["conditions"] = [{"angle": 45.0, "s": 10.0}, {"angle": 60.0, "v": 20.0}]
    segments[1]["bands"] = [{"start": 65.0, "end": 75.0, "lower": 17.0, "upper": 21.0}]
    design = only(answered(cam(segments=segments, limits={"pressure_angle": 35.0, "jerk": 3000.0})))
    table = design.mechanism.program
    at = {round(angle, 6): (s, v) for angle, s, v in zip(table.angle, table.s, table.v, strict=True)}
    assert at[135.0][0] == pytest.approx(10.0, abs=1e-9)
    assert at[150.0][1] == pytest.approx(20.0, abs=1e-8)
    assert all(17.0 - 1e-6 <= at[angle][0] <= 21.0 + 1e-6 for angle in np.arange(155.0, 165.5, 0.5))


@pytest.mark.campaign
def test_continuous_jerk():
    beta = 0.5 * math.pi
    limits = {"pressure_angle": 35.0, "jerk": 100.0 * 25.0 / beta**3}
    design = only(answered(cam(segments=moves("optimal", "optimal"), limits=limits, continuity="jerk")))
    assert all(joint.continuous == ["s", "v", "a", "j"] for joint in design.joints)


@pytest.mark.slow
def test_a_whole_turn_of_optimal_motions():
    segments = [
        {"motion": "rise", "angle": 180.0, "lift": 10.0, "law": "optimal"},
        {"motion": "fall", "angle": 180.0, "lift": 10.0, "law": "optimal"},
    ]
    design = only(answered(cam(segments=segments, minimize="rms_jerk")))
    assert design.optimality.gap <= 1e-3
    assert all({"s", "v", "a"} <= set(joint.continuous) for joint in design.joints)
    # An eccentric has an rms jerk of 5/√2.
    assert design.optimality.value <= 5.0 / math.sqrt(2.0)


WITHOUT_LIMITS = [
    pytest.param("peak_velocity", 1.0, 1, marks=pytest.mark.slow),
    ("peak_acceleration", 4.0, 2),
    ("peak_jerk", 32.0, 3),
    ("rms_acceleration", math.sqrt(12.0 / 2.0), 2),
    ("rms_jerk", math.sqrt(720.0 / 2.0), 3),
    pytest.param("peak_torque", 2.25, None, marks=pytest.mark.slow),
]


@pytest.mark.campaign
@pytest.mark.parametrize(("minimize", "known", "order"), WITHOUT_LIMITS)
def test_known_limits_through_the_whole_solver(minimize, known, order):
    """Unit rise in a quarter turn, fall in another: abrupt motions, verified on closer points where they bend.

    Rises and falls fill half of the turn, so that a mean square is halved.
    """
    beta = 0.5 * math.pi
    follower = {"type": "translating_roller", "roller_radius": 0.1}
    limits = {"pressure_angle": 60.0, "curvature_ratio": 0.0}
    problem = cam(segments=moves("optimal", "optimal", 1.0), minimize=minimize, follower=follower, limits=limits)
    design = only(answered(problem))
    unit = beta**-order if order is not None else beta**-3
    assert design.optimality.value == pytest.approx(known * unit, rel=2e-3)
    assert design.optimality.value >= known * unit * (1.0 - 1e-9)
    assert design.optimality.bound <= known * unit * (1.0 + 1e-9)


@pytest.mark.campaign
def test_smallest_cam_over_all_motions():
    """No law gives a cam as small, curvature counted; the bound is by pressure angle alone."""
    best = only(answered(cam(segments=moves("optimal", "optimal"), minimize="size")))
    law = only(answered(cam(segments=moves("auto", "auto"), minimize="size")))
    assert best.optimality.bound < best.mechanism.prime_radius < law.mechanism.prime_radius


@pytest.mark.campaign
def test_smallest_flat_faced_cam_over_all_motions():
    limits = {"face_width": 60.0, "jerk": 1500.0, "min_radius": 2.0}
    problem = cam(
        segments=moves("optimal", "optimal"), minimize="size", follower={"type": "translating_flat"}, limits=limits
    )
    best = only(answered(problem))
    assert best.optimality.gap <= 2e-3
    assert best.metrics.face_width <= 60.0 * 1.002


@pytest.mark.campaign
def test_a_lift_that_vanishes_beside_the_roller_is_solved():
    """The pitch curve is a circle but for rounding, and the limit on its curvature is just reached all around."""
    small = moves("modified_sine", "cycloidal", 1e-5, 90.0, 90.0)
    design = only(answered(cam(segments=small, follower={"type": "translating_roller", "roller_radius": 10.0})))
    assert design.mechanism.prime_radius == pytest.approx(20.0, rel=1e-5)


@pytest.mark.slow
def test_a_cam_that_comes_to_the_pivot_of_its_arm_is_refused():
    segments = moves("modified_sine", "cycloidal", 9.0, 30.0, 55.0)
    follower = {"type": "oscillating_flat", "pivot_distance": 140.0, "face_offset": -7.0, "sense": -1}
    limits = {"hub_radius": 137.0}
    shown = answered(cam(segments=segments, follower=follower, limits=limits, include_failed=True))
    (design,) = shown.designs
    profile = design.mechanism.profile
    assert max(math.hypot(x, y) for x, y in zip(profile.x, profile.y, strict=True)) > 140.0
    assert [check.name for check in design.verification.checks if not check.passed] == ["clears_pivot"]


@pytest.mark.campaign
def test_the_profile_is_held_against_the_program_between_its_points():
    """Two hundred moves of fifteen points each: exact at the points, and a ten-thousandth of the lift off between."""
    segments = [
        {"motion": "rise" if k % 2 == 0 else "fall", "angle": 1.8, "lift": 1.0, "law": "cycloidal"} for k in range(200)
    ]
    (design,) = answered(cam(segments=segments, limits={}, include_failed=True)).designs
    (check,) = (check for check in design.verification.checks if check.name == "reproduces_program")
    assert check.value <= 1e-6 or not check.passed
    assert len(design.mechanism.profile.x) > 4000 or check.value == pytest.approx(1.2e-4, rel=0.05)


@pytest.mark.parametrize("law", ["modified_sine", "cycloidal"])
@pytest.mark.parametrize("limit", [1.0, 4.0])
def test_the_least_radius_under_a_flat_face_is_measured_within_a_thousandth(law: str, limit: float) -> None:
    """Circles through points half a degree apart had it up to half too large, always to the unsafe side."""
    statement = {
        "kind": "cam",
        "segments": [
            {"motion": "dwell", "angle": 140.0},
            {"motion": "rise", "angle": 60.0, "lift": 20.0, "law": law},
            {"motion": "dwell", "angle": 60.0},
            {"motion": "return", "angle": 100.0, "law": law},
        ],
        "follower": {"type": "translating_flat"},
        "limits": {"min_radius": limit},
    }
    (design,) = solve(parse_problem(statement)).designs
    assert design.verification.passed
    # Norton, eq. 8.31: the radius of curvature is base radius, displacement and acceleration; here of the laws.
    motions = [build_law_segment(LAWS[law], math.radians(angle), 0.0, 20.0).pieces for angle in (60.0, 100.0)]
    moved = [pieces.motion(np.linspace(0.0, pieces.length, 100_001)) for pieces in motions]
    least = min(float((m.s + m.a).min()) for m in moved) + design.mechanism.base_radius
    assert design.metrics.min_convex_radius <= least * (1.0 + 1e-8)
    assert least == pytest.approx(limit, rel=1e-6)


def test_a_contact_force_below_the_least_fails_whatever_preload_is_stated() -> None:
    statement = {
        "kind": "cam",
        "segments": [
            {"motion": "rise", "angle": 90.0, "lift": 20.0, "law": "cycloidal"},
            {"motion": "return", "angle": 270.0, "law": "cycloidal"},
        ],
        "follower": {"type": "translating_roller", "roller_radius": 8.0},
        "speed_rpm": 600.0,
        "dynamics": {"mass": 2.0, "spring_rate": 0.5, "least_force": 5.0, "preload": 1.0},
        "length_unit": "m",
    }
    statement["segments"][0]["lift"], statement["follower"]["roller_radius"] = 0.02, 0.008
    result = solve(parse_problem(statement))
    assert result.designs == []
    gap = next(gap for gap in result.nearest_miss.gaps if gap.check == "contact_force")
    assert gap.limit == 5.0
    assert gap.value < 0.0
    del statement["dynamics"]["preload"]
    (design,) = solve(parse_problem(statement)).designs
    checks = {check.name: check for check in design.verification.checks}
    assert checks["contact_force"].passed
    assert checks["contact_force"].value == pytest.approx(5.0, rel=1e-6)


@pytest.mark.parametrize(
    "changes",
    [{"closure": "form"}, {"follower": {"type": "barrel_roller", "roller_radius": 5.0, "cylinder_radius": 60.0}}],
    ids=["groove", "barrel"],
)
def test_a_least_force_between_two_walls_is_refused(changes) -> None:
    dynamics = {"mass": 0.5, "spring_rate": 20.0, "least_force": 50.0}
    statement = {**DOUBLE_DWELL, "speed_rpm": 60.0, "dynamics": dynamics, **changes}
    if "follower" in changes:
        statement.pop("limits", None)
    (fault,) = parse_problem(statement).find_contradictions()
    assert fault.path == "/dynamics/least_force"
    dynamics["least_force"] = 0.0
    assert parse_problem(statement).find_contradictions() == []


@pytest.mark.slow
@pytest.mark.parametrize(
    ("criterion", "exploded"),
    further(
        [("peak_acceleration", ["jerk"]), ("peak_velocity", ["acceleration", "jerk"])],
        [("peak_acceleration", ["jerk"])],
    ),
)
def test_a_criterion_that_lets_another_peak_explode_is_warned_about(criterion, exploded):
    result = answered(cam(segments=moves("optimal", "optimal"), minimize=criterion))
    design = only(result)
    warning = design.optimality.warning
    assert warning in result.summary
    rise = next(segment for segment in design.segments if segment.motion == "rise")
    # Peaks of a cycloidal rise of h in β are 2 h/β, 2π h/β² and 4π² h/β³.
    beta, plain = math.radians(90.0), {"velocity": 2.0, "acceleration": 2.0 * math.pi, "jerk": 4.0 * math.pi**2}
    for order, (name, factor) in enumerate(plain.items(), 1):
        times = getattr(rise, f"peak_{name}") / (factor * 25.0 / beta**order)
        assert (times > 10.0) == (name in exploded)
        if name in exploded:
            assert f"the peak {name} is {times:.3g} times" in warning.lower()
    assert f"set a limit on {' or '.join(exploded)}" in warning


def test_a_sound_motion_is_not_warned_about():
    assert only(answered(cam(segments=moves("optimal", "optimal"), minimize="peak_jerk"))).optimality.warning is None
    assert only(answered(cam(segments=moves("modified_sine", "cycloidal")))).optimality.warning is None


@pytest.mark.parametrize(
    ("limits", "default"),
    [
        ({}, "`pressure_angle` = 30"),
        ({"pressure_angle": 45.0}, "`curvature_ratio` = 2"),
        ({"pressure_angle": 30.0}, None),
        ({"pressure_angle": 45.0, "curvature_ratio": 2.0}, None),
    ],
)
def test_a_default_that_set_the_radius_is_named(limits, default):
    summary = answered(cam(limits=limits)).summary
    assert [part for part in summary.split(". ") if "default" in part] == (
        [] if default is None else [f"The default {default} determines the radius; give your own value to change it."]
    )
