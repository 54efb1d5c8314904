"""What a kind of problem declares of itself: its statement, its answer and its solver."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any, Generic, Literal, NamedTuple, TypeVar

from synthesis.model.answer import Result
from synthesis.model.mechanism_types import mechanism_types, models_within
from synthesis.model.statement import StatedProblem

Progress = Callable[[float, str], None]
"""Called with the fraction done, 0 to 1, and a short message."""


def part_of(progress: Progress, begin: float, end: float) -> Progress:
    """The progress of a part of the work, which begins and ends at these shares of the whole."""
    return lambda share, message: progress(begin + (end - begin) * share, message)


P = TypeVar("P", bound=StatedProblem)
R = TypeVar("R", bound=Result[Any])


def never(_problem: StatedProblem) -> bool:
    """No statement is."""
    return False


def always(_problem: StatedProblem) -> bool:
    """Every statement is."""
    return True


Group = Literal[
    "Carry a body",
    "Draw a curve",
    "Make an output follow",
    "Change a speed",
    "Lift and rest",
    "Run smoothly",
]
"""What a person wants, in the order of the studio's gallery."""


class Named(NamedTuple):
    """An example as a person looks for it: its name, what it is for, and what it shows in a sentence."""

    name: str
    group: Group
    line: str


@dataclass(frozen=True)
class Kind(Generic[P, R]):
    """One kind of problem.

    Attributes
    ----------
    name : str
        What the field ``kind`` of its statements holds.
    problem, result : type
        The models of the statement and of the answer.
    solve : callable
        From a consistent statement to its answer. It imports the solver when it is called: whoever only needs the
        models does not wait for the compiled kernels.
    warm_up : callable, optional
        Loads what most jobs need, in the time of one brief job; every new worker calls it beside its first jobs. Where
        it is left out the examples of the kind are solved instead. All examples are solved where the kernels are
        compiled ahead of time.
    verify : callable, optional
        Measures a finished mechanism against a statement: the design, or None where it cannot be driven. It tells how
        far the answers to a statement that asks for less are from the one that was asked.
    nearer : callable, optional
        Designs of a statement by continuation from designs of a looser one, in a fraction of the time of a search: how
        a limit out of reach is approached. None for statements that it has none for; those are searched.
    nearly : callable, optional
        Measures a finished mechanism against a statement of which it meets as nearly as it can what designs must meet
        exactly: from the statement, a design that does, and another mechanism, the design of that; None where it cannot
        be driven.
    gallery : tuple of Named
        Its examples by name, in their order.
    brief : callable, optional
        Whether the answer to a statement takes a fraction of a second, as a rule. The service computes such ones beside
        searches that take long; where it is left out none is brief.
    """

    name: str
    problem: type[P]
    result: type[R]
    solve: Callable[[P, Progress], R]
    warm_up: Callable[[], None] | None = None
    verify: Callable[[P, Any], Any] | None = None
    nearer: Callable[[P, Sequence[Any], Progress], Sequence[Any] | None] | None = None
    brief: Callable[[P], bool] = never
    nearly: Callable[[P, Any, Any], Any] | None = None
    gallery: tuple[Named, ...] = field(kw_only=True)

    @property
    def mechanisms(self) -> list[str]:
        """The types of mechanisms that its designs can have, in the order of the models of its answer."""
        designs = models_within(self.result.model_fields["designs"].annotation)
        return [name for design in designs for name in mechanism_types(design)]

    @property
    def metrics(self) -> list[str]:
        """The names of what is measured of its designs beside checks, in the order of the models of its answer."""
        designs = models_within(self.result.model_fields["designs"].annotation)
        measured = [model for design in designs for model in models_within(design.model_fields["metrics"].annotation)]
        named = [field.alias or name for model in measured for name, field in model.model_fields.items()]
        return list(dict.fromkeys(named))

    @property
    def examples(self) -> list[dict[str, Any]]:
        """Runnable statements, as a client would post them; the first is the plainest."""
        schema_extra = self.problem.model_config["json_schema_extra"]
        assert isinstance(schema_extra, dict)
        stated = schema_extra["examples"]
        assert isinstance(stated, list)
        return [statement for statement in stated if isinstance(statement, dict)]
