"""The problem of trains in series: a speed ratio that one train alone does not reach."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Annotated, Literal

from pydantic import ConfigDict, Field

from kinematics.message import compose
from synthesis.kinds.train_series.units import Unit, Units, estimate_train_count, find_unit_contradictions
from synthesis.model.gears.ratio_target import RatioTarget, parse_decimal, parse_target
from synthesis.model.gears.request import ExactRatio
from synthesis.model.json_object import JsonObject
from synthesis.model.problem import Contradiction, ProblemBase

MAX_PLANETARY_TRAINS = 50_000_000
"""Maximum number of trains of a planetary unit, by its independent tooth numbers; most of them are not sound."""

MAX_ORDINARY_TRAINS = 5_000_000
"""Maximum number of trains of a unit of ordinary gears: all of them are kept in memory."""

MAX_LARGER_HALF, MAX_SMALLER_HALF = 2_000_000_000, 100_000_000
"""Maximum number of series of the units on the larger and on the smaller side of the search: minutes at worst."""

EXAMPLE_UNIT: JsonObject = {
    "type": "planetary_train",
    "arrangement": "simple",
    "input": "sun",
    "output": "carrier",
    "fixed": "ring",
    "teeth": {"min": 17, "max": 60, "ring_max": 130},
    "module": 2.0,
}


class TrainSeriesProblem(ProblemBase):
    """Trains in series: two to four trains, each driving the next, for a speed ratio; proven to be the best.

    Every unit has its own constraints and its own fixed member. All trains of all units are covered in exact
    arithmetic, so that an empty answer is a proof.
    """

    model_config = ConfigDict(
        title="Trains in series",
        json_schema_extra={
            "examples": [
                {
                    "kind": "train_series",
                    "ratio": 25,
                    "units": [EXAMPLE_UNIT, EXAMPLE_UNIT],
                    "tolerance": 0.0,
                    "max_designs": 3,
                },
                {
                    "kind": "train_series",
                    "ratio": 333,
                    "units": [EXAMPLE_UNIT, EXAMPLE_UNIT, EXAMPLE_UNIT],
                    "max_designs": 3,
                },
                {
                    "kind": "train_series",
                    "ratio": -40,
                    "units": [{"type": "gear_train", "teeth": {"min": 18, "max": 100}, "module": 1.5}, EXAMPLE_UNIT],
                    "tolerance": 1e-3,
                    "rank_by": "size",
                    "max_designs": 3,
                },
            ]
        },
    )

    kind: Literal["train_series"]
    ratio: ExactRatio = Field(
        description="Input speed of the first unit over output speed of the last, negative for opposite directions: a "
        'number or an exact expression such as "127/50", "pi", "-sqrt(2)".'
    )
    units: Units = Field(
        description="The trains, from the input on: problems of planetary_train or gear_train with `type` in place "
        "of `kind`, without ratio, tolerance and ranking. Equal units may change places: only the series with the "
        "larger "
        "ratio first is listed."
    )
    tolerance: Annotated[float, Field(strict=True, ge=0.0, lt=1.0)] | None = Field(
        default=None, description="Maximum relative error of the ratio. Default: the best possible."
    )
    rank_by: Literal["error", "size"] = Field(
        default="error",
        description="`error`: the nearest first, and the smallest of equally near ones. `size`: the smallest series "
        "within the tolerance first, and the nearest of equally small ones. Size is the number of teeth of all units, "
        "with one copy of every gear.",
    )

    @property
    def sign(self) -> int:
        """Direction: +1 same, −1 opposite."""
        return parse_target(self.ratio)[0]

    @property
    def target(self) -> RatioTarget:
        """Magnitude of the requested ratio, exact."""
        return parse_target(self.ratio)[1]

    @property
    def exact_tolerance(self) -> Fraction | None:
        """The tolerance as the decimal that was written."""
        return None if self.tolerance is None else parse_decimal(self.tolerance)

    @property
    def first_equal_units(self) -> list[int]:
        """For every unit the first unit that is equal to it."""
        return [self.units.index(unit) for unit in self.units]

    @property
    def combinations(self) -> int:
        """Estimated maximum number of series of a consistent problem."""
        return math.prod(estimate_train_count(unit, self.length_unit) for unit in self.units)

    def find_contradictions(self) -> list[Contradiction]:
        """Return errors of the units, a ranking that needs a tolerance, and searches that would take hours."""
        faults = [
            Contradiction(f"/units/{k}{fault.path}", fault.detail)
            for k, unit in enumerate(self.units)
            for fault in find_unit_contradictions(unit, self.length_unit)
        ]
        if self.rank_by == "size" and self.tolerance is None:
            faults.append(Contradiction("/tolerance", compose("train_series-size-needs-tolerance")))
        return faults or self._check_extent()

    def _check_extent(self) -> list[Contradiction]:
        counts = [estimate_train_count(unit, self.length_unit) for unit in self.units]
        faults = []
        for k, (unit, count) in enumerate(zip(self.units, counts, strict=True)):
            most, excess = (
                (MAX_ORDINARY_TRAINS, "train_series-ordinary-unit-too-large")
                if unit.type == "gear_train"
                else (MAX_PLANETARY_TRAINS, "train_series-planetary-unit-too-large")
            )
            if count > most:
                detail = compose(excess, trains=f"{count:.0e}", limit=f"{most:.0e}")
                faults.append(Contradiction(f"/units/{k}/teeth", detail))
        # The search needs one split of the units with both sides within their limits.
        if not faults and not any(
            least <= MAX_SMALLER_HALF and most <= MAX_LARGER_HALF for least, most in map(sorted, _list_halves(counts))
        ):
            detail = compose("train_series-too-many-series", series=f"{math.prod(counts):.0e}")
            faults.append(Contradiction("/units", detail))
        return faults


def _list_halves(counts: list[int]) -> list[tuple[int, int]]:
    """List the numbers of series of some units and of the others, for every split."""
    n = len(counts)
    return [
        (
            math.prod(counts[k] for k in range(n) if chosen >> k & 1),
            math.prod(counts[k] for k in range(n) if not chosen >> k & 1),
        )
        for chosen in range(1, 1 << (n - 1))
    ]


__all__ = ["TrainSeriesProblem", "Unit"]
