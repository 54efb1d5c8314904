"""The smallest cam for a motion program under limits on pressure angle, curvature and face width.

The formulas are independent of those of the analysis core that verifies the cams. θ is the cam angle, k the
tangent of the maximum pressure angle (rise and fall may have different ones), ρ the minimum radius of curvature of the
pitch curve.

Translating roller, x = d + s with d² = R² − e²: tan φ = (v − e)/x, so that d ≥ |v − e|/k − s, and

    κ = (x² + (v − e)(2v − e) − a x)/(x² + (v − e)²)^{3/2},  |κ| ≤ 1/ρ

(Norton 8.31; Rao 5.4). Oscillating roller of arm L and pivot distance C, with μ = 1 ∓ v and ψ = ψ0 + s:
tan φ = ±(C cos ψ − L μ)/(C sin ψ), so that with cos γ = L μ cos φ/C each cam angle allows an interval,
|γ − φ| ≤ ψ ≤ min(φ + γ, 2π − γ − φ).

Translating face: R ≥ ρ − s − a, and the contact sweeps the range from min v to max v. Oscillating face with offset f:
ρ = C sin ψ (1 − v²/μ²) + C cos ψ a/μ³ − f, again an interval of ψ at each cam angle.

If every cam angle allows an interval, the smallest radius is the maximum of the lower ends; otherwise it is found by
exchange (:mod:`synthesis.kinds.cam.sizing.critical_points`). A free offset, arm or pivot is searched. Without a limit
on curvature the prime radius is a convex function of the offset, so that its minimum is global.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize_scalar

from kinematics.arrays import Real
from kinematics.cam.motion.pieces import Motion
from kinematics.cam.motion.program import Program
from synthesis.kinds.cam.sizing.critical_points import find_critical_motion, find_smallest_allowed

MAX_RADIUS = 1e4
"""Upper end of the search for radii, in multiples of the follower's travel and the given lengths."""

RADIUS_MARGIN = 1e-9
"""Share by which a radius at a limit is enlarged, so that the limit holds when measured on the finished cam."""

CENTRE_CLEARANCE = 1e-6
"""Minimum distance of the trace point from the cam's centre, as a share of the lift."""

ANGLE_CLEARANCE = 1e-9
"""Minimum angle in radians between an arm and the line from pivot to centre: if both are in line, the contact is not
determined."""

VALLEY_TOLERANCE = 1e-7
"""Accuracy of a searched dimension, as a share of its range, if each evaluation sizes a cam. The radius is flat at its
minimum, so that it is accurate to the square of this."""

COARSE_STEP_COUNT = 48
"""Number of steps of the grid on which the search for a free dimension starts."""

INFEASIBLE_RADIUS = 1e30
"""Radius that stands for an infeasible one: finite, so that the search can compute with it."""

MINIMUM_TOLERANCE = 1e-10
"""Relative accuracy of a searched dimension. The radius is flat at its minimum, so that it is accurate to the square of
this."""


@dataclass(frozen=True)
class RollerLimits:
    """Limits of a roller's cam.

    ``rise`` and ``fall`` are the maximum pressure angles (radians) for v ≥ 0 and v ≤ 0. ``pitch_radius`` is the
    minimum |radius of curvature| of the pitch curve, 0 without a limit. ``least`` is the smallest prime radius that
    hub and roller permit. ``moment`` times the tangent of the pressure angle is the overturning moment of a slide, as
    a signed share of its limit.
    """

    rise: float
    fall: float
    pitch_radius: float
    least: float
    moment: Callable[[Motion], Real] | None = None

    @property
    def angles(self) -> tuple[tuple[int, float], ...]:
        """Sign of v and pressure angle for rise and fall."""
        return (1, self.rise), (-1, self.fall)


@dataclass(frozen=True)
class Size:
    """The smallest radius found, and the value of the free dimension if there was one.

    ``proven`` is true if no smaller radius exists, to rounding.
    """

    radius: float
    proven: bool
    free: float | None = None


def _mask_active(sign: int, v: Real) -> NDArray[np.bool_]:
    """Return the mask of the cam angles at which the limit for rises and dwells (1) or for falls (−1) applies."""
    return v >= 0.0 if sign > 0 else v <= 0.0


def size_translating_roller(program: Program, offset: float, limits: RollerLimits) -> Size | None:
    """Find the smallest prime radius of a translating roller follower at an offset; None if none is feasible."""
    d = _compute_min_height(program, offset, limits)
    if limits.pitch_radius > 0.0:
        sound = find_smallest_allowed(
            program,
            _make_translating_curvature(offset, limits.pitch_radius),
            d,
            d + _bound_search(program, offset, limits),
        )
        if sound is None:
            return None
        d = sound
    # The margin is on d, the quantity that the limits bound; the offset is exact.
    return Size(math.hypot(d * (1.0 + RADIUS_MARGIN), offset), proven=True)


def search_offset(program: Program, limits: RollerLimits, range_of_offset: tuple[float, float]) -> Size | None:
    """Find the smallest prime radius of a translating roller follower over its offset.

    For the pressure angle alone, d and the radius are convex functions of the offset. If curvature permits the radius
    at the best offset, it is the global minimum. Otherwise the search over the offset starts from a grid, and its
    result is not proven.
    """
    low, high = range_of_offset
    by_angle = replace(limits, pitch_radius=0.0)
    motion = find_critical_motion(program, *_list_angle_functions(limits))

    def evaluate_radius(offset: float) -> float:
        if limits.moment is not None:
            return math.hypot(_compute_min_height(program, offset, by_angle), offset)
        # The worst points do not depend on the offset, unless the moment is limited.
        return math.hypot(_compute_min_height_at(motion, offset, by_angle, program), offset)

    best = _minimize_convex(evaluate_radius, low, high)
    # Solve exactly at the offset found, with its own worst points.
    alone = size_translating_roller(program, best, by_angle)
    size = size_translating_roller(program, best, limits)
    if alone is None:
        return None
    if size is not None and size.radius <= alone.radius * (1.0 + 2.0 * RADIUS_MARGIN):
        return Size(size.radius, True, best)
    return _search_dimension(lambda e: size_translating_roller(program, e, limits), low, high)


def _list_angle_functions(limits: RollerLimits) -> list[Callable[[Motion], Real]]:
    """Return ±v/k − s for each limit: |v − e|/k − s differs from them by a constant."""
    functions: list[Callable[[Motion], Real]] = [lambda motion: motion.s]
    for _, angle in limits.angles:
        functions += [_make_height_function(sign / math.tan(angle)) for sign in (1.0, -1.0)]
    return functions


def _make_height_function(share: float) -> Callable[[Motion], Real]:
    """Return the function share · v − s."""
    return lambda motion: share * motion.v - motion.s


def _compute_min_height(program: Program, offset: float, limits: RollerLimits) -> float:
    # The bound on d can only have its maximum at stationary points of these functions.
    functions = _list_angle_functions(limits)
    if limits.moment is not None:
        functions += [_make_moment_function(sign, offset, limits.moment) for sign in (1.0, -1.0)]
    return _compute_min_height_at(find_critical_motion(program, *functions), offset, limits, program)


def _make_moment_function(sign: float, offset: float, moment: Callable[[Motion], Real]) -> Callable[[Motion], Real]:
    """Return the function ±share · (v − e) − s."""
    return lambda motion: sign * moment(motion) * (motion.v - offset) - motion.s


def _compute_min_height_at(motion: Motion, offset: float, limits: RollerLimits, program: Program) -> float:
    """Return the minimum d for the pressure angle, the limits of the prime circle, and the clearance of the centre."""
    least = math.sqrt(max(limits.least**2 - offset**2, 0.0))
    needed = [least, float(-motion.s.min()) + CENTRE_CLEARANCE * program.lift]
    for sign, angle in limits.angles:
        on = _mask_active(sign, motion.v)
        if on.any():
            needed.append(float((np.abs(motion.v - offset) / math.tan(angle) - motion.s)[on].max()))
    if limits.moment is not None:
        needed.append(float((np.abs(limits.moment(motion) * (motion.v - offset)) - motion.s).max()))
    return max(needed)


def _make_translating_curvature(offset: float, radius: float) -> Callable[[Motion, Real], Real]:
    """Return |κ| ρ − 1 as a function of motion and d."""

    def excess(motion: Motion, d: Real) -> Real:
        x, w = motion.s + d, motion.v - offset
        square = x * x + w * w
        kappa = (x * x + w * (w + motion.v) - motion.a * x) / square**1.5
        return np.asarray(np.abs(kappa) * radius - 1.0)

    return excess


def _bound_search(program: Program, length: float, limits: RollerLimits) -> float:
    peaks = program.peaks
    size = peaks[0].largest + peaks[1].largest + peaks[2].largest + abs(length) + limits.pitch_radius + limits.least
    return MAX_RADIUS * size


def size_oscillating_roller(
    program: Program, arm: float, pivot: float, sense: int, limits: RollerLimits
) -> Size | None:
    """Find the smallest prime radius of an oscillating roller follower; None if no start angle is feasible.

    The pressure angle permits an interval of start angles at each cam angle. Within the common interval, the exchange
    method satisfies the limit on curvature.
    """
    s = program.peaks[0]
    # The arm must not cross the line of pivot and centre anywhere in its swing.
    low, high = max(0.0, -s.least) + ANGLE_CLEARANCE, math.pi - max(s.greatest, 0.0) - ANGLE_CLEARANCE
    functions: list[Callable[[Motion], Real]] = []
    for _, angle in limits.angles:
        functions += [_make_start_function(sign, angle, arm, pivot, sense) for sign in (1.0, -1.0)]
    motion = find_critical_motion(program, *functions, lambda m: m.v)
    for sign, angle in limits.angles:
        on = _mask_active(sign, motion.v)
        if not on.any():
            continue
        share = arm * (1.0 - sense * motion.v[on]) * math.cos(angle) / pivot
        # If γ does not exist, the velocity is too large for this pressure angle at any start angle.
        if np.abs(share).max() > 1.0:
            return None
        gamma = np.arccos(share)
        low = max(low, float((np.abs(gamma - angle) - motion.s[on]).max()))
        high = min(high, float((np.minimum(angle + gamma, 2.0 * math.pi - gamma - angle) - motion.s[on]).min()))
    least = _compute_start_angle(arm, pivot, max(limits.least, abs(arm - pivot)))
    if least is None:
        return None
    start: float | None = max(low, least)
    assert start is not None
    if start > high:
        return None
    if limits.pitch_radius > 0.0:
        start = find_smallest_allowed(
            program, _make_oscillating_curvature(arm, pivot, sense, limits.pitch_radius), start, high
        )
        if start is None:
            return None
    # The margin must not leave the permitted interval.
    start = min(start * (1.0 + RADIUS_MARGIN), 0.5 * (start + high))
    # The law of cosines would lose digits if arm and pivot distance are nearly equal.
    radius = math.hypot(arm - pivot, 2.0 * math.sqrt(arm * pivot) * math.sin(0.5 * start))
    return Size(radius, proven=True)


def search_pivot(
    program: Program, arm: float, range_of_pivot: tuple[float, float], sense: int, limits: RollerLimits
) -> Size | None:
    """Find the smallest prime radius over the pivot distance; the search starts from a grid and proves nothing."""
    return _search_dimension(lambda c: size_oscillating_roller(program, arm, c, sense, limits), *range_of_pivot)


def _make_start_function(sign: float, angle: float, arm: float, pivot: float, sense: int) -> Callable[[Motion], Real]:
    """Return the function ±γ − s, which bounds the start angle except for a constant."""
    return lambda motion: sign * _compute_gamma(motion.v, angle, arm, pivot, sense) - motion.s


def _compute_gamma(v: Real, angle: float, arm: float, pivot: float, sense: int) -> Real:
    return np.arccos(np.clip(arm * (1.0 - sense * v) * math.cos(angle) / pivot, -1.0, 1.0))


def _compute_start_angle(arm: float, pivot: float, radius: float) -> float | None:
    """Return ψ0 for a prime radius; None if the arm cannot reach it."""
    share = (radius**2 - (arm - pivot) ** 2) / (4.0 * arm * pivot)
    return 2.0 * math.asin(math.sqrt(max(share, 0.0))) if share < 1.0 else None


def _make_oscillating_curvature(arm: float, pivot: float, sense: int, radius: float) -> Callable[[Motion, Real], Real]:
    """Return |κ| ρ − 1 as a function of motion and ψ0, from z = e^{iθ}(C − L e^{∓iψ})."""

    def excess(motion: Motion, start: Real) -> Real:
        rate = 1.0 - sense * motion.v
        swung = arm * np.exp(-1j * sense * (start + motion.s))
        first = 1j * (pivot - rate * swung)
        second = -pivot + (rate**2 + 1j * sense * motion.a) * swung
        kappa = (np.conj(first) * second).imag / np.abs(first) ** 3
        return np.asarray(np.abs(kappa) * radius - 1.0)

    return excess


def size_translating_flat(program: Program, least_radius: float, least: float) -> Size:
    """Find the smallest base radius of a translating flat-faced follower: R + s + a ≥ ρ everywhere."""
    motion = find_critical_motion(program, lambda m: m.s + m.a, lambda m: m.s)
    needed = least_radius - float((motion.s + motion.a).min())
    standing = CENTRE_CLEARANCE * program.lift - float(motion.s.min())
    radius = max(needed, least, standing)
    # Add an absolute margin as well, because a relative one would vanish for a base radius near zero.
    return Size(radius + RADIUS_MARGIN * max(radius, program.lift), proven=True)


def size_oscillating_flat(
    program: Program,
    pivot: float,
    face_offset: float,
    sense: int,
    least_radius: float,
    least: float,
    width: float | None,
) -> Size | None:
    """Find the smallest base radius of an oscillating flat-faced follower; None if no start angle is feasible."""
    # The contact stays finite only if μ > 0 over the whole turn.
    s, v = program.peaks[:2]
    # At μ = 1 ∓ v = 0 the contact runs off to infinity.
    if not (v.greatest if sense == 1 else -v.least) < 1.0:
        return None

    # ρ + f = across · sin ψ + along · cos ψ, a sinusoid of the start angle.
    def compute_parts(m: Motion) -> tuple[Real, Real]:
        rate = 1.0 - sense * m.v
        return pivot * (1.0 - (m.v / rate) ** 2), pivot * m.a / rate**3

    def lower(m: Motion) -> Real:
        across, along = compute_parts(m)
        share = (least_radius + face_offset) / np.hypot(across, along)
        return np.arcsin(np.clip(share, -1.0, 1.0)) - np.arctan2(along, across) - m.s

    def upper(m: Motion) -> Real:
        across, along = compute_parts(m)
        share = (least_radius + face_offset) / np.hypot(across, along)
        return math.pi - np.arcsin(np.clip(share, -1.0, 1.0)) - np.arctan2(along, across) - m.s

    motion = find_critical_motion(program, lower, upper, lambda m: np.hypot(*compute_parts(m)))
    across, along = compute_parts(motion)
    # If the amplitude of the sinusoid is too small, no start angle gives the required radius of curvature.
    if (least_radius + face_offset > np.hypot(across, along)).any():
        return None
    reach = (least + face_offset) / pivot
    if reach >= 1.0:
        return None
    low = max(float(lower(motion).max()), math.asin(max(reach, 0.0)))
    low = max(low, math.asin(min(1.0, max(face_offset, 0.0) / pivot)) - s.least + ANGLE_CLEARANCE)
    high = min(float(upper(motion).min()), 0.5 * math.pi - s.greatest - ANGLE_CLEARANCE)
    if low > high:
        return None
    if width is not None:
        narrow = _find_narrow_start(program, pivot, sense, width, low, high)
        if narrow is None:
            return None
        low = narrow
    start = min(low * (1.0 + RADIUS_MARGIN), 0.5 * (low + high))
    return Size(pivot * math.sin(start) - face_offset, proven=True)


def _find_narrow_start(
    program: Program, pivot: float, sense: int, width: float, low: float, high: float
) -> float | None:
    """Find the smallest start angle at which the contact sweeps at most the face width.

    The sweep is the difference of C cos ψ/μ between two cam angles, and is a sinusoid of ψ0 for each pair. Closely
    spaced start angles are tested with exact extremes, and the lower end of the permitted range is found by bisection.
    """

    def sweep(start: float) -> float:
        motion = find_critical_motion(program, lambda m: np.cos(start + m.s) / (1.0 - sense * m.v))
        reach = pivot * np.cos(start + motion.s) / (1.0 - sense * motion.v)
        return float(reach.max() - reach.min())

    before = low
    for start in np.linspace(low, high, COARSE_STEP_COUNT + 1):
        if sweep(float(start)) <= width:
            if start == low:
                return low
            bad, good = before, float(start)
            for _ in range(50):
                middle = 0.5 * (bad + good)
                bad, good = (bad, middle) if sweep(middle) <= width else (middle, good)
            return good
        before = float(start)
    return None


def _minimize_convex(function: Callable[[float], float], low: float, high: float) -> float:
    """Return the minimizer of a convex function on an interval."""
    minimum = minimize_scalar(
        function, bounds=(low, high), method="bounded", options={"xatol": MINIMUM_TOLERANCE * (high - low)}
    )
    # The bounded search never evaluates the ends exactly.
    return min((low, float(minimum.x), high), key=function)


def _search_dimension(size: Callable[[float], Size | None], low: float, high: float) -> Size | None:
    """Minimize the radius over a dimension: a grid, then a descent into its three best valleys."""
    cache: dict[float, float] = {}

    def evaluate_radius(value: float) -> float:
        value = float(value)
        # Every evaluation sizes a cam: cache the results, and take the best at the end.
        if value not in cache:
            smallest = size(value)
            cache[value] = INFEASIBLE_RADIUS if smallest is None else smallest.radius
        return cache[value]

    grid = [float(value) for value in np.linspace(low, high, COARSE_STEP_COUNT + 1)]
    values = [evaluate_radius(value) for value in grid]
    # Local minima of the grid among the feasible values.
    valleys = [
        k for k in range(len(grid)) if values[k] < INFEASIBLE_RADIUS and values[k] == min(values[max(k - 1, 0) : k + 2])
    ]
    for k in sorted(valleys, key=lambda k: values[k])[:3]:
        left, right = grid[max(k - 1, 0)], grid[min(k + 1, COARSE_STEP_COUNT)]
        minimize_scalar(
            evaluate_radius, bounds=(left, right), method="bounded", options={"xatol": VALLEY_TOLERANCE * (high - low)}
        )
    best = min(cache, key=lambda value: cache[value])
    return Size(cache[best], False, best) if cache[best] < INFEASIBLE_RADIUS else None
