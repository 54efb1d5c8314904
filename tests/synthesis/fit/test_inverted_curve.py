"""Curves of Stephenson II sixbars by inversion: against the analysis core, slopes and margins against differences."""

from __future__ import annotations

import math

import numpy as np
import pytest

from kinematics.linkage.planar.drive import drive
from synthesis.fit.chart import compute_lengths
from synthesis.fit.constraints import BOXES, EQUATION_COUNT, GIVEN_PIVOTS, LIMIT_COUNT, LINKS, PIVOT_MARGIN
from synthesis.fit.inverted_curve import (
    GROUND_JOINT_COUNT,
    PIVOT,
    POINT,
    compute_inverted_joints,
    compute_inverted_slopes,
    compute_inverted_velocity,
    differentiate_slant,
    transform_to_ground,
)
from synthesis.fit.sixbar_curve import COUPLER, CRANK, DYAD, ROCKER, UNKNOWNS
from synthesis.kinds.path.residuals.sixbar import count_sixbar_margins, count_sixbar_rows
from synthesis.kinds.path.residuals.stephenson_2 import compute_inverted_rows
from synthesis.kinds.path.sixbar.mechanism import build_fitted_sixbar
from synthesis.kinds.path.sixbar.shape_matching import FORMS
from synthesis.verification.reconstruction import rebuild_mechanism
from tests.support.synthesis.sixbar_curve import drawn, stated

ALL = FORMS["stephenson_2"]
STEP = 1e-6


def seen(form, x, signs, theta):
    """Joints as the ground sees them, and cosine and sine of the least transmission angle."""
    lengths, places = np.empty(4), np.empty(GROUND_JOINT_COUNT, np.complex128)
    compute_lengths(form.family, x, lengths, np.empty((4, 4)))
    closes, cosine, sine = compute_inverted_joints(x, lengths, signs[0], form.carrier, signs[1], theta, places)
    assert closes
    return places, cosine, sine


@pytest.mark.parametrize("form", ALL)
def test_the_core_drives_the_same_curve_once_round(form):
    x, signs, theta = drawn(form)
    made = build_fitted_sixbar("stephenson_2", form, x, signs, theta[0], 3.0 - 2.0j, 7.0)
    angles = theta[0] + np.linspace(0.0, 2.0 * math.pi, 25)
    each = [seen(form, x, signs, angle) for angle in angles]
    o2 = complex(x[0], x[1])
    inputs = np.unwrap([np.angle(places[0] - o2) for places, _, _ in each])
    assert abs(inputs[-1] - inputs[0]) == pytest.approx(2.0 * math.pi)
    assert len(set(np.sign(np.diff(inputs)))) == 1
    motion = drive(rebuild_mechanism(made), inputs, order=0)
    assert motion.valid.all()
    expected = [3.0 - 2.0j + 7.0 * places[POINT] for places, _, _ in each]
    np.testing.assert_allclose(motion.joints["P"][0], expected, atol=1e-9)
    assert set(motion.sines) == {"link_3", "link_5", "output"}
    least = np.min(np.abs(list(motion.sines.values())), axis=0)
    np.testing.assert_allclose(least, [abs(sine) for _, _, sine in each], atol=1e-9)
    body = next(link for link in made.skeleton.links if "P" in link.joints)
    assert body.name == {CRANK: "link_3", COUPLER: "link_4", ROCKER: "link_5"}[form.carrier]


@pytest.mark.parametrize("form", ALL)
def test_slopes_are_those_of_differences(form):
    x, signs, theta = drawn(form)
    lengths, chart = np.empty(4), np.empty((4, 4))
    compute_lengths(form.family, x, lengths, chart)
    places, by = np.empty(PIVOT + 1, np.complex128), np.empty((PIVOT + 1, UNKNOWNS + 1), np.complex128)
    turns, row = np.zeros((3, UNKNOWNS + 1)), np.empty(UNKNOWNS)
    slopes = np.empty((GROUND_JOINT_COUNT, UNKNOWNS + 1), np.complex128)
    assert compute_inverted_slopes(x, lengths, chart, signs[0], form.carrier, signs[1], theta[5], turns, places, by)
    here = [transform_to_ground(x, joint, turns, places, by, slopes[joint]) for joint in range(GROUND_JOINT_COUNT)]
    np.testing.assert_allclose(here, seen(form, x, signs, theta[5])[0], atol=1e-12)
    assert differentiate_slant(places, by, row) == pytest.approx(seen(form, x, signs, theta[5])[1])
    for k in range(UNKNOWNS + 1):
        change, turn = STEP * (np.arange(UNKNOWNS) == k), STEP * (k == UNKNOWNS)
        (more, up, _), (less, down, _) = (seen(form, x + w * change, signs, theta[5] + w * turn) for w in (1.0, -1.0))
        np.testing.assert_allclose(slopes[:, k], (more - less) / (2.0 * STEP), atol=1e-6 * (1.0 + np.abs(slopes).max()))
        if k < UNKNOWNS:
            assert row[k] == pytest.approx((up - down) / (2.0 * STEP), abs=1e-6 * (1.0 + np.abs(row).max()))
    _, p, moved = compute_inverted_velocity(x, lengths, signs[0], form.carrier, signs[1], theta[5])
    assert p == pytest.approx(here[POINT])
    assert moved == pytest.approx(slopes[POINT, UNKNOWNS])


@pytest.mark.parametrize("form", ALL[::2])
def test_rows_descend_as_the_cost_does(form):
    """The gradient of half the sum of squares, angles eliminated and loads of all demands among it."""
    x, signs, theta = drawn(form)
    setting = stated(form, signs, x)
    places = np.array([seen(form, x, signs, angle)[0][POINT] for angle in theta[::2]])
    places = places + 1e-3 * (np.cos(5.0 * theta[::2]) + 1j * np.sin(3.0 * theta[::2]))
    points = np.stack([places.real, places.imag, np.zeros(24), np.linspace(0.5, 1.5, 24)], axis=1)
    limits = count_sixbar_margins(setting)
    multipliers = np.full(limits + 1, 1.0)

    def evaluated(at, state, settled=8):
        residuals, jacobian = (
            np.zeros(count_sixbar_rows(24, setting)),
            np.zeros((count_sixbar_rows(24, setting), UNKNOWNS)),
        )
        for _ in range(settled):
            count = compute_inverted_rows(at, points, setting, multipliers, state, residuals, jacobian)
            assert count > 0
        return residuals[:count], jacobian[:count]

    state = np.concatenate([theta[::2], np.zeros(limits)])
    residuals, jacobian = evaluated(x, state)
    assert np.isfinite(state).sum() > 24 + 150
    gradient = jacobian.T @ residuals
    differences = []
    for k in range(UNKNOWNS):
        change = STEP * (np.arange(UNKNOWNS) == k)
        costs = [0.5 * float(np.sum(evaluated(x + way * change, state.copy())[0] ** 2)) for way in (1.0, -1.0)]
        differences.append((costs[0] - costs[1]) / (2.0 * STEP))
    np.testing.assert_allclose(gradient, differences, rtol=1e-4, atol=1e-4 * np.abs(gradient).max())


def test_boxes_and_given_coordinates_are_of_the_pivots_on_the_ground():
    form = ALL[0]
    x, signs, theta = drawn(form)
    setting = stated(form, signs, x)
    setting[GIVEN_PIVOTS] = 0.1, 0.2, 0.3, 0.4
    limits, points = count_sixbar_margins(setting), np.array([[0.0, 0.0, 0.0, 1.0]])
    state = np.concatenate([theta[:1], np.zeros(limits)])
    residuals, jacobian = np.zeros(count_sixbar_rows(1, setting)), np.zeros((count_sixbar_rows(1, setting), UNKNOWNS))
    assert compute_inverted_rows(x, points, setting, np.ones(limits + 1), state, residuals, jacobian) > 0
    o2 = complex(x[0], x[1])
    o4 = o2 + np.exp(x[DYAD + 1] + 1j * x[2])
    assert state[-EQUATION_COUNT:] == pytest.approx([o2.real - 0.1, o2.imag - 0.2, o4.real - 0.3, o4.imag - 0.4])
    low, high = setting[BOXES][:2]
    sides = [way for at in (o2.real, o2.imag, o4.real, o4.imag) for way in (at - low, high - at)]
    assert state[1 + limits - LIMIT_COUNT + PIVOT_MARGIN :][:8] == pytest.approx(sides)
    made = build_fitted_sixbar("stephenson_2", form, x, signs, theta[0], 0j, 1.0)
    names = "input", "input_arm", "link_4_arm", "link_4_side", "output", "ground"
    margins = sorted(math.log(made.links[name] / setting[LINKS][0]) for name in names)
    assert sorted(state[1:13:2]) == pytest.approx(margins)
