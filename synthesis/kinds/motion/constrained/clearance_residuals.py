"""Workspace margins of a constrained fit, along the motion from the first target to the last.

Pivots and poses are converted to the chart of a fourbar that carries a body (:mod:`synthesis.fit.fourbar_workspace`),
which provides the margins and their derivatives; the chart's few numbers are differenced. The motion begins and ends
where the finished linkage meets its first and last target: at the input that minimises the largest deviation relative
to its tolerance. With relative deviations s_i(φ) this is found by steps δ that minimise max |s_i + s_i' δ|; the minimum
lies where one of these lines is zero or two have the same absolute value.
"""

from __future__ import annotations

import math

import numpy as np

from kinematics.arrays import Real
from kinematics.compiling import njit
from synthesis.fit.chart import LENGTHS, OPTIONS, POINT
from synthesis.fit.coupler_curve import close_two_bars, compute_unit_vector
from synthesis.fit.fourbar_workspace import LINKAGE, append_workspace_rows, compute_workspace_margins
from synthesis.fit.workspace_margins import ROW_SIZE, count_margins
from synthesis.numerics.levenberg import MATRIX, VECTOR

BODY, ENDS, CHART_SIZE = LINKAGE, LINKAGE + 1, LINKAGE + 3
"""Indices into a chart after the fourbar's own entries (lengths here, not logarithms): the direction of A → B on the
body as given, and the crank's angles from the ground line at both ends; last the number of entries."""

DIFFERENCE_STEP = 1e-6
"""Step of the unknowns for finite differences of the chart."""

MAX_NEAREST_STEPS, MAX_ANGLE_STEP, ANGLE_TOLERANCE = 12, 0.1, 1e-13
"""Iteration for the nearest input: maximum number of steps, maximum step in radians, and convergence tolerance in
radians."""

SCAN_STEP_COUNT = 4
"""Number of maximum steps scanned on either side of a pose for the initial nearest input."""


@njit(**OPTIONS)
def _apply_deviations(x: Real, points: Real, k: int, pose: Real) -> None:
    """Write pose k with its deviations; these follow the eight pivot coordinates in x."""
    # Deviations are stored pose by pose, but only for coordinates with a tolerance, hence the counting.
    at = 8
    for j in range(k + 1):
        for c in range(3):
            if j == k:
                pose[c] = points[k, c]
            if points[j, 3 + c] > 0.0:
                if j == k:
                    pose[c] += points[k, 3 + c] * x[at]
                at += 1


@njit(**OPTIONS)
def compute_chart(x: Real, points: Real, assembly: float, steps: Real, beyond: Real, chart: Real) -> bool:
    """Write the chart of the unknowns of a constrained fit; return False if a link has no length.

    Parameters
    ----------
    x, points : float64
        As for :func:`synthesis.kinds.motion.constrained.residuals.evaluate_rows`.
    assembly : float
        Sign of the assembly.
    steps : float64, shape (n − 1,)
        The input's rotation from each pose to the next, radians, known to half a turn.
    beyond : float64, shape (2,)
        Offsets of the ends of the motion from the first and last pose, radians: start of the search on input, result on
        output. NaN requests a scan of the neighbourhood.
    chart : float64, shape (CHART_SIZE,)
        Output.
    """
    n = len(points)
    o2, o4 = complex(x[0], x[1]), complex(x[2], x[3])
    home = complex(points[0, 0], points[0, 1])
    arm_a, arm_b = complex(x[4], x[5]) - home, complex(x[6], x[7]) - home
    pose, turned = np.empty(3), 0.0
    _apply_deviations(x, points, 0, pose)
    p = complex(pose[0], pose[1])
    a, b = p + compute_unit_vector(pose[2]) * arm_a, p + compute_unit_vector(pose[2]) * arm_b
    crank = a - o2
    for k in range(1, n):
        _apply_deviations(x, points, k, pose)
        after = complex(pose[0], pose[1]) + compute_unit_vector(pose[2]) * arm_a - o2
        step = after * crank.conjugate()
        off = math.atan2(step.imag, step.real) - steps[k - 1]
        # Take the branch of the rotation nearest to the start's, so that it changes continuously during the fit.
        turned += steps[k - 1] + off - 2.0 * math.pi * round(off / (2.0 * math.pi))
        crank = after
    ground, bar = o4 - o2, arm_b - arm_a
    lengths = chart[LENGTHS : LENGTHS + 4]
    lengths[0], lengths[1], lengths[2], lengths[3] = abs(ground), abs(a - o2), abs(bar), abs(b - o4)
    if not lengths.min() > 0.0:
        return False
    # P in the coupler's frame, whose real axis goes from A to B.
    own = (p - a) * (b - a).conjugate() / lengths[2]
    chart[0], chart[1], chart[2] = o2.real, o2.imag, math.atan2(ground.imag, ground.real)
    chart[POINT], chart[POINT + 1], chart[BODY] = own.real, own.imag, math.atan2(bar.imag, bar.real)
    first = (a - o2) * ground.conjugate()
    begin = math.atan2(first.imag, first.real)
    # The motion ends where the driven linkage is nearest to its end poses, not at the fitted poses themselves.
    for end in range(2):
        angle, row = (begin, points[0]) if end == 0 else (begin + turned, points[n - 1])
        chart[ENDS + end] = _find_nearest_angle(chart, assembly, angle, beyond[end], row)
        beyond[end] = chart[ENDS + end] - angle
    return True


@njit(**OPTIONS)
def _find_nearest_angle(chart: Real, assembly: float, angle: float, beyond: float, row: Real) -> float:
    """Find the crank angle near a given one that minimises the largest deviation from a pose, relative to tolerance.

    Return the given angle if a coordinate of the pose is exact, because that one determines the input. ``beyond`` is as
    for :func:`compute_chart`.
    """
    if not row[3:].min() > 0.0:
        return angle
    # Alternate on both sides: 0, +1, −1, +2, −2 … maximum steps.
    shares, slopes = np.empty(3), np.empty(3)
    ahead, after = np.empty(3), np.empty(3)
    missed, at = np.inf, angle
    # beyond is NaN if no earlier result exists (NaN differs from itself): then scan both sides of the angle.
    for k in range(1 if beyond == beyond else 2 * SCAN_STEP_COUNT + 1):
        tried = angle + (beyond if beyond == beyond else MAX_ANGLE_STEP * ((k + 1) // 2) * (1 if k % 2 else -1))
        if _compute_shares(chart, assembly, tried, row, ahead, after) and np.abs(ahead).max() < missed:
            missed, at = np.abs(ahead).max(), tried
            shares[:], slopes[:] = ahead, after
    # The linkage does not close near the pose: keep the angle and let other margins decide.
    if missed == np.inf:
        return angle
    angle = at
    for _ in range(MAX_NEAREST_STEPS):
        step = min(max(_minimize_max_share(shares, slopes), -MAX_ANGLE_STEP), MAX_ANGLE_STEP)
        # Shorten the step until it improves: the linear model is not valid far away, and the linkage may not close.
        while abs(step) > ANGLE_TOLERANCE:
            closes = _compute_shares(chart, assembly, angle + step, row, ahead, after)
            if closes and np.abs(ahead).max() < missed:
                break
            step *= 0.25
        if abs(step) <= ANGLE_TOLERANCE:
            break
        angle += step
        shares[:], slopes[:] = ahead, after
        missed = np.abs(shares).max()
    return angle


@njit(**OPTIONS)
def _minimize_max_share(shares: Real, slopes: Real) -> float:
    """Return the δ that minimises max |s_i + s_i' δ|."""
    best, least = 0.0, np.abs(shares).max()
    # The minimum is at a zero of one line (i = j) or where two have equal or opposite values: try all candidates.
    for i in range(len(shares)):
        for j in range(i + 1):
            for sign in (-1.0, 1.0):
                share, slope = shares[i] - sign * shares[j], slopes[i] - sign * slopes[j]
                if i == j:
                    share, slope = shares[i], slopes[i]
                if slope == 0.0:
                    continue
                step = -share / slope
                greatest = np.abs(shares + slopes * step).max()
                if greatest < least:
                    best, least = step, greatest
    return best


@njit(**OPTIONS)
def _compute_shares(chart: Real, assembly: float, angle: float, row: Real, shares: Real, slopes: Real) -> bool:
    """Write deviations from a pose relative to its tolerances, and their derivatives by the crank's angle.

    Return False if the linkage does not close.
    """
    lengths = chart[LENGTHS : LENGTHS + 4]
    ground = lengths[0] * compute_unit_vector(chart[2])
    crank = lengths[1] * compute_unit_vector(chart[2] + angle)
    closes, along = close_two_bars(ground - crank, lengths[2], lengths[3], assembly)
    if not closes:
        return False
    last = crank + lengths[2] * along - ground
    # The coupler's rotation per rotation of the crank; the output's length stays constant.
    turn = -(last.conjugate() * 1j * crank).real / (last.conjugate() * 1j * lengths[2] * along).real
    arm = complex(chart[POINT], chart[POINT + 1]) * along
    place = complex(chart[0], chart[1]) + crank + arm
    moves = 1j * (crank + turn * arm)
    off = math.atan2(along.imag, along.real) - chart[BODY] - row[2]
    # Angles are compared modulo a full turn.
    off -= 2.0 * math.pi * round(off / (2.0 * math.pi))
    shares[0], shares[1], shares[2] = (place.real - row[0]) / row[3], (place.imag - row[1]) / row[4], off / row[5]
    slopes[0], slopes[1], slopes[2] = moves.real / row[3], moves.imag / row[4], turn / row[5]
    return True


@njit(**OPTIONS)
def append_room_rows(
    x: Real,
    points: Real,
    assembly: float,
    steps: Real,
    room: Real,
    multipliers: Real,
    values: Real,
    residuals: Real,
    jacobian: Real,
    m: int,
) -> int:
    """Append the rows of the active workspace margins; return the new row count, or −1 if the motion does not close.

    Parameters
    ----------
    x, points, assembly, steps
        As for :func:`compute_chart`.
    room, multipliers, values
        As for :func:`synthesis.fit.fourbar_workspace.append_workspace_rows`.
    residuals, jacobian, m
        As for :func:`synthesis.numerics.augmented_lagrangian.append_limit_rows`.
    """
    chart, turns, beyond = np.empty(CHART_SIZE), np.zeros((2, CHART_SIZE)), np.full(2, np.nan)
    if not compute_chart(x, points, assembly, steps, beyond, chart):
        return -1
    # The ends of the motion are chart entries of their own, so their derivatives are unit vectors.
    turns[0, ENDS], turns[1, ENDS + 1] = 1.0, 1.0
    # Chain rule: derivatives of the margins by the chart are exact, those of the chart by x are differenced below.
    by_chart = np.empty((count_margins(room), CHART_SIZE))
    count: int = append_workspace_rows(
        chart, chart[LENGTHS : LENGTHS + 4].copy(), np.eye(4), assembly, chart[ENDS : ENDS + 2].copy(), turns, False,
        BODY, room, multipliers, values, residuals[m:], by_chart, 0,
    )  # fmt: skip
    # No active margin, or −1 if the motion does not close.
    if count <= 0:
        return m if count == 0 else -1
    changed, ahead, behind = x.copy(), np.empty(CHART_SIZE), np.empty(CHART_SIZE)
    jacobian[m : m + count] = 0.0
    for i in range(len(x)):
        # Start each search from the unperturbed result, so that the difference contains no scanning noise.
        changed[i] = x[i] + DIFFERENCE_STEP
        if not compute_chart(changed, points, assembly, steps, beyond.copy(), ahead):
            return -1
        changed[i] = x[i] - DIFFERENCE_STEP
        if not compute_chart(changed, points, assembly, steps, beyond.copy(), behind):
            return -1
        changed[i] = x[i]
        for j in range(CHART_SIZE):
            change = ahead[j] - behind[j]
            # Entries that are angles may jump by a full turn between the two evaluations.
            if j == 2 or j >= BODY:
                change -= 2.0 * math.pi * round(change / (2.0 * math.pi))
            change /= 2.0 * DIFFERENCE_STEP
            if change != 0.0:
                for k in range(count):
                    jacobian[m + k, i] += by_chart[k, j] * change
    return m + count


@njit(VECTOR(MATRIX, MATRIX, VECTOR, MATRIX, VECTOR), **OPTIONS)
def compute_min_margins(x: Real, points: Real, assemblies: Real, steps: Real, room: Real) -> Real:
    """Return the minimum workspace margin of each of m linkages, −∞ for one whose motion does not close.

    Parameters
    ----------
    x : float64, shape (m, unknowns)
        Unknowns of each linkage.
    points : float64, shape (n, 6)
        Target poses and tolerances, common to all.
    assemblies, steps : float64, shapes (m,) and (m, n − 1)
        Values of each linkage, as for :func:`compute_chart`.
    room : float64
        Workspace parameters, not empty.
    """
    least, chart = np.full(len(x), -np.inf), np.empty(CHART_SIZE)
    values, rows = np.empty(count_margins(room)), np.empty((count_margins(room), ROW_SIZE))
    for k in range(len(x)):
        if not compute_chart(x[k], points, assemblies[k], steps[k], np.full(2, np.nan), chart):
            continue
        lengths, ends = chart[LENGTHS : LENGTHS + 4].copy(), chart[ENDS : ENDS + 2].copy()
        if compute_workspace_margins(chart, lengths, assemblies[k], ends, False, BODY, room, values, rows):
            least[k] = values.min()
    return least
