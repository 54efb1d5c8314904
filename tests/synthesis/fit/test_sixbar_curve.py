"""Curves of sixbars: closed forms against the analysis core, slopes and margins against differences."""

from __future__ import annotations

import math
from itertools import chain

import numpy as np
import pytest

from kinematics.linkage.planar.drive import drive
from synthesis.fit.chart import compute_lengths
from synthesis.fit.sixbar_curve import (
    GROUND,
    INPUT,
    UNKNOWNS,
    compute_velocity,
    differentiate_pins,
    differentiate_point,
    locate_joints,
)
from synthesis.kinds.path.residuals.sixbar import (
    compute_sixbar_rows,
    count_sixbar_margins,
    count_sixbar_rows,
)
from synthesis.kinds.path.sixbar.mechanism import build_fitted_sixbar
from synthesis.kinds.path.sixbar.shape_matching import FORMS
from synthesis.verification.reconstruction import rebuild_mechanism
from tests.support.synthesis.sixbar_curve import drawn, stated

ALL = [(kind, form) for kind, forms in FORMS.items() for form in forms if form.holder != INPUT]


def p_at(form, x, signs, theta):
    lengths, places = np.empty(4), np.empty(6, np.complex128)
    compute_lengths(form.family, x, lengths, np.empty((4, 4)))
    assert locate_joints(x, lengths, signs[0], form.carrier, form.holder, signs[1], theta, places)
    return complex(places[5])


@pytest.mark.parametrize(("kind", "form"), ALL)
def test_the_core_drives_the_same_curve(kind, form):
    x, signs, theta = drawn(form)
    made = build_fitted_sixbar(kind, form, x, signs, theta[0], 3.0 - 2.0j, 7.0)
    turned = np.linspace(0.0, 2.0 * math.pi, 25)
    motion = drive(rebuild_mechanism(made), theta[0] + turned, order=0)
    expected = [3.0 - 2.0j + 7.0 * p_at(form, x, signs, theta[0] + turn) for turn in turned]
    assert motion.valid.all()
    np.testing.assert_allclose(motion.joints["P"][0], expected, atol=1e-10)
    assert made.type == kind
    assert set(motion.sines) == {"coupler", "link_5"}
    assert min(np.abs(sines).min() for sines in motion.sines.values()) > math.sin(math.radians(14.0))
    body = next(link for link in made.skeleton.links if "P" in link.joints)
    assert not {"O2", "O4", "O6"} & set(body.joints)


@pytest.mark.parametrize(("kind", "form"), ALL)
def test_slopes_are_those_of_differences(kind, form):
    x, signs, theta = drawn(form)
    lengths, chart = np.empty(4), np.empty((4, 4))
    compute_lengths(form.family, x, lengths, chart)
    by_c, by_d, slopes = (np.empty(UNKNOWNS + 1, np.complex128) for _ in range(3))
    pinned = x, lengths, chart, signs[0], form.carrier, form.holder, theta[5], np.empty((2, UNKNOWNS + 1)), by_c, by_d
    _, c, d = differentiate_pins(*pinned)
    _, p = differentiate_point(x, signs[1], c, d, by_c, by_d, slopes)
    step = 1e-6
    for k in range(UNKNOWNS):
        change = step * (np.arange(UNKNOWNS) == k)
        difference = p_at(form, x + change, signs, theta[5]) - p_at(form, x - change, signs, theta[5])
        assert slopes[k] == pytest.approx(difference / (2.0 * step), abs=1e-6 * (1.0 + abs(slopes[k])))
    difference = p_at(form, x, signs, theta[5] + step) - p_at(form, x, signs, theta[5] - step)
    assert slopes[-1] == pytest.approx(difference / (2.0 * step), abs=1e-6)
    _, there, moved = compute_velocity(x, lengths, signs[0], form.carrier, form.holder, signs[1], theta[5])
    assert there == pytest.approx(p)
    assert moved == pytest.approx(slopes[-1])


@pytest.mark.parametrize(("kind", "form"), ALL[::3])
def test_rows_descend_as_the_cost_does(kind, form):
    """The gradient of half the sum of squares, angles eliminated and loads of all demands among it."""
    x, signs, theta = drawn(form)
    setting = stated(form, signs, x)
    places = np.array([p_at(form, x, signs, angle) for angle in theta[::2]])
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
            count = compute_sixbar_rows(at, points, setting, multipliers, state, residuals, jacobian)
            assert count > 0
        return residuals[:count], jacobian[:count]

    state = np.concatenate([theta[::2], np.zeros(limits)])
    residuals, jacobian = evaluated(x, state)
    assert np.isfinite(state).sum() > 24 + 150
    gradient, step = jacobian.T @ residuals, 1e-6
    differences = []
    for k in range(UNKNOWNS):
        change = step * (np.arange(UNKNOWNS) == k)
        costs = [0.5 * float(np.sum(evaluated(x + way * change, state.copy())[0] ** 2)) for way in (1.0, -1.0)]
        differences.append((costs[0] - costs[1]) / (2.0 * step))
    np.testing.assert_allclose(gradient, differences, rtol=1e-4, atol=1e-4 * np.abs(gradient).max())


def test_every_form_has_its_point_off_the_ground():
    assert {form.carrier for _, form in ALL}.isdisjoint({GROUND})
    every = list(chain.from_iterable(FORMS.values()))
    assert len(every) == len(set(every))
