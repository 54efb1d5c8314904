"""Refinement of a profile: points are added where a sound cam fails its verification because its points are too few."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol, TypeVar

import numpy as np
from numpy.typing import NDArray

from synthesis.model.answer import Verification
from synthesis.model.kind import Progress

Real = NDArray[np.float64]

MAX_POINTS = 14_000
"""Points of a curve at most. Where a motion changes its acceleration within less than a step, points are put closer
until the profile reproduces it; beyond this number the design fails its verification."""

MAX_REFINEMENTS = 8
"""Times that points are put closer at most."""


class Reproduced(Protocol):
    """What was measured on a profile; ``off`` is by how much the follower's motion misses the program."""

    @property
    def off(self) -> Real:
        """By angle of the profile; NaN where the follower cannot be laid on."""


Mechanism = TypeVar("Mechanism")
Measured = TypeVar("Measured", bound=Reproduced)


def resolved(
    angle: Real,
    make: Callable[[Real], Mechanism],
    verify: Callable[[Mechanism], tuple[Verification, Measured | None]],
    closer: Callable[[Real, Measured, set[str]], Real | None],
    progress: Progress,
) -> tuple[Mechanism, Verification, Measured | None]:
    """The mechanism whose points stand at ``angle`` or closer, verified.

    Parameters
    ----------
    angle : float, shape (n,)
        Where points stand at first, radians.
    make, verify : callable
        The mechanism with such points, and its checks with what was measured; None where nothing can be.
    closer : callable
        Angles that stand closer, from those used, what was measured with them and the checks that failed; None where
        more points do not help.
    """
    mechanism = make(angle)
    verification, measured = verify(mechanism)
    for _ in range(MAX_REFINEMENTS):
        if measured is None or not np.isfinite(measured.off).all():
            break
        finer = closer(angle, measured, {check.name for check in verification.checks if not check.passed})
        if finer is None or len(finer) > MAX_POINTS:
            break
        angle = finer
        progress(0.8, f"verifying with {len(angle)} points")
        mechanism = make(angle)
        verification, measured = verify(mechanism)
    return mechanism, verification, measured
