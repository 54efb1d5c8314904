"""Piston engines: cylinders, their arrangement, masses, gas, and the requested results."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import ConfigDict, Field

from kinematics.message import compose
from synthesis.model.dimension import ANGLE, INERTIA, LENGTH, MASS, ROTATIONAL_SPEED
from synthesis.model.dynamics.loads import FULL_TURN, Interpolation, PairRows, find_period_error
from synthesis.model.dynamics.request import METRES_PER_UNIT, FlywheelSpec
from synthesis.model.problem import (
    Contradiction,
    Count,
    Degrees,
    Flag,
    NonNegative,
    Number,
    PositiveLength,
    PositiveNumber,
    ProblemBase,
    Statement,
)

MAX_CYLINDERS = 16
"""Maximum number of cylinders: 2^15 choices of firing."""

MIN_ROD_RATIO = 1.0 + 1e-3
"""Minimum ratio of rod length to crank radius: at 1 the rod could not pass the dead centre."""

MAX_COMBINATIONS, MAX_CHOICES = 20_000, 20_000_000
"""Maximum number of combinations of given throw angles, and of their choices of firing in total."""

MAX_ROD_RATIO = 1e6
"""Maximum ratio of rod length to crank radius, above which the motion is lost in the rounding of the rod length."""

BANK_COUNTS: dict[str, int] = {"inline": 1, "vee": 2, "opposed": 2, "w": 3}
"""Number of banks by type of layout; a radial engine has a star of cylinders instead."""


class EngineLayout(Statement):
    """The arrangement of cylinders and cranks."""

    type: Literal["inline", "vee", "opposed", "radial", "w"]
    vee_angle: Annotated[float, ANGLE, Field(strict=True, gt=0.0, lt=180.0)] | None = Field(
        default=None,
        description="Angle between neighbouring banks of a vee or w, degrees; use `opposed` for 180 and `inline` "
        "for 0.",
    )
    pins: Literal["shared", "own"] = Field(
        default="shared",
        description="Whether neighbouring cylinders of different banks share one throw, or each has its own.",
    )
    throws: list[Degrees] | None = Field(
        default=None,
        min_length=1,
        max_length=MAX_CYLINDERS,
        description="Phases (lags) of the throws along the shaft, degrees. Default: they are found.",
    )
    positions: list[Number] | None = Field(
        default=None,
        min_length=1,
        max_length=MAX_CYLINDERS,
        description="Places of the throws along the shaft, in spacings; by default 0, 1, 2, ...",
    )
    spacing: PositiveLength | None = Field(
        default=None, description="Spacing of neighbouring throws; without it moments are for a spacing of 1."
    )
    numbering: Literal["along_shaft", "by_bank"] = Field(
        default="along_shaft", description="Numbering of the cylinders: throw by throw, or bank by bank."
    )
    first_bank: Literal["left", "right"] = Field(default="left", description="The bank that is numbered first.")

    def count_throws(self, cylinders: int) -> int | None:
        """Return the number of throws for the cylinders; None if they do not fill the banks."""
        if self.type == "inline" or self.pins == "own":
            return cylinders
        if self.type == "radial":
            return 1
        banks = BANK_COUNTS[self.type]
        return None if cylinders % banks else cylinders // banks


class ConnectingRod(Statement):
    """A connecting rod."""

    mass: Annotated[NonNegative, MASS]
    cg: Annotated[NonNegative, LENGTH] = Field(description="Distance from the crank pin to the centre of gravity.")
    inertia: Annotated[NonNegative, INERTIA] | None = Field(
        default=None,
        description="Moment of inertia about the centre of gravity; by default that of two masses at the pins.",
    )


class CrankThrow(Statement):
    """One throw of the crankshaft."""

    mass: Annotated[NonNegative, MASS]
    cg: Annotated[Number, LENGTH] = Field(
        description="Distance of the centre of gravity from the shaft towards the pin; negative with counterweights."
    )
    inertia: Annotated[NonNegative, INERTIA] | None = Field(
        default=None, description="Moment of inertia about the shaft; it counts towards the flywheel's."
    )


class EngineMasses(Statement):
    """Moving masses, equal for all cylinders."""

    piston: Annotated[PositiveNumber, MASS] = Field(description="Mass of the piston with its pin and rings.")
    rod: ConnectingRod
    crank: CrankThrow | None = None


class CylinderPressure(Statement):
    """Gauge pressure in a cylinder over its cycle, which begins at the top dead centre of its firing."""

    table: PairRows = Field(description="Rows of crank angle (°) and pressure (Pa, or in consistent units).")
    interpolation: Interpolation = "linear"


class IdleFlywheel(FlywheelSpec):
    """A flywheel to even the speed, usually at idle."""

    speed_rpm: Annotated[PositiveNumber, ROTATIONAL_SPEED]


class EngineProblem(ProblemBase):
    """Piston engine: its shaking, torque and firing, or the arrangements of its throws that fire evenly.

    With `throws` the engine is analysed: exact harmonics of forces, moments and torque instead of two terms; firing
    orders; pin forces; balancers. Without them all arrangements of the throws that fire evenly are found and
    ranked by their shaking of the frame. Every number is verified by driving the slider-crank of each cylinder.
    """

    model_config = ConfigDict(
        title="Piston engine",
        json_schema_extra={
            "examples": [
                {
                    "kind": "engine",
                    "cylinders": 4,
                    "stroke_cycle": 4,
                    "bore": 76.0,
                    "stroke": 72.0,
                    "rod": 130.0,
                    "masses": {
                        "piston": 0.35,
                        "rod": {"mass": 0.45, "cg": 40.0, "inertia": 0.0012},
                        "crank": {"mass": 1.0, "cg": 5.0},
                    },
                    "layout": {"type": "inline", "throws": [0.0, 180.0, 180.0, 0.0], "spacing": 85.0},
                    "speed_rpm": 3000.0,
                    "pressure": {
                        "table": [
                            [0.0, 2.4e6],
                            [15.0, 4.2e6],
                            [40.0, 1.6e6],
                            [90.0, 4.5e5],
                            [140.0, 2.0e5],
                            [180.0, 2.0e4],
                            [540.0, 0.0],
                            [630.0, 9.0e4],
                            [690.0, 8.0e5],
                            [720.0, 2.4e6],
                        ]
                    },
                    "flywheel": {"coefficient": 0.04, "speed_rpm": 800.0},
                },
                {
                    "kind": "engine",
                    "cylinders": 8,
                    "stroke_cycle": 4,
                    "stroke": 80.0,
                    "rod": 140.0,
                    "layout": {"type": "vee", "vee_angle": 90.0},
                },
            ]
        },
    )

    kind: Literal["engine"]
    units: Literal["si", "consistent"] = Field(
        default="si",
        description="`si`: kg, N, N·m, Pa, lengths in the length unit; `consistent`: no conversion.",
    )
    cylinders: Annotated[Count, Field(ge=1, le=MAX_CYLINDERS)]
    stroke_cycle: Literal[2, 4]
    stroke: PositiveLength = Field(description="Stroke of the piston: twice the crank's radius.")
    rod: PositiveLength | None = Field(default=None, description="Length of the rod; give this or `rod_ratio`.")
    rod_ratio: PositiveNumber | None = Field(default=None, description="Length of the rod over the crank's radius.")
    bore: PositiveLength | None = Field(default=None, description="Cylinder diameter, for gas forces.")
    masses: EngineMasses | None = Field(
        default=None, description="Moving masses; without them forces are in units of m_B r ω²."
    )
    pressure: CylinderPressure | None = None
    speed_rpm: Annotated[PositiveNumber, ROTATIONAL_SPEED] | None = Field(
        default=None, description="Speed for the forces; required with masses or pressure."
    )
    layout: EngineLayout
    other_layouts: list[EngineLayout] = Field(
        default=[], max_length=8, description="Further permitted layouts, if throws are to be found."
    )
    throw_angles: list[Degrees] | None = Field(
        default=None,
        min_length=1,
        max_length=24,
        description="Permitted phases, if throws are to be found, with or without even firing.",
    )
    moment_about: Literal["first_throw", "middle"] = Field(
        default="first_throw",
        description="Reference of the reported moments; arrangements are ranked by moments about the middle.",
    )
    method: Literal["exact", "two_term"] = Field(
        default="exact", description="`two_term`: cos θ + (r/l) cos 2θ, for comparison with books."
    )
    avoid_adjacent: Flag = Field(
        default=True, description="Rank firing orders lower if neighbours in one bank fire in succession."
    )
    firing_order: list[Annotated[Count, Field(ge=1, le=MAX_CYLINDERS)]] | None = Field(
        default=None, min_length=1, max_length=MAX_CYLINDERS, description="Required firing order."
    )
    firing_angles: list[Degrees] | None = Field(
        default=None,
        min_length=1,
        max_length=MAX_CYLINDERS,
        description="Firing angles of these cylinders, in that order.",
    )
    flywheel: IdleFlywheel | None = None

    @property
    def force_units(self) -> Literal["si", "consistent"]:
        """The given units."""
        return self.units

    @property
    def scale(self) -> float:
        """The length unit in the unit of the forces."""
        return METRES_PER_UNIT[self.length_unit] if self.units == "si" else 1.0

    @property
    def crank(self) -> float:
        """Radius of the crank, in the length unit."""
        return 0.5 * self.stroke

    @property
    def rod_length(self) -> float:
        """Length of the rod, in the length unit."""
        return self.rod if self.rod is not None else (self.rod_ratio or 0.0) * self.crank

    @property
    def cycle(self) -> float:
        """Crank angle of a cycle, degrees."""
        return 0.5 * FULL_TURN * self.stroke_cycle

    @property
    def layouts(self) -> list[tuple[str, EngineLayout]]:
        """All layouts with their paths in the problem."""
        others = [(f"/other_layouts/{n}", layout) for n, layout in enumerate(self.other_layouts)]
        return [("/layout", self.layout), *others]

    def find_contradictions(self) -> list[Contradiction]:
        """Return lengths, counts and tables that do not agree."""
        found = []
        if (self.rod is None) == (self.rod_ratio is None):
            found.append(Contradiction("/rod", compose("engine-rod-choice")))
        elif self.rod_length < MIN_ROD_RATIO * self.crank:
            path = "/rod" if self.rod is not None else "/rod_ratio"
            found.append(Contradiction(path, compose("engine-rod-too-short")))
        elif self.rod_length > MAX_ROD_RATIO * self.crank:
            path = "/rod" if self.rod is not None else "/rod_ratio"
            found.append(Contradiction(path, compose("engine-rod-too-long", ratio=f"{MAX_ROD_RATIO:g}")))
        for path, layout in self.layouts:
            found += self._find_layout_errors(path, layout)
        return found + self._find_force_errors() + self._find_firing_errors()

    def _find_layout_errors(self, path: str, layout: EngineLayout) -> list[Contradiction]:
        found = []
        if (layout.type in ("vee", "w")) != (layout.vee_angle is not None):
            detail = compose("engine-vee-angle-choice")
            found.append(Contradiction(f"{path}/vee_angle", detail))
        if layout.type in ("inline", "radial") and layout.pins == "own":
            found.append(Contradiction(f"{path}/pins", compose("engine-pins-of-one-bank")))
        count = layout.count_throws(self.cylinders)
        if count is None:
            detail = compose("engine-banks-not-filled", cylinders=self.cylinders, banks=BANK_COUNTS[layout.type])
            found.append(Contradiction("/cylinders", detail))
        elif layout.throws is not None and len(layout.throws) != count:
            found.append(Contradiction(f"{path}/throws", compose("engine-throw-list-length", count=count)))
        if count is not None and layout.positions is not None and len(layout.positions) != count:
            found.append(Contradiction(f"{path}/positions", compose("engine-throw-list-length", count=count)))
        # Other layouts are compared with their best throws, so that they may not give any.
        if path != "/layout" and layout.throws is not None:
            found.append(Contradiction(f"{path}/throws", compose("engine-throws-of-further-layouts")))
        return found

    def _find_force_errors(self) -> list[Contradiction]:
        found = []
        if self.speed_rpm is None and (self.masses is not None or self.pressure is not None):
            found.append(Contradiction("/speed_rpm", compose("engine-speed-missing")))
        if self.pressure is not None:
            # A pressure without a bore gives no force.
            if self.bore is None:
                found.append(Contradiction("/bore", compose("engine-bore-missing")))
            fault = find_period_error(self.pressure.table, self.cycle)
            if fault is not None:
                found.append(Contradiction("/pressure/table", fault))
        if self.masses is not None and self.masses.rod.cg > self.rod_length:
            found.append(Contradiction("/masses/rod/cg", compose("engine-rod-center-beyond-pin")))
        # Without masses or gas there is no torque to even out.
        if self.flywheel is not None and self.masses is None and self.pressure is None:
            found.append(Contradiction("/flywheel", compose("engine-flywheel-without-torque")))
        return found

    def _find_firing_errors(self) -> list[Contradiction]:
        found, order, given = [], self.firing_order, self.layout.throws is not None
        if order is not None and sorted(order) != list(range(1, self.cylinders + 1)):
            found.append(
                Contradiction("/firing_order", compose("engine-firing-order-incomplete", count=self.cylinders))
            )
        if self.firing_angles is not None and (order is None or len(order) != len(self.firing_angles)):
            found.append(Contradiction("/firing_angles", compose("engine-firing-angle-count")))
        # Given throws leave nothing to search.
        if given and (self.other_layouts or self.throw_angles is not None):
            path = "/other_layouts" if self.other_layouts else "/throw_angles"
            found.append(Contradiction(path, compose("engine-nothing-to-find")))
        if self.throw_angles is not None and not given:
            # A four-stroke cylinder may fire in either of two turns.
            choices = 1 if self.stroke_cycle == 2 else 1 << (self.cylinders - 1)
            for path, layout in self.layouts:
                count = layout.count_throws(self.cylinders) or 1
                # The first throw is fixed, as only differences matter.
                combinations = len(self.throw_angles) ** (count - 1)
                if combinations > MAX_COMBINATIONS or combinations * choices > MAX_CHOICES:
                    detail = compose(
                        "engine-too-many-combinations", combinations=combinations, count=count, layout=path
                    )
                    found.append(Contradiction("/throw_angles", detail))
        return found
