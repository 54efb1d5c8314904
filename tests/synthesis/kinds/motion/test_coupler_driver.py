"""Drivers of a coupler: the transmission angles that places are chosen by, against the driven sixbar."""

from __future__ import annotations

import numpy as np
import pytest

from kinematics.linkage.fourbar import OPEN_ASSEMBLY, Fourbar, positions
from kinematics.linkage.planar.drive import drive
from kinematics.linkage.planar.mechanism import Mechanism
from synthesis.kinds.motion.driver.coupler_driver import MIN_SINE, compute_min_sines

LENGTHS = 2.0, 3.0, 2.5, 3.2
STEPS = 1201


@pytest.mark.parametrize("aside", [0.0, 0.6, -0.5])
@pytest.mark.parametrize("pin", [0.5 + 0.6j, 1.4 + 0.2j, 0.2 - 0.9j])
def test_the_least_sine_is_that_of_the_sixbar_over_a_turn_of_its_crank(pin: complex, aside: float) -> None:
    linkage = Fourbar.from_lengths(*LENGTHS, 1.0 + 1.0j)
    at = positions(linkage, np.linspace(0.7, 1.5, STEPS), OPEN_ASSEMBLY)
    c = at.a + (at.b - at.a) * pin
    chord = c[-1] - c[0]
    o2, o4 = complex(linkage.input_pivot), complex(linkage.output_pivot)
    o6 = 0.5 * (c[0] + c[-1]) + chord * (2.0 + 1j * aside)
    along = np.gradient(c)
    bars = np.array([at.a, at.b, (at.a - o2) / abs(at.a - o2), (at.b - o4) / abs(at.b - o4)])
    least = np.ones((1, 1))
    compute_min_sines(c[None], (along / np.abs(along))[None], np.array([[o6]]), bars, least)

    first, last = abs(c[0] - o6), abs(c[-1] - o6)
    assert first > last
    d = o6 + (c[0] - o6) / first * 0.5 * (first - last)
    joints = {"O2": o2, "O4": o4, "O6": o6, "A": at.a[0], "B": at.b[0], "C": c[0], "D": d}
    links = {
        "ground": ("O2", "O4", "O6"),
        "crank": ("O6", "D"),
        "driver": ("C", "D"),
        "coupler": ("A", "B", "C"),
        "input": ("O2", "A"),
        "output": ("O4", "B"),
    }
    mechanism = Mechanism({name: complex(z) for name, z in joints.items()}, links, "crank")
    motion = drive(mechanism, float(mechanism.reference_input) + np.linspace(0.0, 2.0 * np.pi, 721), order=0)
    assert motion.valid.all()
    assert set(motion.sines) == {"driver", "input", "output"}
    expected = min(float(np.abs(sine).min()) for sine in motion.sines.values())
    if expected < MIN_SINE:
        assert least[0, 0] == 0.0
    else:
        assert least[0, 0] == pytest.approx(expected, abs=2e-3)
