"""Pairs and functions of random linkages, with every constraint 5 % looser than the planted linkage has it.

Two to six pairs, with dials that stand anywhere, and twelve pairs with noise, which are fitted. Answered where a design
passes all checks and, where it is fitted, has no greater error than the planted linkage.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from kinematics.linkage.fourbar import (
    CROSSED_ASSEMBLY,
    OPEN_ASSEMBLY,
    Fourbar,
    barker_class,
    can_assemble,
    find_transmission_extremes,
    positions,
    stays_on_branch,
)
from tests.support.demands.planted import SIZE, looser
from tests.support.demands.task import Task

PAIRS = (2, 3, 4, 5, 6, 12)
"""Pairs, one number after the other; the last are fitted."""

LENGTHS = 1.0
"""Links are e to the power of −this to this times the ground."""

TURNED = (50.0, 120.0)
"""Degrees through which the input turns."""

TRANSMISSION = 20.0
"""Least transmission angle of the planted linkages over their ranges, degrees."""

CLOSEST = 0.3
"""Inputs keep this share of even distances from one another."""

MOVED = 15.0
"""Degrees through which an output goes at least."""

FITTED = 12
"""Pairs from which on they are fitted."""

NOISE = 0.2
"""Standard deviation of the outputs of fitted pairs, degrees."""

CLASSES = {"rocker_rocker": "non_grashof", "rocker_crank": "any"}
"""Grashof's classes whose names as demands are others, or that cannot be demanded."""


class _Planted:
    """A linkage over a range without a toggle, and the pairs that it meets."""

    def __init__(self, rng: np.random.Generator, count: int) -> None:
        while True:
            a, b, c = np.exp(rng.uniform(-LENGTHS, LENGTHS, 3))
            size = SIZE * rng.uniform(0.2, 1.0)
            self.o2 = SIZE * complex(*rng.normal(size=2))
            self.o4 = self.o2 + size * np.exp(1j * rng.uniform(0.0, math.tau))
            self.linkage = Fourbar(self.o2, complex(self.o4), size * a, size * b, size * c)
            side = OPEN_ASSEMBLY if rng.random() < 0.5 else CROSSED_ASSEMBLY
            first, turned = rng.uniform(0.0, math.tau), math.radians(rng.uniform(*TURNED))
            gaps = np.concatenate([[0.0], CLOSEST + rng.exponential(size=count - 1)])
            inputs = first + turned * np.cumsum(gaps) / gaps.sum()
            if not can_assemble(self.linkage) or not stays_on_branch(self.linkage, first, first + turned):
                continue
            at = positions(self.linkage, inputs, side)
            self.least = math.degrees(float(find_transmission_extremes(self.linkage, first, first + turned)[0]))
            self.inputs, self.outputs = np.degrees(inputs), np.degrees(np.unwrap(at.output_angle))
            if np.all(at.valid) and self.least >= TRANSMISSION and np.ptp(self.outputs) >= MOVED:
                break
        self.a, self.b = complex(at.a[0]), complex(at.b[0])
        self.lengths = [size, size * a, size * b, size * c]
        self.grashof = barker_class(self.linkage).motion

    def demands(self) -> dict[str, Any]:
        """Its constraints, all looser than it has them."""
        fixed, moving = [self.o2, complex(self.o4)], [self.a, self.b]
        grashof = CLASSES.get(self.grashof, self.grashof)
        return looser(self.lengths, fixed, moving, transmission=self.least, grashof=grashof)


def tasks(count: int, seed: int) -> Iterator[Task]:
    """The statements."""
    rng = np.random.default_rng(seed)
    for n in range(count):
        number = PAIRS[n % len(PAIRS)]
        planted = _Planted(rng, number)
        dials = rng.uniform(-180.0, 180.0, 2)
        pairs = [
            {"input": float(x), "output": float(y)}
            for x, y in zip(planted.inputs + dials[0], planted.outputs + dials[1], strict=True)
        ]
        noise = NOISE * rng.normal(size=number) if number >= FITTED else np.zeros(number)
        for pair, off in zip(pairs, noise, strict=True):
            pair["output"] += float(off)
        most = float(np.abs(noise).max()) if number >= FITTED else math.inf
        statement = {"kind": "function", "pairs": pairs, "constraints": planted.demands()}

        def answered(result: Any, most: float = most) -> bool:
            return any(
                design.verification.passed and design.metrics.max_structural_error <= most for design in result.designs
            )

        yield Task(statement, answered, f"{n}: {number} pairs")
