"""Whether solids of an assembly share room: boxes first, then the kernel's own intersections."""

from __future__ import annotations

from itertools import combinations
from typing import Any

import numpy as np
from numpy.typing import NDArray

from service.parts.assembly.model import Assembly
from service.parts.export import cad

FLAT = 1e-4
"""Millimetres of height or width that two boxes may share: the kernel's boxes are a little too large."""


IN_TOUCH = 3e-3
"""By how much one of two parts is smaller that touch: where solids are exactly tangent the kernel may see one in the
other whole."""


def smaller(shape: Any) -> Any:
    """A solid that is a little smaller about the middle of its box."""
    from build123d import Solid
    from OCP.BRepBuilderAPI import BRepBuilderAPI_Transform
    from OCP.gp import gp_Pnt, gp_Trsf

    box = shape.bounding_box()
    middle, size = box.center(), max(box.size.X, box.size.Y)
    scaled = gp_Trsf()
    scaled.SetScale(gp_Pnt(middle.X, middle.Y, middle.Z), 1.0 - 2.0 * IN_TOUCH / size)
    return Solid(BRepBuilderAPI_Transform(shape.wrapped, scaled, True).Shape())


def shared_room(whole: Assembly, solids: list[Any], inputs: NDArray[np.float64]) -> tuple[int, dict[str, float]]:
    """How many pairs were intersected, and the greatest volume that each pair shares that shares any."""
    resting: dict[tuple[int, int], tuple[complex, complex]] = {}
    found: dict[str, float] = {}
    tried = 0
    for input_ in inputs:
        driven = whole.motion.compute_state(np.array([input_]))
        placed = cad.place_solids(whole, solids, float(input_))
        boxes = [one.bounding_box(optimal=False) for one in placed]
        for n, m in combinations(range(len(placed)), 2):
            one, other = boxes[n], boxes[m]
            if any(
                min(getattr(one.max, axis), getattr(other.max, axis))
                - max(getattr(one.min, axis), getattr(other.min, axis)) < FLAT
                for axis in "XYZ"
            ):  # fmt: skip
                continue
            # Two that have not moved towards each other since need not be tried again.
            a, b = (whole.motion.compute_placement(whole.parts[k].carrier, driven) for k in (n, m))
            towards = complex((b.shift[0] - a.shift[0]) / a.turn[0]), complex(b.turn[0] / a.turn[0])
            if (
                resting.get((n, m)) is not None
                and max(abs(x - y) for x, y in zip(resting[n, m], towards, strict=True)) < 1e-9 * whole.size
            ):
                continue
            resting[n, m] = towards
            tried += 1
            touch = frozenset((whole.parts[n].name, whole.parts[m].name)) in whole.touching
            common = (smaller(placed[n]) if touch else placed[n]).intersect(placed[m])
            volume = sum(getattr(body, "volume", 0.0) for body in ([] if common is None else list(common)))
            if volume > 0.0:
                pair = f"{whole.parts[n].name} {whole.parts[m].name}"
                found[pair] = max(found.get(pair, 0.0), volume)
    return tried, found
