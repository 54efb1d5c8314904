"""Refinement of a profile: points are added if a sound cam fails its verification because of too few points."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol, TypeVar

import numpy as np

from kinematics.arrays import Real
from kinematics.message import compose
from synthesis.model.answer import Verification
from synthesis.model.kind import Progress

MAX_POINTS = 14_000
"""Maximum number of points of a curve. If the acceleration changes within less than a step, the points are refined
until the profile reproduces the motion. Beyond this number the design fails its verification."""

MAX_REFINEMENTS = 8
"""Maximum number of refinements of a profile."""


class ReproductionMeasure(Protocol):
    """Measurements on a profile; ``off`` is the deviation of the follower's motion from the program."""

    @property
    def off(self) -> Real:
        """Deviation at each angle of the profile; NaN if the follower cannot be laid against it."""


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
        Build the mechanism with points at given angles; return its checks and the measurements, None if nothing can be
        measured.
    closer : callable
        Refine the angles, given those used, the measurements and the failed checks; returns None if more points do not
        help.
    """
    mechanism = make(angle)
    verification, measured = verify(mechanism)
    for _ in range(MAX_REFINEMENTS):
        # Closer points improve nothing if the follower does not touch the profile everywhere.
        if measured is None or not np.isfinite(measured.off).all():
            break
        finer = closer(angle, measured, {check.name for check in verification.checks if not check.passed})
        if finer is None or len(finer) > MAX_POINTS:
            break
        angle = finer
        progress(0.8, compose("cam-verifying-with-points", count=len(angle)))
        mechanism = make(angle)
        verification, measured = verify(mechanism)
    return mechanism, verification, measured
