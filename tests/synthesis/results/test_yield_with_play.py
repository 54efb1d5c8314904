"""The yield counts the play of pins: against linkages whose clearances are turned by chance and closed by circles."""

import cmath
import math

import numpy as np
import pytest

from synthesis.analyses import parse_request

LATCH = {
    "type": "fourbar",
    "fixed_pivots": {"input": [0.0, 0.0], "output": [60.0, 0.0]},
    "links": {"input": 20.0, "coupler": 70.0, "output": 50.0},
    "coupler_point": {"distance": 40.0, "angle": 30.0},
    "assembly": "open",
}
INPUTS = np.radians([40.0, 90.0, 130.0])
TOLERANCE, CLEARANCE, MAX_ERROR = 0.01, 0.05, 0.09
SAMPLES = 20_000


def close_fourbar(lengths, pins):
    """Positions of P at the inputs, shape (inputs, samples); ``pins`` are the four clearance links, of that shape."""
    o4x, crank, coupler, output = lengths
    a = crank * np.exp(1j * INPUTS)[:, None] + pins[0] + pins[1]
    to_pivot = o4x + pins[3] - pins[2] - a
    distance = np.abs(to_pivot)
    along = (distance**2 + coupler**2 - output**2) / (2.0 * distance)
    turn = (along + 1j * np.sqrt(coupler**2 - along**2)) * to_pivot / distance / coupler
    return a + turn * cmath.rect(40.0, math.radians(30.0))


def sample_independently(clearance):
    rng = np.random.default_rng(11)
    nominal = close_fourbar([60.0, 20.0, 70.0, 50.0], np.zeros((4, 3, 1)))
    off = rng.uniform(-TOLERANCE, TOLERANCE, (3, SAMPLES))
    shape = 4, 3, SAMPLES
    pins = clearance * np.sqrt(rng.uniform(size=shape)) * np.exp(2j * np.pi * rng.uniform(size=shape))
    places = close_fourbar([60.0, 20.0 + off[0], 70.0 + off[1], 50.0 + off[2]], pins)
    # The coordinates of P on the coupler have the tolerance of lengths too.
    reach = rng.uniform(-TOLERANCE, TOLERANCE, (2, SAMPLES))
    return nominal[:, 0], np.mean((np.abs(places - nominal + reach[0] + 1j * reach[1]) <= MAX_ERROR).all(axis=0))


@pytest.mark.parametrize("clearance", [0.0, CLEARANCE])
def test_the_yield_is_that_of_pins_anywhere_in_their_holes(clearance):
    places, expected = sample_independently(clearance)
    targets = [
        {"x": place.real, "y": place.imag, "input_angle": math.degrees(angle)}
        for place, angle in zip(places, INPUTS, strict=True)
    ]
    block = {
        "tolerances": {"length": TOLERANCE, "pin_clearance": clearance},
        "quality": {"max_error": MAX_ERROR},
        "input": "fixed",
        "samples": SAMPLES,
    }
    found = parse_request({"mechanism": LATCH, "targets": targets, "manufacture": block}).build_answer()["yield"]
    assert found["value"] == pytest.approx(expected, abs=0.015)
    assert (found["value"] > 0.98) == (clearance == 0.0)


def test_the_play_of_a_slider_moves_its_line_and_its_crank():
    """An in-line slider-crank at dead centre: only clearances along the slide count, two of the crank and its pin."""
    slider = {
        "type": "slider_crank",
        "fixed_pivot": [0.0, 0.0],
        "links": {"crank": 20.0, "coupler": 70.0},
        "slide": {"point": [0.0, 0.0], "angle": 30.0},
        "assembly": "open",
    }
    limit = 0.06
    block = {
        "tolerances": {"length": 1e-9, "pin_clearance": CLEARANCE},
        "quality": {"max_error": limit},
        "input": "fixed",
        "samples": SAMPLES,
    }
    targets = [{"input_angle": 30.0, "output": 90.0}]
    found = parse_request({"mechanism": slider, "targets": targets, "manufacture": block}).build_answer()["yield"]
    rng = np.random.default_rng(5)
    pins = CLEARANCE * np.sqrt(rng.uniform(size=(2, SAMPLES))) * np.exp(2j * np.pi * rng.uniform(size=(2, SAMPLES)))
    expected = np.mean(np.abs(pins.sum(axis=0).real) <= limit)
    assert found["value"] == pytest.approx(expected, abs=0.015)
