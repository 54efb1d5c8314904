"""The coupler curve of a fourbar as an algebraic curve: a tricircular sextic with three double points.

Equation (S. Roberts, Proc. London Math. Soc. 7 (1875) 14, doi:10.1112/plms/s1-7.1.14; A. Cayley, ibid. 136,
doi:10.1112/plms/s1-7.1.136; Norton, Sec. 3.6). The point p = x + iy is constrained by the coupler's two bars, of
lengths l = |z| to A and n = |z − b| to B, where z is the coupler point in the coupler's frame. With e = e^{iθ3}, q2 = p
− O2 and q4 = p − O4, A = p − z e lies on its circle about O2 and B = p − (z − b) e on its circle about O4:

    Re(m1 e) = k1,   m1 = q̄2 z,          k1 = (|q2|² + l² − a²) / 2
    Re(m2 e) = k2,   m2 = q̄4 (z − b),    k2 = (|q4|² + n² − c²) / 2

Two linear equations for e; |e| = 1 leaves the curve

    F = |N|² − D² = 0,   N = k1 m2 − k2 m1,   D = Im(m̄1 m2).

Its highest term is b²/4 · (x² + y²)³; divided by b²/4 and with lengths in units of :func:`curve_unit` it is the
*monic* sextic of this module. In p and p̄ it has degree three in each (three times through the circular points).

Double points. N = 0 and D = 0 together, where the two equations for e become one and have two solutions. D = 0 is
the circle of the singular foci, through O2, O4 and the third fixed pivot of the cognates (the line O2 O4 if P is on
the line A B). Written as

    p = (σ0 ū O2 − σ1 v̄ O4) / Δ,    Δ = σ0 ū − σ1 v̄,    u = z / l,   v = (z − b) / n,

it makes m1 and m2 real multiples σ1 l and σ0 n of M = −u v ḡ / Δ̄, g = O4 − O2, so that N = 0 becomes a cubic
form in (σ0, σ1): three double points, one or three of them real. With K = k1 / (σ1 l) = k2 / (σ0 n) the two coupler
directions are e = (K ± √(K² − |M|²)) / M. |K| < |M| is a crunode, which the linkage passes in two configurations;
|K| > |M| an acnode, which it never reaches; |K| = |M| a cusp, where P is on the moving centrode and at the pole. A
change-point linkage has further double points, off the circle, where its links fall into one line; they are not
listed here.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex, Mask, Real
from kinematics.errors import DimensionError
from kinematics.linkage.fourbar.closed_form import CROSSED_ASSEMBLY, OPEN_ASSEMBLY, Fourbar, require
from kinematics.linkage.fourbar.cognates import PIVOT_TOLERANCE

CRUNODE, CUSP, ACNODE = 1, 0, -1
"""Kinds of double points: the curve crosses itself, has a cusp, or is an isolated real point."""

CUSP_TOLERANCE = 1e-9
"""Bound of |1 − K²/|M|²| for a cusp: the loop of the curve then spans less than about 1e-4 rad of the coupler's
rotation, and its size, which goes with the cube of that, is below 1e-12 of the linkage."""

REAL_ROOT_TOLERANCE = 1e-7
"""Imaginary part, relative to 1 + |root|, up to which a root counts as real: rounding splits a double root by √ε, and
the real part of such a pair satisfies the equation to the square of this."""


class DoublePoints(NamedTuple):
    """The three double points on the circle of singular foci, shape designs + (3,), real ones first.

    ``valid`` marks the real ones; ``kind`` is :data:`CRUNODE`, :data:`CUSP` or :data:`ACNODE` (also where ``valid`` is
    False). ``input_angle`` (radians) and ``assembly``, shape designs + (3, 2), are the two configurations at a crunode.
    At a cusp both are the same; without a configuration they are NaN and +1.
    """

    valid: Mask
    point: Complex
    kind: NDArray[np.int64]
    input_angle: Real
    assembly: NDArray[np.int64]


def coupler_curve_degree(links: int) -> int:
    """Return the maximum degree of a coupler curve of a linkage of n links, m = 2 · 3^(n/2 − 1).

    The formula is Wunderlich's (Norton 3.3).

    Raises
    ------
    DimensionError
        For a number of links that is odd or below 4.

    Examples
    --------
    >>> coupler_curve_degree(4)
    6
    """
    if links < 4 or links % 2:
        raise DimensionError("links", "kinematics-even-and-at-least", links, least=4)
    return int(2 * 3 ** (links // 2 - 1))


def curve_unit(linkage: Fourbar) -> Real:
    """Return the unit of length of the monic sextic, a + b + c + d + |AP|, which no link exceeds; shape designs."""
    return np.asarray(linkage.lengths.sum(axis=-1) + np.abs(linkage.coupler_point))


def compute_sextic_coefficients(linkage: Fourbar) -> Complex:
    """Compute the coefficients of the monic sextic Σ C[j, k] ξ^j ξ̄^k with j, k = 0 … 3 and ξ = (p − O2) / unit.

    Shape designs + (4, 4). C is Hermitian and C[3, 3] = 1, which leaves fifteen real numbers. They are equal for a
    linkage and its cognates in a common origin and unit.
    """
    _, a, b, c, z, rest, ground = _scale_dimensions(linkage)
    zero, half = np.zeros_like(z), np.full_like(z, 0.5)

    def build_grid(*rows: tuple[Complex, ...]) -> Complex:
        """Build a grid with rows by powers of ξ and columns by powers of ξ̄."""
        return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)

    k1 = build_grid((0.5 * (_square_magnitude(z) - a * a) + zero, zero), (zero, half))
    k2 = build_grid(
        (0.5 * (_square_magnitude(ground) + _square_magnitude(rest) - c * c) + zero, -0.5 * ground),
        (-0.5 * ground.conj(), half),
    )
    m1, m2 = build_grid((zero, z)), build_grid((-ground.conj() * rest, rest))
    cubic = _multiply_polynomials(k1, m2) - _multiply_polynomials(k2, m1)
    turned = _multiply_polynomials(_conjugate_polynomial(m1), m2)
    circle = -0.5j * (turned - _conjugate_polynomial(turned))
    found = _multiply_polynomials(cubic, _conjugate_polynomial(cubic))
    # D is real and of lower degree, so D² only affects the leading 3 × 3 block.
    found[..., :3, :3] -= _multiply_polynomials(circle, circle)
    return np.asarray(found * (4.0 / (b * b))[..., None, None])


def find_double_points(linkage: Fourbar) -> DoublePoints:
    """Find the real double points of the coupler curve and the configurations that pass them.

    Raises
    ------
    DimensionError
        For a coupler point at A or B, whose curve is a circle.
    """
    _require_sextic(linkage)
    unit, a, _, c, z, rest, ground = _scale_dimensions(linkage)
    near, far, d2 = np.abs(z), np.abs(rest), _square_magnitude(ground)
    u, v = z / near, rest / far
    cosine = (u * v.conj()).real
    one, other = near * near - a * a, far * far - c * c
    form = np.stack(
        [
            far * one,
            -2.0 * cosine * far * one - near * d2 - near * other,
            far * d2 + far * one + 2.0 * cosine * near * other,
            -near * other,
        ],
        axis=-1,
    )
    first, second, real = _find_form_roots(form)
    unit, a, c, near, far = (x[..., None] for x in (unit, a, c, near, far))
    z, rest, u, v, ground = (x[..., None] for x in (z, rest, u, v, ground))
    with np.errstate(divide="ignore", invalid="ignore"):
        delta = first * u.conj() - second * v.conj()
        q2, q4 = -second * v.conj() * ground / delta, -first * u.conj() * ground / delta
        k1, k2 = 0.5 * (_square_magnitude(q2) + near**2 - a * a), 0.5 * (_square_magnitude(q4) + far**2 - c * c)
        both = (k1 * second * near + k2 * first * far) / ((second * near) ** 2 + (first * far) ** 2)
        turn = -u * v * ground.conj() / delta.conj()
        # A positive gap gives two coupler directions: a crunode.
        gap = 1.0 - both**2 / _square_magnitude(turn)
        kind = np.where(np.abs(gap) <= CUSP_TOLERANCE, CUSP, np.where(gap > 0.0, CRUNODE, ACNODE))
        spread = np.sqrt(np.where(kind == CRUNODE, gap, 0.0)) * np.abs(turn)
        e = (both[..., None] + 1j * spread[..., None] * np.array([1.0, -1.0])) / turn[..., None]
        # Remove rounding from the unit vectors.
        e = e / np.abs(e)
    reached = (real & (kind != ACNODE))[..., None]
    arm, output = q2[..., None] - z[..., None] * e, q4[..., None] - rest[..., None] * e
    side = e.real * output.imag - e.imag * output.real
    return DoublePoints(
        real,
        np.where(real, linkage.input_pivot[..., None] + q2 * unit, np.nan),
        np.where(real, kind, ACNODE),
        np.where(reached, np.angle(arm), np.nan),
        np.where(reached & (side < 0.0), CROSSED_ASSEMBLY, OPEN_ASSEMBLY),
    )


class _Scaled(NamedTuple):
    """Dimensions in units of ``unit``: link lengths, z, z − b and O4 − O2."""

    unit: Real
    a: Real
    b: Real
    c: Real
    z: Complex
    rest: Complex
    ground: Complex


def _scale_dimensions(linkage: Fourbar) -> _Scaled:
    unit, z, b = curve_unit(linkage), linkage.coupler_point, linkage.coupler
    ground = linkage.output_pivot - linkage.input_pivot
    return _Scaled(unit, linkage.input / unit, b / unit, linkage.output / unit, z / unit, (z - b) / unit, ground / unit)


def _require_sextic(linkage: Fourbar) -> None:
    z, b = linkage.coupler_point, linkage.coupler
    apart = np.minimum(np.abs(z), np.abs(z - b)) > PIVOT_TOLERANCE * b
    require("coupler_point", "kinematics-away-from-moving-pivots", z, apart)


def _find_form_roots(form: Real) -> tuple[Real, Real, Mask]:
    """Find the zeros (σ0, σ1) of the binary cubics Σ form[k] σ0^(3−k) σ1^k on the unit circle, real ones first.

    The form is rotated so that its largest value over six directions becomes the leading coefficient; then no root is
    large.
    """
    angle = np.arange(6) * (np.pi / 6.0)
    directions = np.stack([np.cos(angle), np.sin(angle)])
    # A cubic form cannot be small in all six directions.
    best = angle[np.abs(_evaluate_form(form[..., None, :], *directions)).argmax(axis=-1)]
    x, y = np.cos(best), np.sin(best)
    along = _differentiate_form(form, x, y)
    across = _differentiate_form(form, -y, x)
    turned = np.stack(
        [
            _evaluate_form(form, -y, x),
            x * across[0] + y * across[1],
            x * along[1] - y * along[0],
            _evaluate_form(form, x, y),
        ],
        axis=-1,
    )
    roots = _find_roots(turned)
    real = np.abs(roots.imag) <= REAL_ROOT_TOLERANCE * (1.0 + np.abs(roots))
    order = np.argsort(np.where(real, roots.real, np.inf), axis=-1)
    real, t = np.take_along_axis(real, order, axis=-1), np.take_along_axis(roots.real, order, axis=-1)
    long, x, y = np.hypot(1.0, t), x[..., None], y[..., None]
    return (t * x - y) / long, (t * y + x) / long, real


def _evaluate_form(form: Real, x: Real, y: Real) -> Real:
    return np.asarray(((form[..., 0] * x + form[..., 1] * y) * x + form[..., 2] * y * y) * x + form[..., 3] * y * y * y)


def _differentiate_form(form: Real, x: Real, y: Real) -> tuple[Real, Real]:
    """Compute the partial derivatives of the form."""
    by_x = (3.0 * form[..., 0] * x + 2.0 * form[..., 1] * y) * x + form[..., 2] * y * y
    by_y = (form[..., 1] * x + 2.0 * form[..., 2] * y) * x + 3.0 * form[..., 3] * y * y
    return by_x, by_y


def _find_roots(polynomial: Real) -> Complex:
    """Find roots of polynomials, lowest power first on the last axis, as eigenvalues of companion matrices."""
    degree = polynomial.shape[-1] - 1
    companion = np.zeros((*polynomial.shape[:-1], degree, degree))
    companion[..., 1:, :-1] = np.eye(degree - 1)
    companion[..., -1] = -polynomial[..., :-1] / polynomial[..., -1:]
    return np.asarray(np.linalg.eigvals(companion), np.complex128)


def _multiply_polynomials(first: Complex, second: Complex) -> Complex:
    """Multiply polynomials in two variables, powers on the last two axes."""
    (j, k), (m, n) = first.shape[-2:], second.shape[-2:]
    batch = np.broadcast_shapes(first.shape[:-2], second.shape[:-2])
    product = np.zeros((*batch, j + m - 1, k + n - 1), np.complex128)
    for row in range(j):
        for column in range(k):
            product[..., row : row + m, column : column + n] += first[..., row : row + 1, column : column + 1] * second
    return product


def _conjugate_polynomial(grid: Complex) -> Complex:
    """Return the conjugate polynomial: powers of ξ and ξ̄ exchanged."""
    return np.asarray(np.swapaxes(grid, -1, -2).conj())


def _square_magnitude(x: Complex | Real) -> Real:
    """Return |x|²."""
    return np.asarray(x.real**2 + x.imag**2, np.float64)
