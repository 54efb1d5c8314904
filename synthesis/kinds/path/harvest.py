"""What becomes of linkages that were found: verified designs, why others were rejected, and the answer made of them."""

from __future__ import annotations

from collections import Counter

import numpy as np

from synthesis.kinds.path.design import PathDesign, PathResult
from synthesis.kinds.path.problem import PathProblem
from synthesis.model.answer import Search
from synthesis.outcome.ranking import distinct, ranked

SAME_DESIGN = 1e-6
"""Designs whose joints agree to this share of the task's size are one and the same."""

APART = 0.05
"""The same where there is a family of them: nearer ones are variants of one design."""

_REASONS = {
    "reaches_targets": "residual",
    "same_circuit": "circuit_defect",
    "same_branch": "branch_defect",
    "visits_in_order": "order_defect",
    "shortest_link": "link_length",
    "longest_link": "link_length",
}
"""Why a design was rejected, by the check that it failed; other checks go by their own name."""

_OF_DIMENSIONS = frozenset(
    (
        "shortest_link", "longest_link", "link_ratio", "grashof", "full_rotation", "coupler_point",
        "fixed_pivot_region", "input_pivot_region", "moving_pivot_region", "fixed_pivots",
    )
)  # fmt: skip
"""Checks of dimensions alone: a design that breaks one is refuted, however badly rounding lets it be driven."""


class Harvest:
    """Designs that satisfy all demands of a problem, those that do not, and the reasons.

    ``unproven`` counts the solutions of the equations that were rejected although nothing was measured that speaks
    against them: where there are some, none of what was found may be called all there is.
    """

    def __init__(self, problem: PathProblem, *, apart: float = SAME_DESIGN) -> None:
        self.problem, self.apart = problem, apart
        self.passed: list[PathDesign] = []
        self.failed: list[PathDesign] = []
        self.rejected: Counter[str] = Counter()
        self.candidates = 0
        self.unproven = 0

    def degenerate(self) -> None:
        """A solution has a link without length: it is no linkage."""
        self.candidates += 1
        self.unproven += 1
        self.rejected["degenerate"] += 1

    def add(self, design: PathDesign | None) -> None:
        """Put a verified design where it belongs; None is one that could not be driven."""
        self.candidates += 1
        if design is None:
            self.unproven += 1
            self.rejected["cannot_be_driven"] += 1
        elif design.verification.passed:
            self.passed.append(design)
        else:
            self.failed.append(design)
            broken = [check.name for check in design.verification.checks if not check.passed]
            name = broken[0]
            if name == "reaches_targets":
                # A solution that rounding keeps from being shown to reach its points: that says nothing against it.
                name = next((other for other in broken if other in _OF_DIMENSIONS), name)
                self.unproven += name == "reaches_targets"
            self.rejected[_REASONS.get(name, name)] += 1

    def listed(self) -> str:
        """The reasons in words."""
        return ", ".join(f"{name.replace('_', ' ')} {n}" for name, n in self.rejected.items() if n)

    def shown(self) -> list[PathDesign]:
        """Designs in the order asked for, each once; those that failed after the others, where they are wanted."""
        problem = self.problem
        designs = ranked(self.passed, problem.rank_by)
        if problem.include_failed:
            designs += ranked(self.failed, problem.rank_by)
        if not designs:
            return []
        joints = np.array(
            [[complex(*one.mechanism.skeleton.joints[name]) for name in ("O2", "A", "B", "O4")] for one in designs]
        )
        return [designs[n] for n in distinct(joints, len(designs), self.apart * problem.task_size)]

    def result(self, method: str, *, complete: bool, summary: str) -> PathResult:
        """The answer."""
        problem = self.problem
        return PathResult(
            designs=self.shown()[: problem.max_designs],
            search=Search(
                method=method,
                complete=complete,
                candidates=self.candidates,
                accepted=len(self.passed),
                rejected={name: n for name, n in self.rejected.items() if n},
                seed=problem.seed,
            ),
            summary=summary,
        )
