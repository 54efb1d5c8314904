"""Quick return: literature, brute force, the proof of what cannot be reached, and what problems are refused."""

from __future__ import annotations

import json
import math
from itertools import product
from typing import Any

import numpy as np
import pytest
from pydantic import ValidationError

from kinematics.linkage.fourbar import Fourbar, barker_type, find_transmission_extremes
from synthesis.dispatch import solve
from synthesis.kinds.quick_return.crank_rocker import list_families
from synthesis.kinds.quick_return.design import QuickReturnDesign
from synthesis.model.linkage.answer import FourbarMechanism
from synthesis.registry import KINDS, parse_problem
from tests.cases import HERE
from tests.support.synthesis.quick_return import crank_rocker

OPTIMA, CENTRAL = json.loads((HERE / "crank_rocker_optimum.json").read_text(encoding="utf-8"))


def in_grounds(design: QuickReturnDesign) -> np.ndarray[Any, Any]:
    """Ground, crank, coupler and rocker over the ground."""
    assert isinstance(design.mechanism, FourbarMechanism)
    links = design.mechanism.links
    return np.array([links.ground, links.input, links.coupler, links.output]) / links.ground


@pytest.mark.parametrize("row", OPTIMA["inputs"]["table"], ids=lambda row: f"{row['phi_deg']}-{row['psi_deg']}")
def test_the_optimum_of_freudenstein_and_primrose(row: dict[str, Any]) -> None:
    stated = {"time_ratio": row["time_ratio"], "swing": float(row["psi_deg"]), "rank_by": "transmission_angle"}
    found = crank_rocker(**stated).designs
    near = [d for d in found if np.allclose(in_grounds(d), row["links"], rtol=0.0, atol=1e-6)]
    assert len(near) == 1, [in_grounds(d) for d in found]
    assert near[0].metrics.min_transmission_angle == pytest.approx(row["mu_min_deg"], abs=1e-6)
    # Each row is the best of one of the two families; no design of the answer beats the better family's best.
    assert found[0].metrics.min_transmission_angle >= near[0].metrics.min_transmission_angle - 1e-9


@pytest.mark.parametrize("row", CENTRAL["inputs"]["table"], ids=lambda row: f"{row['swing_deg']}-{row['mu_deg']}")
def test_equal_strokes_with_the_transmission_angle_of_brodell_and_soni(row: dict[str, Any]) -> None:
    """Their linkage is the one whose link ratio is just as large as it must be for the transmission angle."""
    links = row["links"]
    found = crank_rocker(
        time_ratio=1.0,
        swing=float(row["swing_deg"]),
        constraints={"max_link_ratio": max(links) / min(links), "min_transmission_angle": row["mu_deg"] - 1e-6},
    ).designs
    assert np.allclose(in_grounds(found[0]), links, rtol=0.0, atol=1e-6)
    assert found[0].metrics.min_transmission_angle == pytest.approx(row["mu_deg"], abs=1e-6)


def test_norton_example_3_9() -> None:
    """Time ratio 1:1.25 and a swing of 45°: crank rotations of 160° and 200°."""
    best = crank_rocker(time_ratio=1.25, swing=45.0).designs[0]
    assert best.metrics.barker == "GCRR"
    assert best.metrics.slow_rotation == pytest.approx(200.0, abs=1e-9)
    assert best.metrics.fast_rotation == pytest.approx(160.0, abs=1e-9)
    assert best.metrics.swing == pytest.approx(45.0, abs=1e-9)


def best_by_brute_force(time_ratio: float, swing: float) -> float:
    """The best transmission angle of crank-rockers with O2 anywhere on the circle over the chord of B, driven.

    The rocker has a length of 1 and its pivot at 0. From O2 the chord B1 B2 is seen under the angle δ (Norton 3-9): O2
    lies on one of two circles through B1 and B2, on the chord's line for a ratio of 1.
    """
    psi, delta = math.radians(swing), math.pi * (time_ratio - 1.0) / (time_ratio + 1.0)
    b1, b2 = complex(1.0), complex(math.cos(psi), math.sin(psi))
    middle, half = 0.5 * (b1 + b2), 0.5 * abs(b2 - b1)
    along = (b2 - b1) / abs(b2 - b1)
    if delta == 0.0:
        far = half * (1.0 + np.geomspace(1e-3, 1e3, 20001))
        o2 = np.concatenate([middle + along * far, middle - along * far])
    else:
        around = half / math.sin(delta) * np.exp(1j * np.linspace(0.0, 2.0 * math.pi, 40001))
        centre = 1j * along * half / math.tan(delta)
        o2 = np.concatenate([middle + centre + around, middle - centre + around])
    one, other = np.abs(b1 - o2), np.abs(b2 - o2)
    a, b = 0.5 * np.abs(one - other), 0.5 * (one + other)
    sound = (a > 1e-9) & (np.abs(o2) > 1e-9)
    o2, a, b, b_1, b_2 = o2[sound], a[sound], b[sound], b1 - o2[sound], b2 - o2[sound]
    linkage = Fourbar(o2, 0.0, a, b, 1.0)
    on_one_circuit = np.sign((-o2.conj() * b_1).imag) == np.sign((-o2.conj() * b_2).imag)
    # The chord is seen under δ or π − δ: crank and coupler are one line at both ends, the nearer one folded.
    seen = np.abs(np.angle(b_2 / b_1))
    turning = (barker_type(linkage) == 2) & on_one_circuit & (np.abs(seen - delta) < 1e-6)
    if not turning.any():
        return 0.0
    least = find_transmission_extremes(linkage, 0.0, 2.0 * math.pi)[0]
    return math.degrees(float(least[turning].max()))


@pytest.mark.parametrize(
    ("swing", "ratio"),
    list(product([20.0, 40.0, 60.0, 80.0, 100.0, 120.0], [1.0, 1.1, 1.2, 1.3, 1.4, 1.5, 1.6])),
)
def test_over_the_grid_the_best_is_found_and_measured(swing: float, ratio: float) -> None:
    result = crank_rocker(time_ratio=ratio, swing=swing)
    assert result.search.complete
    for design in result.designs:
        assert design.metrics.time_ratio == pytest.approx(ratio, abs=1e-9)
        assert design.metrics.swing == pytest.approx(swing, abs=1e-9)
    first = result.designs[0].metrics
    # The best quality stands first among those that transmit well enough; designs are searched up to a link ratio of
    # 10 itself, which the measured lengths give to their last digits only.
    metrics = [design.metrics for design in result.designs]
    for least in (30.0, 20.0):
        even = [one for one in metrics if one.link_ratio <= 10.0 * (1.0 + 1e-12)]
        sound = [one for one in even if one.min_transmission_angle >= least]
        if sound:
            assert first.quality == max(one.quality for one in sound)
            break
    # Ranked by the angle, only linkages with extreme links, which cannot be built, are not the first.
    best = max(one.min_transmission_angle for one in metrics if one.link_ratio <= 50.0)
    ranked = crank_rocker(time_ratio=ratio, swing=swing, rank_by="transmission_angle").designs
    assert ranked[0].metrics.min_transmission_angle == pytest.approx(best, rel=1e-9)


def test_no_crank_rocker_has_a_ratio_beyond_the_stated_range() -> None:
    """Sampled over all shapes; strokes by the law of cosines."""
    rng = np.random.default_rng(3)
    lengths = 10.0 ** rng.uniform(-1.5, 0.0, (400_000, 4))
    a, b, c, d = lengths.T
    a, b, c, d = (x[barker_type(Fourbar.from_lengths(a, b, c, d)) == 2] for x in (a, b, c, d))
    assert len(a) > 20_000

    def corner(side: Any, one: Any, other: Any) -> Any:
        return np.arccos(np.clip((one * one + other * other - side * side) / (2.0 * one * other), -1.0, 1.0))

    rotation = math.pi + corner(c, d, b - a) - corner(c, d, a + b)
    swing = np.degrees(np.abs(corner(b - a, c, d) - corner(a + b, c, d)))
    ratio = np.maximum(rotation, 2.0 * math.pi - rotation) / np.minimum(rotation, 2.0 * math.pi - rotation)
    share = ratio * (180.0 - swing) / (540.0 + swing)
    assert share.max() < 1.0
    assert share.max() > 0.8  # the bound is near to what is met


@pytest.mark.parametrize("swing", [1.0, 20.0, 90.0, 150.0, 170.0])
def test_the_range_is_reached_up_to_its_end_and_not_beyond(swing: float) -> None:
    greatest = (540.0 + swing) / (180.0 - swing)
    inside = crank_rocker(time_ratio=0.99 * greatest, swing=swing)
    assert inside.designs
    (reach,) = inside.reachable
    assert reach.greatest == pytest.approx(greatest)
    outside = crank_rocker(time_ratio=1.0001 * greatest, swing=swing)
    assert outside.designs == []
    assert outside.search.complete
    assert not outside.reachable[0].reaches
    assert f"{greatest:.6g}" in outside.summary


@pytest.mark.parametrize("swing", [180.0, 270.0, 359.0])
def test_no_crank_rocker_swings_by_half_a_turn(swing: float) -> None:
    result = crank_rocker(time_ratio=1.2, swing=swing)
    assert result.designs == []
    assert result.search.complete
    assert "less than 180°" in result.summary


def test_a_limit_of_the_link_ratio_is_met_by_the_best_within_it() -> None:
    free = crank_rocker(time_ratio=1.1, swing=60.0, rank_by="transmission_angle").designs[0]
    limit = 0.8 * free.metrics.link_ratio
    best = crank_rocker(
        time_ratio=1.1, swing=60.0, constraints={"max_link_ratio": limit}, rank_by="transmission_angle"
    ).designs[0]
    assert best.metrics.link_ratio == pytest.approx(limit, rel=1e-6)
    members = list_families(1.1, math.radians(60.0))
    rho = np.linspace(1.001, 20.0, 20001)
    allowed = [f.compute_transmission(r) for f in members for r in rho if f.link_ratio(r) <= limit]
    assert best.metrics.min_transmission_angle >= math.degrees(max(allowed)) - 1e-6


def test_no_link_ratio_below_what_the_swing_needs() -> None:
    needed = 1.0 / math.sin(math.radians(10.0))
    none = crank_rocker(time_ratio=1.2, swing=20.0, constraints={"max_link_ratio": 0.999 * needed})
    assert none.designs == []
    assert none.search.complete
    assert "link ratio" in none.summary
    assert crank_rocker(time_ratio=1.2, swing=20.0, constraints={"max_link_ratio": 1.05 * needed}).designs


def test_a_transmission_angle_above_the_best_is_proven_to_be_out_of_reach() -> None:
    best = crank_rocker(time_ratio=1.25, swing=45.0).designs[0].metrics.min_transmission_angle
    assert crank_rocker(time_ratio=1.25, swing=45.0, constraints={"min_transmission_angle": best - 1e-3}).designs
    none = crank_rocker(time_ratio=1.25, swing=45.0, constraints={"min_transmission_angle": best + 1e-3})
    assert none.designs == []
    assert none.search.complete


def test_a_transmission_angle_just_below_the_bound_of_equal_strokes_is_met() -> None:
    found = crank_rocker(time_ratio=1.0, swing=20.0, constraints={"min_transmission_angle": 79.9999})
    assert found.designs
    assert found.designs[0].metrics.min_transmission_angle >= 79.9999 * (1.0 - 1e-9)
    none = crank_rocker(time_ratio=1.0, swing=20.0, constraints={"min_transmission_angle": 80.01})
    assert none.designs == []
    assert none.search.complete


@pytest.mark.parametrize("size", [1e-6, 1.0, 1e6])
def test_size_and_place(size: float) -> None:
    stated = {"time_ratio": 1.2, "swing": 50.0, "rocker_length": size, "ground_angle": 30.0}
    design = crank_rocker(**stated, crank_pivot=[1e2 * size, -2e2 * size]).designs[0]
    assert isinstance(design.mechanism, FourbarMechanism)
    assert design.mechanism.links.output == pytest.approx(size, rel=1e-12)
    pivots = design.mechanism.fixed_pivots
    assert pivots.input == (1e2 * size, -2e2 * size)
    ground = complex(*pivots.output) - complex(*pivots.input)
    assert np.degrees(np.angle(ground)) == pytest.approx(30.0, abs=1e-9)
    assert design.verification.passed


def test_limits_of_length_set_the_size() -> None:
    limits = {"min": 20.0, "max": 100.0}
    found = crank_rocker(time_ratio=1.2, swing=50.0, constraints={"link_length": limits}).designs
    assert found
    for design in found:
        assert isinstance(design.mechanism, FourbarMechanism)
        lengths = design.mechanism.links.model_dump().values()
        assert max(lengths) <= 100.0 * (1.0 + 1e-9)
        assert min(lengths) >= 20.0 * (1.0 - 1e-9)


@pytest.mark.parametrize(
    ("stated", "path"),
    [
        ({"time_ratio": 1.2, "swing": 0.0}, "swing"),
        ({"time_ratio": 1.2, "swing": 360.0}, "swing"),
        ({"time_ratio": 0.99, "swing": 40.0}, "time_ratio"),
        ({"time_ratio": 1e10, "swing": 40.0}, "time_ratio"),
        ({"time_ratio": 1.2, "swing": math.nan}, "swing"),
        ({"time_ratio": 1.2, "swing": 40.0, "rocker_length": 0.0}, "rocker_length"),
    ],
)
def test_what_is_refused(stated: dict[str, Any], path: str) -> None:
    with pytest.raises(ValidationError) as caught:
        parse_problem({"kind": "quick_return", "mechanism": "fourbar", **stated})
    assert caught.value.errors()[0]["loc"][-1] == path


@pytest.mark.parametrize(
    ("stated", "path"),
    [
        ({"mechanism": "fourbar"}, "/swing"),
        ({"mechanism": "fourbar", "swing": 40.0, "stroke": 3.0}, "/stroke"),
        ({"mechanism": "auto"}, "/swing"),
        ({"mechanism": "whitworth"}, "/stroke"),
        ({"mechanism": "crank_shaper", "stroke": 1.0, "swing": 1.0}, "/swing"),
        ({"mechanism": "auto", "swing": 40.0, "stroke": 3.0}, "/swing"),
    ],
)
def test_contradictions_name_their_field(stated: dict[str, Any], path: str) -> None:
    problem = parse_problem({"kind": "quick_return", "time_ratio": 1.2, **stated})
    assert [found.path for found in problem.find_contradictions()] == [path]


def random_pairs(count: int) -> list[tuple[float, float]]:
    """Swings and time ratios within the range, not near to its end."""
    rng = np.random.default_rng(17)
    swings = rng.uniform(5.0, 150.0, count)
    return [(s, 1.03 + rng.uniform(0.0, 0.5) * ((540.0 + s) / (180.0 - s) - 1.03)) for s in swings.tolist()]


@pytest.mark.parametrize(("swing", "ratio"), random_pairs(12))
def test_demands_on_both_sides_of_the_searched_best(swing: float, ratio: float) -> None:
    """What a search over all crank-rockers reaches is found; what it misses by a little is said not to exist."""
    searched = best_by_brute_force(ratio, swing)
    below, above = ({"min_transmission_angle": searched + by} for by in (-0.02, 0.02))
    assert crank_rocker(time_ratio=ratio, swing=swing, constraints=below).designs
    none = crank_rocker(time_ratio=ratio, swing=swing, constraints=above)
    assert none.designs == []
    assert none.search.complete


@pytest.mark.parametrize("mechanism", ["auto", "fourbar", "drag_link_rocker"])
def test_a_transmission_angle_above_the_bound_of_a_swing_is_proven_impossible(mechanism: str) -> None:
    """A rocker of 110° transmits at less than 90° − 55° = 35°, alone or behind a drag link."""
    limits = {"min_transmission_angle": 40.0}
    statement = {"kind": "quick_return", "swing": 110.0, "time_ratio": 1.5, "mechanism": mechanism}
    result = KINDS["quick_return"].solve(parse_problem({**statement, "constraints": limits}), lambda *_: None)
    assert (result.designs, result.search.complete) == ([], True)
    assert result.summary.startswith(
        "No design exists. If a rocker swings by 110°, the minimum transmission angle is below 35°"
    )


def test_a_summary_with_more_designs_than_listed_says_so() -> None:
    for most in (3, 50):
        statement = {"kind": "quick_return", "swing": 110.0, "time_ratio": 1.0, "max_designs": most}
        result = solve(parse_problem(statement))
        count, listed = result.search.accepted, len(result.designs)
        assert result.summary.startswith(f"{count} designs have a measured time ratio of 1.")
        assert (f"{listed} of {count} designs that passed are listed." in result.summary) == (listed < count)
