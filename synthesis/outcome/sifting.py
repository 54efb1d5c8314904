"""What a search that covered everything returns and says of itself, once its designs are verified."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Generic, NamedTuple, Protocol, TypeVar

from synthesis.model.answer import Search, Verification
from synthesis.model.statement import StatedProblem


class Verified(Protocol):
    """A design with its checks."""

    @property
    def verification(self) -> Verification:
        """The checks."""


Design = TypeVar("Design", bound=Verified)


class Sifted(NamedTuple, Generic[Design]):
    """The designs that passed, those to return (with the failed ones last where they are asked for), and the search."""

    passed: list[Design]
    returned: list[Design]
    search: Search


def sifted(
    problem: StatedProblem,
    designs: Sequence[Design],
    candidates: int,
    rejected: Mapping[str, int],
    complete: bool = True,
) -> Sifted[Design]:
    """Designs by their verification, and the account of the search.

    Parameters
    ----------
    candidates : int
        Combinations that the search covered.
    rejected : mapping
        How many of them fell for which reason, those outranked among them.
    complete : bool
        Whether the combinations are all that the statement lets in. A design that fails its verification breaks the
        promise as well.
    """
    passed = [design for design in designs if design.verification.passed]
    failed = [design for design in designs if not design.verification.passed]
    every = {**rejected, "verification": len(failed)}
    search = Search(
        method="exhaustive",
        complete=complete and not failed,
        candidates=candidates,
        accepted=len(passed),
        rejected={reason: count for reason, count in every.items() if count},
        seed=problem.seed,
    )
    return Sifted(passed, [*passed, *failed] if problem.include_failed else passed, search)
