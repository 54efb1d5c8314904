"""Slider dyads that carry the body exactly: points of the body, or of the ground seen by the body, that keep to lines.

A PR dyad is a point A of the body whose images lie on one line of the ground; an RP dyad is a fixed point O whose
images in the body lie on one line of the body, which then slides through a block at O. In both the images are
s_k + t_k z with |t_k| = 1 and z the point, and so are the differences d_k = a_k + b_k z from the first one. With the
position j that is turned farthest, and the pole w = −a_j/b_j of that displacement, u = z − w gives d_j = b_j u and
d_k = e_k + b_k u. Three images are in line when Im(conj(d_j) d_k) = 0; divided by |u|² that is *linear in y = 1/u*,

    Im(conj(b_j) e_k y) = −Im(conj(b_j) b_k).

So two positions leave the whole plane, three a line of y, which is a circle of points through the pole, four one point,
and five a point by chance only (Bottema & Roth, *Theoretical Kinematics*, ch. VIII, and Ball's point in finite motion).
The pole itself is no slider: its two images coincide.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from synthesis.kinds.motion.draws import distances, points_around
from synthesis.kinds.motion.stated_dyads import DyadChoices
from synthesis.kinds.motion.task import Complex, MotionTask, Real, stated_pivot

IN_LINE = 1e-9
"""Distance of images from their line, in task sizes, below which they count as on it: as for residuals of targets."""

TURNED = 1e-9
"""|b_k| below which two positions count as parallel."""

LOST = 1e-13
"""The same up to which they are so to rounding: between the two too few digits are left to tell."""

MAX_DISTANCE = 1e3
"""Points farther away than this many task sizes are no sliders that anybody builds."""

STRAIGHT = 1e-9
"""Distance of the line of y from the origin below which the circle of points is a line through the pole."""


class Sliders(NamedTuple):
    """Slider dyads: their points z, and the angles of their lines (radians; of the body's line in the first position).

    ``sampled`` says that they are drawn from a family; ``proved`` that these are all.
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


def sliders(task: MotionTask, choices: DyadChoices, *, inverted: bool, rng: np.random.Generator, count: int) -> Sliders:
    """All slider dyads of one side, or about ``count`` of them where there is a family.

    Parameters
    ----------
    task : MotionTask
        Two to five positions.
    choices : DyadChoices
        The pivot (``moving_pivot`` or ``coupler_vector`` for PR, ``fixed_pivot`` for RP) and ``slide_angle`` may be
        stated.
    inverted : bool
        RP instead of PR.
    """
    images = _images(task, inverted)
    stated = stated_pivot(task, choices, fixed=inverted)
    angle = None if choices.slide_angle is None else math.radians(choices.slide_angle)
    name = "fixed point" if inverted else "point of the body"
    if stated is not None:
        points, sampled, plain = np.array([stated]), False, True
    elif angle is not None:
        points, sampled, plain = _with_angle(images, angle, rng, count)
    else:
        points, sampled, plain = _any_angle(task, images, rng, count, inverted)
    near = np.isfinite(points) & (np.abs(points) < MAX_DISTANCE)
    proved = plain and not sampled and bool(near.all())
    points = points[near]
    d = images.a[:, None] + images.b[:, None] * points
    along = d[np.abs(d).argmax(axis=0), np.arange(len(points))] if len(points) else np.empty(0, np.complex128)
    with np.errstate(divide="ignore", invalid="ignore"):
        unit = along / np.abs(along)
        off = np.abs((np.conj(unit) * d).imag).max(axis=0, initial=0.0)
    angles = np.angle(unit)
    if angle is not None:
        off = np.maximum(off, np.abs(np.sin(angles - angle)) * np.abs(along))
        angles = np.full(len(points), angle)
    good = (off <= IN_LINE) & (np.abs(along) > IN_LINE)
    reason = f"No {name} has its images in all positions on one line."
    return Sliders(points[good], angles[good], sampled, proved, reason)


def _images(task: MotionTask, inverted: bool) -> _Images:
    t = np.conj(task.turns) if inverted else task.turns
    s = task.points[0] - t * task.points if inverted else task.points - t * task.points[0]
    return _Images((s - s[0])[1:], (t - t[0])[1:])


def _with_angle(images: _Images, angle: float, rng: np.random.Generator, count: int) -> tuple[Complex, bool, bool]:
    """Points that slide in a given direction: one linear equation for each later position.

    Returned with them: whether they are drawn, and whether the positions have the digits to tell.
    """
    turn = np.exp(-1j * angle)
    # Im(turn (a + b z)) = 0 with z = x + iy
    matrix = np.stack([(turn * images.b).imag, (turn * images.b).real], axis=1)
    right = -(turn * images.a).imag
    point, free, plain = _solutions(matrix, right)
    if not len(free):
        return np.array([point]), False, plain
    spread = distances(rng, count, len(free)) * rng.choice([-1.0, 1.0], (count, len(free)))
    return np.asarray(point + spread @ free), True, False


def _any_angle(
    task: MotionTask, images: _Images, rng: np.random.Generator, count: int, inverted: bool
) -> tuple[Complex, bool, bool]:
    """Points whose images are in line, whatever the line's direction; the rest as :func:`_with_angle`."""
    n = len(images.a) + 1
    centre = task.points.mean() if inverted else task.points[0]
    around = points_around(centre, rng, count)
    j = int(np.abs(images.b).argmax())
    if n == 2 or abs(images.b[j]) <= TURNED:
        return around, True, False
    others = [k for k in range(n - 1) if k != j]
    pole = -images.a[j] / images.b[j]
    e, b = images.a[others] + images.b[others] * pole, images.b[others]
    factor = np.conj(images.b[j]) * e
    matrix = np.stack([factor.imag, factor.real], axis=1)  # Im(factor y), y = y1 + i y2
    right = -(np.conj(images.b[j]) * b).imag
    y, free, plain = _solutions(matrix, right)
    nobody = np.empty(0, np.complex128)
    if len(free) == 2:
        parallel = np.abs(right).max() <= TURNED
        return around if parallel else nobody, bool(parallel), plain and not parallel
    if not len(free):
        # The point runs off to infinity where y vanishes.
        return (np.array([pole + 1.0 / y]), False, plain) if abs(y) > STRAIGHT else (nobody, False, False)
    direction = complex(free[0])
    if abs(y) <= STRAIGHT:
        spread = distances(rng, count) * rng.choice([-1.0, 1.0], count)
        return np.asarray(pole + spread * direction.conjugate()), True, False
    # u runs on a circle through the pole with the diameter 1/|y|: evenly, and densely near the body.
    turned = rng.uniform(-0.5 * np.pi, 0.5 * np.pi, count - count // 2)
    distance = distances(rng, count // 2)
    distance = distance[distance * abs(y) < 1.0]
    close = np.arccos(distance * abs(y)) * rng.choice([-1.0, 1.0], len(distance))
    along = np.concatenate([turned, close])
    return np.asarray(pole + np.cos(along) * np.exp(-1j * along) / y), True, False


def _solutions(matrix: Real, right: Real) -> tuple[complex, Complex, bool]:
    """Least solution of M (x, y) = r as x + iy, and unit directions, none to two, in which it may be moved.

    The last tells whether their number is beyond doubt.
    """
    u, s, vh = np.linalg.svd(matrix, full_matrices=True)
    rank = int(np.sum(s > TURNED))
    x = (vh[:rank].T / s[:rank]) @ (u[:, :rank].T @ right)
    plain = not np.any((s > LOST) & (s <= TURNED))
    return complex(x[0], x[1]), vh[rank:] @ np.array([1.0, 1j]), plain
