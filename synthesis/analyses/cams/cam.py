"""Analysis of a finished cam: the motion of its follower is computed from the contact with the profile.

Displacements of an oscillating follower are in degrees and its velocities in rad/s. Those of a translating follower are
lengths, and lengths per second. Forces are along the follower's motion; for an oscillating follower they are torques
about its pivot.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from pydantic import ConfigDict, Field

from kinematics.arrays import Real
from kinematics.cam.dynamics import FollowerLoad
from kinematics.cam.finished.contact import Contour
from kinematics.cam.finished.motion_program import measure_program
from kinematics.cam.follower import Follower, OscillatingFlat, OscillatingRoller
from kinematics.cam.profile import space_angles
from kinematics.cam.response import FollowerTrain, Response
from kinematics.errors import DimensionError
from kinematics.message import compose
from synthesis.analyses.base import DrivenAnalysis, DrivenRequest, Family
from synthesis.mechanisms.base import MechanismError
from synthesis.mechanisms.cam import GivenCam
from synthesis.model.answer import Answer
from synthesis.model.json_object import JsonObject
from synthesis.model.problem import NonNegative, PositiveNumber, Statement

MAX_EFFORT = 40_000_000
"""Maximum product of positions and points of the profile: about two seconds."""

PROGRAM_SAMPLE_COUNT = 1440
"""Number of cam angles at which the program of a profile is measured for the computation of vibrations."""

MIN_POSITIONS = 24
"""Number of moves of a cutter's path from which the refinement to a chordal tolerance starts."""

MAX_CHORDS = 20_000
"""Number of moves of a cutter's path at which its refinement ends: a tolerance finer than the profile itself would
never be met."""


class Load(Statement):
    """The follower as one mass on a spring; a moment of inertia and torques for an oscillating one."""

    mass: PositiveNumber
    spring_rate: NonNegative = 0.0
    preload: NonNegative = Field(default=0.0, description="Preload towards the cam at zero displacement.")
    damping: NonNegative = Field(default=0.0, description="Damping force per unit of velocity.")

    def build_core(self) -> FollowerLoad:
        """Build the load of the analysis core."""
        return FollowerLoad(self.mass, self.spring_rate, self.preload, self.damping)


class Train(Statement):
    """An elastic follower: a mass behind a train of stiffness and damping, with a return spring on the mass."""

    mass: PositiveNumber
    stiffness: PositiveNumber
    damping: NonNegative = 0.0
    spring_rate: NonNegative = 0.0
    preload: NonNegative = 0.0

    def build_core(self) -> FollowerTrain:
        """Build the train of the analysis core."""
        return FollowerTrain(self.mass, self.stiffness, self.damping, self.spring_rate, self.preload)


class Cutter(Statement):
    """A cutter or grinding wheel that makes the profile.

    Its path is given at the positions of the motion, or within a chordal tolerance.
    """

    radius: NonNegative
    chordal_tolerance: PositiveNumber | None = Field(
        default=None,
        description="Maximum distance of the straight moves from the path; null: use the positions of the motion.",
    )


EXAMPLE: JsonObject = {
    "type": "cam",
    "follower": {"type": "translating_roller", "roller_radius": 15.0},
    "prime_radius": 40.0,
    "rotation": "ccw",
    "profile": {
        "x": [round(5.0 + 30.0 * math.cos(math.radians(6 * k)), 9) for k in range(60)],
        "y": [round(30.0 * math.sin(math.radians(6 * k)), 9) for k in range(60)],
    },
}
"""Example: a circle that turns about a point off its centre."""


class CamAnalysisRequest(DrivenRequest[GivenCam]):
    """A cam and how it turns; a full turn in 360 steps by default."""

    model_config = ConfigDict(
        title="Cam: motion and forces of its profile",
        json_schema_extra={
            "examples": [
                {
                    "mechanism": EXAMPLE,
                    "motion": {"from": 0.0, "to": 360.0, "steps": 72, "speed_rpm": 60.0},
                    "load": {"mass": 0.5, "spring_rate": 4.0, "preload": 30.0},
                    "cutter": {"radius": 12.0, "chordal_tolerance": 0.05},
                }
            ]
        },
    )

    load: Load | None = None
    train: Train | None = Field(
        default=None, description="Steady vibration at the speed of the motion's first position."
    )
    cutter: Cutter | None = None

    def find_errors(self) -> list[tuple[str, str]]:
        """Return errors that the validation of single fields cannot find."""
        faults = super().find_errors()
        if self.train is not None and self.motion.rate <= 0.0:
            faults.append(("/motion/speed", compose("analyses-vibration-needs-speed")))
        return faults

    def build_answer(self) -> JsonObject:
        """Build the answer over the motion, in the form of :class:`CamAnalysis`."""
        at, speed, time = self.motion.list_inputs()
        contour, follower = self.mechanism.build_contour(), self.mechanism.build_follower()
        if len(at) * len(contour.points) > MAX_EFFORT:
            raise MechanismError("/profile", compose("analyses-too-many-points-and-positions"))
        rotation = self.mechanism.rotation
        contact = contour.follow(follower, np.radians(at), rotation)
        unit = 180.0 / math.pi if isinstance(follower, OscillatingRoller | OscillatingFlat) else 1.0
        velocity = contact.v * speed
        acceleration = contact.a * speed**2 + contact.v * self.motion.acceleration
        return {
            "input_angle": at.tolist(),
            "time": None if time is None else time.tolist(),
            "valid": contact.valid.tolist(),
            "follower": {
                "position": (contact.s * unit).tolist(),
                "velocity": velocity.tolist(),
                "acceleration": acceleration.tolist(),
            },
            "contact": {"x": contact.point.real.tolist(), "y": contact.point.imag.tolist()},
            "play": self._measure_play(follower, at, contact.s, unit),
            "pressure_angle": np.degrees(contact.pressure_angle).tolist(),
            "radius_of_curvature": contact.radius.tolist(),
            "forces": None
            if self.load is None
            else compute_force_series(self.load, contact.s, contact.v, contact.pressure_angle, velocity, acceleration),
            "response": None if self.train is None else self._compute_response(contour, follower, at),
            "cutter_path": None if self.cutter is None else self._compute_cutter_path(contour, follower, at),
            "profile": {
                "size": float(np.abs(contour.points).max()),
                "least_convex_radius": _find_min_radius(contour, 1.0),
                "least_hollow_radius": _find_min_radius(contour, -1.0),
                "cusped": contour.has_cusp,
                "crossings": [[float(z.real), float(z.imag)] for z in contour.crossings[:16]],
            },
        }

    def _measure_play(self, follower: Follower, at: Real, s: Real, unit: float) -> list[float] | None:
        """Compute the play of the roller between the walls of its groove; None for an open cam."""
        wall = self.mechanism.build_wall()
        if wall is None:
            return None
        try:
            outer = wall.follow_inside(follower, np.radians(at), self.mechanism.rotation)
        except DimensionError as error:
            raise MechanismError("/outer_wall", str(error)) from None
        return [float(gap) for gap in (outer - s) * unit]

    def _compute_response(self, contour: Contour, follower: Follower, at: Real) -> JsonObject:
        """Compute the steady vibration of the elastic follower at the cam angles ``at``, degrees."""
        assert self.train is not None, "needs `train`"
        program = measure_program(contour, follower, self.mechanism.rotation, PROGRAM_SAMPLE_COUNT)
        vibration = Response(program, self.train.build_core(), self.motion.rate)
        theta, grid = np.mod(np.radians(at), math.tau), vibration.angle
        lag = np.interp(theta, grid, vibration.state[0])
        return {
            "natural_frequency": vibration.train.natural_frequency,
            "frequency_ratio": vibration.frequency_ratio,
            "resonant": vibration.resonant,
            "too_slow": vibration.too_slow,
            "lag": lag.tolist(),
            "acceleration": (np.interp(theta, grid, vibration.acceleration) * self.motion.rate**2).tolist(),
            "contact_force": np.interp(theta, grid, vibration.contact_force).tolist(),
            "least_contact_force": float(vibration.contact_force.min()),
        }

    def _compute_cutter_path(self, contour: Contour, follower: Follower, at: Real) -> JsonObject:
        """Compute centres of the cutter at the cam angles ``at``, degrees, or as close as the tolerance requires."""
        assert self.cutter is not None, "needs `cutter`"
        cutter, rotation = self.cutter, self.mechanism.rotation

        def compute_centres(theta: Real) -> NDArray[np.complex128]:
            contact = contour.follow(follower, theta, rotation)
            return contact.point + cutter.radius * contact.normal

        theta = np.radians(at)
        if cutter.chordal_tolerance is not None:
            theta = space_angles(MIN_POSITIONS)
            theta = np.append(theta, math.tau)
            path = compute_centres(theta)
            # Halve every step whose chord deviates too far from the path, until none does.
            while len(theta) < MAX_CHORDS:
                middle = 0.5 * (theta[:-1] + theta[1:])
                between = compute_centres(middle)
                chord = np.diff(path)
                length = np.abs(chord)
                # Distance of the middle point from the chord; if the chord has no length, from its end.
                off = np.abs(((between - path[:-1]) * np.conj(chord)).imag) / np.where(length > 0.0, length, 1.0)
                coarse = np.where(length > 0.0, off, np.abs(between - path[:-1])) > cutter.chordal_tolerance
                if not coarse.any():
                    break
                order = np.argsort(np.concatenate([theta, middle[coarse]]), kind="stable")
                theta = np.concatenate([theta, middle[coarse]])[order]
                path = np.concatenate([path, between[coarse]])[order]
            theta, path = theta[:-1], path[:-1]
        else:
            path = compute_centres(theta)
        hollow = _find_min_radius(contour, -1.0)
        return {
            "angle": np.degrees(theta).tolist(),
            "x": path.real.tolist(),
            "y": path.imag.tolist(),
            "gouges": hollow is not None and cutter.radius >= hollow,
        }


def compute_force_series(
    load: Load, s: Real, v: Real, pressure_angle: Real, velocity: Real, acceleration: Real
) -> dict[str, list[float]]:
    """Compute the forces along the follower's motion and between the surfaces, and the torque on the camshaft."""
    inertia = load.mass * acceleration + load.damping * velocity
    force = inertia + load.spring_rate * s + load.preload
    return {
        "along": force.tolist(),
        "normal": (force / np.cos(pressure_angle)).tolist(),
        "torque": (force * v).tolist(),
    }


def _find_min_radius(contour: Contour, side: float) -> float | None:
    """Find the minimum radius of curvature of the convex (``side`` 1) or hollow (−1) parts; None if there are none."""
    greatest = float((side * contour.curvature()).max())
    return 1.0 / greatest if greatest > FLAT / float(np.abs(contour.points).max()) else None


FLAT = 1e-6
"""Curvature times size of a profile up to which it counts as straight."""


class FollowerSeries(Answer):
    """The follower over the positions; null where it touches nothing."""

    position: list[float | None] = Field(description="Displacement, length units, or degrees of an arm.")
    velocity: list[float | None]
    acceleration: list[float | None]


class CurvePoints(Answer):
    """Points in the cam's own frame."""

    x: list[float | None]
    y: list[float | None]


class CamForceSeries(Answer):
    """Forces of the load over the positions."""

    along: list[float | None] = Field(
        description="Force along the follower's motion; contact is lost where it is not positive."
    )
    normal: list[float | None] = Field(description="Force between the surfaces.")
    torque: list[float | None] = Field(description="Torque that turns the camshaft.")


class ResponseSeries(Answer):
    """Steady vibration of an elastic follower; null at a resonance."""

    natural_frequency: float
    frequency_ratio: float
    resonant: bool
    too_slow: bool = Field(description="The natural frequency is below ten times the speed.")
    lag: list[float | None] = Field(description="Deviation of the mass from the cam's displacement; length or radians.")
    acceleration: list[float | None]
    contact_force: list[float | None]
    least_contact_force: float | None


class CutterPath(Answer):
    """Centres of the cutter in the cam's own frame."""

    angle: list[float]
    x: list[float | None]
    y: list[float | None]
    gouges: bool = Field(description="The cutter is larger than a hollow of the profile.")


class ProfileFacts(Answer):
    """Properties of the profile points alone."""

    size: float = Field(description="Greatest radius.")
    least_convex_radius: float | None
    least_hollow_radius: float | None
    cusped: bool
    crossings: list[tuple[float, float]]


class CamAnalysis(DrivenAnalysis):
    """Analysis of a cam over the motion."""

    valid: list[bool]
    follower: FollowerSeries
    contact: CurvePoints
    play: list[float | None] | None = Field(
        description="Play in a groove from the inner to the outer wall; negative if the roller does not fit."
    )
    pressure_angle: list[float | None] = Field(description="Magnitude, degrees.")
    radius_of_curvature: list[float | None] = Field(
        description="Radius of curvature of the profile at the contact, positive if convex."
    )
    forces: CamForceSeries | None
    response: ResponseSeries | None
    cutter_path: CutterPath | None
    profile: ProfileFacts


FAMILY = Family(CamAnalysisRequest, CamAnalysis)
