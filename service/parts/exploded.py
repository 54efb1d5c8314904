"""An assembly drawn apart: how far each part is lifted, so that nothing hides what it stands on."""

from __future__ import annotations

from service.parts.model import Assembly, Part
from service.parts.sheet import layers

SPREAD = 1.2
"""What all spaces between layers are together, as a share of the size of the mechanism, or of its largest part."""

COVERED = 0.4
"""Space below a second base besides, which covers what is between the two, as a share of the size."""

ALONG = 0.08
"""Between two parts on one of crossing shafts, as a share of the size of the mechanism."""

LEAST = 1.2
"""One of them in heights of the layer below it at least, which may be posts between two bases."""


def lifts(assembly: Assembly) -> dict[str, float]:
    """Millimetres by which each part goes up, by its name, where the assembly is all apart.

    Layers of plates and of what lies between them keep their order. Pins stand free above them all; one with its
    head below hangs free beneath, as it is put in from there. Where axes cross, each part goes along its own.
    """
    if not assembly.parallel:
        return _along_their_shafts(assembly)
    stacked = layers(assembly)
    size = max(assembly.size, *(part.length_and_width[0] for part in assembly.parts))
    space = SPREAD * size / len(stacked)
    found: dict[str, float] = {}
    lift = 0.0
    for n, layer in enumerate(stacked):
        if n > 0 and any(part.sort == "base" and part.planes[0] > 0 for part in layer.parts):
            lift += COVERED * size
        found.update(dict.fromkeys((part.name for part in layer.parts), lift))
        lift += max(space, LEAST * layer.height)
    raised = [part for part in assembly.parts if part.name in found]
    low = min(part.low + found[part.name] for part in raised)
    high = max(part.high + found[part.name] for part in raised)
    for part in assembly.parts:
        if part.name not in found:
            found[part.name] = (low - space - part.high) if part.headed else (high + space - part.low)
    return found


def _along_their_shafts(assembly: Assembly) -> dict[str, float]:
    """What is on a shaft goes away from its wheel, and the shaft out to the side on which it is longer."""
    found = dict.fromkeys((part.name for part in assembly.parts), 0.0)
    space = ALONG * assembly.size
    wheels = [part for part in assembly.parts if part.sort in ("gear", "cam") and part.name in assembly.frames]
    for wheel in wheels:
        own = assembly.frames[wheel.name]
        beside = [part for part in assembly.parts if assembly.frames.get(part.name) is own and part not in wheels]
        for side in (-1.0, 1.0):
            away = [part for part in beside if part.sort not in ("pin", "key") and _beyond(part, wheel, side) > 0.0]
            away.sort(key=lambda part: part.low, reverse=side < 0.0)
            found.update({part.name: side * space * n for n, part in enumerate(away, 1)})
        for part in beside:
            if part.sort == "pin":
                out = 1.0 if part.low + part.high > wheel.low + wheel.high else -1.0
                found[part.name] = out * (space * (len(beside) // 2 + 1) + part.high - part.low)
    found["base"] = -2.0 * space
    return found


def _beyond(part: Part, wheel: Part, side: float) -> float:
    """How far the middle of a part is beyond that of the wheel on a side."""
    return 0.5 * side * (part.low + part.high - wheel.low - wheel.high)
