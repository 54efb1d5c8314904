"""An assembly drawn apart: how far each part is lifted, so that nothing hides what it stands on."""

from __future__ import annotations

from service.parts.model import Assembly
from service.parts.sheet import layers

SPREAD = 1.2
"""What all spaces between layers are together, as a share of the size of the mechanism, or of its largest part."""

LEAST = 1.2
"""One of them in thicknesses of the thickest layer at least."""


def lifts(assembly: Assembly) -> dict[str, float]:
    """Millimetres by which each part goes up, by its name, where the assembly is all apart.

    Layers of plates and of what lies between them keep their order, with as much space between any two. Pins stand free
    above them all; one with its head below hangs free beneath, as it is put in from there.
    """
    stacked = layers(assembly)
    size = max(assembly.size, *(part.length_and_width[0] for part in assembly.parts))
    space = max(LEAST * max(layer.height for layer in stacked), SPREAD * size / len(stacked))
    found: dict[str, float] = {}
    for k, layer in enumerate(stacked):
        found.update(dict.fromkeys((part.name for part in layer.parts), k * space))
    raised = [part for part in assembly.parts if part.name in found]
    low = min(part.low + found[part.name] for part in raised)
    high = max(part.high + found[part.name] for part in raised)
    for part in assembly.parts:
        if part.name not in found:
            found[part.name] = (low - space - part.high) if part.headed else (high + space - part.low)
    return found
