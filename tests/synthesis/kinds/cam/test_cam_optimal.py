"""Optimal motions against the known limits of cam motion, and their bounds against motions that others found."""

from __future__ import annotations

import math

import numpy as np
import pytest

from kinematics.cam.motion.laws import LAWS
from synthesis.kinds.cam.program.convex_programs import Condition, Demand, Limit
from synthesis.kinds.cam.program.knots import KnotMotion
from synthesis.kinds.cam.program.least_torque import multiply_rates
from synthesis.kinds.cam.program.optimal import (
    NoMotion,
    Optimum,
    Run,
    minimize_derivative,
    minimize_flat_size,
    minimize_force,
    minimize_roller_size,
    minimize_torque,
)
from synthesis.kinds.cam.program.piecewise import Piecewise

MODIFIED_SINE = tuple(factor.largest for factor in LAWS["modified_sine"].factors)
CLOSE = 2e-3


def dwell_to_dwell(angle: float = 1.0, lift: float = 1.0, continuity: int = 2, **limits: float) -> Run:
    names = {"v": 1, "a": 2, "j": 3}
    ends = [Condition.fix_derivative(0.0, i, 0.0) for i in range(continuity + 1)]
    ends += [Condition.fix_derivative(angle, i, lift if i == 0 else 0.0) for i in range(continuity + 1)]
    return Run(angle, tuple(ends), continuity, tuple(Limit(names[k], limit) for k, limit in limits.items()))


def found(best: Optimum | NoMotion) -> Optimum:
    assert isinstance(best, Optimum)
    return best


def least_acceleration(jerk: float) -> float:
    """Least peak acceleration of a unit rise in a unit of time, dwell to dwell, under a peak jerk."""
    return 0.25 * jerk * (1.0 - math.sqrt(1.0 - 32.0 / jerk))


def assert_meets(run: Run, motion: KnotMotion) -> None:
    """Conditions hold to rounding, limits and demands everywhere: by dense evaluation, not by the knots."""
    for condition in run.conditions:
        value = sum(k * motion.derivative(order)(at) for at, order, k in condition.terms)
        unit = run.lift / run.angle ** max(order for _, order, _ in condition.terms)
        # The last knot's state is the value from the left.
        if condition.terms[0][0] == run.angle:
            knot = int(np.abs(motion.times - run.angle).argmin())
            value = sum(k * motion.states[knot, order] for _, order, k in condition.terms)
        assert value == pytest.approx(condition.value, abs=1e-9 * unit)
    t = np.linspace(0.0, run.angle, 20011)
    for limit in run.limits:
        assert np.abs(motion.derivative(limit.order)(t)).max() <= limit.constant * (1.0 + 1e-9)
    for demand in run.demands:
        inside = t[(t >= demand.start) & (t <= demand.end)]
        value = sum(w * motion.derivative(i)(inside) for i, w in enumerate(demand.weights))
        assert np.max(value) <= demand.right + 1e-7 * run.lift
    curve = motion.displacement
    jumps = curve.coefficients[:-1].sum(axis=1) - curve.coefficients[1:, 0]
    assert np.abs(jumps).max() <= 1e-11 * run.lift


LIMITS = [
    ("peak velocity", "peak", 1, 2, {}, 1.0),
    ("peak acceleration", "peak", 2, 2, {}, 4.0),
    ("peak jerk", "peak", 3, 2, {}, 32.0),
    ("rms acceleration", "rms", 2, 2, {}, math.sqrt(12.0)),
    ("rms jerk, 3-4-5", "rms", 3, 2, {}, math.sqrt(720.0)),
    ("rms fourth derivative, 4-5-6-7", "rms", 4, 3, {}, math.sqrt(100800.0)),
    ("modified sine's jerk", "peak", 2, 2, {"j": MODIFIED_SINE[2]}, least_acceleration(MODIFIED_SINE[2])),
    ("3-4-5's jerk", "peak", 2, 2, {"j": 60.0}, least_acceleration(60.0)),
]


@pytest.mark.parametrize(
    ("measure", "order", "continuity", "limits", "known"), [row[1:] for row in LIMITS], ids=[row[0] for row in LIMITS]
)
def test_known_limits(measure, order, continuity, limits, known):
    run = dwell_to_dwell(continuity=continuity, **limits)
    best = found(minimize_derivative(run, measure, order))
    assert best.cap is None
    assert known * (1.0 - CLOSE) <= best.bound <= known * (1.0 + 1e-9)
    assert known * (1.0 - 1e-9) <= best.value <= known * (1.0 + CLOSE)
    assert_meets(run, best.motions[0])


def test_peaks_at_the_jerk_of_the_laws():
    """Printed with the statement of the limits: the law's own acceleration, and the least at its jerk."""
    for name, least, own in (
        ("modified_trapezoid", 4.728, 4.888),
        ("modified_sine", 4.613, 5.528),
        ("polynomial_345", 4.753, 5.774),
        ("cycloidal", 5.574, 6.283),
    ):
        factors = LAWS[name].factors
        assert factors[1].largest == pytest.approx(own, abs=6e-4)
        assert least_acceleration(factors[2].largest) == pytest.approx(least, abs=6e-4)


def test_least_velocity_at_modified_sines_own_acceleration_and_jerk():
    _, a, j = MODIFIED_SINE
    best = found(minimize_derivative(dwell_to_dwell(a=a, j=j), "peak", 1))
    assert best.value == pytest.approx(1.572, rel=1e-3)
    assert best.value <= best.bound * 1.001
    assert MODIFIED_SINE[0] == pytest.approx(1.760, abs=6e-4)


def test_norton_example_8_10():
    """Return at 10 in/s from 5 in to 0 within half a second, under a jerk of 4800 in/s³; his polynomial needs 230.9."""
    rate = 2.0 * math.pi
    ends = [
        Condition.fix_derivative(t, i, x / rate**i)
        for t, s in ((0.0, 5.0), (math.pi, 0.0))
        for i, x in ((0, s), (1, 10.0), (2, 0.0))
    ]
    run = Run(math.pi, tuple(ends), 2, (Limit(3, 4800.0 / rate**3),))
    best = found(minimize_derivative(run, "peak", 2))
    assert best.value * rate**2 == pytest.approx(190.1, rel=CLOSE)
    assert best.bound * rate**2 == pytest.approx(190.1, rel=CLOSE)
    assert_meets(run, best.motions[0])


@pytest.mark.parametrize("lift", [1.0, -2.5])
def test_least_inertia_torque(lift):
    """|v a| ≥ 9/4 of h²/β³, for a fall as for a rise; modified sine takes 5.458."""
    angle = 0.8
    start = max(0.0, -lift)
    ends = [
        Condition.fix_derivative(t, i, s if i == 0 else 0.0)
        for t, s in ((0.0, start), (angle, start + lift))
        for i in range(3)
    ]
    run = Run(angle, tuple(ends), 2)
    best = found(minimize_torque(run, "peak"))
    unit = lift**2 / angle**3
    assert 2.25 * (1 - CLOSE) <= best.bound / unit <= 2.25 * (1.0 + 1e-9)
    assert 2.25 <= best.value / unit <= 2.25 * (1.0 + CLOSE)
    assert multiply_rates(best.motions[0]).peak() == pytest.approx(best.value)
    assert_meets(run, best.motions[0])
    law = LAWS["modified_sine"].motion(np.linspace(0.0, 1.0, 100001))
    assert np.abs(law.v * law.a).max() == pytest.approx(5.458, abs=5e-3)


@pytest.mark.slow
def test_least_rms_torque_is_bounded_from_below_by_the_laws_and_reached():
    best = found(minimize_torque(dwell_to_dwell(), "rms"))
    assert best.value <= best.bound * 1.001
    for law in LAWS.values():
        if law.factors[1].largest < math.inf and law.name != "constant_velocity" and not law.name.startswith("half"):
            curve = law.motion(np.linspace(0.0, 1.0, 20001))
            assert math.sqrt(np.mean((curve.v * curve.a) ** 2)) >= best.bound


def test_torque_under_a_limit_on_jerk_keeps_it():
    run = dwell_to_dwell(j=MODIFIED_SINE[2])
    best = found(minimize_torque(run, "peak"))
    assert best.bound == pytest.approx(2.25, rel=CLOSE)
    assert 2.25 < best.value < 5.458
    assert_meets(run, best.motions[0])


@pytest.mark.slow
def test_motion_and_prime_radius_together():
    """Unit lift in 60°, 20°, no offset, modified sine's own peaks: 3.647 where modified sine itself needs 4.142."""
    angle, tangent = math.pi / 3.0, math.tan(math.radians(20.0))
    run = dwell_to_dwell(angle, a=MODIFIED_SINE[1] / angle**2, j=MODIFIED_SINE[2] / angle**3)
    best = found(minimize_roller_size([run], [(tangent, tangent)], 0.0, []))
    assert best.value == pytest.approx(3.647, rel=CLOSE)
    assert best.value * (1.0 - CLOSE) <= best.bound <= best.value
    assert_meets(run, best.motions[0])
    t = np.linspace(0.0, angle, 10001)
    motion = best.motions[0]
    assert np.max(np.abs(motion.derivative(1)(t)) / tangent - motion.displacement(t)) <= best.value * (1.0 + 1e-7)
    law = LAWS["modified_sine"].motion(np.linspace(0.0, 1.0, 100001))
    assert np.max(law.v / angle / tangent - law.s) == pytest.approx(4.142, abs=5e-4)


@pytest.mark.campaign
def test_offset_and_prime_radius_together():
    angle, tangent = math.pi / 3.0, math.tan(math.radians(20.0))
    run = dwell_to_dwell(angle, j=100.0 / angle**3)
    alone = found(minimize_roller_size([run], [(tangent, tangent)], 0.0, []))
    free = found(minimize_roller_size([run], [(tangent, tangent)], None, []))
    fixed = found(minimize_roller_size([run], [(tangent, tangent)], float(free.scalars[1]), []))
    assert free.value < alone.value
    assert fixed.value == pytest.approx(free.value, rel=CLOSE)
    assert free.bound <= free.value


def test_flat_faced_size():
    """Without a width, the least max(−s − a); with one, the radius grows and the width is kept."""
    angle = 1.2
    run = dwell_to_dwell(angle, j=80.0 / angle**3)
    best = found(minimize_flat_size([run], 0.3, None, None))
    radius = best.motions[0].combination((1.0, 0.0, 1.0)).minimum()[0] + best.value
    assert radius == pytest.approx(0.3, abs=1e-9)
    assert best.bound <= best.value <= best.bound * 1.001
    width = 0.8 * best.motions[0].derivative(1).peak()
    narrow = found(minimize_flat_size([run], 0.3, width, (0.0, 0.0, 0.0)))
    assert narrow.motions[0].derivative(1).peak() <= width * (1.0 + 1e-9)
    assert best.value < narrow.value
    assert narrow.bound <= narrow.value <= narrow.bound * 1.002
    for name in ("cycloidal", "modified_sine", "polynomial_345"):
        law = LAWS[name].motion(np.linspace(0.0, 1.0, 20001))
        if np.abs(law.j).max() <= 80.0:
            assert np.max(-law.s - law.a / angle**2) + 0.3 >= best.bound


def test_contact_force_stays_above_its_floor():
    """A rise against a spring: the peak force is bounded by the laws', the floor is kept exactly."""
    angle, weights, floor = 1.0, (3.0, 0.4, 1.0), 2.0
    run = dwell_to_dwell(angle, j=70.0)
    best = found(minimize_force([run], weights, floor, None, (0.0, 3.0)))
    force = best.motions[0].combination(weights)
    preload = float(best.scalars[1])
    assert force.minimum()[0] + preload >= floor * (1.0 - 1e-6)
    assert force.maximum()[0] + preload <= best.value * (1.0 + 1e-6)
    assert best.value * 0.999 <= best.bound <= best.value
    law = LAWS["modified_sine"].motion(np.linspace(0.0, 1.0, 20001))
    theirs = weights[0] * law.s + weights[1] * law.v + weights[2] * law.a
    assert max(theirs.max(), 3.0) - min(theirs.min(), 0.0) + floor >= best.bound


def test_interior_conditions_and_band():
    """A point to pass with a velocity, and a band to stay in: met exactly, and they cost something."""
    plain = dwell_to_dwell()
    conditions = (*plain.conditions, Condition.fix_derivative(0.3, 0, 0.4), Condition.fix_derivative(0.6, 1, 0.9))
    band = (Demand((-1.0,), -0.5, (), 0.55, 0.7), Demand((1.0,), 0.6, (), 0.55, 0.7))
    run = Run(1.0, conditions, 2, (Limit(3, 900.0),), band)
    best = found(minimize_derivative(run, "peak", 2))
    assert_meets(run, best.motions[0])
    assert best.value > 5.0
    assert best.bound <= best.value <= best.bound * 1.02


def test_a_rise_and_fall_in_one_run_beat_two_separate_ones():
    """Acceleration need not vanish at the top; position and velocity there are conditions within the run."""
    ends = [Condition.fix_derivative(t, i, 0.0) for t in (0.0, 2.0) for i in range(3)]
    run = Run(
        2.0, (*ends, Condition.fix_derivative(1.0, 0, 1.0), Condition.fix_derivative(1.0, 1, 0.0)), 2, (Limit(3, 69.5),)
    )
    best = found(minimize_derivative(run, "peak", 2))
    assert best.value < 0.99 * least_acceleration(69.5)
    assert_meets(run, best.motions[0])
    assert best.bound <= best.value <= best.bound * 1.002


def test_a_periodic_run_has_a_free_state_that_the_bound_accounts_for():
    """Up and down in a whole turn, with the acceleration free but equal at both ends."""
    terms = tuple(Condition(((2.0, i, 1.0), (0.0, i, -1.0)), 0.0) for i in (1, 2))
    stated = (
        Condition.fix_derivative(0.0, 0, 0.0),
        Condition.fix_derivative(0.0, 1, 0.0),
        Condition.fix_derivative(1.0, 0, 1.0),
        Condition.fix_derivative(1.0, 1, 0.0),
    )
    run = Run(2.0, (*stated, Condition.fix_derivative(2.0, 0, 0.0), *terms), 2)
    best = found(minimize_derivative(run, "rms", 3))
    # The unrestricted optimum is a periodic spline; a cosine is a near feasible rival.
    rival = math.pi**3 / 2.0 / math.sqrt(2.0)
    assert best.bound <= best.value <= best.bound * 1.001
    assert best.value <= rival
    assert best.value >= 0.9 * rival


def test_limits_that_no_motion_keeps():
    proven = minimize_derivative(dwell_to_dwell(a=3.9), "peak", 1)
    assert isinstance(proven, NoMotion)
    assert proven.factor == pytest.approx(4.0 / 3.9, rel=1e-4)
    assert proven.factor <= 4.0 / 3.9 * (1.0 + 1e-12)
    own = minimize_derivative(dwell_to_dwell(a=4.6, j=60.0), "peak", 2)
    assert isinstance(own, NoMotion)
    assert own.factor is not None
    assert own.factor > 1.0


@pytest.mark.campaign
def test_the_bound_is_not_above_any_of_many_feasible_motions():
    """Laws whose own peaks are the limits never do better than the bound."""
    for name in ("cycloidal", "modified_sine", "modified_trapezoid", "polynomial_345", "polynomial_4567"):
        v, a, j = (factor.largest for factor in LAWS[name].factors)
        assert found(minimize_derivative(dwell_to_dwell(j=j), "peak", 2)).bound <= a
        assert found(minimize_derivative(dwell_to_dwell(a=a, j=j), "peak", 1)).bound <= v
        assert found(minimize_derivative(dwell_to_dwell(v=v, a=a), "peak", 3)).bound <= j


def test_exact_extremes_of_piecewise_polynomials():
    rng = np.random.default_rng(5)
    curve = Piecewise(np.array([0.0, 0.5, 1.7, 2.0]), rng.normal(size=(3, 5)))
    x = np.linspace(0.0, 1.0, 100001)
    dense = np.polynomial.polynomial.polyval(x, curve.coefficients.T)
    (greatest, where), (least, _) = curve.maximum(), curve.minimum()
    assert greatest == pytest.approx(dense.max(), abs=1e-8)
    assert least == pytest.approx(dense.min(), abs=1e-8)
    assert min(abs(curve(where) - greatest), abs(curve(where - 1e-12) - greatest)) <= 1e-8
    assert curve.rms() == pytest.approx(math.sqrt((dense**2).mean(axis=1) @ curve.steps / 2.0), rel=1e-4)
    assert curve.convex_integral(np.abs) >= np.abs(dense).mean(axis=1) @ curve.steps
