"""Code that several tests share: train series."""

from __future__ import annotations

from synthesis.kinds.train_series.design import TrainSeriesResult
from tests.support.independent.train_series import Best


def same(result: TrainSeriesResult, best: Best) -> bool:
    """Whether solver and brute force agree on the optimum, and on whether there is one."""
    if best.error is None:
        return not result.designs and result.search.complete and result.search.combinations == best.combinations
    if not result.designs:
        return False
    first = result.designs[0]
    return (
        result.search.complete
        and first.verification.passed
        and result.search.combinations == best.combinations
        and result.search.ties == best.ties
        and abs(abs(first.metrics.error) - float(best.error)) <= 1e-12 * max(1e-3, float(best.error))
        and first.metrics.total_teeth == best.total
    )
