"""Exact derivatives of a linkage's deviations by its dimensions, through the closure of its loop.

In the letters of :mod:`kernels`: the pin B of the coupler u = B − A is guided with the normal n, n·dB = r, where r =
n·dO4 + c dc for the output of a fourbar, and n·dO2 − do for a slide at the offset o. From dB = dO2 + dk + û db + i u
dφ follow

    dφ = (r − n·(dO2 + dk + û db)) / n·iu,        dP = dO2 + dk + û dp + i (P − A) dφ,        dk = e^{iθ} da + i k dθ,

so the input θ is treated as one more dimension. A further differentiation gives, with ω = ∂φ/∂θ and v = ∂P/∂θ,

    dω = −(dn·i(k + ω u) + n·i(dk + ω du)) / n·iu,        dv = i (dk + p dω + ω dp').

An adjusted input minimizes the sum of the squares of distance and angle in their units, e·v/E² + ε ω/Ω² = 0, which
gives dθ for every dimension. The input that minimizes the larger of both, used to judge variants, has no derivative
where a target is met exactly. Sources: Norton, Design of Machinery, Sec. 4.10 (transmission angle); Chase and
Greenwood, Design issues in mechanical tolerance analysis, Manufacturing Review 1 (1988) 50, for closures as tolerance
chains.
"""

from __future__ import annotations

import dataclasses
import math
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Complex, Integers, Real
from kinematics.linkage.variation.variants import Task, measure_deviations

POLISH_STEPS = 2
"""Newton steps that polish the closest inputs; the kernels leave an error of 1e-6 rad."""


class Sensitivities(NamedTuple):
    """Derivatives of the deviations at targets by n dimensions.

    Attributes
    ----------
    inputs : float, shape (t,)
        Closest inputs of the nominal linkage, radians.
    offsets : float, shape (t, 3)
        Deviations x, y, angle at these inputs (see :func:`measure_deviations`).
    fixed : float, shape (t, 3, n)
        Derivatives of the deviations at fixed inputs.
    motion : float, shape (t, 3)
        Derivatives of the deviations by the input.
    rates : float, shape (t, 3, n)
        Derivatives of the deviations with the input adjusted; the same as ``fixed`` if it is not adjusted.
    least : float or None
        Minimum transmission angle over the used range, radians; None without a range.
    least_rates : float, shape (n,)
        Derivatives of that angle; zeros without a range. If the minimum occurs twice, those at the first place.
    """

    inputs: Real
    offsets: Real
    fixed: Real
    motion: Real
    rates: Real
    least: float | None
    least_rates: Real


class _Loop(NamedTuple):
    """The loop at t inputs, and the derivatives of its parts by the n dimensions and, last, by the input.

    ``u``, ``normal`` and ``arm`` (P − A) have the shape (t,), all others (t, n + 1); ``turn`` is that of the coupler.
    """

    u: Complex
    normal: Complex
    arm: Complex
    turn: Real
    du: Complex
    dn: Complex
    db: Complex
    dp: Complex
    dturn: Real
    """Derivatives of ∂φ/∂θ."""
    dv: Complex
    """Derivatives of ∂P/∂θ."""


def _dot(a: Complex, b: Complex | np.complex128) -> Real:
    return np.asarray((a * np.conj(b)).real)


def _differentiate_loop(task: Task, row: Real, inputs: Real, assemblies: Integers) -> _Loop:
    """Differentiate the loop of the linkage with the dimensions ``row``, shape (n,)."""
    n = len(row)
    lengths = 3 if task.slides else 4
    a, b = row[lengths], row[lengths + 1]
    shape = len(inputs), n + 1
    crank = a * np.exp(1j * inputs)
    # Direct effect of each dimension: O2, the length b, P on its link, and the guide of B.
    o2, dk, along, place = (np.zeros(shape, np.complex128) for _ in range(4))
    o2[:, 0], o2[:, 1] = 1.0, 1j
    dk[:, lengths], dk[:, n] = np.exp(1j * inputs), 1j * crank
    if task.slides:
        normal = np.full(len(inputs), 1j * task.slide_direction)
        across = -row[2] - _dot(crank, normal)
        u = task.slide_direction * (assemblies * np.sqrt((b - across) * (b + across))) + normal * across
        guide = _dot(normal[:, None], o2)
        guide[:, 2] -= 1.0
        held = np.zeros(shape, np.complex128)
    else:
        c = row[6]
        diagonal = complex(row[2] - row[0], row[3] - row[1]) - crank
        f = np.abs(diagonal)
        part = (f * f + (b - c) * (b + c)) / (2.0 * f)
        u = diagonal / f * (part + 1j * assemblies * np.sqrt((b - part) * (b + part)))
        normal = u - diagonal
        held = np.zeros(shape, np.complex128)
        held[:, 2], held[:, 3] = 1.0, 1j
        guide = _dot(normal[:, None], held)
        guide[:, 6] += c
    unit = u / b
    along[:, lengths + 1] = unit
    arm = np.zeros_like(u)
    if task.guides:
        arm = complex(row[-2], row[-1]) * unit
        place[:, n - 2], place[:, n - 1] = unit, 1j * unit
    lever = _dot(normal, 1j * u)[:, None]
    turn = (guide - _dot(normal[:, None], o2 + dk + along)) / lever
    du = along + 1j * u[:, None] * turn
    db = o2 + dk + du
    dn = np.zeros_like(db) if task.slides else db - held
    darm = place + 1j * arm[:, None] * turn
    speed = turn[:, n:]
    dturn = (
        -(_dot(dn, 1j * (crank[:, None] + speed * u[:, None])) + _dot(normal[:, None], 1j * (dk + speed * du))) / lever
    )
    dv = 1j * (dk + arm[:, None] * dturn + speed * darm)
    return _Loop(u, normal, arm, turn, du, dn, db, o2 + dk + darm, dturn, dv)


def compute_sensitivities(task: Task, nominal: Real) -> Sensitivities:
    """Compute derivatives of a linkage's deviations, and of its minimum transmission angle, by its dimensions.

    Parameters
    ----------
    task : Task
        The targets, with the units in which misses are compared.
    nominal : float, shape (n,)
        Dimensions, as for :func:`measure_deviations`. The linkage must have a position at every target.

    Returns
    -------
    Sensitivities
        Not finite if the linkage is at a toggle.
    """
    square = dataclasses.replace(task, greatest=False)
    driven = measure_deviations(square, nominal[None])
    inputs, offsets = driven.inputs[0], driven.offsets[0]
    n = len(nominal)
    follows = task.adjusted and task.guides
    following = np.zeros((len(inputs), n))
    weights = np.array([1.0 / task.units[0]] * 2 + [1.0 / task.units[1]]) ** 2
    with np.errstate(divide="ignore", invalid="ignore"):
        for last in [False] * (POLISH_STEPS * follows) + [True]:
            every, speeds = _differentiate_targets(task, _differentiate_loop(task, nominal, inputs, task.assemblies))
            if not follows:
                break
            # Derivative of half the sum of squares by the input, and its derivatives.
            slope = np.einsum("c,tc,tc->t", weights, offsets, every[:, :, n])
            slopes = np.einsum("c,tcj,tc->tj", weights, every, every[:, :, n])
            slopes += np.einsum("c,tc,tcj->tj", weights, offsets, speeds)
            following = -slopes[:, :n] / slopes[:, n:]
            if not last:
                inputs = inputs - slope / slopes[:, n]
                there = dataclasses.replace(square, adjusted=False, inputs=inputs, used=None)
                offsets = measure_deviations(there, nominal[None]).offsets[0]
    fixed, motion = every[:, :, :n], every[:, :, n]
    rates = fixed + motion[:, :, None] * following[:, None, :]
    least, least_rates = _find_transmission(task, nominal, inputs, following)
    return Sensitivities(inputs, offsets, fixed, motion, rates, least, least_rates)


def _differentiate_targets(task: Task, at: _Loop) -> tuple[Real, Real]:
    """Differentiate x, y and the angle, shape (t, 3, n + 1), and their rates by the input."""
    zeros = np.zeros_like(at.turn)
    if task.sort == "outputs":
        if task.slides:
            first = np.stack([_dot(at.db, np.complex128(task.slide_direction)), zeros, zeros], axis=1)
        else:
            first = np.stack([zeros, zeros, _differentiate_angle(at.normal, at.dn)], axis=1)
        return first, np.zeros_like(first)
    turned, turning = (at.turn, at.dturn) if task.sort == "poses" else (zeros, zeros)
    first = np.stack([at.dp.real, at.dp.imag, turned], axis=1)
    return first, np.stack([at.dv.real, at.dv.imag, turning], axis=1)


def _differentiate_angle(vector: Complex, change: Complex) -> Real:
    """Compute the derivatives of a vector's angle, shape (t, n + 1)."""
    return np.asarray((np.conj(vector[:, None]) * change).imag / (np.abs(vector) ** 2)[:, None])


def _find_transmission(task: Task, nominal: Real, inputs: Real, following: Real) -> tuple[float | None, Real]:
    """Find the minimum transmission angle over the used range, and its derivatives: at an adjusted end, or inside.

    An inner minimum occurs with the crank along the ground or normal to the slide, where the angle is stationary in the
    input.
    """
    if task.used is None:
        return None, np.zeros(len(nominal))
    margins, first, last = task.margins, int(inputs.argmin()), int(inputs.argmax())
    low, high = float(inputs[first] - margins[0]), float(inputs[last] + margins[1])
    if not math.isfinite(high - low):  # a target that the linkage cannot approach has no input
        return None, np.zeros(len(nominal))
    if task.slide_angle is not None:
        still = task.slide_angle + 0.5 * math.pi
    else:
        still = math.atan2(nominal[3] - nominal[1], nominal[2] - nominal[0])
    turns = np.array([place + math.tau * math.ceil((low - place) / math.tau) for place in (still, still + math.pi)])
    places = np.concatenate([[low, high], turns[turns <= high]])
    ends = np.zeros((len(places), len(nominal)))
    ends[0], ends[1] = following[first], following[last]
    signs = np.full(len(places), task.assemblies[0])
    with np.errstate(divide="ignore", invalid="ignore"):
        at = _differentiate_loop(task, nominal, places, signs)
        between = np.angle(at.normal / at.u)
        change = _differentiate_angle(at.normal, at.dn) - _differentiate_angle(at.u, at.du)
    # The acute angle between two lines: lines have no direction, so their angles are taken modulo π.
    folded = np.remainder(between, math.pi)
    acute = np.minimum(folded, math.pi - folded)
    k = int(np.where(np.isfinite(acute), acute, 0.0).argmin())
    sense = 1.0 if folded[k] <= 0.5 * math.pi else -1.0
    return float(acute[k]), sense * (change[k, :-1] + change[k, -1] * ends[k])
