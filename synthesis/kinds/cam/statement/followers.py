"""Followers of a cam: their dimensions, and their mass and spring."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Discriminator, Field

from kinematics.message import compose
from synthesis.model.dimension import FORCE, MASS, ROTATIONAL_SPEED, STIFFNESS
from synthesis.model.problem import (
    Contradiction,
    Coordinate,
    NonNegative,
    PositiveLength,
    PositiveNumber,
    Sizable,
    Statement,
)


class LengthRange(Statement):
    """A dimension that is free between two lengths."""

    min: PositiveLength
    max: PositiveLength


class RateRange(Statement):
    """A spring rate that is free between two values."""

    min: Annotated[NonNegative, STIFFNESS]
    max: Annotated[PositiveNumber, STIFFNESS]


class TranslatingRoller(Statement):
    """A roller on a slide. Without a prime radius the smallest feasible one is found."""

    type: Literal["translating_roller"]
    roller_radius: PositiveLength | LengthRange = Field(
        description="Radius, or a range: the largest that fits is used."
    )
    offset: Coordinate | Literal["free"] = Field(
        default=0.0,
        description="Distance of the slide from the cam's centre; positive lowers the rise's pressure angle.",
    )
    prime_radius: PositiveLength | None = None
    overhang: PositiveLength | None = Field(
        default=None,
        description="Distance from the roller's centre at zero displacement to the near end of the slide's guide: the "
        "lever of the lateral force, which shrinks with the displacement.",
    )


class OscillatingRoller(Statement):
    """A roller on a swinging arm; lifts are degrees of the arm."""

    type: Literal["oscillating_roller"]
    roller_radius: PositiveLength | LengthRange = Field(
        description="Radius, or a range: the largest that fits is used."
    )
    arm: PositiveLength = Field(description="Distance from the pivot to the roller's centre.")
    pivot_distance: PositiveLength | LengthRange = Field(
        description="Distance from the cam's centre to the pivot, or a range."
    )
    sense: Literal[1, -1] = Field(
        default=1, description="1: the arm swings outward in the sense in which the cam turns; -1: against it."
    )
    prime_radius: PositiveLength | None = None


class TranslatingFlat(Statement):
    """A flat face on a slide, square to its motion. Without a base radius the smallest feasible one is found."""

    type: Literal["translating_flat"]
    base_radius: PositiveLength | None = None
    offset: Coordinate | Literal["free"] = Field(
        default=0.0,
        description="Distance of the slide's axis from the cam's centre, positive toward the side on which a rise "
        "touches "
        "the face; `free`: the offset of minimum overturning moment.",
    )


class OscillatingFlat(Statement):
    """A flat face on a swinging arm; lifts are degrees of the arm."""

    type: Literal["oscillating_flat"]
    pivot_distance: PositiveLength
    face_offset: Coordinate = Field(
        default=0.0, description="Distance of the face from the pivot, positive toward the cam."
    )
    sense: Literal[1, -1] = 1
    base_radius: PositiveLength | None = None


class BarrelRoller(Statement):
    """A roller in the groove of a barrel (cylindrical) cam, moving along its axis; the groove's two walls guide it."""

    type: Literal["barrel_roller"]
    roller_radius: PositiveLength
    cylinder_radius: PositiveLength | None = Field(
        default=None,
        description="Radius of the cylinder on which the roller's middle runs. Default: the smallest feasible one.",
    )


Follower = Annotated[
    TranslatingRoller | OscillatingRoller | TranslatingFlat | OscillatingFlat | BarrelRoller, Discriminator("type")
]


class FollowerDynamics(Statement):
    """The follower as one mass on a spring. Newton, kilogram and the length unit; pound-force and lbf s²/in for inches.

    For an oscillating follower all values refer to its arm's end: effective mass and spring at the roller.
    """

    mass: Annotated[PositiveNumber, MASS]
    spring_rate: Annotated[NonNegative, STIFFNESS] | RateRange | Literal["free"] = Field(
        default=0.0,
        description="Force per length unit. `free`, or a range: the spring with the smallest peak contact force is "
        "chosen, of all that hold the follower to the cam at every speed up to `max_rpm`.",
    )
    damping_ratio: NonNegative = Field(default=0.0, description="Fraction of critical damping of mass and spring.")
    damping: NonNegative | None = Field(
        default=None,
        description="Damping force over velocity, in the units of force, length and seconds; replaces `damping_ratio`.",
    )
    preload: Annotated[NonNegative, FORCE] | None = Field(
        default=None, description="Spring force at zero displacement. Default: the smallest sufficient one."
    )
    least_force: Annotated[NonNegative, FORCE] = Field(default=0.0, description="Minimum contact force at all times.")
    max_rpm: Annotated[PositiveNumber, ROTATIONAL_SPEED] | None = Field(
        default=None,
        description="The contact force is kept at all cam speeds from 0 to this one, in revolutions per minute. "
        "Default: "
        "only at `speed_rpm`, and for a chosen spring at all speeds up to it.",
    )
    train_stiffness: Annotated[PositiveNumber, STIFFNESS] | None = Field(
        default=None,
        description="Force per length unit of the elastic train between cam and mass. Default: unknown, and vibrations "
        "are not computed.",
    )
    train_damping_ratio: Annotated[float, Field(strict=True, ge=0.0, lt=1.0), Sizable] = Field(
        default=0.0, description="Fraction of critical damping of the mass on its train."
    )
    min_frequency_ratio: NonNegative | None = Field(
        default=None, description="Minimum natural frequency of mass and spring over the cam's speed."
    )


def find_follower_contradictions(follower: Follower) -> list[Contradiction]:
    """Return contradictions between dimensions of a follower."""
    contradictions = []
    for name in ("roller_radius", "pivot_distance"):
        stated = getattr(follower, name, None)
        if isinstance(stated, LengthRange) and stated.min >= stated.max:
            contradictions.append(Contradiction(f"/follower/{name}/max", compose("cam-max-not-above-min")))
    if isinstance(follower, TranslatingRoller | OscillatingRoller) and follower.prime_radius is not None:
        radius = follower.roller_radius
        least = radius.min if isinstance(radius, LengthRange) else radius
        if follower.prime_radius <= least:
            contradictions.append(Contradiction("/follower/prime_radius", compose("cam-prime-radius-within-roller")))
        if isinstance(follower, TranslatingRoller):
            offset = follower.offset
            if offset == "free":
                detail = compose("cam-free-offset-needs-free-radius")
                contradictions.append(Contradiction("/follower/offset", detail))
            elif abs(offset) >= follower.prime_radius:
                contradictions.append(Contradiction("/follower/offset", compose("cam-offset-too-large")))
        elif isinstance(follower.pivot_distance, LengthRange):
            detail = compose("cam-free-pivot-needs-free-radius")
            contradictions.append(Contradiction("/follower/pivot_distance", detail))
        else:
            arm, pivot = follower.arm, follower.pivot_distance
            # The cam's centre, the pivot and the roller's centre must form a triangle.
            if not abs(pivot - arm) < follower.prime_radius < pivot + arm:
                contradictions.append(Contradiction("/follower/prime_radius", compose("cam-arm-does-not-reach")))
    if isinstance(follower, OscillatingFlat):
        # At its lowest position the face must pass between cam and pivot.
        reach = (follower.base_radius or 0.0) + follower.face_offset
        if reach >= follower.pivot_distance:
            contradictions.append(Contradiction("/follower/pivot_distance", compose("cam-pivot-too-near")))
    return contradictions
