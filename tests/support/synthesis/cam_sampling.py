"""Random motion programs, and the smallest radius by brute force: dense angles, radii tried one by one."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise

import numpy as np

from kinematics.cam.motion.laws import LAWS
from kinematics.cam.motion.pieces import Motion
from kinematics.cam.motion.program import TURN, Program
from kinematics.cam.motion.segments import build_dwell, build_law_segment

SMOOTH = ("cycloidal", "modified_trapezoid", "modified_sine", "polynomial_345", "polynomial_4567", "trapezoidal")


TRIES = 400
"""Radii of the grid."""


def random_program(rng: np.random.Generator, lift: float) -> Program:
    """One or two rises with their falls and dwells, of smooth laws."""
    moves = int(rng.integers(1, 3))
    shares = rng.uniform(0.3, 1.0, 4 * moves)
    angles = shares / shares.sum() * TURN
    segments = []
    for k in range(moves):
        h = lift * rng.uniform(0.4, 1.0)
        up, down = rng.choice(SMOOTH, 2)
        segments += [
            build_law_segment(LAWS[str(up)], float(angles[4 * k]), 0.0, h),
            build_dwell(float(angles[4 * k + 1]), h),
            build_law_segment(LAWS[str(down)], float(angles[4 * k + 2]), h, 0.0),
            build_dwell(float(angles[4 * k + 3]), 0.0),
        ]
    return Program(segments)


def dense_motion(program: Program, points: int = 8001) -> Motion:
    """Both sides of every break, and many angles between."""
    breaks = program.breaks
    at = np.concatenate([np.linspace(a, b, points)[1:-1] for a, b in pairwise(breaks)])
    parts = program.motion(at), program.motion(breaks[:-1]), program.motion(breaks[1:], before=True)
    return Motion(*(np.concatenate(values) for values in zip(*parts, strict=True)))


def first_sound(
    program: Program,
    sound: Callable[[float, Motion], bool],
    start: float,
    stop: float,
    also: float | None = None,
) -> float | None:
    """The smallest sound radius: tried on a grid with many angles, then bisected with very many.

    A radius that is claimed to be sound is tried ``also``: what is sound may be less wide than the grid's step.
    """
    coarse, fine = dense_motion(program, 301), dense_motion(program)
    grid = np.linspace(start, stop, TRIES)
    step = float(grid[1] - grid[0])
    if also is not None:
        grid = np.sort(np.append(grid, also))
    for radius in map(float, grid):
        if not sound(radius, coarse):
            continue
        bad, good = max(radius - step, start), radius
        if sound(bad, fine):
            return bad
        while not sound(good, fine):
            good += 1e-3 * step
        for _ in range(40):
            middle = 0.5 * (bad + good)
            bad, good = (bad, middle) if sound(middle, fine) else (middle, good)
        return good
    return None


def pressure_and_curvature(z1: np.ndarray, z2: np.ndarray, along: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Pressure angle, without sign, against the follower's motion, and curvature; of the pitch curve."""
    normal = -1j * z1 / np.abs(z1)
    angle = np.abs(np.angle(normal * np.conj(along)))
    return np.minimum(angle, math.pi - angle), (np.conj(z1) * z2).imag / np.abs(z1) ** 3


def translating(m: Motion, prime: float, offset: float) -> tuple[np.ndarray, np.ndarray]:
    """Of a translating roller follower, in the frame of the ground."""
    p = math.sqrt(prime**2 - offset**2) + m.s + 1j * offset
    return pressure_and_curvature(m.v + 1j * p, m.a + 2j * m.v - p, np.ones_like(p))


def oscillating(m: Motion, prime: float, arm: float, pivot: float, sense: int) -> tuple[np.ndarray, np.ndarray]:
    """Of an oscillating roller follower, in the frame of the ground."""
    psi = math.acos((pivot**2 + arm**2 - prime**2) / (2.0 * pivot * arm)) + m.s
    swung = -arm * np.exp(-1j * sense * psi)
    p1 = -1j * sense * m.v * swung
    p2 = (-1j * sense * m.a - m.v**2) * swung
    p = pivot + swung
    return pressure_and_curvature(p1 + 1j * p, p2 + 2j * p1 - p, -1j * sense * swung / arm)
