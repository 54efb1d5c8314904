"""Parts of geared fivebars: teeth, phase and centre distance, in motion and in the mechanism's own terms."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from kinematics.linkage.planar.catalogue import make_geared_fivebar
from kinematics.linkage.planar.mechanism import GearPair
from service.parts.assembly.interference import find_overlaps
from service.parts.assembly.sizes import PartsQuery
from service.parts.geometry.regions import Region, move_outline
from service.parts.geometry.solids import Prism
from service.parts.linkage.gears import find_teeth, make_pair_wheels
from service.parts.registry import NotMade, make_parts
from tests.support.service.parts_of_geared_linkages import planted


@pytest.mark.slow
@pytest.mark.parametrize("ratio", [-2.0, 1.5])
def test_gears_turn_with_their_links_and_would_bite_in_any_other_phase(ratio: float) -> None:
    problem, design = planted(ratio)
    whole = make_parts(design, problem, PartsQuery(thickness=4.0, pin=2.0, clearance=0.1))
    gears = {part.name: part for part in whole.parts if part.sort == "gear"}
    assert ("idler" in gears) == (ratio > 0.0)
    inputs = whole.motion.low + np.array([0.0, 1.0, 4.5])
    state = whole.motion.compute_state(inputs)
    turns = {name: whole.motion.compute_placement(part.carrier, state).turn for name, part in gears.items()}
    since = inputs - whole.motion.reference
    assert turns["gear_of_input"] == pytest.approx(np.exp(1j * since), abs=1e-9)
    assert turns["gear_of_output"] == pytest.approx(np.exp(1j * ratio * since), abs=1e-9)
    # Turned by half a pitch on its shaft the output's gear stands in its mate.
    gear = gears["gear_of_output"]
    (body,) = gear.bodies
    assert isinstance(body, Prism)
    turn = complex(np.exp(1j * math.pi / 18.0))
    moved = move_outline(body.region.outer, turn, 60.0 * (1.0 - turn))
    bitten = replace(gear, bodies=(body._replace(region=Region(moved, body.region.holes)),))
    changed = replace(whole, parts=tuple(bitten if part is gear else part for part in whole.parts))
    assert find_overlaps(whole) == []
    assert any("gear_of_output" in found.parts for found in find_overlaps(changed))


@pytest.mark.parametrize("ratio", [-2.0, 2.0, -0.75, 21.0 / 19.0])
def test_teeth_have_the_ratio_on_the_given_pivots(ratio: float) -> None:
    linkage = make_geared_fivebar(0.0, 60.0, 10.0, 70.0, 70.0, 12.0, ratio, 0.5, 0.3, 1, 0.0)
    first, second, *idler = make_pair_wheels(linkage, GearPair("input", "output", ratio))
    assert first.gear.teeth / second.gear.teeth == pytest.approx(abs(ratio), rel=1e-12)
    for wheel in (second, *idler):
        assert wheel.gear.module == pytest.approx(first.gear.module, rel=1e-12)
    radii = [wheel.gear.pitch_radius for wheel in (first, second)] + [2.0 * one.gear.pitch_radius for one in idler]
    assert math.fsum(radii) == pytest.approx(60.0, rel=1e-12)
    # At the pitch point of each mesh one gear shows a tooth where the other shows a space.
    for one, other in [(first, idler[0]), (idler[0], second)] if idler else [(first, second)]:
        along = np.angle(other.centre - one.centre)
        phases = [
            (towards - wheel.tooth_at) / (2.0 * math.pi / wheel.gear.teeth) % 1.0
            for wheel, towards in ((one, along), (other, along + math.pi))
        ]
        assert math.remainder(sum(phases) - 0.5, 1.0) == pytest.approx(0.0, abs=1e-9)


def test_a_ratio_that_no_teeth_have_is_refused() -> None:
    with pytest.raises(NotMade, match="exactly"):
        find_teeth(math.sqrt(2.0))
    with pytest.raises(NotMade, match="teeth"):
        find_teeth(1.0 / 40.0)
