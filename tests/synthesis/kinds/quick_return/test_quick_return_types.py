"""Quick return by slider-cranks, slotted links and drag links: optima by brute force, ranges, the choice of type."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from kinematics.linkage.fourbar import Fourbar, barker_type, find_transmission_extremes, positions
from synthesis.kinds.quick_return.design import DragLinkMechanism, QuickReturnMechanism
from synthesis.kinds.quick_return.drag_link import find_drag_link
from synthesis.model.linkage.answer import SliderCrankMechanism
from tests.cases import cases
from tests.support.synthesis.quick_return import answer

SLIDING = ("offset_slider_crank", "crank_shaper", "whitworth", "drag_link_slider")


def offset_limits(x: Any, e: Any) -> Any:
    """Time ratio of slider-cranks with crank x and offset e in couplers: by the directions of B at its limits."""
    far, near = np.arcsin(e / (1.0 + x)), np.arcsin(np.minimum(e / (1.0 - x), 1.0))
    return (math.pi + near - far) / (math.pi - near + far)


@pytest.mark.parametrize("ratio", [1.01, 1.1, 1.25, 1.5, 2.0, 2.5, 2.9])
def test_the_best_offset_slider_crank(ratio: float) -> None:
    best = answer(mechanism="offset_slider_crank", time_ratio=ratio, stroke=10.0)
    assert best.search.complete
    x = np.linspace(1e-3, 1.0 - 1e-3, 4001)[:, None]
    # For each crank the offset with the time ratio, between no offset and a coupler square to the slide.
    low, high = np.zeros_like(x), 1.0 - x
    reached = offset_limits(x, high) >= ratio
    for _ in range(60):
        middle = 0.5 * (low + high)
        above = offset_limits(x, middle) > ratio
        low, high = np.where(above, low, middle), np.where(above, middle, high)
    searched = math.degrees(math.acos(float((x + low)[reached].min())))
    angle = max(design.metrics.min_transmission_angle for design in best.designs)
    assert angle == pytest.approx(searched, abs=0.01)


def test_no_slider_crank_has_a_ratio_of_three() -> None:
    rng = np.random.default_rng(5)
    x, e = rng.uniform(0.0, 1.0, (2, 200_000))
    turning = x + e < 1.0
    assert offset_limits(x, e)[turning].max() < 3.0
    assert answer(mechanism="offset_slider_crank", time_ratio=2.99, stroke=1.0).designs
    none = answer(mechanism="offset_slider_crank", time_ratio=3.0, stroke=1.0)
    assert none.designs == []
    assert none.search.complete
    assert "below 3" in none.summary


def test_equal_strokes_of_a_slider_crank_have_no_offset() -> None:
    (design, *_) = answer(mechanism="offset_slider_crank", time_ratio=1.0, stroke=10.0).designs
    assert isinstance(design.mechanism, SliderCrankMechanism)
    assert abs(design.mechanism.offset) < 1e-12
    assert design.mechanism.links.crank == pytest.approx(5.0, rel=1e-12)
    demanded = {"min_transmission_angle": 89.0}
    (steep, *_) = answer(mechanism="offset_slider_crank", time_ratio=1.0, stroke=10.0, constraints=demanded).designs
    assert steep.metrics.min_transmission_angle >= 89.0 * (1.0 - 1e-9)


@pytest.mark.parametrize("ratio", [1.05, 1.4, 2.0, 3.0, 8.0])
@pytest.mark.parametrize("kind", ["crank_shaper", "whitworth"])
def test_slotted_links_have_ratio_and_stroke(kind: str, ratio: float) -> None:
    (design,) = answer(
        mechanism=kind, time_ratio=ratio, stroke=80.0, ground_angle=25.0, crank_pivot=[7.0, -3.0]
    ).designs
    made = design.mechanism
    assert isinstance(made, QuickReturnMechanism)
    assert (made.links.crank > made.links.ground) == (kind == "whitworth")
    assert design.metrics.time_ratio == pytest.approx(ratio, abs=1e-9)
    assert design.metrics.stroke == pytest.approx(80.0, rel=1e-9)
    assert made.slide.angle == 25.0
    # The block stays between O4 and C.
    assert made.links.ground + made.links.crank < made.links.rocker
    if kind == "crank_shaper":
        swing = 2.0 * math.asin(made.links.crank / made.links.ground)
        assert (math.pi + swing) / (math.pi - swing) == pytest.approx(ratio, rel=1e-12)


@pytest.mark.parametrize("kind", ["crank_shaper", "whitworth"])
def test_slotted_links_cannot_have_equal_strokes(kind: str) -> None:
    none = answer(mechanism=kind, time_ratio=1.0, stroke=80.0)
    assert none.designs == []
    assert none.search.complete
    assert "above 1" in none.summary


@pytest.mark.parametrize("kind", SLIDING)
def test_a_demanded_transmission_angle_is_met_or_refused(kind: str) -> None:
    limit = 65.0
    found = answer(mechanism=kind, time_ratio=1.4, stroke=80.0, constraints={"min_transmission_angle": limit})
    assert bool(found.designs) == (kind != "offset_slider_crank")
    assert all(design.metrics.min_transmission_angle >= limit - 1e-6 for design in found.designs)


def drag_links(link_ratio: float, count: int) -> Any:
    """Random drag links with their transmission angles and greatest time ratios, driven by the analysis core."""
    rng = np.random.default_rng(11)
    a, b, c = np.exp(rng.uniform(0.0, math.log(link_ratio), (3, count)))
    kept = barker_type(Fourbar.from_lengths(a, b, c, 1.0)) == 1
    a, b, c = a[kept], b[kept], c[kept]
    linkage = Fourbar.from_lengths(a, b, c, np.ones_like(a))
    theta = np.linspace(0.0, 2.0 * math.pi, 361)
    output = np.unwrap(positions(linkage, theta).output_angle, axis=-1)
    least = find_transmission_extremes(linkage, 0.0, 2.0 * math.pi)[0]
    greatest = np.empty(len(a))
    for n, row in enumerate(output):
        twice = np.concatenate([row, row[1:] + 2.0 * math.pi])
        turned = np.interp(row + math.pi, twice, np.concatenate([theta, theta[1:] + 2.0 * math.pi])) - theta
        greatest[n] = turned.max() / (2.0 * math.pi - turned.max())
    return np.degrees(least), greatest


@pytest.fixture(scope="module")
def sampled() -> Any:
    return drag_links(6.0, 20_000)


@pytest.mark.parametrize("ratio", [1.2, 1.5, 2.0, 2.5, 3.5])
def test_no_sampled_drag_link_transmits_better(sampled: Any, ratio: float) -> None:
    least, greatest = sampled
    assert len(least) > 3000
    best = find_drag_link(ratio, 6.0)
    assert best is not None
    searched = least[greatest >= ratio].max()
    found = math.degrees(best.transmission)
    assert found >= searched - 0.01
    assert found <= searched + 4.0  # the sample is coarse
    assert max(best.input, best.coupler, best.output) <= 6.0 * (1.0 + 1e-9)


@pytest.mark.parametrize("case", cases("quick_return_sixbar", "quick_return"))
def test_norton_example_3_10(case: Any) -> None:
    """Printed as fast over slow: 1/1.4; crank rotations of 150° and 210°."""
    ratio = 1.0 / case.inputs["time_ratio"]
    design = answer(mechanism="drag_link_rocker", time_ratio=ratio, swing=float(case.inputs["swing"])).designs[0]
    assert isinstance(design.mechanism, DragLinkMechanism)
    case.check(
        alpha=design.metrics.fast_rotation,
        beta=design.metrics.slow_rotation,
        achieved_alpha=design.metrics.fast_rotation,
        achieved_swing=design.metrics.swing,
        barker=design.metrics.barker,
    )


@pytest.mark.parametrize("ratio", [1.0, 1.02, 1.4, 2.0, 3.0, 6.0])
@pytest.mark.parametrize("swing", [20.0, 90.0, 150.0])
def test_drag_links_with_a_rocker(ratio: float, swing: float) -> None:
    found = answer(mechanism="drag_link_rocker", time_ratio=ratio, swing=swing, rocker_length=3.0).designs
    assert found
    for design in found:
        assert design.metrics.time_ratio == pytest.approx(ratio, abs=1e-9)
        assert design.metrics.swing == pytest.approx(swing, abs=1e-9)
        assert isinstance(design.mechanism, DragLinkMechanism)
        assert design.mechanism.links["output"] == pytest.approx(3.0, rel=1e-12)


def test_auto_gives_every_type_that_reaches_the_ratio() -> None:
    found = answer(time_ratio=1.4, stroke=50.0)
    kinds = {design.mechanism.type for design in found.designs}
    assert kinds == {"slider_crank", "crank_shaper", "whitworth", "drag_link_slider"}
    assert [reach.type for reach in found.reachable] == list(SLIDING)
    found = answer(time_ratio=1.4, stroke=50.0, rank_by="transmission_angle")
    angles = [design.metrics.min_transmission_angle for design in found.designs]
    assert angles == sorted(angles, reverse=True)
    fast = answer(time_ratio=5.0, stroke=50.0)
    assert "slider_crank" not in {design.mechanism.type for design in fast.designs}
    assert "offset slider crank cannot reach" in fast.summary
    swinging = answer(time_ratio=1.4, swing=60.0)
    assert {design.mechanism.type for design in swinging.designs} == {"fourbar", "drag_link_rocker"}


@pytest.mark.parametrize("kind", SLIDING)
@pytest.mark.parametrize("stroke", [1e-6, 1e6])
def test_strokes_of_any_size(kind: str, stroke: float) -> None:
    (design, *_) = answer(mechanism=kind, time_ratio=1.3, stroke=stroke).designs
    assert design.metrics.stroke == pytest.approx(stroke, rel=1e-9)


def test_a_huge_ratio_is_answered_honestly() -> None:
    """Near its change point a mechanism has too few digits for a ratio of 10⁸: nothing is returned, nothing proven."""
    for kind in ("crank_shaper", "drag_link_slider"):
        found = answer(mechanism=kind, time_ratio=1e8, stroke=1.0)
        assert found.designs == []
        assert not found.search.complete
        assert "No design was found" in found.summary


@pytest.mark.parametrize("limits", [{}, {"min_transmission_angle": 89.99}, {"max_link_ratio": 1.0001}])
def test_a_swing_of_nearly_half_a_turn_is_answered(limits: dict[str, float]) -> None:
    for kind in ("fourbar", "drag_link_rocker"):
        found = answer(mechanism=kind, time_ratio=1.0, swing=179.9999999, constraints=limits)
        assert all(design.verification.passed for design in found.designs)


@pytest.mark.parametrize("limit", [None, 80.0])
@pytest.mark.parametrize("ratio", [13.0, 14.5, 15.0, 30.0, 200.0])
def test_a_crank_shaper_reverses_twice_at_large_time_ratios(ratio: float, limit: float | None) -> None:
    constraints = {} if limit is None else {"min_transmission_angle": limit}
    found = answer(mechanism="crank_shaper", time_ratio=ratio, stroke=40.0, constraints=constraints)
    (design,) = found.designs
    links = design.mechanism.links
    # Crank over ground is the sine of half the link's swing, 90° (T − 1)/(T + 1).
    half = 0.5 * math.pi * (ratio - 1.0) / (ratio + 1.0)
    assert links.crank / links.ground == pytest.approx(math.sin(half), rel=1e-12)
    assert design.metrics.time_ratio == pytest.approx(ratio, rel=1e-9)
    assert design.metrics.stroke == pytest.approx(40.0, rel=1e-9)
