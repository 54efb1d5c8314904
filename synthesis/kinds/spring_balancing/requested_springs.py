"""Requested springs: their permitted places, rates and lengths."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from kinematics.message import compose
from synthesis.model.dimension import FORCE, LENGTH, STIFFNESS, TORQUE, TORSION_STIFFNESS
from synthesis.model.dynamics.bodies import Name, Place
from synthesis.model.problem import Degrees, NonNegative, PositiveLength, PositiveNumber, Statement

MAX_CORNERS = 8
"""Maximum number of corners of the area of an end: each is a spring of its own in the program."""

MAX_FREE_ANGLE = 3600.0
"""Default maximum free angle of a torsion spring, degrees: it can be wound up by ten turns."""

Rate = Annotated[NonNegative, STIFFNESS]
Long = Annotated[NonNegative, LENGTH]
TorsionRate = Annotated[NonNegative, TORSION_STIFFNESS]


class SoughtEnd(Statement):
    """The end of a spring on a link or the `ground`: at a `point`, or anywhere `within` an area."""

    link: Name
    point: Place | None = Field(default=None, description="Point in the reference configuration.")
    within: list[Place] | None = Field(
        default=None,
        min_length=2,
        max_length=MAX_CORNERS,
        description="Area of the end in the reference configuration: the line between two places, or the convex area "
        "of "
        "more.",
    )

    @model_validator(mode="after")
    def _validate_place(self) -> Self:
        if (self.point is None) == (self.within is None):
            raise ValueError(compose("spring_balancing-end-place-choice"))
        return self

    @property
    def corners(self) -> list[Place]:
        """The places that span the permitted area; a single one for a given end."""
        return list(self.within or []) if self.point is None else [self.point]


LENGTH_FIELDS = (
    *("rate", "min_rate", "max_rate", "free_length", "min_free_length", "max_free_length", "preload", "max_preload"),
    *("form", "min_length", "max_length", "max_deflection", "max_force", "diameter"),
)
TORSION_FIELDS = ("torsion", "max_torsion", "free_angle", "min_free_angle", "max_free_angle", "max_torque")


class SoughtSpring(Statement):
    """A spring to be found: between two `ends`, or a torsion spring between two `links`.

    Omitted values are found. Without a free length, or limits of one, the spring has none: its force is the rate
    times its length.
    """

    ends: tuple[SoughtEnd, SoughtEnd] | None = None
    rate: Rate | None = Field(default=None, description="Rate, N/m or in consistent units; default: free.")
    min_rate: Rate | None = Field(default=None, description="Minimum rate; default 0: the spring may be omitted.")
    max_rate: Rate | None = None
    free_length: Long | None = Field(default=None, description="Free length; default 0, a zero-free-length spring.")
    min_free_length: Long | None = None
    max_free_length: Long | None = None
    preload: Annotated[NonNegative, FORCE] = Field(default=0.0, description="Tension at the free length.")
    max_preload: Annotated[NonNegative, FORCE] | None = Field(
        default=None, description="Maximum preload; the preload is free between `preload` and this."
    )
    form: Literal["extension", "compression"] | None = Field(
        default=None,
        description="An extension spring is never shorter than its free length, a compression spring never longer. "
        "By default it acts in both directions.",
    )
    min_length: PositiveLength | None = Field(
        default=None, description="Minimum length at every position, such as the solid length."
    )
    max_length: PositiveLength | None = Field(default=None, description="Maximum length at every position.")
    max_deflection: PositiveLength | None = Field(
        default=None, description="Maximum deflection from the free length at every position: the stroke of the spring."
    )
    max_force: Annotated[PositiveNumber, FORCE] | None = None
    diameter: PositiveLength | None = Field(
        default=None,
        description="Coil diameter of a compression spring: a warning is given if the free length exceeds four "
        "diameters, "
        "since such springs buckle.",
    )
    links: tuple[Name, Name] | None = Field(default=None, description="Links between which a torsion spring acts.")
    torsion: TorsionRate | None = Field(
        default=None, description="Torsion rate, N·m/rad or in consistent units; default: free."
    )
    max_torsion: TorsionRate | None = None
    free_angle: Degrees | None = Field(
        default=None,
        description="Rotation of the second link relative to the first from the reference without torque; default: "
        "free "
        "within ten turns.",
    )
    min_free_angle: Degrees | None = None
    max_free_angle: Degrees | None = None
    max_torque: Annotated[PositiveNumber, TORQUE] | None = None

    @model_validator(mode="after")
    def _validate_form(self) -> Self:
        if (self.ends is None) == (self.links is None):
            raise ValueError(compose("spring_balancing-ends-or-links"))
        changed = self.find_changed_fields()
        strange = [name for name in (TORSION_FIELDS if self.links is None else LENGTH_FIELDS) if name in changed]
        if strange:
            raise ValueError(compose("spring_balancing-fields-of-other-type", fields=", ".join(strange)))
        for name, least, most in (
            ("rate", "min_rate", "max_rate"),
            ("free_length", "min_free_length", "max_free_length"),
            ("torsion", "", "max_torsion"),
            ("free_angle", "min_free_angle", "max_free_angle"),
        ):
            low, high = getattr(self, least, None), getattr(self, most)
            if getattr(self, name) is not None and (low is not None or high is not None):
                raise ValueError(compose("spring_balancing-value-and-limits-given", field=name))
            if low is not None and high is not None and low > high:
                raise ValueError(compose("spring_balancing-minimum-above-maximum", minimum=least, maximum=most))
        if self.links is not None and self.free_angles[0] > self.free_angles[1]:
            raise ValueError(compose("spring_balancing-free-angles-excluded"))
        if self.max_preload is not None and self.max_preload < self.preload:
            raise ValueError(compose("spring_balancing-preload-limit-too-small"))
        if self.min_length is not None and self.max_length is not None and self.min_length >= self.max_length:
            raise ValueError(compose("spring_balancing-lengths-excluded"))
        return self._check_form()

    def _check_form(self) -> Self:
        """Check the values that only springs of one form have."""
        if self.form == "compression" and (self.without_length or self.preload > 0.0 or self.max_preload):
            raise ValueError(compose("spring_balancing-compression-spring-form"))
        bounded = self.form == "extension" or self.max_deflection is not None or self.free_lengths[1] is not None
        if self.ends is not None and not bounded:
            raise ValueError(compose("spring_balancing-free-length-unbounded"))
        if self.diameter is not None and self.form != "compression":
            raise ValueError(compose("spring_balancing-diameter-not-applicable"))
        return self

    @property
    def rates(self) -> tuple[float, float | None]:
        """Minimum and maximum rate, None without a maximum; for a torsion spring its own."""
        if self.links is not None:
            return (0.0, self.max_torsion) if self.torsion is None else (self.torsion, self.torsion)
        return (self.min_rate or 0.0, self.max_rate) if self.rate is None else (self.rate, self.rate)

    @property
    def free_lengths(self) -> tuple[float, float | None]:
        """Minimum and maximum free length, None without a maximum."""
        if self.free_length is not None:
            return self.free_length, self.free_length
        if self.min_free_length is None and self.max_free_length is None:
            return 0.0, 0.0
        return self.min_free_length or 0.0, self.max_free_length

    @property
    def free_angles(self) -> tuple[float, float]:
        """Minimum and maximum free angle, degrees."""
        if self.free_angle is not None:
            return self.free_angle, self.free_angle
        least, most = self.min_free_angle, self.max_free_angle
        return -MAX_FREE_ANGLE if least is None else least, MAX_FREE_ANGLE if most is None else most

    @property
    def preloads(self) -> tuple[float, float]:
        """Minimum and maximum preload."""
        return self.preload, self.preload if self.max_preload is None else self.max_preload

    @property
    def is_required(self) -> bool:
        """True if it may not be omitted, because a rate or a preload is required."""
        return self.rates[0] > 0.0 or self.preloads[0] > 0.0

    @property
    def without_length(self) -> bool:
        """True for a zero-free-length spring."""
        return self.ends is not None and self.free_lengths == (0.0, 0.0) and self.preloads == (0.0, 0.0)

    @property
    def open_ends(self) -> list[int]:
        """The ends whose places are open."""
        return [n for n, end in enumerate(self.ends or ()) if end.within is not None]

    @property
    def is_superposable(self) -> bool:
        """True if its drive is a sum over the corners of its ends: zero free length, and no minimum length."""
        return self.without_length and self.min_length is None

    @property
    def convex(self) -> bool:
        """True if its best form is a convex program: no end open, or one end of a zero-free-length spring."""
        return not self.open_ends or (self.is_superposable and len(self.open_ends) == 1)
