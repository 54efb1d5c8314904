"""Positions of all nodes of a linkage at an input, and their derivatives by input and unknowns.

The unknowns z are the coordinates (x₀, y₀, x₁, y₁, ...) of all nodes in the reference position, where the input is 0.
A dyad keeps the lengths of its two links and the side on which it stands there, a point its place on its link. With
b = X_j − X_i a node of either kind is

    X_k = X_i + p b + q Jb,        J the quarter turn,

with p and q constant for a point. For a dyad with links r₁ and r₂, p = (r₁² − r₂² + |b|²)/2|b|² and
q = ± √(r₁²/|b|² − p²): the circles about i and j meet there. Its derivatives follow from u·du = r₁ dr₁ and
v·dv = r₂ dr₂ with u = X_k − X_i and v = X_k − X_j, a system of two equations for dX_k.

The cosine of the angle between the links of a dyad is (r₁² + r₂² − |b|²)/2r₁r₂; its absolute value is that of the
transmission angle.
"""

from __future__ import annotations

import math

import numpy as np

from kinematics.arrays import Integers, Real
from kinematics.compiling import njit
from synthesis.fit.chart import OPTIONS
from synthesis.fit.linkage.topology import CRANK, DYAD, FIXED, POINT, VIEW

CONSTANT_COUNT = 4
"""Number of constants of a node."""

MIN_HEIGHT_SQUARE = 1e-12
"""Least square of a dyad's height over its base, in bases. A flatter dyad is at a toggle, where its derivatives are
infinite."""


@njit(**OPTIONS)
def compute_constants(nodes: Integers, z: Real, constants: Real) -> None:
    """Compute what a linkage keeps when it moves, from its reference position.

    Parameters
    ----------
    nodes : int, shape (n, 4)
        A topology's table.
    z : float, shape (2n or more,)
        Unknowns.
    constants : float, shape (n, 4)
        Output: the arm of a crank; p, q and b/|b|² of a point; r₁², r₂², the side, and 1/r₁r₂ of a dyad.
    """
    for k in range(len(nodes)):
        kind, i, j = nodes[k, 0], nodes[k, 1], nodes[k, 2]
        ux, uy = z[2 * k] - z[2 * i], z[2 * k + 1] - z[2 * i + 1]
        bx, by = z[2 * j] - z[2 * i], z[2 * j + 1] - z[2 * i + 1]
        if kind == CRANK:
            constants[k, 0], constants[k, 1] = ux, uy
        elif kind == POINT:
            per = 1.0 / (bx * bx + by * by)
            constants[k, 0], constants[k, 1] = (ux * bx + uy * by) * per, (uy * bx - ux * by) * per
            constants[k, 2], constants[k, 3] = bx * per, by * per
        elif kind == DYAD:
            vx, vy = z[2 * k] - z[2 * j], z[2 * k + 1] - z[2 * j + 1]
            constants[k, 0], constants[k, 1] = ux * ux + uy * uy, vx * vx + vy * vy
            constants[k, 2] = 1.0 if bx * uy - by * ux > 0.0 else -1.0
            constants[k, 3] = 1.0 / math.sqrt(constants[k, 0] * constants[k, 1])


@njit(**OPTIONS)
def _compute_view_turn(z: Real, places: Real, j: int, k: int) -> tuple[float, float]:
    """Return the rotation (cosine, sine) that turns the link through j and k back to its reference direction."""
    hx, hy = z[2 * k] - z[2 * j], z[2 * k + 1] - z[2 * j + 1]
    gx, gy = places[k, 0] - places[j, 0], places[k, 1] - places[j, 1]
    per = 1.0 / (gx * gx + gy * gy)
    return (hx * gx + hy * gy) * per, (hy * gx - hx * gy) * per


@njit(**OPTIONS)
def close_linkage(nodes: Integers, z: Real, constants: Real, theta: float, places: Real, cosines: Real) -> bool:
    """Move a linkage to an input; return whether it closes there.

    Parameters
    ----------
    nodes, z, constants
        See :func:`compute_constants`.
    theta : float
        Rotation of the input from the reference position, radians.
    places : float, shape (n, 2)
        Output: the nodes.
    cosines : float, shape (n,)
        Output: cosines of the angles between the links of dyads; other entries are not written.
    """
    cosine, sine = math.cos(theta), math.sin(theta)
    for k in range(len(nodes)):
        kind, i, j = nodes[k, 0], nodes[k, 1], nodes[k, 2]
        if kind == FIXED:
            places[k, 0], places[k, 1] = z[2 * k], z[2 * k + 1]
        elif kind == CRANK:
            places[k, 0] = places[i, 0] + cosine * constants[k, 0] - sine * constants[k, 1]
            places[k, 1] = places[i, 1] + sine * constants[k, 0] + cosine * constants[k, 1]
        elif kind == VIEW:
            wx, wy = _compute_view_turn(z, places, j, nodes[k, 3])
            gx, gy = places[i, 0] - places[j, 0], places[i, 1] - places[j, 1]
            places[k, 0], places[k, 1] = z[2 * j] + wx * gx - wy * gy, z[2 * j + 1] + wx * gy + wy * gx
        else:
            bx, by = places[j, 0] - places[i, 0], places[j, 1] - places[i, 1]
            if kind == POINT:
                p, q = constants[k, 0], constants[k, 1]
            else:
                square = bx * bx + by * by
                per = 1.0 / square
                first, second = constants[k, 0], constants[k, 1]
                p = 0.5 * (first - second + square) * per
                height = first * per - p * p
                cosines[k] = 0.5 * (first + second - square) * constants[k, 3]
                # Negated, so that NaN from coinciding pins counts as open, too.
                if not height > MIN_HEIGHT_SQUARE:
                    return False
                q = constants[k, 2] * math.sqrt(height)
            places[k, 0], places[k, 1] = places[i, 0] + p * bx - q * by, places[i, 1] + p * by + q * bx
    return True


@njit(**OPTIONS)
def trace_linkage(nodes: Integers, z: Real, thetas: Real, places: Real, cosines: Real) -> None:
    """Move a linkage through inputs (m,): nodes (m, n, 2) and cosines (m, n), NaN where it does not close."""
    constants = np.empty((len(nodes), CONSTANT_COUNT))
    compute_constants(nodes, z, constants)
    for k in range(len(thetas)):
        if not close_linkage(nodes, z, constants, thetas[k], places[k], cosines[k]):
            places[k], cosines[k] = np.nan, np.nan


@njit(**OPTIONS)
def differentiate_input(nodes: Integers, z: Real, constants: Real, places: Real, rates: Real) -> None:
    """Compute the derivatives of all nodes by the input, shape (n, 2), at the position of :func:`close_linkage`."""
    for k in range(len(nodes)):
        kind, i, j = nodes[k, 0], nodes[k, 1], nodes[k, 2]
        if kind == FIXED:
            rates[k, 0] = rates[k, 1] = 0.0
        elif kind == CRANK:
            rates[k, 0] = rates[i, 0] - (places[k, 1] - places[i, 1])
            rates[k, 1] = rates[i, 1] + (places[k, 0] - places[i, 0])
        elif kind == POINT:
            p, q = constants[k, 0], constants[k, 1]
            dx, dy = rates[j, 0] - rates[i, 0], rates[j, 1] - rates[i, 1]
            rates[k, 0], rates[k, 1] = rates[i, 0] + p * dx - q * dy, rates[i, 1] + p * dy + q * dx
        elif kind == DYAD:
            ux, uy = places[k, 0] - places[i, 0], places[k, 1] - places[i, 1]
            vx, vy = places[k, 0] - places[j, 0], places[k, 1] - places[j, 1]
            per = 1.0 / (ux * vy - uy * vx)
            f, g = ux * rates[i, 0] + uy * rates[i, 1], vx * rates[j, 0] + vy * rates[j, 1]
            rates[k, 0], rates[k, 1] = (vy * f - uy * g) * per, (ux * g - vx * f) * per
        else:
            other = nodes[k, 3]
            wx, wy = _compute_view_turn(z, places, j, other)
            px, py = places[i, 0] - places[j, 0], places[i, 1] - places[j, 1]
            gx, gy = places[other, 0] - places[j, 0], places[other, 1] - places[j, 1]
            ex, ey = rates[other, 0] - rates[j, 0], rates[other, 1] - rates[j, 1]
            # The viewing link rotates with its second pin about the first; subtract that rotation.
            spin = (gx * ey - gy * ex) / (gx * gx + gy * gy)
            dx, dy = rates[i, 0] - rates[j, 0] + spin * py, rates[i, 1] - rates[j, 1] - spin * px
            rates[k, 0], rates[k, 1] = wx * dx - wy * dy, wx * dy + wy * dx


@njit(**OPTIONS)
def differentiate_nodes(
    nodes: Integers, z: Real, constants: Real, theta: float, places: Real, slopes: Real
) -> None:  # fmt: skip
    """Compute the derivatives of all nodes by the input and by all unknowns.

    Parameters
    ----------
    nodes, z, constants, theta, places
        See :func:`close_linkage`, which must have closed the linkage there.
    slopes : float, shape (n, 2, 1 + 2n)
        Output: derivatives by the input in column 0, by the coordinates of node k in columns 1 + 2k and 2 + 2k. It must
        be 0 on the first call for a topology: entries that are always 0 are not written.
    """
    cosine, sine = math.cos(theta), math.sin(theta)
    for k in range(len(nodes)):
        kind, i, j = nodes[k, 0], nodes[k, 1], nodes[k, 2]
        own, first, second = 1 + 2 * k, 1 + 2 * i, 1 + 2 * j
        a, b = slopes[k, 0], slopes[k, 1]
        if kind == FIXED:
            a[own], b[own + 1] = 1.0, 1.0
        elif kind == CRANK:
            a[0], b[0] = -(places[k, 1] - places[i, 1]), places[k, 0] - places[i, 0]
            a[own], a[own + 1], b[own], b[own + 1] = cosine, -sine, sine, cosine
            a[first], a[first + 1], b[first], b[first + 1] = 1.0 - cosine, sine, -sine, 1.0 - cosine
        elif kind == POINT:
            _differentiate_point(i, j, k, constants, places, slopes)
        elif kind == DYAD:
            ux, uy = places[k, 0] - places[i, 0], places[k, 1] - places[i, 1]
            vx, vy = places[k, 0] - places[j, 0], places[k, 1] - places[j, 1]
            per = 1.0 / (ux * vy - uy * vx)
            m11, m12, m21, m22 = vy * per, -uy * per, -vx * per, ux * per
            for c in range(own):
                f = ux * slopes[i, 0, c] + uy * slopes[i, 1, c]
                g = vx * slopes[j, 0, c] + vy * slopes[j, 1, c]
                a[c], b[c] = m11 * f + m12 * g, m21 * f + m22 * g
            # Changes of the reference position change the lengths: r₁ dr₁ = U·(dz_k − dz_i), and likewise r₂.
            for axis in range(2):
                f, g = z[2 * k + axis] - z[2 * i + axis], z[2 * k + axis] - z[2 * j + axis]
                a[own + axis], b[own + axis] = m11 * f + m12 * g, m21 * f + m22 * g
                a[first + axis] -= m11 * f
                b[first + axis] -= m21 * f
                a[second + axis] -= m12 * g
                b[second + axis] -= m22 * g
        else:
            _differentiate_view(i, j, nodes[k, 3], k, z, places, slopes)


@njit(**OPTIONS)
def _differentiate_point(i: int, j: int, k: int, constants: Real, places: Real, slopes: Real) -> None:
    """Compute the derivatives of a point k of the link through i and j."""
    own, first, second = 1 + 2 * k, 1 + 2 * i, 1 + 2 * j
    a, b = slopes[k, 0], slopes[k, 1]
    p, q = constants[k, 0], constants[k, 1]
    for c in range(own):
        dx, dy = slopes[j, 0, c] - slopes[i, 0, c], slopes[j, 1, c] - slopes[i, 1, c]
        a[c] = slopes[i, 0, c] + p * dx - q * dy
        b[c] = slopes[i, 1, c] + p * dy + q * dx
    # p + iq = u/b in the reference position, so that a change of u there turns and stretches as the link has done.
    gx, gy = places[j, 0] - places[i, 0], places[j, 1] - places[i, 1]
    wx = gx * constants[k, 2] + gy * constants[k, 3]
    wy = gy * constants[k, 2] - gx * constants[k, 3]
    a[own], b[own], a[own + 1], b[own + 1] = wx, wy, -wy, wx
    ex, ey = (p - 1.0) * wx - q * wy, (p - 1.0) * wy + q * wx
    a[first] += ex
    b[first] += ey
    a[first + 1] -= ey
    b[first + 1] += ex
    ex, ey = -p * wx + q * wy, -p * wy - q * wx
    a[second] += ex
    b[second] += ey
    a[second + 1] -= ey
    b[second + 1] += ex


@njit(**OPTIONS)
def _differentiate_view(i: int, j: int, other: int, k: int, z: Real, places: Real, slopes: Real) -> None:
    """Compute the derivatives of a view k of node i from the link through j and ``other``."""
    own, second, third = 1 + 2 * k, 1 + 2 * j, 1 + 2 * other
    a, b = slopes[k, 0], slopes[k, 1]
    wx, wy = _compute_view_turn(z, places, j, other)
    px, py = places[i, 0] - places[j, 0], places[i, 1] - places[j, 1]
    gx, gy = places[other, 0] - places[j, 0], places[other, 1] - places[j, 1]
    per = 1.0 / (gx * gx + gy * gy)
    # The view is z_j + (H/g) p with H the link in the reference position and g the link where it is.
    rx, ry = (px * gx + py * gy) * per, (py * gx - px * gy) * per
    for c in range(own):
        dx, dy = slopes[i, 0, c] - slopes[j, 0, c], slopes[i, 1, c] - slopes[j, 1, c]
        ex, ey = slopes[other, 0, c] - slopes[j, 0, c], slopes[other, 1, c] - slopes[j, 1, c]
        dx -= rx * ex - ry * ey
        dy -= rx * ey + ry * ex
        a[c], b[c] = wx * dx - wy * dy, wx * dy + wy * dx
    a[third] += rx
    b[third] += ry
    a[third + 1] -= ry
    b[third + 1] += rx
    a[second] += 1.0 - rx
    b[second] -= ry
    a[second + 1] += ry
    b[second + 1] += 1.0 - rx


@njit(**OPTIONS)
def differentiate_cosine(
    nodes: Integers, z: Real, constants: Real, k: int, places: Real, slopes: Real, cosine: float, row: Real
) -> None:
    """Write the derivatives of a dyad's cosine into ``row``, shape (1 + 2n,), the first by the input."""
    i, j = nodes[k, 1], nodes[k, 2]
    per = constants[k, 3]
    bx, by = places[j, 0] - places[i, 0], places[j, 1] - places[i, 1]
    for c in range(len(row)):
        row[c] = -per * (
            bx * (slopes[j, 0, c] - slopes[i, 0, c]) + by * (slopes[j, 1, c] - slopes[i, 1, c])
        )  # fmt: skip
    for side in range(2):
        end = i if side == 0 else j
        factor = per - cosine / constants[k, side]
        for axis in range(2):
            change = factor * (z[2 * k + axis] - z[2 * end + axis])
            row[1 + 2 * k + axis] += change
            row[1 + 2 * end + axis] -= change


@njit(**OPTIONS)
def move_reference(nodes: Integers, z: Real, theta: float, moved: Real) -> bool:
    """Write the unknowns of the same linkage with its reference position at an input; return whether it closes.

    Views keep no coordinates of their own. In the new reference position the viewing link has another direction, so
    that all nodes are turned with it.
    """
    n = len(nodes)
    constants, places, cosines = np.empty((n, CONSTANT_COUNT)), np.empty((n, 2)), np.empty(n)
    compute_constants(nodes, z, constants)
    if not close_linkage(nodes, z, constants, theta, places, cosines):
        return False
    wx, wy, ox, oy, px, py = 1.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for k in range(n):
        if nodes[k, 0] == VIEW:
            j = nodes[k, 2]
            wx, wy = _compute_view_turn(z, places, j, nodes[k, 3])
            ox, oy, px, py = z[2 * j], z[2 * j + 1], places[j, 0], places[j, 1]
            break
    for k in range(n):
        gx, gy = places[k, 0] - px, places[k, 1] - py
        if nodes[k, 0] == VIEW:
            moved[2 * k], moved[2 * k + 1] = places[k, 0], places[k, 1]
        else:
            moved[2 * k], moved[2 * k + 1] = ox + wx * gx - wy * gy, oy + wx * gy + wy * gx
    return True
