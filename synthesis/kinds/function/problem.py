"""Function generation: a linkage whose output follows its input by a function or by pairs."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from functools import lru_cache
from typing import Annotated, Any, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import ConfigDict, Field

from kinematics.arrays import Real
from kinematics.message import compose
from synthesis.kinds.function.statement.functions import FunctionStatement
from synthesis.kinds.function.statement.mechanism_types import (
    MULTILOOP_TYPES,
    SIXBARS,
    Mechanisms,
    Multiloop,
    Sixbar,
    check_types,
    list_unsupported,
)
from synthesis.model.dimension import ANGLE, OUTPUT
from synthesis.model.linkage.problem import Constraints, LinkageProblem
from synthesis.model.linkage.type_choice import refuse_class, remove_unclassed, select_searched_types
from synthesis.model.manufacture.request import ManufactureTask, RequiredTargets, list_fixed_coordinates
from synthesis.model.problem import (
    MAX_MAGNITUDE,
    Contradiction,
    Count,
    Degrees,
    Flag,
    Interval,
    Number,
    Point,
    PositiveNumber,
    Statement,
)

FULL_TURN = 360.0

MAX_RANGE = 359.0
"""Maximum range of an input or output, degrees: at a full turn the first value would coincide with the last."""

MIN_RANGE = 0.01
"""Minimum range, degrees; below it there is no motion."""

INPUT_TOLERANCE = 1e-6
"""Tolerance for equal inputs, degrees: no linkage distinguishes closer ones."""

BASE_PAIR_COUNT = 3
"""Number of pairs that the three proportions alone can meet; each open zero or scale adds one."""

MAX_EXACT_PAIRS = 7

MAX_SIXBAR_PAIRS = 8
"""Maximum number of pairs that the search of sixbars and eightbars meets exactly. Watt II has nine parameters, other
sixbars eleven, eightbars more."""

UNIT_SCALE_TOLERANCE = 1e-7
"""Tolerance for a scale of 1, which leaves the pairs unchanged."""

WATT_2_PAIR_COUNT = 9
"""Number of pairs that leave finitely many Watt II sixbars, all of which are computed."""

REQUIRED_POINT_COUNT = 41
"""Number of points of the range, including its ends, at which a manufactured approximation must match the function."""


class Pair(Statement):
    """A value of the input, degrees, and the corresponding value of the output, degrees or length units."""

    input: Degrees
    output: Annotated[Number, OUTPUT]


class Zeros(Statement):
    """Zeros: link angles at the value 0, degrees from the line O2 → O4, or from the slide's direction.

    For a slider: its position along its line, from the foot of the fixed pivot, in length units. Null leaves it open.
    """

    input: Degrees | None = None
    output: Annotated[Number, OUTPUT] | None = None


class Scales(Statement):
    """Scales: rotation of the link (or travel of the slider) per unit of the value. Null leaves a scale open."""

    input: Annotated[PositiveNumber, ANGLE] | None = None
    output: Annotated[PositiveNumber, OUTPUT] | None = None


class GroundPivots(Statement):
    """The fixed pivots O2 (input) and O4 (output)."""

    input: Point
    output: Point


class FunctionConstraints(Constraints):
    """Constraints of a function generator; the default maximum link ratio is 100.

    For many functions the error decreases without bound as the links get longer, so the limit is part of the task.
    """

    max_link_ratio: Annotated[float, Field(strict=True, ge=1.0, le=MAX_MAGNITUDE)] | None = Field(
        default=100.0,
        description="Maximum ratio of the longest to the shortest link. Default 100; left open: no limit.",
    )


@lru_cache(maxsize=64)
def _unwrap_pairs(pairs: tuple[tuple[float, float], ...], slides: bool) -> Real:
    """Unwrap the pairs' angles; cached and read-only, because every measured linkage needs them several times."""
    values = np.array(pairs)
    onward = np.unwrap(values[:, 0], period=FULL_TURN)
    # Inputs given in order are kept as they are: unwrapping could break a range of more than half a turn.
    if not _is_monotonic(values[:, 0]) and _is_monotonic(onward):
        values[:, 0] = onward
    if not slides:
        values[:, 1] = np.unwrap(values[:, 1], period=FULL_TURN)
    values.flags.writeable = False
    return values


def _is_monotonic(values: Real) -> bool:
    steps = np.diff(values)
    return bool(np.all(steps > 0.0) or np.all(steps < 0.0))


class FunctionProblem(LinkageProblem):
    """Function generation: the output of a fourbar, a slider-crank or a sixbar follows its input.

    The task is a list of input-output pairs, or a function over an interval with the ranges of input and output. A
    linkage meets 2 to 5 pairs exactly, or 6 or 7 with open scales. Otherwise it approximates the pairs, or the whole
    function, with the smallest mean square or maximum structural error, measured on the finished linkage.
    """

    model_config = ConfigDict(
        title="Function generation",
        json_schema_extra={
            "examples": [
                {
                    "kind": "function",
                    "function": {"name": "power", "exponent": 1.5, "x": [1.0, 4.0]},
                    "input_range": 90.0,
                    "output_range": 90.0,
                    "criterion": "minimax",
                    "constraints": {"max_link_ratio": 10.0, "min_transmission_angle": 30.0},
                    "max_designs": 3,
                },
                {
                    "kind": "function",
                    "pairs": [
                        {"input": 40.0, "output": 70.0},
                        {"input": 45.0, "output": 76.0},
                        {"input": 60.0, "output": 90.0},
                    ],
                },
                {
                    "kind": "function",
                    "mechanism": "slider_crank",
                    "function": {"name": "logarithm", "x": [1.0, 10.0]},
                    "input_range": 80.0,
                    "output_range": 50.0,
                    "precision_points": 4,
                },
                {
                    "kind": "function",
                    "function": {"name": "logarithm", "x": [1.0, 10.0]},
                    "input_range": 60.0,
                    "output_range": 60.0,
                    "mechanisms": ["watt_2"],
                    "constraints": {"max_link_ratio": 10.0, "min_transmission_angle": 30.0},
                    "max_designs": 2,
                },
            ]
        },
    )

    kind: Literal["function"]
    pairs: Annotated[list[Pair], Field(min_length=2, max_length=200)] | None = None
    function: FunctionStatement | None = None
    input_range: Degrees | tuple[Degrees, Degrees] | None = Field(
        default=None,
        description="Rotation of the input while x runs over its interval, degrees, counter-clockwise positive; or its "
        "values at both ends. Null leaves it open.",
    )
    output_range: Annotated[Number | tuple[Number, Number] | None, OUTPUT] = Field(
        default=None,
        description="The same for the output: degrees, or length units for a slider. Positive if the output starts "
        "counter-clockwise, whether y rises or falls. If left open, its direction is open too.",
    )
    either_direction: Flag = Field(default=False, description="Also try the opposite direction of the output.")
    range_limits: Annotated[Interval, ANGLE] = Field(
        default=(30.0, 150.0), description="Limits of ranges that are left open, degrees."
    )
    scales: Scales | None = Field(
        default=None,
        description="Scales of pairs. Omitted: 1 for up to five exact pairs; for six pairs the output's scale is open, "
        "for seven both are.",
    )
    scale_limits: Interval = Field(default=(0.25, 4.0), description="Limits of scales that are left open.")
    zeros: Zeros | Literal["auto"] | None = Field(
        default="auto",
        description="Zeros of input and output; both may be left open. `auto` reads two or three pairs as angles of a "
        "link, or its extension, from the ground line, and opens the zeros if no such linkage satisfies all "
        "constraints. In all other cases `auto` leaves them open.",
    )
    precision_points: Annotated[Count, Field(ge=2, le=WATT_2_PAIR_COUNT)] | None = Field(
        default=None,
        description="Number of points at which the function is met exactly. Nine points are possible only for watt_2 "
        "sixbars, all of which are computed.",
    )
    spacing: Literal["chebyshev", "equal"] = Field(default="chebyshev", description="Spacing of the precision points.")
    mechanism: Literal["fourbar", "slider_crank"] = "fourbar"
    mechanisms: Mechanisms | None = Field(
        default=None,
        description="Types of linkage to search. auto: fourbars, sixbars if no fourbar is feasible and accurate, and "
        "eightbars if all of these miss the function by far. Omitted: the type given by `mechanism`.",
    )
    criterion: Literal["precision", "least_squares", "minimax"] | None = Field(
        default=None,
        description="Approximation criterion. Omitted: `precision` if precision points are given, or if all pairs (at "
        "most eight) can be met exactly; otherwise `minimax`. With `precision`, nine pairs and `watt_2` alone, all "
        "sixbars that meet the pairs are computed.",
    )
    fixed_pivots: GroundPivots | None = Field(
        default=None,
        description="Fixed pivots of a fourbar; for a slider-crank `output` is a point towards which the slide points. "
        "Omitted: position, direction and size (for a slider-crank position and direction) are chosen to satisfy "
        "regions and length limits; O2 at the origin and the ground line along +x if that is possible.",
    )
    constraints: FunctionConstraints = FunctionConstraints()

    @property
    def aim(self) -> Literal["precision", "least_squares", "minimax"]:
        """The criterion, with its default if omitted."""
        if self.criterion is not None:
            return self.criterion
        if self.pairs is not None:
            # Eight is the limit of the search; nine exact pairs need an explicit request.
            return "precision" if len(self.pairs) <= min(self.max_exact_pairs, MAX_SIXBAR_PAIRS) else "minimax"
        return "precision" if self.precision_points is not None else "minimax"

    @property
    def sixbars(self) -> tuple[Sixbar, ...]:
        """The types of sixbar to search."""
        return remove_unclassed(
            select_searched_types(self.mechanisms, SIXBARS, list_unsupported(self)), refuse_class(self.constraints)
        )

    @property
    def simple_problem(self) -> FunctionProblem | None:
        """The same problem restricted to the fourbars or slider-cranks in ``mechanisms``; None if there are none."""
        return None if self.only_multiloop else self.model_copy(update={"mechanisms": None})

    @property
    def has_eightbars(self) -> bool:
        """Whether eightbars may be searched; for ``auto`` only for approximations, which others may miss by far."""
        if self.mechanisms == "auto" and self.aim == "precision":
            return False
        return bool(select_searched_types(self.mechanisms, ("eightbar",), list_unsupported(self)))

    def restrict_to(self, types: Sequence[Multiloop]) -> FunctionProblem:
        """Return the same problem for sixbars or eightbars alone, with the same criterion and open zeros."""
        return self.model_copy(update={"mechanisms": list(types), "criterion": self.aim, "zeros": None})

    @property
    def only_multiloop(self) -> bool:
        """Whether only sixbars and eightbars are requested."""
        return isinstance(self.mechanisms, list) and set(self.mechanisms) <= set(MULTILOOP_TYPES)

    @property
    def limits_place(self) -> bool:
        """Whether the place or the size of the linkage is limited."""
        limits = self.constraints
        chosen = (
            limits.fixed_pivot_region,
            limits.moving_pivot_region,
            limits.link_length,
            self.fixed_pivots,
            self.space,
        )
        return any(one is not None for one in chosen)

    @property
    def has_given_zeros(self) -> bool:
        """Whether a zero is given; zeros are measured from the ground line of a fourbar."""
        return isinstance(self.zeros, Zeros) and (self.zeros.input, self.zeros.output) != (None, None)

    @property
    def slides(self) -> bool:
        """Whether the output is a slider."""
        return self.mechanism == "slider_crank"

    @property
    def manufacture_task(self) -> ManufactureTask | str:
        """Manufacturing analysis: the targets are output positions at given inputs of the dial."""
        count = len(self.precision_shares) if self.aim == "precision" else REQUIRED_POINT_COUNT
        return ManufactureTask(self.slides, not self.slides, False, count if self.pairs is None else len(self.pairs))

    @property
    def guides_a_point(self) -> bool:
        """Whether the linkage guides a coupler point P; never for a function generator."""
        return False

    def measure_error(self, design: Any) -> float:
        """Return the error by the criterion, radians or a share of the range; 0 for pairs that are met exactly."""
        if self.aim == "precision" and self.function is None:
            return 0.0
        error = design.structural_error.rms if self.aim == "least_squares" else design.structural_error.max
        # With an open range a smaller output would otherwise always look more accurate.
        if self.slides or self.is_output_open:
            return float(error / abs(design.metrics.output_range))
        return math.radians(error)

    @property
    def error_unit(self) -> tuple[float, str]:
        """Errors of a rotating output are written in degrees."""
        return super().error_unit if self.slides or self.is_output_open else (math.degrees(1.0), "°")

    def classify_design(self, design: Any) -> int:
        """Return 0 for a design on the pairs' own scales, 1 for one with other scales."""
        off = [abs(dial.scale - 1.0) for dial in (design.dials.input, design.dials.output)]
        return int(self.pairs is not None and max(off) > UNIT_SCALE_TOLERANCE)

    def measure_target_errors(
        self, design: Any, _counted: NDArray[np.bool_] | None = None
    ) -> tuple[float | None, float | None]:
        """Return the maximum structural error as a distance, or as an angle in degrees."""
        greatest = design.metrics.max_structural_error
        return (greatest, None) if self.slides else (None, greatest)

    def build_required_targets(self, design: Any) -> RequiredTargets:
        """Return the pairs, precision points, or samples of the range that a manufactured design must keep."""
        values = self._list_required_inputs()
        if self.pairs is not None:
            outputs = self.values[:, 1]
        else:
            assert self.function is not None
            outputs = self.function.values(values)
        dials = design.dials
        # Convert dial readings to link angles or slider positions, as measured on the linkage.
        inputs, places = (
            dial.place + dial.scale * (shown - dial.at)
            for dial, shown in ((dials.input, values), (dials.output, outputs))
        )
        pivots = self.fixed_pivots
        kept = list_fixed_coordinates((None, None) if pivots is None else (pivots.input, pivots.output))
        if self.slides:
            # A slider's dial is fixed to the frame, so its targets are positions and not angles.
            return RequiredTargets(
                np.radians(inputs), travels=places, free=False, size=float(np.ptp(places)) or 1.0, kept=kept
            )
        zeros = self.zero_choice
        return RequiredTargets(
            np.radians(inputs),
            angles=np.radians(places),
            free=False,
            on_ground=(zeros[0] is not None, zeros[1] is not None),
            kept=kept,
        )

    def _list_required_inputs(self) -> Real:
        """Return the input values at which a manufactured linkage must match its target."""
        if self.pairs is not None:
            return self.values[:, 0]
        assert self.function is not None
        low, high = self.function.interval
        shares = self.precision_shares if self.aim == "precision" else np.linspace(0.0, 1.0, REQUIRED_POINT_COUNT)
        return np.asarray(low + (high - low) * shares)

    @property
    def from_ground(self) -> bool:
        """Whether pairs are first read as angles of a link, or its extension, from the ground line."""
        few = self.pairs is not None and len(self.pairs) <= BASE_PAIR_COUNT
        return self.zeros == "auto" and few and not self.only_multiloop

    @property
    def zero_choice(self) -> tuple[float | None, float | None]:
        """Zeros of input and output; None for an open one."""
        if self.from_ground:
            return 0.0, 0.0
        return (self.zeros.input, self.zeros.output) if isinstance(self.zeros, Zeros) else (None, None)

    @property
    def max_exact_pairs(self) -> int:
        """Maximum number of pairs that can be met exactly: the number of open proportions, zeros and scales."""
        if self.only_multiloop:
            return WATT_2_PAIR_COUNT if self.only_watt_2 else MAX_SIXBAR_PAIRS
        zeros = [self.zeros.input, self.zeros.output].count(None) if isinstance(self.zeros, Zeros) else 2
        if self.function is not None:
            free = [self.input_range, self.output_range].count(None)
        elif self.scales is not None:
            free = [self.scales.input, self.scales.output].count(None)
        else:
            # A slider's output scale only changes the size of the linkage, so it is not a degree of freedom.
            free = 1 if self.slides else 2
        return BASE_PAIR_COUNT + zeros + free

    @property
    def determines_watts(self) -> bool:
        """Whether nine pairs must be met exactly by Watt II sixbars, of which there are finitely many."""
        count = self.precision_points if self.pairs is None else len(self.pairs)
        return self.only_watt_2 and self.aim == "precision" and count == WATT_2_PAIR_COUNT

    @property
    def follows_watts(self) -> bool:
        """Whether Watt II sixbars approximate nine or more pairs, any nine of which leave finitely many sixbars."""
        many = self.pairs is not None and len(self.pairs) >= WATT_2_PAIR_COUNT
        return self.only_watt_2 and self.aim != "precision" and many and None not in self.scale_choice

    @property
    def only_watt_2(self) -> bool:
        """Whether only Watt II sixbars are requested."""
        return self.only_multiloop and self.sixbars == ("watt_2",) and not self.has_eightbars

    def span(self, side: Literal["input", "output"]) -> float | None:
        """Return the signed range of a side, degrees or length units; None if it is open."""
        stated = self.input_range if side == "input" else self.output_range
        if isinstance(stated, tuple):
            return stated[1] - stated[0]
        return stated

    def first_value(self, side: Literal["input", "output"]) -> float:
        """Return the value of a side at the start of its range: 0 unless values at both ends are given."""
        stated = self.input_range if side == "input" else self.output_range
        return stated[0] if isinstance(stated, tuple) else 0.0

    @property
    def scale_choice(self) -> tuple[float | None, float | None]:
        """Scales of pairs; None for an open one."""
        if self.scales is not None:
            return self.scales.input, self.scales.output
        if self.aim != "precision" or self.pairs is None or self.only_multiloop:
            return 1.0, 1.0
        zeros = sum(zero is None for zero in self.zero_choice)
        # Each further pair needs one more open parameter; the output's scale is opened first.
        beyond = len(self.pairs) - BASE_PAIR_COUNT - zeros
        if beyond <= 0:
            return 1.0, 1.0
        if self.slides:
            # The input's scale is the only one that changes the shape.
            return None, 1.0
        return (1.0, None) if beyond == 1 else (None, None)

    @property
    def values(self) -> Real:
        """The pairs as an array, shape (n, 2), with unwrapped angles.

        Inputs are unwrapped along the shorter way from pair to pair if that makes them monotonic; angles of the output
        always are.
        """
        assert self.pairs is not None
        return _unwrap_pairs(tuple((pair.input, pair.output) for pair in self.pairs), self.slides)

    @property
    def is_output_open(self) -> bool:
        """Whether the search may choose the output's range, or the scale of its values."""
        if self.pairs is None:
            return self.span("output") is None and self.range_limits[0] < self.range_limits[1]
        low, high = self.open_scale(1)
        return self.scale_choice[1] is None and low < high

    def open_scale(self, side: int) -> tuple[float, float]:
        """Open the scale of the input (0) or output (1): return its limits, with which no link makes a full turn."""
        low, high = self.scale_limits
        # Values times scale must stay below a full turn.
        most = MAX_RANGE / float(np.ptp(self.values[:, side]))
        return low, max(min(high, most), low)

    @property
    def precision_shares(self) -> Real:
        """Positions of the precision points, as shares of the interval of x (Chebyshev or equal spacing)."""
        n = self.precision_points or BASE_PAIR_COUNT + 2
        if self.spacing == "equal":
            return np.linspace(0.0, 1.0, n)
        # Chebyshev's zeros: they nearly equalize the extremes of the error between the points.
        return np.asarray(0.5 - 0.5 * np.cos((2.0 * np.arange(n) + 1.0) * math.pi / (2.0 * n)))

    def find_contradictions(self) -> list[Contradiction]:
        """Return errors of pairs, function and ranges, and contradictory constraints."""
        found = [
            *self._check_statement(),
            *self._check_zeros_and_scales(),
            *self.find_contradicting_constraints(),
            *check_types(self),
        ]
        if self.slides:
            found += self.constraints.find_class_contradictions((), compose("function-class-needs-fourbar"))
        if self.fixed_pivots is not None and self.fixed_pivots.input == self.fixed_pivots.output:
            found.append(Contradiction("/fixed_pivots/output", compose("function-pivots-coincide")))
        if self.range_limits[0] < MIN_RANGE or self.range_limits[1] > MAX_RANGE:
            detail = compose("function-range-limits-outside", lowest=f"{MIN_RANGE}", highest=f"{MAX_RANGE}")
            found.append(Contradiction("/range_limits", detail))
        if self.scale_limits[0] <= 0.0:
            found.append(Contradiction("/scale_limits", compose("function-scales-not-positive")))
        return found

    def _check_statement(self) -> Iterator[Contradiction]:
        # Later checks need exactly one of the two.
        if (self.pairs is None) == (self.function is None):
            where = "/pairs" if self.pairs is None else "/function"
            yield Contradiction(where, compose("function-pairs-or-function"))
            return
        if self.pairs is not None:
            for field in ("input_range", "output_range", "precision_points"):
                if getattr(self, field) is not None:
                    yield Contradiction(f"/{field}", compose("function-field-is-for-functions"))
            yield from self._check_pairs(self.pairs)
            return
        assert self.function is not None
        if self.scales is not None:
            yield Contradiction("/scales", compose("function-scales-are-for-pairs"))
        if self.criterion not in (None, "precision") and self.precision_points is not None:
            detail = compose("function-criterion-uses-no-points", criterion=self.criterion)
            yield Contradiction("/precision_points", detail)
        faults = list(self.function.find_errors())
        yield from (Contradiction(f"/function{fault.path}", fault.detail) for fault in faults)
        if not faults:
            yield from self._check_ranges()

    def _check_pairs(self, pairs: list[Pair]) -> Iterator[Contradiction]:
        turned = [float(value) for value in self.values[:, 0]]
        for k, later in enumerate(turned):
            for j, earlier in enumerate(turned[:k]):
                # Inputs that differ by full turns are the same position of the link.
                if abs(math.remainder(later - earlier, FULL_TURN)) <= INPUT_TOLERANCE:
                    yield Contradiction(f"/pairs/{k}/input", compose("function-inputs-equal", pair=j))
                    return
        if max(turned) - min(turned) > MAX_RANGE:
            yield Contradiction("/pairs", compose("function-inputs-cover-turn"))
            return
        steps = np.sign(np.diff(turned))
        wrong = np.flatnonzero(steps != steps[0])
        # Without order, the input may oscillate between the pairs.
        if self.constraints.in_order and len(wrong):
            detail = compose("function-inputs-unordered")
            yield Contradiction(f"/pairs/{wrong[0] + 1}/input", detail)
        moved = [float(value) for value in self.values[:, 1]]
        if not self.slides and max(moved) - min(moved) > MAX_RANGE:
            yield Contradiction("/pairs", compose("function-outputs-cover-turn"))
        # Angles are compared absolutely, lengths relative to their size.
        if max(moved) - min(moved) <= INPUT_TOLERANCE * (max(map(abs, moved)) if self.slides else 1.0):
            yield Contradiction("/pairs", compose("function-output-rests"))
        if self.aim == "precision" and len(pairs) > self.max_exact_pairs:
            reason = "function-too-many-sixbar-pairs" if self.only_multiloop else "function-too-many-pairs"
            yield Contradiction("/pairs", compose(reason, count=self.max_exact_pairs))

    def _check_ranges(self) -> Iterator[Contradiction]:
        for side in ("input", "output"):
            span = self.span("input" if side == "input" else "output")
            if span is None:
                continue
            # A slider's range is a length, so limits in degrees do not apply.
            turns = side == "input" or not self.slides
            if turns and not MIN_RANGE <= abs(span) <= MAX_RANGE:
                detail = compose("function-range-outside", lowest=f"{MIN_RANGE}", highest=f"{MAX_RANGE}")
                yield Contradiction(f"/{side}_range", detail)
            elif span == 0.0:
                yield Contradiction(f"/{side}_range", compose("function-output-rests"))
        if self.slides and self.output_range is None:
            yield Contradiction("/output_range", compose("function-slider-range-missing"))
        if self.aim == "precision" and (self.precision_points or 0) > self.max_exact_pairs:
            reason = "function-too-many-sixbar-points" if self.only_multiloop else "function-too-many-points"
            yield Contradiction("/precision_points", compose(reason, count=self.max_exact_pairs))

    def _check_zeros_and_scales(self) -> Iterator[Contradiction]:
        if self.scales is not None and self.slides and self.scales.output is None:
            yield Contradiction("/scales/output", compose("function-slider-scale-missing"))
        if not self.determines_watts:
            return
        detail = compose("function-nine-pairs-need-it")
        for side in ("input", "output"):
            if self.scales is not None and getattr(self.scales, side) is None:
                yield Contradiction(f"/scales/{side}", detail)
            if self.function is not None and self.span(side) is None:
                yield Contradiction(f"/{side}_range", detail)
