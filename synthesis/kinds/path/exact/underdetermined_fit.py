"""Fourbars that meet fewer points than they can exactly: random members of the family, within limits.

Fewer points than a fourbar can meet leave a family of linkages. Descents from random starts
(:mod:`synthesis.kinds.path.points.fit`) end at random members of it that satisfy all limits, given pivots included.
Most random members are poor linkages; therefore the first rounds add limits on the transmission angle, the link ratio
and the longest link to the client's, and relax them from round to round.
"""

from __future__ import annotations

import math

import numpy as np

from synthesis.kinds.path.design import PathDesign
from synthesis.kinds.path.points.fit import build_mechanism, build_point_task, find_minima
from synthesis.kinds.path.problem import PathProblem
from synthesis.kinds.path.residuals.constraint_vector import UsableLimits
from synthesis.kinds.path.verification.fourbar import verify_path
from synthesis.model.kind import Progress, scale_progress

ROUND_LIMITS = (UsableLimits(45.0, 6.0, 6.0), UsableLimits(25.0, 12.0, 12.0), UsableLimits(12.0, 20.0, 20.0), None)
"""Limits added to the client's in each round, the strictest first."""

MAX_REFINED = 40
"""Maximum number of linkages that are refined and verified in a round."""

EXACT_TOLERANCE = 1e-11
"""Root mean square distance, in task sizes, up to which a linkage counts as a member of the family."""


def find_exact_fits(problem: PathProblem, progress: Progress) -> list[PathDesign | None]:
    """Find linkages through all points and verify them; None for one that could not be driven.

    Rounds continue until enough designs satisfy all constraints.
    """
    task = build_point_task(problem)
    rng = np.random.default_rng(problem.seed)
    designs: list[PathDesign | None] = []
    sound = 0
    # Strict limits first: they find the good linkages while the family is large, and are dropped when it is empty.
    for n, usable in enumerate(ROUND_LIMITS):
        part = scale_progress(progress, n / len(ROUND_LIMITS), (n + 1) / len(ROUND_LIMITS))
        for candidate in find_minima(problem, task, rng, part, finalists=MAX_REFINED, usable=usable):
            # A minimum with a positive error is a fit, not a member of the family.
            if math.sqrt(2.0 * candidate.cost / len(task.rows)) > EXACT_TOLERANCE:
                continue
            mechanism = build_mechanism(candidate, task)
            design = None if mechanism is None else verify_path(problem, mechanism)
            designs.append(design)
            sound += design is not None and design.verification.passed
        if sound >= problem.max_designs:
            break
    return designs
