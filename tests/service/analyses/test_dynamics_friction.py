"""Friction in ``POST /v1/analyses``: a slider-crank by hand, where it sticks, where it jams, and bad statements."""

from __future__ import annotations

import math
from typing import Any

import httpx
import numpy as np
import pytest

from tests.support.service.dynamics import BLOCK, CRANK, OTHER_TYPES, TURN, Statement, agrees, asked, refused

LONG_CRANK = {
    "type": "slider_crank",
    "fixed_pivot": [0.0, 0.0],
    "links": {"crank": 100.0, "coupler": 115.0},
    "slide": {"point": [0.0, 0.0], "angle": 0.0},
    "assembly": "open",
}
PUSHED = {"loads": [{"joint": "B", "force": {"constant": [-200.0, 0.0]}}]}


def by_hand(found: Statement, mu: float) -> tuple[np.ndarray, np.ndarray]:
    """Force of a massless rod on the piston, and the slope of the rod; Norton's equations with friction (11.10e)."""
    piston = found["joints"]["B"]
    pin = np.array(found["joints"]["A"]["x"]) + 1j * np.array(found["joints"]["A"]["y"])
    rod = np.array(piston["x"]) + 1j * np.array(piston["y"]) - pin
    slope = rod.imag / rod.real
    along = 200.0 / (1.0 - mu * np.abs(slope) * np.sign(piston["vx"]))
    return along + 1j * along * slope, slope


def test_slide_friction_by_hand(client: httpx.Client) -> None:
    mu = 0.15
    block = PUSHED | {"friction": {"slides": {"0": mu}}}
    found = asked(client, OTHER_TYPES["slider_crank"], block, motion=TURN | {"from": 3.0, "to": 363.0})
    agrees(found)
    force, _ = by_hand(found, mu)
    forces = found["dynamics"]
    assert set(forces["status"]) == {"ok"}
    np.testing.assert_allclose(forces["joints"]["B"]["coupler"]["x"], -force.real, rtol=1e-9)
    slide = forces["slides"][0]
    np.testing.assert_allclose(slide["normal"], -force.imag, rtol=1e-9, atol=1e-9)
    expected = -np.sign(found["joints"]["B"]["vx"]) * mu * np.abs(force.imag)
    np.testing.assert_allclose(slide["friction"], expected, rtol=1e-9, atol=1e-9)
    lost = np.array(slide["friction"]) * -1e-3 * np.array(found["joints"]["B"]["vx"])
    np.testing.assert_allclose(forces["friction"]["power"], lost, rtol=1e-9, atol=1e-9)


def test_where_the_rod_wedges_the_piston_nothing_is_a_number(client: httpx.Client) -> None:
    """μ |tan φ| > 1: moving out there is no solution, moving back there are two."""
    mu = 0.9
    block = PUSHED | {"friction": {"slides": {"0": mu}}}
    found = asked(client, LONG_CRANK, block, motion=TURN | {"from": 2.5, "to": 357.5})
    agrees(found)
    forces = found["dynamics"]
    force, slope = by_hand(found, mu)
    jammed = mu * np.abs(slope) > 1.0
    assert 20 < jammed.sum() < 60
    assert [status == "friction_jam" for status in forces["status"]] == jammed.tolist()
    assert all((value is None) == bool(jam) for value, jam in zip(forces["drive"], jammed, strict=True))
    pin = np.array(forces["joints"]["B"]["coupler"]["x"], float)
    np.testing.assert_allclose(pin[~jammed], -force.real[~jammed], rtol=1e-8)
    assert forces["extremes"]["drive"]["mean"] is None


def test_pins_take_power_and_stick_where_they_stand(client: httpx.Client) -> None:
    """A crank alone: the pin carries its weight, and its moment is μ r m g."""
    skeleton = {
        "joints": {"O2": [0.0, 0.0], "P": [100.0, 0.0]},
        "links": [{"name": "ground", "joints": ["O2"]}, {"name": "input", "joints": ["O2", "P"]}],
        "input_link": "input",
    }
    block = {
        "gravity": {"magnitude": 10.0},
        "bodies": {"input": {"mass": 3.0, "cg": [0.0, 0.0]}},
        "friction": {"pins": {"O2": {"mu": 0.2, "radius": 8.0}}},
    }
    alone = {"type": "skeleton", "skeleton": skeleton}
    found = asked(client, alone, block, motion={"at": 30.0, "speed": 4.0})["dynamics"]
    assert found["drive"] == pytest.approx([0.2 * 0.008 * 30.0])
    assert found["friction"]["pins"]["O2"] == {"input": pytest.approx([-0.048]), "ground": pytest.approx([0.048])}
    assert found["friction"]["power"] == pytest.approx([4.0 * 0.048])
    assert found["shaking"]["moment"] == pytest.approx([0.0], abs=1e-12)
    still = asked(client, alone, block, motion={"at": 30.0, "speed": 0.0})["dynamics"]
    assert (still["status"], still["drive"]) == (["stick"], pytest.approx([0.0], abs=1e-12))


def test_friction_of_all_pins_of_a_fourbar(client: httpx.Client) -> None:
    pins = {joint: {"mu": 0.2, "radius": 6.0} for joint in ("O2", "A", "B", "O4")}
    free = asked(client, CRANK, BLOCK)["dynamics"]
    found = asked(client, CRANK, BLOCK | {"friction": {"pins": pins}})
    agrees(found)
    forces = found["dynamics"]
    assert min(forces["friction"]["power"]) > 0.0
    more = (np.array(forces["drive"]) - free["drive"]) * 2.0 * math.pi
    np.testing.assert_allclose(more, forces["friction"]["power"], rtol=1e-9)
    assert forces["power"]["mean"] - free["power"]["mean"] == pytest.approx(np.mean(more[:-1]), rel=1e-9)
    moment = np.abs(forces["friction"]["pins"]["A"]["coupler"])
    force = np.hypot(*(forces["joints"]["A"]["coupler"][axis] for axis in "xy"))
    np.testing.assert_allclose(moment, 0.2 * 0.006 * force, rtol=1e-9)
    # Without friction in the statement the answer has none.
    assert "friction" not in free


BAD: dict[str, tuple[Any, str]] = {
    "coefficient above 1.5": ({"pins": {"A": {"mu": 5.0, "radius": 3.0}}}, "/pins/A/mu"),
    "negative coefficient": ({"pins": {"A": {"mu": -0.1, "radius": 3.0}}}, "/pins/A/mu"),
    "no radius": ({"pins": {"A": {"mu": 0.1, "radius": 0.0}}}, "/pins/A/radius"),
    "no such pin": ({"pins": {"Q": {"mu": 0.1, "radius": 3.0}}}, "/pins/Q"),
    "nothing turns there": ({"pins": {"P": {"mu": 0.1, "radius": 3.0}}}, "/pins/P"),
    "no such slide": ({"slides": {"0": 0.1}}, "/slides/0"),
    "slide of another name": ({"slides": {"B": 0.1}}, "/slides/B"),
    "slide coefficient": ({"slides": {"0": math.pi}}, "/slides/0"),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_friction_is_refused_at_the_field(client: httpx.Client, name: str) -> None:
    stated, path = BAD[name]
    assert any(fault.startswith(f"/dynamics/friction{path}") for fault in refused(client, {"friction": stated}))
