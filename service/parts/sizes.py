"""How thick and wide the parts are: what a request states, and what follows from it, all in millimetres."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Annotated, Literal, NamedTuple

from pydantic import BaseModel, ConfigDict, Field

from service.parts.standards import PINS, SHEETS, RetainingRing, retaining_ring_for, washer_for

Process = Literal["print", "laser", "mill"]

File = Literal["zip", "step", "glb", "json", "svg"]
"""What a design's parts are had as: ``json`` is what shows them in three dimensions, ``svg`` a picture of them."""

PartFile = Literal["dxf", "stl", "step", "3mf"]
"""What one part is had as."""

SOLID: tuple[File | PartFile, ...] = ("step", "glb", "stl", "3mf")
"""Files that need the extra ``cad`` whatever the process is."""

NEEDS_CAD: tuple[Process, ...] = ("print", "mill")
"""Processes whose files are solids."""

LARGEST = 1e6
"""The greatest length that a request may state, in the unit of the problem."""

SMALLEST_SCALE, LARGEST_SCALE = 1e-6, 1e6
"""Between which a design is built: squares of smaller lengths are nothing, and of larger ones infinite."""

LARGEST_ASSEMBLY = 20_000.0
"""What is made at most, millimetres."""

MILLIMETRES = {"mm": 1.0, "cm": 10.0, "m": 1000.0, "in": 25.4}

MOST_SPEEDS = 1000
"""Of a gearbox that a request may name."""

MOST_POSITIONS = 720
"""At which an assembly is shown."""

CLEARANCES: dict[Process, float] = {"print": 0.2, "laser": 0.1, "mill": 0.05}
"""By which a hole is wider than its pin on each side, where nothing is stated, millimetres."""

WIDTH, THICKNESS = 2.5, 0.7
"""Width and greatest thickness of a plate, in diameters of its pins, where neither is stated."""

WALL = 0.25
"""What is left of a plate beside a hole at least, in diameters of its pins."""

BLOCK = 1.5
"""Width of a block in diameters of its pin, beside the clearance of its hole, and its length in widths."""

TIGHTEST, LOOSEST = 1.0 / 400.0, 0.1
"""Clearances in diameters of the pin: parts nearer than that do not turn, and a wider slot lets go of its block."""

THINNEST_PIN, WIDEST_PIN = 0.5, 200.0
"""Pins that are made, millimetres."""


class PartsQuery(BaseModel):
    """What the parts are made of; lengths in the unit of the problem. What is left out follows from the mechanism."""

    model_config = ConfigDict(extra="forbid")

    process: Process = Field(
        default="laser",
        description="How the plates are made: it decides about fasteners and files, and the clearance where none is "
        "stated (0.2 mm printed, 0.1 mm cut, 0.05 mm milled).",
    )
    width: Annotated[float, Field(gt=0.0, le=LARGEST)] | None = Field(
        default=None, description="Of a link between its round ends; 2.5 diameters of its pins if left out."
    )
    pin: Annotated[float, Field(gt=0.0, le=LARGEST)] | None = Field(
        default=None, description="Diameter of all pins and shafts."
    )
    thickness: Annotated[float, Field(gt=0.0, le=LARGEST)] | None = Field(
        default=None,
        description="Of all plates; that of a sheet up to 0.7 diameters of the pins if left out.",
    )
    clearance: Annotated[float, Field(gt=0.0, le=LARGEST)] | None = Field(
        default=None, description="By which a hole is wider than its pin, and a slot than its block, on each side."
    )
    shafts: Literal["one_side", "both_sides"] | None = Field(
        default=None,
        description="Whether shafts stand on one base, or between two; if left out as the problem states, or on one "
        "where that can be built. Where neither can be, and this is left out, one link is two plates on a shaft "
        "through the second base.",
    )
    over: Literal["cycle", "used"] | None = Field(
        default=None,
        description="The motion that nothing may be in the way of: the used range or all of the cycle; if left out as "
        "the problem states, or the cycle of an input that turns fully.",
    )
    bore: Annotated[float, Field(gt=0.0, le=LARGEST)] | None = Field(
        default=None,
        description="Of gears: the diameter of their shafts; if left out the thickest that the smallest has room for.",
    )
    face_width: Annotated[float, Field(gt=0.0, le=LARGEST)] | None = Field(
        default=None, description="Of gears; if left out as the answer has it, or six modules."
    )
    speed: Annotated[int, Field(ge=1, le=MOST_SPEEDS)] | None = Field(
        default=None,
        description="Of a gearbox of sliding gears: which of its speeds is engaged, from 1, in the order of "
        "`metrics.speeds`; 1 if left out.",
    )
    scale: Annotated[float, Field(ge=SMALLEST_SCALE, le=LARGEST_SCALE)] = Field(
        default=1.0, description="How much larger than the design it is built, as for a mechanism of unit size."
    )


class AssemblyQuery(PartsQuery):
    """The same, and the position in which the assembly is shown."""

    input_angle: Annotated[float, Field(ge=-1e6, le=1e6)] | None = Field(
        default=None, description="Input angle, degrees; that of the design's reference if left out."
    )
    input_place: Annotated[float, Field(ge=-1e9, le=1e9)] | None = Field(
        default=None, description="The same where a slide drives: its place along the slide."
    )


class NotMade(ValueError):
    """There are no such parts; ``path`` is the field of the request whose fault it is, empty where it is none's."""

    def __init__(self, detail: str, path: str = "") -> None:
        super().__init__(detail)
        self.path = path


class ViewQuery(PartsQuery):
    """The same, and at how many inputs the assembly is shown."""

    positions: Annotated[int, Field(ge=1, le=MOST_POSITIONS)] = Field(
        default=72, description="Inputs, spread evenly over the motion that the parts were made for."
    )


class Refused(NamedTuple):
    """Why there is no such file; ``path`` is the field whose fault it is, empty where it is none's."""

    detail: str
    path: str
    known: bool = True
    """Whether there is a part of this name, and a file of this form of it."""


@dataclass(frozen=True)
class Sizes:
    """What the parts are made of, in millimetres."""

    process: Process
    width: float
    pin: float
    thickness: float
    clearance: float

    @property
    def collar(self) -> float:
        """The widest diameter that stands on a pin beside a plate."""
        washer = washer_for(self.pin, self.width)
        return min(2.0 * self.pin, self.width) if washer is None else washer.diameter

    @property
    def hole(self) -> float:
        """Diameter of a hole for a pin."""
        return self.pin + 2.0 * self.clearance

    @property
    def play(self) -> float:
        """What the parts on a pin may move along it, in each gap between two planes."""
        return self.clearance

    @property
    def ring(self) -> RetainingRing:
        """What holds a pin that is not printed."""
        return retaining_ring_for(self.pin, self.collar)

    @property
    def cap(self) -> float:
        """Height of the head and the cap of a printed pin."""
        return 0.2 * self.pin

    @property
    def end(self) -> float:
        """By how much a pin stands out of its uppermost plate; of its lowest by less the play."""
        if self.process == "print":
            return self.play + self.cap
        return self.play + self.ring.width + self.ring.beyond

    @property
    def washers(self) -> int:
        """How many standard washers fill the gap between two planes; 0 where there are none."""
        washer = None if self.process == "print" else washer_for(self.pin, self.width)
        # Two pins may end in one gap, one over the other, and pass each other.
        return 0 if washer is None else math.ceil(2.0 * self.end / washer.thickness - 1e-9)

    @property
    def gap(self) -> float:
        """Between two planes."""
        washer = washer_for(self.pin, self.width)
        filled = 2.0 * self.end
        if self.washers and washer is not None:
            filled = self.washers * washer.thickness
        return filled + self.play

    @property
    def pitch(self) -> float:
        """From one plane to the next."""
        return self.thickness + self.gap

    @property
    def block(self) -> tuple[float, float]:
        """Length and width of a block in a slot."""
        width = BLOCK * self.pin + 2.0 * self.clearance
        return BLOCK * width, width

    @property
    def apart(self) -> float:
        """What two parts in one plane keep apart."""
        return self.clearance + 0.02 * self.width

    def scaled(self, factor: float) -> Sizes:
        """All lengths larger by a factor."""
        return replace(
            self,
            width=factor * self.width,
            pin=factor * self.pin,
            thickness=factor * self.thickness,
            clearance=factor * self.clearance,
        )


def sheet_for(pin: float) -> float:
    """Thickness of the plates on pins of a diameter."""
    return max((one for one in SHEETS if one <= THICKNESS * pin), default=THICKNESS * pin)


def pin_below(most: float) -> float:
    """The thickest pin that is sold and not thicker than ``most``; as thick where there is none so thin."""
    return max((one for one in PINS if one <= most * (1.0 + 1e-9)), default=most)


def judged(sizes: Sizes, unit: float) -> None:
    """Refuse a clearance or a thickness that does not go with the pins.

    Parameters
    ----------
    unit : float
        Millimetres to a length unit of the problem, in which the refusal is told.
    """
    words = {value: name for name, value in MILLIMETRES.items()}[unit]
    tight, loose = TIGHTEST * sizes.pin, LOOSEST * sizes.pin
    if not tight <= sizes.clearance <= loose:
        raise NotMade(
            f"The clearance is to be from {tight / unit:.4g} to {loose / unit:.4g} {words} for pins of "
            f"{sizes.pin / unit:.6g} {words}.", "/query/clearance",
        )  # fmt: skip
    if not 0.1 * sizes.pin <= sizes.thickness <= 20.0 * sizes.pin:
        raise NotMade(
            f"The thickness is to be from {0.1 * sizes.pin / unit:.4g} to {20.0 * sizes.pin / unit:.4g} {words} "
            f"for pins of {sizes.pin / unit:.6g} {words}.", "/query/thickness",
        )  # fmt: skip


def rounded_up(value: float) -> float:
    """Upwards to three digits."""
    step = 10.0 ** (math.floor(math.log10(value)) - 2)
    return float(f"{math.ceil(value / step - 1e-9) * step:.3g}")


def rounded_down(value: float) -> float:
    """Downwards to three digits."""
    step = 10.0 ** (math.floor(math.log10(value)) - 2)
    return float(f"{math.floor(value / step + 1e-9) * step:.3g}")
