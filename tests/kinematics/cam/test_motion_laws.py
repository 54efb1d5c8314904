"""Laws of motion: closed forms of their peaks, end conditions, derivatives by another route."""

from __future__ import annotations

import math

import numpy as np
import pytest

from kinematics.cam.motion.laws import LAWS, build_sine_constant_cosine
from kinematics.cam.motion.pieces import Pieces
from kinematics.errors import DimensionError
from tests.oracles.differences import derivative

PI = math.pi
ROOT_129 = math.sqrt(129.0)
MODIFIED_TRAPEZOID = 8.0 * PI / (2.0 + PI)
MODIFIED_SINE = 4.0 * PI**2 / (PI + 4.0)
# Of the double harmonic: the cosines where 8c² − c − 4 = 0 have the greatest jerk.
COSINE = (1.0 - ROOT_129) / 16.0
DOUBLE_HARMONIC_JERK = 0.5 * PI**3 * math.sqrt(1.0 - COSINE**2) * (1.0 - 4.0 * COSINE)

CLOSED_FORMS = {
    "constant_velocity": (1.0, 0.0, 0.0),
    "constant_acceleration": (2.0, 4.0, math.inf),
    "simple_harmonic": (PI / 2.0, PI**2 / 2.0, PI**3 / 2.0),
    "cycloidal": (2.0, 2.0 * PI, 4.0 * PI**2),
    "trapezoidal": (2.0, 16.0 / 3.0, 128.0 / 3.0),
    "modified_trapezoid": (2.0, MODIFIED_TRAPEZOID, 4.0 * PI * MODIFIED_TRAPEZOID),
    "modified_sine": (4.0 * PI / (PI + 4.0) * 2.0 / 2.0, MODIFIED_SINE, 4.0 * PI * MODIFIED_SINE),
    "polynomial_23": (1.5, 6.0, 12.0),
    "polynomial_345": (15.0 / 8.0, 10.0 / math.sqrt(3.0), 60.0),
    "polynomial_4567": (35.0 / 16.0, 84.0 * math.sqrt(5.0) / 25.0, 52.5),
    "polynomial_456789": (315.0 / 128.0, 2520.0 * (3.0 / 14.0) ** 3 / math.sqrt(7.0), 78.75),
    "double_harmonic": (3.0 * math.sqrt(3.0) * PI / 8.0, PI**2, DOUBLE_HARMONIC_JERK),
    "double_harmonic_reversed": (3.0 * math.sqrt(3.0) * PI / 8.0, PI**2, DOUBLE_HARMONIC_JERK),
    "half_harmonic_start": (PI / 2.0, PI**2 / 4.0, PI**3 / 8.0),
    "half_harmonic_end": (PI / 2.0, PI**2 / 4.0, PI**3 / 8.0),
    "half_cycloidal_start": (2.0, PI, PI**2),
    "half_cycloidal_end": (2.0, PI, PI**2),
}
"""Greatest |v|, |a|, |j|. Modified sine and trapezoid: Norton, Cam Design and Manufacturing Handbook, SCCA family."""


@pytest.mark.parametrize("name", CLOSED_FORMS)
def test_peak_factors_are_the_closed_forms(name: str) -> None:
    found = [factor.largest for factor in LAWS[name].factors]
    assert found == pytest.approx(CLOSED_FORMS[name], rel=1e-12, abs=1e-12)


def test_modified_constant_velocity_from_its_pulse() -> None:
    """Half the lift is V (1/2 − 1/4) plus the quarter in which a pulse of sines gathers the velocity V = A/(2π)."""
    # Distance under a quarter sine over p to velocity A 2p/π, then a quarter cosine over 3p, with p = 1/16.
    p, k = 1.0 / 16.0, 2.0 / PI
    gathered = (k * p) * (p - k * p) + k * p * 3.0 * p + (3.0 * k * p) ** 2
    a = 0.5 / (gathered + 0.25 * 4.0 * k * p)
    v, acceleration, jerk = (factor.largest for factor in LAWS["modified_constant_velocity"].factors)
    assert (v, acceleration, jerk) == pytest.approx((a / (2.0 * PI), a, 8.0 * PI * a), rel=1e-12)


def test_eighth_power_by_the_roots_of_its_derivatives() -> None:
    law = np.polynomial.Polynomial([0.0, 0.0, 0.0, 6.09755, 0.0, -20.78040, 26.73155, -13.60965, 2.56095])
    for order, factor in enumerate(LAWS["eighth_power"].factors, start=1):
        roots = law.deriv(order + 1).roots()
        inside = [root.real for root in roots if abs(root.imag) < 1e-9 and 0.0 < root.real < 1.0]
        values = law.deriv(order)(np.array([0.0, *inside, 1.0]))
        assert factor.greatest == pytest.approx(values.max(), abs=1e-10)
        assert factor.least == pytest.approx(values.min(), abs=1e-10)


@pytest.mark.parametrize("name", LAWS)
def test_a_law_goes_from_nothing_to_one(name: str) -> None:
    s, v, a, _ = LAWS[name].motion(np.array([0.0, 1.0]))
    assert s == pytest.approx([0.0, 1.0], abs=1e-13)
    rests = [not name.endswith("_end"), not name.endswith("_start")]
    if name != "constant_velocity":
        assert list(np.abs(v) < 1e-12) == rests
    smooth = ("cycloidal", "trap", "modified", "345", "4567")
    if any(word in name for word in smooth):
        assert a == pytest.approx([0.0, 0.0], abs=1e-11)


@pytest.mark.parametrize("name", LAWS)
def test_derivatives_agree_with_differences(name: str) -> None:
    law, step = LAWS[name], 2e-3
    points = np.linspace(0.02, 0.98, 49) + 1e-3 / 7.0
    nearest = np.abs(points[:, None] - law.pieces.start).min(axis=1)
    points = points[nearest > 4.0 * step]
    found = law.motion(points)
    for order in (1, 2, 3):
        by_differences = derivative(lambda h: law.motion(points + h).s, order, step)
        size = max(1.0, float(np.abs(found[order]).max()))
        assert found[order] == pytest.approx(by_differences, abs=(2e-9, 2e-8, 2e-5)[order - 1] * size)


@pytest.mark.parametrize("name", LAWS)
def test_inner_joints_are_continuous(name: str) -> None:
    pieces = LAWS[name].pieces
    inner = pieces.start[1:-1]
    after, before = pieces.motion(inner), pieces.motion(inner, before=True)
    assert after.s == pytest.approx(before.s, abs=1e-14)
    assert after.v == pytest.approx(before.v, abs=1e-13)
    if name != "constant_acceleration":
        assert after.a == pytest.approx(before.a, abs=1e-12)


def test_constant_acceleration_has_both_values_in_its_middle() -> None:
    pieces = LAWS["constant_acceleration"].pieces
    assert pieces.motion(0.5).a == pytest.approx(-4.0)
    assert pieces.motion(0.5, before=True).a == pytest.approx(4.0)
    jerk = LAWS["constant_acceleration"].factors[2]
    assert (jerk.least, jerk.at_least, jerk.greatest) == (-math.inf, 0.5, 0.0)


@pytest.mark.parametrize("name", LAWS)
def test_reversal_is_the_law_seen_from_its_end(name: str) -> None:
    u = np.linspace(0.0, 1.0, 33)
    mirrored = LAWS[name].reversed("mirrored").motion(u)
    assert mirrored.s == pytest.approx(1.0 - LAWS[name].pieces.motion(1.0 - u, before=True).s, abs=1e-12)
    assert mirrored.a == pytest.approx(-LAWS[name].pieces.motion(1.0 - u, before=True).a, abs=1e-10)


def twin(pieces: Pieces, at: float) -> list[float]:
    """The kernel's values in plain numpy."""
    piece = min(max(int(np.searchsorted(pieces.start, at, side="right")) - 1, 0), pieces.count - 1)
    x = at - pieces.start[piece]
    values = []
    for order in range(4):
        polynomial = np.polynomial.Polynomial(pieces.polynomial[piece]).deriv(order) if order else None
        value = polynomial(x) if polynomial else np.polynomial.Polynomial(pieces.polynomial[piece])(x)
        w, phase = pieces.frequency[piece], pieces.phase[piece] + 0.5 * PI * order
        values.append(float(value + (pieces.amplitude[piece] * w**order * np.sin(w * x + phase)).sum()))
    return values


@pytest.mark.parametrize("name", LAWS)
def test_the_kernel_agrees_with_its_twin(name: str) -> None:
    pieces = LAWS[name].pieces
    points = np.linspace(-0.05, 1.05, 45)
    found = np.array(pieces.motion(points))
    assert found == pytest.approx(np.array([twin(pieces, float(u)) for u in points]).T, abs=1e-10)


def test_one_law_is_a_case_of_another() -> None:
    u = np.linspace(0.0, 1.0, 21)
    for name, parts in (("cycloidal", (0.25, 0.0, 0.25)), ("simple_harmonic", (0.0, 0.0, 0.5))):
        made = build_sine_constant_cosine(name, *parts).motion(u)
        for ours, known in zip(made, LAWS[name].motion(u), strict=True):
            assert ours[:-1] == pytest.approx(known[:-1], abs=1e-11)


def test_impossible_parts_are_refused() -> None:
    for parts in ((0.3, 0.1, 0.2), (-0.1, 0.3, 0.1), (0.0, 0.0, 0.0)):
        with pytest.raises(DimensionError, match="parts of the law"):
            build_sine_constant_cosine("impossible", *parts)
