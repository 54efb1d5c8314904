"""Code that several tests share: closed shapes."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex

COUNT, FINE = 96, 4096
"""Points of a curve, and places along it from which they are laid out."""


def _turn(count: int = FINE) -> NDArray[np.float64]:
    return np.linspace(0.0, 2.0 * np.pi, count, endpoint=False)


def _polygon(*corners: complex) -> Complex:
    return np.array(corners, np.complex128)


def _rounded(corners: Complex, radius: float) -> Complex:
    """A polygon with its corners replaced by arcs of a radius."""
    out: list[complex] = []
    for k, corner in enumerate(corners):
        one, other = corners[k - 1] - corner, corners[(k + 1) % len(corners)] - corner
        one, other = one / abs(one), other / abs(other)
        half = 0.5 * abs(np.angle(other / one))
        middle = corner + (one + other) / abs(one + other) * radius / np.sin(half)
        first, last = corner + one * radius / np.tan(half) - middle, corner + other * radius / np.tan(half) - middle
        swing = np.angle(last / first)
        out += list(middle + first * np.exp(1j * swing * np.linspace(0.0, 1.0, 40)))
    return np.array(out)


def _egg() -> Complex:
    t = _turn()
    return np.cos(t) * (1.0 + 0.25 * np.sin(t)) * 0.75 + 1j * np.sin(t)


def _limacon() -> Complex:
    t = _turn()
    return (0.7 + np.cos(t)) * np.exp(1j * t)


def _teardrop() -> Complex:
    t = _turn()
    return np.cos(t) + 0.8j * np.sin(t) * np.sin(0.5 * t) ** 1.5


def _foot() -> Complex:
    """A flat step and a high way back, as a leg makes them."""
    return _rounded(_polygon(0.0, 10.0, 9.0 + 2.0j, 6.0 + 4.2j, 2.0 + 3.2j), 0.7)


def _bean() -> Complex:
    t = _turn()
    return np.cos(t) + 1j * (0.6 * np.sin(t) + 0.35 * np.cos(t) ** 2)


def _heart() -> Complex:
    t = _turn()
    y = 13.0 * np.cos(t) - 5.0 * np.cos(2 * t) - 2.0 * np.cos(3 * t) - np.cos(4 * t)
    return 16.0 * np.sin(t) ** 3 + 1j * y


def _crescent() -> Complex:
    outer = np.exp(1j * np.linspace(0.25 * np.pi, 1.75 * np.pi, FINE))
    middle, radius = 0.6, abs(np.exp(0.25j * np.pi) - 0.6)
    lean = np.angle(np.exp(0.25j * np.pi) - middle)
    inner = middle + radius * np.exp(1j * np.linspace(-lean, lean - 2.0 * np.pi, FINE))
    return np.concatenate([outer, inner])


def _star() -> Complex:
    return (np.where(np.arange(10) % 2, 0.5, 1.0) * np.exp(1j * (0.2 * np.pi * np.arange(10) + 0.5 * np.pi))).astype(
        np.complex128
    )


def _s() -> Complex:
    """An S with a width: a bent middle line with round ends."""
    t = np.linspace(-1.0, 1.0, FINE)
    line = 0.8 * np.sin(np.pi * t) + 1.6j * t
    across = 1j * np.gradient(line)
    across = 0.3 * across / np.abs(across)
    ends = [
        end + start * np.exp(-1j * np.pi * np.linspace(0.0, 1.0, 400))
        for end, start in ((line[-1], across[-1]), (line[0], -across[0]))
    ]
    return np.concatenate([line + across, ends[0], (line - across)[::-1], ends[1]])


_SQUARE = (0.0, 1.0, 1.0 + 1.0j, 1.0j)

SHAPES: dict[str, Callable[[], Complex]] = {
    "circle": lambda: np.exp(1j * _turn()),
    "ellipse 3:1": lambda: 3.0 * np.cos(_turn()) + 1j * np.sin(_turn()),
    "egg": _egg,
    "D": lambda: np.exp(1j * np.linspace(-0.5 * np.pi, 0.5 * np.pi, FINE)),
    "limaçon": _limacon,
    "teardrop": _teardrop,
    "stadium": lambda: _rounded(_polygon(0.0, 3.0, 3.0 + 1.0j, 1.0j), 0.4999),
    "foot": _foot,
    "bean": _bean,
    "triangle": lambda: np.exp(2j * np.pi * np.arange(3) / 3.0),
    "rounded square": lambda: _rounded(_polygon(*_SQUARE), 0.2),
    "eight": lambda: np.sin(_turn()) + 0.5j * np.sin(2.0 * _turn()),
    "heart": _heart,
    "trefoil": lambda: (1.0 + 0.5 * np.cos(3.0 * _turn())) * np.exp(1j * _turn()),
    "L": lambda: _polygon(0.0, 3.0, 3.0 + 1.0j, 1.0 + 1.0j, 1.0 + 4.0j, 4.0j),
    "square": lambda: _polygon(*_SQUARE),
    "crescent": _crescent,
    "star": _star,
    "S": _s,
    "cross": lambda: _polygon(1, 2, 2 + 1j, 3 + 1j, 3 + 2j, 2 + 2j, 2 + 3j, 1 + 3j, 1 + 2j, 2j, 1j, 1 + 1j),
}
"""Curves by their names, as closed polylines."""


def outline(name: str) -> Complex:
    """Points at equal distances along a curve, shape (96,), in a box with a diagonal of 100."""
    corners = SHAPES[name]()
    whole = np.append(corners, corners[0])
    along = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(whole)))])
    at = np.linspace(0.0, along[-1], COUNT, endpoint=False)
    points = np.interp(at, along, whole.real) + 1j * np.interp(at, along, whole.imag)
    return np.asarray(100.0 * points / np.hypot(np.ptp(points.real), np.ptp(points.imag)))
