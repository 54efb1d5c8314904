"""Residuals of linkages of every family with a stance among their constraints
(:mod:`synthesis.kinds.path.statement.stance`).

The crank angles at the stance's first and last point are those at which P is nearest to them, θ₀ and θ₁, which move
with the unknowns as P's path does. At :data:`PLACE_COUNT` angles in equal steps from θ₀ to θ₁ P has the height h across
the stance line and the place s along it; the margins at each are

    f/2 − |h − (max h + min h)/2|,
    t − |(θ₁ − θ₀) s′/(s₁ − s₀) − 1|,        s′ = (s(θ + δ) − s(θ − δ))/2δ,

where f is the flatness and t the share by which the speed may differ. They precede all other margins of
:mod:`synthesis.numerics.augmented_lagrangian`. The rows of points and of the other constraints are
those of :mod:`synthesis.kinds.path.residuals.points` and :mod:`synthesis.fit.linkage.residuals`; slider-cranks
and geared fivebars have constraints on their fixed pivots and their longest link.
"""

from __future__ import annotations

import math

import numpy as np

from kinematics.arrays import Complex, Real
from kinematics.compiling import njit
from synthesis.fit.chart import GEARED_FIVEBAR, OPTIONS, SLIDER_CRANK, compute_lengths
from synthesis.fit.constraints import FAMILY_INDEX, SIGN_INDEX
from synthesis.fit.coupler_curve import place_with_slopes
from synthesis.fit.linkage.closure import CONSTANT_COUNT, close_linkage, compute_constants, differentiate_nodes
from synthesis.fit.linkage.residuals import compute_linkage_rows
from synthesis.fit.linkage.setting import POINT_NODE, unpack_table
from synthesis.kinds.path.residuals.curve_descent import count_links, is_jamming, measure_pivot_violations
from synthesis.kinds.path.residuals.points import compute_path_rows
from synthesis.numerics.array_layout import ArrayLayout
from synthesis.numerics.augmented_lagrangian import append_limit_rows
from synthesis.numerics.levenberg import ROWS

PLACE_COUNT = 25
"""Number of places of P in the stance at which it is constrained."""

MARGIN_COUNT = 4 * PLACE_COUNT
"""Number of margins of a stance: of the heights, from above and from below, and of the speeds."""

DIFFERENCE_STEP = 1e-3
"""δ, radians: a height is the mean of two places separated by 2δ, with an error δ²/2 of P's acceleration."""

STANCE = ArrayLayout(first=1, last=1, cycle=1, cosine=1, sine=1, flatness=1, off_mean=1)
"""Stance in a setting, before everything else."""

FIRST, LAST = STANCE.index("first"), STANCE.index("last")
"""Rows of the stance's first and last point."""

CYCLE = STANCE.index("cycle")
"""The input's cycle, radians, if the stance continues past the last row; otherwise 0."""

COSINE, SINE = STANCE.index("cosine"), STANCE.index("sine")
"""Direction of the stance line."""

FLATNESS = STANCE.index("flatness")
"""Flatness, in the task's unit; infinite if not constrained."""

OFF_MEAN = STANCE.index("off_mean")
"""Share by which the speed may differ from its mean; infinite if not constrained."""

STANCE_SIZE = STANCE.size
"""Number of values of a stance in a setting."""

SIMPLE_SETTING = ArrayLayout(
    STANCE_SIZE, family=1, sign=1, ratio=1, longest=1, jam_cycle=1, transmission_cosine=1, pivot_limits=8
)
"""Setting of a slider-crank or a geared fivebar, behind the stance."""

SIMPLE_FAMILY, SIMPLE_SIGN = SIMPLE_SETTING.index("family"), SIMPLE_SETTING.index("sign")
"""Family and assembly."""

RATIO, LONGEST = SIMPLE_SETTING.index("ratio"), SIMPLE_SETTING.index("longest")
"""Gear ratio, and longest link."""

JAM_CYCLE = SIMPLE_SETTING.index("jam_cycle")
"""Cycle in which it must not jam, radians."""

TRANSMISSION_COSINE = SIMPLE_SETTING.index("transmission_cosine")
"""Cosine of the minimum transmission angle of a crank that turns through."""

PIVOT_LIMITS = SIMPLE_SETTING.slice("pivot_limits")
"""Limits of fixed pivots, (4, 2) in rows."""

SIMPLE_SIZE = SIMPLE_SETTING.size
"""Number of values of that setting."""

LENGTH_MARGIN_COUNT, PIVOT_MARGIN_COUNT = 6, 4
"""Number of margins of a slider-crank or a geared fivebar: lengths and P's arm below the longest, a slider-crank's
transmission angle above the minimum; and of its pivots, which are equations."""

MIN_SPEED = 1e-9
"""Speed of P, task sizes per radian, below which its path has no direction; also that of its advance in a stance."""

MAX_SETTLING_STEPS, MAX_TURN_STEP, TURN_TOLERANCE = 3, 0.25, 1e-8
"""Maximum number of steps that settle crank angles at each linkage, the maximum step, and the step after which they are
settled, radians."""


@njit(**OPTIONS)
def _compute_nearest_turn(by: Complex, unknowns: int, turn: Real) -> None:
    """Compute the derivatives of the crank angle at which P is nearest to a point: P stays in place along its path."""
    along = by[unknowns]
    square = along.real * along.real + along.imag * along.imag
    for j in range(unknowns):
        turn[j] = 0.0
        if square > MIN_SPEED * MIN_SPEED:
            turn[j] = -(along.real * by[j].real + along.imag * by[j].imag) / square


@njit(**OPTIONS)
def _compute_end_offset(state: Real, n: int, setting: Real) -> float:
    """Return the amount by which the stance's last crank angle exceeds that at its last point."""
    # The cycle continues in the direction in which the points are passed.
    beyond: float = setting[CYCLE] if state[n - 1] >= state[0] else -setting[CYCLE]
    return beyond


@njit(**OPTIONS)
def _compute_margins(
    places: Complex, by: Complex, turn: float, turns: Real, setting: Real, multipliers: Real, values: Real,
    gradients: Real,
) -> None:  # fmt: skip
    """Compute the margins of a stance and, for those that bear a load, their derivatives.

    ``places`` (2 k,) are those before and those behind each angle, ``by`` (2 k, m) their derivatives; ``turn`` is the
    crank's rotation in the stance, ``turns`` (2, m) the derivatives of its ends.
    """
    values[:] = np.inf
    count, m = len(places) // 2, by.shape[1]
    cosine, sine = setting[COSINE], setting[SINE]
    weight = multipliers[-1]
    if setting[FLATNESS] < np.inf:
        low, high = 0, 0
        heights = np.empty(count)
        for k in range(count):
            both = places[k] + places[count + k]
            heights[k] = 0.5 * (cosine * both.imag - sine * both.real)
            low = k if heights[k] < heights[low] else low
            high = k if heights[k] > heights[high] else high
        # The band may lie anywhere; only its height is limited.
        middle = 0.5 * (heights[low] + heights[high])
        for k in range(count):
            for side in range(2):
                number, toward = 2 * k + side, 1.0 if side == 0 else -1.0
                values[number] = 0.5 * setting[FLATNESS] - toward * (heights[k] - middle)
                if values[number] < multipliers[number] / weight:
                    for j in range(m):
                        own, ends = by[k, j] + by[count + k, j], by[low, j] + by[count + low, j]
                        change = own - 0.5 * (ends + by[high, j] + by[count + high, j])
                        gradients[number, j] = -0.5 * toward * (cosine * change.imag - sine * change.real)
    if not setting[OFF_MEAN] < np.inf:
        return
    last = count - 1
    whole = places[last] + places[count + last] - places[0] - places[count]
    way = 0.5 * (cosine * whole.real + sine * whole.imag)
    if abs(way) < MIN_SPEED:
        # A stance without advance has no mean speed; the floor keeps the quotient finite.
        way = math.copysign(MIN_SPEED, way)
    for k in range(count):
        step = places[count + k] - places[k]
        speed = (cosine * step.real + sine * step.imag) / (2.0 * DIFFERENCE_STEP)
        share = turn * speed / way
        for side in range(2):
            number, toward = 2 * (count + k) + side, 1.0 if side == 0 else -1.0
            values[number] = setting[OFF_MEAN] - toward * (share - 1.0)
            if values[number] < multipliers[number] / weight:
                for j in range(m):
                    change = by[count + k, j] - by[k, j]
                    every = by[last, j] + by[count + last, j] - by[0, j] - by[count, j]
                    by_speed = (cosine * change.real + sine * change.imag) / (2.0 * DIFFERENCE_STEP)
                    by_way = 0.5 * (cosine * every.real + sine * every.imag)
                    by_turn = turns[1, j] - turns[0, j]
                    gradients[number, j] = -toward * (turn * by_speed + speed * by_turn - share * by_way) / way


@njit(**OPTIONS)
def _locate_place(k: int, first: float, last: float) -> tuple[float, float]:
    """Return the share of the stance and the crank angle of place ``k``.

    The places before each angle come first, then those behind it.
    """
    share = (k % PLACE_COUNT) / (PLACE_COUNT - 1)
    return share, first + share * (last - first) + (DIFFERENCE_STEP if k >= PLACE_COUNT else -DIFFERENCE_STEP)


@njit(**OPTIONS)
def _shift_slopes(by: Complex, m: int, share: float, turns: Real, out: Complex) -> None:
    """Compute the derivatives of a place of the stance whose crank angle moves with those of the ends."""
    for j in range(m):
        # The places divide the stance evenly, so that their angles are interpolated between its ends.
        turn = (1.0 - share) * turns[0, j] + share * turns[1, j]
        out[j] = by[j] + complex(by[m].real * turn, by[m].imag * turn)


@njit(**OPTIONS)
def _compute_simple_stance(
    family: int, x: Real, lengths: Real, chart: Real, sign: float, ratio: float, first: float, last: float,
    turns: Real, places: Complex, out: Complex,
) -> bool:  # fmt: skip
    """Compute places of P in the stance and their derivatives, of a linkage with one closure; False beyond a toggle.

    ``first`` and ``last`` are crank angles; ``turns`` (2, m) receives their derivatives.
    """
    m = out.shape[1]
    by = np.empty(m + 1, np.complex128)
    for end in range(2):
        closes, _ = place_with_slopes(family, x, lengths, chart, sign, ratio, first if end == 0 else last, by)
        if not closes:
            return False
        _compute_nearest_turn(by, m, turns[end])
    for k in range(2 * PLACE_COUNT):
        share, angle = _locate_place(k, first, last)
        closes, places[k] = place_with_slopes(family, x, lengths, chart, sign, ratio, angle, by)
        if not closes:
            return False
        _shift_slopes(by, m, share, turns, out[k])
    return True


@njit(ROWS, **OPTIONS)
def compute_fourbar_stance_rows(
    x: Real, points: Real, setting: Real, multipliers: Real, state: Real, residuals: Real, jacobian: Real
) -> int:
    """Compute the rows of :func:`compute_path_rows` and those of the stance.

    See :data:`synthesis.numerics.levenberg.ROWS`. ``setting`` begins with the stance. ``state`` is that of
    :func:`compute_path_rows`, with the margins of the stance before all others.
    """
    n, own = len(points), setting[STANCE_SIZE:]
    inner = np.empty(len(state) - MARGIN_COUNT)
    inner[: 3 * n] = state[: 3 * n]
    m = compute_path_rows(x, points, own, multipliers[MARGIN_COUNT:], inner, residuals, jacobian)
    if m < 0:
        return -1
    state[: 3 * n], state[3 * n + MARGIN_COUNT :] = inner[: 3 * n], inner[3 * n :]
    lengths, chart = np.empty(4), np.empty((4, 4))
    family = int(own[FAMILY_INDEX])
    compute_lengths(family, x, lengths, chart)
    places, by = np.empty(2 * PLACE_COUNT, np.complex128), np.empty((2 * PLACE_COUNT, len(x)), np.complex128)
    turns = np.zeros((2, len(x)))
    first = x[2] + state[int(setting[FIRST])]
    last = x[2] + state[int(setting[LAST])] + _compute_end_offset(state, n, setting)
    if not _compute_simple_stance(family, x, lengths, chart, own[SIGN_INDEX], 0.0, first, last, turns, places, by):
        return -1
    rows: int = _append_stance_rows(
        places,
        by,
        last - first,
        turns,
        setting,
        multipliers,
        state[3 * n : 3 * n + MARGIN_COUNT],
        residuals,
        jacobian,
        m,
    )
    return rows


@njit(**OPTIONS)
def _append_stance_rows(
    places: Complex,
    by: Complex,
    turn: float,
    turns: Real,
    setting: Real,
    multipliers: Real,
    values: Real,
    residuals: Real,
    jacobian: Real,
    m: int,
) -> int:
    """Append the rows of a stance to m others; return the number of all rows."""
    gradients, loads = np.zeros((MARGIN_COUNT, by.shape[1])), np.empty(MARGIN_COUNT + 1)
    loads[:MARGIN_COUNT], loads[MARGIN_COUNT] = multipliers[:MARGIN_COUNT], multipliers[-1]
    _compute_margins(places, by, turn, turns, setting, loads, values, gradients)
    rows: int = append_limit_rows(values, gradients, 0, loads, residuals, jacobian, m)
    return rows


@njit(ROWS, **OPTIONS)
def compute_linkage_stance_rows(
    x: Real, targets: Real, setting: Real, multipliers: Real, state: Real, residuals: Real, jacobian: Real
) -> int:
    """Compute the rows of :func:`compute_linkage_rows` and those of the stance.

    ``setting`` begins with the stance, ``state`` with the inputs of the targets, followed by the margins of the stance.
    """
    n, own = len(targets), setting[STANCE_SIZE:]
    inner = np.empty(len(state) - MARGIN_COUNT)
    inner[:n] = state[:n]
    m = compute_linkage_rows(x, targets, own, multipliers[MARGIN_COUNT:], inner, residuals, jacobian)
    if m < 0:
        return -1
    state[:n], state[n + MARGIN_COUNT :] = inner[:n], inner[n:]
    nodes = unpack_table(own)[0]
    count, point, unknowns = len(nodes), int(own[POINT_NODE]), len(x)
    constants, joints, cosines = np.empty((count, CONSTANT_COUNT)), np.empty((count, 2)), np.zeros(count)
    slopes, by_point = np.zeros((count, 2, 1 + 2 * count)), np.zeros(unknowns + 1, np.complex128)
    compute_constants(nodes, x, constants)
    places, by = np.empty(2 * PLACE_COUNT, np.complex128), np.empty((2 * PLACE_COUNT, unknowns), np.complex128)
    turns = np.zeros((2, unknowns))
    first = state[int(setting[FIRST])]
    last = state[int(setting[LAST])] + _compute_end_offset(state, n, setting)
    # The first two passes compute the derivatives of the ends, which all others need.
    for k in range(-2, 2 * PLACE_COUNT):
        share, angle = (0.0, first) if k == -2 else (1.0, last) if k == -1 else _locate_place(k, first, last)
        if not close_linkage(nodes, x, constants, angle, joints, cosines):
            return -1
        differentiate_nodes(nodes, x, constants, angle, joints, slopes)
        # Derivatives by the input are last here.
        for c in range(2 * count):
            by_point[c] = complex(slopes[point, 0, 1 + c], slopes[point, 1, 1 + c])
        by_point[unknowns] = complex(slopes[point, 0, 0], slopes[point, 1, 0])
        if k < 0:
            _compute_nearest_turn(by_point, unknowns, turns[k + 2])
            continue
        places[k] = complex(joints[point, 0], joints[point, 1])
        _shift_slopes(by_point, unknowns, share, turns, by[k])
    rows: int = _append_stance_rows(
        places, by, last - first, turns, setting, multipliers, state[n : n + MARGIN_COUNT], residuals, jacobian, m
    )
    return rows


@njit(**OPTIONS)
def _settle_simple_angle(
    family: int, x: Real, lengths: Real, chart: Real, sign: float, ratio: float, z: complex, angle: float, by: Complex
) -> float:
    """Return the crank angle at the place of the path nearest to z, by Newton's method from ``angle``.

    The last angle is returned where the linkage does not close. ``by`` is scratch.
    """
    for _ in range(MAX_SETTLING_STEPS):
        closes, p = place_with_slopes(family, x, lengths, chart, sign, ratio, angle, by)
        if not closes:
            return angle
        gap, along = p - z, by[len(x)]
        square = along.real * along.real + along.imag * along.imag
        if square < MIN_SPEED * MIN_SPEED:
            break
        turn = -(along.real * gap.real + along.imag * gap.imag) / square
        turn = min(max(turn, -MAX_TURN_STEP), MAX_TURN_STEP)
        if abs(turn) < TURN_TOLERANCE:
            break
        angle += turn
    return angle


@njit(ROWS, **OPTIONS)
def compute_simple_stance_rows(
    x: Real, points: Real, setting: Real, multipliers: Real, state: Real, residuals: Real, jacobian: Real
) -> int:
    """Compute the rows of a slider-crank or geared fivebar.

    They are those of the points, at their nearest places, of the stance, of the longest link and of the fixed pivots.
    ``state`` contains the crank angles at the points, the margins of the stance, and those of lengths and pivots.
    """
    n, unknowns, family = len(points), len(x), int(setting[SIMPLE_FAMILY])
    sign, ratio = setting[SIMPLE_SIGN], setting[RATIO]
    lengths, chart = np.zeros(4), np.zeros((4, 4))
    compute_lengths(family, x, lengths, chart)
    # Logarithms beyond this overflow; the negation also catches NaN.
    if not np.abs(x).max() < 30.0:
        return -1
    if family == GEARED_FIVEBAR and is_jamming(x, lengths, sign, ratio, setting[JAM_CYCLE]):
        return -1
    by = np.empty(unknowns + 1, np.complex128)
    m = 0
    for i in range(n):
        z, root, angle = complex(points[i, 0], points[i, 1]), points[i, 3], state[i]
        angle = _settle_simple_angle(family, x, lengths, chart, sign, ratio, z, angle, by)
        closes, p = place_with_slopes(family, x, lengths, chart, sign, ratio, angle, by)
        if not closes:
            return -1
        state[i] = angle
        gap, along = p - z, by[unknowns]
        speed = abs(along)
        # Only the component across the path can be reduced by the linkage; the angle takes the other one.
        across = complex(-along.imag / speed, along.real / speed) if speed > MIN_SPEED else 1j
        residuals[m] = root * (gap.real * across.imag - gap.imag * across.real)
        residuals[m + 1] = root * (gap.real * across.real + gap.imag * across.imag)
        for j in range(unknowns):
            jacobian[m, j] = 0.0
            jacobian[m + 1, j] = root * (by[j].real * across.real + by[j].imag * across.imag)
        m += 2
    values = state[n + MARGIN_COUNT :]
    gradients, off, slopes = (
        np.zeros((LENGTH_MARGIN_COUNT + PIVOT_MARGIN_COUNT, unknowns)),
        np.zeros(4),
        np.zeros((4, unknowns)),
    )
    _compute_length_margins(family, x, lengths, chart, setting[LONGEST], values, gradients)
    if family == SLIDER_CRANK:
        _compute_angle_margin(lengths, chart, setting[TRANSMISSION_COSINE], values, gradients)
    within = np.ascontiguousarray(setting[PIVOT_LIMITS]).reshape(4, 2)
    measure_pivot_violations(family, x, lengths, chart, within, off, slopes)
    for k in range(PIVOT_MARGIN_COUNT):
        values[LENGTH_MARGIN_COUNT + k], gradients[LENGTH_MARGIN_COUNT + k] = off[k], slopes[k]
    m = append_limit_rows(values, gradients, PIVOT_MARGIN_COUNT, multipliers[MARGIN_COUNT:], residuals, jacobian, m)
    places, out = np.empty(2 * PLACE_COUNT, np.complex128), np.empty((2 * PLACE_COUNT, unknowns), np.complex128)
    turns = np.zeros((2, unknowns))
    first = state[int(setting[FIRST])]
    last = state[int(setting[LAST])] + _compute_end_offset(state, n, setting)
    if not _compute_simple_stance(family, x, lengths, chart, sign, ratio, first, last, turns, places, out):
        return -1
    rows: int = _append_stance_rows(
        places, out, last - first, turns, setting, multipliers, state[n : n + MARGIN_COUNT], residuals, jacobian, m
    )
    return rows


@njit(**OPTIONS)
def _compute_angle_margin(lengths: Real, chart: Real, cosine: float, values: Real, gradients: Real) -> None:
    """Compute the margin of a slider-crank's transmission angle: (r + |e|)/l must not exceed ``cosine``."""
    crank, rod, offset = lengths[0], lengths[1], lengths[2]
    least, sign = (crank + abs(offset)) / rod, (1.0 if offset >= 0.0 else -1.0)
    values[LENGTH_MARGIN_COUNT - 1] = cosine - least
    for j in range(3):
        gradients[LENGTH_MARGIN_COUNT - 1, 3 + j] = -(chart[0, j] + sign * chart[2, j] - least * chart[1, j]) / rod


@njit(**OPTIONS)
def _compute_length_margins(
    family: int, x: Real, lengths: Real, chart: Real, longest: float, values: Real, gradients: Real
) -> None:
    """Compute the shares by which lengths, and P's arm, are below the longest."""
    values[:LENGTH_MARGIN_COUNT] = np.inf
    if not longest < np.inf:
        return
    m, count = len(x), count_links(family)
    logs = 4 if family == GEARED_FIVEBAR else 3
    for k in range(count):
        sign = 1.0 if lengths[k] >= 0.0 else -1.0
        values[k] = 1.0 - sign * lengths[k] / longest
        for j in range(count):
            gradients[k, logs + j] = -sign * chart[k, j] / longest
    arm = math.hypot(x[m - 2], x[m - 1])
    values[LENGTH_MARGIN_COUNT - 2] = 1.0 - arm / longest
    if arm > 0.0:
        gradients[LENGTH_MARGIN_COUNT - 2, m - 2], gradients[LENGTH_MARGIN_COUNT - 2, m - 1] = (
            -x[m - 2] / (arm * longest),
            -x[m - 1] / (arm * longest),
        )
