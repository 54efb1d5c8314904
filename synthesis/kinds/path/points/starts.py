"""Starts for fits of fourbars to points: random shapes, their places and coupler points by linear least squares.

For a shape (ratios of lengths) and crank angles φ_k the path is linear in three complex numbers,

    z_k ≈ c₀ + g a e^{iφ_k} + q e^{iφ3_k},

the fixed pivot O2, the ground vector and the coupler point turned with it. With prescribed timing that leaves four
numbers to draw: three ratios, and the crank's phase. With free timing the angles are drawn too, as a run of the crank
along the points, and are then improved in alternation: the resulting path is sampled, points are assigned to samples in
order, and the linear problem is solved again.

A ``setting`` is one of :func:`synthesis.kinds.path.residuals.constraint_vector.pack_setting`.
"""

from __future__ import annotations

import math

import numpy as np

from kinematics.arrays import Complex, Real
from kinematics.compiling import njit
from synthesis.fit.chart import FOURBAR, LENGTHS, POINT, compute_lengths, write_unknowns
from synthesis.fit.constraints import FAMILY_INDEX, FULL_TURN_INDEX, GIVEN_PIVOTS, SIGN_INDEX
from synthesis.fit.coupler_curve import (
    close_two_bars,
    compute_unit_vector,
    find_crank_range,
    find_rocking_range,
    place_linkage,
)
from synthesis.kinds.path.residuals.constraint_vector import (
    ORDER_INDEX,
    PHASE_ABSOLUTE,
    PHASE_GROUND_LINE,
    PHASE_REFERENCE_INDEX,
    TIMING_INDEX,
)
from synthesis.kinds.path.residuals.point_assignment import assign_samples
from synthesis.kinds.path.residuals.points import PHASE_UNKNOWN

DRAW_SIZE = 12
"""Number of random numbers of a start: three or four for the shape, then phase, range, direction, and warp of the run.
"""

SAMPLE_COUNT = 96
"""Number of samples of a curve to which points are assigned."""

MAX_LEAD_SAMPLES = 4
"""Number of samples before the curve's nearest one to the first point at which a run may begin."""

TAIL_COEFFICIENT = 0.2
"""Cubic term of the drawn logarithms of lengths, which gives their distribution long tails: the best linkages often are
at a limit, with one link far longer than the others or near a change point."""

FLIP_NONE, FLIP_OUTPUT, FLIP_COUPLER, FLIP_FAR_DYAD = FLIPS = range(4)
"""Ways to flip a linkage: not at all; O4 to the other side of B; B to the other side of A; B and O4 both to the other
sides of A and O2. A fit that has run to the limit of a link's length shows that a slider would be better, and beyond
the slider there is the link's mirror image."""

CLASS_MARGIN = 1e-5
"""Margin, as a share of the sum of the links, with which a linkage that has left its class is put back into it."""

MIN_SPREAD = 1e-12
"""Number added to sums of squared unit vectors that serve as divisors, because a shape that does not move has no best
place."""

MIN_SCALE, MAX_SCALE = 1e-9, 1e9
"""Minimum and maximum ground link of a start, in task sizes; beyond them it is a degenerate solution of the linear
problem."""

UNREACHABLE_SQUARE = 1e18
"""Squared distance, in squared task sizes, assigned to a sample at which the linkage does not close. It is finite
because sums are compared."""

MIN_GROUND = 1e-3
"""Minimum ground link of a start, in task sizes, if its direction is given."""

ALTERNATION_COUNT = 3
"""Number of alternations between fitting the angles and fitting place and coupler point."""


@njit(cache=True, nogil=True)
def _fit_ground(
    crank: Complex, coupler: Complex, target: Complex, mean_crank: complex, mean_coupler: complex, mean_target: complex
) -> tuple[complex, complex, complex]:
    """Return the projections of crank and target on the coupler, and the ground vector that fits the target."""
    n = len(crank)
    # Eliminate the coupler vector first (Gram-Schmidt), then solve for the ground vector alone.
    square, on_crank, on_target = MIN_SPREAD, 0.0j, 0.0j
    for k in range(n):
        e = coupler[k] - mean_coupler
        square += e.real * e.real + e.imag * e.imag
        on_crank += e.conjugate() * (crank[k] - mean_crank)
        on_target += e.conjugate() * (target[k] - mean_target)
    on_crank /= square
    on_target /= square
    across, mixed = MIN_SPREAD, 0.0j
    for k in range(n):
        e = coupler[k] - mean_coupler
        f = crank[k] - mean_crank - on_crank * e
        across += f.real * f.real + f.imag * f.imag
        mixed += f.conjugate() * (target[k] - mean_target - on_target * e)
    return on_crank, on_target, mixed / across


@njit(cache=True, nogil=True)
def fit_place(lengths: Real, sign: float, angles: Real, points: Real, setting: Real, turn: float, x: Real) -> float:
    """Fit position, size and coupler point of a shape at given crank angles; return half the sum of squares.

    The angles are measured from the ground line.
    ``x`` receives the linkage's nine numbers. ``turn`` is the angle of the ground line for absolute crank angles.
    """
    n = len(points)
    d, a = lengths[0], lengths[1]
    crank, coupler = np.empty(n, np.complex128), np.empty(n, np.complex128)
    target = np.empty(n, np.complex128)
    for k in range(n):
        pin = a * compute_unit_vector(angles[k])
        good, coupler[k] = close_two_bars(d - pin, lengths[2], lengths[3], sign)
        if not good:
            return np.inf
        crank[k] = pin / d
        target[k] = complex(points[k, 0], points[k, 1])
    # A given pivot is subtracted instead of the mean; a partly given one counts as free here, and as a constraint
    # later.
    pivots = setting[GIVEN_PIVOTS]
    pivot_given = not (math.isnan(pivots[0]) or math.isnan(pivots[1]))
    ground_given = pivot_given and not (math.isnan(pivots[2]) or math.isnan(pivots[3]))
    mean_crank, mean_coupler, mean_target = 0.0j, 0.0j, 0.0j
    if pivot_given:
        mean_target = complex(pivots[0], pivots[1])
    else:
        mean_crank, mean_coupler, mean_target = crank.mean(), coupler.mean(), target.mean()
    on_crank, on_target, ground = _fit_ground(crank, coupler, target, mean_crank, mean_coupler, mean_target)
    if ground_given:
        ground = complex(pivots[2] - pivots[0], pivots[3] - pivots[1])
    elif setting[TIMING_INDEX] > 0.0 and setting[PHASE_REFERENCE_INDEX] == PHASE_ABSOLUTE:
        along = compute_unit_vector(turn)
        # Absolute crank angles fix the direction of the ground line; only its length is free.
        ground = max((ground * along.conjugate()).real, MIN_GROUND) * along
    size = abs(ground)
    if not MIN_SCALE < size < MAX_SCALE:
        return np.inf
    # The coupler point follows from the eliminated projection.
    arm = on_target - ground * on_crank
    pivot = mean_target - ground * mean_crank - arm * mean_coupler
    cost = 0.0
    for k in range(n):
        gap = pivot + ground * crank[k] + arm * coupler[k] - target[k]
        cost += gap.real * gap.real + gap.imag * gap.imag
    x[0], x[1] = pivot.real, pivot.imag
    x[2] = math.atan2(ground.imag, ground.real)
    scaled = lengths * (size / d)
    if not write_unknowns(scaled, int(setting[FAMILY_INDEX]), 0.0, x):
        return np.inf
    point = arm * ground.conjugate() / size
    x[POINT], x[POINT + 1] = point.real, point.imag
    return 0.5 * cost


@njit(cache=True, nogil=True)
def draw_shape(draw: Real, family: int, x: Real, lengths: Real) -> bool:
    """Draw a random shape of a class; return False if it cannot be assembled."""
    slopes = np.empty((4, 4))
    # Charts of Grashof classes contain slacks, which spread more widely than lengths.
    spread = 0.9 if family == FOURBAR else 1.3
    for i in range(4):
        x[LENGTHS + i] = spread * draw[i] * (1.0 + TAIL_COEFFICIENT * draw[i] * draw[i])
    compute_lengths(family, x, lengths, slopes)
    low, high = find_crank_range(lengths[0], lengths[1], lengths[2], lengths[3])
    assembles: bool = low < high
    return assembles


@njit(cache=True, nogil=True)
def make_timed_starts(draws: Real, points: Real, setting: Real, unknowns: int, starts: Real, costs: Real) -> None:
    """Make starts with prescribed timing, one for each row of draws; infinite costs mark failures."""
    n = len(points)
    lengths, angles = np.empty(4), np.empty(n)
    for row in range(len(draws)):
        draw, x = draws[row], np.zeros(10)
        costs[row] = np.inf
        if not draw_shape(draw, int(setting[FAMILY_INDEX]), x, lengths):
            continue
        # From the ground line the given angles are complete.
        phase = 0.0 if setting[PHASE_REFERENCE_INDEX] == PHASE_GROUND_LINE else math.pi * draw[4]
        for k in range(n):
            angles[k] = points[k, 2] + phase
        costs[row] = fit_place(lengths, setting[SIGN_INDEX], angles, points, setting, -phase, x)
        if unknowns > PHASE_UNKNOWN:
            x[PHASE_UNKNOWN] = phase
        starts[row] = x[:unknowns]


@njit(cache=True, nogil=True)
def make_free_starts(
    draws: Real, along: Real, points: Real, setting: Real, starts: Real, runs: Real, costs: Real
) -> None:
    """Make starts with free timing: linkages into ``starts``, crank angles from the ground line into ``runs``.

    ``along`` contains the positions of the points along the path that they form, as shares of its closed length, which
    includes the way back from the last point to the first.
    """
    n = len(points)
    lengths = np.empty(4)
    for row in range(len(draws)):
        draw, x = draws[row], np.zeros(9)
        costs[row] = np.inf
        if not draw_shape(draw, int(setting[FAMILY_INDEX]), x, lengths):
            continue
        low, high = find_crank_range(lengths[0], lengths[1], lengths[2], lengths[3])
        crank = low == 0.0 and high == math.pi
        if not crank and setting[FULL_TURN_INDEX] > 0.0:
            continue
        way = 1.0 if draw[5] > 0.0 else -1.0
        share = 0.5 + 0.5 * draw[6]
        angles = runs[row]
        if crank:
            # A full turn, with the gap between the last point and the first in proportion; or a part of a turn.
            whole = (
                2.0 * math.pi
                if setting[FULL_TURN_INDEX] > 0.0 or draw[7] > 0.0
                else 2.0 * math.pi * share / along[n - 1]
            )
            begin = math.pi * draw[4]
            for k in range(n):
                s = along[k]
                # Crank angles are rarely proportional to path length: some parts of a curve are passed much faster.
                warp = draw[8] * (math.sin(2.0 * math.pi * s + 3.0 * draw[9]) - math.sin(3.0 * draw[9]))
                angles[k] = begin + way * (whole * s + 0.8 * warp)
        else:
            begin, width = find_rocking_range(low, high)
            used = width * (0.2 + 0.78 * share)
            begin += (
                0.01 * width + (0.98 * width - used) * (0.5 + 0.5 * draw[4]) if used < 0.98 * width else 0.01 * width
            )
            for k in range(n):
                s = along[k] / along[n - 1]
                angles[k] = begin + used * (s if way > 0.0 else 1.0 - s)
        cost = fit_place(lengths, setting[SIGN_INDEX], angles, points, setting, 0.0, x)
        for _ in range(ALTERNATION_COUNT):
            if not cost < np.inf:
                break
            costs[row] = assign_nearest_angles(x, points, setting, angles)
            starts[row] = x
            compute_lengths(int(setting[FAMILY_INDEX]), x, lengths, np.empty((4, 4)))
            cost = fit_place(lengths, setting[SIGN_INDEX], angles, points, setting, 0.0, x)


@njit(cache=True, nogil=True)
def assign_nearest_angles(x: Real, points: Real, setting: Real, angles: Real) -> float:
    """Find by samples the crank angles at which a linkage is nearest to the points in order.

    Returns half the sum of squares.
    """
    n = len(points)
    lengths, slopes = np.empty(4), np.empty((4, 4))
    compute_lengths(int(setting[FAMILY_INDEX]), x, lengths, slopes)
    low, high = find_crank_range(lengths[0], lengths[1], lengths[2], lengths[3])
    crank = low == 0.0 and high == math.pi
    count = SAMPLE_COUNT
    begin, step = 0.0, 2.0 * math.pi / count
    if not crank:
        begin, width = find_rocking_range(low, high)
        if low > 0.0 and high < math.pi and math.sin(angles[n // 2]) < 0.0:
            # The crank has two ranges, on either side of the ground line; the points are on the lower one.
            begin = -high
        step = width / count
        # Samples in the middles of their steps avoid the toggles.
        begin += 0.5 * step
    squares = np.empty((n, count))
    for j in range(count):
        good, p, _ = place_linkage(FOURBAR, x, lengths, setting[SIGN_INDEX], 0.0, x[2] + begin + j * step)
        for k in range(n):
            gx, gy = p.real - points[k, 0], p.imag - points[k, 1]
            squares[k, j] = gx * gx + gy * gy if good else UNREACHABLE_SQUARE
    if setting[ORDER_INDEX] == 0.0:
        least = 0.0
        for k in range(n):
            j = int(np.argmin(squares[k]))
            angles[k] = begin + j * step
            least += squares[k, j]
        return 0.5 * least
    totals, back = np.empty(count + 1), np.empty((n, count + 1), np.int16)
    chosen, best_chosen = np.empty(n, np.int64), np.zeros(n, np.int64)
    best, best_first, best_way = np.inf, 0, 1
    for way in (1, -1):
        if not crank:
            first = 0 if way > 0 else count - 1
            least = assign_samples(squares, first, count, way, totals, back, chosen, best)
            if least < best:
                best, best_first, best_way = least, first, way
                best_chosen[:] = chosen
            continue
        for j in range(count):
            # A run begins near a place where the curve passes the first point, at most a few samples before it.
            if squares[0, j] <= squares[0, j - 1] and squares[0, j] < squares[0, (j + 1) % count]:
                first = (j - way * MAX_LEAD_SAMPLES) % count
                least = assign_samples(squares, first, count + 1, way, totals, back, chosen, best)
                if least < best:
                    best, best_first, best_way = least, first, way
                    best_chosen[:] = chosen
    for k in range(n):
        angles[k] = begin + step * (best_first + best_way * best_chosen[k])
    return 0.5 * best


def compute_path_shares(points: Real) -> Real:
    """Return the positions of points along the closed polygon that they form, as shares of its length, all below 1."""
    z = points[:, 0] + 1j * points[:, 1]
    chords = np.abs(np.diff(np.append(z, z[0])))
    whole = np.concatenate([[0.0], np.cumsum(chords)])
    return np.asarray(whole[:-1] / whole[-1])


@njit(cache=True, nogil=True)
def make_perturbed_starts(
    bases: Real,
    states: Real,
    sign: float,
    flip: int,
    draws: Real,
    points: Real,
    setting: Real,
    starts: Real,
    costs: Real,
) -> None:
    """Make starts near known linkages: change their lengths, and fit the place again at the same crank angles.

    Parameters
    ----------
    bases : float64, shape (k, unknowns)
        Linkages, used cyclically.
    states : float64, shape (starts, points or more)
        Their crank angles, which turn with the ground line.
    sign : float
        Their assembly.
    flip : int
        One of :data:`FLIPS`, applied first.
    draws : float64, shape (starts, 4)
        Changes of the unknowns that represent lengths.
    points, setting, starts, costs
        As for :func:`make_free_starts`; the setting's assembly sign is the starts'.
    """
    lengths, slopes = np.empty(4), np.empty((4, 4))
    family, n = int(setting[FAMILY_INDEX]), len(points)
    angles = np.empty(n)
    for row in range(len(starts)):
        base = row % len(bases)
        x = np.zeros(10)
        x[: bases.shape[1]] = bases[base]
        costs[row] = np.inf
        compute_lengths(family, x, lengths, slopes)
        turned = 0.0
        if flip != FLIP_NONE:
            # The linkage is flipped in its configuration at the middle point, which then stays the same.
            phi = states[row, n // 2]
            a = lengths[1] * compute_unit_vector(phi)
            good, coupler = close_two_bars(lengths[0] - a, lengths[2], lengths[3], sign)
            if not good:
                continue
            b = a + lengths[2] * coupler
            o4 = complex(lengths[0], 0.0)
            if flip == FLIP_OUTPUT:
                o4 = 2.0 * b - o4
            else:
                b = 2.0 * a - b
                if flip == FLIP_FAR_DYAD:
                    o4 = -o4
            turned = math.atan2(o4.imag, o4.real)
            lengths[0], lengths[3] = abs(o4), abs(b - o4)
            if not write_unknowns(lengths, family, CLASS_MARGIN, x):
                continue
        for i in range(4):
            x[LENGTHS + i] += draws[row, i]
        compute_lengths(family, x, lengths, slopes)
        for k in range(n):
            angles[k] = states[row, k] - turned
            states[row, k] = angles[k]
        costs[row] = fit_place(lengths, setting[SIGN_INDEX], angles, points, setting, x[2], x)
        starts[row] = x[: bases.shape[1]]
