"""Thickness and width of the parts: the options of a request and derived sizes, all in millimetres."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Annotated, Literal, NamedTuple

from pydantic import BaseModel, ConfigDict, Field

from kinematics.message import compose
from service.parts.assembly.standard_parts import (
    PIN_DIAMETERS,
    SHEET_THICKNESSES,
    RetainingRing,
    find_retaining_ring,
    find_washer,
)

Process = Literal["print", "laser", "mill"]

File = Literal["zip", "step", "glb", "json", "svg"]
"""File formats of an assembly: ``json`` is the three-dimensional model for the viewer, ``svg`` a picture."""

PartFile = Literal["dxf", "stl", "step", "3mf"]
"""File formats of a single part."""

SOLID_FORMATS: tuple[File | PartFile, ...] = ("step", "glb", "stl", "3mf")
"""Files that need the extra ``cad`` for every process."""

CAD_PROCESSES: tuple[Process, ...] = ("print", "mill")
"""Processes whose files are solids."""

MAX_LENGTH = 1e6
"""Maximum length in a request, in the unit of the problem."""

MIN_SCALE, MAX_SCALE = 1e-6, 1e6
"""Minimum and maximum scale: squares of smaller lengths underflow, those of larger ones overflow."""

MAX_ASSEMBLY_SIZE = 20_000.0
"""Maximum size of an assembly, millimetres."""

MILLIMETRES_PER_UNIT = {"mm": 1.0, "cm": 10.0, "m": 1000.0, "in": 25.4}

MAX_SPEEDS = 1000
"""Maximum number by which a request can select a speed of a gearbox."""

MAX_POSITIONS = 720
"""Maximum number of positions in which an assembly is shown."""

DEFAULT_CLEARANCES: dict[Process, float] = {"print": 0.2, "laser": 0.1, "mill": 0.05}
"""Default clearance between hole and pin on each side, millimetres."""

WIDTH_PER_PIN, MAX_THICKNESS_PER_PIN = 2.5, 0.7
"""Default width and maximum default thickness of a plate, in pin diameters."""

MIN_WALL_PER_PIN = 0.25
"""Minimum wall between a hole and the edge of a plate, in pin diameters."""

BLOCK_WIDTH_PER_PIN = 1.5
"""Width of a block in pin diameters, without the clearance of its hole, and its length in widths."""

MIN_CLEARANCE_PER_PIN, MAX_CLEARANCE_PER_PIN = 1.0 / 400.0, 0.1
"""Minimum and maximum clearance in pin diameters: tighter parts jam, and a wider slot releases its block."""

MIN_PIN, MAX_PIN = 0.5, 200.0
"""Minimum and maximum pin diameter, millimetres."""


class PartsQuery(BaseModel):
    """Sizes and process of the parts; lengths in the unit of the problem. Omitted sizes follow from the mechanism."""

    model_config = ConfigDict(extra="forbid")

    process: Process = Field(
        default="laser",
        description="Process by which the plates are made. It determines fasteners, files and the default clearance "
        "(0.2 mm printed, 0.1 mm cut, 0.05 mm milled).",
    )
    width: Annotated[float, Field(gt=0.0, le=MAX_LENGTH)] | None = Field(
        default=None, description="Width of a link between its round ends. Default: 2.5 pin diameters."
    )
    pin: Annotated[float, Field(gt=0.0, le=MAX_LENGTH)] | None = Field(
        default=None, description="Diameter of all pins and shafts."
    )
    thickness: Annotated[float, Field(gt=0.0, le=MAX_LENGTH)] | None = Field(
        default=None,
        description="Thickness of all plates. Default: the thickest sheet up to 0.7 pin diameters.",
    )
    clearance: Annotated[float, Field(gt=0.0, le=MAX_LENGTH)] | None = Field(
        default=None, description="Clearance on each side between a hole and its pin, and between a slot and its block."
    )
    shafts: Literal["one_side", "both_sides"] | None = Field(
        default=None,
        description="Whether shafts are held by one base or two. Default: as in the problem, or by one base if that "
        "can be built. If neither can be built with the default, one link is divided into two plates on a shaft "
        "through the second base.",
    )
    over: Literal["cycle", "used"] | None = Field(
        default=None,
        description="The motion that must be free of interference: the used range or the full cycle. Default: as in "
        "the problem, or the cycle of an input that turns fully.",
    )
    bore: Annotated[float, Field(gt=0.0, le=MAX_LENGTH)] | None = Field(
        default=None,
        description="Shaft diameter of gears. Default: the largest that fits the smallest gear.",
    )
    face_width: Annotated[float, Field(gt=0.0, le=MAX_LENGTH)] | None = Field(
        default=None, description="Face width of gears. Default: that of the answer, or six modules."
    )
    speed: Annotated[int, Field(ge=1, le=MAX_SPEEDS)] | None = Field(
        default=None,
        description="Engaged speed of a gearbox with sliding gears, from 1, in the order of `metrics.speeds`. "
        "Default: 1.",
    )
    scale: Annotated[float, Field(ge=MIN_SCALE, le=MAX_SCALE)] = Field(
        default=1.0, description="Built size relative to the design, for example for a mechanism of unit size."
    )


class AssemblyQuery(PartsQuery):
    """The options of the parts, and the position in which the assembly is shown."""

    input_angle: Annotated[float, Field(ge=-1e6, le=1e6)] | None = Field(
        default=None, description="Input angle, degrees. Default: that of the design's reference."
    )
    input_place: Annotated[float, Field(ge=-1e9, le=1e9)] | None = Field(
        default=None, description="Place of a sliding input along its slide. Default: that of the design's reference."
    )


class NotMade(ValueError):
    """The parts cannot be made; ``path`` is the field of the request that prevents it, or empty."""

    def __init__(self, detail: str, path: str = "") -> None:
        super().__init__(detail)
        self.path = path


class ViewQuery(PartsQuery):
    """The options of the parts, and the number of inputs at which the assembly is shown."""

    positions: Annotated[int, Field(ge=1, le=MAX_POSITIONS)] = Field(
        default=72, description="Number of inputs, evenly spaced over the motion for which the parts were made."
    )


class FileRefusal(NamedTuple):
    """The reason why a file does not exist; ``path`` is the field responsible, or empty."""

    detail: str
    path: str
    known: bool = True
    """Whether a part of this name, and a file of it in this format, exist."""


@dataclass(frozen=True)
class Sizes:
    """Sizes of the parts, in millimetres."""

    process: Process
    width: float
    pin: float
    thickness: float
    clearance: float

    @property
    def collar(self) -> float:
        """Largest diameter of the parts on a pin next to a plate."""
        washer = find_washer(self.pin, self.width)
        # Without a standard washer spacers are twice as wide as the pin.
        return min(2.0 * self.pin, self.width) if washer is None else washer.diameter

    @property
    def hole(self) -> float:
        """Diameter of a hole for a pin."""
        return self.pin + 2.0 * self.clearance

    @property
    def play(self) -> float:
        """Axial play of the parts on a pin, in each gap between two planes."""
        return self.clearance

    @property
    def ring(self) -> RetainingRing:
        """Retaining ring of a pin that is not printed."""
        return find_retaining_ring(self.pin, self.collar)

    @property
    def cap(self) -> float:
        """Height of the head and the cap of a printed pin."""
        return 0.2 * self.pin

    @property
    def end(self) -> float:
        """Length of a pin beyond its uppermost plate; beyond its lowest one it is less by the play."""
        if self.process == "print":
            return self.play + self.cap
        return self.play + self.ring.width + self.ring.beyond

    @property
    def washers(self) -> int:
        """Number of standard washers that fill the gap between two planes; 0 without standard washers."""
        washer = None if self.process == "print" else find_washer(self.pin, self.width)
        # Two pins may end in one gap, one above the other, and pass each other.
        return 0 if washer is None else math.ceil(2.0 * self.end / washer.thickness - 1e-9)

    @property
    def gap(self) -> float:
        """Gap between two planes."""
        washer = find_washer(self.pin, self.width)
        filled = 2.0 * self.end
        if self.washers and washer is not None:
            filled = self.washers * washer.thickness
        return filled + self.play

    @property
    def pitch(self) -> float:
        """Distance from one plane to the next."""
        return self.thickness + self.gap

    @property
    def block(self) -> tuple[float, float]:
        """Length and width of a block in a slot."""
        width = BLOCK_WIDTH_PER_PIN * self.pin + 2.0 * self.clearance
        return BLOCK_WIDTH_PER_PIN * width, width

    @property
    def min_gap(self) -> float:
        """Minimum distance of two parts in one plane."""
        return self.clearance + 0.02 * self.width

    def scale(self, factor: float) -> Sizes:
        """Return the sizes multiplied by a factor."""
        return replace(
            self,
            width=factor * self.width,
            pin=factor * self.pin,
            thickness=factor * self.thickness,
            clearance=factor * self.clearance,
        )


def choose_sheet(pin: float) -> float:
    """Return the default thickness of plates on pins of a diameter."""
    return max(
        (one for one in SHEET_THICKNESSES if one <= MAX_THICKNESS_PER_PIN * pin), default=MAX_THICKNESS_PER_PIN * pin
    )


def choose_pin(most: float) -> float:
    """Return the thickest standard pin up to ``most``; ``most`` itself if all standard pins are thicker."""
    return max((one for one in PIN_DIAMETERS if one <= most * (1.0 + 1e-9)), default=most)


def check_sizes(sizes: Sizes, unit: float) -> None:
    """Refuse a clearance or a thickness that does not suit the pins.

    Parameters
    ----------
    unit : float
        Millimetres per length unit of the problem; the error message uses that unit.
    """
    words = {value: name for name, value in MILLIMETRES_PER_UNIT.items()}[unit]
    tight, loose = MIN_CLEARANCE_PER_PIN * sizes.pin, MAX_CLEARANCE_PER_PIN * sizes.pin
    if not tight <= sizes.clearance <= loose:
        raise NotMade(
            compose(
                "parts-clearance-out-of-range",
                smallest=f"{tight / unit:.4g}",
                largest=f"{loose / unit:.4g}",
                unit=words,
                pin=f"{sizes.pin / unit:.6g}",
            ),
            "/query/clearance",
        )
    if not 0.1 * sizes.pin <= sizes.thickness <= 20.0 * sizes.pin:
        raise NotMade(
            compose(
                "parts-thickness-out-of-range",
                smallest=f"{0.1 * sizes.pin / unit:.4g}",
                largest=f"{20.0 * sizes.pin / unit:.4g}",
                unit=words,
                pin=f"{sizes.pin / unit:.6g}",
            ),
            "/query/thickness",
        )


def round_up(value: float) -> float:
    """Round up to three significant digits."""
    step = 10.0 ** (math.floor(math.log10(value)) - 2)
    return float(f"{math.ceil(value / step - 1e-9) * step:.3g}")


def round_down(value: float) -> float:
    """Round down to three significant digits."""
    step = 10.0 ** (math.floor(math.log10(value)) - 2)
    return float(f"{math.floor(value / step + 1e-9) * step:.3g}")
