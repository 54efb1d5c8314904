"""Problems of path generation: a linkage whose coupler point goes through points, or near them."""

from __future__ import annotations

import math
from functools import lru_cache
from itertools import pairwise
from typing import Annotated, Any, Literal, Self

import numpy as np
from pydantic import ConfigDict, Field, model_validator

from kinematics.arrays import Real
from kinematics.message import compose
from synthesis.kinds.path.statement.mechanism_types import (
    SIXBAR_TYPES,
    Mechanisms,
    Simple,
    Sixbar,
    find_mechanism_contradictions,
    find_unsupported,
    find_unsupported_unclassed,
    list_simple_types,
)
from synthesis.kinds.path.statement.stance import Stance, find_stance_errors
from synthesis.kinds.path.statement.start import StartFourbar, find_start_errors
from synthesis.model.dimension import LENGTH
from synthesis.model.linkage.problem import Constraints, LinkageProblem, Region
from synthesis.model.linkage.type_choice import UNCLASSED_SIXBAR, remove_unclassed, select_searched_types
from synthesis.model.manufacture.request import ManufactureTask, RequiredTargets, list_fixed_coordinates
from synthesis.model.problem import (
    Contradiction,
    Coordinate,
    Count,
    Degrees,
    Flag,
    Interval,
    Number,
    PartialPoint,
    PositiveLength,
    Statement,
)

POINT_TOLERANCE = 1e-9
"""Points closer than this share of the coordinates' size count as equal."""

ANGLE_TOLERANCE = 1e-9
"""Crank angles closer than this, in degrees modulo full turns, count as equal."""

MAX_EXACT_POINTS = {"fourbar": 9, "slider_crank": 8, "geared_fivebar": 11}
"""Maximum number of points that a linkage can meet exactly, in general: its number of dimensions without the gear
ratio."""

MAX_USABLE_ERROR = 0.02
"""Maximum error of a sound fit, as a share of the task's size, that precedes exact designs which are not sound."""

STRAY_SHARE = 0.01
"""Excursion, as a share of the task's size, up to which a curve does not count as straying between the points."""

MAX_GEAR_TURNS = 60
"""Maximum number of crank turns after which a geared fivebar must repeat, so that its whole motion can be driven."""

MAX_POINTS = 1000
"""Maximum number of points accepted; a curve that needs more is oversampled."""

MAX_LINK_DIAGONALS = 5.0
"""Maximum link length of a curve match if no limit is given, in diagonals of the box around the curve. Without a limit
fits tend to links that are many times longer without being better."""


class PathPoint(Statement):
    """A point of the path, in length units."""

    x: Coordinate
    y: Coordinate
    crank_angle: Degrees | None = Field(
        default=None, description="Angle of the crank where P is here, degrees; for prescribed timing."
    )
    tolerance: PositiveLength | None = Field(
        default=None,
        description="Maximum distance of P from this point, and of the traced curve from the line through the points "
        "near it. Give it for all points, or for none.",
    )

    @property
    def point(self) -> complex:
        """The point as a complex number."""
        return complex(self.x, self.y)


class CouplerPointLimits(Statement):
    """Allowed place of P on the coupler: along the line A → B, and across it to the left, from A, in length units."""

    along: Annotated[Interval, LENGTH] | None = None
    across: Annotated[Interval, LENGTH] | None = None


class PathConstraints(Constraints):
    """Constraints on a linkage, including limits specific to path generation."""

    input_pivot_region: Region | None = Field(default=None, description="Region of the input's fixed pivot.")
    coupler_point: CouplerPointLimits | None = None


class PathPivots(Statement):
    """Given fixed pivots; a pivot, or one of its coordinates, may be left open."""

    input: PartialPoint | None = None
    output: PartialPoint | None = None

    def count_given(self) -> int:
        """Return the number of given coordinates."""
        return sum(value is not None for pivot in (self.input, self.output) for value in pivot or ())

    @model_validator(mode="after")
    def _check_distinct(self) -> Self:
        if self.input is not None and self.input == self.output and None not in self.input:
            raise ValueError(compose("path-fixed-pivots-equal"))
        return self


class PathProblem(LinkageProblem):
    """Path generation: a fourbar whose coupler point goes exactly through points, or as near to them as possible.

    With *free* timing the input angles at the points are free: a fourbar can meet at most nine points. For nine, every
    fourbar is computed: all 1442 cognate triples, real and complex, from which the real ones are verified with both
    cognates and either fixed pivot as the input's. Fewer points leave freedom, which goes into the constraints and the
    ranking. With *prescribed* timing each point has its crank angle: at most five points can be met exactly, and for
    five every fourbar is found. More points are fitted by least squares.
    """

    model_config = ConfigDict(
        title="Path generation",
        json_schema_extra={
            "examples": [
                {
                    "kind": "path",
                    "points": [
                        {"x": 40.0, "y": 30.0},
                        {"x": 32.0, "y": 42.0},
                        {"x": 20.0, "y": 45.0},
                        {"x": 8.0, "y": 40.0},
                        {"x": 2.0, "y": 30.0},
                    ],
                    "rounds": 1,
                    "max_designs": 5,
                },
                {
                    "kind": "path",
                    "timing": "prescribed",
                    "points": [
                        {"x": -23.0, "y": 34.0, "crank_angle": 0.0},
                        {"x": -17.0, "y": 32.0, "crank_angle": 40.0},
                        {"x": -7.0, "y": 40.0, "crank_angle": 80.0},
                        {"x": 4.0, "y": 55.0, "crank_angle": 120.0},
                        {"x": 8.0, "y": 66.0, "crank_angle": 160.0},
                    ],
                },
                {
                    "kind": "path",
                    "timing": "prescribed",
                    "closed": True,
                    "points": [
                        {"x": 50.0, "y": 110.0, "crank_angle": 0.0},
                        {"x": 30.0, "y": 110.0, "crank_angle": 40.0},
                        {"x": 10.0, "y": 90.0, "crank_angle": 80.0},
                        {"x": 2.0, "y": 60.0, "crank_angle": 120.0},
                        {"x": 0.0, "y": 40.0, "crank_angle": 160.0},
                        {"x": 10.0, "y": 25.0, "crank_angle": 200.0},
                        {"x": 20.0, "y": 30.0, "crank_angle": 240.0},
                        {"x": 40.0, "y": 50.0, "crank_angle": 280.0},
                        {"x": 60.0, "y": 90.0, "crank_angle": 320.0},
                    ],
                    "constraints": {
                        "grashof": "crank_rocker",
                        "link_length": {"min": 10.0, "max": 200.0},
                        "min_transmission_angle": 30.0,
                    },
                    "max_designs": 3,
                },
                {
                    "kind": "path",
                    "method": "curve_match",
                    "closed": True,
                    "points": [
                        {"x": 53.0, "y": 71.0},
                        {"x": 35.0, "y": 71.0},
                        {"x": 22.0, "y": 67.0},
                        {"x": 14.0, "y": 60.0},
                        {"x": 12.0, "y": 49.0},
                        {"x": 11.6, "y": 39.0},
                        {"x": 11.6, "y": 28.0},
                        {"x": 11.6, "y": 18.0},
                        {"x": 12.5, "y": 12.0},
                        {"x": 18.0, "y": 20.0},
                        {"x": 27.0, "y": 29.0},
                        {"x": 38.0, "y": 39.0},
                        {"x": 50.0, "y": 49.0},
                        {"x": 60.0, "y": 62.0},
                    ],
                    "max_designs": 5,
                },
            ]
        },
    )

    kind: Literal["path"]
    points: list[PathPoint] = Field(
        min_length=3, max_length=MAX_POINTS, description="Points of the path, in the order in which P visits them."
    )
    timing: Literal["free", "prescribed"] = Field(
        default="free", description="Whether each point has a crank angle at which it is met."
    )
    crank_phase: Literal["free", "absolute", "ground_line"] = Field(
        default="free",
        description="Reference line of prescribed crank angles: any line, so that only their differences count; "
        "the x axis; or the line from the input's fixed pivot to the output's.",
    )
    crank_direction: Literal["as_given", "either"] = Field(
        default="as_given", description="Whether the crank may also turn in the direction opposite to its angles."
    )
    closed: Flag = Field(default=False, description="The points lie on a closed curve, and the input makes full turns.")
    method: Literal["auto", "exact", "least_squares", "curve_match"] = Field(
        default="auto",
        description="How the points are met: exactly, with the minimum sum of squared distances, or, by curve_match, "
        "as a whole drawn curve (closed) or stroke. auto: exactly if a linkage can meet that number of points, "
        "otherwise, or if no linkage does, by least_squares. If none of these linkages is sound, auto also fits sound "
        "ones, by curve_match on a closed curve.",
    )
    placement_free: list[Literal["position", "rotation", "size"]] = Field(
        default=[],
        max_length=3,
        description="For curve_match: properties of the drawn curve that may change. The linkage is then moved, "
        "rotated or scaled with its curve to satisfy given pivots, regions and limits of lengths.",
    )
    mechanism: Literal["fourbar", "slider_crank", "geared_fivebar"] = "fourbar"
    gear_ratio: Number | None = Field(
        default=None,
        description="For geared fivebars: rotation of the output over that of the input. Left out: 1, -1, 2 and -2 are "
        "tried.",
    )
    mechanisms: Mechanisms | None = Field(
        default=None,
        description="The types of linkages to search, in place of mechanism; auto: fourbars, sixbars if no fourbar is "
        "sound and near, and eightbars if sixbars are far off, too.",
    )
    stance: Stance | None = Field(
        default=None,
        description="For legs: a part of the path that must be straight, optionally at constant speed.",
    )
    start: StartFourbar | None = Field(
        default=None,
        description="For least_squares: the fit starts from this fourbar alone; no random fourbars are tried.",
    )
    fixed_pivots: PathPivots = PathPivots()
    constraints: PathConstraints = PathConstraints()
    rounds: Annotated[Count, Field(ge=1, le=20)] = Field(
        default=3,
        description="For fourbars and fewer than nine points of free timing: number of random samples of linkages near "
        "them. Other types, including sixbars and eightbars, are sampled once and ignore this field.",
    )

    @property
    def task_size(self) -> float:
        """The maximum distance between two points, relative to which tolerances are measured, in length units."""
        return _compute_max_distance(tuple(point.point for point in self.points)) or 1.0

    @property
    def sixbars(self) -> tuple[Sixbar, ...]:
        """The types of sixbars to search; ``auto`` excludes Stephenson II."""
        named = select_searched_types(self.mechanisms, SIXBAR_TYPES, find_unsupported(self))
        if self.mechanisms == "auto":
            return tuple(name for name in named if name != UNCLASSED_SIXBAR)
        return remove_unclassed(named, find_unsupported_unclassed(self))

    @property
    def has_eightbars(self) -> bool:
        """Whether eightbars are searched; ``auto`` searches them only if sixbars are far off."""
        searched: tuple[Literal["eightbar"], ...] = select_searched_types(
            self.mechanisms, ("eightbar",), find_unsupported(self)
        )
        return bool(searched)

    def select_type(self, name: Simple) -> PathProblem:
        """Return the problem for one type with a single closure, as requested without ``mechanisms``."""
        ratio = self.gear_ratio if name == "geared_fivebar" else None
        return self.model_copy(update={"mechanisms": None, "mechanism": name, "gear_ratio": ratio})

    @property
    def prescribed(self) -> bool:
        """Whether the points have crank angles."""
        return self.timing == "prescribed"

    @property
    def most_exact(self) -> int:
        """Maximum number of points that can be met exactly, in general: as many as there are degrees of freedom for."""
        # Every given coordinate takes one degree of freedom; a prescribed point takes two, because its crank angle is
        # known.
        free = MAX_EXACT_POINTS[self.mechanism] - self.fixed_pivots.count_given()
        return (free + (self.crank_phase == "free")) // 2 if self.prescribed else free

    @property
    def is_fitted(self) -> bool:
        """Whether the points are met approximately, not exactly."""
        if self.method == "auto":
            # Tolerances and a stance make sense for approximate points only.
            return len(self.points) > self.most_exact or self.tolerances is not None or self.stance is not None
        return self.method in ("least_squares", "curve_match")

    @property
    def tolerances(self) -> Real | None:
        """Maximum distance of the curve from each point, shape (points,), in length units; None without tolerances."""
        stated = [point.tolerance for point in self.points if point.tolerance is not None]
        return np.array(stated) if len(stated) == len(self.points) else None

    @property
    def manufacture_task(self) -> ManufactureTask | str:
        """Places of P that a manufactured linkage must reproduce, at free inputs if timing is free; or why it is not
        supported."""
        if self.mechanism == "geared_fivebar":
            return compose("path-manufacture-not-for-fivebars")
        if self.placement_free:
            return compose("path-manufacture-not-for-free-place")
        return ManufactureTask(True, False, not self.prescribed, len(self.points))

    def build_required_targets(self, design: Any) -> RequiredTargets:
        """Return the points and tolerances that a design must keep, in any direction."""
        widths = self.tolerances
        limits = None
        if widths is not None:
            limits = np.stack([widths, widths, np.zeros(len(widths))], axis=1)
        return RequiredTargets(
            inputs=np.radians([target.input_angle for target in design.targets]),
            points=np.array([point.point for point in self.points]),
            free=not self.prescribed,
            limits=limits,
            around=True,
            size=self.task_size,
            on_ground=(self.crank_phase == "ground_line", False),
            kept=list_fixed_coordinates((self.fixed_pivots.input, self.fixed_pivots.output)),
        )

    def measure_error(self, design: Any) -> float:
        """Return the RMS distance from the points together with the excursion between them; 0 within tolerances."""
        if self.tolerances is not None:
            return 0.0
        return math.hypot(design.metrics.rms_distance, design.metrics.excursion or 0.0) / self.task_size

    @property
    def error_unit(self) -> tuple[float, str]:
        """Errors are written as lengths."""
        return self.task_size, f" {self.length_unit}"

    def classify_design(self, design: Any) -> int:
        """Return 0 for a design that was meant to meet its points exactly, 1 for a fit.

        A sound fit that is near the points precedes exact designs that transmit too badly, unless the method is exact.
        """
        # A local import, because statements are also read where no design is compared.
        from synthesis.results.practicality import is_sound

        exact = design.metrics.curve_distance is None
        if self.method != "auto" or self.is_fitted:
            return int(not exact)
        if not is_sound(design):
            return 2 if exact else 3
        if exact:
            return 0
        return 1 if self.measure_error(design) <= MAX_USABLE_ERROR else 3

    def is_astray(self, design: Any) -> bool:
        """Return whether the curve strays between the points by more than they are missed, and visibly."""
        excursion = design.metrics.excursion or 0.0
        return bool(excursion > max(2.0 * design.metrics.max_distance, STRAY_SHARE * self.task_size))

    @property
    def is_matched(self) -> bool:
        """Whether the points form a curve to be drawn as a whole."""
        return self.method == "curve_match"

    @property
    def longest_link(self) -> float:
        """The longest link that a curve match may have, in length units."""
        limit = self.constraints.link_length
        if limit is not None and limit.max is not None:
            return limit.max
        points = np.array([point.point for point in self.points])
        return MAX_LINK_DIAGONALS * math.hypot(float(np.ptp(points.real)), float(np.ptp(points.imag)))

    @property
    def crank_turns(self) -> list[float]:
        """Prescribed crank angles as one run of the crank from the first, radians: forward, or backward if that is
        shorter.

        If the points are not met in order within one turn, the differences as given.
        """
        angles = [point.crank_angle or 0.0 for point in self.points]
        onward = [0.0]
        for one, other in pairwise(angles):
            # Each step is taken as a positive angle below a full turn, so that the run is monotone.
            onward.append(onward[-1] + _normalize_turn(other - one))
        backward = [0.0]
        for one, other in pairwise(angles):
            backward.append(backward[-1] - _normalize_turn(one - other))
        runs = [run for run in (onward, backward) if abs(run[-1]) <= 360.0 + ANGLE_TOLERANCE]
        run = min(runs, key=lambda turns: abs(turns[-1])) if runs else [angle - angles[0] for angle in angles]
        return [math.radians(turn) for turn in run]

    def find_contradictions(self) -> list[Contradiction]:
        """Return contradictory requests: equal points, incomplete or impossible timing, and constraints that exclude
        one another."""
        if self.mechanisms is None:
            return self._find_type_contradictions()
        # Requests are checked for each type, because some apply to one type only.
        types = list_simple_types(self.mechanisms) or ("fourbar",)
        each = [fault for name in types for fault in self.select_type(name)._find_type_contradictions()]
        return list(dict.fromkeys([*find_mechanism_contradictions(self), *each]))

    def _find_type_contradictions(self) -> list[Contradiction]:
        return [
            *self._check_timing(),
            *self._check_equal_points(),
            *self._check_method(),
            *self._check_tolerances(),
            *self._check_pivots(),
            *self._check_mechanism(),
            *self._check_closed(),
            *find_stance_errors(self),
            *find_start_errors(self),
            *self.find_contradicting_constraints(),
        ]

    def _check_timing(self) -> list[Contradiction]:
        given = [k for k, point in enumerate(self.points) if point.crank_angle is not None]
        if not self.prescribed:
            faults = [
                Contradiction(f"/points/{k}/crank_angle", compose("path-angle-with-free-timing")) for k in given[:1]
            ]
            for name, value, default in (
                ("crank_phase", self.crank_phase, "free"),
                ("crank_direction", self.crank_direction, "as_given"),
            ):
                if value != default:
                    faults.append(Contradiction(f"/{name}", compose("path-prescribed-timing-only")))
            return faults
        missing = [k for k in range(len(self.points)) if k not in set(given)]
        if missing:
            return [Contradiction(f"/points/{k}/crank_angle", compose("path-angle-missing")) for k in missing]
        return [*self._check_equal_angles(), *self._check_turns()]

    def _check_equal_angles(self) -> list[Contradiction]:
        """Return points at equal crank angles, for exact tasks; a fit needs at least three different angles."""
        angles = [point.crank_angle or 0.0 for point in self.points]
        if self.is_fitted:
            different = {
                round(_normalize_turn(angle) / ANGLE_TOLERANCE) % round(360.0 / ANGLE_TOLERANCE) for angle in angles
            }
            if len(different) < 3:
                return [Contradiction("/points", compose("path-too-few-angles"))]
            return []
        return [
            Contradiction(f"/points/{k}/crank_angle", compose("path-angles-repeat", point=j))
            for k, later in enumerate(angles)
            for j, earlier in enumerate(angles[:k])
            if abs(math.remainder(later - earlier, 360.0)) <= ANGLE_TOLERANCE
        ]

    def _check_turns(self) -> list[Contradiction]:
        turned = self.crank_turns
        if self.constraints.in_order and abs(turned[-1] - turned[0]) > 0.0:
            steps = [other - one for one, other in pairwise(turned)]
            if min(steps) < 0.0 < max(steps) or max(turned) - min(turned) > math.tau * (1.0 + ANGLE_TOLERANCE):
                detail = compose("path-angles-out-of-order")
                return [Contradiction("/points", detail)]
        return []

    def _check_equal_points(self) -> list[Contradiction]:
        points = np.array([point.point for point in self.points])
        size = float(np.abs(np.concatenate([points.real, points.imag])).max())
        equal = np.abs(points[:, None] - points) <= POINT_TOLERANCE * size
        if self.is_fitted:
            different = sum(not equal[k, :k].any() for k in range(len(points)))
            if different < 3:
                return [Contradiction("/points", compose("path-too-few-points-differ", count=different))]
            return []
        if self.prescribed:
            if equal.all():
                return [Contradiction("/points", compose("path-points-all-equal"))]
            return []
        return [
            Contradiction(f"/points/{k}", compose("path-points-repeat", point=j))
            for k in range(len(points))
            for j in range(k)
            if equal[k, j]
        ]

    def _check_method(self) -> list[Contradiction]:
        if self.placement_free and not (self.is_matched and self.mechanism == "fourbar"):
            return [Contradiction("/placement_free", compose("path-free-place-for-matched-fourbars"))]
        if self.is_matched:
            if self.prescribed:
                return [Contradiction("/timing", compose("path-matched-curve-with-timing"))]
            return []
        if self.method == "exact" and len(self.points) > self.most_exact:
            detail = compose(
                "path-too-many-points-with-timing" if self.prescribed else "path-too-many-points", count=self.most_exact
            )
            return [Contradiction("/method", detail)]
        return []

    def _check_tolerances(self) -> list[Contradiction]:
        given = [k for k, point in enumerate(self.points) if point.tolerance is not None]
        if not given:
            return []
        if self.method == "exact":
            detail = compose("path-exact-points-with-tolerances")
            return [Contradiction(f"/points/{given[0]}/tolerance", detail)]
        open_ones = sorted(set(range(len(self.points))) - set(given))
        detail = compose("path-tolerance-missing")
        return [Contradiction(f"/points/{k}/tolerance", detail) for k in open_ones[:1]]

    def _check_pivots(self) -> list[Contradiction]:
        faults = []
        limits = self.constraints
        for side, pivot, regions in (
            ("input", self.fixed_pivots.input, (limits.fixed_pivot_region, limits.input_pivot_region)),
            ("output", self.fixed_pivots.output, (limits.fixed_pivot_region,)),
        ):
            for region in regions:
                if pivot is None or region is None:
                    continue
                at = complex(
                    region.x[0] if pivot[0] is None else pivot[0], region.y[0] if pivot[1] is None else pivot[1]
                )
                if not region.contains(at):
                    faults.append(Contradiction(f"/fixed_pivots/{side}", compose("path-pivot-outside-region")))
        return faults

    def _check_mechanism(self) -> list[Contradiction]:
        """Return requests that only fourbars support, and invalid gear ratios."""
        faults = []
        if self.gear_ratio is not None:
            turns = self.gear_ratio * np.arange(1.0, MAX_GEAR_TURNS + 1.0)
            if self.mechanism != "geared_fivebar":
                faults.append(
                    Contradiction("/gear_ratio", compose("path-mechanism-without-gears", mechanism=self.mechanism))
                )
            elif self.gear_ratio == 0.0:
                faults.append(Contradiction("/gear_ratio", compose("path-output-does-not-turn")))
            elif float(np.abs(turns - np.round(turns)).min()) > ANGLE_TOLERANCE:
                detail = compose("path-gears-do-not-repeat", turns=MAX_GEAR_TURNS)
                faults.append(Contradiction("/gear_ratio", detail))
        if self.mechanism == "fourbar":
            return faults
        if self.prescribed:
            faults.append(Contradiction("/timing", compose("path-timing-for-fourbars-only", mechanism=self.mechanism)))
        faults += self.constraints.find_class_contradictions(
            (), compose("path-mechanism-without-class", mechanism=self.mechanism)
        )
        if self.constraints.coupler_point is not None:
            detail = compose("path-coupler-point-for-fourbars-only", mechanism=self.mechanism)
            faults.append(Contradiction("/constraints/coupler_point", detail))
        if self.mechanism == "slider_crank" and self.fixed_pivots.output is not None:
            faults.append(Contradiction("/fixed_pivots/output", compose("path-slider-crank-with-output-pivot")))
        return faults

    def _check_closed(self) -> list[Contradiction]:
        if self.closed and self.constraints.grashof in ("double_rocker", "non_grashof"):
            detail = compose("path-class-does-not-turn", grashof=self.constraints.grashof)
            return [Contradiction("/constraints/grashof", detail)]
        return []


@lru_cache(maxsize=64)
def _compute_max_distance(points: tuple[complex, ...]) -> float:
    """Return the maximum distance between two points; cached, because every measured linkage needs it."""
    places = np.array(points)
    return float(np.abs(places[:, None] - places).max())


def _normalize_turn(degrees: float) -> float:
    """Return an angle in [0, 360) degrees, with 0 for one that is 0 up to rounding."""
    turned = math.fmod(degrees, 360.0) % 360.0
    return 0.0 if 360.0 - turned <= ANGLE_TOLERANCE else turned
