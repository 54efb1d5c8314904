"""Fits of a whole curve: their errors, their cognates as fits of the same curve, and fits under constraints.

Constraints guide the search from the start. A fit that violates a constraint is refitted with multipliers that enforce
it, from several starting points:

* from every free fit and its cognates, which draw the same curve with other pivots, links and transmission angles:
  if one of them satisfies all constraints, these cost nothing;
* from members of the shape library that satisfy the constraints on shape alone, by constrained descents;
* along the constraint on the transmission angle, which is raised in steps from the value of the free fit.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from typing import NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex, Real
from synthesis.fit.chart import FOURBAR, POINT, UNKNOWNS, compute_lengths, write_unknowns
from synthesis.fit.constraints import COSINE
from synthesis.fit.coupler_curve import trace_points
from synthesis.kinds.path.curve.shape_matching import Starts
from synthesis.kinds.path.residuals.constraint_vector import restrict_to_zones
from synthesis.kinds.path.residuals.curve_constraints import descend_constrained, descend_softly, measure_violation
from synthesis.kinds.path.residuals.families import compute_joints
from synthesis.kinds.path.task.target_curve import TargetCurve
from synthesis.kinds.path.verification.excursion import build_course, measure_distances
from synthesis.model.linkage.conversion import FourbarConfiguration
from synthesis.numerics.portions import run_in_portions
from synthesis.results.ranking import select_distinct

CURVE_SAMPLE_COUNT = 121
"""Number of places on a fit's curve at which excursions between the points are measured."""

MAX_CONSTRAINED_POINTS = 120
"""Maximum number of points used in constrained descents; denser targets are thinned, and the final fits use all
points."""

FIT_DUPLICATE_TOLERANCE = 1e-4
"""Fits whose joints agree to this share of the curve's size are duplicates."""

MAX_CONSTRAINED = 20
"""Maximum number of fits and cognates that are refitted under the constraints: those with the smallest error and
violation."""

FREE_ERROR_RATIO, MAX_CONSTRAINED_IF_FEASIBLE = 1.001, 7
"""If the error of the nearest feasible fit is within the first factor of that of the nearest free fit, only the second
number of other fits is refitted under the constraints, to offer a choice."""

MAX_SOFT, MAX_SOFT_STEPS = 12, 30
"""Maximum number of results of soft descents from the shape library that are refitted under all constraints, and the
number of steps of these descents."""

ANGLE_SHARES = (0.34, 0.67)
"""Shares of a required transmission angle that are enforced first, if the angle is raised in steps."""

MAX_CLIMBING = 6
"""Maximum number of free fits, the nearest ones, for which a required transmission angle is raised in steps."""


Joint = TypeVar("Joint", complex, Complex)
"""A joint in one configuration, or in several as an array."""


class Fit(NamedTuple):
    """A linkage fitted to a target.

    It consists of the family, the unknowns (m,), the assembly, the crank angles at all fitted points (radians), and the
    error in the target's unit, which includes excursions between the points.
    """

    family: int
    x: Real
    sign: float
    theta: Real
    error: float


def get_thinning(target: TargetCurve) -> slice:
    """Return the slice of fitted points that is used first: all points, unless there are many."""
    return slice(None, None, math.ceil(len(target.fitted) / MAX_CONSTRAINED_POINTS))


def build_fit(target: TargetCurve, family: int, x: Real, sign: float, theta: Real) -> Fit:
    """Build a fit and compute its error at the target's own points and between them."""
    lengths, chart = np.zeros(4), np.zeros((4, 4))
    compute_lengths(family, x, lengths, chart)
    count = len(target.points)
    # The first ``count`` angles belong to the target's own points; the fill points in between carry no error.
    end = theta[0] + 2.0 * math.pi if target.closed else theta[count - 1]
    at = np.concatenate([theta[:count], np.linspace(theta[0], end, CURVE_SAMPLE_COUNT)])
    places, along = np.empty(len(at), np.complex128), np.empty(len(at), np.complex128)
    if not trace_points(family, x, lengths, sign, 0.0, at, places, along):
        return Fit(family, x, sign, theta, math.inf)
    misses = np.abs(places[:count] - target.points)
    _, beyond = measure_distances(places[count:], build_course(target.points, target.closed, float(misses.max())))
    return Fit(family, x, sign, theta, math.hypot(math.sqrt(float(np.mean(misses**2))), float(beyond.max())))


def get_configuration(fit: Fit) -> FourbarConfiguration:
    """Return the joints at the first point, in the target's unit."""
    return compute_joints(fit.family, fit.x, fit.sign, float(fit.theta[0]))[1]


def select_distinct_fits(fits: list[Fit], count: int) -> list[Fit]:
    """Return the first fits, at most ``count``, that differ in some joint."""
    return [fits[k] for k in select_distinct([get_configuration(fit) for fit in fits], count, FIT_DUPLICATE_TOLERANCE)]


def list_cognates(joints: FourbarConfiguration) -> list[FourbarConfiguration]:
    """Return a fourbar and its two cognates (Roberts) in one configuration, each driven from either fixed pivot.

    With ζ = (P − A)/(B − A) the third pivot is O2 + ζ (O4 − O2), and O2 A P A′ is a parallelogram (Norton, Sec. 3.7).
    """
    return [FourbarConfiguration(*map(complex, one)) for one in _construct_cognates(*joints)]


def _construct_cognates(o2: Joint, a: Joint, b: Joint, o4: Joint, p: Joint) -> list[tuple[Joint, ...]]:
    """Return the cognates of joints in one configuration, or in several as arrays."""
    cognates: list[tuple[Joint, ...]] = []
    for start, pin, other, far in ((o2, a, b, o4), (o4, b, a, o2)):
        cognates.append((start, pin, other, far, p))
        # With P on a pin of the coupler two cognates collapse.
        if np.any(np.abs(p - pin) == 0.0) or np.any(np.abs(other - pin) == 0.0):
            continue
        zeta = (p - pin) / (other - pin)
        third = start + zeta * (far - start)
        new_pin = start + (p - pin)
        new_other = new_pin + zeta * (pin - start)
        cognates.append((start, new_pin, new_other, third, p))
        cognates.append((third, new_other, new_pin, start, p))
    return cognates


def build_cognate_fits(fit: Fit, families: Iterable[int]) -> list[Fit]:
    """Return the cognates of a fit, from either pivot, that belong to one of the families; they share its error."""
    lengths, chart = np.zeros(4), np.zeros((4, 4))
    compute_lengths(fit.family, fit.x, lengths, chart)
    p, along = np.empty(len(fit.theta), np.complex128), np.empty(len(fit.theta), np.complex128)
    if not trace_points(fit.family, fit.x, lengths, fit.sign, 0.0, fit.theta, p, along):
        return []
    o2 = np.full(len(p), complex(fit.x[0], fit.x[1]))
    a = o2 + lengths[1] * np.exp(1j * fit.theta)
    o4 = o2 + lengths[0] * np.exp(1j * fit.x[2])
    found = []
    for joints in _construct_cognates(o2, a, a + lengths[2] * along, o4, p)[1:]:
        other = _express_in_chart(joints, families, fit.error)
        if other is not None:
            found.append(other)
    return found


def _express_in_chart(joints: tuple[Complex, ...], families: Iterable[int], error: float) -> Fit | None:
    """Express a linkage, given by its joints along a curve, shape (points,) each, as a fit.

    Returns None if it belongs to none of the families, or changes its assembly along the curve.
    """
    o2, a, b, o4, p = joints
    lengths = np.abs(np.array([o4[0] - o2[0], a[0] - o2[0], b[0] - a[0], b[0] - o4[0]]))
    sides = ((o4 - a).conj() * (b - a)).imag
    if not (np.all(sides > 0.0) or np.all(sides < 0.0)) or lengths.min() <= 0.0:
        return None
    x = np.zeros(UNKNOWNS[FOURBAR])
    x[0], x[1], x[2] = o2[0].real, o2[0].imag, np.angle(o4[0] - o2[0])
    at = (p[0] - a[0]) * np.exp(-1j * np.angle(b[0] - a[0]))
    x[POINT], x[POINT + 1] = at.real, at.imag
    # The families of Grashof linkages are numbered by their shortest link; FOURBAR covers the rest.
    shortest = int(np.argmin(lengths))
    for family in families:
        if family not in (shortest, FOURBAR) or not write_unknowns(lengths, family, 0.0, x):
            continue
        return Fit(family, x, 1.0 if sides[0] > 0.0 else -1.0, np.unwrap(np.angle(a - o2)), error)
    return None


def find_constrained_fits(
    target: TargetCurve,
    free: list[Fit],
    starts: Callable[[], list[Starts]],
    families: list[int],
    setting: Real,
    count: int,
) -> list[Fit]:
    """Find fits that satisfy all constraints: at most ``count`` distinct ones, the nearest first.

    Parameters
    ----------
    target : TargetCurve
        The curve to draw.
    free : list of Fit
        Fits without the constraints, the nearest first.
    starts : callable
        Returns members of the shape library as starts of constrained descents; called if constraints cost accuracy.
    families : list of int
        Families to which an answer may belong.
    setting : float
        The constraints: :func:`synthesis.kinds.path.residuals.curve_constraints.pack_curve_setting`.
    count : int
        Maximum number of fits.
    """
    # Cognates share the curve and its error but have other pivots, lengths and transmission angles.
    variants = [one for fit in free for one in (fit, *build_cognate_fits(fit, families))]
    lost = np.array([measure_violation(one.family, one.x, one.theta, one.sign, setting) for one in variants])
    kept = [one for one, much in zip(variants, lost, strict=True) if much == 0.0]
    # Error and violation are both in the target's unit; a fit that needs little change is the best start.
    order = np.argsort([math.hypot(one.error, much) for one, much in zip(variants, lost, strict=True)], kind="stable")
    near = select_distinct_fits([variants[k] for k in order if lost[k] > 0.0], MAX_CONSTRAINED)
    if kept and min(fit.error for fit in kept) <= FREE_ERROR_RATIO * free[0].error:
        near = near[:MAX_CONSTRAINED_IF_FEASIBLE]
    else:
        near += _fit_softly(target, starts(), setting)
    held: list[Fit | None] = [None] * len(near)
    climbing = set()
    if math.isfinite(setting[COSINE]):
        # Only a required transmission angle can be raised in steps, and only the nearest fits are worth the extra
        # descents.
        climbing = set(np.argsort([one.error for one in near], kind="stable")[:MAX_CLIMBING].tolist())

    def process_portion(some: slice) -> None:
        for k in range(*some.indices(len(near))):
            held[k] = solve_constrained_fit(target, near[k], setting, climbing=k in climbing)

    run_in_portions(process_portion, len(near), 1)
    found = [*kept, *(fit for fit in held if fit is not None)]
    chosen = select_distinct_fits(sorted(found, key=lambda fit: fit.error), count)
    if get_thinning(target).step > 1:
        # Free fits already used all points.
        whole = {id(fit) for fit in kept}
        chosen = [fit if id(fit) in whole else _refine_on_all_points(target, fit, setting) for fit in chosen]
    return chosen


def _refine_on_all_points(target: TargetCurve, fit: Fit, setting: Real) -> Fit:
    """Refit a constrained fit of thinned points to all points; keep it if that fails."""
    return solve_constrained_fit(target, fit, setting, thin=slice(None)) or fit


def solve_constrained_fit(
    target: TargetCurve, fit: Fit, setting: Real, *, climbing: bool = False, thin: slice | None = None
) -> Fit | None:
    """Find the fit nearest to one that satisfies all constraints; return None if the descent fails.

    ``climbing``: pass through parts of the required transmission angle first. ``thin``: the slice of points to fit, by
    default that of :func:`get_thinning`.
    """
    part = get_thinning(target) if thin is None else thin
    x, theta = fit.x, fit.theta[part]
    angle = math.acos(min(setting[COSINE], 1.0)) if climbing else 0.0
    # Large angles are hard to reach in one descent: the multipliers would grow before the linkage has moved.
    for share in (*(ANGLE_SHARES if climbing else ()), 1.0):
        demanded = setting.copy()
        if share < 1.0:
            demanded[COSINE] = math.cos(share * angle)
        reached = descend_constrained(
            fit.family, x, theta, fit.sign, target.fitted[part], target.weights[part], demanded
        )
        if reached is None:
            return None
        x, theta = reached.x, reached.theta
    return build_fit(target, fit.family, x, fit.sign, interpolate_all_angles(target, theta, part))


def interpolate_all_angles(target: TargetCurve, theta: Real, part: slice | NDArray[np.int64]) -> Real:
    """Interpolate crank angles at all fitted points from those at some of them."""
    every = np.arange(len(target.fitted))
    at = every[part]
    if len(at) == len(every):
        return theta
    if target.closed:
        # Close the cycle, so that angles behind the last thinned point are interpolated too.
        theta = np.append(theta, theta[0] + math.copysign(2.0 * math.pi, theta[-1] - theta[0]))
        at = np.append(at, len(every))
    return np.interp(every, at, theta)


def _fit_softly(target: TargetCurve, starts: list[Starts], setting: Real) -> list[Fit]:
    """Fit at equal steps along the target from the shape library, with constraints as penalties from the first step."""
    found: list[tuple[float, Fit]] = []
    for some in starts:
        if not len(some.x):
            continue
        ends = descend_softly(
            some.family, some.x, some.theta, some.sign, target.steps, restrict_to_zones(setting), MAX_SOFT_STEPS
        )
        best = [k for k in np.argsort(ends.cost, kind="stable")[:MAX_SOFT] if math.isfinite(ends.cost[k])]
        for k in best:
            fit = Fit(some.family, ends.x[k], float(some.sign[k]), target.interpolate_angles(ends.theta[k]), math.inf)
            found.append((float(ends.cost[k]), fit))
    found.sort(key=lambda pair: pair[0])
    return select_distinct_fits([fit for _, fit in found], MAX_SOFT)
