"""Pareto front of an answer: the designs that no other dominates."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from synthesis.model.linkage.answer import ERROR_FIELDS, Front
from synthesis.model.protocols import DrivenDesign, LinkageMeasures
from synthesis.results.ranking import RESIDUAL_ROUNDING


def _find_error_field(metrics: LinkageMeasures) -> str | None:
    return next((field for field in ERROR_FIELDS if hasattr(metrics, field)), None)


def measure_error(design: DrivenDesign) -> float:
    """Return the error of a design by the measure of its kind; 0 if all designs of the kind are exact."""
    field = _find_error_field(design.metrics)
    return 0.0 if field is None else float(getattr(design.metrics, field))


def pareto_front(designs: Sequence[DrivenDesign]) -> Front | None:
    """Return the Pareto front of the designs of an answer, ignoring designs that fail a check.

    Parameters
    ----------
    designs : sequence
        Linkage designs in the order of the answer.

    Returns
    -------
    Front or None
        None for fewer than two sound designs.
    """
    sound = [n for n, design in enumerate(designs) if design.verification.passed]
    # A front of a single design has no information.
    if len(sound) < 2:
        return None
    metrics = [designs[n].metrics for n in sound]
    # Smaller is better in every column, so the transmission angle is negated.
    columns = {
        "min_transmission_angle": [-float(measured.min_transmission_angle) for measured in metrics],
        "size": [float(measured.size) for measured in metrics],
    }
    error = _find_error_field(metrics[0])
    # Errors at rounding level count as equal; otherwise rounding noise would decide the front.
    if error is not None:
        columns = {
            ERROR_FIELDS[error]: [max(float(getattr(measured, error)), RESIDUAL_ROUNDING) for measured in metrics],
            **columns,
        }
    table = np.array(list(columns.values())).T
    # Pairwise comparison is fast enough: an answer has a few hundred designs at most.
    no_worse = (table[:, None] <= table).all(axis=2)
    better = (table[:, None] < table).any(axis=2)
    beaten = np.flatnonzero((no_worse & better).any(axis=0))
    return Front(quantities=list(columns), designs=list(np.delete(sound, beaten).tolist()))
