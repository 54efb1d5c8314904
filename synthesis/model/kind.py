"""Declaration of a kind of problem: its statement, its answer and its solver."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any, Generic, Literal, NamedTuple, TypeVar

from synthesis.model.answer import AnyResult, Reachable
from synthesis.model.json_object import JsonObject
from synthesis.model.mechanism_types import collect_models, list_mechanism_types
from synthesis.model.problem import ProblemBase

Progress = Callable[[float, str], None]
"""Callback that receives the completed share, 0 to 1, and a short message."""


def scale_progress(progress: Progress, begin: float, end: float) -> Progress:
    """Return a progress callback for a part of the work, which begins and ends at the given shares of the whole."""
    return lambda share, message: progress(begin + (end - begin) * share, message)


P = TypeVar("P", bound=ProblemBase)
R = TypeVar("R", bound=AnyResult)


def return_false(_problem: ProblemBase) -> bool:
    """Return False for every statement."""
    return False


def return_true(_problem: ProblemBase) -> bool:
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


class NamedExample(NamedTuple):
    """Example for the gallery: its name, its purpose, and a sentence that describes it."""

    name: str
    group: Group
    line: str


class RatioCheck(NamedTuple):
    """Names of the check of a ratio's tolerance, and of the metric that it compares with the tolerance."""

    check: str
    metric: str


class TableColumns(NamedTuple):
    """Columns of a table that states a problem: the list field that its rows fill, and the required columns.

    ``closes`` is true if rows that end where they began state a closed curve, by the field ``closed``.
    """

    field: str
    required: tuple[str, ...]
    closes: bool = False


@dataclass(frozen=True)
class TaskEasing(Generic[P]):
    """Nearest-miss strategy of a kind whose task can be made gradually easier if no design fulfils it.

    Attributes
    ----------
    ease : callable
        Returns the statement with its task reduced to a share, 0 to 1, of the requested task.
    list_reached : callable
        Returns the values that an eased statement requests, as fields of :class:`synthesis.model.answer.Reachable`.
    describe_reached : callable
        Returns a sentence for the summary that describes the reached values, with a leading space, or an empty string.
    """

    ease: Callable[[P, float], P]
    list_reached: Callable[[P], JsonObject]
    describe_reached: Callable[[Reachable], str]


def list_no_problems() -> list[JsonObject]:
    """Return no statements."""
    return []


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
        first jobs. Without it, the examples of the kind are solved instead. When kernels are compiled ahead of time,
        all examples are solved in any case.
    verify : callable, optional
        Measures a finished mechanism against a statement and returns the design, or None if it cannot be driven. It is
        used to measure how far designs of a relaxed statement are from the original one.
    nearer : callable, optional
        Continues designs of a looser statement to designs of a stricter one, in a fraction of the time of a search. It
        is used to approach a limit that cannot be reached. Returns None for statements that it does not support; these
        are solved by a search.
    nearly : callable, optional
        Measures a finished mechanism, for example a rounded one, that meets only approximately the targets that designs
        must meet exactly. Takes the statement, an exact design and the mechanism, and returns the design of the
        mechanism, or None if it cannot be driven.
    usable : callable, optional
        Returns the statement of a second search for sound designs, from a statement with their limits as constraints;
        None if no search is worth while. Without it, no second search is made.
    gallery : tuple of NamedExample
        Examples with their names, in the order of the statement's examples.
    brief : callable, optional
        Whether solving a statement usually takes a fraction of a second. The service runs such jobs alongside long
        searches. By default no statement is brief.
    ratio_check : RatioCheck, optional
        For kinds with an optional ``tolerance`` of a speed ratio. If no design is within the tolerance, the nearest
        miss is the most accurate design.
    easing : TaskEasing, optional
        For kinds whose task can be eased. If no design fulfils the task, the nearest miss is found by bisection of the
        share of the task. Needs ``verify``.
    is_first_loaded : bool
        Whether a new worker solves the first example before it takes jobs, because this kind is requested most.
    list_warm_up_problems : callable, optional
        Returns statements, runnable like the examples, whose kernels no example calls. They are solved when kernels are
        compiled ahead of time.
    columns : TableColumns, optional
        Columns of a table with a header that states a problem of this kind.
    """

    name: str
    problem: type[P]
    result: type[R]
    solve: Callable[[P, Progress], R]
    warm_up: Callable[[], None] | None = None
    verify: Callable[[P, Any], Any] | None = None
    nearer: Callable[[P, Sequence[Any], Progress], Sequence[Any] | None] | None = None
    brief: Callable[[P], bool] = return_false
    nearly: Callable[[P, Any, Any], Any] | None = None
    usable: Callable[[P], P | None] | None = None
    ratio_check: RatioCheck | None = None
    easing: TaskEasing[P] | None = None
    is_first_loaded: bool = False
    list_warm_up_problems: Callable[[], list[JsonObject]] = list_no_problems
    columns: TableColumns | None = None
    gallery: tuple[NamedExample, ...] = field(kw_only=True)

    @property
    def mechanisms(self) -> list[str]:
        """Types of mechanisms that designs of this kind can have, in the order of the models of its answer."""
        designs = collect_models(self.result.model_fields["designs"].annotation)
        return [name for design in designs for name in list_mechanism_types(design)]

    @property
    def metrics(self) -> list[str]:
        """Names of the metrics of designs of this kind, in the order of the models of its answer."""
        designs = collect_models(self.result.model_fields["designs"].annotation)
        measured = [model for design in designs for model in collect_models(design.model_fields["metrics"].annotation)]
        named = [field.alias or name for model in measured for name, field in model.model_fields.items()]
        # Designs of different models share metrics; list each name once.
        return list(dict.fromkeys(named))

    @property
    def examples(self) -> list[JsonObject]:
        """Runnable statements, as a client would post them; the first is the simplest."""
        schema_extra = self.problem.model_config["json_schema_extra"]
        assert isinstance(schema_extra, dict)
        stated = schema_extra["examples"]
        assert isinstance(stated, list)
        return [statement for statement in stated if isinstance(statement, dict)]


AnyKind = Kind[Any, Any]
"""A kind of problem with any statement and any answer."""
