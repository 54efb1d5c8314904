"""Compiled sweeps: shared parts of the kernels of all linkages.

A kernel computes the constants of a design once and the cosines and sines of a row of input angles once. The inner loop
over angles has only sums, products, one or two roots and one or two divisions on separate rows of real and imaginary
parts, without branches and calls, so that the compiler vectorizes it (four angles at a time on AVX2). An invalid
position is NaN.

Arguments that kernels share, C-contiguous:

``pivots``   complex (3, D), read-only: the points of a design
``lengths``  float (3, D), read-only: the lengths of a design
``sign``     float (D,) or (1,): assembly signs
``theta``    float (D, N) or (1, N): input angles
``rates``    float (3, D, N) or (3, 1, N): speed, acceleration and jerk of the input

A single design may be given instead of D; it is then repeated. Results are written into the last arguments. Any point
of the coupler is A + arm (B − A) with its own complex ``arm``: 0 for A, 1 for B. In what follows k is the crank A − O2,
u = B − A, and ω, α, φ are the first three derivatives of an angle: ``w``, ``a``, ``j`` in the code, with Norton's
numbers of the links, 2 input, 3 coupler, 4 output.
"""

from __future__ import annotations

import math

import numpy as np

from kinematics.arrays import Complex, Real
from kinematics.compiling import KernelOptions, njit

OPTIONS: KernelOptions = {"cache": True, "nogil": True, "error_model": "numpy"}
"""Options of every kernel: cached on disk, without the interpreter's lock, division by zero as in NumPy."""

TOGGLE_SLACK = 16 * float(np.finfo(np.float64).eps)
"""Amount, as a share of the product of the sides, by which the squared height of a triangle may be negative. It changes
no link by more than that share: a toggle or change point is a valid configuration, and rounding must not remove it."""

TOGGLE_SINE = 1e-6
"""Sine of the transmission angle below which derivatives count as undefined. Near a toggle the sine goes with the root
of the input angle's distance from it: rounding of the toggle angle alone gives a sine of up to 2e-7, and an
acceleration of 1e20 without a single correct digit. At this limit the relative error is about 1 %."""

TILE_SIZE = 128
"""Number of input angles processed together: their intermediate rows stay in the first-level cache."""

OCTANT_TANGENT = math.sqrt(2.0) - 1.0
"""tan(π/8): up to this slope the arc tangent is evaluated directly, above it relative to the diagonal."""


@njit(**OPTIONS)
def compute_direction(x: float, y: float) -> float:
    """Return the angle of the vector (x, y) in (−π, π], without branches; NaN for the zero vector.

    The slope is reduced to 0 … tan(π/8) by symmetry, where (arctan(t)/t − 1)/t² is a polynomial in t² (interpolated
    at Chebyshev points, error 5e-18). The total error is below two units in the last place.
    """
    across, up = math.fabs(x), math.fabs(y)
    # Octant symmetry: arctan of the smaller over the larger component.
    steep = up > across
    large, small = (up if steep else across), (across if steep else up)
    diagonal = small > OCTANT_TANGENT * large
    t = (small - large if diagonal else small) / (large + small if diagonal else large)
    # math.atan2 is a call with branches, which would prevent vectorization.
    z = t * t
    series = 0.03923165829558719 + z * -0.01917688711906226
    series = -0.0508544973794026 + z * series
    series = 0.0585814891280221 + z * series
    series = -0.06664511447381948 + z * series
    series = 0.07692183190826087 + z * series
    series = -0.09090904578123903 + z * series
    series = 0.11111111015256361 + z * series
    series = -0.14285714284666542 + z * series
    series = 0.1999999999999552 + z * series
    series = -0.3333333333333333 + z * series
    angle = t + t * z * series
    angle = (0.25 * math.pi if diagonal else 0.0) + angle
    angle = 0.5 * math.pi - angle if steep else angle
    angle = math.pi - angle if x < 0.0 else angle
    return -angle if y < 0.0 else angle


@njit(**OPTIONS)
def fill_cosines(theta: Real, cosine: Real, sine: Real) -> None:
    """Fill the cosines and sines of a row of angles."""
    for k in range(len(theta)):
        cosine[k] = math.cos(theta[k])
        sine[k] = math.sin(theta[k])


@njit(**OPTIONS)
def divide_by_length(z: complex, length: float) -> complex:
    """Return z / length; the built-in complex division would handle cases that cannot occur."""
    return complex(z.real / length, z.imag / length)


@njit(**OPTIONS)
def fill_points(x: Real, y: Real, ux: Real, uy: Real, arm: complex, point: Complex) -> None:
    """Fill x + iy + arm (ux + i uy): a point of the coupler, or its derivative, from those of A and u = B − A.

    Each loop writes a single complex row: with several the compiler must assume aliasing and does not vectorize.
    """
    for k in range(len(point)):
        point[k] = complex(x[k] + (arm.real * ux[k] - arm.imag * uy[k]), y[k] + (arm.real * uy[k] + arm.imag * ux[k]))


@njit(**OPTIONS)
def fill_velocities(
    kx: Real, ky: Real, ux: Real, uy: Real, w2: Real, w3: Real, arm: complex, velocity: Complex
) -> None:
    """Fill the velocity of a coupler point, i ω2 k + i ω3 arm u."""
    for k in range(len(velocity)):
        x, y = arm.real * ux[k] - arm.imag * uy[k], arm.real * uy[k] + arm.imag * ux[k]
        velocity[k] = complex(-w2[k] * ky[k] - w3[k] * y, w2[k] * kx[k] + w3[k] * x)


@njit(**OPTIONS)
def fill_accelerations(
    kx: Real,
    ky: Real,
    ux: Real,
    uy: Real,
    w2: Real,
    a2: Real,
    w3: Real,
    a3: Real,
    arm: complex,
    acceleration: Complex,
) -> None:
    """Fill the acceleration of a coupler point, (i α2 − ω2²) k + (i α3 − ω3²) arm u."""
    for k in range(len(acceleration)):
        x, y = arm.real * ux[k] - arm.imag * uy[k], arm.real * uy[k] + arm.imag * ux[k]
        n2, n3 = w2[k] * w2[k], w3[k] * w3[k]
        acceleration[k] = complex(
            -n2 * kx[k] - a2[k] * ky[k] - n3 * x - a3[k] * y, a2[k] * kx[k] - n2 * ky[k] + a3[k] * x - n3 * y
        )


@njit(**OPTIONS)
def fill_jerks(
    kx: Real,
    ky: Real,
    ux: Real,
    uy: Real,
    w2: Real,
    a2: Real,
    j2: Real,
    w3: Real,
    a3: Real,
    j3: Real,
    arm: complex,
    jerk: Complex,
) -> None:
    """Fill the jerk of a coupler point; the third derivative of e^{iθ} has the factor i (φ − ω³) − 3 ω α."""
    for k in range(len(jerk)):
        x, y = arm.real * ux[k] - arm.imag * uy[k], arm.real * uy[k] + arm.imag * ux[k]
        n2, t2 = 3.0 * w2[k] * a2[k], j2[k] - w2[k] * w2[k] * w2[k]
        n3, t3 = 3.0 * w3[k] * a3[k], j3[k] - w3[k] * w3[k] * w3[k]
        jerk[k] = complex(-n2 * kx[k] - t2 * ky[k] - n3 * x - t3 * y, t2 * kx[k] - n2 * ky[k] + t3 * x - n3 * y)
