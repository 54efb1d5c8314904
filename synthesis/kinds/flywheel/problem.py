"""Flywheels: a torque over a cycle, a speed, how much it may vary, and the limits of the wheel."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import ConfigDict, Field, JsonValue

from synthesis.model.dimension import DENSITY, ROTATIONAL_SPEED, SPEED
from synthesis.model.dynamics import METRES, StatedFlywheel, WeighedLinkage
from synthesis.model.loads import FULL_TURN, Interpolation, PairRows, Turns, period_fault
from synthesis.model.statement import Contradiction, PositiveLength, PositiveNumber, Range, StatedProblem, Statement

PULSE: list[JsonValue] = [[0.0, 10.0], [60.0, 10.0], [90.0, 160.0], [120.0, 160.0], [150.0, 10.0], [360.0, 10.0]]
"""A press that works over a sixth of a turn: the torque of the examples, N·m over degrees."""


class StatedTorque(Statement):
    """The torque of a shaft over its angle, as a table that repeats after whole turns."""

    table: PairRows = Field(description="Rows of the shaft's angle (°) and the torque.")
    interpolation: Interpolation = "linear"
    turns: Turns = Field(default=1, description="Turns of the shaft after which it repeats; 2 of a four-stroke engine.")
    side: Literal["demand", "supply"] = Field(
        default="demand",
        description="`demand`: what a machine takes from the shaft; `supply`: what an engine gives it. "
        "The other side is steady.",
    )


class Machine(Statement):
    """A linkage that the shaft drives, with its masses and loads: the torque is what it takes at constant speed."""

    mechanism: dict[str, Any] = Field(description="As in `POST /v1/analyses`; its input is the shaft.")
    dynamics: WeighedLinkage


class Most(Statement):
    """An upper limit of a length."""

    max: PositiveLength


class Least(Statement):
    """A lower limit of a length."""

    min: PositiveLength


class FastestRim(Statement):
    """The greatest speed of the rim at the shaft's greatest speed."""

    max: Annotated[PositiveNumber, SPEED] = Field(description="m/s, or in the consistent units.")


class Flattest(Statement):
    """The greatest radius, in thicknesses."""

    max: PositiveNumber


class Thickness(Range):
    """Least and greatest thickness of the wheel, along its axis."""

    min: PositiveLength | None = None
    max: PositiveLength | None = None


class FlywheelLimits(Statement):
    """What bounds the wheel. Its mass falls as its radius grows, so that one of these sets its size."""

    radius: Most | None = Field(default=None, description="Of the outside.")
    thickness: Thickness | None = None
    wall: Least | None = Field(default=None, description="Of a rim, between its inner and its outer radius.")
    rim_speed: FastestRim | None = None
    radius_to_thickness: Flattest | None = None


class FlywheelProblem(StatedProblem, StatedFlywheel):
    """Flywheel: the lightest disc or rim with which a shaft keeps its speed within a coefficient of fluctuation.

    The torque over a cycle is a table, or that of a linkage with masses and loads. The moment of inertia follows
    exactly, not to first order; the lightest wheel that has it stands at its limits, and the answer names those. The
    finished wheel is verified by integrating the speed of its shaft over two cycles.
    """

    model_config = ConfigDict(
        title="Flywheel",
        json_schema_extra={
            "examples": [
                {
                    "kind": "flywheel",
                    "torque": {"table": PULSE},
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
        description="`si`: kg, N·m, kg·m², s, and lengths in the length unit; `consistent`: nothing is converted.",
    )
    torque: StatedTorque | None = Field(default=None, description="Give this, or `machine`.")
    machine: Machine | None = None
    speed_rpm: Annotated[PositiveNumber, ROTATIONAL_SPEED] = Field(description="Mean over time.")
    form: Literal["disc", "rim", "any"] = Field(
        default="disc", description="A full disc, or a ring whose arms and hub are not counted."
    )
    density: Annotated[PositiveNumber, DENSITY]
    limits: FlywheelLimits

    @property
    def force_units(self) -> Literal["si", "consistent"]:
        """Those that are stated."""
        return self.units

    @property
    def scale(self) -> float:
        """The length unit in that of the inertia."""
        return METRES[self.length_unit] if self.units == "si" else 1.0

    @property
    def forms(self) -> tuple[Literal["disc", "rim"], ...]:
        """The forms that are asked for."""
        return ("disc", "rim") if self.form == "any" else (self.form,)

    def contradictions(self) -> list[Contradiction]:
        """A torque of two sources or none, tables that do not repeat, and wheels that nothing bounds."""
        found = []
        if (self.torque is None) == (self.machine is None):
            found.append(Contradiction("/torque", "give the torque as a table or by a machine, one of both"))
        if self.torque is not None:
            fault = period_fault(self.torque.table, FULL_TURN * self.torque.turns)
            if fault is not None:
                found.append(Contradiction("/torque/table", fault))
        if self.machine is not None:
            found += self._machine_faults(self.machine)
        return found + self._unbounded()

    def _unbounded(self) -> list[Contradiction]:
        limits, found = self.limits, []
        least = limits.thickness is not None and limits.thickness.min is not None
        # A rim of least thickness can still be as wide as it likes, with a wall the thinner.
        bounding = least and ("rim" not in self.forms or limits.wall is not None)
        if not (bounding or limits.radius or limits.rim_speed or limits.radius_to_thickness):
            detail = "unbounded: mass falls as the radius grows; limit radius, rim_speed or radius_to_thickness"
            found.append(Contradiction("/limits", f"{detail}, or the least thickness, of a rim with its least wall"))
        most = limits.thickness is not None and limits.thickness.max is not None
        if "rim" in self.forms and not (most or limits.wall):
            detail = "unbounded: a rim is the lighter the thinner its wall; limit the greatest thickness or the wall"
            found.append(Contradiction("/limits", detail))
        if self.form == "disc" and limits.wall is not None:
            found.append(Contradiction("/limits/wall", "a disc has no wall; ask for a rim, or drop the limit"))
        return found

    def _machine_faults(self, machine: Machine) -> list[Contradiction]:
        """Faults of the mechanism and its block, as an analysis tells them."""
        # It brings the analysis core, for which the parsing of problems does not wait.
        from synthesis.analyses.weighed import weighed_faults

        if machine.dynamics.units != self.units:
            detail = f"the wheel is stated in units {self.units}; state the machine in them too"
            return [Contradiction("/machine/dynamics/units", detail)]
        faults = weighed_faults(machine.mechanism, machine.dynamics, self.length_unit, shaft=True)
        return [Contradiction(f"/machine{path}", detail) for path, detail in faults]
