"""Motion generation: a linkage whose coupler carries a body through positions."""

from __future__ import annotations

import cmath
import math
from typing import Any, Literal

import numpy as np
from pydantic import ConfigDict, Field, PrivateAttr

from kinematics.message import compose
from synthesis.kinds.motion.statement.contradictions import list_contradictions
from synthesis.kinds.motion.statement.dyad_choices import DriverDyad, DyadChoices, GroundLine
from synthesis.kinds.motion.statement.mechanism_types import (
    SIXBARS,
    Chain,
    Mechanisms,
    Sixbar,
    list_unsupported,
    list_unsupported_stephenson_2,
)
from synthesis.kinds.motion.statement.positions import MAX_EXACT_POSITIONS, MAX_SIXBAR_POSITIONS, Position, Tolerance
from synthesis.model.linkage.answer import FourbarMechanism
from synthesis.model.linkage.problem import LinkageProblem
from synthesis.model.linkage.type_choice import remove_unclassed, select_searched_types
from synthesis.model.manufacture.request import ManufactureTask, RequiredTargets, list_fixed_coordinates
from synthesis.model.problem import Contradiction, Flag

MIN_TOLERANCE = 1e-12
"""Largest tolerance that counts as zero, as a share of the largest coordinate (or of the task's size) and in radians:
such a coordinate is met exactly. Doubles resolve 1e-16 of either, and driving a linkage to a position leaves an error
of several thousand times that."""

MIN_MOTION_RATIO = 1e-3
"""Minimum motion of P, as a share of its distance to given pivots, that sets the task's size."""

SIDE_FIELDS = "input_side", "output_side"


class MotionProblem(LinkageProblem):
    """Motion generation: a fourbar whose coupler carries a body through two to five positions.

    Each side of the linkage is a dyad: a link from a fixed pivot to a moving pivot on the body. n positions leave 5 − n
    free choices per dyad (Norton, Table 5-3). Free choices that are not given are searched, and the best distinct
    linkages are returned. For five positions there are at most six linkages, and all feasible ones are returned.
    """

    model_config = ConfigDict(
        title="Motion generation",
        json_schema_extra={
            "examples": [
                {
                    "kind": "motion",
                    "positions": [
                        {"x": 0.0, "y": 0.0, "angle": 0.0},
                        {"x": 40.0, "y": 15.0, "angle": -25.0},
                        {"x": 75.0, "y": 5.0, "angle": -60.0},
                    ],
                    "constraints": {"min_transmission_angle": 35.0},
                    "max_designs": 5,
                },
                {
                    "kind": "motion",
                    "positions": [
                        {"x": 0.0, "y": 0.0, "angle": 0.0},
                        {"x": 40.0, "y": 15.0, "angle": -25.0},
                        {"x": 75.0, "y": 5.0, "angle": -60.0},
                    ],
                    "ground_line": {"point": [0.0, -60.0], "angle": 0.0},
                    "input_side": {"fixed_pivot": [0.0, None]},
                    "max_designs": 3,
                },
                {
                    "kind": "motion",
                    "positions": [
                        {"x": 0.0, "y": 0.0, "angle": 0.0},
                        {"x": -9.0, "y": 7.0, "angle": -14.0},
                        {"x": -13.0, "y": 18.0, "angle": -28.0},
                        {"x": -5.0, "y": 33.0, "angle": -46.0},
                    ],
                    "constraints": {"min_transmission_angle": 40.0, "max_link_ratio": 5.0},
                    "max_designs": 3,
                },
                {
                    "kind": "motion",
                    "positions": [
                        {"x": 0.0, "y": 0.0, "angle": 0.0},
                        {"x": -4.0, "y": 4.0, "angle": 6.0},
                        {"x": -25.0, "y": 11.0, "angle": 30.0},
                        {"x": -32.0, "y": 10.0, "angle": 38.0},
                        {"x": -37.0, "y": 8.0, "angle": 44.0},
                    ],
                },
                {
                    "kind": "motion",
                    "positions": [
                        {"x": 0.0, "y": 0.0, "angle": 0.0, "exact": True},
                        {"x": 12.0, "y": 7.0, "angle": -9.0},
                        {"x": 26.0, "y": 12.0, "angle": -17.0},
                        {"x": 41.0, "y": 14.0, "angle": -27.0},
                        {"x": 55.0, "y": 13.0, "angle": -38.0},
                        {"x": 68.0, "y": 9.0, "angle": -50.0},
                        {"x": 75.0, "y": 5.0, "angle": -60.0, "exact": True},
                    ],
                    "method": "least_squares",
                    "max_designs": 3,
                },
                {
                    "kind": "motion",
                    "positions": [
                        {"x": 0.0, "y": 0.0, "angle": 0.0},
                        {"x": 12.0, "y": 7.0, "angle": -9.0, "tolerance": {"x": 1.0, "y": 1.0, "angle": 3.0}},
                        {"x": 26.0, "y": 12.0, "angle": -17.0, "tolerance": 1.0},
                        {"x": 41.0, "y": 14.0, "angle": -27.0, "tolerance": 1.0},
                        {"x": 55.0, "y": 13.0, "angle": -38.0, "tolerance": {"angle": 5.0}},
                        {"x": 75.0, "y": 5.0, "angle": -60.0},
                    ],
                    "max_designs": 3,
                },
                {
                    "kind": "motion",
                    "positions": [
                        {"x": 0.0, "y": 0.0, "angle": 0.0},
                        {"x": 230.0, "y": 240.0, "angle": 40.0, "tolerance": {"x": 40.0, "y": 40.0, "angle": 15.0}},
                        {"x": 190.0, "y": 470.0, "angle": 85.0, "tolerance": {"x": 30.0, "y": 30.0, "angle": 3.0}},
                    ],
                    "constraints": {
                        "fixed_pivot_region": {"x": [-250.0, -30.0], "y": [120.0, 290.0]},
                        "moving_pivot_region": {"x": [-60.0, -10.0], "y": [-280.0, 280.0]},
                    },
                    "max_designs": 5,
                },
                {
                    "kind": "motion",
                    "positions": [
                        {"x": 0.0, "y": 0.0, "angle": 0.0},
                        {"x": 40.0, "y": 15.0, "angle": -25.0},
                        {"x": 75.0, "y": 5.0, "angle": -60.0},
                    ],
                    "output_side": {"dyad": "PR", "slide_angle": 15.0},
                    "max_designs": 3,
                },
                {
                    "kind": "motion",
                    "positions": [
                        {"x": 0.0, "y": 0.0, "angle": 0.0},
                        {"x": 30.0, "y": 20.0, "angle": 45.0},
                    ],
                    "driver_dyad": {"link": "input", "pivot_region": {"x": [-150.0, 150.0], "y": [-150.0, 0.0]}},
                    "max_designs": 3,
                },
                {
                    "kind": "motion",
                    "positions": [
                        {"x": 0.0, "y": 0.0, "angle": 0.0},
                        {"x": 30.0, "y": 20.0, "angle": 45.0},
                    ],
                    "driver_dyad": {"link": "coupler"},
                    "max_designs": 3,
                },
                {
                    "kind": "motion",
                    "positions": [
                        {"x": 0.0, "y": 0.0, "angle": 0.0},
                        {"x": 35.0, "y": 12.0, "angle": 20.0},
                        {"x": 70.0, "y": 8.0, "angle": 5.0},
                        {"x": 100.0, "y": -20.0, "angle": -25.0},
                        {"x": 115.0, "y": -60.0, "angle": -40.0},
                    ],
                    "mechanisms": ["watt_1", "stephenson_3"],
                    "max_designs": 3,
                },
            ]
        },
    )

    kind: Literal["motion"]
    positions: list[Position] = Field(min_length=2, max_length=200)
    input_side: DyadChoices = DyadChoices()
    output_side: DyadChoices = DyadChoices()
    ground_line: GroundLine | None = Field(default=None, description="Both fixed pivots lie on this line.")
    method: Literal["auto", "exact", "least_squares"] = Field(
        default="auto",
        description="How positions are met: exactly (at most five), or as closely as possible, within the tolerances "
        "if any are given. auto: exactly for up to five positions without tolerances.",
    )

    driver_dyad: Flag | DriverDyad = Field(
        default=False,
        description="Add a fully rotating crank that moves the linkage from the first position to the last.",
    )

    mechanisms: Mechanisms | None = Field(
        default=None,
        description="Types of linkage to search. auto: fourbars and slider-cranks, sixbars if none of these is "
        "feasible, and eightbars if all of these miss fitted positions by far. Omitted: fourbars, and slider-cranks "
        "if no fourbar is feasible.",
    )
    chain: Chain | None = Field(
        default=None,
        description="Fixed dimensions of the three-link chain in a sixbar; only with a list of sixbar types.",
    )

    _kinds_of_slider: tuple[Literal["PR", "RP"], ...] = PrivateAttr(default=("PR", "RP"))

    @property
    def sixbars(self) -> tuple[Sixbar, ...]:
        """The types of sixbar to search."""
        return remove_unclassed(
            select_searched_types(self.mechanisms, SIXBARS, list_unsupported(self)),
            list_unsupported_stephenson_2(self),
        )

    @property
    def has_eightbars(self) -> bool:
        """Whether eightbars may be searched; for ``auto`` only if positions are fitted, so that all may miss by far."""
        if self.mechanisms == "auto" and not self.is_least_squares:
            return False
        return bool(select_searched_types(self.mechanisms, ("eightbar",), list_unsupported(self)))

    @property
    def two_dyad_problem(self) -> MotionProblem | None:
        """The same problem restricted to the fourbars and slider-cranks in ``mechanisms``; None if there are none."""
        named = self.mechanisms
        sides: dict[str, DyadChoices] = {}
        if isinstance(named, list) and self.slider is None:
            if "fourbar" not in named and "slider_crank" not in named:
                return None
            # Fix the dyad types, so that a failed search does not fall back on a type that was not requested.
            if "slider_crank" not in named:
                sides = {side: getattr(self, side).model_copy(update={"dyad": "RR"}) for side in SIDE_FIELDS}
            elif "fourbar" not in named:
                sides = {"output_side": self.output_side.model_copy(update={"dyad": "PR"})}
        part = self.model_copy(update={"mechanisms": None, "chain": None, **sides})
        if isinstance(named, list):
            # A named slider-crank has a slider on a fixed line; inverted ones have other types.
            part._kinds_of_slider = ("PR",)
        return part

    @property
    def slider_kinds(self) -> tuple[Literal["PR", "RP"], ...]:
        """Kinds of slider that may replace pins: RP (inverted slider-crank) only if ``mechanisms`` is no list."""
        return self._kinds_of_slider

    @property
    def sixbars_possible(self) -> bool:
        """Whether the number of positions is within the limit for sixbars."""
        return len(self.positions) <= MAX_SIXBAR_POSITIONS

    @property
    def manufacture_task(self) -> ManufactureTask | str:
        """Manufacturing analysis: the targets are poses at free input angles; an error text if it is unsupported."""
        if self.driver is not None:
            return compose("motion-manufacture-with-driver")
        if self.slider == "RP" or self.input_side.dyad == "PR":
            return compose("motion-manufacture-type-unsupported")
        return ManufactureTask(True, True, True, len(self.positions), self._grid_conflict)

    @property
    def _grid_conflict(self) -> str:
        """Error text for a given value that rounding to a grid would change; empty if there is none."""
        for name, side in (("input_side", self.input_side), ("output_side", self.output_side)):
            for field in ("moving_pivot", "coupler_vector", "link_angle", "rotations"):
                if getattr(side, field) is not None:
                    return compose("motion-grid-moves-choice", field=f"{name}.{field}")
        return "" if self.ground_line is None else compose("motion-grid-moves-pivots")

    def build_required_targets(self, design: Any) -> RequiredTargets:
        """Return the positions and tolerances that a manufactured design must keep; angles in radians."""
        limits = np.array(self.limits)
        limits[:, 2] = np.radians(limits[:, 2])
        # Without a body angle in the mechanism the reference configuration is the first position.
        stands = design.mechanism.reference_body_angle
        return RequiredTargets(
            inputs=np.radians([target.input_angle for target in design.targets]),
            points=np.array([position.point for position in self.positions]),
            angles=np.radians([position.angle for position in self.positions]),
            body=math.radians(self.positions[0].angle if stands is None else stands),
            limits=limits,
            size=self.task_size,
            kept=list_fixed_coordinates((self.input_side.fixed_pivot, self.output_side.fixed_pivot)),
        )

    def measure_error(self, design: Any) -> float:
        """Return the RMS of the residuals of fitted positions; 0 for positions that are met, also within tolerances."""
        return float(design.metrics.rms_residual) if self.is_least_squares else 0.0

    def classify_design(self, design: Any) -> int:
        """Return 0 for a sound parallelogram and 1 for others: if the body must not turn, the plain linkage is first.

        Fits without tolerances are compared by their errors instead.
        """
        # A local import, because statements are also read where no design is compared.
        from synthesis.results.practicality import is_sound

        mechanism = design.mechanism
        plain = isinstance(mechanism, FourbarMechanism) and mechanism.is_parallelogram and is_sound(design)
        return int(not plain or self.is_least_squares)

    @property
    def first_pose(self) -> tuple[complex, float]:
        """P as a complex number, length units, and the body's angle, degrees, in the first position."""
        return self.positions[0].point, self.positions[0].angle

    @property
    def input_slides(self) -> bool:
        """Whether the input is a slider."""
        return self.input_side.dyad == "PR"

    @property
    def slider(self) -> Literal["PR", "RP"] | None:
        """The type of the requested slider, on either side; None if both sides have pins."""
        # The output side first, since a slider there is the usual case.
        for side in (self.output_side, self.input_side):
            if side.dyad in ("PR", "RP"):
                return side.dyad
        return None

    @property
    def driver(self) -> DriverDyad | None:
        """The options of the driver dyad; None if no driver dyad is requested."""
        if isinstance(self.driver_dyad, DriverDyad):
            return self.driver_dyad
        return DriverDyad() if self.driver_dyad else None

    @property
    def limits(self) -> list[tuple[float, float, float]]:
        """Tolerance of each position in x, y (length units) and angle (degrees).

        0 for a coordinate that is met exactly; infinite for one that is fitted without a limit.
        """
        fitted = self.is_least_squares
        return [self._compute_limits(position, fitted) for position in self.positions]

    def _compute_limits(self, position: Position, fitted: bool) -> tuple[float, float, float]:
        tolerance = position.tolerance
        if isinstance(tolerance, Tolerance):
            return self._clip_tolerances(tolerance.x or 0.0, tolerance.y or 0.0, tolerance.angle or 0.0)
        if tolerance is not None:
            # The angle may move a point one task size away by as much as the length tolerance.
            return self._clip_tolerances(tolerance, tolerance, math.degrees(min(tolerance / self.task_size, math.pi)))
        return (math.inf, math.inf, math.inf) if fitted and not position.exact else (0.0, 0.0, 0.0)

    def _clip_tolerances(self, x: float, y: float, angle: float) -> tuple[float, float, float]:
        """Return the tolerances, with those below double-precision resolution set to 0."""
        # Rounding is relative to coordinates, which may be far larger than the task.
        least = MIN_TOLERANCE * max(self.task_size, *(max(abs(p.x), abs(p.y)) for p in self.positions))
        turned = math.degrees(MIN_TOLERANCE)
        return x if x > least else 0.0, y if y > least else 0.0, angle if angle > turned else 0.0

    @property
    def is_least_squares(self) -> bool:
        """Whether positions without a tolerance are fitted: more than five positions, or least squares requested.

        If any position has a tolerance, those without one are met exactly.
        """
        if self._has_tolerances:
            return False
        # Five positions are normally exact, so they are fitted only on request; six or more always.
        enough = len(self.positions) >= MAX_EXACT_POSITIONS + (self.method == "auto")
        return self.method != "exact" and enough

    @property
    def approximate(self) -> bool:
        """Whether five or more positions are fitted, with tolerances or without."""
        return self.is_least_squares or (self._allows_deviations and len(self.positions) >= MAX_EXACT_POSITIONS)

    @property
    def has_few_tolerances(self) -> bool:
        """Whether there are two to four positions, some with tolerances that the method may use."""
        return self._allows_deviations and len(self.positions) < MAX_EXACT_POSITIONS and self.method != "exact"

    @property
    def is_constrained_fit(self) -> bool:
        """Whether a constrained fit uses these tolerances: fourbars with no given values but pivots."""
        return self.has_few_tolerances and self._has_only_pivots

    @property
    def is_workspace_fit(self) -> bool:
        """Whether a constrained fit applies tolerances and a workspace together, for any number of positions."""
        tolerated = self._allows_deviations and (self.has_few_tolerances or self.approximate)
        return tolerated and self._has_only_pivots and self.space is not None and self.space.has_constraints

    @property
    def _has_only_pivots(self) -> bool:
        """Whether the problem is a plain fourbar whose only given values are pivots."""
        sides = self.input_side, self.output_side
        return self.driver is None and all(side.dyad in ("any", "RR") and side.has_only_pivots for side in sides)

    @property
    def _has_tolerances(self) -> bool:
        return any(position.tolerance is not None for position in self.positions)

    @property
    def _allows_deviations(self) -> bool:
        """Whether some tolerance exceeds rounding error."""
        return self._has_tolerances and any(limit > 0.0 for limits in self.limits for limit in limits)

    @property
    def task_size(self) -> float:
        """Characteristic length of the task, in length units; tolerances and free choices are relative to it.

        The maximum distance between two positions of P. If P moves by less than a thousandth of its distance to the
        given pivots and regions, or of the length of a given chain: that distance. If none is given either: 1.
        """
        points = [position.point for position in self.positions]
        moved = max(abs(p - q) for p in points for q in points)
        reach = max([self.chain_size, *(abs(z - points[0]) for z in self._list_given_points())])
        # Zero remains if all positions and choices coincide: then lengths have no scale, and 1 will do.
        return max(moved, 0.0 if moved >= MIN_MOTION_RATIO * reach else reach) or 1.0

    @property
    def chain_size(self) -> float:
        """The longest given length of the chain, or distance to one of its pivots; 0 if none is given."""
        return 0.0 if self.chain is None else self.chain.size_from(self.positions[0].point)

    @property
    def turns(self) -> list[float]:
        """Rotation of the body from the first position to each, radians in [−π, π]."""
        first = self.positions[0].angle
        # The shorter rotation: a position gives the angle only up to full turns.
        return [math.radians(math.remainder(position.angle - first, 360.0)) for position in self.positions]

    def _list_given_points(self) -> list[complex]:
        first = self.positions[0]
        points = [] if self.ground_line is None else [self.ground_line.project_point(first.point)]
        for side in (self.input_side, self.output_side):
            for pivot in (side.fixed_pivot, side.moving_pivot):
                if pivot is not None:
                    x, y = pivot
                    # A half-given pivot is taken at P's coordinate in the open direction.
                    points.append(complex(first.x if x is None else x, first.y if y is None else y))
        for region in (self.constraints.fixed_pivot_region, self.constraints.moving_pivot_region):
            if region is not None:
                points += [complex(x, y) for x in region.x for y in region.y]
        return points

    def find_contradictions(self) -> list[Contradiction]:
        """Return errors that involve several fields: equal positions, too many or conflicting choices."""
        listed = list_contradictions(self)
        part = None if self.mechanisms is None else self.two_dyad_problem
        # Both problems list some of the same contradictions; keep the first of each, in order.
        return listed if part is None else list(dict.fromkeys([*listed, *part.find_contradictions()]))

    @property
    def exact_end_poses(self) -> tuple[dict[int, complex], dict[int, complex]]:
        """P and the body's rotation e^{iα} at the first and last position, by index, if these are met exactly.

        The last position is included only if the first one is exact too: rotations are measured from the first.
        """
        # Both x, y and angle must be exact for a pose to be known.
        ends = [k for k in (0, len(self.positions) - 1) if self.limits[k] == (0.0, 0.0, 0.0)]
        return self.list_poses(ends if 0 in ends else [])

    def list_poses(self, listed: list[int]) -> tuple[dict[int, complex], dict[int, complex]]:
        """Return P (length units) and the body's rotation e^{iα} at the listed positions, both by index."""
        turns = self.turns
        return {k: self.positions[k].point for k in listed}, {k: cmath.rect(1.0, turns[k]) for k in listed}
