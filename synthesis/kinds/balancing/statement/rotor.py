"""Requested rotors: their unbalance, the planes, and the masses or holes that may correct it."""

from __future__ import annotations

import cmath
import math
from typing import Annotated, Literal, Self

from pydantic import Discriminator, Field, Tag, model_validator

from kinematics.message import compose
from synthesis.model.dimension import ANGLE, FORCE, GRADE, MASS, ROTATIONAL_SPEED
from synthesis.model.problem import (
    Contradiction,
    Coordinate,
    Count,
    Degrees,
    NonNegative,
    PositiveLength,
    PositiveNumber,
    ProblemBase,
    Statement,
)

MIN_SEPARATION = 1e-3
"""Minimum distance between two planes or bearings, as a share of the unbalances' distance from them. Closer planes
would carry thousands of times the unbalance, with a corresponding loss of digits."""

MAX_LEVELS = 200
"""Maximum number of depth steps of a hole, or of different stock weights."""

INDEPENDENCE_TOLERANCE = 1e-6
"""Share of the largest response below which the independent response of another plane is rounding, so that the runs do
not distinguish the planes."""


class RotorMass(Statement):
    """A mass of the rotor that is off its axis."""

    mass: Annotated[NonNegative, MASS]
    radius: PositiveLength = Field(description="Distance of its centre from the axis.")
    angle: Degrees = Field(description="Angle in the rotor.")
    z: Coordinate = Field(default=0.0, description="Place along the axis.")

    @property
    def moment(self) -> complex:
        """Unbalance m R e^{jθ}, masses times length units."""
        return cmath.rect(self.mass * self.radius, math.radians(self.angle))


class BearingReading(Statement):
    """A measured force of the turning rotor on a bearing."""

    force: Annotated[NonNegative, FORCE]
    angle: Degrees = Field(description="Angle in the rotor.")
    z: Coordinate = Field(description="Place of the bearing along the axis.")

    @property
    def vector(self) -> complex:
        """The force in the rotor's frame."""
        return cmath.rect(self.force, math.radians(self.angle))


class Reading(Statement):
    """A vibration in phase with the rotor: amplitude in any unit, and phase measured like the angles of the rotor."""

    amplitude: NonNegative
    angle: Degrees

    @property
    def vector(self) -> complex:
        """Amplitude and phase as a complex number."""
        return cmath.rect(self.amplitude, math.radians(self.angle))


Readings = Annotated[list[Reading], Field(min_length=1, max_length=8)]


class TrialRun(Statement):
    """A run with a trial weight in one of the planes only."""

    mass: Annotated[PositiveNumber, MASS]
    radius: PositiveLength
    angle: Degrees
    readings: Readings

    @property
    def moment(self) -> complex:
        """Unbalance m R e^{jθ} of the trial weight."""
        return cmath.rect(self.mass * self.radius, math.radians(self.angle))


class Influence(Statement):
    """Readings of the initial rotor, and of a run with a trial weight in each plane, in the order of the planes."""

    initial: Readings
    trials: list[TrialRun] = Field(min_length=1, max_length=2)


def _get_places_tag(value: object) -> str:
    return "<angles>" if isinstance(value, list | tuple) else "<count>"


Places = Annotated[
    Annotated[Annotated[Count, Field(ge=1, le=72)], Tag("<count>")]
    | Annotated[Annotated[list[Degrees], Field(min_length=1, max_length=72)], Tag("<angles>")],
    Discriminator(_get_places_tag),
]
"""Angles in the rotor: a number of equally spaced angles from 0° on, or a list of angles in degrees."""


class _PlaceChoice(Statement):
    angles: Annotated[Places, ANGLE] = Field(
        description="Number of places at equal angles from 0° on; or their angles, degrees."
    )
    radius: PositiveLength
    max_places: Annotated[Count, Field(ge=1, le=72)] | None = Field(
        default=None, description="Maximum number of places used in a plane."
    )

    @property
    def directions(self) -> list[float]:
        """The distinct angles, degrees."""
        if isinstance(self.angles, int):
            return [360.0 * k / self.angles for k in range(self.angles)]
        return sorted({angle % 360.0 for angle in self.angles})


class Holes(_PlaceChoice):
    """Holes that may be drilled at some angles, each in steps up to a maximum."""

    step: Annotated[PositiveNumber, MASS] = Field(description="Mass removed by one step of drilling.")
    max_per_hole: Annotated[PositiveNumber, MASS] = Field(description="Maximum mass removed by a hole.")

    @property
    def steps(self) -> int:
        """Maximum number of steps of a hole."""
        return math.floor(self.max_per_hole / self.step * (1.0 + 1e-12))

    @model_validator(mode="after")
    def _validate_steps(self) -> Self:
        if not 1 <= self.max_per_hole / self.step * (1.0 + 1e-12) < MAX_LEVELS + 1:
            raise ValueError(compose("balancing-hole-step-count", count=MAX_LEVELS))
        return self


class RotorStock(_PlaceChoice):
    """Weights in stock; one may be fixed at each of the given angles."""

    masses: list[Annotated[PositiveNumber, MASS]] = Field(min_length=1, max_length=MAX_LEVELS)


class Correction(Statement):
    """The correction of the rotor: one mass per plane, of given radius or given mass; holes; or stock weights."""

    radius: PositiveLength | None = Field(default=None, description="Radius of the masses, which follow from it.")
    mass: Annotated[PositiveNumber, MASS] | None = Field(
        default=None, description="Mass of each correction; the radii follow from it."
    )
    holes: Holes | None = None
    stock: RotorStock | None = None
    removed: bool = Field(
        default=False, strict=True, description="Whether the masses are removed from the rotor; for holes always."
    )

    @model_validator(mode="after")
    def _validate_choice(self) -> Self:
        if sum(stated is not None for stated in (self.radius, self.mass, self.holes, self.stock)) != 1:
            raise ValueError(compose("balancing-correction-choice"))
        if self.stock is not None and self.removed:
            raise ValueError(compose("balancing-stock-is-added"))
        return self

    @property
    def place_choice(self) -> Holes | RotorStock | None:
        """The requested holes or stock weights; None if the correction is one mass per plane."""
        return self.holes or self.stock


class RotorBase(ProblemBase):
    """The fields of a rotor."""

    units: Literal["si", "consistent"] = Field(
        default="si",
        description="Units of a rotor. `si`: kg and N, unbalances in g·mm. `consistent`: no conversion. A linkage has "
        "the units of its `dynamics`.",
    )
    masses: list[RotorMass] = Field(default=[], max_length=200, description="Masses of a rotor that are off its axis.")
    bearing_readings: list[BearingReading] = Field(
        default=[], max_length=2, description="Forces on the bearings of a rotor at `rpm`."
    )
    influence: Influence | None = Field(default=None, description="Runs of a rotor without and with trial weights.")
    rpm: Annotated[PositiveNumber, ROTATIONAL_SPEED] | None = Field(
        default=None, description="Speed of the rotor, revolutions per minute."
    )
    planes: list[Coordinate] = Field(
        default=[0.0],
        min_length=1,
        max_length=2,
        description="Places of a rotor's correction planes along the axis. A single plane balances the force only.",
    )
    bearings: tuple[Coordinate, Coordinate] | None = Field(
        default=None, description="Places of the bearings; by default those of the readings, else the two planes."
    )
    rotor_mass: Annotated[PositiveNumber, MASS] | None = Field(
        default=None, description="Mass of the rotor, for the balance grade."
    )
    max_grade: Annotated[PositiveNumber, GRADE] | None = Field(
        default=None, description="Maximum balance quality grade G of ISO 21940, mm/s."
    )
    correction: Correction | None = Field(
        default=None, description="Correction of the rotor; by default only the unbalances are reported."
    )
    rank_by: Literal["residual", "places"] = Field(
        default="residual",
        description="Ranking for a rotor. residual: the smallest first. places: the fewest masses or holes first.",
    )

    @property
    def used_planes(self) -> list[float]:
        """The planes of correction; two planes at one place count as one."""
        return self.planes[:1] if self.planes[0] == self.planes[-1] else self.planes

    @property
    def supports(self) -> list[float] | None:
        """Positions of both bearings along the axis; None if they are unknown."""
        if self.bearings is not None:
            return list(self.bearings)
        if len(self.bearing_readings) == 2:
            return [reading.z for reading in self.bearing_readings]
        return self.planes if len(self.used_planes) == 2 else None

    @property
    def places(self) -> list[float]:
        """Positions of the unbalances along the axis."""
        stated = [entry.z for entry in self.masses] + [entry.z for entry in self.bearing_readings]
        return stated or self.used_planes

    def find_rotor_errors(self) -> list[Contradiction]:
        """Return the errors of the rotor's fields.

        These are several sources of the unbalance or none, planes that are too close, a grade without a speed, and
        runs with trial weights that do not determine the unbalance.
        """
        found = []
        stated = [bool(self.masses), bool(self.bearing_readings), self.influence is not None]
        if sum(stated) != 1:
            detail = compose("balancing-unbalance-source-choice")
            found.append(Contradiction("/masses", detail))
        if self.bearing_readings and self.rpm is None:
            found.append(Contradiction("/rpm", compose("balancing-reading-speed-missing")))
        found += self._find_plane_errors()
        if self.influence is not None:
            found += self._find_influence_errors(self.influence)
        if self.max_grade is not None:
            found += [
                Contradiction(f"/{name}", compose("balancing-grade-needs-field"))
                for name in ("rpm", "rotor_mass")
                if getattr(self, name) is None
            ]
            if self.supports is None and any(z != self.planes[0] for z in self.places):
                detail = compose("balancing-couple-needs-bearings")
                found.append(Contradiction("/bearings", detail))
        return found

    def _find_plane_errors(self) -> list[Contradiction]:
        reach = max(abs(z - self.planes[0]) for z in [*self.places, *self.planes])
        apart = abs(self.planes[-1] - self.planes[0])
        if len(self.used_planes) == 2 and apart < MIN_SEPARATION * reach:
            detail = compose("balancing-planes-too-close")
            return [Contradiction("/planes", detail)]
        supports = self.supports
        if supports is not None:
            reach = max(abs(z - supports[0]) for z in [*self.places, *self.planes, supports[1]])
            if abs(supports[1] - supports[0]) <= MIN_SEPARATION * reach:
                path = "/bearings" if self.bearings is not None else "/bearing_readings/1/z"
                return [Contradiction(path, compose("balancing-bearings-too-close"))]
        return []

    def _find_influence_errors(self, influence: Influence) -> list[Contradiction]:
        planes, sensors = len(self.used_planes), len(influence.initial)
        if len(influence.trials) != planes:
            return [Contradiction("/influence/trials", compose("balancing-trial-run-count", count=planes))]
        for n, run in enumerate(influence.trials):
            if len(run.readings) != sensors:
                return [
                    Contradiction(
                        f"/influence/trials/{n}/readings", compose("balancing-reading-count-differs", count=sensors)
                    )
                ]
        if sensors < planes:
            return [Contradiction("/influence/initial", compose("balancing-reading-count-too-small", count=planes))]
        initial = [reading.vector for reading in influence.initial]
        columns = [
            [(reading.vector - at) / run.moment for reading, at in zip(run.readings, initial, strict=True)]
            for run in influence.trials
        ]
        # Magnitude of the response to each plane's trial weight.
        norms = [math.sqrt(sum(abs(entry) ** 2 for entry in column)) for column in columns]
        unlike = min(norms) / max(norms) if max(norms) > 0.0 else 0.0
        if planes == 2 and unlike > 0.0:
            # The sine of the angle between the two columns is zero if the planes respond alike.
            product = sum(one.conjugate() * other for one, other in zip(*columns, strict=True))
            unlike *= math.sqrt(max(0.0, 1.0 - (abs(product) / (norms[0] * norms[1])) ** 2))
        if not unlike > INDEPENDENCE_TOLERANCE:
            detail = compose("balancing-planes-indistinguishable")
            return [Contradiction("/influence/trials", detail)]
        return []
