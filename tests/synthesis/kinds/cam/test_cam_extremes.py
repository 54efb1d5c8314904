"""The worst values of finished cams against the exact curves of their programs: right to 1e-6, none flattering."""

from __future__ import annotations

import math

import numpy as np
import pytest

from kinematics.cam.finished.contact import Contour
from kinematics.cam.finished.discretization import Stretches, estimate_uncertainty
from kinematics.cam.finished.extreme_values import find_worst_values
from kinematics.cam.finished.local_curves import choose_stencils, select_every_second
from kinematics.cam.follower import OscillatingFlat, OscillatingRoller, TranslatingFlat, TranslatingRoller
from kinematics.cam.motion.laws import LAWS
from kinematics.cam.motion.program import TURN, Program
from kinematics.cam.motion.segments import build_dwell, build_law_segment
from kinematics.cam.profile import Cam
from synthesis.dispatch import solve
from synthesis.kinds.cam.profile import (
    MAX_PARTS,
    build_cam_mechanism,
    build_core_follower,
    choose_profile_angles,
    find_stretches,
    read_points,
    refine_angles,
)
from synthesis.kinds.cam.program.composition import Composition, compose_program
from synthesis.registry import parse_problem
from tests.campaign import further
from tests.oracles.cam_formulas import least_convex_radius, pressure_angle_extremes
from tests.support.independent.cams import statements
from tests.support.synthesis.cam_sampling import dense_motion, oscillating, translating

LAW_NAMES = ("modified_sine", "cycloidal", "modified_trapezoid", "polynomial_345")

FOLLOWERS = {
    "translating_roller": {"type": "translating_roller", "roller_radius": 8.0, "offset": 5.0},
    "oscillating_roller": {"type": "oscillating_roller", "roller_radius": 8.0, "arm": 90.0, "pivot_distance": 120.0},
    "translating_flat": {"type": "translating_flat"},
    "oscillating_flat": {"type": "oscillating_flat", "pivot_distance": 140.0, "face_offset": 4.0},
}


def statement(law: str, follower: str, **fields: object) -> dict[str, object]:
    """A double dwell with an uneven rise and fall."""
    lift = 20.0 if follower.startswith("translating") else 12.0
    segments = [
        {"motion": "dwell", "angle": 65.0},
        {"motion": "rise", "angle": 70.0, "lift": lift, "law": law},
        {"motion": "dwell", "angle": 95.0},
        {"motion": "return", "angle": 130.0, "law": law},
    ]
    return {"kind": "cam", "segments": segments, "follower": FOLLOWERS[follower], **fields}


def stated_program(law: str, lift: float) -> Program:
    """The same, from the laws."""
    rise, fall = math.radians(70.0), math.radians(130.0)
    return Program(
        [
            build_dwell(math.radians(65.0), 0.0),
            build_law_segment(LAWS[law], rise, 0.0, lift),
            build_dwell(math.radians(95.0), lift),
            build_law_segment(LAWS[law], fall, lift, 0.0),
        ]
    )


@pytest.mark.campaign
@pytest.mark.parametrize("law", LAW_NAMES)
@pytest.mark.parametrize("follower", ["translating_roller", "oscillating_roller"])
def test_a_roller_has_the_extremes_of_the_laws(law: str, follower: str) -> None:
    """From circles through three points the radii of slides were right to 3e-4, sampled pressure angles to 8e-6."""
    (design,) = solve(parse_problem(statement(law, follower))).designs
    mechanism, found = design.mechanism, design.metrics
    stated, roller = mechanism.follower, mechanism.follower.roller_radius
    if follower == "translating_roller":
        motion = dense_motion(stated_program(law, 20.0), 200_001)
        angle, bend = translating(motion, mechanism.prime_radius, stated.offset)
    else:
        motion = dense_motion(stated_program(law, math.radians(12.0)), 200_001)
        angle, bend = oscillating(motion, mechanism.prime_radius, stated.arm, stated.pivot_distance, stated.sense)
    convex, hollow = 1.0 / bend.max(), math.inf if bend.min() >= 0.0 else -1.0 / bend.min()
    exact = {
        "max_pressure_angle_rise": math.degrees(angle[motion.v >= 0.0].max()),
        "max_pressure_angle_fall": math.degrees(angle[motion.v < 0.0].max()),
        "min_convex_radius": convex - roller,
        "curvature_ratio": min(convex, hollow) / roller,
    }
    for name, value in exact.items():
        assert getattr(found, name) == pytest.approx(value, rel=1e-6), name
    if math.isfinite(hollow):
        assert found.min_concave_radius == pytest.approx(hollow + roller, rel=1e-6)
    assert found.min_convex_radius <= exact["min_convex_radius"] * (1.0 + 1e-8)


@pytest.mark.slow
@pytest.mark.parametrize("law", LAW_NAMES)
@pytest.mark.parametrize("follower", ["translating_flat", "oscillating_flat"])
def test_a_face_has_the_extremes_of_the_laws(law: str, follower: str) -> None:
    """ρ = R + s + a of a slide, C sin ψ − f + (C cos ψ a/μ − C sin ψ v²)/μ² of an arm, μ = 1 − v."""
    (design,) = solve(parse_problem(statement(law, follower, limits={"min_radius": 3.0}))).designs
    mechanism, found = design.mechanism, design.metrics
    if follower == "translating_flat":
        m = dense_motion(stated_program(law, 20.0), 200_001)
        radius, reach = mechanism.base_radius + m.s + m.a, m.v
    else:
        pivot, offset = mechanism.follower.pivot_distance, mechanism.follower.face_offset
        m = dense_motion(stated_program(law, math.radians(12.0)), 200_001)
        psi = math.asin((mechanism.base_radius + offset) / pivot) + m.s
        rate, x, y = 1.0 - m.v, pivot * np.cos(psi), pivot * np.sin(psi)
        radius, reach = y - offset + (x * m.a / rate - y * m.v**2) / rate**2, x / rate
    assert found.min_convex_radius == pytest.approx(radius.min(), rel=1e-6)
    assert found.min_convex_radius <= radius.min() * (1.0 + 1e-8)
    assert found.face_width == pytest.approx(np.ptp(reach), rel=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("law", LAW_NAMES)
def test_a_barrel_has_the_extremes_of_the_laws(law: str) -> None:
    """tan φ = v/R and κ = a R/(R² + v²)^{3/2}."""
    problem = parse_problem(
        statement(law, "translating_roller") | {"follower": {"type": "barrel_roller", "roller_radius": 6.0}}
    )
    (design,) = solve(problem).designs
    radius, m = design.mechanism.cylinder_radius, dense_motion(stated_program(law, 20.0), 200_001)
    least = ((radius**2 + m.v**2) ** 1.5 / np.maximum(np.abs(m.a) * radius, 1e-9)).min()
    found = design.metrics
    assert found.max_pressure_angle_rise == pytest.approx(math.degrees(math.atan(m.v.max() / radius)), rel=1e-6)
    assert found.max_pressure_angle_fall == pytest.approx(math.degrees(math.atan(-m.v.min() / radius)), rel=1e-6)
    assert found.min_radius == pytest.approx(least, rel=1e-6)
    assert found.min_radius <= least * (1.0 + 1e-8)


def beside_a_step(follower: dict[str, object]) -> dict[str, object]:
    """The acceleration is greatest where the jerk jumps, 1.25e-4° before one of the equal steps of half a degree."""
    segments = [
        {"motion": "rise", "angle": 70.857, "lift": 13.787, "law": "modified_sine"},
        {"motion": "dwell", "angle": 81.353},
        {"motion": "fall", "angle": 117.089, "lift": 13.787, "law": "modified_sine"},
        {"motion": "dwell", "angle": 90.701},
    ]
    limits = {"pressure_angle": 35.0}
    return {"kind": "cam", "segments": segments, "follower": follower, "limits": limits}


def test_curvature_is_measured_where_a_step_is_almost_a_break() -> None:
    """With points at both it was 1 % greater than it is: of so short a chord rounding leaves no curvature."""
    (design,) = solve(parse_problem(beside_a_step({"type": "barrel_roller", "roller_radius": 6.132}))).designs
    radius, rise, fall = design.mechanism.cylinder_radius, math.radians(70.857), math.radians(117.089)
    law = LAWS["modified_sine"]
    program = Program(
        [
            build_law_segment(law, rise, 0.0, 13.787),
            build_dwell(math.radians(81.353), 13.787),
            build_law_segment(law, fall, 13.787, 0.0),
            build_dwell(TURN - rise - fall - math.radians(81.353), 0.0),
        ]
    )
    m = dense_motion(program, 200_001)
    least = ((radius**2 + m.v**2) ** 1.5 / np.maximum(np.abs(m.a) * radius, 1e-9)).min()
    assert design.metrics.min_radius == pytest.approx(least, rel=1e-6)
    steps = np.diff(design.mechanism.program.angle)
    assert steps.min() > 0.01


@pytest.mark.slow
@pytest.mark.parametrize(("seed", "number"), further([(5, 18), (0, 39), (5, 159), (0, 179)], [(5, 18)]))
def test_rounding_leaves_a_least_radius_its_digits(seed: int, number: int) -> None:
    """Optimal motions go to the limit of 3: it was stated up to 6.6e-6 less where points stood close."""
    *_, stated = statements(number, seed)
    assert stated["limits"]["min_radius"] == 3.0
    (design,) = solve(parse_problem(stated)).designs
    assert design.metrics.min_convex_radius == pytest.approx(3.0, rel=5e-7)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("follower", "minimize", "rounded"),
    further(
        [
            ("translating_flat", "peak_torque", 2e-3),
            ("oscillating_flat", "rms_torque", 5e-5),
            ("translating_roller", "rms_torque", 1e-6),
        ],
        [("translating_flat", "peak_torque", 2e-3)],
    ),
)
def test_a_spike_of_the_acceleration_is_measured(follower: str, minimize: str, rounded: float) -> None:
    """Nothing limits it: it lasts for 1e-6 rad, and under the slide's face the cam is 12000 times as large as its edge.

    Its radius of 3 was stated as tens of thousands: no curvature was measured between breaks so near to each other.
    """
    limits = {"min_radius": 3.0} if follower.endswith("flat") else {"pressure_angle": 40.0}
    stated = statement("optimal", follower, minimize=minimize, limits=limits)
    problem = parse_problem(stated)
    (design,) = solve(problem).designs
    assert design.verification.passed
    composed = compose_program(problem)
    assert isinstance(composed, Composition)
    cam = Cam(composed.program, build_core_follower(design.mechanism), design.mechanism.rotation)
    exact = least_convex_radius(cam) - cam.roller_radius
    assert exact * (1.0 - rounded) <= design.metrics.min_convex_radius <= exact * (1.0 + 1e-7)


@pytest.mark.slow
def test_points_are_laid_where_no_equal_step_has_room() -> None:
    """Forty equal steps, and a break every third of a degree."""
    n = 1080
    moves = [
        build_law_segment(LAWS["cycloidal"], TURN / n, *((0.0, 1e-3) if k % 2 == 0 else (1e-3, 0.0))) for k in range(n)
    ]
    cam = Cam(Program(moves), TranslatingFlat(80.0), "cw")
    angles = choose_profile_angles(cam.program, cam.profile, 0.0, 40)
    assert np.all(np.diff(angles) > 0.0)
    assert np.isin(np.round(cam.program.joints[:-1], 9), np.round(angles, 9)).all()


def unsettled_beside(breaks: list[int]) -> set[int]:
    """Chords of 40 to be divided where the curvatures of the twentieth differ; the one after it is too short for it."""
    near = np.ones((40, 2))
    wide = near.copy()
    near[20] += 0.01
    none = np.zeros(40, np.bool_)
    stretches = Stretches(np.array(breaks, dtype=np.int64), none, none, none)
    room = np.where(np.arange(40) == 21, 0.9, 1e3)
    return set(np.flatnonzero(estimate_uncertainty(near, wide, np.zeros(40), room, stretches)[2]).tolist())


def test_chords_that_are_too_short_are_not_divided() -> None:
    """Beside a chord whose curvature is not settled there is one of which rounding leaves none."""
    assert unsettled_beside([]) == {18, 19, 20, 22}


def test_chords_are_divided_no_further_than_there_is_room() -> None:
    """Where a curve runs over a break they are divided as finely as possible, but not into what is rounding."""
    near, chord = np.ones((40, 2)), np.arange(40)
    stretches = Stretches(np.empty(0, np.int64), chord == 20, np.zeros(40, np.bool_), np.zeros(40, np.bool_))
    unsettled = estimate_uncertainty(near, near, np.zeros(40), np.where(chord == 20, 1.0, 1e3), stretches)[2]
    angle = TURN / 40.0 * chord
    parts, _ = np.histogram(refine_angles(angle, unsettled, 1.0), np.append(angle, TURN))
    assert parts[17:24].tolist() == [2, MAX_PARTS, MAX_PARTS, 2, MAX_PARTS, MAX_PARTS, 2]


def test_chords_beyond_a_break_are_not_divided() -> None:
    """Their curves run through none of the points."""
    assert unsettled_beside([3, 20]) == {20, 22}
    assert unsettled_beside([3, 19]) == {19, 20, 22}


def test_short_steps_are_not_divided_beside_long_ones() -> None:
    """The step before the divided one is half as long, the one after it as long: only that is divided with it."""
    angle = np.array([0.0, 1.0, 1.4, 2.2, 3.0, 4.0, 5.0])
    off = np.where(np.arange(7) == 2, 1.0, 0.0)
    found = refine_angles(angle, off, 1.0)
    assert np.setdiff1d(found, angle) == pytest.approx([1.8, 2.6])


def test_a_profile_without_its_breaks_is_measured_worse_never_better() -> None:
    """Breaks only say where curves end; where they are left out, what two densities differ by is added."""
    program = stated_program("cycloidal", 20.0)
    cam = Cam(program, TranslatingFlat(90.0), "cw")
    angle = np.linspace(0.0, TURN, 721)[:-1]
    none = np.zeros(720, np.bool_)
    blind = Stretches(np.empty(0, np.int64), none, none, none)
    found = find_worst_values(Contour(cam.profile(angle), angle), cam.follower, "cw", blind)
    assert 1.0 / found.convex <= cam.radius_extremes.least * (1.0 + 1e-9)


@pytest.mark.parametrize("first", [0.1, 0.35, 0.6, 0.85])
def test_curvature_between_the_places_of_a_chord_is_measured(first: float) -> None:
    """Where curves run over breaks, as here at each point, it was stated up to 6e-5 too flat."""
    cam = Cam(stated_program("polynomial_4567", 20.0), TranslatingFlat(83.0), "cw")
    angle = np.radians(0.125 * (np.arange(2880) + first))
    blurred = Stretches(np.empty(0, np.int64), np.ones(2880, np.bool_), *np.zeros((2, 2880), np.bool_))
    found = find_worst_values(Contour(cam.profile(angle), angle), cam.follower, "cw", blurred)
    assert 1.0 / found.convex <= cam.radius_extremes.least * (1.0 + 1e-9)
    assert 1.0 / found.convex == pytest.approx(cam.radius_extremes.least, rel=1e-4)


def test_stencils_stay_between_breaks() -> None:
    first = choose_stencils(40, np.array([3, 20]))
    assert first[3] == 3
    assert first[19] == 15
    assert first[20] == 20
    assert first[2] == 38 - 40 + 0
    assert (choose_stencils(40, np.empty(0, np.int64)) == np.arange(40) - 2).all()
    kept, breaks = select_every_second(40, np.array([3, 20]))
    assert {3, 20} <= set(kept[breaks].tolist())
    assert np.diff(kept).max() == 2


@pytest.mark.parametrize("points", [360, 720])
@pytest.mark.parametrize("follower", ["translating_roller", "oscillating_roller"])
def test_a_limit_on_jerk_is_measured_within_a_ten_thousandth(points: int, follower: str) -> None:
    """With 360 points the arm's cam was refused: its program had the jerk 6, its own check measured 6.0128."""
    jerk, lift = (20.0, 20.0 * math.radians(60.0) ** 3 / 40.0) if follower.startswith("trans") else (6.0, 9.87)
    roller = {"translating_roller": {"roller_radius": 0.4 * lift}, "oscillating_roller": {"roller_radius": 10.0}}
    arm = {"arm": 60.0, "pivot_distance": 90.0} if follower == "oscillating_roller" else {}
    problem = {
        "kind": "cam",
        "segments": [
            {"motion": "dwell", "angle": 90.0},
            {"motion": "rise", "angle": 60.0, "lift": lift, "law": "optimal"},
            {"motion": "dwell", "angle": 90.0},
            {"motion": "fall", "angle": 120.0, "lift": lift, "law": "modified_sine"},
        ],
        "follower": {"type": follower, **roller[follower], **arm},
        "minimize": "peak_acceleration",
        "limits": {"jerk": jerk, "pressure_angle": 40.0},
        "profile_points": points,
    }
    (design,) = solve(parse_problem(problem)).designs
    (check,) = (check for check in design.verification.checks if check.name == "peak_jerk")
    assert check.value == pytest.approx(jerk, rel=1e-4)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(6))
def test_extremes_of_exact_formulas_agree(seed: int) -> None:
    """What the profile's points give against what the program gives at once, for cams that turn either way."""
    rng = np.random.default_rng(seed)
    program = stated_program(str(rng.choice(LAW_NAMES)), 0.1)
    sense = 1 if seed % 2 else -1
    followers = (
        TranslatingRoller(1.5, 0.3, float(rng.uniform(-0.4, 0.4))),
        OscillatingRoller(1.5, 0.3, 1.6, 2.2, sense),
        OscillatingFlat(3.0, 5.0, 0.1, sense),
    )
    for follower in followers:
        cam = Cam(program, follower, "ccw" if seed % 3 else "cw")
        angle = choose_profile_angles(program, cam.profile, cam.roller_radius, 1440)
        mechanism = build_cam_mechanism(cam, angle)
        stretches = find_stretches(mechanism.program)
        contour = Contour(read_points(mechanism.profile), np.radians(mechanism.program.angle), stretches.breaks)
        found = find_worst_values(contour, follower, cam.rotation, stretches)
        if isinstance(follower, OscillatingFlat):
            reach = follower.reach(dense_motion(program, 100_001))
            assert found.sweep == pytest.approx(np.ptp(reach), rel=1e-6)
        else:
            steepest = max(found.rising, found.falling)
            assert steepest == pytest.approx(pressure_angle_extremes(cam).largest, rel=1e-6)
