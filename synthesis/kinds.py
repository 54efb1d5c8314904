"""The kinds of problems: how each is stated, how it is answered, and which solver does it.

A new kind is one line here, beside its models in :mod:`synthesis.problems` and :mod:`synthesis.designs` and its solver.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple, Union

from pydantic import Discriminator, Tag, TypeAdapter

from synthesis.designs import (
    CamResult,
    DwellResult,
    FunctionResult,
    GearboxResult,
    GearTrainResult,
    LayshaftResult,
    MotionResult,
    ParallelMotionResult,
    PathResult,
    PlanetaryResult,
    QuickReturnResult,
    Result,
    SteeringResult,
    StraightLineResult,
)
from synthesis.problems import (
    CamProblem,
    DwellProblem,
    FunctionProblem,
    GearboxProblem,
    GearTrainProblem,
    LayshaftProblem,
    MotionProblem,
    ParallelMotionProblem,
    PathProblem,
    PlanetaryProblem,
    QuickReturnProblem,
    StatedProblem,
    SteeringProblem,
    StraightLineProblem,
)

Progress = Callable[[float, str], None]
"""Called with the fraction done, 0 to 1, and a short message."""


class Kind(NamedTuple):
    """One kind of problem; ``solver``, imported when it is needed, is ``module:function`` of problem and progress."""

    problem: type[StatedProblem]
    result: type[Result[Any]]
    solver: str


KINDS: dict[str, Kind] = {
    "motion": Kind(MotionProblem, MotionResult, "synthesis.motion.solver:solve_motion"),
    "path": Kind(PathProblem, PathResult, "synthesis.path.solver:solve_path"),
    "quick_return": Kind(QuickReturnProblem, QuickReturnResult, "synthesis.quick_return.solver:solve_quick_return"),
    "straight_line": Kind(
        StraightLineProblem, StraightLineResult, "synthesis.straight_line.solver:solve_straight_line"
    ),
    "steering": Kind(SteeringProblem, SteeringResult, "synthesis.steering.solver:solve_steering"),
    "dwell": Kind(DwellProblem, DwellResult, "synthesis.dwell.solver:solve_dwell"),
    "parallel_motion": Kind(
        ParallelMotionProblem, ParallelMotionResult, "synthesis.parallel_motion.solver:solve_parallel_motion"
    ),
    "gear_train": Kind(GearTrainProblem, GearTrainResult, "synthesis.gear_train.solver:solve_gear_train"),
    "planetary_train": Kind(
        PlanetaryProblem, PlanetaryResult, "synthesis.planetary_train.solver:solve_planetary_train"
    ),
    "gearbox": Kind(GearboxProblem, GearboxResult, "synthesis.gearbox.solver:solve_gearbox"),
    "layshaft_gearbox": Kind(
        LayshaftProblem, LayshaftResult, "synthesis.layshaft_gearbox.solver:solve_layshaft_gearbox"
    ),
    "function": Kind(FunctionProblem, FunctionResult, "synthesis.function.solver:solve_function"),
    "cam": Kind(CamProblem, CamResult, "synthesis.cam.solver:solve_cam"),
}
"""Every kind of problem by its name."""


def _tag(statement: Any) -> str | None:
    kind = statement.get("kind") if isinstance(statement, dict) else getattr(statement, "kind", None)
    return f"<{kind}>" if isinstance(kind, str) and kind in KINDS else None


if TYPE_CHECKING:
    Problem = StatedProblem
else:
    _members = tuple(Annotated[kind.problem, Tag(f"<{name}>")] for name, kind in KINDS.items())
    Problem = Annotated[
        Union[_members],  # noqa: UP007  (made of a list)
        Discriminator(
            _tag,
            custom_error_type="unknown_kind",
            custom_error_message=f"kind must be given and be one of: {', '.join(KINDS)}",
        ),
    ]
    """Any problem; the field ``kind`` tells which."""


def parse_problem(statement: dict[str, Any]) -> Problem:
    """The problem of a JSON-like statement; raises pydantic's ValidationError for an ill-formed one."""
    return _PROBLEM.validate_python(statement)


def examples(kind: str) -> list[dict[str, Any]]:
    """The runnable examples of a kind, as a client would post them."""
    schema_extra = KINDS[kind].problem.model_config["json_schema_extra"]
    assert isinstance(schema_extra, dict)
    found = schema_extra["examples"]
    assert isinstance(found, list)
    return [one for one in found if isinstance(one, dict)]


def example(kind: str) -> dict[str, Any]:
    """The first of them."""
    return examples(kind)[0]


_PROBLEM: TypeAdapter[Problem] = TypeAdapter(Problem)
