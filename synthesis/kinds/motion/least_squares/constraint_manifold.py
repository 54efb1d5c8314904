"""A dyad as a surface in the space of the body's poses, and the distance of a pose from it.

A pose (x, y, φ) consists of the coordinates of P and the body's rotation from the first position. A dyad constrains the
body to a surface f = 0 in the space of poses. With A = P + e^{iφ} α the ground position of a body point α, and
V = e^{−iφ}(O − P) the position of a fixed point O relative to the body,

    forward     w = A − w₀:   the point A of the body moves on a circle or a line fixed in the ground;
    inverted    w = V − w₀:   the fixed point O lies on a circle or a line fixed in the body;

    f = κ|w|²/2 + n·w − d,    n = e^{iν},    ν, d, κ and the point (α or O) the five numbers of the dyad.

The circle passes near w₀ with normal n and has curvature κ. κ = 0 is a line: a PR dyad (the pin A slides on a line of
the ground) or, inverted, an RP dyad (a line of the body slides through a block pinned at O). With κ ≠ 0 either form
describes an RR dyad; the form whose point (α or O) lies nearer to the origin is used. If the other pivot then goes to
infinity, all five numbers stay bounded, and the dyad becomes the slider with κ = 0.

Poses are weighted by variances D = diag(τ²), one tolerance per coordinate, 0 for an exact coordinate. The pose nearest
to a target pose t that two dyads allow is t + D Jᵀλ, by repeated linearization; with S = J D Jᵀ = L Lᵀ the weighted
distance is |Lᵀλ|. By the envelope theorem its derivative by a number of a dyad is, to first order, that of L⁻¹f at the
fixed nearest pose. The poses are therefore not unknowns of a Gauss–Newton step, only the ten numbers are (orthogonal
distance regression; Ahn, *Least Squares Orthogonal Distance Fitting of Curves and Surfaces*, 2004).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Real
from kinematics.compiling import njit

DYAD_NUMBER_COUNT = 5
"""Number of parameters of a dyad: two coordinates of its point, ν, d, κ."""

MAX_LINEARIZATIONS = 30
"""Maximum number of linearizations for a nearest pose; a few usually suffice."""

POSE_TOLERANCE = 1e-14
"""Step of the nearest pose (task sizes, radians) below which the iteration has converged."""

LOST_RESIDUAL = 1e6
"""Residual of a pose whose nearest allowed pose was not found; larger than any regular residual."""

MAX_STEP = 1e6
"""Step of the nearest pose (task sizes, radians) at which the iteration counts as divergent."""

MIN_DETERMINANT = 1e-12
"""Minimum of s₁₁s₂₂ − s₁₂² relative to s₁₁s₂₂; below it the two surfaces are tangent, and both dyads allow the same
motions."""


class Surface(NamedTuple):
    """One dyad's surface apart from its five numbers: its form, the reference w₀, and whether κ is free or 0."""

    inverted: bool
    origin: complex
    curved: bool


@njit(cache=True, nogil=True)
def evaluate_constraint(
    inverted: bool,
    origin: complex,
    p: NDArray[np.float64],
    pose: NDArray[np.float64],
    by_pose: NDArray[np.float64],
    by_number: NDArray[np.float64],
) -> float:
    """Return f at a pose and write its derivatives by the pose (3,) and by the dyad's numbers (5,).

    Parameters
    ----------
    inverted, origin
        Form and w₀ of the surface.
    p : float, shape (5,)
        The dyad's numbers: point (two coordinates), ν, d, κ.
    pose : float, shape (3,)
        x, y, φ.
    """
    spin = complex(math.cos(pose[2]), math.sin(pose[2]))
    if inverted:
        spin = spin.conjugate()
        arm = spin * (complex(p[0], p[1]) - complex(pose[0], pose[1]))
        w = arm - origin
        by_x, by_turn = -spin, -1j * arm
    else:
        arm = spin * complex(p[0], p[1])
        w = complex(pose[0], pose[1]) + arm - origin
        by_x, by_turn = complex(1.0, 0.0), 1j * arm
    n = complex(math.cos(p[2]), math.sin(p[2]))
    g = (p[4] * w + n).conjugate()
    by_pose[0] = (g * by_x).real
    by_pose[1] = (g * 1j * by_x).real
    by_pose[2] = (g * by_turn).real
    by_number[0] = (g * spin).real
    by_number[1] = (g * 1j * spin).real
    by_number[2] = ((1j * n).conjugate() * w).real
    by_number[3] = -1.0
    square = w.real * w.real + w.imag * w.imag
    by_number[4] = 0.5 * square
    value: float = 0.5 * p[4] * square + (n.conjugate() * w).real - p[3]
    return value


@njit(cache=True, nogil=True)
def _linearize_constraint(
    inverted: bool,
    origin: complex,
    numbers: NDArray[np.float64],
    x: NDArray[np.float64],
    target: NDArray[np.float64],
    by_pose: NDArray[np.float64],
    by_number: NDArray[np.float64],
) -> float:
    """Linearize the constraint of a dyad at x; return its value extrapolated to the target pose."""
    ahead: float = evaluate_constraint(inverted, origin, numbers, x, by_pose, by_number)
    for c in range(3):
        ahead += by_pose[c] * (target[c] - x[c])
    return ahead


@njit(cache=True, nogil=True)
def _move_pose(
    x: NDArray[np.float64],
    target: NDArray[np.float64],
    weighted: NDArray[np.float64],
    first: float,
    second: float,
) -> float:
    """Move x to the nearest pose of the linearized constraints, by their multipliers; return the largest change."""
    moved = 0.0
    for c in range(3):
        step = target[c] + weighted[0, c] * first + weighted[1, c] * second - x[c]
        x[c] += step
        moved = max(moved, abs(step))
    return moved


@njit(cache=True, nogil=True)
def find_nearest_poses(
    inverted: NDArray[np.bool_],
    origins: NDArray[np.complex128],
    numbers: NDArray[np.float64],
    targets: NDArray[np.float64],
    variances: NDArray[np.float64],
    linearizations: int,
    residuals: NDArray[np.float64],
    jacobian: NDArray[np.float64],
    poses: NDArray[np.float64],
) -> None:
    """Find the nearest poses that two dyads allow, and the weighted residuals with their Jacobian.

    Parameters
    ----------
    inverted, origins, numbers
        Surfaces of the two dyads, shapes (2,), (2,) and (2, 5).
    targets, variances : float, shape (n, 3)
        Target poses and τ².
    linearizations : int
        1 for the first-order distance (Sampson's), more for the distance itself.
    residuals, jacobian, poses : float, shapes (n, 2), (n, 2, 10) and (n, 3)
        Output arrays: residuals whose squares add up to the squared weighted distance, and the nearest poses.
    """
    by_pose, by_number = np.empty((2, 3)), np.empty((2, DYAD_NUMBER_COUNT))
    weighted, x, ahead = np.empty((2, 3)), np.empty(3), np.empty(2)
    for k in range(len(targets)):
        target, variance = targets[k], variances[k]
        x[:] = target
        converged = linearizations == 1
        l11 = l21 = l22 = first = second = 0.0
        for _ in range(linearizations):
            for side in range(2):
                by = by_pose[side], by_number[side]
                ahead[side] = _linearize_constraint(inverted[side], origins[side], numbers[side], x, target, *by)
                for c in range(3):
                    weighted[side, c] = by_pose[side, c] * variance[c]
            s11 = s12 = s22 = 0.0
            for c in range(3):
                s11 += by_pose[0, c] * weighted[0, c]
                s12 += by_pose[0, c] * weighted[1, c]
                s22 += by_pose[1, c] * weighted[1, c]
            determinant = s11 * s22 - s12 * s12
            if not determinant > MIN_DETERMINANT * s11 * s22:
                converged = False
                break
            first = -(s22 * ahead[0] - s12 * ahead[1]) / determinant
            second = -(s11 * ahead[1] - s12 * ahead[0]) / determinant
            l11 = math.sqrt(s11)
            l21 = s12 / l11
            l22 = math.sqrt(determinant / s11)
            if linearizations == 1:
                break
            moved = _move_pose(x, target, weighted, first, second)
            # Also true for NaN: a divergent iteration must end.
            if not moved < MAX_STEP:
                break
            if moved < POSE_TOLERANCE * (1.0 + abs(x[0]) + abs(x[1])):
                converged = True
                break
        poses[k] = x
        if not converged:
            residuals[k] = LOST_RESIDUAL
            jacobian[k] = 0.0
            continue
        # r = −Lᵀλ, and its derivative L⁻¹ ∂f/∂p.
        residuals[k, 0] = -(l11 * first + l21 * second)
        residuals[k, 1] = -l22 * second
        jacobian[k] = 0.0
        for c in range(DYAD_NUMBER_COUNT):
            jacobian[k, 0, c] = by_number[0, c] / l11
            jacobian[k, 1, c] = -l21 / l22 * jacobian[k, 0, c]
            jacobian[k, 1, DYAD_NUMBER_COUNT + c] = by_number[1, c] / l22


@njit(cache=True, nogil=True)
def compute_surface_distances(
    inverted: bool,
    origin: complex,
    numbers: NDArray[np.float64],
    targets: NDArray[np.float64],
    variances: NDArray[np.float64],
    residuals: NDArray[np.float64],
    jacobian: NDArray[np.float64],
) -> None:
    """Compute the first-order weighted distances of poses from one dyad's surface, f/√(J D Jᵀ), and their Jacobian.

    ``residuals`` (n,) and ``jacobian`` (n, 5) are written. If all coordinates are exact, the residual is f itself.
    """
    by_pose = np.empty(3)
    for k in range(len(targets)):
        value = evaluate_constraint(inverted, origin, numbers, targets[k], by_pose, jacobian[k])
        s = 0.0
        for c in range(3):
            s += by_pose[c] * by_pose[c] * variances[k, c]
        scale = 1.0 / math.sqrt(s) if s > 0.0 else 1.0
        residuals[k] = scale * value
        for c in range(DYAD_NUMBER_COUNT):
            jacobian[k, c] *= scale


def make_surface(fixed: complex, moving: complex) -> tuple[Surface, Real]:
    """Return surface and numbers of an RR dyad, given its fixed pivot and its moving pivot in the pose (0, 0, 0)."""
    inverted = abs(fixed) < abs(moving)
    point, centre = (fixed, moving) if inverted else (moving, fixed)
    arm = point - centre
    numbers = np.array([point.real, point.imag, math.atan2(arm.imag, arm.real), 0.0, 1.0 / abs(arm)])
    return Surface(inverted, point, True), numbers


def compute_pivots(surface: Surface, numbers: Real) -> tuple[complex, complex]:
    """Return the fixed pivot, and the moving pivot in the pose (0, 0, 0), of an RR dyad; κ must not be 0."""
    point = complex(numbers[0], numbers[1])
    centre = complex(surface.origin - np.exp(1j * numbers[2]) / numbers[4])
    return (point, centre) if surface.inverted else (centre, point)


def compute_line(surface: Surface, numbers: Real) -> tuple[complex, complex, float]:
    """Return the point (α or O), the foot of the normal from w₀, and the line's angle, radians, for κ = 0."""
    n = complex(np.exp(1j * numbers[2]))
    return complex(numbers[0], numbers[1]), surface.origin + numbers[3] * n, float(numbers[2]) + 0.5 * math.pi
