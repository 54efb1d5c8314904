"""Verification of linkages on a grid, whose rounded dimensions miss points even if the problem requires exactness."""

from __future__ import annotations

from synthesis.kinds.path.design import PathDesign
from synthesis.kinds.path.problem import PathProblem
from synthesis.kinds.path.verification.fourbar import verify_path
from synthesis.kinds.path.verification.linkage import verify_traced
from synthesis.model.linkage.answer import FourbarMechanism, LinkageMechanism, SliderCrankMechanism


def verify_on_grid(problem: PathProblem, mechanism: LinkageMechanism) -> PathDesign | None:
    """Drive a fourbar or slider-crank past the points, and measure it; None if it cannot be driven.

    Raises
    ------
    TypeError
        For a mechanism of another type.
    """
    nearly = problem if problem.is_fitted else problem.model_copy(update={"method": "least_squares"})
    if isinstance(mechanism, FourbarMechanism):
        return verify_path(nearly, mechanism)
    if isinstance(mechanism, SliderCrankMechanism):
        return verify_traced(nearly, mechanism)
    raise TypeError(f"a {mechanism.type} cannot be rounded to a grid")
