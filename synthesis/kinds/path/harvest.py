"""What becomes of linkages that were found: verified designs, why others were rejected, and the answer made of them."""

from __future__ import annotations

from collections.abc import Sequence

from synthesis.kinds.path.design import PathDesign, PathResult
from synthesis.kinds.path.problem import PathProblem
from synthesis.kinds.path.verification import verify_path
from synthesis.model.linkages import FourbarConfiguration, fourbar_mechanism
from synthesis.outcome.ranking import distinct, ranked
from synthesis.outcome.sifting import DEFECTS, LENGTHS, NUMERICAL, Sifting

SAME_DESIGN = 1e-6
"""Designs whose joints agree to this share of the task's size are one and the same."""

APART = 0.05
"""The same where there is a family of them: nearer ones are variants of one design."""

SHORTEST_LINK = 1e-9
"""Links shorter than this share of the longest are no links."""

_OF_DIMENSIONS = frozenset(
    (
        "shortest_link", "longest_link", "link_ratio", "grashof", "full_rotation", "coupler_point",
        "fixed_pivot_region", "input_pivot_region", "moving_pivot_region", "fixed_pivots",
    )
)  # fmt: skip
"""Checks of dimensions alone: a design that breaks one is refuted, however badly rounding lets it be driven."""


class Harvest(Sifting[PathDesign]):
    """Designs that satisfy all demands of a problem, those that do not, and the reasons; what is alike is one."""

    def __init__(self, problem: PathProblem, *, apart: float = SAME_DESIGN) -> None:
        super().__init__(problem, DEFECTS | LENGTHS)
        self.problem, self.apart = problem, apart

    @property
    def unproven(self) -> bool:
        """Whether solutions were rejected although nothing was measured that speaks against them.

        Then none of what was found may be called all there is.
        """
        return bool(NUMERICAL & self.rejected.keys())

    def reason_of(self, broken: Sequence[str]) -> str:
        """Rounding can keep a solution from being shown to reach its points: that says nothing against it."""
        if broken[0] == "reaches_targets":
            broken = [name for name in broken if name in _OF_DIMENSIONS] or broken
        return super().reason_of(broken)

    def drive(self, joints: FourbarConfiguration) -> bool:
        """Verify a fourbar; returns whether it has all points on one circuit."""
        if not joints.has_no_link_below(SHORTEST_LINK):
            self.reject("degenerate")
            return False
        design = verify_path(self.problem, fourbar_mechanism(joints))
        self.add(design)
        return design is not None and all(
            check.passed for check in design.verification.checks if check.name in ("reaches_targets", "same_circuit")
        )

    def proof(self, *, complete: bool) -> str:
        """What an empty answer means, as a sentence of the summary; empty where there are designs."""
        if self.passed:
            return ""
        if not complete:
            return " Others may exist."
        none = "none of them does both" if self.problem.method == "auto" else "no design exists"
        return f" These are all fourbars, so {none}."

    def result(self, method: str, *, complete: bool, summary: str) -> PathResult:
        """The answer."""
        return PathResult(
            designs=self.designs(self.ordered, self.different),
            search=self.search(method, complete=complete),
            summary=summary,
        )

    def ordered(self, designs: list[PathDesign]) -> list[PathDesign]:
        """Designs in the order asked for."""
        return ranked(designs, self.problem.rank_by)

    def different(self, designs: list[PathDesign]) -> list[PathDesign]:
        """Designs, each once."""
        return that_differ(designs, len(designs), self.apart * self.problem.task_size)


def that_differ(designs: list[PathDesign], count: int, apart: float) -> list[PathDesign]:
    """The first designs, at most ``count``, of which each has some joint ``apart`` from where all before have it."""
    names = ("O2", "A", "B", "O4")
    joints = [[complex(*design.mechanism.skeleton.joints[name]) for name in names] for design in designs]
    return [designs[n] for n in distinct(joints, count, apart)]
