"""Slider-cranks and geared fivebars that guide a point: planted ones come back, and are measured as they move."""

import math

import numpy as np
import pytest

from kinematics.linkage import SliderCrank
from kinematics.linkage.fourbar import Fourbar, positions
from kinematics.linkage.planar.catalogue import make_geared_fivebar
from kinematics.linkage.planar.drive import drive
from kinematics.linkage.slider_crank import closed_form as sliders
from synthesis.dispatch import solve
from synthesis.kinds.path.design import PathResult
from synthesis.kinds.path.slider_cranks_and_fivebars import build_cognate_fivebars, build_geared_fivebar
from synthesis.kinds.path.verification.linkage import verify_traced
from synthesis.model.linkage.conversion import FourbarConfiguration, build_slider_crank
from synthesis.registry import parse_problem

SLIDER = SliderCrank(1.0 + 2.0j, 1.0 + 2.3j, 0.3, 1.0, 3.2, 1.5 + 1.2j)
TURN = np.linspace(0.0, math.tau, 40, endpoint=False)


def statement(points, mechanism, **changes):
    return parse_problem(
        {
            "kind": "path",
            "mechanism": mechanism,
            "points": [{"x": float(z.real), "y": float(z.imag)} for z in points],
            **changes,
        }
    )


def answer(points, mechanism, **changes) -> PathResult:
    problem = statement(points, mechanism, **changes)
    problem.require_consistent()
    return solve(problem, lambda share, message: None)


def geared(ratio, count=60, turns=1):
    """P of a geared fivebar over its whole cycle."""
    made = make_geared_fivebar(0.0, 2.0, 1.0, 2.5, 2.2, 0.8, ratio, 0.7, 0.0, 1, 1.8 + 0.9j)
    motion = drive(made, np.linspace(0.0, math.tau * turns, count, endpoint=False), order=0)
    assert motion.valid.all()
    return motion.joints["P"][0]


ELEVEN = [2.2, 2.96, 3.38, 3.8, 4.11, 4.46, 5.16, 6.01, 6.46, 6.93, 7.28]


@pytest.mark.slow
def test_eleven_points_of_a_geared_fivebar_are_met():
    """As many points as it has numbers: first descents miss them, and perturbed copies of the best reach them."""
    linkage = make_geared_fivebar(0.0, 2.219, 1.078, 2.409, 3.151, 0.873, -2.0, 0.481, 0.0, 1, -1.426 + 3.824j)
    motion = drive(linkage, np.array(ELEVEN), order=0)
    assert motion.valid.all()
    points = 20.0 * motion.joints["P"][0]
    # In the default order, fits that transmit better would be searched and listed too.
    result = answer(points, "geared_fivebar", gear_ratio=-2.0, rank_by="accuracy")
    assert result.search.method == "family_search"
    assert result.designs
    size = np.abs(points[:, None] - points).max()
    for design in result.designs:
        assert design.verification.passed
        assert design.metrics.max_distance < 1e-8 * size


@pytest.mark.campaign
def test_what_no_slider_crank_meets_is_fitted():
    """An ellipse of two to one in eight points, the fourth and the seventh a little aside."""
    points = 2.0 * np.cos(np.arange(8) * np.pi / 4.5) + 1j * np.sin(np.arange(8) * np.pi / 4.5)
    points[[3, 6]] += 0.05j
    result = answer(points, "slider_crank", max_designs=3)
    assert result.designs
    assert all(design.metrics.max_distance <= 0.05 * 4.0 for design in result.designs)
    assert result.designs == answer(points, "slider_crank", max_designs=3, method="least_squares").designs
    assert "fitted instead" in result.summary


def slider_mechanism(theta):
    at = sliders.positions(SLIDER, theta, 1)
    joints = (complex(z) for z in (SLIDER.pivot, at.a, at.b))
    return build_slider_crank(*joints, 0.3, complex(at.p))


def test_verification_meets_what_a_slider_crank_draws():
    angles = np.array([0.3, 0.9, 1.8, 2.6, 4.0])
    points = sliders.coupler_points(SLIDER, angles, 1).p
    design = verify_traced(statement(points, "slider_crank"), slider_mechanism(0.3))
    assert design.verification.passed
    assert design.metrics.full_rotation
    assert np.allclose([math.radians(target.input_angle) for target in design.targets], angles, atol=1e-6)


@pytest.mark.parametrize("off", [1e-6, 1e-2])
def test_verification_sees_a_point_that_is_missed(off):
    angles = np.array([0.3, 0.9, 1.8, 2.6])
    points = sliders.coupler_points(SLIDER, angles, 1).p + np.array([0.0, 0.0, off * (1.0 + 1.0j), 0.0])
    design = verify_traced(statement(points, "slider_crank"), slider_mechanism(0.3))
    assert not design.verification.passed
    dense = sliders.coupler_points(SLIDER, 1.8 + np.linspace(-1.0, 1.0, 400_001) * min(0.3, 30.0 * off), 1).p
    assert design.metrics.max_distance == pytest.approx(np.abs(dense - points[2]).min(), rel=1e-3)


def test_verification_sees_a_wrong_order():
    points = sliders.coupler_points(SLIDER, np.array([0.3, 1.8, 0.9, 2.6, 1.3]), 1).p
    design = verify_traced(statement(points, "slider_crank"), slider_mechanism(0.3))
    assert not design.verification.passed


@pytest.mark.slow
def test_a_slider_cranks_closed_curve_is_recovered():
    points = sliders.coupler_points(SLIDER, TURN, 1).p
    best = answer(points, "slider_crank", method="curve_match", closed=True).designs[0]
    assert best.metrics.max_distance < 1e-9
    assert best.metrics.full_rotation
    assert best.mechanism.links.crank == pytest.approx(1.0)
    assert best.mechanism.links.coupler == pytest.approx(3.2)


@pytest.mark.campaign
@pytest.mark.parametrize("method", ["curve_match", "least_squares"])
def test_a_slider_cranks_stroke_with_noise_is_fitted(method):
    rng = np.random.default_rng(5)
    clean = sliders.coupler_points(SLIDER, TURN[3:23], 1).p
    noise = 0.01 * (rng.normal(size=20) + 1j * rng.normal(size=20))
    best = answer(clean + noise, "slider_crank", method=method, rank_by="accuracy").designs[0]
    assert best.metrics.rms_distance < 0.015
    assert best.metrics.visits_in_order


@pytest.mark.campaign
@pytest.mark.parametrize("n", [3, 5, 8])
def test_slider_cranks_meet_up_to_eight_points_exactly(n):
    points = sliders.coupler_points(SLIDER, np.linspace(0.4, 4.0, n), 1).p
    result = answer(points, "slider_crank")
    assert result.designs
    assert not result.search.complete
    for design in result.designs:
        assert design.verification.passed
        assert design.metrics.max_distance < 1e-9


@pytest.mark.campaign
def test_a_slider_crank_stands_on_a_given_pivot():
    points = sliders.coupler_points(SLIDER, np.linspace(0.4, 4.0, 5), 1).p
    result = answer(points, "slider_crank", fixed_pivots={"input": [1.0, 2.0]})
    assert result.designs
    for design in result.designs:
        assert np.allclose(design.mechanism.fixed_pivot, [1.0, 2.0], atol=1e-8)


@pytest.mark.slow
def test_a_fitted_slider_crank_keeps_a_given_pivot_and_an_angle():
    """Points that none draws, around the curve of one with 70°; the least angle is looked for by brute force."""
    rng = np.random.default_rng(2)
    turn = np.arange(12) * np.pi / 6.0
    pins = 10.0 + 5.0j + 20.0 * np.exp(1j * turn)
    rods = np.sqrt(70.0**2 - (pins.imag - 2.0) ** 2) + 1j * (2.0 - pins.imag)
    points = pins + rods / 70.0 * complex(*rng.uniform(-40.0, 60.0, 2))
    points += 0.5 * (rng.normal(size=12) + 1j * rng.normal(size=12))
    stated = {"fixed_pivots": {"input": [10.0, 5.0]}, "constraints": {"min_transmission_angle": 40.0}}
    result = answer(points, "slider_crank", method="least_squares", **stated)
    assert result.designs
    for design in result.designs:
        assert design.mechanism.fixed_pivot == pytest.approx((10.0, 5.0), abs=1e-9)
        skeleton = {name: complex(*place) for name, place in design.mechanism.skeleton.joints.items()}
        crank, rod = abs(skeleton["A"] - skeleton["O2"]), abs(skeleton["B"] - skeleton["A"])
        across = np.exp(-1j * np.radians(design.mechanism.slide.angle))
        heights = (across * (skeleton["O2"] - skeleton["B"])).imag + crank * np.sin(np.linspace(0.0, 2.0 * np.pi, 2000))
        assert np.degrees(np.arccos(np.abs(heights).max() / rod)) > 40.0
        assert design.metrics.rms_distance < 0.6


@pytest.mark.campaign
@pytest.mark.parametrize(
    ("ratio", "turns"),
    [(-1.0, 1), *(pytest.param(*one, marks=pytest.mark.slow) for one in [(2.0, 1), (-2.0, 1), (0.5, 2)])],
)
def test_a_geared_fivebars_whole_cycle_is_recovered(ratio, turns):
    points = geared(ratio, turns=turns)
    best = answer(points, "geared_fivebar", method="curve_match", closed=True, gear_ratio=ratio).designs[0]
    assert best.metrics.max_distance < 1e-8
    assert best.metrics.full_rotation
    assert best.mechanism.gear_ratio == ratio
    links = best.mechanism.links
    found = sorted([links.ground, links.input, links.coupler_1, links.coupler_2, links.output])
    assert np.allclose(found, [0.8, 1.0, 2.0, 2.2, 2.5], rtol=1e-5)


def test_a_fivebar_is_rebuilt_from_its_dimensions():
    """The dimensions alone, driven by the analysis core, stand where the joints stood, whatever the ratio."""
    rng = np.random.default_rng(2)
    for ratio in (1.0, -2.0, 0.5, 1.5):
        o2, o5, a, b, c, p = rng.normal(size=6) + 1j * rng.normal(size=6)
        angle = float(np.angle(a - o2)) + math.tau
        made = build_geared_fivebar(o2, a, c, b, o5, p, ratio, angle)
        links, sign = made.links, 1 if made.assembly == "open" else -1
        point = made.coupler_point.distance * np.exp(1j * math.radians(made.coupler_point.angle))
        again = make_geared_fivebar(
            o2, o5, links.input, links.coupler_1, links.coupler_2, links.output, ratio,
            math.radians(made.phase), math.radians(made.reference_input_angle), sign, point,
        )  # fmt: skip
        for name, wanted in (("A", a), ("B", b), ("C", c), ("P", p)):
            assert abs(complex(again.joints[name]) - wanted) < 1e-12


def test_cognate_fivebars_draw_the_fourbars_curve():
    """Norton, Fig. 3-28: gear ratio +1; those whose cranks turn draw all of the curve."""
    crank = Fourbar(3.0 + 2.0j, 10.0 + 1.0j, 2.0, 6.0, 5.0, 3.0 + 2.5j)
    at = positions(crank, 0.7, 1)
    joints = FourbarConfiguration(*map(complex, (crank.input_pivot, at.a, at.b, crank.output_pivot, at.p)))
    target = positions(crank, np.linspace(0.7, 0.7 + math.tau, 50, endpoint=False), 1).p
    problem = statement(target, "geared_fivebar", method="curve_match", closed=True, gear_ratio=1.0)
    whole = 0
    for made in build_cognate_fivebars(joints):
        assert made.gear_ratio == 1.0
        design = verify_traced(problem, made)
        if design is not None and design.verification.passed:
            whole += 1
            assert design.metrics.max_distance < 1e-8
    assert whole >= 2


@pytest.mark.campaign
def test_fivebars_with_a_free_ratio_meet_nine_points():
    result = answer(geared(-1.0)[5:32:3], "geared_fivebar")
    assert result.designs
    for design in result.designs:
        assert design.verification.passed
        assert design.mechanism.gear_ratio in (1.0, -1.0, 2.0, -2.0)


@pytest.mark.slow
@pytest.mark.parametrize("size", [1e-5, 1e5])
@pytest.mark.parametrize("mechanism", ["slider_crank", "geared_fivebar"])
def test_size_and_place_do_not_matter(size, mechanism):
    points = sliders.coupler_points(SLIDER, TURN, 1).p if mechanism == "slider_crank" else geared(-1.0)
    moved = points * size * np.exp(1.1j) + (50.0 - 80.0j) * size
    more = {} if mechanism == "slider_crank" else {"gear_ratio": -1.0}
    best = answer(moved, mechanism, method="curve_match", closed=True, **more).designs[0]
    assert best.metrics.max_distance < 1e-8 * size


@pytest.mark.parametrize(
    ("mechanism", "changes", "where"),
    [
        ("fourbar", {"gear_ratio": 2.0}, "/gear_ratio"),
        ("slider_crank", {"gear_ratio": 2.0}, "/gear_ratio"),
        ("geared_fivebar", {"gear_ratio": 0.0}, "/gear_ratio"),
        ("geared_fivebar", {"gear_ratio": math.pi}, "/gear_ratio"),
        ("slider_crank", {"constraints": {"grashof": "crank_rocker"}}, "/constraints/grashof"),
        ("slider_crank", {"fixed_pivots": {"output": [1.0, 2.0]}}, "/fixed_pivots/output"),
        ("slider_crank", {"method": "exact"}, "/method"),
        ("geared_fivebar", {"constraints": {"coupler_point": {"along": [0.0, 1.0]}}}, "/constraints/coupler_point"),
    ],
)
def test_what_a_mechanism_cannot_be_asked_is_refused_with_its_place(mechanism, changes, where):
    points = sliders.coupler_points(SLIDER, TURN[:12], 1).p
    assert where in [fault.path for fault in statement(points, mechanism, **changes).find_contradictions()]


def test_prescribed_timing_is_for_fourbars():
    problem = parse_problem(
        {
            "kind": "path",
            "mechanism": "slider_crank",
            "timing": "prescribed",
            "points": [{"x": float(k), "y": float(k * k), "crank_angle": 20.0 * k} for k in range(4)],
        }
    )
    assert "/timing" in [fault.path for fault in problem.find_contradictions()]


@pytest.mark.campaign
@pytest.mark.parametrize("mechanism", ["slider_crank", "geared_fivebar"])
def test_odd_curves_end_with_an_honest_answer(mechanism):
    for curve in (np.linspace(0.0, 10.0, 6) + 0j, np.array([0.0, 1.0, 1.0, 2.0 + 1.0j, 3.0])):
        result = answer(curve, mechanism, method="curve_match")
        for design in result.designs:
            assert design.verification.passed
