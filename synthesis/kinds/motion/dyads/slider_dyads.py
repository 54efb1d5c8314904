"""Slider dyads that carry the body exactly: points of the body (or of the ground, relative to it) that move on lines.

A PR dyad is a point A of the body whose images lie on one line of the ground; an RP dyad is a fixed point O whose
images in the body lie on one line of the body, which then slides through a block at O. In both the images are
s_k + t_k z with |t_k| = 1 and z the point, so their differences from the first one are d_k = a_k + b_k z. With the
position j of the largest rotation, and the pole w = −a_j/b_j of that displacement, u = z − w gives d_j = b_j u and
d_k = e_k + b_k u. Three images are collinear if Im(conj(d_j) d_k) = 0; divided by |u|² this is *linear in y = 1/u*,

    Im(conj(b_j) e_k y) = −Im(conj(b_j) b_k).

So two positions leave the whole plane; three leave a line of y, that is, a circle of points through the pole; four
leave one point; five leave a point only by chance (Bottema & Roth, *Theoretical Kinematics*, ch. VIII; the finite
analogue of Ball's point). The pole itself is no slider: its two images coincide.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Complex, Real
from kinematics.message import compose
from synthesis.kinds.motion.statement.dyad_choices import DyadChoices
from synthesis.kinds.motion.task.positions import MotionTask, find_given_pivot
from synthesis.kinds.motion.task.random_points import sample_distances, sample_points_around

LINE_TOLERANCE = 1e-9
"""Tolerance for images on a line, in task sizes; the same as for residuals of targets."""

PARALLEL_TOLERANCE = 1e-9
"""|b_k| below which two positions count as parallel."""

RESOLUTION_LIMIT = 1e-13
"""|b_k| up to which two positions are parallel to rounding; between this value and :data:`PARALLEL_TOLERANCE` too few
digits remain to decide."""

MAX_DISTANCE = 1e3
"""Maximum distance of a slider's point, in task sizes; farther ones cannot be built in practice."""

STRAIGHT_TOLERANCE = 1e-9
"""Distance of the line of y from the origin below which the circle of points degenerates to a line through the pole."""


class Sliders(NamedTuple):
    """Slider dyads: their points z and the angles of their lines (radians; for RP in the first position).

    ``sampled``: they are a sample of a family. ``proved``: they are provably all.
    """

    points: Complex
    angles: Real
    sampled: bool
    proved: bool
    reason: str = ""


class _Images(NamedTuple):
    """Differences of images from the first, d_k = a_k + b_k z, shapes (n − 1,)."""

    a: Complex
    b: Complex


def find_sliders(
    task: MotionTask, choices: DyadChoices, *, inverted: bool, rng: np.random.Generator, count: int
) -> Sliders:
    """Find all slider dyads of one side, or sample about ``count`` of them if there is a family.

    Parameters
    ----------
    task : MotionTask
        Two to five positions.
    choices : DyadChoices
        May contain the pivot (``moving_pivot`` or ``coupler_vector`` for PR, ``fixed_pivot`` for RP) and
        ``slide_angle``.
    inverted : bool
        RP instead of PR.
    """
    images = _compute_images(task, inverted)
    stated = find_given_pivot(task, choices, fixed=inverted)
    angle = None if choices.slide_angle is None else math.radians(choices.slide_angle)
    if stated is not None:
        points, sampled, plain = np.array([stated]), False, True
    elif angle is not None:
        points, sampled, plain = _solve_with_angle(images, angle, rng, count)
    else:
        points, sampled, plain = _solve_any_angle(task, images, rng, count, inverted)
    # Infinite points come from a vanishing y and belong to no slider.
    near = np.isfinite(points) & (np.abs(points) < MAX_DISTANCE)
    proved = plain and not sampled and bool(near.all())
    points = points[near]
    d = images.a[:, None] + images.b[:, None] * points
    # The longest displacement gives the best-conditioned direction of the line.
    along = d[np.abs(d).argmax(axis=0), np.arange(len(points))] if len(points) else np.empty(0, np.complex128)
    with np.errstate(divide="ignore", invalid="ignore"):
        unit = along / np.abs(along)
        off = np.abs((np.conj(unit) * d).imag).max(axis=0, initial=0.0)
    angles = np.angle(unit)
    if angle is not None:
        # The distance from a line of the given direction counts over the whole displacement.
        off = np.maximum(off, np.abs(np.sin(angles - angle)) * np.abs(along))
        angles = np.full(len(points), angle)
    # A point that does not move slides on no line, or on all of them.
    good = (off <= LINE_TOLERANCE) & (np.abs(along) > LINE_TOLERANCE)
    reason = compose("motion-no-fixed-point-on-line" if inverted else "motion-no-body-point-on-line")
    return Sliders(points[good], angles[good], sampled, proved, reason)


def _compute_images(task: MotionTask, inverted: bool) -> _Images:
    # Seen from the body, the ground turns the other way: the same equations then give RP dyads.
    t = np.conj(task.turns) if inverted else task.turns
    s = task.points[0] - t * task.points if inverted else task.points - t * task.points[0]
    return _Images((s - s[0])[1:], (t - t[0])[1:])


def _solve_with_angle(
    images: _Images, angle: float, rng: np.random.Generator, count: int
) -> tuple[Complex, bool, bool]:
    """Find points that slide in a given direction: one linear equation for each later position.

    Also return whether the points are a sample, and whether the positions have enough digits to decide this.
    """
    turn = np.exp(-1j * angle)
    # Im(turn (a + b z)) = 0 with z = x + iy
    matrix = np.stack([(turn * images.b).imag, (turn * images.b).real], axis=1)
    right = -(turn * images.a).imag
    point, free, plain = _solve_linear(matrix, right)
    if not len(free):
        return np.array([point]), False, plain
    # Random signs sample both directions of the line.
    spread = sample_distances(rng, count, len(free)) * rng.choice([-1.0, 1.0], (count, len(free)))
    return np.asarray(point + spread @ free), True, False


def _solve_any_angle(
    task: MotionTask, images: _Images, rng: np.random.Generator, count: int, inverted: bool
) -> tuple[Complex, bool, bool]:
    """Find points whose images lie on a line of any direction; return the same values as :func:`_solve_with_angle`."""
    n = len(images.a) + 1
    centre = task.points.mean() if inverted else task.points[0]
    around = sample_points_around(centre, rng, count)
    j = int(np.abs(images.b).argmax())
    # Two images always lie on a line; in a pure translation all points are alike, and the caller's check decides.
    if n == 2 or abs(images.b[j]) <= PARALLEL_TOLERANCE:
        return around, True, False
    others = [k for k in range(n - 1) if k != j]
    pole = -images.a[j] / images.b[j]
    e, b = images.a[others] + images.b[others] * pole, images.b[others]
    factor = np.conj(images.b[j]) * e
    matrix = np.stack([factor.imag, factor.real], axis=1)  # Im(factor y), y = y1 + i y2
    right = -(np.conj(images.b[j]) * b).imag
    y, free, plain = _solve_linear(matrix, right)
    nobody = np.empty(0, np.complex128)
    # All positions have the same pole, so y drops out: either all points move on lines, or none.
    if len(free) == 2:
        parallel = np.abs(right).max() <= PARALLEL_TOLERANCE
        return around if parallel else nobody, bool(parallel), plain and not parallel
    if not len(free):
        # The point approaches infinity as y vanishes.
        return (np.array([pole + 1.0 / y]), False, plain) if abs(y) > STRAIGHT_TOLERANCE else (nobody, False, False)
    direction = complex(free[0])
    if abs(y) <= STRAIGHT_TOLERANCE:
        # A line of y through the origin makes the circle of points a straight line through the pole.
        spread = sample_distances(rng, count) * rng.choice([-1.0, 1.0], count)
        return np.asarray(pole + spread * direction.conjugate()), True, False
    # u lies on a circle through the pole with diameter 1/|y|: half of the samples are uniform, half dense near it.
    turned = rng.uniform(-0.5 * np.pi, 0.5 * np.pi, count - count // 2)
    distance = sample_distances(rng, count // 2)
    # No point of the circle is farther from the pole than its diameter.
    distance = distance[distance * abs(y) < 1.0]
    close = np.arccos(distance * abs(y)) * rng.choice([-1.0, 1.0], len(distance))
    along = np.concatenate([turned, close])
    return np.asarray(pole + np.cos(along) * np.exp(-1j * along) / y), True, False


def _solve_linear(matrix: Real, right: Real) -> tuple[complex, Complex, bool]:
    """Return the minimum-norm solution of M (x, y) = r as x + iy, and zero to two unit directions of freedom.

    The third value is False if too few digits remain to determine the number of directions.
    """
    u, s, vh = np.linalg.svd(matrix, full_matrices=True)
    # The rows are formed from unit turns and task units, so an absolute tolerance is adequate.
    rank = int(np.sum(s > PARALLEL_TOLERANCE))
    x = (vh[:rank].T / s[:rank]) @ (u[:, :rank].T @ right)
    plain = not np.any((s > RESOLUTION_LIMIT) & (s <= PARALLEL_TOLERANCE))
    return complex(x[0], x[1]), vh[rank:] @ np.array([1.0, 1j]), plain
