"""Springs as a client asks for them: where they may hold, and of what rates and lengths they may be."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from synthesis.model.bodies import Name, Place
from synthesis.model.dimension import FORCE, LENGTH, STIFFNESS, TORQUE, TORSION_STIFFNESS
from synthesis.model.statement import Degrees, NonNegative, PositiveLength, PositiveNumber, Statement

MOST_CORNERS = 8
"""Corners of the area of an end at most: each is a spring of its own in the program."""

WOUND = 3600.0
"""Free angle of a torsion spring at most where none is stated, degrees: it can be wound up by ten turns."""

Rate = Annotated[NonNegative, STIFFNESS]
Long = Annotated[NonNegative, LENGTH]
TorsionRate = Annotated[NonNegative, TORSION_STIFFNESS]


class SoughtEnd(Statement):
    """Where a spring holds on a link or the `ground`: at a `point`, or anywhere `within` an area."""

    link: Name
    point: Place | None = Field(default=None, description="In the reference configuration.")
    within: list[Place] | None = Field(
        default=None,
        min_length=2,
        max_length=MOST_CORNERS,
        description="Anywhere between these places of the reference configuration: on the line between two, in the "
        "convex area of more.",
    )

    @model_validator(mode="after")
    def _one_of_them(self) -> Self:
        if (self.point is None) == (self.within is None):
            raise ValueError("give a point, or the places within which the end lies")
        return self

    @property
    def corners(self) -> list[Place]:
        """The places that span where it may be; one alone where it is given."""
        return list(self.within or []) if self.point is None else [self.point]


OF_LENGTHS = (
    *("rate", "min_rate", "max_rate", "free_length", "min_free_length", "max_free_length", "preload", "max_preload"),
    *("form", "min_length", "max_length", "max_deflection", "max_force", "diameter"),
)
OF_TORSION = ("torsion", "max_torsion", "free_angle", "min_free_angle", "max_free_angle", "max_torque")


class SoughtSpring(Statement):
    """A spring that is sought: between two `ends`, or a torsion spring between two `links`.

    What is left open is found. Without a free length, or limits of one, the spring has none: its force is the rate
    times its length.
    """

    ends: tuple[SoughtEnd, SoughtEnd] | None = None
    rate: Rate | None = Field(default=None, description="N/m, or in the consistent units; left open by default.")
    min_rate: Rate | None = Field(default=None, description="By default 0: the spring may be left out.")
    max_rate: Rate | None = None
    free_length: Long | None = Field(default=None, description="0 is a zero-free-length spring, the default.")
    min_free_length: Long | None = None
    max_free_length: Long | None = None
    preload: Annotated[NonNegative, FORCE] = Field(default=0.0, description="Tension at the free length.")
    max_preload: Annotated[NonNegative, FORCE] | None = Field(
        default=None, description="The preload is left open between `preload` and this."
    )
    form: Literal["extension", "compression"] | None = Field(
        default=None,
        description="An extension spring is nowhere shorter than its free length, a compression spring nowhere longer. "
        "By default it bears both.",
    )
    min_length: PositiveLength | None = Field(default=None, description="At every position, as the solid length.")
    max_length: PositiveLength | None = Field(default=None, description="At every position.")
    max_deflection: PositiveLength | None = Field(
        default=None, description="From the free length, at every position: the stroke of the spring."
    )
    max_force: Annotated[PositiveNumber, FORCE] | None = None
    diameter: PositiveLength | None = Field(
        default=None,
        description="Of the coil of a compression spring: it is warned of where the free length is more than four "
        "times as much, as such springs buckle.",
    )
    links: tuple[Name, Name] | None = Field(default=None, description="Between which a torsion spring acts.")
    torsion: TorsionRate | None = Field(default=None, description="N·m/rad, or in the consistent units; else open.")
    max_torsion: TorsionRate | None = None
    free_angle: Degrees | None = Field(
        default=None,
        description="Rotation of the second link against the first from the reference without torque; else open, by "
        "default within ten turns.",
    )
    min_free_angle: Degrees | None = None
    max_free_angle: Degrees | None = None
    max_torque: Annotated[PositiveNumber, TORQUE] | None = None

    @model_validator(mode="after")
    def _one_form(self) -> Self:
        if (self.ends is None) == (self.links is None):
            raise ValueError("give the ends of a spring, or the links of one that turns")
        strange = [name for name in (OF_TORSION if self.links is None else OF_LENGTHS) if name in self.model_fields_set]
        strange = [name for name in strange if getattr(self, name) != type(self).model_fields[name].default]
        if strange:
            raise ValueError(f"{', '.join(strange)} is of the other sort of spring")
        for name, least, most in (
            ("rate", "min_rate", "max_rate"),
            ("free_length", "min_free_length", "max_free_length"),
            ("torsion", "", "max_torsion"),
            ("free_angle", "min_free_angle", "max_free_angle"),
        ):
            low, high = getattr(self, least, None), getattr(self, most)
            if getattr(self, name) is not None and (low is not None or high is not None):
                raise ValueError(f"give the {name}, or its limits")
            if low is not None and high is not None and low > high:
                raise ValueError(f"{least} must not be above {most}")
        if self.links is not None and self.free_angles[0] > self.free_angles[1]:
            raise ValueError("the limits of the free angle leave none: it is within ten turns where one is not stated")
        if self.max_preload is not None and self.max_preload < self.preload:
            raise ValueError("max_preload must not be below preload")
        if self.min_length is not None and self.max_length is not None and self.min_length >= self.max_length:
            raise ValueError("min_length must be below max_length")
        return self._formed()

    def _formed(self) -> Self:
        """What springs of one form have and others have not."""
        if self.form == "compression" and (self.without_length or self.preload > 0.0 or self.max_preload):
            raise ValueError("a compression spring has a free length, and no preload")
        bounded = self.form == "extension" or self.max_deflection is not None or self.free_lengths[1] is not None
        if self.ends is not None and not bounded:
            raise ValueError("without an end the free length may grow while the rate falls; give max_free_length")
        if self.diameter is not None and self.form != "compression":
            raise ValueError("the diameter tells whether a compression spring buckles")
        return self

    @property
    def rates(self) -> tuple[float, float | None]:
        """The least rate and the greatest, None where there is none; of a torsion spring its own."""
        if self.links is not None:
            return (0.0, self.max_torsion) if self.torsion is None else (self.torsion, self.torsion)
        return (self.min_rate or 0.0, self.max_rate) if self.rate is None else (self.rate, self.rate)

    @property
    def free_lengths(self) -> tuple[float, float | None]:
        """The least free length and the greatest, None where there is none."""
        if self.free_length is not None:
            return self.free_length, self.free_length
        if self.min_free_length is None and self.max_free_length is None:
            return 0.0, 0.0
        return self.min_free_length or 0.0, self.max_free_length

    @property
    def free_angles(self) -> tuple[float, float]:
        """The least free angle and the greatest, degrees."""
        if self.free_angle is not None:
            return self.free_angle, self.free_angle
        least, most = self.min_free_angle, self.max_free_angle
        return -WOUND if least is None else least, WOUND if most is None else most

    @property
    def preloads(self) -> tuple[float, float]:
        """The least preload and the greatest."""
        return self.preload, self.preload if self.max_preload is None else self.max_preload

    @property
    def demanded(self) -> bool:
        """Whether it may not be left out: a rate or a preload is asked of it."""
        return self.rates[0] > 0.0 or self.preloads[0] > 0.0

    @property
    def without_length(self) -> bool:
        """Whether it is a zero-free-length spring."""
        return self.ends is not None and self.free_lengths == (0.0, 0.0) and self.preloads == (0.0, 0.0)

    @property
    def open_ends(self) -> list[int]:
        """The ends whose places are sought."""
        return [n for n, end in enumerate(self.ends or ()) if end.within is not None]

    @property
    def superposed(self) -> bool:
        """Whether its drive is a sum over the corners of its ends: of zero length, and no least one."""
        return self.without_length and self.min_length is None

    @property
    def convex(self) -> bool:
        """Whether the best of it is a convex program: no end open, or one of a zero-free-length spring."""
        return not self.open_ends or (self.superposed and len(self.open_ends) == 1)
