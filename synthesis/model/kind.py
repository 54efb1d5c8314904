"""Declaration of a kind of problem: its statement, its answer and its solver."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any, Generic, Literal, NamedTuple, TypeVar

from synthesis.model.answer import Result
from synthesis.model.mechanism_types import mechanism_types, models_within
from synthesis.model.statement import StatedProblem

Progress = Callable[[float, str], None]
"""Callback with the fraction done, 0 to 1, and a short message."""


def part_of(progress: Progress, begin: float, end: float) -> Progress:
    """Return a progress callback for a part of the work that begins and ends at these shares of the whole."""
    return lambda share, message: progress(begin + (end - begin) * share, message)


P = TypeVar("P", bound=StatedProblem)
R = TypeVar("R", bound=Result[Any])


def never(_problem: StatedProblem) -> bool:
    """Return False for every statement."""
    return False


def always(_problem: StatedProblem) -> bool:
    """Return True for every statement."""
    return True


Group = Literal[
    "Carry a body",
    "Draw a curve",
    "Make an output follow",
    "Change a speed",
    "Lift and rest",
    "Run smoothly",
]
"""Purposes of a mechanism, in the order of the studio's gallery."""


class Named(NamedTuple):
    """Example for the gallery: its name, its purpose, and one sentence on what it shows."""

    name: str
    group: Group
    line: str


@dataclass(frozen=True)
class Kind(Generic[P, R]):
    """Declaration of one kind of problem.

    Attributes
    ----------
    name : str
        Value of the field ``kind`` of its statements.
    problem, result : type
        Models of the statement and of the answer.
    solve : callable
        Solves a consistent statement. It imports the solver only when called, so that code that needs only the models
        does not wait for the compiled kernels.
    warm_up : callable, optional
        Loads the kernels that most jobs need, in the time of one brief job. Every new worker calls it alongside its
        first jobs. If left out, the examples of the kind are solved instead. When kernels are compiled ahead of time,
        all examples are solved.
    verify : callable, optional
        Measures a finished mechanism against a statement and returns the design, or None if it cannot be driven. It
        shows how far designs of a relaxed statement are from the original statement.
    nearer : callable, optional
        Continues designs of a looser statement to designs of a stricter one, in a fraction of the time of a search, to
        approach a limit that cannot be reached. Returns None for statements without continuation; those are searched.
    nearly : callable, optional
        Measures a finished mechanism that satisfies only approximately what designs must satisfy exactly, for example
        after rounding. Takes the statement, an exact design and the other mechanism, and returns the design of the
        latter, or None if it cannot be driven.
    gallery : tuple of Named
        Examples with their names, in the order of the statement's examples.
    brief : callable, optional
        Whether solving a statement usually takes a fraction of a second. The service runs such jobs alongside long
        searches. By default no statement is brief.
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
        """Types of mechanisms that its designs can have, in the order of the models of its answer."""
        designs = models_within(self.result.model_fields["designs"].annotation)
        return [name for design in designs for name in mechanism_types(design)]

    @property
    def metrics(self) -> list[str]:
        """Names of the metrics of its designs, in the order of the models of its answer."""
        designs = models_within(self.result.model_fields["designs"].annotation)
        measured = [model for design in designs for model in models_within(design.model_fields["metrics"].annotation)]
        named = [field.alias or name for model in measured for name, field in model.model_fields.items()]
        return list(dict.fromkeys(named))

    @property
    def examples(self) -> list[dict[str, Any]]:
        """Runnable statements, as a client would post them; the first is the simplest."""
        schema_extra = self.problem.model_config["json_schema_extra"]
        assert isinstance(schema_extra, dict)
        stated = schema_extra["examples"]
        assert isinstance(stated, list)
        return [statement for statement in stated if isinstance(statement, dict)]
