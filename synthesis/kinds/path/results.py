"""Results of a search: verified designs, reasons for rejections, and the answer built from them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from kinematics.message import compose, join_messages
from synthesis.kinds.path.design import PathDesign, PathResult
from synthesis.kinds.path.problem import PathProblem
from synthesis.kinds.path.verification.fourbar import verify_path
from synthesis.model.linkage.conversion import FourbarConfiguration, build_fourbar
from synthesis.results.candidate_log import DEFECT_REASONS, LENGTH_REASONS, NUMERICAL_REASONS, CandidateLog
from synthesis.results.ranking import rank_designs, select_distinct

DESIGN_DUPLICATE_TOLERANCE = 1e-6
"""Designs whose joints agree to this share of the task's size are duplicates."""

MIN_SEPARATION = 0.05
"""Minimum separation of designs of a continuous family, as a share of the task's size: nearer ones are variants."""

MIN_LINK_SHARE = 1e-9
"""Linkages with a link shorter than this share of the longest are degenerate."""

_DIMENSION_CHECKS = frozenset(
    (
        "shortest_link", "longest_link", "link_ratio", "grashof", "full_rotation", "coupler_point",
        "fixed_pivot_region", "input_pivot_region", "moving_pivot_region", "fixed_pivots",
    )
)  # fmt: skip
"""Names of checks of dimensions alone: a design that fails one is refuted, however inaccurately it can be driven."""


class PathCandidateLog(CandidateLog[PathDesign]):
    """Designs that satisfy all constraints of a problem, those that do not, and the reasons; duplicates are merged."""

    def __init__(self, problem: PathProblem, *, apart: float = DESIGN_DUPLICATE_TOLERANCE) -> None:
        super().__init__(problem, DEFECT_REASONS | LENGTH_REASONS)
        self.problem, self.apart = problem, apart

    @property
    def unproven(self) -> bool:
        """Whether solutions were rejected only because of rounding, with no measurement that refutes them.

        The designs found must then not be called all solutions.
        """
        return bool(NUMERICAL_REASONS & self.rejected.keys())

    def find_reason(self, broken: Sequence[str]) -> str:
        """Return the reason of a rejection from the failed checks.

        Rounding can prevent a solution from reaching its points, which says nothing against it; checks of dimensions
        are preferred as the reason.
        """
        # Checks of dimensions do not depend on the driven motion and therefore remain valid.
        if broken[0] == "reaches_targets":
            broken = [name for name in broken if name in _DIMENSION_CHECKS] or broken
        return super().find_reason(broken)

    def drive(self, joints: FourbarConfiguration) -> bool:
        """Verify a fourbar; return whether it has all points on one circuit."""
        # The analysis core could not drive it.
        if not joints.has_no_link_below(MIN_LINK_SHARE):
            self.reject("degenerate")
            return False
        design = verify_path(self.problem, build_fourbar(joints))
        self.record_candidate(design)
        return design is not None and all(
            check.passed for check in design.verification.checks if check.name in ("reaches_targets", "same_circuit")
        )

    def describe_completeness(self, *, complete: bool) -> str:
        """Describe in a sentence of the summary the meaning of an empty result; empty if there are designs."""
        if self.passed:
            return ""
        if not complete:
            return compose("path-others-may-exist")
        return compose("path-no-fourbar-does-both" if self.problem.method == "auto" else "path-no-design-exists")

    def build_result(self, method: str, *, complete: bool, summary: str) -> PathResult:
        """Build the result."""
        return PathResult(
            designs=self.select_designs(self.sort_designs, self.select_distinct),
            search=self.build_search(method, complete=complete),
            summary=summary,
        )

    def sort_designs(self, designs: list[PathDesign]) -> list[PathDesign]:
        """Return designs in the requested order."""
        return rank_designs(designs, self.problem.rank_by)

    def select_distinct(self, designs: list[PathDesign]) -> list[PathDesign]:
        """Return designs without duplicates."""
        return select_distinct_designs(designs, len(designs), self.apart * self.problem.task_size)


def join_sentences(sentences: Iterable[str]) -> str:
    """Join the sentences of a summary; they may begin with a space, and empty ones are left out."""
    return join_messages(sentence.lstrip() for sentence in sentences)


def select_distinct_designs(designs: list[PathDesign], count: int, apart: float) -> list[PathDesign]:
    """Return the first distinct designs, at most ``count``.

    A design is distinct if some joint is at least ``apart`` from its position in each earlier design.
    """
    names = ("O2", "A", "B", "O4")
    joints = [[complex(*design.mechanism.skeleton.joints[name]) for name in names] for design in designs]
    return [designs[n] for n in select_distinct(joints, count, apart)]
