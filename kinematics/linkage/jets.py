"""Jets: a quantity with its first time derivatives, and the arithmetic of moving points and turning links.

A jet is an array whose first axis holds value, velocity, acceleration and jerk, or the first few of them; the other
axes are designs and input angles. Products follow Leibniz' rule, turns follow

    d/dt e^{iφ} = iφ' e^{iφ},  d²/dt² e^{iφ} = (iφ'' − φ'²) e^{iφ},  d³/dt³ e^{iφ} = (iφ''' − 3φ'φ'' − iφ'³) e^{iφ}.
"""

from __future__ import annotations

from math import comb
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Jet = NDArray[np.complex128]
"""Complex jet, shape (n, ...) with n from 1 to 4."""

RealJet = NDArray[np.float64]
"""Real jet, shape (n, ...) with n from 1 to 4."""

SINGULAR = 1e-7
"""Sine below which derivatives are undefined: a limit itself is known to the square root of rounding only."""


def product(a: Jet, b: Jet) -> Jet:
    """Product of two jets of one length."""
    rows = [sum(comb(n, k) * a[k] * b[n - k] for k in range(n + 1)) for n in range(len(a))]
    return np.stack(rows)


def turn(angle: RealJet) -> Jet:
    """e^{iφ} of a real jet φ."""
    u = np.exp(1j * angle[0])
    rows = [u]
    if len(angle) > 1:
        w = angle[1]
        rows.append(1j * w * u)
    if len(angle) > 2:
        alpha = angle[2]
        rows.append((1j * alpha - w * w) * u)
    if len(angle) > 3:
        rows.append((1j * (angle[3] - w**3) - 3.0 * w * alpha) * u)
    return np.stack(rows)


def angle_of(direction: Jet) -> RealJet:
    """Jet of the angle of a jet that does not vanish; its length may change."""
    with np.errstate(divide="ignore", invalid="ignore"):
        unit = direction / direction[0]
    rows = [np.angle(direction[0])]
    if len(unit) > 1:
        rows.append(unit[1].imag)
    if len(unit) > 2:
        rows.append((unit[2] - unit[1] * unit[1]).imag)
    if len(unit) > 3:
        rows.append((unit[3] - 3.0 * unit[1] * unit[2] + 2.0 * unit[1] ** 3).imag)
    return np.stack(rows)


class Angle(NamedTuple):
    """Solution of a closure: the angle's jet, and what tells how near its limit it is.

    ``rotation`` is NaN where the closure does not exist, its derivatives also at the limit. ``sine`` is
    Im(e^{−iφ} k) / |k|, the sine of the angle that vanishes at a limit; NaN where there is none. ``margin`` is the jet
    of |k|² − r², value and rate (where the input has one), as shares of |k|²: negative where the closure does not
    exist, NaN where k or r is NaN.
    """

    rotation: RealJet
    sine: NDArray[np.float64]
    margin: RealJet


def solve_angle(k: Jet, r: RealJet, sign: NDArray[np.int64], folded: float) -> Angle:
    """Angle φ with Re(e^{−iφ} k) = r: the equation that every closure comes down to.

    With κ the angle of k, φ = κ − sign · arccos(r / |k|), and the derivatives follow from differentiating the equation,
    whose coefficient of the highest derivative of φ is Im(e^{−iφ} k) = sign · √(|k|² − r²).

    Parameters
    ----------
    k, r : jets
        Complex and real, of one shape (n, ...).
    sign : int
        +1 or −1, broadcasting with the shape: the assembly.
    folded : float
        |k|² − r² down to −folded · |k|² counts as zero: a closure folded flat, to rounding.
    """
    length = np.abs(k[0])
    with np.errstate(divide="ignore", invalid="ignore"):
        excess = (length - r[0]) * (length + r[0])
        square = length * length
        margin = [excess / square]
        if len(k) > 1:
            margin.append(2.0 * ((np.conj(k[0]) * k[1]).real - r[0] * r[1]) / square)
        exists = (excess >= -folded * square) & (length > 0.0)
        root = np.sqrt(np.where(exists, np.maximum(excess, 0.0), np.nan))
        rows = [np.angle(k[0]) - sign * np.arctan2(root, r[0])]
        determinant = sign * root
        if len(k) > 1:
            e = np.exp(-1j * rows[0])
            scale = np.where(root > SINGULAR * length, 1.0 / determinant, np.nan)
            w = (r[1] - (e * k[1]).real) * scale
            rows.append(w)
        if len(k) > 2:
            alpha = (r[2] - (e * (k[2] - 2j * w * k[1] - w * w * k[0])).real) * scale
            rows.append(alpha)
        if len(k) > 3:
            third = k[3] - 3j * w * k[2] - 3.0 * (1j * alpha + w * w) * k[1] + (1j * w**3 - 3.0 * w * alpha) * k[0]
            rows.append((r[3] - (e * third).real) * scale)
        sine = determinant / length
    return Angle(np.stack(rows), sine, np.stack(margin))
