"""Find the coupler curves that have the shape of a given one: sweep, resample by arc length, compare, place.

Shapes are compared with position, size and rotation removed. A curve is N points at equal distances along it, less its
centroid, of unit norm. The similarity of two closed curves is

    ρ = max over s and direction of |Σⱼ z̄ⱼ tⱼ₊ₛ| ≤ 1,

because √(1 − ρ²) is the norm of the difference left by the best similarity transformation. The sums for all s are one
inverse transform of the product of Fourier descriptors (Zahn & Roskies 1972, doi:10.1109/TC.1972.5008949). Mirror
images count as similar: the mirrored linkage has the mirrored curve. An open stroke has a first and a last point and
needs no shift; it is compared with windows of every candidate, of several lengths and at several places along it.

Candidates are drawn at run time (:mod:`synthesis.kinds.path.curve.random_linkages`) and swept by the compiled kernel.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy import fft

from kinematics.arrays import Complex, Mask, Real
from kinematics.compiling import njit
from synthesis.fit.chart import FOURBAR, GEARED_FIVEBAR, OPTIONS, SLIDER_CRANK, SLIDER_ROCKER, compute_lengths
from synthesis.fit.coupler_curve import sweep_curves
from synthesis.kinds.path.curve.random_linkages import RandomLinkages, compute_cycle, draw_linkages
from synthesis.kinds.path.task.target_curve import SHAPE_POINT_COUNT, sample_equal_steps
from synthesis.numerics.portions import THREAD_COUNT
from synthesis.results.ranking import select_distinct

SWEEP_STEP_COUNT = 96
"""Number of crank positions at which a candidate is swept, before it is resampled."""

CHUNK_SIZE = 2048
"""Number of candidates compared at a time: their curves fit into the processor's cache."""

WINDOW_LENGTHS = (1.0, 0.85, 0.7, 0.58, 0.47, 0.38, 0.3, 0.22, 0.15)
"""Shares of a curve's length that are compared with an open stroke."""

WINDOW_START_COUNT = 24
"""Number of places along the curve at which a window begins."""

WINDOW_POINT_COUNT = 24
"""Number of points at which a window is compared with a stroke: half of a shape's, because there are many windows."""

START_DUPLICATE_TOLERANCE = 0.12
"""Starts whose pivots agree to this share of the task's size lead to the same linkage; only the first is followed."""

OVERSUPPLY_FACTOR = 6
"""Multiple of the requested number of candidates that is searched for distinct ones, because the most similar
candidates are often nearly equal."""

PLACE_OVERSUPPLY_FACTOR = 8
"""Further multiple that is searched if the place of the candidates matters too."""

MAX_OVERSIZE_RATIO = 2.0
"""Maximum excess factor of the links of a start over the longest permitted link; most links shrink in the descent."""

TURN_ROUNDING = 1e-12
"""Relative rounding of a range of crank angles that is a whole cycle."""


class Starts(NamedTuple):
    """Linkages of one family placed on the target, most similar first.

    Attributes
    ----------
    family : int
    x, sign : float, shapes (n, m), (n,)
    theta : float, shape (n, SHAPE_POINT_COUNT)
        Crank angles at the target's shape points, radians.
    unlike : float, shape (n,)
        Dissimilarity √(1 − ρ²).
    swept : int
        Number of curves compared: candidates, or windows of them.
    """

    family: int
    x: Real
    sign: Real
    theta: Real
    unlike: Real
    swept: int


@njit(**OPTIONS)
def _resample(curves: Complex, closed: bool, shapes: Complex) -> None:
    """Resample every curve at equal steps of arc length, into ``shapes``."""
    n, steps = curves.shape
    count = shapes.shape[1]
    pieces = steps if closed else steps - 1
    along = np.empty(pieces + 1)
    for i in range(n):
        along[0] = 0.0
        for k in range(pieces):
            along[k + 1] = along[k] + abs(curves[i, (k + 1) % steps] - curves[i, k])
        k = 0
        for j in range(count):
            at = along[pieces] * j / (count if closed else count - 1)
            while k < pieces - 1 and along[k + 1] < at:
                k += 1
            length = along[k + 1] - along[k]
            share = (at - along[k]) / length if length > 0.0 else 0.0
            shapes[i, j] = curves[i, k] + share * (curves[i, (k + 1) % steps] - curves[i, k])


@njit(**OPTIONS)
def _match_windows(
    curves: Complex, ring: bool, lengths: Real, starts: int, target: Complex, best: Real, where: NDArray[np.int64]
) -> None:
    """Find the window of each curve that is most similar to an open target.

    Curves are sampled at equal steps. Windows are compared forward and backward, and mirrored as well. ``best``
    receives ρ. ``where`` (n, 3) receives the index of the length, the index of the start, and a code: 0 for forward, 1
    for backward, plus 2 for mirrored.
    """
    n, count = curves.shape
    points = len(target)
    window = np.empty(points, np.complex128)
    for i in range(n):
        best[i] = -1.0
        for a in range(len(lengths)):
            size = lengths[a]
            for s in range(starts):
                if ring:
                    begin = s / starts
                elif size >= 1.0:
                    # The whole of an open curve is a single window.
                    if s > 0:
                        break
                    begin = 0.0
                else:
                    begin = (1.0 - size) * s / (starts - 1)
                middle, norm = 0j, 0.0
                for j in range(points):
                    at = begin + size * j / (points - 1)
                    at *= count if ring else count - 1
                    k = int(at)
                    # The last point of an open curve has no successor; interpolate from the interval before it.
                    if not ring and k >= count - 1:
                        k = count - 2
                    left, right = curves[i, k % count], curves[i, (k + 1) % count]
                    window[j] = left + (at - k) * (right - left)
                    middle += window[j]
                middle /= points
                # Correlations with the target: forward and backward; f1, b1 those of the mirrored window.
                f0, f1, b0, b1 = 0j, 0j, 0j, 0j
                for j in range(points):
                    w = window[j] - middle
                    norm += w.real * w.real + w.imag * w.imag
                    t, r = target[j], target[points - 1 - j]
                    f0 += w.conjugate() * t
                    b0 += w.conjugate() * r
                    f1 += w * t
                    b1 += w * r
                if norm <= 0.0:
                    continue
                root = math.sqrt(norm)
                for manner, value in enumerate((f0, b0, f1, b1)):
                    rho = abs(value) / root
                    if rho > best[i]:
                        best[i] = rho
                        where[i, 0], where[i, 1], where[i, 2] = a, s, manner


class Similarity(NamedTuple):
    """Similarity of the candidates of a chunk.

    It consists of ρ, shape (n,), and the target's place on each candidate, shape (n, 3); see :func:`_match_windows`.
    """

    rho: Real
    where: NDArray[np.int64]


def compare_closed(curves: Complex, target: Complex) -> Similarity:
    """Compare closed curves with a closed target, over all shifts, both directions and the mirror image."""
    shapes = np.empty((len(curves), SHAPE_POINT_COUNT), np.complex128)
    _resample(curves, True, shapes)
    # Centring and normalization remove position and size; |Σ| ignores the rotation.
    shapes -= shapes.mean(axis=1, keepdims=True)
    norms = np.linalg.norm(shapes, axis=1)
    shapes /= np.where(norms > 0.0, norms, np.inf)[:, None]
    # Single precision suffices to rank shapes and is faster.
    descriptors = fft.fft(shapes.astype(np.complex64), axis=1)
    rho, where = np.full(len(curves), -1.0), np.zeros((len(curves), 3), np.int64)
    for manner in range(4):
        variant = target[::-1] if manner % 2 else target
        if manner >= 2:
            # The mirrored candidate z̄ compared with t has the same |Σ| as z compared with t̄.
            variant = variant.conj()
        product = fft.ifft(fft.fft(variant).astype(np.complex64) * descriptors.conj(), axis=1)
        sizes = np.abs(product)
        # The shift with the largest correlation aligns the starting points of the two curves.
        shift = sizes.argmax(axis=1)
        greatest = sizes[np.arange(len(curves)), shift]
        better = greatest > rho
        rho[better] = greatest[better]
        where[better, 1], where[better, 2] = shift[better], manner
    return Similarity(np.minimum(rho, 1.0), where)


def compare_open(curves: Complex, ring: bool, target: Complex) -> Similarity:
    """Compare windows of curves with an open target; ``ring`` if the curves close."""
    shapes = np.empty((len(curves), SWEEP_STEP_COUNT), np.complex128)
    _resample(curves, ring, shapes)
    rho, where = np.empty(len(curves)), np.zeros((len(curves), 3), np.int64)
    few, _ = sample_equal_steps(target, False, WINDOW_POINT_COUNT)
    few -= few.mean()
    _match_windows(shapes, ring, np.array(WINDOW_LENGTHS), WINDOW_START_COUNT, few / np.linalg.norm(few), rho, where)
    return Similarity(np.minimum(rho, 1.0), where)


class ComparedShapes(NamedTuple):
    """Candidates of one family compared with a target: the similarity of each, and the target's place on it.

    Includes the target (equal steps, in its own unit) and whether it is closed.
    """

    family: int
    drawn: RandomLinkages
    ratio: float
    likeness: Similarity
    swept: int
    target: Complex
    closed: bool


def compare_shapes(
    family: int,
    target: Complex,
    closed: bool,
    count: int,
    *,
    ratio: float = 0.0,
    seed: int = 0,
    progress: Callable[[float], None] | None = None,
) -> ComparedShapes:
    """Draw candidates of a family and compare their curves with the target.

    Parameters
    ----------
    family : int
        A family of :mod:`synthesis.fit.chart`.
    target : complex, shape (SHAPE_POINT_COUNT,)
        Equal steps along the target.
    closed : bool
        Whether it is a closed curve; an open one is compared with windows of the candidates.
    count : int
        Number of candidates to draw.
    ratio : float
        Gear ratio.
    seed : int
        Seed of the draw.
    progress : callable, optional
        Called with the share done.
    """
    centre = target.mean()
    norm = float(np.linalg.norm(target - centre))
    shape = (target - centre) / norm
    drawn = draw_linkages(family, count, ratio, seed)
    rho, where = np.full(count, -1.0), np.zeros((count, 3), np.int64)
    swept = 0

    def compare_chunk(first: int) -> list[tuple[NDArray[np.int64], Similarity]]:
        curves, _, good, rings = _sweep_rows(drawn, family, slice(first, min(first + CHUNK_SIZE, count)), ratio)
        compared = []
        for ring in (True, False):
            # Curves of cranks that do not turn through cannot match a closed target.
            chosen = np.flatnonzero(good & (rings == ring))
            if (ring or not closed) and len(chosen):
                some = curves[chosen]
                compared.append(
                    (first + chosen, compare_closed(some, shape) if closed else compare_open(some, ring, shape))
                )
        return compared

    with ThreadPoolExecutor(THREAD_COUNT) as pool:
        chunks = range(0, count, CHUNK_SIZE)
        for first, parts in zip(chunks, pool.map(compare_chunk, chunks), strict=True):
            for chosen, likeness in parts:
                rho[chosen], where[chosen] = likeness.rho, likeness.where
                swept += len(chosen) * (1 if closed else len(WINDOW_LENGTHS) * WINDOW_START_COUNT)
            if progress is not None:
                progress(min(first + CHUNK_SIZE, count) / count)
    return ComparedShapes(family, drawn, ratio, Similarity(rho, where), swept, target, closed)


def select_most_similar(
    of: ComparedShapes,
    keep: int,
    longest: float = math.inf,
    suited: Mask | None = None,
    lost: Callable[[Real, Real, Real], Real] | None = None,
) -> Starts:
    """Select the candidates whose curves are most similar to the target, and place them on it.

    Parameters
    ----------
    of : ComparedShapes
        The candidates.
    keep : int
        Maximum number returned.
    longest : float
        Longest link, in the target's units, of the linkages kept.
    suited : bool, shape (candidates,), optional
        Which of the candidates may be chosen.
    lost : callable, optional
        Returns, for candidates on the target (x, theta, sign), the distance of each from its required place, shape
        (n,), in the target's unit. Then :data:`PLACE_OVERSUPPLY_FACTOR` times the number is placed, ordered by
        dissimilarity and distance together.
    """
    family, drawn, target = of.family, of.drawn, of.target
    rho = of.likeness.rho if suited is None else np.where(suited, of.likeness.rho, -1.0)
    order = np.argsort(-rho, kind="stable")[
        : OVERSUPPLY_FACTOR * keep * (1 if lost is None else PLACE_OVERSUPPLY_FACTOR)
    ]
    # Candidates that jam or do not close keep ρ = −1.
    order = order[rho[order] > 0.0]
    x, theta, sign = _place_rows(family, drawn, order, of.likeness.where[order], target, of.closed, of.ratio)
    if lost is not None:
        near = np.argsort(np.hypot(_compute_dissimilarity(rho[order]), lost(x, theta, sign)), kind="stable")
        order, x, theta, sign = order[near], x[near], theta[near], sign[near]
    chosen = _select_distinct(x, theta, np.ptp(target.real) + np.ptp(target.imag), longest, family, keep)
    return Starts(family, x[chosen], sign[chosen], theta[chosen], _compute_dissimilarity(rho[order[chosen]]), of.swept)


def _compute_dissimilarity(rho: Real) -> Real:
    """Return the difference that the best similarity transformation leaves between curves of unit norm."""
    return np.asarray(np.sqrt(np.maximum(0.0, 1.0 - rho**2)))


def _sweep_rows(
    drawn: RandomLinkages, family: int, rows: slice | NDArray[np.int64], ratio: float
) -> tuple[Complex, Real, Mask, Mask]:
    """Return P and θ over the crank's range of each candidate, which of them do not jam, and which close."""
    x, sign, begin, end = drawn.x[rows], drawn.sign[rows], drawn.begin[rows], drawn.end[rows]
    # A geared fivebar repeats only after several turns of its crank.
    turn = compute_cycle(ratio) if family == GEARED_FIVEBAR else 2.0 * math.pi
    rings = end - begin >= turn * (1.0 - TURN_ROUNDING)
    curves, theta = np.empty((len(x), SWEEP_STEP_COUNT), np.complex128), np.empty((len(x), SWEEP_STEP_COUNT))
    good = np.empty(len(x), np.bool_)
    sweep_curves(family, x, sign, ratio, begin, end, rings, curves, theta, good)
    return curves, theta, good, rings


def _place_rows(
    family: int,
    drawn: RandomLinkages,
    order: NDArray[np.int64],
    where: NDArray[np.int64],
    target: Complex,
    closed: bool,
    ratio: float,
) -> tuple[Real, Real, Real]:
    """Move, rotate, scale and mirror candidates onto the target.

    Returns the unknowns, the crank angles at the target's points, and the assembly signs.
    """
    curves, theta, _, rings = _sweep_rows(drawn, family, order, ratio)
    x, sign = drawn.x[order].copy(), drawn.sign[order].copy()
    at = np.empty((len(order), SHAPE_POINT_COUNT))
    cycles = drawn.end[order] - drawn.begin[order]
    _place_each(
        family, ratio, curves, theta, rings, cycles, where, np.array(WINDOW_LENGTHS), target, closed, x, sign, at
    )
    return x, at, sign


@njit(cache=True, nogil=True)
def _place_each(
    family: int,
    ratio: float,
    curves: Complex,
    theta: Real,
    rings: Mask,
    cycles: Real,
    where: NDArray[np.int64],
    windows: Real,
    target: Complex,
    closed: bool,
    x: Real,
    sign: Real,
    at: Real,
) -> None:
    """Put every candidate on the target in place; ``at`` receives the crank angles at its points."""
    middle = target.mean()
    for i in range(len(x)):
        z, angles, mirrored = resample_matched(
            curves[i], theta[i], rings[i], cycles[i], where[i], windows, closed, len(target)
        )
        if mirrored:
            _mirror(family, x[i], sign, i)
        here = z.mean()
        alpha = fit_similarity(z, here, target)
        _move(family, x[i], ratio, alpha, middle - alpha * here)
        # Rotating a linkage adds the rotation to its crank angles.
        at[i] = angles + cmath.phase(alpha)


@njit(cache=True, nogil=True)
def resample_matched(
    curve: Complex,
    theta: Real,
    ring: bool,
    cycle: float,
    where: NDArray[np.int64],
    windows: Real,
    closed: bool,
    count: int,
) -> tuple[Complex, Real, bool]:
    """Return ``count`` places of one curve and the crank angles there, matched to a target's points.

    ``where`` is a row of :class:`Similarity`. The third result is true if the curve was mirrored in the real axis.
    """
    place, start, manner = np.arange(count), where[1], where[2]
    if closed:
        share = (place - start) / count
    else:
        size = windows[where[0]]
        begin = start / WINDOW_START_COUNT if ring else (1.0 - size) * start / (WINDOW_START_COUNT - 1)
        share = begin + size * place / (count - 1)
    z, angles = _interpolate_at_shares(curve, theta, ring, cycle, share)
    if manner % 2 == 1:
        z, angles = z[::-1].copy(), angles[::-1].copy()
    if manner >= 2:
        z, angles = z.conj(), -angles
    return z, angles, manner >= 2


@njit(cache=True, nogil=True)
def fit_similarity(z: Complex, here: complex, target: Complex) -> complex:
    """Return the factor that brings places about their centroid ``here`` nearest to a target in least squares."""
    likeness, norm = 0j, 0.0
    for k in range(len(z)):
        about = z[k] - here
        likeness += about.conjugate() * target[k]
        norm += about.real * about.real + about.imag * about.imag
    return likeness / norm


@njit(cache=True, nogil=True)
def _interpolate_at_shares(curve: Complex, theta: Real, ring: bool, cycle: float, share: Real) -> tuple[Complex, Real]:
    """Interpolate points and crank angles at shares of a curve's length; of a closed curve also beyond its end."""
    count = len(curve) + 1 if ring else len(curve)
    points, angles, along = np.empty(count, np.complex128), np.empty(count), np.zeros(count)
    points[: len(curve)], angles[: len(curve)] = curve, theta
    if ring:
        points[-1], angles[-1] = curve[0], theta[0] + cycle
    for k in range(1, count):
        along[k] = along[k - 1] + abs(points[k] - points[k - 1])
    along /= along[-1]
    # Beyond a full turn the place repeats while the crank angle continues to grow.
    turns = np.floor(share) if ring else np.zeros(len(share))
    inside = share - turns
    z = np.interp(inside, along, points.real) + 1j * np.interp(inside, along, points.imag)
    return z, np.interp(inside, along, angles) + cycle * turns


@njit(cache=True, nogil=True)
def _mirror(family: int, x: Real, sign: Real, i: int) -> None:
    """Mirror the linkage in the real axis, in place; crank angles change sign with it."""
    x[1] = -x[1]
    x[-1] = -x[-1]
    if family == GEARED_FIVEBAR:
        x[3], x[8] = -x[3], -x[8]
    else:
        x[2] = -x[2]
    if family in (SLIDER_CRANK, SLIDER_ROCKER):
        x[5] = -x[5]
    else:
        # A slider's assembly is contained in its offset, all others change theirs.
        sign[i] = -sign[i]


@njit(cache=True, nogil=True)
def _move(family: int, x: Real, ratio: float, alpha: complex, beta: complex) -> None:
    """Map the linkage by z → αz + β, in place; crank angles grow by the phase of α."""
    size, turn = abs(alpha), cmath.phase(alpha)
    o2 = alpha * complex(x[0], x[1]) + beta
    x[0], x[1] = o2.real, o2.imag
    if family == GEARED_FIVEBAR:
        o5 = alpha * complex(x[2], x[3]) + beta
        x[2], x[3] = o5.real, o5.imag
        x[4:8] += math.log(size)
        # The second crank's phase absorbs the difference of both cranks' rotation.
        x[8] += (1.0 - ratio) * turn
    else:
        x[2] += turn
        x[3:5] += math.log(size)
        if family == SLIDER_ROCKER:
            x[5] *= size
        elif family != SLIDER_CRANK:
            x[5:7] += math.log(size)
    x[-2:] *= size


def _select_distinct(x: Real, theta: Real, size: float, longest: float, family: int, keep: int) -> NDArray[np.int64]:
    """Return at most ``keep`` rows of distinct linkages that are not far too large."""
    rows, marks = _mark_rows(x, theta, longest, family)
    return np.asarray(rows[select_distinct(marks, keep, START_DUPLICATE_TOLERANCE * size)])


@njit(cache=True, nogil=True)
def _mark_rows(x: Real, theta: Real, longest: float, family: int) -> tuple[NDArray[np.int64], Real]:
    """Return the rows of linkages that are not far too large, and coordinates that distinguish them.

    The coordinates are O2, A and the other lengths.
    """
    lengths, chart = np.empty(4), np.empty((4, 4))
    rows, marks, count = np.empty(len(x), np.int64), np.empty((len(x), 8)), 0
    shift = 0 if family == GEARED_FIVEBAR else 1
    for i in range(len(x)):
        lengths[:] = 0.0
        compute_lengths(family, x[i], lengths, chart)
        # The arm from the pin to P counts as a length, too: it is a link of the finished part.
        if max(np.abs(lengths).max(), math.hypot(x[i, -2], x[i, -1])) > MAX_OVERSIZE_RATIO * longest:
            continue
        crank = lengths[0 if family > FOURBAR else 1]
        rows[count] = i
        marks[count] = 0.0
        marks[count, 0], marks[count, 1] = x[i, 0], x[i, 1]
        marks[count, 2] = x[i, 0] + crank * math.cos(theta[i, 0])
        marks[count, 3] = x[i, 1] + crank * math.sin(theta[i, 0])
        marks[count, 4 : 8 - shift] = lengths[shift:]
        count += 1
    return rows[:count], marks[:count]
