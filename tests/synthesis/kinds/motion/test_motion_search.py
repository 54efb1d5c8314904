"""Searches over free choices: what comes back is usable, distinct, and true by a route of the tests' own."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from synthesis.dispatch import solve
from synthesis.registry import list_examples, parse_problem
from synthesis.results.buildability import is_buildable
from tests.campaign import sampled
from tests.cases import search_tasks
from tests.support.synthesis.motion_search import ORDINARY, confirm, run
from tests.support.synthesis.planted import plant


@pytest.mark.campaign
@pytest.mark.parametrize("task", search_tasks(), ids=lambda task: task["id"])
def test_positions_alone_give_five_distinct_usable_linkages(task: dict[str, Any]) -> None:
    result = run(positions=task["positions"])
    assert len(result.designs) >= 5
    confirm(result, task["positions"], 30.0)
    points = np.array([[p["x"], p["y"]] for p in task["positions"]])
    size = max(np.hypot(*(p - q)) for p in points for q in points)
    joints = [np.array([d.mechanism.skeleton.joints[name] for name in ("O2", "A", "B", "O4")]) for d in result.designs]
    for k, one in enumerate(joints):
        for other in joints[:k]:
            assert np.hypot(*(one - other).T).max() > 0.05 * size
    assert [d.metrics.quality for d in result.designs] == sorted(
        (d.metrics.quality for d in result.designs), reverse=True
    )


@pytest.mark.parametrize(
    ("constraints", "holds"),
    [
        ({"min_transmission_angle": 60.0}, lambda d: d.metrics.min_transmission_angle >= 60.0),
        ({"grashof": "crank_rocker"}, lambda d: d.metrics.barker == "GCRR"),
        ({"grashof": "double_crank"}, lambda d: d.metrics.barker == "GCCC"),
        ({"grashof": "double_rocker"}, lambda d: d.metrics.barker == "GRCR"),
        ({"grashof": "non_grashof"}, lambda d: d.metrics.barker.startswith("RRR")),
        ({"full_rotation": True}, lambda d: d.metrics.barker in ("GCRR", "GCCC")),
        ({"max_link_ratio": 2.0}, lambda d: d.metrics.link_ratio <= 2.0),
        (
            {"link_length": {"min": 20.0, "max": 70.0}},
            lambda d: (
                min(d.mechanism.links.model_dump().values()) >= 20.0
                and max(d.mechanism.links.model_dump().values()) <= 70.0
            ),
        ),
        (
            {"fixed_pivot_region": {"x": [0.0, 90.0], "y": [-90.0, -40.0]}},
            lambda d: all(
                0.0 <= x <= 90.0 and -90.0 <= y <= -40.0
                for x, y in (d.mechanism.fixed_pivots.input, d.mechanism.fixed_pivots.output)
            ),
        ),
        (
            {"moving_pivot_region": {"x": [-25.0, 25.0], "y": [-40.0, 0.0]}},
            lambda d: all(
                -25.0 <= x <= 25.0 and -40.0 <= y <= 0.0
                for x, y in (d.mechanism.skeleton.joints[name] for name in "AB")
            ),
        ),
    ],
    ids=lambda value: "-".join(value) if isinstance(value, dict) else "",
)
def test_constraints_hold(constraints: dict[str, Any], holds: Any) -> None:
    result = run(positions=ORDINARY, constraints=constraints)
    assert len(result.designs) == 10
    assert all(holds(design) for design in result.designs)
    confirm(result, ORDINARY, constraints.get("min_transmission_angle", 30.0))


@pytest.mark.parametrize("rank_by", ["quality", "size", "transmission_angle"])
def test_ranking_as_asked(rank_by: str) -> None:
    """The order is as asked, and asking for more does not change the first: the search itself goes by it."""

    def values(count: int) -> list[float]:
        designs = run(positions=ORDINARY, rank_by=rank_by, max_designs=count).designs
        # The smallest linkages are too small for links of any width; they are last.
        assert [*map(is_buildable, designs)] == sorted(map(is_buildable, designs), reverse=True)
        metrics = [design.metrics for design in designs if is_buildable(design)]
        keys = {"quality": [-m.quality for m in metrics], "size": [m.size for m in metrics]}
        return keys.get(rank_by, [-m.min_transmission_angle for m in metrics])

    few, many = values(3), values(40)
    assert few == sorted(few)
    assert many == sorted(many)
    assert few[0] == many[0]


def test_two_positions_alone() -> None:
    result = run(positions=ORDINARY[:2])
    assert len(result.designs) == 10
    confirm(result, ORDINARY[:2], 30.0)


@pytest.mark.campaign
def test_one_side_given_the_other_searched() -> None:
    rng = np.random.default_rng(7)
    for _ in range(10):
        planted = plant(rng, 3, 10.0)
        result = run(positions=planted.positions, input_side=planted.input_side.choices("fixed"))
        assert result.designs
        confirm(result, planted.positions, 0.0)
        for design in result.designs:
            assert complex(*design.mechanism.fixed_pivots.input) == pytest.approx(
                planted.input_side.fixed_pivot, abs=1e-9
            )


def test_the_same_seed_gives_the_same_answer_and_another_seed_another() -> None:
    one, again, other = run(positions=ORDINARY), run(positions=ORDINARY), run(positions=ORDINARY, seed=1)
    assert one == again
    assert one.designs != other.designs
    assert other.search.seed == 1


def test_counts_add_up() -> None:
    search = run(positions=ORDINARY).search
    assert search.candidates == search.accepted + sum(search.rejected.values())
    assert search.candidates >= 1_000_000
    assert not search.complete


@pytest.mark.parametrize("scale", [1e-8, 1e-3, 1e3, 1e7])
def test_scaled_task_gives_the_scaled_answer(scale: float) -> None:
    scaled = [{"x": p["x"] * scale, "y": p["y"] * scale, "angle": p["angle"]} for p in ORDINARY]
    one, other = run(positions=ORDINARY, max_designs=3), run(positions=scaled, max_designs=3)
    for a, b in zip(one.designs, other.designs, strict=True):
        assert b.metrics.min_transmission_angle == pytest.approx(a.metrics.min_transmission_angle, abs=1e-6)
        for name, length in a.mechanism.links.model_dump().items():
            assert b.mechanism.links.model_dump()[name] == pytest.approx(length * scale, rel=1e-9)


def test_a_limit_no_linkage_meets_is_an_honest_none() -> None:
    result = run(positions=ORDINARY, constraints={"min_transmission_angle": 89.9})
    assert result.designs == []
    assert not result.search.complete
    assert "a solution may still exist" in result.summary


def test_poor_but_sound_linkages_are_offered_when_nothing_better_exists() -> None:
    """The body turns half a turn each time: transmission angles stay small, and the summary says so."""
    hard = [
        {"x": 0.0, "y": 0.0, "angle": 0.0},
        {"x": 10.0, "y": 0.0, "angle": 179.999},
        {"x": 20.0, "y": 5.0, "angle": 359.9},
    ]
    result = run(positions=hard)
    assert result.designs
    assert max(d.metrics.min_transmission_angle for d in result.designs) < 30.0
    assert "No design found reaches 30°" in result.summary
    confirm(result, hard, 0.0)


class TestNoDesign:
    def test_translation_along_a_line(self) -> None:
        positions = [{"x": k, "y": 2.0 * k, "angle": 30.0} for k in (0.0, 1.0, 3.0)]
        for side in ({}, {"moving_pivot": [5.0, 1.0]}):
            result = run(positions=positions, input_side=side)
            assert result.designs == []
            assert result.search.complete
            assert "slider" in result.summary

    def test_rotation_about_one_point(self) -> None:
        turned = [np.exp(1j * math.radians(a)) * (3.0 + 1.0j) for a in (0.0, 20.0, 50.0)]
        positions = [{"x": z.real, "y": z.imag, "angle": a} for z, a in zip(turned, (0.0, 20.0, 50.0), strict=True)]
        result = run(positions=positions)
        assert result.designs == []
        assert result.search.complete
        assert "rotations about one point" in result.summary

    @pytest.mark.slow
    def test_moving_pivot_with_collinear_images(self) -> None:
        """P goes along a line while the body turns: no pin joint can stand at P, elsewhere it can, and a slider can."""
        positions = [{"x": x, "y": 0.0, "angle": a} for x, a in ((0.0, 0.0), (1.0, 20.0), (3.0, 50.0))]
        result = run(positions=positions, input_side={"moving_pivot": [0.0, 0.0], "dyad": "RR"})
        assert result.designs == []
        assert result.search.complete
        assert "slider" in result.summary
        assert run(positions=positions).designs
        sliding = run(positions=positions, output_side={"moving_pivot": [0.0, 0.0]}).designs[0].mechanism
        assert sliding.type == "slider_crank"
        assert sliding.slide.angle % 180.0 == pytest.approx(0.0, abs=1e-9)
        assert sliding.skeleton.joints["B"] == pytest.approx((0.0, 0.0), abs=1e-12)


class TestPoles:
    """A pivot at a displacement pole leaves a whole family of dyads, where a general pivot leaves one."""

    def test_fixed_pivot_at_the_pole_of_two_positions(self) -> None:
        positions = [{"x": 1.0, "y": 0.0, "angle": 0.0}, {"x": 0.0, "y": 1.0, "angle": 90.0}]
        result = run(positions=positions, input_side={"fixed_pivot": [0.0, 0.0]})
        assert len(result.designs) == 10
        confirm(result, positions, 30.0)

    @pytest.mark.parametrize("pair", [(0, 1), (0, 2), (1, 2)])
    @pytest.mark.parametrize("choice", ["fixed_pivot", "moving_pivot"])
    def test_pivot_at_a_pole_of_three_positions(self, pair: tuple[int, int], choice: str) -> None:
        z = [complex(p["x"], p["y"]) for p in ORDINARY]
        u = [np.exp(1j * math.radians(p["angle"])) for p in ORDINARY]
        j, k = pair
        turn = u[k] / u[j]
        pole = (z[k] - turn * z[j]) / (1.0 - turn)
        if choice == "moving_pivot":  # where that point of the body is in the first position
            pole = z[0] + (pole - z[j]) * u[0] / u[j]
        # A moving pivot that returns to its place cannot be driven from there to the next target; it can be the output.
        side = "input_side" if choice == "fixed_pivot" else "output_side"
        result = run(positions=ORDINARY, **{side: {choice: [pole.real, pole.imag]}})
        assert not result.search.complete
        assert result.designs
        confirm(result, ORDINARY, 0.0)

    def test_fixed_pivot_below_a_displacement_along_one_axis(self) -> None:
        for end in ({"x": 10.0, "y": 0.0, "angle": 0.0}, {"x": 0.0, "y": 10.0, "angle": 0.0}):
            positions = [{"x": 0.0, "y": 0.0, "angle": 0.0}, end]
            assert len(run(positions=positions, input_side={"fixed_pivot": [-3.0, -4.0]}).designs) == 10


@pytest.mark.slow
def test_no_empty_answer_is_complete_where_a_linkage_exists() -> None:
    """Planted linkages stated by their own numbers, edges of regions and limits at their own values included."""
    rng = np.random.default_rng(12)
    ways = [("fixed",), ("moving",), ("b2", "b3"), ("theta", "phi"), ("z", "phi")]
    for trial in range(60):
        planted = plant(rng, 3, 10.0 ** rng.uniform(-3.0, 3.0), complex(*rng.uniform(-9.0, 9.0, 2)))
        one, other = planted.input_side, planted.output_side
        pivots = [one.fixed_pivot, other.fixed_pivot]
        edges = [sorted(z.real for z in pivots), sorted(z.imag for z in pivots)]
        result = run(
            positions=planted.positions,
            input_side=one.choices(*ways[trial % 5]),
            output_side=other.choices(*ways[trial % 3]),
            constraints={"fixed_pivot_region": {"x": edges[0], "y": edges[1]}},
        )
        assert result.designs or not result.search.complete, result.summary


def test_failed_designs_are_shown_on_demand() -> None:
    result = run(positions=ORDINARY, constraints={"min_transmission_angle": 89.9}, include_failed=True)
    assert len(result.designs) == 10
    assert result.search.accepted == 0
    for design in result.designs:
        assert {c.name for c in design.verification.checks if not c.passed} == {"transmission_angle"}


def test_motions_past_a_toggle_on_demand() -> None:
    """Without the demand for one branch, and no limit on the transmission angle, such linkages are counted as sound."""
    free = {"same_branch": False, "in_order": False, "min_transmission_angle": 0.0}
    strict = {"min_transmission_angle": 0.0}
    one, other = run(positions=ORDINARY, constraints=free), run(positions=ORDINARY, constraints=strict)
    assert one.search.rejected["outranked"] > other.search.rejected["outranked"]
    for result in (one, other):
        assert result.search.candidates == result.search.accepted + sum(result.search.rejected.values())


@pytest.mark.campaign
@pytest.mark.parametrize(
    "seed", [0, *(pytest.param(seed, marks=pytest.mark.campaign) for seed in range(1, 1 + sampled(3)))]
)
def test_random_tasks_by_independent_continuation(seed: int) -> None:
    """Some hundred random tasks, none of whose designs shows a defect when it is followed step by step."""
    rng = np.random.default_rng(seed)
    followed = 0
    for _ in range(25):
        n = int(rng.integers(2, 4))
        positions = [
            {"x": x, "y": y, "angle": a}
            for x, y, a in zip(*rng.uniform(-50.0, 50.0, (2, n)), rng.uniform(-90.0, 90.0, n), strict=True)
        ]
        result = run(positions=positions, max_designs=20, constraints={"min_transmission_angle": 5.0})
        confirm(result, positions, 5.0)
        followed += len(result.designs)
    assert followed > 300


def test_the_designs_of_a_wide_search_are_not_neighbours_of_the_best() -> None:
    """Each has some pivot half a task size from where every other has it, and none is poor."""
    result = solve(parse_problem(list_examples("motion")[0]))
    assert len(result.designs) == 5
    quality = [design.metrics.quality for design in result.designs]
    assert min(quality) >= 0.5 * max(quality)
    joints = np.array(
        [
            [complex(*design.mechanism.skeleton.joints[name]) for name in ("O2", "A", "B", "O4")]
            for design in result.designs
        ]
    )
    places = [complex(position["x"], position["y"]) for position in list_examples("motion")[0]["positions"]]
    size = max(abs(a - b) for a in places for b in places)
    apart = [np.abs(joints[i] - joints[j]).max() for i in range(5) for j in range(i)]
    assert min(apart) > 0.5 * size


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["motion", "function", "quick_return", "dwell", "parallel_motion", "steering"])
def test_answers_of_linkages_tell_what_trades_against_what(kind: str) -> None:
    result = solve(parse_problem(list_examples(kind)[0]))
    assert len(result.designs) > 1
    best = max(range(len(result.designs)), key=lambda n: result.designs[n].metrics.min_transmission_angle)
    assert set(result.front.quantities) >= {"min_transmission_angle", "size"}
    smallest = min(result.designs[n].metrics.size for n in result.front.designs)
    assert smallest == min(design.metrics.size for design in result.designs)
    highest = max(result.designs[n].metrics.min_transmission_angle for n in result.front.designs)
    assert highest == result.designs[best].metrics.min_transmission_angle
