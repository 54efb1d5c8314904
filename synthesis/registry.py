"""Registry of all kinds of problems, collected from their folders, and the union of their statements.

A new kind is one import and one entry here; see docs/development/adding-a-kind.md.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Union

from pydantic import BeforeValidator, ConfigDict, Discriminator, Tag, TypeAdapter
from pydantic_core import PydanticCustomError

from kinematics.message import compose
from synthesis.kinds import (
    balancing,
    cam,
    dwell,
    engine,
    flywheel,
    function,
    gear_train,
    gearbox,
    indexing,
    layshaft_gearbox,
    motion,
    parallel_motion,
    path,
    planetary_train,
    quick_return,
    spring_balancing,
    steering,
    straight_line,
    train_series,
)
from synthesis.model.json_object import JsonObject
from synthesis.model.kind import AnyKind
from synthesis.model.problem import ProblemBase

KINDS: dict[str, AnyKind] = {
    folder.KIND.name: folder.KIND
    for folder in (
        motion,
        path,
        quick_return,
        straight_line,
        steering,
        dwell,
        parallel_motion,
        gear_train,
        planetary_train,
        train_series,
        gearbox,
        layshaft_gearbox,
        function,
        cam,
        balancing,
        spring_balancing,
        flywheel,
        engine,
        indexing,
    )
}
"""Every kind of problem by name, in display order."""


def _tag_kind(statement: object) -> str | None:
    kind = statement.get("kind") if isinstance(statement, dict) else None
    if isinstance(statement, ProblemBase):
        kind = statement.kind
    # Brackets keep the tag apart from field names in error locations.
    return f"<{kind}>" if isinstance(kind, str) and kind in KINDS else None


def _require_kind(statement: object) -> object:
    """Refuse a statement without a known kind."""
    # The union itself could only refuse it by a text that is written at import, in one language.
    if _tag_kind(statement) is None:
        raise PydanticCustomError(
            "unknown_kind", "{message}", {"message": compose("synthesis-unknown-kind", kinds=", ".join(KINDS))}
        )
    return statement


if TYPE_CHECKING:
    Problem = ProblemBase
else:
    # Built from the registry, so that a new kind needs no change here; type checkers see the base class.
    _members = tuple(Annotated[kind.problem, Tag(f"<{name}>")] for name, kind in KINDS.items())
    Problem = Annotated[
        Union[_members],  # noqa: UP007  (made of a list)
        Discriminator(_tag_kind),
        BeforeValidator(_require_kind),
    ]
    """Any problem; its field ``kind`` determines its model."""


def parse_problem(statement: JsonObject) -> Problem:
    """Parse a JSON-like statement into a problem.

    Raises
    ------
    pydantic.ValidationError
        For an ill-formed statement.
    """
    return _PROBLEM.validate_python(statement)


def list_examples(kind: str) -> list[JsonObject]:
    """Return the runnable examples of a kind, as a client would post them."""
    return KINDS[kind].examples


def get_first_example(kind: str) -> JsonObject:
    """Return the first example of a kind."""
    return list_examples(kind)[0]


_PROBLEM: TypeAdapter[Problem] = TypeAdapter(Problem, config=ConfigDict(defer_build=True))
