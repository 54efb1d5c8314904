"""Pre-filter: test many linkages for collisions with obstacles at a few sampled positions of their motion.

A compiled kernel drops linkages that clearly collide, so that only the others are driven and verified. A linkage that
passes may still collide between the samples; one that is dropped would fail. Cheap tests come first: a few widely
spaced positions before those between them, the box before obstacles, and circles around outlines before the outlines.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex, Real
from kinematics.compiling import njit
from kinematics.linkage.clearance.outlines import OPTIONS, measure_distance
from kinematics.linkage.fourbar import Fourbar, positions
from synthesis.kinds.motion.exact.input_rotation import measure_input_rotation
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.kinds.motion.task.positions import MotionTask
from synthesis.model.linkage.workspace import Space

SAMPLE_COUNT = 60
"""Number of sampled positions from the first target to the last, or over the cycle."""

FULL_CORNER_COUNT = 60
"""Number of obstacle corners up to which the full number of fourbars is tested; with more corners, fewer are tested."""

CLEARANCE_TOLERANCE = 1e-6
"""Tolerance of a clearance, as a share of the task's size: this filter only selects candidates."""


def limit_batches(space: Space, portions: int) -> int:
    """Return the number of batches to test, at least one: ``portions``, reduced if obstacles have many corners."""
    corners = sum(len(points) for points, _ in (zone.outline for zone in space.obstacles))
    # The cost grows with the number of corners, so fewer linkages are tested then.
    return max(int(portions * min(FULL_CORNER_COUNT / max(corners, 1), 1.0)), 1)


def check_fourbar_clearance(problem: MotionProblem, task: MotionTask, joints: Complex) -> NDArray[np.bool_]:
    """Return a mask of the fourbars that stay within the box and clear of obstacles at the sampled positions.

    Parameters
    ----------
    problem : MotionProblem
        A problem whose ``space`` constrains the motion.
    task : MotionTask
        Its positions.
    joints : complex, shape (n, 4)
        O2, A, B, O4 at the first target, in task coordinates; fourbars that meet the targets.
    """
    space = problem.space
    assert space is not None
    o2, a, b, o4 = (np.ascontiguousarray(task.origin + column * task.size) for column in joints.T)
    point = complex(task.origin)
    linkages = Fourbar(o2, o4, np.abs(a - o2), np.abs(b - a), np.abs(b - o4), (point - a) / (b - a) * np.abs(b - a))
    # The sign of the assembly that meets the first target.
    sign = np.where((np.conj(b - a) * (b - o4)).imag >= 0.0, 1, -1)
    inputs = _sample_inputs(space, task, o2, a)
    at = positions(linkages, inputs, sign)
    home = positions(linkages, np.angle(a - o2)[:, None], sign)
    # The body turns with the coupler, from its angle at the first target.
    spin = np.exp(1j * (at.coupler_angle - home.coupler_angle))
    return _check_clearance(space, task, _MotionSamples(o2, o4[:, None], at.a, at.b, at.p, spin, at.valid))


def check_slider_clearance(
    problem: MotionProblem, task: MotionTask, joints: Complex, angles: Real
) -> NDArray[np.bool_]:
    """Return the same mask for slider-cranks driven by their crank.

    Parameters
    ----------
    joints : complex, shape (n, 3)
        O2, A and the pin B of the slider at the first target, in task coordinates.
    angles : float, shape (n,)
        Angles of the lines on which B slides, radians.
    """
    space = problem.space
    assert space is not None
    o2, a, b = (np.ascontiguousarray(task.origin + column * task.size) for column in joints.T)
    point, along = complex(task.origin), np.exp(1j * angles)
    turned = np.exp(1j * (_sample_inputs(space, task, o2, a) - np.angle(a - o2)[:, None]))
    at_a = o2[:, None] + (a - o2)[:, None] * turned
    # The side on which the slider stays: ahead of A along its line, or behind it.
    reach = ((b - a) * np.conj(along)).real
    off = ((b[:, None] - at_a) * np.conj(along)[:, None]).imag
    # Negative squares: the coupler does not reach the line at this input.
    square = np.abs(b - a)[:, None] ** 2 - off**2
    at_b = at_a + along[:, None] * (np.sign(reach)[:, None] * np.sqrt(np.maximum(square, 0.0)) + 1j * off)
    spin = (at_b - at_a) / (b - a)[:, None]
    at_p = at_a + (point - a)[:, None] * spin
    # A slider has no output link: represent it by a bar of zero length at B.
    return _check_clearance(space, task, _MotionSamples(o2, at_b, at_a, at_b, at_p, spin, square >= 0.0))


class _MotionSamples(NamedTuple):
    """Linkages at the sampled inputs: O2 of shape (n,), O4 of shape (n, 1) or (n, m), the others of shape (n, m)."""

    o2: Complex
    o4: Complex
    a: Complex
    b: Complex
    p: Complex
    spin: Complex
    valid: NDArray[np.bool_]


def _check_clearance(space: Space, task: MotionTask, way: _MotionSamples) -> NDArray[np.bool_]:
    """Return a mask of the linkages that stay within the box and clear of the obstacles."""
    point = complex(task.origin)
    corners = [zone.outline for zone in space.obstacles]
    starts = np.cumsum([0, *(len(points) for points, _ in corners)])
    middles = np.array([complex(points.mean()) for points, _ in corners], np.complex128)
    reaches = np.array([float(np.abs(points - points.mean()).max()) for points, _ in corners])
    outline = (
        np.array([complex(*corner) for corner in space.body.outline]) - point if space.body else np.empty(0, complex)
    )
    out = np.empty(len(way.o2), np.bool_)
    _check_samples(
        *way, outline,
        np.concatenate([points for points, _ in corners]) if corners else np.empty(0, np.complex128),
        starts, np.array([radius for _, radius in corners]), middles, reaches, _get_box(space),
        _order_coarse_first(SAMPLE_COUNT), 0.5 * space.link_width,
        space.clearance - CLEARANCE_TOLERANCE * task.size, CLEARANCE_TOLERANCE * task.size, out,
    )  # fmt: skip
    return out


def _sample_inputs(space: Space, task: MotionTask, o2: Complex, a: Complex) -> Real:
    """Return the sampled input angles, radians, shape (n, SAMPLE_COUNT)."""
    stands = np.angle(a - o2)
    shares = np.linspace(0.0, 1.0, SAMPLE_COUNT)
    if space.over == "cycle":
        return np.asarray(stands[:, None] + math.tau * shares)
    return np.asarray(stands[:, None] + measure_input_rotation(task, o2, a)[:, None] * shares)


def _get_box(space: Space) -> Real:
    """Return the box as (left, right, low, high); infinite bounds without a box."""
    if space.box is None:
        return np.array([-np.inf, np.inf, -np.inf, np.inf])
    (left, low), (right, high) = space.box
    return np.array([left, right, low, high])


def _order_coarse_first(count: int) -> NDArray[np.int64]:
    """Return the integers below a count in order of decreasing spacing, so that gross collisions show early."""
    order: dict[int, None] = {}
    # Start with the power of two above the count and halve the spacing.
    step = 1 << (count - 1).bit_length()
    while step:
        order.update(dict.fromkeys([*range(0, count, step), count - 1]))
        step //= 2
    return np.array(list(order), np.int64)


@njit(**OPTIONS)
def _check_samples(
    o2: Complex,
    o4: Complex,
    a: Complex,
    b: Complex,
    p: Complex,
    spin: Complex,
    valid: NDArray[np.bool_],
    outline: Complex,
    corners: Complex,
    starts: NDArray[np.int64],
    radii: Real,
    middles: Complex,
    reaches: Real,
    box: Real,
    order: NDArray[np.int64],
    half: float,
    clearance: float,
    slack: float,
    out: NDArray[np.bool_],
) -> None:
    """Fill ``out`` with whether each of n linkages is clear at m inputs; shapes of the joints as in
    :class:`_MotionSamples`."""
    bar, hull, body = np.empty(2, np.complex128), np.empty(3, np.complex128), np.empty(len(outline), np.complex128)
    for n in range(len(o2)):
        free = True
        for m in order:
            if not valid[n, m]:
                continue  # the linkage cannot be assembled here; the verification decides about that
            # With an outline of the body the coupler is the bar A–B; without it, the triangle with P.
            hull[0], hull[1], hull[2] = a[n, m], b[n, m], p[n, m]
            for k in range(len(outline)):
                body[k] = p[n, m] + spin[n, m] * outline[k]
            coupler = hull[:2] if len(outline) else hull
            ground = o4[n, m if o4.shape[1] > 1 else 0]
            bar[0], bar[1] = ground, o2[n]
            # The moving ends of both ground links are on the coupler, whose box test covers them.
            free = (
                _is_inside_box(coupler, half, box, slack)
                and _is_inside_box(bar, half, box, slack)
                and _is_inside_box(body, 0.0, box, slack)
            )
            free = free and _is_clear(coupler, half, corners, starts, radii, middles, reaches, clearance)
            free = free and _is_clear(body, 0.0, corners, starts, radii, middles, reaches, clearance)
            bar[1] = b[n, m]
            free = free and _is_clear(bar, half, corners, starts, radii, middles, reaches, clearance)
            bar[0], bar[1] = o2[n], a[n, m]
            free = free and _is_clear(bar, half, corners, starts, radii, middles, reaches, clearance)
            # One collision suffices: the linkage is dropped.
            if not free:
                break
        out[n] = free


@njit(**OPTIONS)
def _is_inside_box(core: Complex, half: float, box: Real, slack: float) -> bool:
    """Return whether a part lies in the box."""
    for z in core:
        if z.real - half < box[0] - slack or z.real + half > box[1] + slack:
            return False
        if z.imag - half < box[2] - slack or z.imag + half > box[3] + slack:
            return False
    return True


@njit(**OPTIONS)
def _is_clear(
    core: Complex,
    half: float,
    corners: Complex,
    starts: NDArray[np.int64],
    radii: Real,
    middles: Complex,
    reaches: Real,
    clearance: float,
) -> bool:
    """Return whether a part is clear of all obstacles; a part without corners is."""
    if not len(core):
        return True
    middle, reach = core.mean(), 0.0
    for z in core:
        reach = max(reach, abs(z - middle))
    for k in range(len(radii)):
        # Gap of the outlines at which the clearance is just kept.
        wanted = clearance + half + radii[k]
        # Enclosing circles decide most cases without the distance of the outlines.
        if abs(middle - middles[k]) - reach - reaches[k] >= wanted:
            continue
        if measure_distance(core, corners[starts[k] : starts[k + 1]]) < wanted:
            return False
    return True
