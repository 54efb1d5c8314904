"""Fits to many positions and quasi-positions: planted linkages, held coordinates, tolerances, and the true error."""

from __future__ import annotations

import cmath
import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from synthesis.dispatch import solve
from synthesis.kinds.motion.design import MotionResult
from synthesis.kinds.motion.least_squares.constraint_manifold import compute_pivots, make_surface
from synthesis.kinds.motion.least_squares.linear_fit import fit_dyads
from synthesis.kinds.motion.least_squares.pose_fit import PoseConstraints, PoseFit
from synthesis.kinds.motion.least_squares.solver import make_pose_constraints
from synthesis.kinds.motion.least_squares.starts import list_starts
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.kinds.motion.statement.dyad_choices import DyadChoices
from synthesis.kinds.motion.task.positions import make_motion_task
from synthesis.kinds.motion.verification.verify import verify
from synthesis.model.linkage.answer import LinkageDesign
from synthesis.model.linkage.conversion import FourbarConfiguration, build_fourbar
from synthesis.numerics.status import Status
from synthesis.registry import parse_problem
from tests.campaign import sampled
from tests.oracles.continuation import Linkages, configurations, follow
from tests.support.synthesis.planted import Planted, plant, plant_many


def silent(fraction: float, message: str) -> None:
    pass


def noisy(planted: Planted, noise: float, rng: np.random.Generator) -> list[dict[str, Any]]:
    """The planted positions, each coordinate off by ``noise`` task sizes (radians), normally distributed."""
    points = [complex(p["x"], p["y"]) for p in planted.positions]
    size = max(abs(p - q) for p in points for q in points)
    return [
        {
            "x": p["x"] + noise * size * rng.normal(),
            "y": p["y"] + noise * size * rng.normal(),
            "angle": p["angle"] + math.degrees(noise * rng.normal()),
        }
        for p in planted.positions
    ]


def motion(positions: list[dict[str, Any]], **more: Any) -> MotionProblem:
    problem = parse_problem({"kind": "motion", "positions": positions, **more})
    assert isinstance(problem, MotionProblem)
    return problem


def solved(problem: MotionProblem) -> MotionResult:
    result = solve(problem, silent)
    assert isinstance(result, MotionResult)
    return result


def the_plant(planted: Planted, problem: MotionProblem) -> LinkageDesign:
    """The planted linkage as a design for other positions, its body as it was planted."""
    one, other, first = planted.input_side, planted.output_side, planted.positions[0]
    joints = FourbarConfiguration(
        one.fixed_pivot, one.moving_pivot, other.moving_pivot, other.fixed_pivot, complex(first["x"], first["y"])
    )
    design = verify(problem, build_fourbar(joints, first["angle"]))
    assert design is not None
    return design


def driven_error(design: LinkageDesign, problem: MotionProblem) -> float:
    """Root mean square residual by plain complex numbers: the nearest pose among very many of the coupler."""
    joints = {name: complex(*z) for name, z in design.mechanism.skeleton.joints.items()}
    o2, o4, a, b, p = (joints[name] for name in ("O2", "O4", "A", "B", "P"))
    side = np.sign(((o4 - a).conjugate() * (b - a)).imag)
    start = cmath.phase(a - o2)
    angles = start + np.linspace(-math.pi, math.pi, 400_001)
    pins = o2 + abs(a - o2) * np.exp(1j * angles)
    base = o4 - pins
    f = np.abs(base)
    along = (abs(b - a) ** 2 - abs(b - o4) ** 2 + f * f) / (2.0 * f)
    height = np.sqrt(np.maximum(abs(b - a) ** 2 - along**2, 0.0))
    coupler = base / f * (along + 1j * side * height) / (b - a)
    closes = np.abs(along) <= abs(b - a)
    points = pins + coupler * (p - a)
    first = problem.positions[0].angle
    body = design.mechanism.reference_body_angle
    shift = 0.0 if body is None else math.radians(body - first)
    total = 0.0
    for position in problem.positions:
        gap = np.abs(points - position.point) / problem.task_size
        turned = np.angle(coupler * np.exp(1j * (shift - math.radians(position.angle - first))))
        total += float(np.where(closes, gap**2 + turned**2, np.inf).min())
    return math.sqrt(total / len(problem.positions))


def assert_sound_by_continuation(design: LinkageDesign) -> None:
    """Targets on one branch, in order, as the independent continuation sees them."""
    mechanism = design.mechanism
    assert mechanism.type == "fourbar"
    pivots, links = mechanism.fixed_pivots, mechanism.links
    linkage = Linkages(
        np.array([complex(*pivots.input)]),
        np.array([complex(*pivots.output)]),
        *(np.array([x]) for x in (links.input, links.coupler, links.output)),
    )
    angles = np.radians([[target.input_angle for target in design.targets]])
    sign = {"open": 1, "crossed": -1}[mechanism.assembly]
    circuit = follow(linkage, *configurations(linkage, angles, np.array([[sign]])))
    assert circuit.same_branch.all()
    assert circuit.in_order.all()


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(3))
def test_planted_linkages_are_recovered_without_noise(seed: int) -> None:
    planted = plant_many(np.random.default_rng(seed), 20)
    # Others that are off by less than usual tolerances may stand before it.
    best = min(solved(motion(planted.positions)).designs, key=lambda design: design.metrics.rms_residual)
    assert best.verification.passed
    assert best.metrics.rms_residual < 1e-9
    joints = {name: complex(*z) for name, z in best.mechanism.skeleton.joints.items()}
    expected = [(s.fixed_pivot, s.moving_pivot) for s in (planted.input_side, planted.output_side)]
    found = [(joints["O2"], joints["A"]), (joints["O4"], joints["B"])]
    gaps = [max(abs(z - w) for f, e in zip(pair, expected, strict=True) for z, w in zip(f, e, strict=True))
            for pair in (found, found[::-1])]  # fmt: skip
    assert min(gaps) < 1e-6


def assert_not_above_the_plant(seed: int, noise: float, n: int) -> None:
    rng = np.random.default_rng(seed)
    planted = plant_many(rng, n)
    problem = motion(noisy(planted, noise, rng))
    allowed = the_plant(planted, problem)
    result = solved(problem)
    if not allowed.verification.passed:
        return
    best = min(result.designs, key=lambda design: design.metrics.rms_residual)
    assert best.metrics.rms_residual <= allowed.metrics.rms_residual * (1.0 + 1e-9)
    assert best.metrics.rms_residual == pytest.approx(driven_error(best, problem), rel=1e-4, abs=1e-5)
    assert_sound_by_continuation(best)


@pytest.mark.campaign
@pytest.mark.parametrize(("seed", "noise"), [(10, 1e-4), (11, 1e-3), (12, 1e-2)])
def test_error_is_not_above_that_of_the_planted_linkage(seed: int, noise: float) -> None:
    assert_not_above_the_plant(seed, noise, 20)


@pytest.mark.campaign
@pytest.mark.parametrize("seed", range(20, 26))
def test_error_is_not_above_that_of_more_planted_linkages(seed: int) -> None:
    assert_not_above_the_plant(seed, (1e-4, 1e-3, 1e-2, 3e-2)[seed % 4], 6 + seed % 15)


@pytest.mark.campaign
def test_error_is_not_above_that_of_any_planted_linkage() -> None:
    for seed in range(100, 100 + sampled(40)):
        assert_not_above_the_plant(seed, (1e-4, 1e-3, 1e-2, 3e-2)[seed % 4], 6 + seed % 15)


def test_held_positions_stay_held_while_others_are_fitted() -> None:
    rng = np.random.default_rng(2)
    planted = plant_many(rng, 12)
    positions = noisy(planted, 3e-3, rng)
    for k in (0, 5, 11):
        positions[k] = {**planted.positions[k], "exact": True}
    problem = motion(positions)
    best = solved(problem).designs[0]
    check = {c.name: c for c in best.verification.checks}["reaches_targets"]
    assert check.passed
    assert max(best.targets[k].residual for k in (0, 5, 11)) < 1e-9
    worst = max(target.point_residual for target in best.targets)
    assert check.detail.startswith(
        f"This check covers 3 of 12 positions. The others are fitted: they are missed by at most {worst:.3g} "
    )
    assert 1e-5 < best.metrics.rms_residual <= the_plant(planted, problem).metrics.rms_residual
    assert_sound_by_continuation(best)


@pytest.mark.slow
def test_tolerances_are_kept_and_held_coordinates_met() -> None:
    rng = np.random.default_rng(3)
    planted = plant_many(rng, 8)
    positions = noisy(planted, 2e-3, rng)
    for position in positions:
        position["tolerance"] = {"x": 0.05, "y": 0.05, "angle": 1.5}
    positions[0] = dict(planted.positions[0])
    positions[7] = {**planted.positions[7], "tolerance": {"angle": 2.0}}
    problem = motion(positions)
    result = solved(problem)
    assert result.designs
    for design in result.designs:
        checks = {c.name: c for c in design.verification.checks}
        assert checks["within_tolerance"].value <= 1.0 + 1e-9
        assert design.targets[0].residual < 1e-9
        assert design.targets[7].point_residual < 1e-9 * problem.task_size
        assert all(t.point_residual <= math.hypot(0.05, 0.05) and t.angle_residual <= 2.0 for t in design.targets)
        assert_sound_by_continuation(design)


@pytest.mark.campaign
def test_too_narrow_tolerances_find_nothing_and_say_so() -> None:
    rng = np.random.default_rng(4)
    positions = noisy(plant_many(rng, 10), 3e-2, rng)
    for position in positions:
        position["tolerance"] = 1e-5
    result = solved(motion(positions))
    assert result.designs == []
    assert not result.search.complete
    assert result.search.rejected["tolerance"] > 0
    assert "tolerance" in result.summary


@pytest.mark.campaign
def test_points_with_rough_angles_are_met_exactly() -> None:
    """Eight points exactly, their angles within ten degrees: each such position leaves one number free."""
    planted = plant_many(np.random.default_rng(5), 7)
    positions = [{**p, "angle": p["angle"] + (-1) ** k * 2.0, "tolerance": {"angle": 10.0}}
                 for k, p in enumerate(planted.positions)]  # fmt: skip
    result = solved(motion(positions))
    assert result.designs
    for design in result.designs:
        assert max(t.point_residual for t in design.targets) < 1e-8


def test_stated_pivots_are_kept() -> None:
    rng = np.random.default_rng(6)
    planted = plant_many(rng, 10)
    side, other = planted.input_side, planted.output_side
    problem = motion(
        noisy(planted, 1e-3, rng),
        input_side={"fixed_pivot": [side.fixed_pivot.real, side.fixed_pivot.imag]},
        output_side={"moving_pivot": [other.moving_pivot.real, other.moving_pivot.imag]},
    )
    best = solved(problem).designs[0]
    assert {c.name for c in best.verification.checks} >= {"input_side", "output_side"}
    assert best.mechanism.type == "fourbar"
    assert complex(*best.mechanism.fixed_pivots.input) == pytest.approx(side.fixed_pivot, abs=1e-12)


@pytest.mark.parametrize("dyad", ["PR", "RP"])
def test_sliders_are_fitted_where_asked_for(dyad: str) -> None:
    """Poses of a body whose one point slides (or whose one line passes through a fixed point), carried by a link."""
    rng = np.random.default_rng(7)
    o2, a, n = 0.0 + 0.0j, 1.0 + 0.4j, 11
    line, through = cmath.exp(0.3j), 2.6 + 0.5j
    positions = []
    reach = 2.0
    for turned in np.linspace(0.0, 1.1, n):
        pin = o2 + (a - o2) * cmath.exp(1j * turned)
        if dyad == "PR":
            gap = (through - pin) * line.conjugate()
            end = pin + line * (gap.real + math.sqrt(reach**2 - gap.imag**2)) + 1j * line * gap.imag
            angle = cmath.phase(end - pin)
        else:
            angle = cmath.phase(through - pin) + math.asin(0.3 / abs(through - pin))
        p = pin + cmath.rect(1.2, angle + 0.7)
        positions.append({"x": p.real, "y": p.imag, "angle": math.degrees(angle)})
    for p in positions:
        p["x"] += 1e-4 * rng.normal()
    result = solved(motion(positions, output_side={"dyad": dyad}))
    best = result.designs[0]
    assert best.mechanism.type == ("slider_crank" if dyad == "PR" else "inverted_slider_crank")
    assert best.verification.passed
    assert best.metrics.rms_residual < 3e-4


def test_the_gradient_agrees_with_differences() -> None:
    """By the envelope theorem the derivative at the nearest poses is exact, however large the residuals are."""
    rng = np.random.default_rng(8)
    planted = plant_many(rng, 12)
    problem = motion(noisy(planted, 0.05, rng))
    task = make_motion_task(problem)
    demands = make_pose_constraints(problem, task)
    tolerances = demands.tolerances.copy()
    tolerances[[0, 11]] = 0.0
    tolerances[5] = [0.0, 0.0, 0.5]
    tolerances[6] = [1.0, 0.0, 1.0]
    found = [make_surface(task.to_task(s.fixed_pivot), task.to_task(s.moving_pivot))
             for s in (planted.input_side, planted.output_side)]  # fmt: skip
    fitting = PoseFit(PoseConstraints(demands.poses, tolerances), (found[0][0], found[1][0]))
    x = fitting.start(found[0][1], found[1][1])
    gradient = fitting.gradient(x)
    step = 1e-6
    differences = [(fitting.cost(x + step * e) - fitting.cost(x - step * e)) / (2.0 * step) for e in np.eye(len(x))]
    assert gradient == pytest.approx(np.array(differences), abs=1e-7)
    assert np.abs(gradient).max() > 1e-3


def test_a_fit_says_whether_it_has_converged() -> None:
    rng = np.random.default_rng(8)
    planted = plant_many(rng, 12)
    problem = motion(noisy(planted, 0.005, rng))
    task = make_motion_task(problem)
    found = [make_surface(task.to_task(s.fixed_pivot), task.to_task(s.moving_pivot))
             for s in (planted.input_side, planted.output_side)]  # fmt: skip
    fitting = PoseFit(make_pose_constraints(problem, task), (found[0][0], found[1][0]))
    start = fitting.start(found[0][1], found[1][1])
    short, whole = fitting.minimize(start, evaluations=2), fitting.minimize(start)
    assert short is not None
    assert short.status is Status.STEP_LIMIT
    assert whole is not None
    assert whole.status.is_converged
    assert whole.cost < short.cost
    assert np.abs(fitting.gradient(whole.point)).max() < 1e-6


@pytest.mark.parametrize("seed", [8, 20, 29])
def test_a_fit_that_has_lost_a_pose_has_not_converged(seed: int) -> None:
    """Noise of 5 % puts a pose where no nearest one is reached; its cost of 1e12 hides every other gain."""
    rng = np.random.default_rng(seed)
    planted = plant_many(rng, 20)
    problem = motion(noisy(planted, 0.05, rng))
    task = make_motion_task(problem)
    dyads = [make_surface(task.to_task(s.fixed_pivot), task.to_task(s.moving_pivot))
             for s in (planted.input_side, planted.output_side)]  # fmt: skip
    fitting = PoseFit(make_pose_constraints(problem, task), (dyads[0][0], dyads[1][0]))
    ended = fitting.minimize(fitting.start(dyads[0][1], dyads[1][1]))
    assert ended is not None
    assert ended.cost > 1e11, "otherwise this seed tests nothing"
    assert ended.status is Status.IMPOSSIBLE


def test_five_poses_give_all_planted_dyads_by_linear_algebra() -> None:
    rng = np.random.default_rng(9)
    for _ in range(15):
        planted = plant(rng, 5)
        origin = complex(planted.positions[0]["x"], planted.positions[0]["y"])
        points = np.array([complex(p["x"], p["y"]) - origin for p in planted.positions])
        fixed, moving = fit_dyads(points[None], np.radians([[p["angle"] for p in planted.positions]]))
        for side in (planted.input_side, planted.output_side):
            gap = np.abs(fixed - side.fixed_pivot + origin) + np.abs(moving - side.moving_pivot + origin)
            assert gap.min() < 1e-5


def test_surfaces_keep_their_pivots() -> None:
    rng = np.random.default_rng(10)
    for _ in range(50):
        fixed, moving = (complex(*rng.normal(size=2)) * 10.0 ** rng.uniform(-2, 2) for _ in range(2))
        assert compute_pivots(*make_surface(fixed, moving)) == pytest.approx((fixed, moving), rel=1e-12)


def test_starts_take_stated_pivots() -> None:
    planted = plant_many(np.random.default_rng(11), 9)
    problem = motion(planted.positions)
    task = make_motion_task(problem)
    pivot = planted.input_side.fixed_pivot
    (start,) = list_starts(
        task,
        make_pose_constraints(problem, task),
        DyadChoices(fixed_pivot=(pivot.real, pivot.imag)),
        np.random.default_rng(0),
    )
    fixed, moving = compute_pivots(start.surface, start.numbers)
    assert task.to_problem(fixed) == pytest.approx(pivot)
    assert task.to_problem(moving) == pytest.approx(planted.input_side.moving_pivot)


@pytest.mark.campaign
@settings(max_examples=3, deadline=None)
@given(st.floats(-3.0, 3.0), st.floats(-2.0, 2.0), st.floats(-50.0, 50.0), st.floats(-50.0, 50.0))
def test_similar_tasks_have_similar_answers(turn: float, power: float, x: float, y: float) -> None:
    rng = np.random.default_rng(12)
    positions = noisy(plant_many(rng, 9), 2e-3, rng)
    factor, shift = cmath.rect(10.0**power, turn), complex(x, y)

    def moved(p: dict[str, Any]) -> dict[str, Any]:
        z = factor * complex(p["x"], p["y"]) + shift
        return {"x": z.real, "y": z.imag, "angle": p["angle"] + math.degrees(turn)}

    # Without limits quality decides between errors that are nearly equal.
    limits, given = {"min_transmission_angle": 0.1}, (positions, [moved(p) for p in positions])
    one, other = (solved(motion(some, constraints=limits)).designs[0] for some in given)
    assert other.metrics.rms_residual == pytest.approx(one.metrics.rms_residual, rel=1e-6)
    here = {name: factor * complex(*z) + shift for name, z in one.mechanism.skeleton.joints.items()}
    there = {name: complex(*z) for name, z in other.mechanism.skeleton.joints.items()}
    gap = max(abs(here[name] - there[name]) for name in here)
    # A fit ends where its gradient is nothing beside rounding; along a flat valley that is not a sharp place.
    assert gap < 1e-3 * abs(factor) * max(abs(z - w) for z in here.values() for w in here.values())


@pytest.mark.parametrize(
    ("changes", "path"),
    [
        ({"method": "exact"}, "/method"),
        ({"input_side": {"rotations": [10.0] * 5}}, "/input_side/rotations"),
        ({"input_side": {"link_angle": 10.0}}, "/input_side/link_angle"),
        ({"output_side": {"coupler_vector": {"length": 10.0}}}, "/output_side/coupler_vector"),
        ({"output_side": {"fixed_pivot": [0.0, 0.0], "moving_pivot": [1.0, 1.0]}}, "/output_side"),
        ({"input_side": {"dyad": "RP"}}, "/input_side/dyad"),
        ({"input_side": {"dyad": "PR"}, "output_side": {"dyad": "PR"}}, "/output_side/dyad"),
        ({"input_side": {"slide_angle": 10.0}}, "/input_side/slide_angle"),
        ({"output_side": {"dyad": "PR", "fixed_pivot": [0.0, 0.0]}}, "/output_side/fixed_pivot"),
        ({"output_side": {"dyad": "RP", "moving_pivot": [0.0, 0.0]}}, "/output_side/moving_pivot"),
    ],
)
def test_contradictions_of_fits_name_the_field(changes: dict[str, Any], path: str) -> None:
    positions = plant_many(np.random.default_rng(13), 6).positions
    assert path in [c.path for c in motion(positions, **changes).find_contradictions()]


def test_contradictions_of_positions_name_the_field() -> None:
    positions: list[dict[str, Any]] = [dict(p) for p in plant_many(np.random.default_rng(14), 8).positions]
    positions[7]["tolerance"] = 0.1
    assert [c.path for c in motion(positions).find_contradictions()] == ["/positions/5"]
    positions[7]["exact"] = True
    assert "/positions/7/exact" in [c.path for c in motion(positions).find_contradictions()]
    assert [c.path for c in motion(positions[:3], method="least_squares").find_contradictions()] == ["/method"]


@pytest.mark.parametrize("tolerance", [None, {"x": 1.0, "y": 1.0, "angle": 2.0}])
def test_a_line_of_the_body_is_stated_where_the_first_position_is_missed(tolerance: dict[str, float] | None) -> None:
    """Seven positions of a planted inverted slider-crank, with noise, and its body's line at the first."""
    rng = np.random.default_rng(3)
    positions: list[dict[str, Any]] = []
    for pin in 30.0 * np.exp(1j * (0.3 + 0.2 * np.arange(7))):
        reach = complex(80.0, 10.0) - pin
        angle = cmath.phase(reach) + math.asin(8.0 / abs(reach))
        point = pin + cmath.rect(50.0, angle + 0.5)
        off = 0.3 * rng.normal(size=3)
        pose = {"x": point.real + off[0], "y": point.imag + off[1], "angle": math.degrees(angle) + off[2]}
        positions.append(pose if tolerance is None else pose | {"tolerance": tolerance})
    stated = positions[0]["angle"]
    problem = {"kind": "motion", "positions": positions, "output_side": {"dyad": "RP", "slide_angle": stated}}
    designs = solve(parse_problem(problem)).designs
    assert designs
    for design in designs:
        mechanism = design.mechanism
        stands = stated if mechanism.reference_body_angle is None else mechanism.reference_body_angle
        line = mechanism.skeleton.slides[0].angle - (stands - stated)
        assert math.remainder(line - stated, 180.0) == pytest.approx(0.0, abs=1e-5)
