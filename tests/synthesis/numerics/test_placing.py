"""Linkages put into boxes: planted places come back; what does not fit is as little outside as a fine search finds."""

import math

import numpy as np
import pytest

from synthesis.numerics.box_placement import Boxes, place_in_boxes


def boxes_around(places, margin):
    """One box around the first two places and one around the others."""
    rows = []
    for some in (places[:2], places[2:]):
        x, y = some.real, some.imag
        rows += [(x.min() - margin, x.max() + margin, y.min() - margin, y.max() + margin)] * len(some)
    return Boxes(*np.array(rows).T)


def outside(boxes, places):
    """How far the farthest place is outside of its box; negative where all are inside."""
    gaps = (boxes.left - places.real, places.real - boxes.right, boxes.low - places.imag, places.imag - boxes.high)
    return float(max(gap.max() for gap in gaps))


def random_joints(rng):
    return np.concatenate([[0.0, 1.0], rng.normal(size=(2, 2)) @ [1.0, 1j]])


@pytest.mark.parametrize("margin", [1e-9, 1e-3, 0.05])
def test_a_planted_place_is_found_however_narrow(margin):
    rng = np.random.default_rng(int(1.0 / margin))
    for _ in range(60):
        joints, size = random_joints(rng), rng.uniform(5.0, 200.0)
        places = 100.0 * complex(*rng.normal(size=2)) + size * np.exp(1j * rng.uniform(0.0, math.tau)) * joints
        boxes = boxes_around(places, margin * size)
        found = place_in_boxes(joints, boxes, 0.99 * size, 1.01 * size, 100.0 + 0j)
        assert found.fits
        assert outside(boxes, found.origin + found.along * joints) <= 1e-10 * size
        assert 0.99 * size * (1.0 - 1e-12) <= abs(found.along) <= 1.01 * size * (1.0 + 1e-12)


def test_what_does_not_fit_is_as_little_outside_as_can_be():
    rng = np.random.default_rng(2)
    boxes = Boxes(*np.array([(0.0, 10.0, 0.0, 1.0)] * 2 + [(20.0, 22.0, 0.0, 1.0)] * 2).T)
    sizes, turns = np.meshgrid(np.linspace(30.0, 40.0, 21), np.linspace(0.0, math.tau, 721))
    for _ in range(10):
        joints = random_joints(rng)
        found = place_in_boxes(joints, boxes, 30.0, 40.0, 100.0 + 0j)
        assert not found.fits
        moved = (sizes * np.exp(1j * turns))[..., None] * joints
        # Half of what the joints are farther apart than their boxes allow, in the direction in which that is more.
        x = (boxes.left - moved.real).max(axis=-1) - (boxes.right - moved.real).min(axis=-1)
        y = (boxes.low - moved.imag).max(axis=-1) - (boxes.high - moved.imag).min(axis=-1)
        least = 0.5 * float(np.maximum(x, y).min())
        assert outside(boxes, found.origin + found.along * joints) <= least * (1.0 + 1e-5)


def test_preferences_are_kept_where_they_fit():
    joints = np.array([0.0, 1.0, 0.3 + 0.8j, 1.2 + 0.9j])
    free = Boxes(*(np.full(4, sign * np.inf) for sign in (-1, 1, -1, 1)))
    assert place_in_boxes(joints, free, 0.0, math.inf, 100.0 + 0j) == (0j, 100.0 + 0j, True)
    wide = Boxes(*(np.full(4, sign * 500.0) for sign in (-1, 1, -1, 1)))
    assert place_in_boxes(joints, wide, 0.0, math.inf, 100.0 + 0j).along == 100.0
    flat = Boxes(*(np.array([limit] * 2 + [np.sign(limit) * np.inf] * 2) for limit in (-1.0, 1.0, -60.0, 60.0)))
    upright = place_in_boxes(joints, flat, 90.0, 110.0, 100.0 + 0j)
    assert upright.fits
    assert abs(upright.along.real) <= 2.0
    assert not place_in_boxes(joints, flat, 90.0, 110.0, 100.0 + 0j, turned=False).fits


def test_sizes_that_exclude_one_another_fit_nowhere():
    found = place_in_boxes(
        np.array([0j, 1.0 + 0j]), Boxes(*(np.full(2, sign * 500.0) for sign in (-1, 1, -1, 1))), 20.0, 5.0, 1j
    )
    assert not found.fits
    assert abs(found.along) == pytest.approx(10.0)
