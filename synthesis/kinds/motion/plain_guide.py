"""Plain guides of a body: a hinge, a slide or a parallelogram, if one of them does what a linkage is requested for.

A rotation about one point needs a hinge, a translation along a line a slide, and a translation along a circle two equal
parallel cranks. The guide is fitted to the positions by least squares, and accepted if its own dimensions carry the
body through all of them: within their tolerances, otherwise within what usual pins and links make meaningless
(:data:`~synthesis.results.practicality.NEGLIGIBLE_ERROR`). A fit without tolerances may instead have up to
:data:`~synthesis.results.practicality.ERROR_BAND` times the error of the best linkage.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence

import numpy as np
import scipy.optimize

from kinematics.arrays import Complex, Real
from kinematics.message import compose, join_messages
from synthesis.kinds.motion.design import Guide, Hinge, MotionResult, Parallelogram, StraightGuide
from synthesis.kinds.motion.problem import SIDE_FIELDS, MotionProblem
from synthesis.kinds.motion.statement.dyad_choices import DyadChoices
from synthesis.kinds.motion.task.pivot_regions import list_side_areas
from synthesis.kinds.motion.verification.verify import verify
from synthesis.model.linkage.answer import FourbarMechanism, LinkageDesign
from synthesis.model.linkage.conversion import FourbarConfiguration, build_fourbar, to_complex, to_point
from synthesis.results.measurement import check_shared_constraints
from synthesis.results.practicality import ERROR_BAND, MAX_REACH, NEGLIGIBLE_ERROR

MIN_ROTATION = 1e-3
"""Minimum rotation of the body, radians, beyond its tolerances, that determines a hinge."""

ANGLE_ROUNDS = 30
"""Number of rounds in which the body's angles are moved within their tolerances to fit a hinge better."""

ROUNDING = 1e-9
"""Lengths below this share of the task's size, and angles in radians, are written as 0."""

SWEEP_COUNT = 361
"""Number of poses at which the body on its guide is compared with the workspace."""


def add_plain_guide(problem: MotionProblem, result: MotionResult) -> MotionResult:
    """Return a result with the plain guide that does the job and a summary that begins with it; unchanged if none does.

    A problem that chooses dyads, types or a driver requests a linkage, so no guide is searched for.
    """
    if not _is_open(problem):
        return result
    for fit in (_fit_hinge, _fit_slide):
        guide = fit(problem)
        if guide is not None and _does_job(problem, guide, result.designs) and _fits_workspace(problem, guide):
            return _announce(problem, result, guide)
    parallelogram = _fit_parallelogram(problem)
    if parallelogram is not None and _does_job(problem, parallelogram, result.designs):
        result = _add_parallelogram(problem, result, parallelogram)
        # The linkage itself was verified with all constraints, hence so is the guide.
        if any(is_parallelogram(design) for design in result.designs):
            return _announce(problem, result, parallelogram)
    return result


def is_parallelogram(design: LinkageDesign) -> bool:
    """Return whether a design passed and is a parallelogram, whose coupler never turns."""
    mechanism = design.mechanism
    return design.verification.passed and isinstance(mechanism, FourbarMechanism) and mechanism.is_parallelogram


def _is_open(problem: MotionProblem) -> bool:
    """Return whether the statement leaves the type of the guide open."""
    wanted = problem.constraints
    return (
        not isinstance(problem.mechanisms, list)
        and problem.driver is None
        and problem.ground_line is None
        and wanted.grashof == "any"
        and not wanted.full_rotation
        and not wanted.force_limits
        and all(getattr(problem, side) == DyadChoices() for side in SIDE_FIELDS)
    )


def _get_poses(problem: MotionProblem) -> tuple[Complex, Real]:
    """Return the positions of P, and the angles of the body's line in radians, continued by the shorter rotations."""
    points = np.array([position.point for position in problem.positions])
    return points, np.unwrap(np.radians([position.angle for position in problem.positions]))


def _get_limits(problem: MotionProblem) -> Real:
    """Return the permitted errors in x, y (length units) and angle (radians), shape (n, 3); infinite if fitted."""
    limits = np.array(problem.limits)
    limits[:, 2] = np.radians(limits[:, 2])
    return np.asarray(np.maximum(limits, NEGLIGIBLE_ERROR * np.array([problem.task_size, problem.task_size, 1.0])))


def _get_weights(problem: MotionProblem) -> Real:
    """Return the weights of x and y in a fit, shape (n, 2): the inverse tolerances, relative to the greatest."""
    limits = _get_limits(problem)[:, :2]
    limits = np.where(np.isfinite(limits), limits, problem.task_size)
    return np.asarray(limits.min() / limits)


def _fit_hinge(problem: MotionProblem) -> Hinge | None:
    """Fit P = c + q e^{iθ}, which is linear in c and q for given angles θ of the body within their tolerances."""
    points, angles = _get_poses(problem)
    slack = np.radians([angle for _, _, angle in problem.limits])
    slack = np.where(np.isfinite(slack), slack, 0.0)
    if np.ptp(angles) <= MIN_ROTATION + 2.0 * slack.max():
        return None
    weights = _get_weights(problem).ravel()
    right = np.stack([points.real, points.imag], axis=1).ravel() * weights
    theta = angles
    for _ in range(ANGLE_ROUNDS):
        cosine, sine, one, zero = np.cos(theta), np.sin(theta), np.ones(len(theta)), np.zeros(len(theta))
        rows = np.stack([[one, zero, cosine, -sine], [zero, one, sine, cosine]]).transpose(2, 0, 1).reshape(-1, 4)
        x = np.linalg.lstsq(rows * weights[:, None], right, rcond=None)[0]
        pivot, arm = complex(x[0], x[1]), complex(x[2], x[3])
        if abs(arm) <= NEGLIGIBLE_ERROR * problem.task_size:
            break  # P is at the hinge, so that the angles say nothing about it
        off = np.angle((points - pivot) / (arm * np.exp(1j * angles)))
        theta = angles + np.clip(off, -slack, slack)
    # A pivot that far away makes no usable hinge.
    if abs(arm) > MAX_REACH * problem.task_size:
        return None
    rotations = theta - theta[0]
    return Hinge(
        pivot=to_point(pivot),
        point=to_point(pivot + arm * cmath.exp(1j * theta[0])),
        body_angle=math.degrees(theta[0]),
        rotations=[math.degrees(turn) for turn in rotations],
        **_measure_misses(points, angles, pivot + arm * np.exp(1j * theta), theta),
    )


def _fit_slide(problem: MotionProblem) -> StraightGuide | None:
    """Fit a straight line to P, and the constant angle of the body that is nearest to all requested ones."""
    points, angles = _get_poses(problem)
    weights = _get_weights(problem).prod(axis=1)
    middle = complex(np.average(points, weights=weights))
    parts = np.stack([(points - middle).real, (points - middle).imag], axis=1) * weights[:, None]
    direction = complex(*np.linalg.svd(parts)[2][0])
    # The line points in the direction of the first motion.
    if ((points[-1] - points[0]) * direction.conjugate()).real < 0.0:
        direction = -direction
    along = ((points - middle) * direction.conjugate()).real
    start = middle + along[0] * direction
    reached = np.asarray(middle + along * direction, np.complex128)
    angle = _find_constant_angle(problem, angles)
    return StraightGuide(
        point=to_point(start),
        direction=math.degrees(cmath.phase(direction)),
        body_angle=math.degrees(angle),
        travels=[float(s) for s in along - along[0]],
        **_measure_misses(points, angles, reached, np.full(len(points), angle)),
    )


def _fit_parallelogram(problem: MotionProblem) -> Parallelogram | None:
    """Fit a circle to P by least squares of the distances, beginning with the linear fit of its equation."""
    points, angles = _get_poses(problem)
    if len(points) < 3:
        return None
    size, origin = problem.task_size, complex(points.mean())
    z = (points - origin) / size
    weights = _get_weights(problem).prod(axis=1)
    # |z|² = 2 Re(conj(c) z) + k is linear in the centre c and k.
    rows = np.stack([2.0 * z.real, 2.0 * z.imag, np.ones(len(z))], axis=1)
    x = np.linalg.lstsq(rows * weights[:, None], np.abs(z) ** 2 * weights, rcond=None)[0]
    # On points of a line the linear fit has no circle of finite size.
    if not np.hypot(x[0], x[1]) <= 2.0 * MAX_REACH:
        return None

    def measure_distances(centre: Real) -> Real:
        distances = np.abs(z - complex(*centre))
        return np.asarray(weights * (distances - np.average(distances, weights=weights**2)))

    c = complex(*scipy.optimize.least_squares(measure_distances, x[:2]).x)
    radius = float(np.average(np.abs(z - c), weights=weights**2))
    if radius > MAX_REACH:
        return None
    around = np.unwrap(np.angle(z - c))
    reached: Complex = origin + size * (c + radius * np.exp(1j * around))
    angle = _find_constant_angle(problem, angles)
    return Parallelogram(
        link_length=radius * size,
        pivot_offset=to_point(origin + size * c - complex(reached[0])),
        point=to_point(complex(reached[0])),
        body_angle=math.degrees(angle),
        rotations=[math.degrees(turn) for turn in around - around[0]],
        **_measure_misses(points, angles, reached, np.full(len(points), angle)),
    )


def _find_constant_angle(problem: MotionProblem, angles: Real) -> float:
    """Return the angle of a body that does not turn: in the middle of what all tolerances permit."""
    slack = _get_limits(problem)[:, 2]
    slack = np.where(np.isfinite(slack), slack, np.pi)
    return float(0.5 * ((angles - slack).max() + (angles + slack).min()))


def _measure_misses(points: Complex, angles: Real, reached: Complex, turned: Real) -> dict[str, float]:
    """Return the greatest distances and angles, degrees, by which a guide misses the requested poses."""
    return {
        "max_distance": float(np.abs(reached - points).max()),
        "max_angle_error": float(np.degrees(np.abs(turned - angles).max())),
    }


def _get_reached_poses(problem: MotionProblem, guide: Guide, shares: Real | None = None) -> tuple[Complex, Real]:
    """Return P and the body's angle (radians) at the positions, from the dimensions of a guide alone.

    ``shares``, between 0 and the number of positions minus 1, are places between the positions instead.
    """
    given = np.array(guide.travels if isinstance(guide, StraightGuide) else guide.rotations)
    moved = given if shares is None else np.interp(shares, np.arange(len(given)), given)
    start, angle = to_complex(guide.point), np.full(len(moved), math.radians(guide.body_angle))
    if isinstance(guide, StraightGuide):
        return start + moved * cmath.rect(1.0, math.radians(guide.direction)), angle
    turns = np.radians(moved)
    if isinstance(guide, Hinge):
        pivot = to_complex(guide.pivot)
        return pivot + (start - pivot) * np.exp(1j * turns), angle + turns
    offset = to_complex(guide.pivot_offset)
    return start + offset - offset * np.exp(1j * turns), angle


def _does_job(problem: MotionProblem, guide: Guide, designs: Sequence[LinkageDesign]) -> bool:
    """Return whether a guide, by its dimensions, carries the body through all positions as accurately as requested."""
    points, angles = _get_poses(problem)
    reached, turned = _get_reached_poses(problem, guide)
    off = reached - points
    errors = np.abs(np.stack([off.real, off.imag, turned - angles], axis=1))
    limits = _get_limits(problem)
    if np.any(errors > limits * (1.0 + 1e-9)):
        return False
    fitted = np.isinf(limits).all(axis=1)
    if not fitted.any():
        return True
    rms = math.sqrt(np.mean((np.abs(off) / problem.task_size) ** 2 + (turned - angles) ** 2))
    best = min((design.metrics.rms_residual for design in designs if design.verification.passed), default=0.0)
    return rms <= max(NEGLIGIBLE_ERROR, ERROR_BAND * best)


def _fits_workspace(problem: MotionProblem, guide: Guide) -> bool:
    """Return whether the pivot of a hinge lies in the permitted regions, and the body on its guide in the workspace."""
    if isinstance(guide, Hinge):
        pivot = np.array([to_complex(guide.pivot)])
        areas = list_side_areas(problem)[0].fixed
        if any(area.compute_distances(pivot)[0] > 0.0 for area in areas):
            return False
    if problem.space is None:
        return True
    first, angle = problem.positions[0].point, math.radians(problem.positions[0].angle)
    points, turned = _get_reached_poses(problem, guide, np.linspace(0.0, len(problem.positions) - 1.0, SWEEP_COUNT))
    # The body's outline is given in the requested first position, which is number 0.
    places = {0: first, **{k: complex(p) for k, p in enumerate(points, 1)}}
    turns = {0: 1.0 + 0j, **{k: cmath.exp(1j * (a - angle)) for k, a in enumerate(turned, 1)}}
    return not problem.space.find_body_collisions(places, turns)


def _add_parallelogram(problem: MotionProblem, result: MotionResult, guide: Parallelogram) -> MotionResult:
    """Return a result with a parallelogram of the guide among its designs; unchanged if none passes verification."""
    if any(is_parallelogram(design) for design in result.designs):
        return result
    offset, p = to_complex(guide.pivot_offset), to_complex(guide.point)
    middle = math.radians(0.5 * (min(guide.rotations) + max(guide.rotations)))
    # A coupler at right angles to the cranks in the middle of the motion transmits best over its whole range.
    coupler = 1j * offset * cmath.exp(1j * middle)
    stands = None if guide.body_angle == problem.positions[0].angle else guide.body_angle
    joints = FourbarConfiguration(p + offset, p, p + coupler, p + coupler + offset, p)
    design = verify(problem, build_fourbar(joints, stands))
    design = None if design is None else check_shared_constraints(problem, design)
    if design is None or not design.verification.passed:
        return result
    search = result.search
    counted = {"candidates": search.candidates + 1, "accepted": search.accepted + 1}
    return result.model_copy(
        update={
            "designs": [design, *result.designs][: problem.max_designs],
            "search": search.model_copy(update=counted),
        }
    )


def _announce(problem: MotionProblem, result: MotionResult, guide: Guide) -> MotionResult:
    """Return a result with the guide, whose summary begins with the numbers by which it is built."""
    sentences = [_describe(problem, guide)]
    if guide.max_distance > ROUNDING * problem.task_size or guide.max_angle_error > math.degrees(ROUNDING):
        missed = {"distance": f"{guide.max_distance:.2g}", "angle": f"{guide.max_angle_error:.2g}"}
        sentences.append(compose("motion-guide-misses", unit=problem.length_unit, **missed))
    summary = join_messages([*sentences, result.summary])
    return result.model_copy(update={"guide": guide, "summary": summary})


def _describe(problem: MotionProblem, guide: Guide) -> str:
    """Describe a guide by the numbers with which it is built."""

    def write(length: float) -> str:
        return f"{0.0 if abs(length) < ROUNDING * problem.task_size else length:.6g}"

    def write_point(point: tuple[float, float]) -> dict[str, str]:
        return {"x": write(point[0]), "y": write(point[1]), "unit": problem.length_unit}

    if isinstance(guide, Hinge):
        radius = write(abs(to_complex(guide.point) - to_complex(guide.pivot)))
        turn = f"{np.ptp(guide.rotations):.4g}"
        return compose("motion-hinge-suffices", **write_point(guide.pivot), radius=radius, turn=turn)
    if isinstance(guide, StraightGuide):
        travel, angle = write(float(np.ptp(guide.travels))), f"{guide.direction:.6g}"
        return compose("motion-slide-suffices", **write_point(guide.point), angle=angle, travel=travel)
    length = write(guide.link_length)
    return compose("motion-parallelogram-suffices", **write_point(guide.pivot_offset), length=length)
