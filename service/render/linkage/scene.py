"""A linkage design as any file of it needs it: the mechanism, its targets, and what the problem demands of P."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from service.render.linkage.drawing import Scene
from service.render.linkage.rebuilt import rebuilt


class Demand(NamedTuple):
    """A demanded point, with the direction of the body there where one is demanded, radians."""

    point: complex
    angle: float | None


def demands(problem: Any) -> list[Demand]:
    """What a problem demands of the point P, in its order; nothing where it demands no places of it."""
    positions = getattr(problem, "positions", None) or getattr(problem, "points", None) or []
    turned = [getattr(position, "angle", None) for position in positions]
    return [
        Demand(position.point, None if angle is None else math.radians(angle))
        for position, angle in zip(positions, turned, strict=True)
    ]


def scene_of(design: Any) -> Scene:
    """The linkage of a design at its targets, or in its reference configuration where it has none, and P's path."""
    mechanism = rebuilt(design)
    targets = getattr(design, "targets", None) or []
    stated = np.array([target.input_angle for target in targets])
    inputs = stated if mechanism.driven_by_slide else np.radians(stated)
    if not len(inputs):
        inputs = np.atleast_1d(mechanism.reference_input)
    traced = ["P"] if "P" in mechanism.joints else []
    return Scene(mechanism, inputs, traced, "P" if traced and len(inputs) > 1 else None)
