"""Outlines of teeth, everywhere along their arcs: involutes by the angle they unwind, between root and tip circle."""

from __future__ import annotations

import math

import numpy as np
import pytest

from kinematics.gear.teeth import Gear, involute
from service.parts.gears.teeth import make_teeth
from service.parts.geometry.arc_chains import ARC_TOLERANCE, fit_chain
from service.parts.geometry.regions import Loop, find_arc

PHI = math.radians(20.0)


def sampled(loop: Loop) -> np.ndarray:
    """Points along every edge, ten to each."""
    shares = np.linspace(0.0, 1.0, 11)
    found = []
    for start, end, bulge in loop.iterate_edges():
        if bulge == 0.0:
            found.append(start + shares * (end - start))
        else:
            centre, angle = find_arc(start, end, bulge)
            found.append(centre + (start - centre) * np.exp(1j * angle * shares))
    return np.concatenate(found)


@pytest.mark.parametrize("play", [0.0, 0.05])
@pytest.mark.parametrize("gear", [Gear(31, 3.0), Gear(17, 1.0, shift=0.4), Gear(60, 2.0, internal=True, addendum=0.9)])
def test_flanks_are_involutes_all_along(gear: Gear, play: float) -> None:
    teeth, m, pitch = gear.teeth, gear.module, gear.pitch_radius
    places = sampled(make_teeth(gear, 0j, 0.0, 0.0, play))
    radii = np.abs(places)
    lowest, highest = sorted((gear.root_radius, gear.tip_radius))
    assert lowest - 1e-3 * m < radii.min()
    assert radii.max() < highest + 2.0 * ARC_TOLERANCE
    # Half of a tooth at a radius: of the pitch circle less half of the play, and the angle that the involute unwinds.
    out = -1.0 if gear.internal else 1.0
    half = (0.25 * math.pi * m + out * gear.shift * m * math.tan(PHI) - 0.5 * play) / pitch
    inner, outer = (pitch - 0.3 * m, gear.tip_radius - 2e-3) if out > 0.0 else (gear.tip_radius + 2e-3, pitch + 0.8 * m)
    on_flanks = places[(radii > inner + 1e-9) & (radii < outer - 1e-9)]
    there = np.arccos(gear.base_radius / np.abs(on_flanks))
    true = half + out * (involute(PHI) - (np.tan(there) - there))
    turn = 2.0 * math.pi / teeth
    away = np.abs(np.remainder(np.angle(on_flanks) + 0.5 * turn, turn) - 0.5 * turn)
    assert len(on_flanks) > 20 * teeth
    # The normal of an involute touches the base circle.
    assert (np.abs(away - true) * gear.base_radius).max() < 2.0 * ARC_TOLERANCE


def test_no_arc_goes_around_a_corner() -> None:
    square = np.array([0j, 1 + 0j, 2 + 0j, 2 + 1j, 2 + 2j, 1 + 2j])
    chain = fit_chain(square)
    assert chain.corners == [0j, 2 + 0j, 2 + 2j, 1 + 2j]
    assert chain.bulges == [0.0, 0.0, 0.0]


def test_a_circle_is_few_arcs() -> None:
    chain = fit_chain(5.0 * np.exp(1j * np.linspace(0.0, 3.0, 40)))
    assert len(chain.bulges) == 1
    centre, angle = find_arc(chain.corners[0], chain.corners[1], chain.bulges[0])
    assert abs(centre) < 1e-9
    assert angle == pytest.approx(3.0)
