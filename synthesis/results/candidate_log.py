"""Log of the candidates of a search: each is accepted, or counted by its reason of rejection.

All searches report ``candidates = accepted + all rejected``. This holds by construction, since a candidate is counted
only when it is accepted or rejected.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Generic, TypeVar, cast

from kinematics.message import JOINED, Message, compose, find_message, join_messages, remember
from synthesis.model.answer import Search
from synthesis.model.kind import Progress
from synthesis.model.linkage.problem import LinkageProblem
from synthesis.model.problem import ProblemBase
from synthesis.model.protocols import DrivenDesign, VerifiedDesign
from synthesis.results.measurement import check_shared_constraints, select_buildable_first
from synthesis.results.practicality import keep_nearest, sort_by_practice
from synthesis.results.remarks import write_name
from synthesis.verification.shared_constraints import check_workspace_of_design

DEFECT_REASONS = {
    "reaches_targets": "residual",
    "same_circuit": "circuit_defect",
    "same_branch": "branch_defect",
    "visits_in_order": "order_defect",
}
"""Reason of rejection by the name of a failed check of the motion."""

LENGTH_REASONS = {"shortest_link": "link_length", "longest_link": "link_length"}
"""Reason of rejection by the name of a failed check of lengths."""

NUMERICAL_REASONS = {"degenerate", "residual", "cannot_be_driven"}
"""Reasons that indicate a numerical failure: a search that rejects candidates for one of them proves nothing."""

OUTRANKED_REASON = "outranked"
"""Reason for sound candidates that are not driven, or not listed, because enough better ones are."""


Candidate = TypeVar("Candidate")
Design = TypeVar("Design", bound=VerifiedDesign)


class CandidateLog(Generic[Design]):
    """Log of the candidates of a search.

    Parameters
    ----------
    problem : ProblemBase
        The problem, with the number of designs, whether to include failed ones, and the seed.
    reasons : mapping, optional
        Reason of rejection by the name of the first failed check; by default the name itself.
    undriven : str
        Reason of a candidate that cannot be driven at all.

    Attributes
    ----------
    passed, failed : list
        Verified designs, in the order in which they were found.
    accepted : int
        Number of accepted candidates. A candidate that can be driven in several ways may become several designs.
    rejected : Counter
        Number of rejected candidates by reason.
    """

    def __init__(
        self, problem: ProblemBase, reasons: Mapping[str, str] | None = None, undriven: str = "cannot_be_driven"
    ) -> None:
        self.stated = problem
        self.passed: list[Design] = []
        self.failed: list[Design] = []
        self.accepted = 0
        self.rejected: Counter[str] = Counter()
        self._reasons = reasons or {}
        self._undriven = undriven

    @property
    def candidates(self) -> int:
        """Number of candidates of the search."""
        return self.accepted + self.rejected.total()

    def reject(self, reason: str, count: int = 1) -> None:
        """Count candidates that are rejected for ``reason`` without verification; a count of 0 adds no entry."""
        if count:
            self.rejected[reason] += count

    def verify_candidates(
        self,
        candidates: Iterable[Candidate],
        verify: Callable[[Candidate], Design | str | None],
        enough: int | None = None,
    ) -> int:
        """Verify candidates in order until ``enough`` designs have passed; by default verify all of them.

        ``verify`` returns a verdict as described at :meth:`insert_design`. Return the number of verified candidates.
        """
        verified = 0
        # Candidates come best first, so the search may stop early.
        for candidate in candidates:
            self.record_candidate(verify(candidate))
            verified += 1
            if enough is not None and len(self.passed) >= enough:
                break
        return verified

    def verify_best(
        self, best: Sequence[Candidate], covered: int, verify: Callable[[Candidate], Design | str | None]
    ) -> None:
        """Verify the ``best`` of the ``covered`` candidates of an exhaustive search; count the others as outranked."""
        # An exhaustive search has evaluated the others and ranked them below.
        self.reject(OUTRANKED_REASON, covered - len(best))
        self.verify_candidates(best, verify)

    def record_candidate(self, verdict: Design | str | None) -> None:
        """Store and count one candidate by its verdict; see :meth:`insert_design`."""
        self.count(self.insert_design(verdict))

    def insert_design(self, verdict: Design | str | None) -> str:
        """Store a design among those that passed, or those that failed, without counting it.

        Parameters
        ----------
        verdict : Design, str or None
            The verified design, or the reason of rejection, or None if the candidate cannot be driven.

        Returns
        -------
        str
            Reason of rejection; empty if the design passed.
        """
        if verdict is None:
            return self._undriven
        if isinstance(verdict, str):
            return verdict
        # The shared constraints (forces, planes, yield) are expensive, so check them only if everything else passed.
        if verdict.verification.passed:
            judged = check_shared_constraints(self.stated, verdict)
            if judged is None:
                return self._undriven
            verdict = judged
        if verdict.verification.passed:
            self.passed.append(verdict)
            return ""
        self.failed.append(verdict)
        return self.find_reason([check.name for check in verdict.verification.failures])

    def count(self, reason: str) -> None:
        """Count a candidate by its reason of rejection; an empty reason counts it as accepted."""
        if reason:
            self.rejected[reason] += 1
        else:
            self.accepted += 1

    def find_reason(self, broken: Sequence[str]) -> str:
        """Return the reason of rejection of a design with these failed checks."""
        # The first failed check names the reason: later ones often follow from it.
        return self._reasons.get(broken[0], broken[0])

    def withdraw(self, kept: list[Design], reason: str) -> None:
        """Keep only ``kept`` of the passed designs; count the others as rejected for ``reason``."""
        # The total stays the same, because accepted candidates become rejected ones.
        withdrawn = len(self.passed) - len(kept)
        self.passed = kept
        self.accepted -= withdrawn
        self.reject(reason, withdrawn)

    def merge_search(self, search: Search) -> None:
        """Add the counts of another search."""
        self.accepted += search.accepted
        self.rejected.update(search.rejected)

    def format_reasons(self, *left_out: str) -> str:
        """Format the reasons of rejection with their counts, except ``left_out``; empty if there are none."""
        return join_messages(
            [
                compose("results-reason-with-count", reason=write_name(name), count=n)
                for name, n in self.rejected.items()
                if name not in left_out
            ],
            ", ",
        )

    def describe_reasons(self) -> str:
        """Describe the reasons of rejection in a sentence for a summary, with a leading space; empty if there are none.

        :func:`synthesis.results.remarks.append_remark` appends it to the summary.
        """
        if not self.rejected:
            return ""
        sentence = find_message(compose("results-rejected", reasons=self.format_reasons()))
        assert sentence is not None
        # A text with the space is a message, too: the empty part before it is not left out here.
        return remember(Message(JOINED, {"separator": " ", "parts": ("", sentence)}))

    def select_designs(
        self,
        ordered: Callable[[list[Design]], list[Design]],
        different: Callable[[list[Design]], list[Design]] | None = None,
    ) -> list[Design]:
        """Return the designs of the answer, at most the requested number; failed designs last, if they are requested.

        Parameters
        ----------
        ordered : callable
            Sorts designs.
        different : callable, optional
            Drops designs that are nearly equal to an earlier one.
        """
        shown = self._sort_by_practice(ordered(self.passed))
        if self.stated.include_failed:
            shown = [*shown, *ordered(list(map(self._complete_failed, self.failed)))]
        shown = different(shown) if different else shown
        if isinstance(self.stated, LinkageProblem):
            # Every design of a linkage problem is a driven linkage.
            driven = cast("list[DrivenDesign]", shown)
            driven = select_buildable_first(self.stated, driven, self.stated.max_designs)
            return cast("list[Design]", keep_nearest(driven, self.stated.max_designs))
        return shown[: self.stated.max_designs]

    def _sort_by_practice(self, designs: list[Design]) -> list[Design]:
        """Return designs in the order of practicality; those of mechanisms without links are unchanged."""
        if not isinstance(self.stated, LinkageProblem):
            return designs
        return cast("list[Design]", sort_by_practice(self.stated, cast("list[DrivenDesign]", designs)))

    def _complete_failed(self, failed: Design) -> Design:
        """Return a failed design, completed by the checks of its workspace."""
        # If the mechanism cannot be rebuilt, show the design without those checks.
        return check_workspace_of_design(self.stated, failed) or failed

    def build_search(self, method: str, *, complete: bool = False) -> Search:
        """Return the counts in the form of the answer; ``complete`` claims that every solution was found."""
        return Search(
            method=method,
            complete=complete,
            candidates=self.candidates,
            accepted=self.accepted,
            # Unary plus drops reasons whose count fell to 0.
            rejected=dict(+self.rejected),
            seed=self.stated.seed,
        )


def report_candidates(
    candidates: Sequence[Candidate], progress: Progress, span: tuple[float, float], message_id: str
) -> Iterator[Candidate]:
    """Yield candidates one by one and report progress between the shares of ``span`` before each.

    The message gets the values ``done``, ``next`` and ``all``: the number of candidates before this one, including it,
    and in total.
    """
    begin, end = span
    count = len(candidates)
    for n, candidate in enumerate(candidates):
        progress(begin + (end - begin) * n / count, compose(message_id, done=n, next=n + 1, all=count))
        yield candidate
