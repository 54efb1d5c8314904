"""Draw random Stephenson II sixbars, sweep them and place them on a target, for
:mod:`synthesis.kinds.path.sixbar.shape_matching`.

Seen from the input link (:mod:`synthesis.fit.inverted_curve`) the pin C of link 4 goes around the input's fixed pivot D
once while link 3 turns once, so that the input turns once relative to the ground. So D is drawn within the curve of C;
then several pairs of lengths of output and ground are tried, and the first with a transmission angle of the output of
at least :data:`~synthesis.kinds.path.sixbar.shape_matching.MIN_TRANSMISSION_ANGLE` over the full turn is taken.
"""

from __future__ import annotations

import cmath
import math

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex, Real
from kinematics.compiling import njit
from synthesis.fit.chart import CRANK_ROCKER, compute_lengths
from synthesis.fit.inverted_curve import GROUND_JOINT_COUNT, POINT, compute_inverted_joints
from synthesis.fit.sixbar_curve import COUPLER, CRANK, DYAD, UNKNOWNS, C, D, P, locate_joints
from synthesis.kinds.path.curve.random_linkages import draw_linkages
from synthesis.kinds.path.curve.shape_matching import SWEEP_STEP_COUNT, fit_similarity, resample_matched

MAX_PIVOT_OFFSET = 0.6
"""Maximum distance of D from the middle of C's curve, as a share of the curve's mean distance from there."""


def draw_sixbars(
    family: int, carrier: int, count: int, tried: int, rng: np.random.Generator
) -> tuple[Real, Real, Real]:
    """Draw unknowns, signs, and lengths to be tried (count, tried, 2); D is still a relative direction and distance."""
    x = np.zeros((count, UNKNOWNS))
    x[:, 3:7] = draw_linkages(family, count, 0.0, int(rng.integers(2**31))).x[:, 3:7]
    half = 0.5 * np.exp(x[:, 4:7])
    # Link 3 is the shortest link of a crank-rocker, the input that of a double-crank; their length is 1.
    coupler, rocker = 1.0 + half[:, 0] + half[:, 1], 1.0 + half[:, 0] + half[:, 2]
    crank = np.ones(count) if family == CRANK_ROCKER else 1.0 + half[:, 1] + half[:, 2]
    for at, size in ((C, coupler), (P, {CRANK: crank, COUPLER: coupler}.get(carrier, rocker))):
        reach = np.exp(rng.uniform(np.log(0.15), np.log(3.0), count))
        pin = size * (0.5 + reach * np.exp(2j * np.pi * rng.uniform(size=count)))
        x[:, at], x[:, at + 1] = pin.real, pin.imag
    aside = MAX_PIVOT_OFFSET * np.sqrt(rng.uniform(size=count)) * np.exp(2j * np.pi * rng.uniform(size=count))
    x[:, D], x[:, D + 1] = aside.real, aside.imag
    signs = np.stack([np.ones(count), rng.choice([-1.0, 1.0], count)], axis=1)
    return x, signs, np.exp(rng.uniform(np.log(0.25), np.log(3.0), (count, tried, 2)))


@njit(cache=True, nogil=True)
def sweep_sixbars(
    family: int, carrier: int, least_angle: float, x: Real, signs: Real, tried: Real, curves: Complex,
    good: NDArray[np.bool_],
) -> None:  # fmt: skip
    """Place D, choose lengths of output and ground among those tried, and sweep the sixbars."""
    n, steps = curves.shape
    lengths, chart = np.empty(4), np.zeros((4, 4))
    places, shown, pin = (
        np.empty(6, np.complex128),
        np.empty(GROUND_JOINT_COUNT, np.complex128),
        np.empty(steps, np.complex128),
    )
    most = math.cos(math.radians(least_angle))
    for i in range(n):
        good[i] = False
        compute_lengths(family, x[i], lengths, chart)
        aside = complex(x[i, D], x[i, D + 1])
        # Lengths of e²⁰ close the dyad anywhere; only the fourbar's pins matter here.
        x[i, DYAD] = x[i, DYAD + 1] = 20.0
        for k in range(steps):
            locate_joints(x[i], lengths, signs[i, 0], COUPLER, 0, 1.0, 2.0 * math.pi * k / steps, places)
            pin[k] = places[2]
        middle = pin.mean()
        pivot = middle + aside * np.abs(pin - middle).mean()
        x[i, D], x[i, D + 1] = pivot.real, pivot.imag
        around = 0.0
        for k in range(steps):
            around += cmath.phase((pin[(k + 1) % steps] - pivot) / (pin[k] - pivot))
        # The winding number of C's curve around D must be one.
        if abs(abs(around) - 2.0 * math.pi) > 1.0:
            continue
        far = np.abs(pin - pivot)
        least, greatest = far.min(), far.max()
        for t in range(tried.shape[1]):
            first, second = greatest * tried[i, t, 0], greatest * tried[i, t, 1]
            # The dyad must close at every distance of C from D.
            if abs(first - second) >= least or first + second <= greatest:
                continue
            x[i, DYAD], x[i, DYAD + 1] = math.log(first), math.log(second)
            hand, sound = 0.0, True
            for k in range(steps):
                angle = 2.0 * math.pi * k / steps
                closes, cosine, sine = compute_inverted_joints(
                    x[i], lengths, signs[i, 0], carrier, signs[i, 1], angle, shown
                )
                # Too close to a toggle, or the triad has changed its assembly.
                if not (closes and abs(cosine) <= most and hand * sine >= 0.0):
                    sound = False
                    break
                hand, curves[i, k] = sine, shown[POINT]
            if sound:
                good[i] = True
                break


@njit(cache=True, nogil=True)
def place_sixbars(
    family: int, carrier: int, windows: Real, where: NDArray[np.int64], target: Complex, closed: bool, x: Real,
    signs: Real, at: Real, marks: Complex,
) -> None:  # fmt: skip
    """Move every sixbar onto the target, in place.

    ``at`` receives the angles of link 3 at the target's points, ``marks`` the joints at the first point.
    """
    lengths, chart = np.empty(4), np.zeros((4, 4))
    curve, theta = np.empty(SWEEP_STEP_COUNT, np.complex128), np.empty(SWEEP_STEP_COUNT)
    middle, places = target.mean(), np.empty(GROUND_JOINT_COUNT, np.complex128)
    for i in range(len(x)):
        compute_lengths(family, x[i], lengths, chart)
        for k in range(SWEEP_STEP_COUNT):
            theta[k] = 2.0 * math.pi * k / SWEEP_STEP_COUNT
            compute_inverted_joints(x[i], lengths, signs[i, 0], carrier, signs[i, 1], theta[k], places)
            curve[k] = places[POINT]
        z, angles, mirrored = resample_matched(
            curve, theta, True, 2.0 * math.pi, where[i], windows, closed, len(target)
        )
        # Mirroring in the real axis flips every ordinate and both assemblies.
        if mirrored:
            for k in (1, 2, C + 1, D + 1, P + 1):
                x[i, k] = -x[i, k]
            signs[i, 0], signs[i, 1] = -signs[i, 0], -signs[i, 1]
        here = z.mean()
        alpha = fit_similarity(z, here, target)
        _transform_sixbar(alpha, middle - alpha * here, x[i])
        at[i] = angles
        compute_lengths(family, x[i], lengths, chart)
        compute_inverted_joints(x[i], lengths, signs[i, 0], carrier, signs[i, 1], at[i, 0], places)
        marks[i] = places


@njit(cache=True, nogil=True)
def _transform_sixbar(alpha: complex, beta: complex, x: Real) -> None:
    """Map a sixbar by z → αz + β, in place; the angles of link 3 relative to the input stay."""
    size = abs(alpha)
    o2 = alpha * complex(x[0], x[1]) + beta
    x[0], x[1] = o2.real, o2.imag
    x[2] += cmath.phase(alpha)
    x[3:7] += math.log(size)
    x[DYAD : DYAD + 2] += math.log(size)
    for at in (C, D, P):
        x[at : at + 2] *= size
