"""What a drawing holds, whatever its format."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from service.outlines.curves import Curve, Source


@dataclass(frozen=True)
class Drawing:
    """Curves in the units of the drawing, y upwards; elements that are none, with the reason; millimetres in a unit."""

    format: Literal["svg", "dxf"]
    curves: list[Curve]
    left_out: list[tuple[Source, str]]
    millimetres: float | None
