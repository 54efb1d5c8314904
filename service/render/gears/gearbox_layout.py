"""Positions of the gears of a gearbox: shafts in the end view, and slots side by side along the shafts.

In the end view the shafts of a machine-tool gearbox lie on one line, the first at 0. Input and main shaft of a layshaft
gearbox are coaxial at 0, the layshaft is at the shaft distance from them, and the reverse idler meshes with both of its
mates. Each pair is rotated so that its teeth mesh.
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass

from kinematics.gear.teeth import Gear
from service.render.gears.placement import PlacedGear, align_mate
from synthesis.kinds.gearbox.design import GearboxMechanism
from synthesis.kinds.layshaft_gearbox.design import LayshaftMechanism


@dataclass(frozen=True)
class BoxGear(PlacedGear):
    """A gear of a gearbox.

    ``pair`` names the pair, ``stage`` numbers the colours, ``shaft`` is the index of its shaft, and ``slot`` numbers
    the pairs along the shafts.
    """

    pair: str
    stage: int
    shaft: int
    slot: int


@dataclass(frozen=True)
class Shaft:
    """A shaft: its place in the end view, its distance below the first one in the developed view, its slots."""

    name: str
    centre: complex
    below: float
    slots: tuple[int, int]


@dataclass(frozen=True)
class BoxLayout:
    """All gears, two or three of each pair in the order of the power flow, and all shafts."""

    gears: list[BoxGear]
    shafts: list[Shaft]


def arrange_gearbox(mechanism: GearboxMechanism) -> BoxLayout:
    """Arrange a machine-tool gearbox; the stages follow one another along the shafts."""
    gears: list[BoxGear] = []
    at = [0.0]
    first = [0]
    for number, stage in enumerate(mechanism.stages):
        # All shafts lie on one line.
        at.append(at[-1] + stage.centre_distance)
        first.append(first[-1] + len(stage.pairs))
        for k, pair in enumerate(stage.pairs):
            name = f"STAGE_{number + 1}_PAIR_{k + 1}"
            driver = pair.driver, number, complex(at[number])
            driven = pair.driven, number + 1, complex(at[number + 1])
            gears += _place_in_mesh(mechanism, name, number, first[number] + k, driver, driven)
    count = len(mechanism.stages)
    names = ["input", *(f"shaft {k}" for k in range(2, count + 1)), "spindle"]
    shafts = [
        Shaft(name, complex(x), x, (first[max(k - 1, 0)], first[min(k + 1, count)] - 1))
        for k, (name, x) in enumerate(zip(names, at, strict=True))
    ]
    return BoxLayout(gears, shafts)


def arrange_layshaft(mechanism: LayshaftMechanism) -> BoxLayout:
    """Arrange a layshaft gearbox: the head pair, then the forward gears from last to first, then reverse."""
    distance = mechanism.centre_distance
    input_shaft, layshaft, main = 0, 1, 2
    beside = complex(distance)
    head = mechanism.head
    gears = _place_in_mesh(mechanism, "HEAD", 0, 0, (head.driver, input_shaft, 0j), (head.driven, layshaft, beside))
    slot = 1
    # Descending, so that the first gear is at the output end.
    for number in range(len(mechanism.gears), 0, -1):
        pair = mechanism.gears[number - 1]
        if pair.layshaft is not None and pair.mainshaft is not None:
            on_layshaft, on_main = (pair.layshaft, layshaft, beside), (pair.mainshaft, main, 0j)
            gears += _place_in_mesh(mechanism, f"GEAR_{number}", slot, slot, on_layshaft, on_main)
            slot += 1
    shafts = [
        Shaft("input", 0j, 0.0, (0, 0)),
        Shaft("layshaft", beside, distance, (0, slot - (mechanism.reverse is None))),
        Shaft("main shaft", 0j, 0.0, (1, slot - (mechanism.reverse is None))),
    ]
    if mechanism.reverse is not None:
        back = mechanism.reverse
        # The idler lies on the intersection of two circles: both of its centre distances are known.
        near, far = (0.5 * mechanism.module * (back.idler + z) for z in (back.layshaft, back.mainshaft))
        x = 0.5 * (distance**2 + far**2 - near**2) / distance
        centre = complex(x, math.sqrt(max(far**2 - x**2, 0.0)))
        idler = len(shafts)
        train = (back.layshaft, layshaft, beside), (back.idler, idler, centre), (back.mainshaft, main, 0j)
        gears += _place_in_mesh(mechanism, "REVERSE", slot, slot, *train)
        shafts.append(Shaft("idler", centre, distance + near, (slot, slot)))
    return BoxLayout(gears, shafts)


def _place_in_mesh(
    mechanism: GearboxMechanism | LayshaftMechanism,
    pair: str,
    stage: int,
    slot: int,
    *placed: tuple[int, int, complex],
) -> list[BoxGear]:
    """Return gears that mesh in sequence, from teeth, shaft and centre of each."""
    gears: list[BoxGear] = []
    for teeth, shaft, centre in placed:
        gear, turned = Gear(teeth, mechanism.module, math.radians(mechanism.pressure_angle)), 0.0
        if gears:
            mate = gears[-1]
            # Rotate the gear so that it meshes with its predecessor.
            turned = align_mate(mate.gear, mate.tooth_at, gear, cmath.phase(centre - mate.centre))
        gears.append(BoxGear(gear, centre, turned, pair, stage, shaft, slot))
    return gears
