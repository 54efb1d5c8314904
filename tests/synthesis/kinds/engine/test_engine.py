"""Engines: harmonics against exact pistons, all even arrangements against brute force, the known engines first."""

from __future__ import annotations

import itertools
import math
from typing import Any

import numpy as np
import pytest

from kinematics.engine.firing import list_firing_choices
from kinematics.engine.pistons import compute_acceleration_harmonics, compute_piston_motion
from synthesis.dispatch import solve
from synthesis.kinds.engine.arrangement import arrange_cylinders
from synthesis.kinds.engine.balancers import compute_peak
from synthesis.kinds.engine.design import EngineDesign, EngineResult
from synthesis.kinds.engine.enumeration import (
    _count_arrangements,
    _enumerate_words,
    compute_slots,
    list_even_arrangements,
    select_distinct,
)
from synthesis.kinds.engine.forces import compute_cylinder
from synthesis.kinds.engine.problem import EngineLayout, EngineProblem
from synthesis.kinds.engine.verification import verify_engine
from synthesis.registry import get_first_example, parse_problem
from tests.cases import Case, cases

Statement = dict[str, Any]


def stated(count: int, layout: Statement, strokes: int = 4, **changes: Any) -> Statement:
    base = {"kind": "engine", "cylinders": count, "stroke_cycle": strokes, "stroke": 2.0, "rod_ratio": 3.5}
    return base | {"layout": layout} | changes


def answered(count: int, layout: Statement, strokes: int = 4, **changes: Any) -> EngineResult:
    problem = parse_problem(stated(count, layout, strokes, **changes))
    result = solve(problem, lambda fraction, message: None)
    assert isinstance(result, EngineResult)
    return result


def only(count: int, layout: Statement, strokes: int = 4, **changes: Any) -> EngineDesign:
    (design,) = answered(count, layout, strokes, **changes).designs
    return design


def spectrum(design: EngineDesign, weigh: bool) -> np.ndarray:
    """Fourier coefficients of −Σ a u/(r ω²) of exact pistons, whose second derivatives are taken numerically."""
    turn, ratio = 2.0 * math.pi * np.arange(2048) / 2048, design.mechanism.rod / design.mechanism.crank
    total = np.zeros(2048, np.complex128)
    for one in design.mechanism.cylinders:
        after = turn - math.radians(one.phase + one.axis)
        place = np.cos(after) + np.sqrt(ratio**2 - np.sin(after) ** 2)
        number = np.fft.fftfreq(2048, 1.0 / 2048)
        push = np.fft.ifft(number**2 * np.fft.fft(place)).real
        total += (one.place if weigh else 1.0) * push * np.exp(1j * math.radians(one.axis))
    return np.asarray(np.fft.fft(total) / 2048)


LAYOUTS: list[tuple[int, Statement]] = [
    *((n, {"type": "inline"}) for n in range(1, 17)),
    *((n, {"type": "vee", "vee_angle": 10.0 * n}) for n in range(2, 17, 2)),
    *((n, {"type": "vee", "vee_angle": 75.0, "pins": "own"}) for n in (3, 5)),
    *((n, {"type": "opposed", "pins": "own"}) for n in range(2, 17, 3)),
    *((n, {"type": "opposed"}) for n in (2, 6, 12)),
    *((n, {"type": "radial"}) for n in range(1, 17)),
    *((n, {"type": "w", "vee_angle": 60.0}) for n in (3, 12)),
]


@pytest.mark.parametrize(("count", "layout"), LAYOUTS, ids=[f"{one['type']}-{n}" for n, one in LAYOUTS])
def test_harmonics_are_those_of_exact_pistons(count: int, layout: Statement) -> None:
    rng = np.random.default_rng(count)
    throws = EngineLayout.model_validate(layout).count_throws(count) or 0
    phases = rng.uniform(0.0, 360.0, throws).round(3).tolist()
    design = only(count, layout | {"throws": phases}, strokes=2)
    assert design.verification.passed
    force, moment = spectrum(design, weigh=False), spectrum(design, weigh=True)
    for harmonic in design.harmonics:
        k = harmonic.order
        if k == 3:
            continue
        size = harmonic.coefficient
        assert size is not None
        for found, told in ((force, harmonic.force), (moment, harmonic.moment)):
            parts = np.array([told.forward, told.backward]) * abs(size)
            assert np.abs(found[[k, -k]]) == pytest.approx(parts, abs=1e-9 * count**2)


@pytest.mark.parametrize("ratio", [0.05, 0.2857, 0.6, 0.95])
def test_the_series_of_the_piston(ratio: float) -> None:
    turn = 2.0 * math.pi * np.arange(4096) / 4096
    moved = compute_piston_motion(turn, ratio, 1.0)
    waves = 2.0 * np.fft.fft(-moved.bend / ratio).real / 4096
    found = compute_acceleration_harmonics(ratio, 12)
    assert [waves[k] for k in found] == pytest.approx(list(found.values()), abs=1e-12)
    small = ratio + ratio**3 / 4.0 + 15.0 * ratio**5 / 128.0
    if ratio < 0.5:
        assert found[2] == pytest.approx(small, abs=0.2 * ratio**7)
    step = 1e-6
    slope = (
        compute_piston_motion(turn + step, ratio, 1.0).place - compute_piston_motion(turn - step, ratio, 1.0).place
    ) / (2.0 * step)
    assert moved.slope == pytest.approx(slope, abs=1e-8)


def brute_force(count: int, layout: EngineLayout, strokes: int) -> set[tuple[float, ...]]:
    """All even-firing arrangements with throws at multiples of 360/(2n), by going through all of them."""
    throws = layout.count_throws(count) or 0
    steps = [360.0 / (2 * count) * k for k in range(2 * count)]
    even = []
    for others in itertools.product(steps, repeat=throws - 1):
        phases = (0.0, *others)
        top = arrange_cylinders(layout, count, phases).top
        if list_firing_choices(top, strokes).unevenness < 1e-6:
            even.append(phases)
    return set(select_distinct(iter(even), layout, count))


VEES = ((2, 90.0), (4, 90.0), (6, 60.0), (6, 120.0), (8, 90.0))
SMALL: list[tuple[int, Statement]] = [
    *((n, {"type": "inline"}) for n in (1, 2, 3, 4)),
    *(
        (n, {"type": "vee", "vee_angle": angle})
        for n, angle in ((2, 90.0), (4, 90.0), (6, 60.0), (6, 120.0), (8, 90.0))
    ),
    *((n, {"type": "opposed", "pins": "own"}) for n in (2, 3, 4)),
    (4, {"type": "vee", "vee_angle": 45.0, "pins": "own"}),
    (3, {"type": "w", "vee_angle": 120.0}),
    (5, {"type": "radial"}),
]


@pytest.mark.slow
@pytest.mark.parametrize("strokes", [2, 4])
@pytest.mark.parametrize(("count", "layout"), SMALL, ids=[f"{one['type']}-{n}" for n, one in SMALL])
def test_all_even_arrangements_are_found(count: int, layout: Statement, strokes: int) -> None:
    problem: Any = parse_problem(stated(count, layout, strokes))
    found = list_even_arrangements(problem, problem.layout)
    assert found.complete
    assert found.total == len(found.phases)
    assert set(found.phases) == brute_force(count, problem.layout, strokes)


OWN: list[Statement] = [
    {"type": "inline"},
    {"type": "opposed", "pins": "own"},
    {"type": "vee", "vee_angle": 50.0, "pins": "own"},
    {"type": "w", "vee_angle": 50.0, "pins": "own"},
]


@pytest.mark.parametrize("strokes", [2, 4])
@pytest.mark.parametrize("count", [5, 6, 7, 8])
@pytest.mark.parametrize("layout", OWN, ids=["inline", "opposed", "vee", "w"])
def test_arrangements_are_counted_as_they_are_listed(layout: Statement, count: int, strokes: int) -> None:
    """Burnside's lemma, which counts more than eight throws, against the lists of fewer."""
    made, slots = EngineLayout.model_validate(layout), compute_slots(count, strokes)
    problem: Any = parse_problem(stated(count, layout, strokes))
    assert _count_arrangements(made, slots, count) == len(list_even_arrangements(problem, made).phases)


def test_words_keep_to_the_slots() -> None:
    words = list(_enumerate_words([[0]] * 4, compute_slots(4, 4)))
    assert words == [(0, 0, 1, 1), (0, 1, 0, 1), (0, 1, 1, 0)]


def firsts(count: int, layout: Statement, strokes: int = 4, **changes: Any) -> EngineDesign:
    result = answered(count, layout, strokes, **changes)
    assert result.search.complete
    assert all(design.verification.passed for design in result.designs)
    return result.designs[0]


def test_the_inline_four() -> None:
    best = firsts(4, {"type": "inline"})
    assert best.mechanism.throws == [0.0, 180.0, 180.0, 0.0]
    assert best.firing.orders[0].order == [1, 3, 4, 2]
    assert best.firing.orders[0].reversed == [1, 2, 4, 3]
    assert (best.metrics.primary_force, best.metrics.primary_moment, best.metrics.secondary_force) == (0.0, 0.0, 4.0)


@pytest.mark.slow
def test_the_inline_six() -> None:
    best = firsts(6, {"type": "inline"})
    mirrored = [(-phase) % 360.0 for phase in best.mechanism.throws]
    assert [0.0, 240.0, 120.0, 120.0, 240.0, 0.0] in (best.mechanism.throws, mirrored)
    for harmonic in best.harmonics:
        if harmonic.order in (1, 2, 4):
            assert (harmonic.force.major, harmonic.moment.major) == (0.0, 0.0)
    assert best.firing.orders[0].order in ([1, 5, 3, 6, 2, 4], [1, 4, 2, 6, 3, 5])
    assert best.balancers == []


@pytest.mark.slow
def test_the_cross_plane_vee_eight() -> None:
    best = firsts(8, {"type": "vee", "vee_angle": 90.0})
    assert best.mechanism.throws == [0.0, 90.0, 270.0, 180.0]
    couple = best.harmonics[0].moment
    assert (couple.major, couple.minor) == pytest.approx((math.sqrt(10.0), math.sqrt(10.0)))
    (balancer,) = best.balancers
    assert (balancer.form, balancer.against) == ("crankshaft_weights", "moment")
    assert balancer.forward == pytest.approx(math.sqrt(10.0))


@pytest.mark.slow
def test_the_vee_six_of_sixty_degrees() -> None:
    """Pins of their own 60° apart: primary and secondary couples of constant size."""
    best = firsts(6, {"type": "vee", "vee_angle": 60.0, "pins": "own", "positions": [0, 0, 1, 1, 2, 2]} | {})
    first, second = best.harmonics[0], best.harmonics[1]
    assert (first.force.major, second.force.major) == (0.0, 0.0)
    assert first.moment.major == pytest.approx(first.moment.minor)
    assert second.moment.major == pytest.approx(second.moment.minor)


def test_the_boxer_twin() -> None:
    best = firsts(2, {"type": "opposed", "pins": "own"})
    assert best.mechanism.throws == [0.0, 180.0]
    assert [harmonic.force.major for harmonic in best.harmonics if harmonic.order != 3] == [0.0, 0.0, 0.0, 0.0]
    assert best.harmonics[0].moment.major == pytest.approx(1.0)


@pytest.mark.slow
def test_layouts_are_compared() -> None:
    """Six cylinders: inline and a boxer, of which neither leaves a force; the vee of 90° has no even throws."""
    others = [{"type": "vee", "vee_angle": 90.0}, {"type": "opposed", "pins": "own"}]
    result = answered(6, {"type": "inline"}, other_layouts=others)
    counts = [answered(6, layout).count for layout in ({"type": "inline"}, *others)]
    assert counts[1] == 0
    assert result.count == sum(counts)
    assert result.designs[0].mechanism.layout == "inline"
    nothing = answered(6, others[0])
    assert (nothing.designs, nothing.search.complete) == ([], True)
    assert "No arrangement" in nothing.summary


def test_stated_throws_need_not_fire_evenly() -> None:
    result = answered(4, {"type": "vee", "vee_angle": 72.0}, throw_angles=[0.0, 90.0, 180.0, 270.0])
    assert result.count == 3
    assert result.search.complete
    least = [design.metrics.unevenness for design in result.designs]
    assert least == sorted(least)
    assert least[0] > 1.0


@pytest.mark.slow
@pytest.mark.parametrize(("count", "strokes"), [(10, 4), (12, 4), (9, 4), (10, 2)])
def test_more_throws_are_counted(count: int, strokes: int) -> None:
    result = answered(count, {"type": "inline"}, strokes, max_designs=2)
    assert not result.search.complete
    assert result.count > 4000
    assert result.search.candidates < result.count
    assert all(design.verification.passed for design in result.designs)
    assert result.designs[0].metrics.unevenness < 1e-6
    if count == 12:
        assert result.designs[0].metrics.secondary_force == 0.0


WEIGHED = get_first_example("engine")


@pytest.mark.parametrize(
    ("part", "broken"),
    [
        ("crank", "harmonics"),
        ("throw", "harmonics"),
        ("firing", "fires_at_top"),
        ("coefficient", "piston_series"),
        ("torque", "torque"),
        ("pin", "pin_forces"),
        ("shaking", "shaking_force"),
        ("balancer", "balancers"),
        ("flywheel", "coefficient"),
    ],
)
def test_verification_notices_a_changed_claim(part: str, broken: str) -> None:
    problem: Any = parse_problem(WEIGHED)
    result: Any = solve(problem, lambda fraction, message: None)
    claims = result.designs[0].model_dump(mode="json")
    if part == "crank":
        claims["harmonics"][1]["force"]["forward"] *= 1.0 + 1e-6
    if part == "throw":
        claims["mechanism"]["cylinders"][1]["phase"] += 1e-3
    if part == "firing":
        claims["firing"]["orders"][0]["angles"][2] += 1e-3
    if part == "coefficient":
        claims["harmonics"][1]["coefficient"] *= 1.0 + 1e-6
    if part == "torque":
        claims["course"]["gas_torque"][40] += 1e-3
    if part == "pin":
        claims["course"]["crank_pin_y"][100] += 0.1
    if part == "shaking":
        claims["course"]["shaking_x"][100] += 0.1
    if part == "balancer":
        claims["balancers"][0]["forward"] *= 1.0 + 1e-6
    if part == "flywheel":
        claims["flywheel"]["inertia"] *= 1.0 - 1e-4
    claims["metrics"].setdefault("forces", None)
    verdict = verify_engine(
        problem, EngineDesign.model_validate(claims | {"verification": {"passed": True, "checks": []}})
    )
    assert broken in {check.name for check in verdict.checks if not check.passed}


def book_engine(given: dict[str, Any], **changes: Any) -> EngineProblem:
    """A cylinder of the book: two-term unless stated, in its own consistent units."""
    problem: Any = parse_problem(
        {
            "kind": "engine",
            "units": "consistent",
            "cylinders": 1,
            "stroke_cycle": 2,
            "stroke": 2.0 * given["r"],
            "rod": float(given["l"]),
            "masses": {
                "piston": given["m4"],
                "rod": {"mass": given["m3"], "cg": given["cg3_from_crankpin_over_l"] * given["l"]},
                "crank": {"mass": given["m2"], "cg": given["rG2_over_r"] * given["r"]},
            },
            "layout": {"type": "inline", "throws": [0.0]},
            "speed_rpm": float(given["rpm"]),
            "method": "two_term",
        }
        | changes
    )
    assert isinstance(problem, EngineProblem)
    return problem


BALANCES = cases("engine_balance", "dynamics")


@pytest.mark.parametrize("case", [row for row in BALANCES if "r" in row.values[0].inputs])
def test_balance_of_one_cylinder(case: Case) -> None:
    given: dict[str, Any] = case.inputs or {}
    problem = book_engine(given)
    speed = given["rpm"] * math.pi / 30.0
    at = np.array([float(given["angle"])])
    shaking = complex(compute_cylinder(problem, at, speed).shaking[0])
    unit = given["r"] * speed**2 * complex(np.exp(1j * np.radians(at[0])))
    rod_b = given["m3"] * given["cg3_from_crankpin_over_l"]
    throw = given["m2"] * given["rG2_over_r"]
    unbalanced, exact = shaking + throw * unit, shaking - (given["m3"] - rod_b) * unit
    over = exact - 2.0 / 3.0 * (given["m4"] + rod_b) * unit
    found = {"unbalanced": unbalanced, "exact_balance": exact, "overbalance_2_3": over}
    peaks = {
        "peak_unbalanced": compute_peak(problem, speed, turning=False, share=0.0),
        "peak_exact_balance": compute_peak(problem, speed, turning=True, share=0.0),
        "peak_overbalance_2_3": compute_peak(problem, speed, turning=True, share=2.0 / 3.0),
    }
    case.check(
        **peaks,
        **{f"Fx_{name}": force.real for name, force in found.items()},
        **{f"Fy_{name}": force.imag for name, force in found.items()},
    )


@pytest.mark.parametrize("case", [row for row in BALANCES if "r" not in row.values[0].inputs])
def test_overbalance_of_inferred_masses(case: Case) -> None:
    """The book prints two peaks, from which the masses follow: all of m_B in the piston, all of m_A in the throw."""
    given: dict[str, Any] = case.inputs or {}
    crank, speed = 0.5 * given["stroke"], given["rpm"] * math.pi / 30.0
    to_and_fro = given["peak_exactly_balanced"] / (crank * speed**2 * (1.0 + 1.0 / given["l_over_r"]))
    turning = (given["peak_unbalanced"] - given["peak_exactly_balanced"]) / (crank * speed**2)
    data = {"r": crank, "l": given["l_over_r"] * crank, "m2": turning, "rG2_over_r": 1.0, "rpm": given["rpm"]}
    problem = book_engine(data | {"m3": 0.0, "cg3_from_crankpin_over_l": 0.5, "m4": to_and_fro})
    result: Any = solve(problem, lambda fraction, message: None)
    best = result.designs[0].overbalance
    over = compute_peak(problem, speed, turning=True, share=given["overbalance_fraction"])
    assert best.unbalanced_peak == pytest.approx(given["peak_unbalanced"], rel=1e-9)
    case.check(
        peak_overbalanced=over,
        ratio_percent=100.0 * over / given["peak_unbalanced"],
        best_fraction_percent=case.expected["best_fraction_percent"].value,
        best_fraction=best.share,
        best_peak_over_mBrw2=best.peak / (to_and_fro * crank * speed**2),
        peak_at_6000=best.unbalanced_peak * (6000.0 / given["rpm"]) ** 2,
    )
    assert 100.0 * best.share == pytest.approx(case.expected["best_fraction_percent"].value, abs=0.06)


@pytest.mark.parametrize("case", cases("piston_acceleration", "dynamics"))
def test_the_acceleration_of_a_piston(case: Case) -> None:
    given: dict[str, Any] = case.inputs or {}
    turned = np.array([given["omega"] * given["t"]])
    exact, series = (
        float(compute_piston_motion(turned, given["r"], given["l"], two_term=two).bend[0]) * given["omega"] ** 2
        for two in (False, True)
    )
    case.check(
        angle=math.degrees(float(turned[0])),
        exact=exact,
        series=series,
        error_percent=100.0 * (exact - series) / exact,
    )


def test_the_overbalance_is_least() -> None:
    (case,) = [row.values[0] for row in cases("engine_balance", "dynamics") if row.id == "n-p13-20"]
    problem = book_engine(case.inputs or {}, method="exact")
    result: Any = solve(problem, lambda fraction, message: None)
    best = result.designs[0].overbalance
    speed = (problem.speed_rpm or 0.0) * math.pi / 30.0
    others = [compute_peak(problem, speed, turning=True, share=share) for share in np.linspace(0.0, 1.0, 101)]
    assert best.peak <= min(others)
    assert min(others) <= 1.01 * best.peak
    assert 0.4 < best.share < 0.8
