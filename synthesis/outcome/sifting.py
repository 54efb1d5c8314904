"""What becomes of candidates: each verified once, those that pass kept, and every other counted by its reason.

Every search has the same account: ``candidates = accepted + all rejected``. Here it holds by construction: nothing
counts a candidate but its acceptance or a reason against it.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Generic, Protocol, TypeVar

from synthesis.model.answer import Search, Verification
from synthesis.model.counting import grouped
from synthesis.model.kind import Progress
from synthesis.model.statement import StatedProblem
from synthesis.outcome.held import held_to_all
from synthesis.proof.room import judged_by_room

DEFECTS = {
    "reaches_targets": "residual",
    "same_circuit": "circuit_defect",
    "same_branch": "branch_defect",
    "visits_in_order": "order_defect",
}
"""Reasons of rejection by the check of the motion that is broken."""

LENGTHS = {"shortest_link": "link_length", "longest_link": "link_length"}
"""Reasons of rejection by the check of lengths that is broken."""

NUMERICAL = {"degenerate", "residual", "cannot_be_driven"}
"""Reasons that say what could not be shown, not what cannot be: a search with one of them proves nothing."""

OUTRANKED = "outranked"
"""Reason of the sound candidates that are not driven, or not offered, because better ones are."""


class Verified(Protocol):
    """A design with its checks."""

    @property
    def verification(self) -> Verification:
        """The checks."""


Candidate = TypeVar("Candidate")
Design = TypeVar("Design", bound=Verified)


class Sifting(Generic[Design]):
    """The account of a search.

    Parameters
    ----------
    problem : StatedProblem
        What was asked: how many designs, whether with those that fail, and the seed.
    reasons : mapping, optional
        Reasons of rejection by the first check that a design breaks; other checks go by their own name.
    undriven : str
        Reason of a candidate that cannot be driven at all.

    Attributes
    ----------
    passed, failed : list
        Verified designs, in the order in which they were met.
    accepted : int
        Candidates that passed. A candidate that may be driven in several ways can be several designs.
    rejected : Counter
        The other candidates by reason.
    """

    def __init__(
        self, problem: StatedProblem, reasons: Mapping[str, str] | None = None, undriven: str = "cannot_be_driven"
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
        """How many the search had."""
        return self.accepted + self.rejected.total()

    def reject(self, reason: str, count: int = 1) -> None:
        """Count candidates that are not verified, for ``reason``; none leaves no trace."""
        if count:
            self.rejected[reason] += count

    def sift(
        self,
        candidates: Iterable[Candidate],
        verify: Callable[[Candidate], Design | str | None],
        enough: int | None = None,
    ) -> int:
        """Verify candidates, the first first, until ``enough`` designs have passed; return how many were verified.

        ``verify`` answers as :meth:`keep` wants it.
        """
        verified = 0
        for candidate in candidates:
            self.add(verify(candidate))
            verified += 1
            if enough is not None and len(self.passed) >= enough:
                break
        return verified

    def sift_best(
        self, best: Sequence[Candidate], covered: int, verify: Callable[[Candidate], Design | str | None]
    ) -> None:
        """Verify the best of the ``covered`` candidates of an exhaustive search; they outrank the others."""
        self.reject(OUTRANKED, covered - len(best))
        self.sift(best, verify)

    def add(self, verdict: Design | str | None) -> None:
        """Keep and count one candidate."""
        self.count(self.keep(verdict))

    def keep(self, verdict: Design | str | None) -> str:
        """Put a design with those that passed or failed, without counting it.

        Parameters
        ----------
        verdict : Design, str or None
            The verified design; the reason why there is none; None where it cannot be driven.

        Returns
        -------
        str
            Why it is rejected; empty where it passed.
        """
        if verdict is None:
            return self._undriven
        if isinstance(verdict, str):
            return verdict
        if verdict.verification.passed:
            judged = held_to_all(self.stated, verdict)
            if judged is None:
                return self._undriven
            verdict = judged
        if verdict.verification.passed:
            self.passed.append(verdict)
            return ""
        self.failed.append(verdict)
        return self.reason_of([check.name for check in verdict.verification.checks if not check.passed])

    def count(self, reason: str) -> None:
        """Count a candidate by the reason against it; by none it is accepted."""
        if reason:
            self.rejected[reason] += 1
        else:
            self.accepted += 1

    def reason_of(self, broken: Sequence[str]) -> str:
        """Why a design that breaks these checks is rejected."""
        return self._reasons.get(broken[0], broken[0])

    def withdraw(self, kept: list[Design], reason: str) -> None:
        """Offer only ``kept`` of the designs that passed; the others count as rejected for ``reason``."""
        withdrawn = len(self.passed) - len(kept)
        self.passed = kept
        self.accepted -= withdrawn
        self.reject(reason, withdrawn)

    def join(self, search: Search) -> None:
        """Take the account of a search into this one."""
        self.accepted += search.accepted
        self.rejected.update(search.rejected)

    def listed(self, *left_out: str) -> str:
        """The reasons in words with their numbers, but for those that are left out; empty where there is none."""
        return ", ".join(
            f"{name.replace('_', ' ')} {grouped(n)}" for name, n in self.rejected.items() if name not in left_out
        )

    def reasons(self) -> str:
        """The reasons as a sentence that is added to a summary."""
        return f" Rejected: {self.listed()}." if self.rejected else ""

    def designs(
        self,
        ordered: Callable[[list[Design]], list[Design]],
        different: Callable[[list[Design]], list[Design]] | None = None,
    ) -> list[Design]:
        """The designs to return: in order, those that failed last and only if asked for, as many as are wanted.

        ``different`` leaves out of them what is nearly the same as one before.
        """
        shown = ordered(self.passed)
        if self.stated.include_failed:
            shown = [*shown, *ordered(list(map(self._in_full, self.failed)))]
        return (different(shown) if different else shown)[: self.stated.max_designs]

    def _in_full(self, failed: Design) -> Design:
        """A design that broke a check of its own, with what it has of the demands that are judged after these."""
        return judged_by_room(self.stated, failed) or failed

    def search(self, method: str, *, complete: bool = False) -> Search:
        """The account in the answer."""
        return Search(
            method=method,
            complete=complete,
            candidates=self.candidates,
            accepted=self.accepted,
            rejected=dict(+self.rejected),
            seed=self.stated.seed,
        )


def reported(
    candidates: Sequence[Candidate], progress: Progress, span: tuple[float, float], message: str
) -> Iterator[Candidate]:
    """Candidates one by one, each after a report of progress between the shares of ``span``.

    ``message`` may name ``{done}``, ``{next}`` and ``{all}``: candidates before this one, with it, and in all.
    """
    begin, end = span
    count = len(candidates)
    for n, candidate in enumerate(candidates):
        progress(begin + (end - begin) * n / count, message.format(done=n, next=n + 1, all=count))
        yield candidate
