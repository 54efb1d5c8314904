"""Problems with a known answer: positions that a random sound fourbar takes, and its dyads to state choices from.

Everything is built with plain complex arithmetic, so that a fault of the analysis core cannot hide in it.
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass
from typing import Any

import numpy as np


@dataclass(frozen=True)
class PlantedDyad:
    """One side of the planted linkage, in the problem's coordinates and degrees."""

    fixed_pivot: complex
    moving_pivot: complex
    rotations: tuple[float, ...]
    coupler_vector: complex

    def choices(self, *names: str) -> dict[str, Any]:
        """The statement of some of its numbers: fixed, moving, theta, z, phi, b2, b3."""
        stated: dict[str, Any] = {}
        rotations: list[float | None] = [None] * len(self.rotations)
        for name in names:
            match name:
                case "fixed":
                    stated["fixed_pivot"] = [self.fixed_pivot.real, self.fixed_pivot.imag]
                case "moving":
                    stated["moving_pivot"] = [self.moving_pivot.real, self.moving_pivot.imag]
                case "theta":
                    stated["link_angle"] = math.degrees(cmath.phase(self.moving_pivot - self.fixed_pivot))
                case "z":
                    stated.setdefault("coupler_vector", {})["length"] = abs(self.coupler_vector)
                case "phi":
                    stated.setdefault("coupler_vector", {})["angle"] = math.degrees(cmath.phase(self.coupler_vector))
                case _:
                    k = int(name[1]) - 2
                    rotations[k] = self.rotations[k]
        if any(rotation is not None for rotation in rotations):
            stated["rotations"] = rotations
        return stated


@dataclass(frozen=True)
class Planted:
    """Positions and the two dyads that take them."""

    positions: list[dict[str, float]]
    input_side: PlantedDyad
    output_side: PlantedDyad


def plant(rng: np.random.Generator, n: int, scale: float = 1.0, offset: complex = 0.0) -> Planted:
    """A random fourbar moved by small steps through n positions, on one branch, never near a toggle."""
    while True:
        o2, o4 = (complex(*rng.uniform(-3.0, 3.0, 2)) for _ in range(2))
        crank = cmath.rect(rng.uniform(0.5, 4.0), rng.uniform(-math.pi, math.pi))
        output = cmath.rect(rng.uniform(0.5, 4.0), rng.uniform(-math.pi, math.pi))
        a, b = o2 + crank, o4 + output
        p = a + complex(*rng.uniform(-2.0, 2.0, 2))
        turn = rng.choice([-1.0, 1.0]) * rng.uniform(0.4, 1.2)
        path = _followed(o2, a, b, o4, np.linspace(0.0, turn, 400))
        if path is None:
            continue
        picks = [0, *np.sort(rng.choice(np.arange(60, 400), n - 1, replace=False))]
        if min(np.diff(picks)) < 30:
            continue
        pins_a, pins_b = path
        couplers = (pins_b - pins_a)[picks] / (b - a)
        points = pins_a[picks] + couplers * (p - a)

        def scaled(z: complex) -> complex:
            return z * scale + offset

        positions = [
            {"x": scaled(z).real, "y": scaled(z).imag, "angle": math.degrees(cmath.phase(turned))}
            for z, turned in zip(points, couplers, strict=True)
        ]

        def dyad(pivot: complex, pins: np.ndarray, picks: list[int] = picks, p: complex = p) -> PlantedDyad:
            links = pins[picks] - pivot
            rotations = tuple(math.degrees(cmath.phase(link / links[0])) for link in links[1:])
            return PlantedDyad(scaled(pivot), scaled(pins[0]), rotations, (p - pins[0]) * scale)

        return Planted(positions, dyad(o2, pins_a), dyad(o4, pins_b))


def plant_many(rng: np.random.Generator, n: int) -> Planted:
    """As :func:`plant`, with n positions at equal steps of the input, however many."""
    while True:
        o2, o4 = (complex(*rng.uniform(-3.0, 3.0, 2)) for _ in range(2))
        a = o2 + cmath.rect(rng.uniform(0.5, 4.0), rng.uniform(-math.pi, math.pi))
        b = o4 + cmath.rect(rng.uniform(0.5, 4.0), rng.uniform(-math.pi, math.pi))
        p = a + complex(*rng.uniform(-2.0, 2.0, 2))
        turn = rng.choice([-1.0, 1.0]) * rng.uniform(0.6, 1.4)
        path = _followed(o2, a, b, o4, np.linspace(0.0, turn, max(n, 60)))
        if path is None:
            continue
        picks = np.linspace(0, len(path[0]) - 1, n).astype(int)
        pins_a, pins_b = path[0][picks], path[1][picks]
        couplers = (pins_b - pins_a) / (b - a)
        points = pins_a + couplers * (p - a)
        positions = [
            {"x": z.real, "y": z.imag, "angle": math.degrees(cmath.phase(turned))}
            for z, turned in zip(points, couplers, strict=True)
        ]

        def dyad(pivot: complex, pins: np.ndarray, p: complex = p) -> PlantedDyad:
            links = pins - pivot
            rotations = tuple(math.degrees(cmath.phase(link / links[0])) for link in links[1:])
            return PlantedDyad(pivot, complex(pins[0]), rotations, p - complex(pins[0]))

        return Planted(positions, dyad(o2, pins_a), dyad(o4, pins_b))


def _followed(
    o2: complex, a: complex, b: complex, o4: complex, turns: np.ndarray
) -> tuple[np.ndarray, np.ndarray] | None:
    """Pins A and B over the input's rotations by Newton from step to step; None where it comes near a toggle."""
    coupler, output = abs(b - a), abs(b - o4)
    lengths = abs(a - o2), coupler, output, abs(o4 - o2)
    if min(lengths) < 0.3 or max(lengths) > 8.0 * min(lengths):
        return None
    pins_a = o2 + (a - o2) * np.exp(1j * turns)
    pins_b = np.empty_like(pins_a)
    for k, pin in enumerate(pins_a):
        for _ in range(8):
            u, v = b - pin, b - o4
            determinant = (u.conjugate() * v).imag
            if abs(determinant) < 0.2 * coupler * output:
                return None
            gap_u, gap_v = (coupler**2 - abs(u) ** 2) / 2.0, (output**2 - abs(v) ** 2) / 2.0
            step = (gap_v * u - gap_u * v) / determinant
            b = b + 1j * step
            if abs(step) < 1e-10:  # quadratic convergence: the next would be below rounding
                break
        pins_b[k] = b
    return pins_a, pins_b


def inverted_images(task: Any, points: Any) -> Any:
    """Fixed points as the body of a motion task sees them, moved back to the first position: shape (..., n)."""
    return task.points[0] + task.turns.conj() * (np.asarray(points)[..., None] - task.points)
