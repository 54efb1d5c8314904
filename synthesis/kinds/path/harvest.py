"""Collect the results of a search: verified designs, reasons for rejections, and the answer built from them."""

from __future__ import annotations

from collections.abc import Sequence

from synthesis.kinds.path.design import PathDesign, PathResult
from synthesis.kinds.path.problem import PathProblem
from synthesis.kinds.path.verification import verify_path
from synthesis.model.linkages import FourbarConfiguration, fourbar_mechanism
from synthesis.outcome.ranking import distinct, ranked
from synthesis.outcome.sifting import DEFECTS, LENGTHS, NUMERICAL, Sifting

SAME_DESIGN = 1e-6
"""Designs whose joints agree to this share of the task's size are duplicates."""

APART = 0.05
"""Minimum separation of designs of a continuous family, as a share of the task's size: nearer ones are variants."""

SHORTEST_LINK = 1e-9
"""Linkages with a link shorter than this share of the longest are degenerate."""

_OF_DIMENSIONS = frozenset(
    (
        "shortest_link", "longest_link", "link_ratio", "grashof", "full_rotation", "coupler_point",
        "fixed_pivot_region", "input_pivot_region", "moving_pivot_region", "fixed_pivots",
    )
)  # fmt: skip
"""Names of checks of dimensions alone: a design that fails one is refuted, however inaccurately it can be driven."""


class Harvest(Sifting[PathDesign]):
    """Designs that satisfy all constraints of a problem, those that do not, and the reasons; duplicates are merged."""

    def __init__(self, problem: PathProblem, *, apart: float = SAME_DESIGN) -> None:
        super().__init__(problem, DEFECTS | LENGTHS)
        self.problem, self.apart = problem, apart

    @property
    def unproven(self) -> bool:
        """Whether solutions were rejected only because of rounding, without any measurement against them.

        The designs found may then not be called all solutions.
        """
        return bool(NUMERICAL & self.rejected.keys())

    def reason_of(self, broken: Sequence[str]) -> str:
        """Return the reason of a rejection from the failed checks.

        Rounding can prevent a solution from reaching its points, which says nothing against it; checks of dimensions
        are preferred as the reason.
        """
        # Checks of dimensions do not depend on the driven motion and therefore remain valid.
        if broken[0] == "reaches_targets":
            broken = [name for name in broken if name in _OF_DIMENSIONS] or broken
        return super().reason_of(broken)

    def drive(self, joints: FourbarConfiguration) -> bool:
        """Verify a fourbar; return whether it has all points on one circuit."""
        # The analysis core could not drive it.
        if not joints.has_no_link_below(SHORTEST_LINK):
            self.reject("degenerate")
            return False
        design = verify_path(self.problem, fourbar_mechanism(joints))
        self.add(design)
        return design is not None and all(
            check.passed for check in design.verification.checks if check.name in ("reaches_targets", "same_circuit")
        )

    def proof(self, *, complete: bool) -> str:
        """Describe in a sentence of the summary the meaning of an empty result; empty if there are designs."""
        if self.passed:
            return ""
        if not complete:
            return " Others may exist."
        none = "none of them does both" if self.problem.method == "auto" else "no design exists"
        return f" These are all fourbars, so {none}."

    def result(self, method: str, *, complete: bool, summary: str) -> PathResult:
        """Build the result."""
        return PathResult(
            designs=self.designs(self.ordered, self.different),
            search=self.search(method, complete=complete),
            summary=summary,
        )

    def ordered(self, designs: list[PathDesign]) -> list[PathDesign]:
        """Return designs in the requested order."""
        return ranked(designs, self.problem.rank_by)

    def different(self, designs: list[PathDesign]) -> list[PathDesign]:
        """Return designs without duplicates."""
        return that_differ(designs, len(designs), self.apart * self.problem.task_size)


def that_differ(designs: list[PathDesign], count: int, apart: float) -> list[PathDesign]:
    """Return the first designs, at most ``count``, with some joint at least ``apart`` from its place in all earlier
    ones."""
    names = ("O2", "A", "B", "O4")
    joints = [[complex(*design.mechanism.skeleton.joints[name]) for name in names] for design in designs]
    return [designs[n] for n in distinct(joints, count, apart)]
