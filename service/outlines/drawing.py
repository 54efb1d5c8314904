"""The content of a drawing, independent of its file format."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from kinematics.message import Message
from service.outlines.curves import Curve, Source


@dataclass(frozen=True)
class Drawing:
    """The curves of a drawing, in drawing units with y upwards.

    ``left_out`` has the elements that are not curves, each with the reason. ``millimetres`` is the size of the drawing
    unit in millimetres, None if it is unknown.
    """

    format: Literal["svg", "dxf"]
    curves: list[Curve]
    left_out: list[tuple[Source, Message]]
    millimetres: float | None
