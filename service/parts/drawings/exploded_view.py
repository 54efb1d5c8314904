"""The exploded view of an assembly: the lift of each part, such that no part hides those below it."""

from __future__ import annotations

from service.parts.assembly.model import Assembly, Part
from service.parts.drawings.assembly_sheet import group_layers

SPREAD_SHARE = 1.2
"""Sum of all spaces between layers, as a share of the size of the mechanism, or of its largest part."""

BASE_GAP_SHARE = 0.4
"""Additional space below a second base, which would cover the parts between, as a share of the size."""

SHAFT_GAP_SHARE = 0.08
"""Space between two parts on one of crossing shafts, as a share of the size of the mechanism."""

MIN_GAP_HEIGHTS = 1.2
"""Minimum space in heights of the layer below, which may be posts between two bases."""


def compute_lifts(assembly: Assembly) -> dict[str, float]:
    """Return the lift of each part in the exploded view, millimetres, by name.

    Layers of plates and of the parts between them keep their order. Pins are above them all; a pin with its head below
    hangs beneath, because it is inserted from there. If axes cross, each part moves along its own.
    """
    if not assembly.parallel:
        return _compute_shaft_lifts(assembly)
    stacked = group_layers(assembly)
    size = max(assembly.size, *(part.length_and_width[0] for part in assembly.parts))
    space = SPREAD_SHARE * size / len(stacked)
    found: dict[str, float] = {}
    lift = 0.0
    for n, layer in enumerate(stacked):
        if n > 0 and any(part.sort == "base" and part.planes[0] > 0 for part in layer.parts):
            lift += BASE_GAP_SHARE * size
        found.update(dict.fromkeys((part.name for part in layer.parts), lift))
        # Thick layers need more space to be seen from above.
        lift += max(space, MIN_GAP_HEIGHTS * layer.height)
    raised = [part for part in assembly.parts if part.name in found]
    low = min(part.low + found[part.name] for part in raised)
    high = max(part.high + found[part.name] for part in raised)
    for part in assembly.parts:
        if part.name not in found:
            found[part.name] = (low - space - part.high) if part.has_lower_head else (high + space - part.low)
    return found


def _compute_shaft_lifts(assembly: Assembly) -> dict[str, float]:
    """Move the parts on a shaft away from its wheel, and the shaft out to the side on which it is longer."""
    found = dict.fromkeys((part.name for part in assembly.parts), 0.0)
    space = SHAFT_GAP_SHARE * assembly.size
    wheels = [part for part in assembly.parts if part.sort in ("gear", "cam") and part.name in assembly.frames]
    for wheel in wheels:
        own = assembly.frames[wheel.name]
        beside = [part for part in assembly.parts if assembly.frames.get(part.name) is own and part not in wheels]
        for side in (-1.0, 1.0):
            away = [
                part for part in beside if part.sort not in ("pin", "key") and _measure_offset(part, wheel, side) > 0.0
            ]
            away.sort(key=lambda part: part.low, reverse=side < 0.0)
            found.update({part.name: side * space * n for n, part in enumerate(away, 1)})
        for part in beside:
            if part.sort == "pin":
                # The shaft leaves on the side on which it is longer.
                out = 1.0 if part.low + part.high > wheel.low + wheel.high else -1.0
                found[part.name] = out * (space * (len(beside) // 2 + 1) + part.high - part.low)
    # The base moves down, away from the shafts.
    found["base"] = -2.0 * space
    return found


def _measure_offset(part: Part, wheel: Part, side: float) -> float:
    """Return the distance of a part's middle from that of the wheel towards a side."""
    return 0.5 * side * (part.low + part.high - wheel.low - wheel.high)
