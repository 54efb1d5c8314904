"""Rotors as a client states them: their unbalance, the planes, and the masses or holes that may correct it."""

from __future__ import annotations

import cmath
import math
from typing import Annotated, Any, Literal, Self

from pydantic import Discriminator, Field, Tag, model_validator

from synthesis.model.dimension import ANGLE, FORCE, GRADE, MASS, ROTATIONAL_SPEED
from synthesis.model.statement import (
    Contradiction,
    Coordinate,
    Count,
    Degrees,
    NonNegative,
    PositiveLength,
    PositiveNumber,
    StatedProblem,
    Statement,
)

APART = 1e-3
"""Least distance of two planes or bearings, as a share of how far from them the unbalances are: nearer ones would have
to carry thousands of times what they balance, and the digits for it are lost."""

MOST_LEVELS = 200
"""Steps of a hole, or weights in stock, at most."""

INDEPENDENT = 1e-6
"""Share of the largest response below which that of another plane is rounding: the runs do not tell planes apart."""


class RotorMass(Statement):
    """A mass of the rotor that is off its axis."""

    mass: Annotated[NonNegative, MASS]
    radius: PositiveLength = Field(description="Of its centre, from the axis.")
    angle: Degrees = Field(description="In the rotor.")
    z: Coordinate = Field(default=0.0, description="Place along the axis.")

    @property
    def moment(self) -> complex:
        """m R e^{jθ}, masses times length units."""
        return cmath.rect(self.mass * self.radius, math.radians(self.angle))


class BearingReading(Statement):
    """The force of the turning rotor on a bearing, as it was measured."""

    force: Annotated[NonNegative, FORCE]
    angle: Degrees = Field(description="In the rotor.")
    z: Coordinate = Field(description="Place of the bearing along the axis.")

    @property
    def vector(self) -> complex:
        """The force in the rotor's frame."""
        return cmath.rect(self.force, math.radians(self.angle))


class Reading(Statement):
    """A vibration that turns with the rotor: amplitude in any unit, and phase counted as the angles of the rotor."""

    amplitude: NonNegative
    angle: Degrees

    @property
    def vector(self) -> complex:
        """Amplitude and phase."""
        return cmath.rect(self.amplitude, math.radians(self.angle))


Readings = Annotated[list[Reading], Field(min_length=1, max_length=8)]


class TrialRun(Statement):
    """A run with a trial weight in one of the planes, and with none in the other."""

    mass: Annotated[PositiveNumber, MASS]
    radius: PositiveLength
    angle: Degrees
    readings: Readings

    @property
    def moment(self) -> complex:
        """m R e^{jθ} of the trial weight."""
        return cmath.rect(self.mass * self.radius, math.radians(self.angle))


class Influence(Statement):
    """Readings of the rotor as it is, and of a run with a trial weight in each plane, in the order of the planes."""

    initial: Readings
    trials: list[TrialRun] = Field(min_length=1, max_length=2)


def _places_tag(stated: Any) -> str:
    return "<angles>" if isinstance(stated, list | tuple) else "<count>"


Places = Annotated[
    Annotated[Annotated[Count, Field(ge=1, le=72)], Tag("<count>")]
    | Annotated[Annotated[list[Degrees], Field(min_length=1, max_length=72)], Tag("<angles>")],
    Discriminator(_places_tag),
]
"""Angles in the rotor: how many at equal distances, from 0° on, or each."""


class _Placed(Statement):
    angles: Annotated[Places, ANGLE] = Field(
        description="How many places there are, at equal angles from 0° on; or their angles, degrees."
    )
    radius: PositiveLength
    max_places: Annotated[Count, Field(ge=1, le=72)] | None = Field(
        default=None, description="Most places of a plane that are used."
    )

    @property
    def directions(self) -> list[float]:
        """The angles, degrees, each once."""
        if isinstance(self.angles, int):
            return [360.0 * k / self.angles for k in range(self.angles)]
        return sorted({angle % 360.0 for angle in self.angles})


class Holes(_Placed):
    """Holes that may be drilled at some angles, each in steps up to a greatest one."""

    step: Annotated[PositiveNumber, MASS] = Field(description="Mass that a step of drilling takes away.")
    max_per_hole: Annotated[PositiveNumber, MASS] = Field(description="The greatest mass that a hole takes away.")

    @property
    def steps(self) -> int:
        """Most steps of a hole."""
        return math.floor(self.max_per_hole / self.step * (1.0 + 1e-12))

    @model_validator(mode="after")
    def _some_steps(self) -> Self:
        if not 1 <= self.max_per_hole / self.step * (1.0 + 1e-12) < MOST_LEVELS + 1:
            raise ValueError(f"max_per_hole must be 1 to {MOST_LEVELS} steps")
        return self


class Stock(_Placed):
    """Weights in stock, of which one may be fixed at each of some angles."""

    masses: list[Annotated[PositiveNumber, MASS]] = Field(min_length=1, max_length=MOST_LEVELS)


class Correction(Statement):
    """How the rotor is corrected: by one mass a plane, of given radius or given mass; by holes; or by stock weights."""

    radius: PositiveLength | None = Field(default=None, description="Of the masses; they follow.")
    mass: Annotated[PositiveNumber, MASS] | None = Field(default=None, description="Of each mass; the radii follow.")
    holes: Holes | None = None
    stock: Stock | None = None
    removed: bool = Field(
        default=False, strict=True, description="Whether the masses are taken from the rotor; of holes they always are."
    )

    @model_validator(mode="after")
    def _one_way(self) -> Self:
        if sum(stated is not None for stated in (self.radius, self.mass, self.holes, self.stock)) != 1:
            raise ValueError("give exactly one of radius, mass, holes and stock")
        if self.stock is not None and self.removed:
            raise ValueError("weights in stock are added")
        return self

    @property
    def placed(self) -> Holes | Stock | None:
        """The places, where the choice is among some."""
        return self.holes or self.stock


class StatedRotor(StatedProblem):
    """What is stated of a rotor."""

    units: Literal["si", "consistent"] = Field(
        default="si",
        description="Of a rotor. `si`: kg and N, unbalances in g·mm. `consistent`: nothing is converted. A linkage has "
        "those of its `dynamics`.",
    )
    masses: list[RotorMass] = Field(default=[], max_length=200, description="Of a rotor: what is off its axis.")
    bearing_readings: list[BearingReading] = Field(
        default=[], max_length=2, description="Of a rotor: forces on its bearings at `rpm`."
    )
    influence: Influence | None = Field(default=None, description="Of a rotor: runs without and with trial weights.")
    rpm: Annotated[PositiveNumber, ROTATIONAL_SPEED] | None = Field(
        default=None, description="Speed of the rotor, revolutions a minute."
    )
    planes: list[Coordinate] = Field(
        default=[0.0],
        min_length=1,
        max_length=2,
        description="Of a rotor: places of the planes along the axis. In one the force alone is balanced.",
    )
    bearings: tuple[Coordinate, Coordinate] | None = Field(
        default=None, description="Places of the bearings; by default those of the readings, else the two planes."
    )
    rotor_mass: Annotated[PositiveNumber, MASS] | None = Field(default=None, description="For the balance grade.")
    max_grade: Annotated[PositiveNumber, GRADE] | None = Field(
        default=None, description="Balance quality grade G of ISO 21940 that must be kept, mm/s."
    )
    correction: Correction | None = Field(default=None, description="By default the unbalances alone are told.")
    rank_by: Literal["residual", "places"] = Field(
        default="residual",
        description="Of a rotor. residual: the least first. places: the fewest masses or holes first.",
    )

    @property
    def used_planes(self) -> list[float]:
        """The planes: two at one place are one."""
        return self.planes[:1] if self.planes[0] == self.planes[-1] else self.planes

    @property
    def supports(self) -> list[float] | None:
        """Places of both bearings; None where nothing tells them."""
        if self.bearings is not None:
            return list(self.bearings)
        if len(self.bearing_readings) == 2:
            return [reading.z for reading in self.bearing_readings]
        return self.planes if len(self.used_planes) == 2 else None

    @property
    def places(self) -> list[float]:
        """Where along the axis the unbalances are."""
        stated = [entry.z for entry in self.masses] + [entry.z for entry in self.bearing_readings]
        return stated or self.used_planes

    def rotor_faults(self) -> list[Contradiction]:
        """Several unbalances or none, planes too near to each other, a grade of no speed, runs that tell nothing."""
        found = []
        stated = [bool(self.masses), bool(self.bearing_readings), self.influence is not None]
        if sum(stated) != 1:
            detail = "state the unbalance once: by masses, by bearing_readings, or by influence"
            found.append(Contradiction("/masses", detail))
        if self.bearing_readings and self.rpm is None:
            found.append(Contradiction("/rpm", "forces on bearings tell an unbalance at a speed only; state it"))
        found += self._plane_faults()
        if self.influence is not None:
            found += self._influence_faults(self.influence)
        if self.max_grade is not None:
            found += [
                Contradiction(f"/{name}", "the balance grade needs it: e ω = U/m ω")
                for name in ("rpm", "rotor_mass")
                if getattr(self, name) is None
            ]
            if self.supports is None and any(z != self.planes[0] for z in self.places):
                detail = "what lies beside the one plane makes a couple, which counts at the bearings; state them"
                found.append(Contradiction("/bearings", detail))
        return found

    def _plane_faults(self) -> list[Contradiction]:
        reach = max(abs(z - self.planes[0]) for z in [*self.places, *self.planes])
        apart = abs(self.planes[-1] - self.planes[0])
        if len(self.used_planes) == 2 and apart < APART * reach:
            detail = "two planes must be apart; one place is one plane, which balances what lies in it"
            return [Contradiction("/planes", detail)]
        supports = self.supports
        if supports is not None:
            reach = max(abs(z - supports[0]) for z in [*self.places, *self.planes, supports[1]])
            if abs(supports[1] - supports[0]) <= APART * reach:
                path = "/bearings" if self.bearings is not None else "/bearing_readings/1/z"
                return [Contradiction(path, "the two bearings must be apart")]
        return []

    def _influence_faults(self, influence: Influence) -> list[Contradiction]:
        planes, sensors = len(self.used_planes), len(influence.initial)
        if len(influence.trials) != planes:
            return [Contradiction("/influence/trials", f"{planes} planes need as many runs with a trial weight")]
        for n, run in enumerate(influence.trials):
            if len(run.readings) != sensors:
                return [Contradiction(f"/influence/trials/{n}/readings", f"the initial run has {sensors} readings")]
        if sensors < planes:
            return [Contradiction("/influence/initial", f"{planes} planes need as many readings at least")]
        initial = [reading.vector for reading in influence.initial]
        columns = [
            [(reading.vector - at) / run.moment for reading, at in zip(run.readings, initial, strict=True)]
            for run in influence.trials
        ]
        norms = [math.sqrt(sum(abs(entry) ** 2 for entry in column)) for column in columns]
        unlike = min(norms) / max(norms) if max(norms) > 0.0 else 0.0
        if planes == 2 and unlike > 0.0:
            product = sum(one.conjugate() * other for one, other in zip(*columns, strict=True))
            unlike *= math.sqrt(max(0.0, 1.0 - (abs(product) / (norms[0] * norms[1])) ** 2))
        if not unlike > INDEPENDENT:
            detail = "the trial weights change the readings not at all, or alike; the planes cannot be told apart"
            return [Contradiction("/influence/trials", detail)]
        return []
