"""The front of an answer: the designs that no other beats in all that they are weighed up by (Pareto)."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Literal

import numpy as np

from synthesis.model.linkage_answer import Front
from synthesis.outcome.ranking import ROUNDING

Quantity = Literal["rms", "min_transmission_angle", "size"]

LEAST: Mapping[Quantity, Callable[[Any], float]] = {
    "rms": lambda design: max(float(design.metrics.rms_residual), ROUNDING),
    "min_transmission_angle": lambda design: -float(design.metrics.min_transmission_angle),
    "size": lambda design: float(design.metrics.size),
}
"""What is less, the better a design is: by name the quantities that every linkage is measured in."""


def front_of(designs: Sequence[Any], own: Mapping[Quantity, Callable[[Any], float]] | None = None) -> Front | None:
    """The designs of an answer that no other beats; those that break a check are not looked at.

    Parameters
    ----------
    designs : sequence
        As they are returned.
    own : mapping, optional
        Quantities as a kind measures them, in place of those in :data:`LEAST`.

    Returns
    -------
    Front or None
        None where there are fewer than two sound designs: nothing is traded.
    """
    sound = [n for n, design in enumerate(designs) if design.verification.passed]
    if len(sound) < 2:
        return None
    quantities = {**LEAST, **(own or {})}
    table = np.array([[of(designs[n]) for of in quantities.values()] for n in sound])
    no_worse = (table[:, None] <= table).all(axis=2)
    better = (table[:, None] < table).any(axis=2)
    beaten = np.flatnonzero((no_worse & better).any(axis=0))
    return Front(quantities=list(quantities), designs=list(np.delete(sound, beaten).tolist()))
