"""Drive Stephenson II sixbars through the turn of their crank, in compiled loops.

Link 4 hangs on three legs: the links 3 (A–B) and 5 (C–D) on the crank O2 A C, and the output O4–E on the ground. With
its inner pins q_k, its outer ones j_k and the leg's length l_k the place of link 4, B and its direction γ, is that at
which

    |q_k − j_k|² = l_k²,  k = 1, 2, 3.

The pose is followed from step to step by Newton's method, so that no dyad of the mechanism has to close by itself, and
links 3 and 5 may swing relative to the crank in any way. A sixbar does not complete the turn if the sine of a
transmission angle vanishes or changes its sign at a step, or if link 4 does not return to its first pose. Verification
later checks the motion between the steps.
"""

from __future__ import annotations

import math

import numpy as np

from kinematics.arrays import Complex, Real
from kinematics.compiling import njit
from synthesis.fit.triad_slant import compute_leg_slant

FIXED_INDEX, C, B, D, E, SHORTEST_INDEX, BEGIN_INDEX = 0, 1, 3, 5, 7, 9, 10
"""Index of the first number of each part of a shape: distance of O4 from O2; C in the frame of the crank, from O2 and
with the real axis to A; B, D and E at the beginning of the first dwell, with O4 on the real axis; the minimum distance
of two pins of a link; and the angle of the crank at the beginning of the first dwell, followed by those of the others.
"""

LEG_COUNT = 3

MAX_NEWTON_STEPS, NEWTON_TOLERANCE, MAX_NEWTON_ROTATION = 12, 1e-12, 0.5
"""Newton's method for the pose of link 4: maximum number of steps, tolerance of the last step relative to the sixbar's
size, and maximum rotation in one step, radians."""

MAX_STEP_ROTATION = 0.7
"""Maximum rotation of link 4 between two steps of the crank, radians."""

CLOSURE_TOLERANCE = 1e-6
"""Maximum distance of link 4 from its first place after a turn, as a share of the size and in radians."""


@njit(cache=True, nogil=True, error_model="numpy")
def _settle_link(outer: Complex, legs: Real, inner: Complex, pose: Real, work: Real) -> bool:
    """Solve for the pose of link 4 at which its three legs have their lengths; return whether that converged.

    ``pose`` (x and y of B, and γ) is the initial guess and receives the solution. ``inner`` contains the pins of link 4
    in its own frame, whose origin is the first of them, B. ``work`` (4, :data:`LEG_COUNT`) is scratch.
    """
    f, px, py, moment = work
    size = 1.0 + legs.max()
    for _ in range(MAX_NEWTON_STEPS):
        along = complex(math.cos(pose[2]), math.sin(pose[2]))
        for k in range(LEG_COUNT):
            arm = along * inner[k]
            px[k] = pose[0] + arm.real - outer[k].real
            py[k] = pose[1] + arm.imag - outer[k].imag
            moment[k] = arm.real * py[k] - arm.imag * px[k]
            f[k] = 0.5 * (px[k] * px[k] + py[k] * py[k] - legs[k] * legs[k])
        # Cramer's rule; the first pin is the origin of link 4, so that the first row has no moment.
        one = py[1] * moment[2] - moment[1] * py[2]
        two = px[1] * moment[2] - moment[1] * px[2]
        lack = f[1] * moment[2] - moment[1] * f[2]
        determinant = px[0] * one - py[0] * two
        x = (f[0] * one - py[0] * lack) / determinant
        y = (px[0] * lack - f[0] * two) / determinant
        rotated = px[0] * (py[1] * f[2] - f[1] * py[2]) - py[0] * (px[1] * f[2] - f[1] * px[2])
        rotated = (rotated + f[0] * (px[1] * py[2] - py[1] * px[2])) / determinant
        if not math.isfinite(rotated):
            return False
        # A limited rotation keeps Newton's method on the branch on which it started.
        share = min(1.0, MAX_NEWTON_ROTATION / max(abs(rotated), MAX_NEWTON_ROTATION))
        pose[0] -= share * x
        pose[1] -= share * y
        pose[2] -= share * rotated
        if (abs(x) + abs(y)) / size + abs(rotated) < NEWTON_TOLERANCE:
            return True
    return False


@njit(cache=True, nogil=True, error_model="numpy")
def _place_pins(
    at: Real, begin: float, c: complex, o4: complex, poses: Real, legs: Real, inner: Complex, pins: Complex
) -> bool:
    """Compute B, D and E at crank angles between the poses of a turn; return whether all were found."""
    steps, pose, work = len(poses) - 1, np.empty(3), np.empty((4, LEG_COUNT))
    outer = np.array([1.0 + 0.0j, c, o4])
    for n in range(len(at)):
        share = (at[n] - begin) / (2.0 * math.pi)
        # Start Newton's method from the interpolated pose of the neighbouring steps.
        share = (share - math.floor(share)) * steps
        before = min(int(share), steps - 1)
        for j in range(3):
            pose[j] = poses[before, j] + (share - before) * (poses[before + 1, j] - poses[before, j])
        crank = complex(math.cos(at[n]), math.sin(at[n]))
        outer[0], outer[1] = crank, c * crank
        if not _settle_link(outer, legs, inner, pose, work):
            return False
        along = complex(math.cos(pose[2]), math.sin(pose[2]))
        for leg in range(LEG_COUNT):
            pins[n, leg] = complex(pose[0], pose[1]) + inner[leg] * along
    return True


@njit(cache=True, nogil=True, error_model="numpy")
def drive_triad(shape: Real, at: Real, least: float, pins: Complex, course: Real, sines: Real) -> bool:
    """Drive a sixbar through a turn; return whether it completes the turn and transmits force throughout.

    Parameters
    ----------
    shape : float, shape (BEGIN_INDEX + dwells,)
    at : float, shape (n,)
        Further crank angles, radians, at which link 4 is required, in addition to the steps of the turn.
    least : float
        Sine of a transmission angle at and below which the sixbar is discarded.
    pins : complex, shape (n, LEG_COUNT)
        Filled: B, D and E at these angles.
    course : float, shape (N,)
        Filled: the output's angle from the beginning of the first dwell, at N equal steps of the turn from there on.
    sines : float, shape (N, LEG_COUNT)
        Filled: magnitudes of the sines of the transmission angles of output, link 3 and link 5 at these steps.
    """
    steps, begin = len(course), shape[BEGIN_INDEX]
    crank, c, o4 = (
        complex(math.cos(begin), math.sin(begin)),
        complex(shape[C], shape[C + 1]),
        complex(shape[FIXED_INDEX]),
    )
    outer = np.array([crank, c * crank, o4])
    b, d, e = complex(shape[B], shape[B + 1]), complex(shape[D], shape[D + 1]), complex(shape[E], shape[E + 1])
    # Link 4 and the output need a length.
    if not (abs(d - b) > 0.0 and abs(e - o4) > 0.0):
        return False
    carried = np.array([b, d, e])
    legs, inner = np.abs(carried - outer), (carried - b) * (d - b).conjugate() / abs(d - b)
    poses, work = np.empty((steps + 1, 3)), np.empty((4, LEG_COUNT))
    poses[0, 0], poses[0, 1], poses[0, 2] = b.real, b.imag, math.atan2((d - b).imag, (d - b).real)
    pose, first, hand = poses[0].copy(), e - o4, 0.0
    for n in range(steps + 1):
        angle = begin + 2.0 * math.pi * n / steps
        crank = complex(math.cos(angle), math.sin(angle))
        outer[0], outer[1] = crank, c * crank
        if n > 0:
            for j in range(3):
                # Predict the pose by linear extrapolation.
                pose[j] = 2.0 * poses[n - 1, j] - poses[n - 2, j] if n > 1 else poses[0, j]
            if not _settle_link(outer, legs, inner, pose, work) or abs(pose[2] - poses[n - 1, 2]) > MAX_STEP_ROTATION:
                return False
            poses[n] = pose
        b = complex(pose[0], pose[1])
        along = complex(math.cos(pose[2]), math.sin(pose[2]))
        d, e = b + inner[1] * along, b + inner[2] * along
        for leg in range(LEG_COUNT):
            _, sine = compute_leg_slant(leg, e, o4, outer[0], b, outer[1], d)
            if n == 0 and leg == 0:
                hand = sine
            # All legs share the sign of the sine, which changes at a toggle.
            if not (abs(sine) > least and sine * hand > 0.0):
                return False
            if n < steps:
                sines[n, leg] = abs(sine)
        if n < steps:
            arm = (e - o4) / first
            course[n] = math.atan2(arm.imag, arm.real)
    whole = poses[steps] - poses[0]
    whole[2] -= 2.0 * math.pi * round(whole[2] / (2.0 * math.pi))
    whole[:2] /= 1.0 + legs.max()
    # A triad may close its turn in another assembly, or only after several turns.
    if not np.abs(whole).sum() < CLOSURE_TOLERANCE:
        return False
    return _place_pins(at, begin, c, o4, poses, legs, inner, pins)


@njit(cache=True, nogil=True, error_model="numpy")
def drive_triads(shapes: Real, at: Real, pins: Complex, course: Real, sines: Real) -> None:
    """Apply :func:`drive_triad` to shapes (m, ...); NaN where one does not complete its turn."""
    for i in range(len(shapes)):
        if not drive_triad(shapes[i], at[i], 0.0, pins[i], course[i], sines[i]):
            pins[i], course[i], sines[i] = np.nan, np.nan, np.nan
