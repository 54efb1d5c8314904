"""Effect of pin clearances at the targets of a linkage: bounds of the positions that P can reach.

A pin may lie anywhere in its hole: a massless *clearance link* between the two centres, at most as long as the
clearance and in any direction (Ting, Zhu and Watkins, The effects of joint clearance on position and orientation
deviation of linkages and manipulators, Mechanism and Machine Theory 35 (2000) 391). At a fixed input, the clearances at
O2 and A move the crank's pin by a vector α in a disc of radius ρ, the sum of both; those at B and O4 lengthen or
shorten the output by γ, |γ| ≤ σ. The clearance of a pin B on a slide moves the slide sideways. So the configuration of
the dyad depends on three numbers, α (two) and γ. With n the guide's normal at B, u = B − A and p = P − A, as in
:mod:`kinematics.linkage.variation`,

    δφ = (|n| γ − n·α) / n·iu,        δP = α + i p δφ

to first order. The set of the displacements δP is convex, and its support in the direction e is
ρ |e − (e·ip) m| + σ |(e·ip) g| with m = n / n·iu and g = |n| / n·iu. The motion of an output depends on α alone, which
then lies in a disc whose radius is the sum of all clearances.

Higher orders are found by driving the linkage with α in :data:`DIRECTION_COUNT` directions, and γ at both ends and in
the middle of its range. The maximum difference from the first order, times :data:`SAFETY_FACTOR`, is added to every
support.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex, Real
from synthesis.manufacture.linkage import ManufacturedLinkage
from synthesis.model.manufacture.answer import Play

DIRECTION_COUNT = 72
"""Number of directions of the clearance vector α that are driven."""

CORNER_COUNT = 24
"""Number of corners of the reported outline."""

SUPPORT_COUNT = 720
"""Number of directions in which the farthest point is searched; they give its distance to 1e-5 of its value."""

SAFETY_FACTOR = 1.5
"""Factor by which the driven higher-order part is enlarged, to cover its maxima between the driven points."""


class _Configuration(NamedTuple):
    """The nominal linkage at its targets.

    Attributes
    ----------
    a, u, normal, arm : complex, shape (t,)
        Position of A, u = B − A, normal n of the guide at B, and p = P − A.
    """

    a: Complex
    u: Complex
    normal: Complex
    arm: Complex


def compute_plays(made: ManufacturedLinkage, clearance: float) -> list[Play] | None:
    """Compute the effect of clearances at each target; None if they let the linkage reach a toggle.

    Parameters
    ----------
    made : ManufacturedLinkage
        The linkage with its targets.
    clearance : float
        Maximum distance between the centres of each pin and its hole.
    """
    at = _evaluate_nominal(made)
    # At a toggle n·iu is 0, and the rotation of the coupler is unbounded.
    lever = _multiply_scalar(at.normal, 1j * at.u)
    if not np.isfinite(lever).all() or np.any(lever == 0.0):
        return None
    guides = made.task.guides
    # The input side has two pins. The output side has two pins, or one pin on a slide.
    crank, guide = 2.0 * clearance, (1.0 if made.task.slides else 2.0) * clearance
    # For an output, all clearances act together, so both radii are added.
    discs = (crank, guide) if guides else (crank + guide, 0.0)
    slope, gain = at.normal / lever, np.abs(at.normal) / lever
    plays = []
    for k in range(len(at.a)):
        near = _Configuration(*(part[k : k + 1] for part in at))
        driven = _drive_clearances(made, near, discs)
        if driven is None:
            return None
        if guides:
            plays.append(_compute_point_play(made, k, near, slope[k], gain[k], discs, driven))
        else:
            plays.append(_compute_output_play(made, k, near, slope[k], discs, driven))
    return plays


class _DrivenClearances(NamedTuple):
    """Driven clearances α and γ, and the resulting changes of P, of the coupler's angle, and of B."""

    alpha: Complex
    gamma: Real
    place: Complex
    turned: Real
    pin: Complex


def _multiply_scalar(a: Complex | complex, b: Complex | complex) -> Real:
    return np.asarray((np.asarray(a) * np.conj(b)).real)


def _evaluate_nominal(made: ManufacturedLinkage) -> _Configuration:
    """Return the nominal linkage at the inputs of its targets."""
    row, task = made.linkage.row, made.task
    o2 = complex(row[0], row[1])
    crank = row[4 - task.slides] * np.exp(1j * task.inputs)
    a = o2 + crank
    if task.slides:
        across = 1j * task.slide_direction
        line = o2 - across * row[2]
        gap = _multiply_scalar(line - a, across)
        # The sign of the assembly determines on which side of A, along the slide, B lies.
        u = task.slide_direction * task.assemblies * np.sqrt(row[4] ** 2 - gap**2) + across * gap
        normal = np.full(len(a), across)
        length = row[4]
    else:
        u = _close_dyad(complex(row[2], row[3]) - a, row[5], row[6], task.assemblies)
        normal = a + u - complex(row[2], row[3])
        length = row[5]
    return _Configuration(a, u, normal, u / length * complex(row[-2], row[-1]))


def _close_dyad(to_centre: Complex, b: float, c: Real | float, sign: NDArray[np.int64] | int) -> Complex:
    """Return u = B − A of a dyad with lengths b (A–B) and c; NaN if it does not close.

    ``to_centre`` is the vector from A to the fixed pivot, and ``sign`` the assembly.
    """
    f = np.abs(to_centre)
    # The factored differences of squares preserve the digits of nearly equal lengths.
    part = (f * f + (b - c) * (b + c)) / (2.0 * f)
    with np.errstate(invalid="ignore"):
        height = np.sqrt((b - part) * (b + part))
    return np.asarray(to_centre / f * (part + 1j * sign * height))


def _drive_clearances(
    made: ManufacturedLinkage, at: _Configuration, discs: tuple[float, float]
) -> _DrivenClearances | None:
    """Drive the linkage at one target with extreme clearances; None if some of them reach a toggle."""
    row, task = made.linkage.row, made.task
    around = discs[0] * np.exp(2j * np.pi * np.arange(DIRECTION_COUNT) / DIRECTION_COUNT)
    shares = np.array([-1.0, 0.0, 1.0])
    # Drive both the full and half the radius, because the nonlinear part need not be at its maximum on the rim.
    alpha = np.concatenate([np.repeat(around, 3), 0.5 * np.repeat(around, 3)])
    gamma = discs[1] * np.tile(shares, 2 * DIRECTION_COUNT)
    a = at.a + alpha
    b = abs(complex(at.u[0]))
    if task.slides:
        across = 1j * task.slide_direction
        gap = _multiply_scalar(complex(row[0], row[1]) - across * row[2] - a, across) + gamma
        with np.errstate(invalid="ignore"):
            way = np.sqrt((b - gap) * (b + gap))
        # Stay in the assembly of the nominal linkage.
        forward = 1.0 if _multiply_scalar(at.u, complex(task.slide_direction))[0] > 0.0 else -1.0
        u = task.slide_direction * forward * way + across * gap
    else:
        centre = complex(row[2], row[3])
        turn = (np.conj(centre - at.a[0]) * at.u[0]).imag
        u = _close_dyad(centre - a, b, abs(complex(at.normal[0])) + gamma, 1 if turn > 0.0 else -1)
    if not np.isfinite(u).all():
        return None
    turned = np.angle(u / at.u)
    return _DrivenClearances(alpha, gamma, alpha + at.arm * (u / at.u - 1.0), turned, a + u - at.a - at.u)


def _compute_point_play(
    made: ManufacturedLinkage,
    k: int,
    at: _Configuration,
    slope: complex,
    gain: float,
    discs: tuple[float, float],
    driven: _DrivenClearances,
) -> Play:
    """Return bounds of the displacement of P at target k and of the coupler's rotation, and an outline around P."""
    arm = complex(at.arm[0])
    # This is the first-order rotation of the coupler, to be compared with the driven one.
    turned = gain * driven.gamma - _multiply_scalar(slope, driven.alpha)
    rest = SAFETY_FACTOR * float(np.abs(driven.place - driven.alpha - 1j * arm * turned).max())

    def compute_support(direction: Complex) -> Real:
        by = _multiply_scalar(direction, 1j * arm)
        # The support of the sum of two sets is the sum of their supports; higher orders are added.
        return np.asarray(discs[0] * np.abs(direction - by * slope) + discs[1] * np.abs(by * gain) + rest)

    least = np.exp(2j * np.pi * np.arange(SUPPORT_COUNT) / SUPPORT_COUNT)
    corners = np.exp(2j * np.pi * np.arange(CORNER_COUNT) / CORNER_COUNT)
    reach = compute_support(corners)
    # Neighbouring tangents e·z = h intersect in the corners of the circumscribed polygon.
    nexts, far = np.roll(corners, -1), np.roll(reach, -1)
    meet = -1j * (reach * nexts - far * corners) / np.sin(2.0 * np.pi / CORNER_COUNT)
    stands = complex(at.a[0]) + arm
    angle = discs[0] * abs(slope) + discs[1] * abs(gain) + SAFETY_FACTOR * float(np.abs(driven.turned - turned).max())
    return Play(
        index=k,
        max_error=float(compute_support(least).max()),
        max_angle_error=math.degrees(angle) if made.task.sort == "poses" else None,
        outline=[(float(z.real), float(z.imag)) for z in stands + meet],
    )


def _compute_output_play(
    made: ManufacturedLinkage,
    k: int,
    at: _Configuration,
    slope: complex,
    discs: tuple[float, float],
    driven: _DrivenClearances,
) -> Play:
    """Return the bound of the output's rotation, or of its displacement along the slide, at target k."""
    if made.task.slides:
        along = complex(made.task.slide_direction)
        moved = _multiply_scalar(driven.pin, along)
        first = _multiply_scalar(driven.alpha, along) - _multiply_scalar(1j * at.u, along) * _multiply_scalar(
            slope, driven.alpha
        )
        reach = abs(along - _multiply_scalar(1j * at.u, along)[0] * slope)
        error = discs[0] * reach + SAFETY_FACTOR * float(np.abs(moved - first).max())
        return Play(index=k, max_error=error)
    normal = complex(at.normal[0])
    turned = np.angle((normal + driven.pin) / normal)
    # This vector is the derivative of the output's angle by a displacement of B.
    tangent = 1j * normal / abs(normal) ** 2
    first = _multiply_scalar(driven.alpha, tangent) - _multiply_scalar(1j * at.u, tangent) * _multiply_scalar(
        slope, driven.alpha
    )
    reach = abs(tangent - _multiply_scalar(1j * at.u, tangent)[0] * slope)
    error = discs[0] * reach + SAFETY_FACTOR * float(np.abs(turned - first).max())
    return Play(index=k, max_angle_error=math.degrees(error))
