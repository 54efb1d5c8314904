"""Find random sixbars whose curves have the shape of a target: drawn, swept, compared and placed in batches.

A sixbar is drawn from its fourbar outwards: Grashof lengths, C and D within a few link lengths of theirs, then several
pairs of lengths of the dyad, of which the first with a transmission angle of at least :data:`MIN_TRANSMISSION_ANGLE`
over the full turn is taken, and P within a few lengths of C E. Logarithms of lengths are spread evenly. Curves are
compared like those of fourbars (:mod:`synthesis.kinds.path.curve.shape_matching`).
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex, Real
from kinematics.compiling import njit
from synthesis.fit.chart import CRANK_ROCKER, DOUBLE_CRANK, compute_lengths
from synthesis.fit.sixbar_curve import COUPLER, CRANK, DYAD, GROUND, INPUT, ROCKER, UNKNOWNS, C, D, P, locate_joints
from synthesis.kinds.path.curve.random_linkages import draw_linkages
from synthesis.kinds.path.curve.shape_matching import (
    CHUNK_SIZE,
    SWEEP_STEP_COUNT,
    WINDOW_LENGTHS,
    Similarity,
    compare_closed,
    compare_open,
    fit_similarity,
    resample_matched,
)
from synthesis.kinds.path.sixbar import stephenson_2_shapes
from synthesis.kinds.path.task.target_curve import SHAPE_POINT_COUNT
from synthesis.numerics.portions import THREAD_COUNT
from synthesis.results.ranking import select_distinct

MIN_TRANSMISSION_ANGLE = 15.0
"""Minimum transmission angle, degrees, of both dyads of a drawn sixbar; descents that start closer to a toggle seldom
leave it."""

LENGTH_TRIAL_COUNT = 12
"""Number of pairs of lengths tried for a dyad."""

START_DUPLICATE_TOLERANCE = 0.05
"""Starts whose joints agree to this share of the target's size lead to the same sixbar."""

OVERSUPPLY_FACTOR = 4
"""Multiple of the requested number that is searched for distinct sixbars."""

MAX_OVERSIZE_RATIO = 2.0
"""Maximum excess factor of the links of a start over the longest permitted link; most links shrink in the descent."""


class Form(NamedTuple):
    """Form of a sixbar: family of its fourbar, and the links that carry and hold the dyad."""

    family: int
    carrier: int
    holder: int


FORMS: dict[str, tuple[Form, ...]] = {
    "watt_1": tuple(
        Form(family, *pair)
        for family in (CRANK_ROCKER, DOUBLE_CRANK)
        for pair in ((COUPLER, ROCKER), (ROCKER, COUPLER), (COUPLER, CRANK), (CRANK, COUPLER))
    ),
    "stephenson_1": tuple(
        Form(family, *pair) for family in (CRANK_ROCKER, DOUBLE_CRANK) for pair in ((CRANK, ROCKER), (ROCKER, CRANK))
    ),
    "stephenson_2": tuple(
        Form(family, carrier, INPUT) for family in (CRANK_ROCKER, DOUBLE_CRANK) for carrier in (COUPLER, CRANK, ROCKER)
    ),
    "stephenson_3": tuple(Form(family, COUPLER, GROUND) for family in (CRANK_ROCKER, DOUBLE_CRANK)),
}
"""Forms of each type. P is on the link of the dyad that is joined to the carrier, or in a Stephenson II on the carrier.
"""

FAMILIES = {
    "any": (CRANK_ROCKER, DOUBLE_CRANK),
    "crank_rocker": (CRANK_ROCKER,),
    "double_crank": (DOUBLE_CRANK,),
}
"""Families of a sixbar's fourbar by the required class."""


class PlacedSixbars(NamedTuple):
    """Sixbars of one form on a target, the most similar first.

    Attributes
    ----------
    form : Form
    x : float, shape (n, 15)
        Unknowns of :mod:`synthesis.fit.sixbar_curve`.
    signs : float, shape (n, 2)
        Assemblies of the fourbar's dyad and of the other.
    theta : float, shape (n, SHAPE_POINT_COUNT)
        Crank angles at the target's shape points, radians.
    unlike : float, shape (n,)
        Dissimilarity √(1 − ρ²).
    """

    form: Form
    x: Real
    signs: Real
    theta: Real
    unlike: Real


@njit(cache=True, nogil=True)
def _sweep_sixbars(
    form_family: int, carrier: int, holder: int, x: Real, signs: Real, tried: Real, curves: Complex,
    good: NDArray[np.bool_],
) -> None:  # fmt: skip
    """Choose the lengths of the dyads, scale P with C E, and sweep all sixbars.

    The lengths are chosen among those ``tried`` (n, pairs, 2), in units of the maximum of C D.
    """
    n, steps = curves.shape
    lengths, chart = np.empty(4), np.zeros((4, 4))
    places, pins = np.empty(6, np.complex128), np.empty((steps, 2), np.complex128)
    most = math.cos(math.radians(MIN_TRANSMISSION_ANGLE))
    for i in range(n):
        good[i] = False
        compute_lengths(form_family, x[i], lengths, chart)
        # Lengths of e²⁰ close the dyad anywhere; only C and D matter here.
        x[i, DYAD] = x[i, DYAD + 1] = 20.0
        least, greatest, sharp = np.inf, 0.0, 0.0
        for k in range(steps):
            locate_joints(x[i], lengths, signs[i, 0], carrier, holder, 1.0, 2.0 * math.pi * k / steps, places)
            pins[k, 0], pins[k, 1] = places[2], places[3]
            far = abs(places[3] - places[2])
            least, greatest = min(least, far), max(greatest, far)
        d, a, b, c = lengths
        for base in (d - a, d + a):
            # The fourbar's transmission angle is extreme where the crank lies along the ground line.
            sharp = max(sharp, abs(b * b + c * c - base * base) / (2.0 * b * c))
        if sharp > most:
            continue
        for k in range(tried.shape[1]):
            first, second = greatest * tried[i, k, 0], greatest * tried[i, k, 1]
            two, around = 2.0 * first * second, first * first + second * second
            # Law of cosines at E for the minimum and maximum of C D.
            if around - least * least <= most * two and greatest * greatest - around <= most * two:
                x[i, DYAD], x[i, DYAD + 1] = math.log(first), math.log(second)
                x[i, P] *= first
                x[i, P + 1] *= first
                good[i] = True
                break
        if good[i]:
            for k in range(steps):
                locate_joints(
                    x[i], lengths, signs[i, 0], carrier, holder, signs[i, 1], 2.0 * math.pi * k / steps, places
                )
                curves[i, k] = places[5]


def _draw_sixbars(form: Form, count: int, rng: np.random.Generator) -> tuple[Real, Real, Real]:
    """Draw unknowns, signs, and lengths of the dyad to be tried, of sixbars around their fourbar."""
    fourbars = draw_linkages(form.family, count, 0.0, int(rng.integers(2**31)))
    x = np.zeros((count, UNKNOWNS))
    x[:, :C] = fourbars.x[:, :C]
    half = 0.5 * np.exp(x[:, 4:7])
    coupler = 1.0 + half[:, 0] + half[:, 1]
    sizes = {
        CRANK: np.ones(count),
        COUPLER: coupler,
        ROCKER: 1.0 + half[:, 0] + half[:, 2],
        GROUND: 1.0 + half[:, 1] + half[:, 2],
    }
    for at, frame in ((C, form.carrier), (D, form.holder)):
        # Pins are drawn around the middle of their link, on the crank around its pivot.
        middle = 0.0 if frame == CRANK else 0.5
        reach = np.exp(rng.uniform(np.log(0.15), np.log(3.0), count))
        pin = sizes[frame] * (middle + reach * np.exp(2j * np.pi * rng.uniform(size=count)))
        x[:, at], x[:, at + 1] = pin.real, pin.imag
    reach = np.exp(rng.uniform(np.log(0.1), np.log(3.0), count))
    point = 0.5 + reach * np.exp(2j * np.pi * rng.uniform(size=count))
    x[:, P], x[:, P + 1] = point.real, point.imag
    signs = np.stack([np.ones(count), rng.choice([-1.0, 1.0], count)], axis=1)
    tried = np.exp(rng.uniform(np.log(0.25), np.log(3.0), (count, LENGTH_TRIAL_COUNT, 2)))
    return x, signs, tried


def find_similar_sixbars(
    form: Form,
    target: Complex,
    closed: bool,
    count: int,
    keep: int,
    rng: np.random.Generator,
    longest: float = math.inf,
    progress: Callable[[float], None] | None = None,
) -> PlacedSixbars:
    """Draw ``count`` sixbars of a form and return the ``keep`` most similar to a target, placed on it.

    Parameters
    ----------
    form : Form
    target : complex, shape (SHAPE_POINT_COUNT,)
        Equal steps along the target.
    closed : bool
        Whether it is a closed curve; an open one is compared with windows of the curves.
    count, keep : int
    rng : Generator
    longest : float
        Longest length, in the target's unit, of the sixbars returned.
    progress : callable, optional
        Called with the share done.
    """
    shape = target - target.mean()
    shape /= np.linalg.norm(shape)
    inverted = form.holder == INPUT
    if inverted:
        x, signs, tried = stephenson_2_shapes.draw_sixbars(form.family, form.carrier, count, LENGTH_TRIAL_COUNT, rng)
    else:
        x, signs, tried = _draw_sixbars(form, count, rng)
    rho, where = np.full(count, -1.0), np.zeros((count, 3), np.int64)

    def compare_chunk(first: int) -> tuple[NDArray[np.int64], Similarity] | None:
        rows = slice(first, min(first + CHUNK_SIZE, count))
        curves = np.empty((rows.stop - first, SWEEP_STEP_COUNT), np.complex128)
        good = np.empty(len(curves), np.bool_)
        if inverted:
            stephenson_2_shapes.sweep_sixbars(
                *form[:2], MIN_TRANSMISSION_ANGLE, x[rows], signs[rows], tried[rows], curves, good
            )
        else:
            _sweep_sixbars(*form, x[rows], signs[rows], tried[rows], curves, good)
        chosen = np.flatnonzero(good)
        if not len(chosen):
            return None
        some = curves[chosen]
        return first + chosen, compare_closed(some, shape) if closed else compare_open(some, True, shape)

    with ThreadPoolExecutor(THREAD_COUNT) as pool:
        for n, found in enumerate(pool.map(compare_chunk, range(0, count, CHUNK_SIZE))):
            if found is not None:
                rho[found[0]], where[found[0]] = found[1]
            if progress is not None:
                progress(min((n + 1) * CHUNK_SIZE, count) / count)
    order = np.argsort(-rho, kind="stable")[: OVERSUPPLY_FACTOR * keep]
    order = order[rho[order] > 0.0]
    chosen_x, chosen_signs = x[order], signs[order]
    theta, marks = np.empty((len(order), SHAPE_POINT_COUNT)), np.empty((len(order), 6), np.complex128)
    windows, places = np.array(WINDOW_LENGTHS), where[order]
    if inverted:
        stephenson_2_shapes.place_sixbars(
            *form[:2], windows, places, target, closed, chosen_x, chosen_signs, theta, marks
        )
    else:
        _place_each(*form, windows, places, target, closed, chosen_x, chosen_signs, theta, marks)
    span = np.abs(marks[:, :5] - target.mean()).max(axis=1)
    # Joints far outside mean links beyond the limit.
    near = np.flatnonzero(np.isfinite(span) & (span <= MAX_OVERSIZE_RATIO * longest))
    kept = near[
        select_distinct(marks[near], keep, START_DUPLICATE_TOLERANCE * (np.ptp(target.real) + np.ptp(target.imag)))
    ]
    unlike = np.sqrt(np.maximum(0.0, 1.0 - rho[order[kept]] ** 2))
    return PlacedSixbars(form, chosen_x[kept], chosen_signs[kept], theta[kept], unlike)


@njit(cache=True, nogil=True)
def _place_each(
    family: int, carrier: int, holder: int, windows: Real, where: NDArray[np.int64], target: Complex, closed: bool,
    x: Real, signs: Real, at: Real, marks: Complex,
) -> None:  # fmt: skip
    """Move every sixbar onto the target, in place.

    ``at`` receives the crank angles at the target's points, ``marks`` the joints at the first point.
    """
    lengths, chart = np.empty(4), np.zeros((4, 4))
    curve, theta = np.empty(SWEEP_STEP_COUNT, np.complex128), np.empty(SWEEP_STEP_COUNT)
    middle, places = target.mean(), np.empty(6, np.complex128)
    for i in range(len(x)):
        compute_lengths(family, x[i], lengths, chart)
        for k in range(SWEEP_STEP_COUNT):
            theta[k] = 2.0 * math.pi * k / SWEEP_STEP_COUNT
            locate_joints(x[i], lengths, signs[i, 0], carrier, holder, signs[i, 1], theta[k], places)
            curve[k] = places[5]
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
        transform_sixbar(holder, alpha, middle - alpha * here, x[i])
        at[i] = angles + cmath.phase(alpha)
        compute_lengths(family, x[i], lengths, chart)
        locate_joints(x[i], lengths, signs[i, 0], carrier, holder, signs[i, 1], at[i, 0], places)
        marks[i] = places


@njit(cache=True, nogil=True)
def transform_sixbar(holder: int, alpha: complex, beta: complex, x: Real) -> None:
    """Map a sixbar by z → αz + β, in place; crank angles grow by the phase of α."""
    size, turn = abs(alpha), cmath.phase(alpha)
    o2 = alpha * complex(x[0], x[1]) + beta
    x[0], x[1] = o2.real, o2.imag
    x[2] += turn
    x[3:7] += math.log(size)
    x[DYAD : DYAD + 2] += math.log(size)
    x[C : C + 2] *= size
    x[P : P + 2] *= size
    if holder == GROUND:
        d = alpha * complex(x[D], x[D + 1]) + beta
        x[D], x[D + 1] = d.real, d.imag
    else:
        x[D : D + 2] *= size
