"""Bounds of the inertia torque: no motion beats them, with limits on acceleration and jerk or without."""

from __future__ import annotations

import copy
import math

import numpy as np
import pytest
from scipy.optimize import minimize

from kinematics.cam.motion.laws import LAWS
from synthesis.kinds.cam.program.composition import Composition, compose_program
from synthesis.registry import list_examples, parse_problem

BASE = list_examples("cam")[0]
BETA, LIFT = 0.5 * math.pi, 10.0
UNIT = LIFT**2 / BETA**3
"""Of v a: for a unit lift over a unit angle it is 1."""

SMOOTH = ("cycloidal", "modified_trapezoid", "modified_sine", "polynomial_345", "polynomial_4567", "trapezoidal")


def composed(minimize_what="peak_torque", **limits):
    segments = copy.deepcopy(BASE["segments"])
    for segment in segments:
        if "law" in segment:
            segment["law"] = "optimal"
            segment.pop("lift", None)
    segments[1]["lift"] = LIFT
    statement = copy.deepcopy(BASE) | {"segments": segments, "minimize": minimize_what}
    statement["limits"] = {"pressure_angle": 30.0} | limits
    found = compose_program(parse_problem(statement))
    assert isinstance(found, Composition)
    return found


def test_the_known_limit():
    """Peak |v a| of a unit lift over a unit angle is 9/4 at least."""
    found = composed()
    assert found.bound == pytest.approx(2.25 * UNIT, rel=1e-3)
    assert found.bound <= found.value <= found.bound * 1.002


@pytest.mark.campaign
@pytest.mark.parametrize("law", SMOOTH)
def test_no_law_beats_the_bound_under_its_own_peaks(law):
    """Each law keeps its own peaks: the best motion under those is as good, and the bound is below both."""
    _, a, j = (factor.largest for factor in LAWS[law].factors)
    motion = LAWS[law].pieces.motion(np.linspace(0.0, 1.0, 20_001))
    own = float(np.abs(motion.v * motion.a).max()) * UNIT
    found = composed(acceleration=1.001 * a * LIFT / BETA**2, jerk=1.001 * j * LIFT / BETA**3)
    assert found.bound <= own
    assert found.bound <= found.value <= own * 1.01
    assert "without limits on acceleration and jerk" in found.scope


@pytest.mark.campaign
@pytest.mark.parametrize("seed", range(6))
def test_no_polynomial_beats_the_bound(seed):
    """Another solver (SLSQP) on another family of motions: 3-4-5 and u³(1−u)³ times powers of u."""
    rng = np.random.default_rng(seed)
    name = ("peak_torque", "rms_torque")[seed % 2]
    u = np.linspace(0.0, 1.0, 801)
    base = np.polynomial.Polynomial([0, 0, 0, 10, -15, 6])
    bump = np.polynomial.Polynomial([0, 0, 0, 1, -3, 3, -1])
    parts = [base, *(bump * np.polynomial.Polynomial(np.eye(6)[k]) for k in range(6))]
    v, a = (np.array([part.deriv(order)(u) for part in parts]) for order in (1, 2))

    def product(c):
        weights = np.concatenate([[1.0], c])
        return (weights @ v) * (weights @ a)

    def cost(c, power):
        return float(np.mean(np.abs(product(c)) ** power) ** (1.0 / power))

    power = 2.0 if name == "rms_torque" else 60.0
    best = minimize(cost, rng.normal(0.0, 1.0, 6), args=(power,), method="SLSQP", options={"maxiter": 200})
    reached = float(np.abs(product(best.x)).max()) if name == "peak_torque" else cost(best.x, 2.0)
    found = composed(name)
    # Rise and fall are alike, and the dwells between take half of the turn.
    bound = found.bound / UNIT * (1.0 if name == "peak_torque" else math.sqrt(2.0))
    assert bound <= reached * (1.0 + 1e-9)
    assert reached <= bound * 1.6
