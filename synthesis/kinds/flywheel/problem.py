"""Flywheels: a torque over a cycle, a speed with its permitted fluctuation, and the limits of the wheel."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import ConfigDict, Field, JsonValue

from kinematics.message import compose
from synthesis.model.dimension import DENSITY, ROTATIONAL_SPEED, SPEED
from synthesis.model.dynamics.loads import FULL_TURN, Interpolation, PairRows, Turns, find_period_error
from synthesis.model.dynamics.request import METRES_PER_UNIT, FlywheelSpec, LoadedLinkage
from synthesis.model.json_object import JsonObject
from synthesis.model.problem import Contradiction, PositiveLength, PositiveNumber, ProblemBase, Range, Statement

EXAMPLE_TORQUE: list[JsonValue] = [
    [0.0, 10.0],
    [60.0, 10.0],
    [90.0, 160.0],
    [120.0, 160.0],
    [150.0, 10.0],
    [360.0, 10.0],
]
"""Torque of the examples, N·m over degrees: a press that works over a sixth of a turn."""


class TorqueTable(Statement):
    """The torque of a shaft over its angle, as a table that repeats after whole turns."""

    table: PairRows = Field(description="Rows of shaft angle (°) and torque.")
    interpolation: Interpolation = "linear"
    turns: Turns = Field(
        default=1, description="Turns of the shaft after which the torque repeats; 2 for a four-stroke engine."
    )
    side: Literal["demand", "supply"] = Field(
        default="demand",
        description="`demand`: torque that a machine takes from the shaft; `supply`: torque that an engine gives it. "
        "The other side is constant.",
    )


class Machine(Statement):
    """A linkage driven by the shaft, with its masses and loads; its torque is computed at constant speed."""

    mechanism: JsonObject = Field(description="Mechanism as in `POST /v1/analyses`; its input is the shaft.")
    dynamics: LoadedLinkage


class MaxLength(Statement):
    """An upper limit of a length."""

    max: PositiveLength


class MinLength(Statement):
    """A lower limit of a length."""

    min: PositiveLength


class MaxRimSpeed(Statement):
    """Maximum speed of the rim at the shaft's greatest speed."""

    max: Annotated[PositiveNumber, SPEED] = Field(description="Maximum rim speed, m/s or in consistent units.")


class MaxSlenderness(Statement):
    """Maximum ratio of radius to thickness."""

    max: PositiveNumber


class Thickness(Range):
    """Minimum and maximum thickness of the wheel, along its axis."""

    min: PositiveLength | None = None
    max: PositiveLength | None = None


class FlywheelLimits(Statement):
    """Limits of the wheel. Its mass falls as its radius grows, so that one of these determines its size."""

    radius: MaxLength | None = Field(default=None, description="Limit of the outer radius.")
    thickness: Thickness | None = None
    wall: MinLength | None = Field(
        default=None, description="Limit of a rim's wall, between its inner and its outer radius."
    )
    rim_speed: MaxRimSpeed | None = None
    radius_to_thickness: MaxSlenderness | None = None


class FlywheelProblem(ProblemBase, FlywheelSpec):
    """Flywheel: the lightest disc or rim with which a shaft keeps its speed within a coefficient of fluctuation.

    The torque over a cycle is a table, or that of a linkage with masses and loads. The moment of inertia follows
    exactly, not just to first order; the lightest wheel with this inertia is at some limits, and the answer names them.
    The finished wheel is verified by integrating the speed of its shaft over two cycles.
    """

    model_config = ConfigDict(
        title="Flywheel",
        json_schema_extra={
            "examples": [
                {
                    "kind": "flywheel",
                    "torque": {"table": EXAMPLE_TORQUE},
                    "speed_rpm": 300.0,
                    "coefficient": 0.05,
                    "form": "any",
                    "density": 7800.0,
                    "limits": {"radius": {"max": 250.0}, "thickness": {"min": 5.0, "max": 60.0}},
                },
                {
                    "kind": "flywheel",
                    "machine": {
                        "mechanism": {
                            "type": "slider_crank",
                            "fixed_pivot": [0.0, 0.0],
                            "links": {"crank": 50.0, "coupler": 180.0},
                            "slide": {"point": [0.0, 0.0], "angle": 0.0},
                        },
                        "dynamics": {
                            "point_masses": [{"joint": "B", "mass": 1.2}],
                            "loads": [
                                {"joint": "B", "force": {"against_motion": {"forward": 2000.0, "backward": 0.0}}}
                            ],
                        },
                    },
                    "speed_rpm": 240.0,
                    "coefficient": 0.02,
                    "existing_inertia": 0.05,
                    "form": "rim",
                    "density": 7200.0,
                    "limits": {"rim_speed": {"max": 12.0}, "thickness": {"max": 60.0}, "wall": {"min": 8.0}},
                },
            ]
        },
    )

    kind: Literal["flywheel"]
    units: Literal["si", "consistent"] = Field(
        default="si",
        description="`si`: kg, N·m, kg·m², s, and lengths in the length unit; `consistent`: no conversion.",
    )
    torque: TorqueTable | None = Field(default=None, description="Torque table; give this or `machine`.")
    machine: Machine | None = None
    speed_rpm: Annotated[PositiveNumber, ROTATIONAL_SPEED] = Field(description="Shaft speed, mean over time.")
    form: Literal["disc", "rim", "any"] = Field(
        default="disc", description="A full disc, or a ring whose arms and hub are not counted."
    )
    density: Annotated[PositiveNumber, DENSITY]
    limits: FlywheelLimits

    @property
    def force_units(self) -> Literal["si", "consistent"]:
        """The given units."""
        return self.units

    @property
    def scale(self) -> float:
        """The length unit in the unit of the inertia."""
        return METRES_PER_UNIT[self.length_unit] if self.units == "si" else 1.0

    @property
    def forms(self) -> tuple[Literal["disc", "rim"], ...]:
        """The requested forms."""
        return ("disc", "rim") if self.form == "any" else (self.form,)

    def find_contradictions(self) -> list[Contradiction]:
        """Return a torque with two sources or none, tables that do not repeat, and wheels without bounds."""
        found = []
        if (self.torque is None) == (self.machine is None):
            found.append(Contradiction("/torque", compose("flywheel-torque-source-choice")))
        if self.torque is not None:
            fault = find_period_error(self.torque.table, FULL_TURN * self.torque.turns)
            if fault is not None:
                found.append(Contradiction("/torque/table", fault))
        if self.machine is not None:
            found += self._find_machine_errors(self.machine)
        return found + self._check_bounds()

    def _check_bounds(self) -> list[Contradiction]:
        limits, found = self.limits, []
        least = limits.thickness is not None and limits.thickness.min is not None
        # With a minimum thickness alone, a rim can still grow without bound as its wall gets thinner.
        bounding = least and ("rim" not in self.forms or limits.wall is not None)
        if not (bounding or limits.radius or limits.rim_speed or limits.radius_to_thickness):
            found.append(Contradiction("/limits", compose("flywheel-mass-unbounded")))
        most = limits.thickness is not None and limits.thickness.max is not None
        if "rim" in self.forms and not (most or limits.wall):
            detail = compose("flywheel-wall-unbounded")
            found.append(Contradiction("/limits", detail))
        if self.form == "disc" and limits.wall is not None:
            found.append(Contradiction("/limits/wall", compose("flywheel-disc-has-no-wall")))
        return found

    def _find_machine_errors(self, machine: Machine) -> list[Contradiction]:
        """Return the errors of the mechanism and its dynamics as the analysis reports them."""
        # Imported here because it loads the analysis core, which parsing a problem should not wait for.
        from synthesis.analyses.linkages.loaded_mechanism import find_loaded_errors

        if machine.dynamics.units != self.units:
            detail = compose("flywheel-units-differ", units=self.units)
            return [Contradiction("/machine/dynamics/units", detail)]
        faults = find_loaded_errors(machine.mechanism, machine.dynamics, self.length_unit, shaft=True)
        return [Contradiction(f"/machine{path}", detail) for path, detail in faults]
