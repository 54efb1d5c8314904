"""Variants of a linkage, driven to its targets, against root finding and a bounded search."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

from kinematics.errors import ShapeError
from kinematics.linkage.variation import Task, measure_deviations, measure_shares
from tests.kinematics.variation_twin import Twin, crank_rocker, slider

TASKS = [(make, sort) for make in (crank_rocker, slider) for sort in ("poses", "points", "outputs")]


@pytest.mark.parametrize(("make", "sort"), TASKS)
@pytest.mark.parametrize("adjusted", [True, False])
@pytest.mark.parametrize("greatest", [True, False])
def test_variants_deviate_as_roots_say(make, sort: str, adjusted: bool, greatest: bool) -> None:
    units = {"points": (0.05, math.inf), "poses": (0.05, 0.01), "outputs": (0.05, 0.01)}[sort]
    nominal, task = make(sort, adjusted=adjusted, units=units)
    task = dataclasses.replace(task, greatest=greatest)
    rng = np.random.default_rng([7, adjusted, greatest])
    rows = nominal + rng.uniform(-0.05, 0.05, (3, len(nominal)))
    driven = measure_deviations(task, rows)
    for i, row in enumerate(rows):
        twin = Twin(task, nominal, row)
        for k in range(len(task.inputs)):
            at = twin.nearest(k)
            taken = driven.distances[i, k] / units[0], driven.angles[i, k] / units[1]
            share = max(taken) if greatest else math.hypot(*taken)
            there = twin.share(k, at)
            # Where distance and angle are alike the bounded search stops short of the corner.
            assert there - 1e-5 <= share <= there + 1e-7
            gap, off = twin.offset(k, float(driven.inputs[i, k]))
            assert driven.offsets[i, k] == pytest.approx([gap.real, gap.imag, off], abs=1e-8)


@pytest.mark.parametrize(("make", "sort"), TASKS)
def test_the_share_of_a_variant_is_that_of_its_deviations(make, sort: str) -> None:
    nominal, task = make(sort)
    rows = nominal + np.random.default_rng(3).uniform(-0.02, 0.02, (2000, len(nominal)))
    driven = measure_deviations(task, rows)
    most = np.maximum(driven.distances / 0.05, driven.angles / 0.01).max(axis=1)
    share = measure_shares(task, rows)
    assert 50 < np.count_nonzero(share <= 1.0) < 1950
    assert np.array_equal(share <= 1.0, most <= 1.0)
    assert share[share <= 1.0] == pytest.approx(most[most <= 1.0], rel=1e-12)


def test_targets_that_are_met_exactly_have_no_deviation() -> None:
    nominal, task = crank_rocker("poses")
    at = measure_deviations(task, nominal[None])
    exact = dataclasses.replace(
        task,
        points=task.points + at.offsets[0, :, 0] + 1j * at.offsets[0, :, 1],
        angles=task.angles + at.offsets[0, :, 2],
        inputs=at.inputs[0],
    )
    driven = measure_deviations(exact, nominal[None])
    # The last step is taken along the tangent, and leaves the square of a hundred-thousandth of the crank.
    assert driven.distances.max() < 1e-9
    assert driven.angles.max() < 1e-9
    assert driven.inputs == pytest.approx(at.inputs, abs=1e-10)


def folding(used: tuple[float, float] | None, *, adjusted: bool = False) -> tuple[np.ndarray, Task]:
    """A fourbar with a long ground, which folds at a crank angle of ±1.2 rad, near to its last target."""
    a, b, d = 3.0, 3.5, 5.0
    f = math.sqrt(a * a + d * d - 2.0 * a * d * math.cos(1.2))
    nominal = np.array([0.0, 0.0, d, 0.0, a, b, f - b, 1.0, 1.0])
    inputs = np.array([0.6, 1.1])
    return nominal, Task(
        "points", np.ones(2, np.int64), inputs, points=np.zeros(2, complex), used=used, adjusted=adjusted
    )


def test_variants_that_cannot_be_assembled_or_leave_their_branch_have_no_deviation() -> None:
    nominal, task = folding((0.6, 1.1))
    shorter = nominal - [0, 0, 0, 0, 0, 0, 0.4, 0, 0]
    longer = 2.0 * nominal - shorter
    driven = measure_deviations(task, [nominal, shorter, longer])
    assert np.isfinite(driven.offsets[[0, 2]]).all()
    assert np.isfinite(driven.offsets[1, 0]).all()
    assert np.isnan(driven.offsets[1, 1]).all()
    # The range that is used goes on to 1.25 rad, where the nominal linkage has folded already.
    beyond = folding((0.6, 1.25))[1]
    driven = measure_deviations(beyond, [nominal, longer])
    assert np.isnan(driven.offsets[0]).all()
    assert np.isfinite(driven.offsets[1]).all()
    # Targets on both sides of a place where the linkage cannot be assembled.
    across = dataclasses.replace(folding(None)[1], inputs=np.array([0.6, math.tau - 0.6]))
    assert np.isfinite(measure_deviations(across, [nominal]).offsets).all()
    held = dataclasses.replace(across, used=(0.6, math.tau - 0.6))
    assert np.isnan(measure_deviations(held, [nominal]).offsets).all()


def test_a_variant_that_folds_before_a_target_comes_as_near_as_it_can() -> None:
    nominal, task = folding(None, adjusted=True)
    shorter = nominal - [0, 0, 0, 0, 0, 0, 0.02, 0, 0]
    first = measure_deviations(dataclasses.replace(task, adjusted=False), [nominal])
    task = dataclasses.replace(task, points=first.offsets[0, :, 0] + 1j * first.offsets[0, :, 1])
    driven = measure_deviations(task, [shorter])
    assert np.isfinite(driven.offsets).all()
    twin = Twin(task, nominal, shorter)
    assert driven.distances[0, 1] == pytest.approx(twin.share(1, twin.nearest(1, reach=0.2)), rel=1e-3)


def test_a_slider_crank_is_held_to_its_branch() -> None:
    nominal, task = slider("points")
    through = dataclasses.replace(task, used=(-0.4, -0.4 + math.tau))
    assert np.isfinite(measure_deviations(through, nominal[None]).offsets).all()
    # With a coupler shorter than crank and offset together the crank does not turn through.
    short = nominal.copy()
    short[4] = abs(nominal[2]) + 1.5
    assert np.isfinite(measure_deviations(task, short[None]).offsets).all()
    assert np.isnan(measure_deviations(through, short[None]).offsets).all()


def test_links_without_a_length_make_no_linkage() -> None:
    for nominal, task in (crank_rocker("poses"), slider("poses")):
        rows = np.repeat(nominal[None], 2, axis=0)
        rows[0, 4], rows[1, 4] = 0.0, -rows[1, 4]
        assert np.isnan(measure_deviations(task, rows).offsets).all()
        assert np.isinf(measure_shares(task, rows)).all()


def test_rows_of_another_linkage_are_refused() -> None:
    nominal, task = crank_rocker("outputs")
    with pytest.raises(ShapeError, match="variants"):
        measure_deviations(task, np.zeros((2, len(nominal) + 2)))


@pytest.mark.parametrize(("make", "sort"), TASKS)
def test_what_is_set_on_a_variant_is_what_is_demanded_less(make, sort: str) -> None:
    nominal, task = make(sort, adjusted=False)
    rows = nominal + np.random.default_rng(5).uniform(-0.05, 0.05, (4, len(nominal)))
    farther, more = 0.03, 0.002
    less = more if sort == "poses" else -more
    changed = {"inputs": task.inputs + farther}
    if task.angles is not None:
        changed["angles"] = task.angles - less
    if task.travels is not None:
        changed["travels"] = task.travels - less
    expected = measure_deviations(dataclasses.replace(task, used=None, **changed), rows)
    given = measure_deviations(dataclasses.replace(task, used=None), rows, np.full((4, 2), [farther, more]))
    assert given.offsets == pytest.approx(expected.offsets, abs=1e-13)
    assert given.inputs == pytest.approx(expected.inputs, abs=1e-13)


def test_dials_counted_from_the_ground_turn_with_it() -> None:
    nominal, task = crank_rocker("outputs")
    o2, o4 = complex(*nominal[:2]), complex(*nominal[2:4])
    dials = dataclasses.replace(task, on_ground=(True, True), ground_angle=float(np.angle(o4 - o2)), used=None)
    turned = nominal.copy()
    around = o2 + (o4 - o2) * np.exp(0.3j)
    turned[2:4] = around.real, around.imag
    assert measure_deviations(dials, turned[None]).offsets == pytest.approx(
        measure_deviations(task, nominal[None]).offsets, abs=1e-13
    )
    assert np.abs(measure_deviations(task, turned[None]).offsets).max() > 0.1


def test_settings_of_other_variants_are_refused() -> None:
    nominal, task = crank_rocker("poses")
    with pytest.raises(ShapeError, match="settings"):
        measure_deviations(task, nominal[None], np.zeros((2, 2)))
