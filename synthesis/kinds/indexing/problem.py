"""Indexing: a wheel that is turned from station to station and held in between, by one of several drives."""

from __future__ import annotations

import math
from typing import Annotated, Literal

from pydantic import ConfigDict, Field

from kinematics.message import compose
from synthesis.model.dimension import (
    ACCELERATION,
    ANGLE,
    FORCE,
    INERTIA,
    LENGTH,
    ROTATIONAL_SPEED,
    TORQUE,
)
from synthesis.model.dynamics.request import METRES_PER_UNIT
from synthesis.model.problem import (
    Contradiction,
    Count,
    Flag,
    NonNegative,
    PositiveLength,
    PositiveNumber,
    ProblemBase,
    Range,
    Statement,
)

MAX_STATIONS, MAX_STOPS = 48, 720
"""Maximum number of stations of a Geneva wheel, which would be all slots beyond; and of stops of a ratchet."""

MIN_TEETH, MAX_GROUPS = 12, 4
"""Minimum number of teeth of a ratchet wheel with straight backs; maximum number of groups of staggered pawls."""

MAX_CRANK_RATIO = 0.999
"""Maximum crank radius over center distance of a plane drive: at 1 the roller would reach the wheel's axis."""

CRANK_TOLERANCE = 1e-5
"""Maximum relative difference of a crank that counts as the crank of shock-free entry, for input with six digits."""

MAX_ROLLERS = 5
"""Maximum number of rollers on a crank."""

MIN_CLEARANCE, MAX_CLEARANCE = 0.01, 3.0
"""Minimum clearance at the end of a slot and at the disc, and maximum of any clearance, in roller diameters."""

DEFAULT_TRANSMISSION_ANGLE = 40.0
"""Default minimum transmission angle of a drag link, degrees."""

Share = Annotated[float, Field(strict=True, gt=0.0, lt=1.0, allow_inf_nan=False)]


class DwellShare(Range):
    """Minimum and maximum share of the time in which the wheel rests."""

    min: Share | None = None
    max: Share | None = None


class IndexingConstraints(Statement):
    """Constraints on a drive."""

    dwell_share: DwellShare | None = None
    peak_acceleration: Annotated[PositiveNumber, ACCELERATION] | None = Field(
        default=None, description="Maximum acceleration of the wheel, with respect to the crank's angle."
    )
    drive_torque: Annotated[PositiveNumber, TORQUE] | None = Field(
        default=None, description="Maximum torque on the crank in either direction."
    )
    pin_force: Annotated[PositiveNumber, FORCE] | None = Field(
        default=None, description="Maximum force between roller and slot."
    )
    size: PositiveLength | None = Field(
        default=None,
        description="Maximum extent: along the line of both axes, or the diameter of a ring or sphere.",
    )
    steady_share: Share | None = Field(
        default=None,
        description="Minimum share of an index, in input angle, in which the wheel has at least nine tenths of its "
        "greatest speed.",
    )
    min_transmission_angle: Annotated[float, Field(strict=True, ge=0.0, le=80.0, allow_inf_nan=False), ANGLE] | None = (
        Field(
            default=None,
            description="Minimum transmission angle of a drag link, between coupler and output; default 40 degrees.",
        )
    )
    shock_free: Flag = Field(
        default=True, description="Whether the roller must enter along the slot, with the wheel at rest."
    )


class Clearances(Statement):
    """Clearances between the parts."""

    slot: Annotated[NonNegative, LENGTH] = Field(
        default=0.0, description="Width of the slot minus the roller's diameter."
    )
    locking: Annotated[NonNegative, LENGTH] = Field(
        default=0.0, description="Radius of the wheel's locking arcs minus the disc's."
    )
    slot_end: PositiveLength | None = Field(
        default=None,
        description="Clearance of the roller at its deepest from the end of the slot; default a twentieth of its "
        "diameter.",
    )
    relief: PositiveLength | None = Field(
        default=None,
        description="Clearance of the disc from the passing wheel, outside the locking arc; default a twentieth of "
        "the roller's diameter.",
    )


class Ratcheting(Statement):
    """Pawls and teeth of a ratchet."""

    count: Annotated[Count, Field(ge=1, le=16)] | None = Field(
        default=None,
        description="Number of all pawls; by default, one design for each number that gives the stations with some "
        "number of teeth.",
    )
    overlap: Annotated[Count, Field(ge=1, le=4)] = Field(
        default=1, description="Number of pawls that hold the wheel at the same time and share its load."
    )
    wheel_radius: PositiveLength | None = Field(default=None, description="Radius to the tips; default: the smallest.")
    tooth_height: PositiveLength | None = Field(
        default=None, description="Tooth height; default a third of the pitch, or more for few teeth."
    )
    length: PositiveLength | None = Field(
        default=None,
        description="Distance from the face of the held tooth to the pawl's pivot; default: the wheel's radius.",
    )
    friction: NonNegative = Field(default=0.15, description="Coefficient of friction between tooth and pawl.")
    face_angle: Annotated[float, Field(strict=True, ge=0.0, le=60.0, allow_inf_nan=False), ANGLE] | None = Field(
        default=None,
        description="Angle between a tooth's face and the radius, leaning over the pawl; default: the smallest that "
        "locks.",
    )
    reserve: Annotated[float, Field(strict=True, ge=0.0, le=30.0, allow_inf_nan=False), ANGLE] = Field(
        default=2.0, description="Reserve of the locking angle beyond the friction angle."
    )


class IndexingProblem(ProblemBase):
    """Indexing: a wheel turned from station to station by a crank's roller, and locked in between; or held by pawls.

    External, internal and spherical Geneva drives, and ratchets. Motion, torque and pin force follow in closed form;
    without a given size the smallest is found whose walls and forces satisfy the constraints. Every answer is verified
    by its own outlines: the roller is driven through the slots, the disc past the wheel, teeth under pawls, and forces
    follow from reactions and energy.
    """

    model_config = ConfigDict(
        title="Indexing drive",
        json_schema_extra={
            "examples": [
                {
                    "kind": "indexing",
                    "drive": "geneva_external",
                    "stations": 6,
                    "center_distance": 80.0,
                    "roller_diameter": 12.0,
                    "speed_rpm": 60.0,
                    "load_inertia": 0.02,
                },
                {
                    "kind": "indexing",
                    "drive": "geneva_external",
                    "stations": 8,
                    "roller_diameter": 10.0,
                    "wall_thickness": 4.0,
                    "wheel_shaft_diameter": 25.0,
                    "crank_shaft_diameter": 6.0,
                    "speed_rpm": 90.0,
                    "load_inertia": 0.05,
                    "load_torque": 2.0,
                    "constraints": {"pin_force": 60.0, "dwell_share": {"min": 0.2, "max": 0.7}},
                },
                {
                    "kind": "indexing",
                    "drive": "geneva_internal",
                    "stations": 4,
                    "center_distance": 70.0,
                    "roller_diameter": 10.0,
                    "wall_thickness": 5.0,
                    "clearances": {"slot": 0.05, "locking": 0.05},
                    "speed_rpm": 120.0,
                    "load_inertia": 0.03,
                },
                {
                    "kind": "indexing",
                    "drive": "geneva_spherical",
                    "stations": 4,
                    "roller_diameter": 10.0,
                    "wheel_shaft_diameter": 20.0,
                    "speed_rpm": 100.0,
                    "load_inertia": 0.01,
                    "constraints": {"pin_force": 40.0},
                },
                {
                    "kind": "indexing",
                    "drive": "geneva_external",
                    "driver": "drag_link",
                    "stations": 4,
                    "center_distance": 100.0,
                    "roller_diameter": 12.0,
                    "speed_rpm": 60.0,
                    "load_inertia": 0.02,
                    "constraints": {"dwell_share": {"min": 0.6}},
                },
                {
                    "kind": "indexing",
                    "drive": "ratchet",
                    "stations": 36,
                    "wall_thickness": 6.0,
                    "wheel_shaft_diameter": 30.0,
                    "load_torque": 40.0,
                    "pawls": {"friction": 0.2},
                    "constraints": {"pin_force": 800.0},
                },
            ]
        },
    )

    kind: Literal["indexing"]
    units: Literal["si", "consistent"] = Field(
        default="si", description="`si`: N, N·m, kg·m², and lengths in the length unit; `consistent`: no conversion."
    )
    drive: Literal["geneva_external", "geneva_internal", "geneva_spherical", "ratchet"] = Field(
        description="Wheel next to the crank, ring around it, or a hemisphere whose axis crosses the crank's at a "
        "right "
        "angle; or a toothed wheel that pawls hold against turning back.",
    )
    driver: Literal["crank", "drag_link"] = Field(
        default="crank",
        description="The part that turns at constant speed: the crank with the roller, or the input of a drag link "
        "whose "
        "output is that crank, found for the minimum peak acceleration of a plane Geneva drive.",
    )
    stations: Annotated[Count, Field(ge=3, le=MAX_STOPS)] = Field(
        description=f"Number of stations, up to {MAX_STATIONS} for a Geneva drive; for a ratchet the number of stops "
        "in a turn."
    )
    rollers: Annotated[Count, Field(ge=1, le=MAX_ROLLERS)] | None = Field(
        default=None,
        description="Rollers on the crank, equally spaced; default: one design for each number with which the wheel "
        "rests.",
    )
    center_distance: PositiveLength | None = Field(
        default=None, description="Center distance of a drive in the plane; default: the smallest is found."
    )
    sphere_radius: PositiveLength | None = Field(
        default=None,
        description="Radius of a spherical drive to the middle of the roller; default: the smallest is found.",
    )
    crank_radius: PositiveLength | None = Field(
        default=None,
        description="Crank radius of a drive in the plane; default, and within 1e-5 of it: that of shock-free entry.",
    )
    roller_diameter: PositiveLength | None = Field(default=None, description="Roller diameter of a Geneva drive.")
    wall_thickness: PositiveLength | None = Field(
        default=None,
        description="Thickness between slot and locking arc; between the ends of slots, and between them and the "
        "bore, it "
        "is the minimum. Default: half of the roller's diameter. For a ratchet: of a tooth at its foot, and above the "
        "bore.",
    )
    pawls: Ratcheting | None = Field(default=None, description="Pawls and teeth of a ratchet.")
    wheel_shaft_diameter: Annotated[NonNegative, LENGTH] = Field(
        default=0.0, description="Diameter of the wheel's bore."
    )
    crank_shaft_diameter: Annotated[NonNegative, LENGTH] = Field(
        default=0.0, description="Diameter of the crank's shaft through the plane of an external wheel; 0: overhung."
    )
    clearances: Clearances = Clearances()
    speed_rpm: Annotated[PositiveNumber, ROTATIONAL_SPEED] | None = Field(
        default=None, description="Constant speed of the crank of a Geneva drive."
    )
    load_inertia: Annotated[NonNegative, INERTIA] = Field(
        default=0.0, description="Moment of inertia about the wheel's axis, including the wheel."
    )
    load_torque: Annotated[NonNegative, TORQUE] = Field(
        default=0.0,
        description="Torque against the wheel's motion, while it moves; for a ratchet the torque that it holds.",
    )
    constraints: IndexingConstraints = IndexingConstraints()

    @property
    def force_units(self) -> Literal["si", "consistent"]:
        """The given units."""
        return self.units

    @property
    def is_oscillating(self) -> bool:
        """True: displacements are angles of the wheel."""
        return True

    @property
    def roller(self) -> float:
        """The diameter of a Geneva drive's roller."""
        assert self.roller_diameter is not None
        return self.roller_diameter

    @property
    def crank_speed(self) -> float:
        """Speed of the crank of a Geneva drive, rad/s."""
        assert self.speed_rpm is not None
        return self.speed_rpm * math.pi / 30.0

    @property
    def transmission_angle(self) -> float:
        """Minimum transmission angle of a drag link, degrees."""
        stated = self.constraints.min_transmission_angle
        return DEFAULT_TRANSMISSION_ANGLE if stated is None else stated

    @property
    def scale(self) -> float:
        """The length unit in the unit of torque over force."""
        return METRES_PER_UNIT[self.length_unit] if self.units == "si" else 1.0

    @property
    def spherical(self) -> bool:
        """True if the axes cross."""
        return self.drive == "geneva_spherical"

    @property
    def wall(self) -> float:
        """The thickness of walls."""
        return self.wall_thickness if self.wall_thickness is not None else 0.5 * self.roller

    @property
    def slot_room(self) -> float:
        """Clearance at the end of a slot."""
        stated = self.clearances.slot_end
        return 0.05 * self.roller if stated is None else stated

    @property
    def relief(self) -> float:
        """Clearance of the disc from the passing wheel."""
        stated = self.clearances.relief
        return 0.05 * self.roller if stated is None else stated

    def find_contradictions(self) -> list[Contradiction]:
        """Return fields of another drive, rollers that leave no rest, and cranks that reach no slot."""
        if self.drive == "ratchet":
            return self._find_ratchet_errors()
        found = [
            Contradiction(f"/{name}", compose("indexing-field-required", drive=self.drive))
            for name in ("roller_diameter", "speed_rpm")
            if getattr(self, name) is None
        ]
        if self.stations > MAX_STATIONS:
            found.append(Contradiction("/stations", compose("indexing-too-many-stations", count=MAX_STATIONS)))
        if self.pawls is not None:
            found.append(Contradiction("/pawls", compose("indexing-field-not-for-drive", drive=self.drive)))
        if found:
            return found
        # Beyond this line the roller and the speed are given.
        found += self._find_driver_errors()
        # A spherical drive has a sphere radius instead of lengths in the plane.
        foreign = ("center_distance", "crank_radius") if self.spherical else ("sphere_radius",)
        found += [
            Contradiction(f"/{name}", compose("indexing-field-not-for-drive", drive=self.drive))
            for name in foreign
            if getattr(self, name) is not None
        ]
        # The default crank enters the slots without shock.
        if not self.constraints.shock_free and self.crank_radius is None:
            detail = compose("indexing-no-shock-possible")
            found.append(Contradiction("/constraints/shock_free", detail))
        if not self.spherical and self.crank_radius is not None:
            found += self._find_crank_errors(self.crank_radius)
            if found:
                return found
        most = self.most_rollers
        if self.rollers is not None and self.rollers > most:
            detail = compose("indexing-rollers-leave-no-rest", stations=self.stations, rollers=most)
            if self.drive != "geneva_external":
                detail = compose("indexing-single-roller-only", drive=self.drive)
            found.append(Contradiction("/rollers", detail))
        # Only in an external drive do the slots stay clear of the crank's axis.
        if self.drive != "geneva_external" and self.crank_shaft_diameter > 0.0:
            detail = compose("indexing-crank-overhung", drive=self.drive)
            found.append(Contradiction("/crank_shaft_diameter", detail))
        if self.drive == "geneva_internal" and self.wheel_shaft_diameter > 0.0:
            detail = compose("indexing-ring-has-no-bore")
            found.append(Contradiction("/wheel_shaft_diameter", detail))
        # Smaller clearances would be lost in the steps of the outlines.
        for name in ("slot_end", "relief"):
            stated = getattr(self.clearances, name)
            if stated is not None and stated < MIN_CLEARANCE * self.roller:
                detail = compose("indexing-clearance-too-small", ratio=f"{MIN_CLEARANCE:g}")
                found.append(Contradiction(f"/clearances/{name}", detail))
        for name in ("slot", "locking", "slot_end", "relief"):
            stated = getattr(self.clearances, name)
            if stated is not None and stated > MAX_CLEARANCE * self.roller:
                detail = compose("indexing-clearance-too-large", ratio=f"{MAX_CLEARANCE:g}")
                found.append(Contradiction(f"/clearances/{name}", detail))
        return found

    @property
    def most_rollers(self) -> int:
        """Maximum number of rollers that leave the wheel a rest."""
        if self.driver == "drag_link":
            return 1
        if self.drive != "geneva_external":
            return 1
        step = math.pi / self.stations
        # Half of an index as a share of half a turn.
        index = (math.asin(min(1.0, math.sin(step) / self.crank_ratio)) - step) / math.pi
        return min(MAX_ROLLERS, max(1, math.ceil(1.0 / index - 1e-9) - 1))

    @property
    def crank_ratio(self) -> float:
        """Crank radius over center distance of a drive in the plane.

        A crank equal to that of shock-free entry to some digits counts as that one, unless a shock is allowed.
        """
        least = math.sin(math.pi / self.stations)
        if self.crank_radius is None or self.center_distance is None:
            return least
        # Rounded input must not count as a crank with a shock.
        ratio = self.crank_radius / self.center_distance
        return ratio if ratio > least * (1.0 + (CRANK_TOLERANCE if self.constraints.shock_free else 0.0)) else least

    def _find_driver_errors(self) -> list[Contradiction]:
        if self.driver == "crank":
            if self.constraints.min_transmission_angle is not None:
                detail = compose("indexing-crank-without-transmission-angle")
                return [Contradiction("/constraints/min_transmission_angle", detail)]
            return []
        if self.spherical:
            return [Contradiction("/driver", compose("indexing-drag-link-for-plane-drives"))]
        return []

    def _find_ratchet_errors(self) -> list[Contradiction]:
        changed = self.find_changed_fields()
        foreign = {
            "rollers": self.rollers,
            "center_distance": self.center_distance,
            "sphere_radius": self.sphere_radius,
            "crank_radius": self.crank_radius,
            "roller_diameter": self.roller_diameter,
            "speed_rpm": self.speed_rpm,
        }
        found = [
            Contradiction(f"/{name}", compose("indexing-field-not-for-ratchet"))
            for name, value in foreign.items()
            if value is not None
        ]
        for name in ("crank_shaft_diameter", "load_inertia", "clearances"):
            if name in changed:
                found.append(Contradiction(f"/{name}", compose("indexing-field-not-for-ratchet")))
        if self.driver != "crank":
            found.append(Contradiction("/driver", compose("indexing-drag-link-for-plane-drives")))
        # The motion of a ratchet follows its drive, so limits on the motion do not apply.
        for name in ("dwell_share", "peak_acceleration", "drive_torque", "steady_share", "min_transmission_angle"):
            if getattr(self.constraints, name) is not None:
                found.append(Contradiction(f"/constraints/{name}", compose("indexing-field-not-for-ratchet")))
        if not self.constraints.shock_free:
            found.append(Contradiction("/constraints/shock_free", compose("indexing-ratchet-without-entry")))
        if self.wall_thickness is None:
            found.append(Contradiction("/wall_thickness", compose("indexing-tooth-thickness-missing")))
        # No pair of tooth and pawl numbers stops at all stations.
        if not self.teeth_choices:
            detail = compose("indexing-no-tooth-number", teeth=MIN_TEETH)
            found.append(Contradiction("/pawls/count", detail))
        return found

    @property
    def pawl(self) -> Ratcheting:
        """The requested pawls, or the defaults."""
        return self.pawls or Ratcheting()

    @property
    def teeth_choices(self) -> list[tuple[int, int]]:
        """Numbers of teeth and pawls that give the requested stations, those with the fewest pawls first.

        Pawls in g groups, staggered by 1/g of a pitch, stop z teeth at g z places; each group has the pawls that
        share the load.
        """
        shared = self.pawl.overlap
        choices = [
            (self.stations // groups, groups * shared)
            for groups in range(1, MAX_GROUPS + 1)
            if self.stations % groups == 0 and self.stations // groups >= max(MIN_TEETH, shared)
        ]
        return [choice for choice in choices if self.pawl.count is None or choice[1] == self.pawl.count]

    def _find_crank_errors(self, radius: float) -> list[Contradiction]:
        if self.center_distance is None:
            return [Contradiction("/crank_radius", compose("indexing-center-distance-missing"))]
        # The crank of shock-free entry is the smallest that reaches a slot.
        least = self.center_distance * math.sin(math.pi / self.stations)
        most = MAX_CRANK_RATIO * self.center_distance
        if not least * (1.0 - CRANK_TOLERANCE) <= radius <= most:
            detail = compose("indexing-crank-radius-out-of-range", minimum=f"{least:.9g}", maximum=f"{most:.9g}")
            return [Contradiction("/crank_radius", detail)]
        return []
