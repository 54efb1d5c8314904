"""Refinement of a profile: points are added if a sound cam fails its verification because it has too few points."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol, TypeVar

import numpy as np

from kinematics.arrays import Real
from synthesis.model.answer import Verification
from synthesis.model.kind import Progress

MAX_POINTS = 14_000
"""Maximum number of points of a curve. If a motion changes its acceleration within less than a step, points are placed
closer until the profile reproduces it; beyond this number the design fails its verification."""

MAX_REFINEMENTS = 8
"""Maximum number of refinements."""


class ReproductionMeasure(Protocol):
    """Measurements on a profile; ``off`` is the deviation of the follower's motion from the program."""

    @property
    def off(self) -> Real:
        """Deviation by angle of the profile; NaN if the follower cannot be laid on."""


Mechanism = TypeVar("Mechanism")
Measured = TypeVar("Measured", bound=ReproductionMeasure)


def resolve_profile(
    angle: Real,
    make: Callable[[Real], Mechanism],
    verify: Callable[[Mechanism], tuple[Verification, Measured | None]],
    closer: Callable[[Real, Measured, set[str]], Real | None],
    progress: Progress,
) -> tuple[Mechanism, Verification, Measured | None]:
    """Return the verified mechanism with points at ``angle`` or, if necessary, at a refinement of it.

    Parameters
    ----------
    angle : float, shape (n,)
        Initial cam angles of the points, radians.
    make, verify : callable
        The mechanism with such points, and its checks with the measurements; None if nothing can be measured.
    closer : callable
        A refinement of the angles, from those used, the measurements and the checks that failed; None if more points
        do not help.
    """
    mechanism = make(angle)
    verification, measured = verify(mechanism)
    for _ in range(MAX_REFINEMENTS):
        # Without contact everywhere there is nothing that closer points could improve.
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
