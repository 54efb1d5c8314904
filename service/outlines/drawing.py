"""The content of a drawing, independent of its file format."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from service.outlines.curves import Curve, Source


@dataclass(frozen=True)
class Drawing:
    """Curves in drawing units with y upwards, elements that are no curves with the reason, and millimetres per unit."""

    format: Literal["svg", "dxf"]
    curves: list[Curve]
    left_out: list[tuple[Source, str]]
    millimetres: float | None
