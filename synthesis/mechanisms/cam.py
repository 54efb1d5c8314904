"""Given cams: a finished profile with its follower, or a contour by its dimensions."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import MISSING, fields
from typing import Annotated, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Discriminator, Field

from kinematics.cam import contours
from kinematics.cam import follower as core
from kinematics.cam.finished.contact import Contour
from kinematics.errors import DimensionError
from kinematics.message import compose
from synthesis.mechanisms.base import MechanismError
from synthesis.model.dimension import ANGLE, LENGTH
from synthesis.model.json_object import JsonObject
from synthesis.model.problem import Coordinate, Degrees, NonNegative, PositiveLength, PositiveNumber, Statement

MAX_POINTS = 20_000
"""Maximum number of points of a given profile."""

Coordinates = Annotated[list[Coordinate], Field(min_length=16, max_length=MAX_POINTS)]


FollowerType = Literal["translating_roller", "oscillating_roller", "translating_flat", "oscillating_flat"]

FOLLOWERS: dict[FollowerType, type[core.Follower]] = {
    "translating_roller": core.TranslatingRoller,
    "oscillating_roller": core.OscillatingRoller,
    "translating_flat": core.TranslatingFlat,
    "oscillating_flat": core.OscillatingFlat,
}
"""Followers of the analysis core by type. The first field of each is the radius of its cam's prime circle or base
circle."""


_NEEDED_BY: dict[FollowerType, str] = {
    "translating_roller": "mechanisms-needed-by-translating-roller",
    "oscillating_roller": "mechanisms-needed-by-oscillating-roller",
    "oscillating_flat": "mechanisms-needed-by-oscillating-flat",
}
"""Messages for a missing dimension of a follower, by its type."""


def get_follower_type(follower: core.Follower) -> FollowerType:
    """Return the type of a follower of the analysis core."""
    return next(name for name, kind in FOLLOWERS.items() if isinstance(follower, kind))


def list_dimensions(kind: type[core.Follower]) -> JsonObject:
    """Return the names of a follower's own dimensions and their defaults."""
    # The first field is the cam's radius, which is not a dimension of the follower.
    return {field.name: 0.0 if field.default is MISSING else field.default for field in fields(kind)[1:]}


def build_follower(name: FollowerType, radius: float, spec: object) -> core.Follower:
    """Build a follower of the analysis core.

    Parameters
    ----------
    name : str
        Type of the follower.
    radius : float
        Radius of the cam's prime circle or base circle.
    spec : object
        A model with the dimensions of the follower; None stands for a default.

    Raises
    ------
    DimensionError
        If no such follower can exist.
    """
    # Only the fields of this type are used, so that a dimension of another type has no effect.
    build: Callable[..., core.Follower] = FOLLOWERS[name]
    dimensions = {
        dimension: default if getattr(spec, dimension) is None else getattr(spec, dimension)
        for dimension, default in list_dimensions(FOLLOWERS[name]).items()
    }
    return build(radius, **dimensions)


class GivenFollower(Statement):
    """A follower; all dimensions of its type must be given."""

    type: FollowerType
    roller_radius: Annotated[NonNegative, LENGTH] | None = Field(default=None, description="0 for a knife edge.")
    offset: Coordinate | None = Field(
        default=None, description="Offset of a translating follower's slide; 0 by default."
    )
    arm: PositiveLength | None = None
    pivot_distance: PositiveLength | None = None
    face_offset: Coordinate | None = Field(default=None, description="0 if left out.")
    sense: Literal[1, -1] | None = Field(default=None, description="1, the default: the arm swings out with the cam.")

    def build_core(self, prime_radius: float | None, base_radius: float | None) -> core.Follower:
        """Build the follower of the analysis core.

        Raises
        ------
        MechanismError
        If a dimension is missing, or if no such follower can exist.
        """
        # Only dimensions without a sensible default are required.
        needed = {"translating_flat": (), "oscillating_flat": ("pivot_distance",)}.get(self.type, ("roller_radius",))
        needed += ("arm", "pivot_distance") if self.type == "oscillating_roller" else ()
        for name in needed:
            if getattr(self, name) is None:
                raise MechanismError(f"/follower/{name}", compose(_NEEDED_BY[self.type]))
        roller = self.type.endswith("roller")
        # Displacement 0 is on the prime circle for a roller, and on the base circle for a flat face.
        radius = prime_radius if roller else base_radius
        if radius is None:
            name = "prime_radius" if roller else "base_radius"
            raise MechanismError(f"/{name}", compose("mechanisms-zero-displacement-undefined"))
        try:
            return build_follower(self.type, radius, self)
        except DimensionError as error:
            raise MechanismError("/follower", str(error)) from None


class GivenCurve(Statement):
    """Points around the cam in its own frame, the first not repeated; the angles are ignored."""

    x: Coordinates
    y: Coordinates
    angle: list[Degrees] | None = Field(default=None, max_length=MAX_POINTS)

    def convert_points(self, path: str) -> NDArray[np.complex128]:
        """Return the points as complex numbers; errors are reported under ``path``."""
        if len(self.x) != len(self.y):
            raise MechanismError(f"{path}/y", compose("mechanisms-as-many-values-as-x"))
        return np.array(self.x) + 1j * np.array(self.y)

    def build_contour(self, path: str) -> Contour:
        """Build the curve of the analysis core; errors are reported under ``path``."""
        points = self.convert_points(path)
        try:
            return Contour(points)
        except DimensionError:
            raise MechanismError(path, compose("mechanisms-neighbouring-points-equal")) from None


class GivenCam(Statement):
    """A finished cam: its profile and its follower. Pitch curve and program of a design are accepted and ignored."""

    type: Literal["cam"]
    follower: GivenFollower
    prime_radius: PositiveLength | None = Field(default=None, description="Radius of the cam of a roller follower.")
    base_radius: PositiveLength | None = Field(default=None, description="Radius of the cam of a flat-faced follower.")
    rotation: Literal["ccw", "cw"] = "ccw"
    profile: GivenCurve
    outer_wall: GivenCurve | None = Field(
        default=None, description="Outer wall of a groove; the profile is its inner wall."
    )
    pitch_curve: object = None
    second: object = Field(default=None, description="The other one of conjugate cams; ignored.")
    program: object = None

    def build_follower(self) -> core.Follower:
        """Build the follower of the analysis core."""
        return self.follower.build_core(self.prime_radius, self.base_radius)

    def build_contour(self) -> Contour:
        """Build the profile of the analysis core."""
        return self.profile.build_contour("/profile")

    def build_wall(self) -> Contour | None:
        """Build the outer wall of a groove; None for an open cam."""
        if self.outer_wall is not None and not self.follower.type.endswith("roller"):
            raise MechanismError("/outer_wall", compose("mechanisms-groove-needs-roller"))
        return None if self.outer_wall is None else self.outer_wall.build_contour("/outer_wall")


class GivenBarrelFollower(Statement):
    """A roller that moves along a barrel's axis."""

    type: Literal["barrel_roller"]
    roller_radius: PositiveLength


class GivenBarrelCam(Statement):
    """A finished barrel cam: both walls of its groove, unrolled. Pitch curve and program are ignored."""

    type: Literal["barrel_cam"]
    follower: GivenBarrelFollower
    cylinder_radius: PositiveLength = Field(description="Radius of the cylinder on which the roller's middle runs.")
    rotation: Literal["ccw", "cw"] = "ccw"
    lower_wall: GivenCurve
    upper_wall: GivenCurve
    pitch_curve: object = None
    program: object = None


class EccentricContour(Statement):
    """A circle that turns about a point off its centre."""

    shape: Literal["eccentric_circle"]
    radius: PositiveLength
    eccentricity: Annotated[NonNegative, LENGTH]

    def build_core(self) -> contours.SpecifiedContour:
        """Build the contour of the analysis core."""
        return contours.build_eccentric_circle(self.radius, self.eccentricity)


class _NosedContour(Statement):
    base_radius: PositiveLength
    nose_radius: PositiveLength
    nose_distance: PositiveLength = Field(description="Distance from the cam's centre to the centre of the nose.")


class TangentContour(_NosedContour):
    """Base circle and nose with straight flanks."""

    shape: Literal["tangent"]

    def build_core(self) -> contours.SpecifiedContour:
        """Build the contour of the analysis core."""
        return contours.build_tangent_cam(self.base_radius, self.nose_radius, self.nose_distance)


class ArcContour(_NosedContour):
    """Base circle and nose with flanks that are arcs: of a radius, or ending at an angle from the nose."""

    shape: Literal["circular_arc"]
    flank_radius: Coordinate | None = Field(default=None, description="Negative for hollow flanks.")
    half_action_angle: Annotated[PositiveNumber, ANGLE] | None = Field(
        default=None, description="Angle from the nose to the end of the flank, degrees."
    )

    def build_core(self) -> contours.SpecifiedContour:
        """Build the contour of the analysis core."""
        radius = self.flank_radius
        # Both ways to describe the flank together could contradict each other.
        if (radius is None) == (self.half_action_angle is None):
            raise MechanismError("/contour/flank_radius", compose("mechanisms-flank-radius-or-angle"))
        if radius is None:
            angle = math.radians(self.half_action_angle or 0.0)
            radius = contours.compute_flank_radius(self.base_radius, self.nose_radius, self.nose_distance, angle)
        return contours.build_circular_arc_cam(self.base_radius, self.nose_radius, self.nose_distance, radius)


class GivenContourCam(Statement):
    """A cam of specified contour with a translating follower; its nose points along +x at cam angle 0."""

    type: Literal["contour_cam"]
    contour: Annotated[EccentricContour | TangentContour | ArcContour, Discriminator("shape")]
    roller_radius: Annotated[NonNegative, LENGTH] | None = Field(
        default=None, description="Radius of a roller follower; null: a flat face."
    )
    offset: Coordinate = 0.0
    rotation: Literal["ccw", "cw"] = "ccw"

    def build_core(self) -> tuple[contours.SpecifiedContour, core.TranslatingRoller | core.TranslatingFlat]:
        """Build contour and follower of the analysis core."""
        try:
            contour = self.contour.build_core()
            if self.roller_radius is None:
                # A flat face touches at the base circle itself; a roller's centre is its radius farther out.
                return contour, core.TranslatingFlat(contour.base_radius)
            prime = contour.base_radius + self.roller_radius
            return contour, core.TranslatingRoller(prime, self.roller_radius, self.offset)
        except DimensionError as error:
            raise MechanismError("", str(error)) from None
