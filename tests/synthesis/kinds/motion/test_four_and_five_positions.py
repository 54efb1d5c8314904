"""Four and five positions as a client states them: planted linkages, mixtures of choices, what is said of the rest."""

from __future__ import annotations

import cmath
import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from synthesis.model.linkage.answer import LinkageDesign
from synthesis.registry import KINDS, parse_problem
from tests.campaign import sampled
from tests.cases import search_tasks
from tests.support.synthesis.motion_search import confirm, run
from tests.support.synthesis.planted import Planted, PlantedDyad, plant

FOUR = [
    {"x": 0.0, "y": 0.0, "angle": 0.0},
    {"x": 30.0, "y": 18.0, "angle": -20.0},
    {"x": 55.0, "y": 22.0, "angle": -42.0},
    {"x": 75.0, "y": 15.0, "angle": -60.0},
]


def joints(design: LinkageDesign) -> np.ndarray:
    return np.array([complex(*design.mechanism.skeleton.joints[name]) for name in ("O2", "A", "B", "O4")])


def planted_joints(planted: Planted) -> np.ndarray:
    one, other = planted.input_side, planted.output_side
    return np.array([one.fixed_pivot, one.moving_pivot, other.moving_pivot, other.fixed_pivot])


def is_among(planted: Planted, designs: list[LinkageDesign], tolerance: float = 1e-5) -> bool:
    """Whether the planted linkage, driven at its own input, is one of the designs."""
    wanted = planted_joints(planted)
    size = float(np.abs(wanted - wanted.mean()).max())
    return any(np.abs(joints(design) - wanted).max() <= tolerance * size for design in designs)


@pytest.mark.parametrize("task", search_tasks(5), ids=lambda task: task["id"])
def test_five_positions_give_the_planted_linkage(task: dict[str, Any]) -> None:
    """The tasks are rounded to 1e-6, which moves the answer by up to some 1e-3 where it is ill-conditioned."""
    result = run(positions=task["positions"])
    assert result.search.complete
    assert result.search.candidates in (1, 6)
    assert result.search.candidates == result.search.accepted + sum(result.search.rejected.values())
    confirm(result, task["positions"], 0.0)
    wanted = task["planted"]
    pivots = complex(*wanted["fixed_input"]), complex(*wanted["fixed_output"])
    gaps = [
        max(
            abs(complex(*design.mechanism.fixed_pivots.input) - pivots[0]),
            abs(complex(*design.mechanism.fixed_pivots.output) - pivots[1]),
            *(abs(getattr(design.mechanism.links, name) - wanted[name]) for name in ("input", "coupler", "output")),
        )
        for design in result.designs
    ]
    assert min(gaps) < 0.02 * wanted["ground"]


@pytest.mark.parametrize("task", search_tasks(4)[:5], ids=lambda task: task["id"])
def test_four_positions_alone_give_five_distinct_usable_linkages(task: dict[str, Any]) -> None:
    result = run(positions=task["positions"])
    assert len(result.designs) >= 5
    confirm(result, task["positions"], 30.0)
    assert result.curves


@pytest.mark.campaign
@pytest.mark.parametrize("task", search_tasks(4)[5:], ids=lambda task: task["id"])
def test_more_tasks_of_four_positions(task: dict[str, Any]) -> None:
    result = run(positions=task["positions"])
    assert len(result.designs) >= 5
    confirm(result, task["positions"], 30.0)


def coordinate(side: PlantedDyad, pivot: str, axis: int) -> dict[str, Any]:
    """The statement of one coordinate of a planted pivot."""
    z = getattr(side, pivot)
    return {pivot: [z.real, None] if axis == 0 else [None, z.imag]}


def choices_of_four(side: PlantedDyad, way: int) -> dict[str, Any]:
    """One number of the side, each time another."""
    ways = [
        side.choices("b2"),
        side.choices("b3"),
        {"rotations": [None, None, side.rotations[2]]},
        side.choices("theta"),
        side.choices("phi"),
        side.choices("z"),
        coordinate(side, "fixed_pivot", 0),
        coordinate(side, "fixed_pivot", 1),
        coordinate(side, "moving_pivot", 0),
        coordinate(side, "moving_pivot", 1),
        side.choices("fixed"),
        side.choices("moving"),
    ]
    return ways[way % len(ways)]


WAYS_OF_FOUR = 12


def planted_problem(planted: Planted, n: int, trial: int) -> dict[str, Any]:
    """A statement that determines the planted linkage, every time by other choices."""
    one, other = planted.input_side, planted.output_side
    ways = {
        2: [("fixed", "b2"), ("moving", "theta"), ("z", "phi", "b2"), ("theta", "phi", "b2"), ("theta", "z", "b2")],
        3: [("fixed",), ("moving",), ("b2", "b3"), ("theta", "phi"), ("z", "phi"), ("b2", "z"), ("theta", "z")],
    }
    statement: dict[str, Any] = {"positions": planted.positions, "max_designs": 200, "include_failed": False}
    if n in ways:
        statement["input_side"] = one.choices(*ways[n][trial % len(ways[n])])
        statement["output_side"] = other.choices(*ways[n][(trial // 2) % len(ways[n])])
    elif n == 4 and trial % 10 == 9:
        line = other.fixed_pivot - one.fixed_pivot
        statement["ground_line"] = {
            "point": [one.fixed_pivot.real, one.fixed_pivot.imag],
            "angle": math.degrees(cmath.phase(line)),
        }
    elif n == 4:
        statement["input_side"] = choices_of_four(one, trial)
        statement["output_side"] = choices_of_four(other, trial // WAYS_OF_FOUR + trial)
    return statement


def find_planted(n: int, seed: int, count: int) -> None:
    """Planted linkages of n positions: stated by their choices they are among the answers, every time."""
    rng = np.random.default_rng([n, seed])
    for trial in range(count):
        planted = plant(rng, n, 10.0 ** rng.uniform(-2.0, 3.0), complex(*rng.uniform(-20.0, 20.0, 2)))
        result = run(**planted_problem(planted, n, trial))
        assert is_among(planted, result.designs), (n, trial, result.summary)


@pytest.mark.parametrize("n", [2, 3, 4, 5])
def test_planted_linkages_are_found_every_time(n: int) -> None:
    find_planted(n, 0, 16)


@pytest.mark.campaign
@pytest.mark.timeout(600)
@pytest.mark.parametrize("seed", range(1, 5))
@pytest.mark.parametrize("n", [2, 3, 4, 5])
def test_a_thousand_planted_linkages_are_found_every_time(n: int, seed: int) -> None:
    find_planted(n, seed, sampled(250))


def no_defect(n: int, seed: int, count: int) -> None:
    """Designs of random tasks of n positions, as many as asked for, each followed step by step."""
    rng = np.random.default_rng([n, seed])
    followed = 0
    while followed < count:
        if n < 4:
            points, angles = rng.uniform(-50.0, 50.0, (n, 2)), rng.uniform(-90.0, 90.0, n)
            positions = [{"x": x, "y": y, "angle": a} for (x, y), a in zip(points, angles, strict=True)]
        else:  # most random tasks of four positions, and nearly all of five, have no linkage at all
            positions = plant(rng, n, 10.0).positions
        result = run(positions=positions, max_designs=50, constraints={"min_transmission_angle": 1.0})
        confirm(result, positions, 1.0)
        followed += len(result.designs)


@pytest.mark.parametrize("n", [4, 5])
def test_no_design_has_a_defect(n: int) -> None:
    no_defect(n, 0, 30)


@pytest.mark.campaign
@pytest.mark.timeout(600)
@pytest.mark.parametrize(
    ("n", "seed"), [(2, 1), (2, 2), (2, 3), (3, 1), (3, 2), (3, 3), (4, 1), (4, 2), (4, 3), (5, 1)]
)
def test_none_of_ten_thousand_designs_has_a_defect(n: int, seed: int) -> None:
    no_defect(n, seed, sampled(1000))


def test_a_stated_coordinate_is_kept_and_the_rest_is_searched() -> None:
    for n in (3, 4):
        positions = FOUR[:n]
        result = run(positions=positions, input_side={"fixed_pivot": [40.0, None]})
        assert result.designs
        confirm(result, positions, 0.0)
        for design in result.designs:
            assert design.mechanism.fixed_pivots.input[0] == pytest.approx(40.0, abs=1e-6)


@pytest.mark.parametrize("n", [2, 3, 4])
def test_both_fixed_pivots_on_the_ground_line(n: int) -> None:
    line = {"point": [0.0, -30.0], "angle": 10.0}
    result = run(positions=FOUR[:n], ground_line=line, constraints={"min_transmission_angle": 0.0})
    assert result.search.complete == (n == 4)
    assert result.designs or n == 4
    confirm(result, FOUR[:n], 0.0)
    for design in result.designs:
        for x, y in (design.mechanism.fixed_pivots.input, design.mechanism.fixed_pivots.output):
            assert y == pytest.approx(-30.0 + math.tan(math.radians(10.0)) * x, abs=1e-6)


def test_a_coordinate_and_the_ground_line_make_a_pivot() -> None:
    line = {"point": [0.0, -30.0], "angle": 0.0}
    sides = {"input_side": {"fixed_pivot": [10.0, None]}, "output_side": {"fixed_pivot": [70.0, None]}}
    one = run(positions=FOUR[:3], ground_line=line, **sides, include_failed=True)
    sides = {"input_side": {"fixed_pivot": [10.0, -30.0]}, "output_side": {"fixed_pivot": [70.0, -30.0]}}
    other = run(positions=FOUR[:3], **sides, include_failed=True)
    assert joints(one.designs[0]) == pytest.approx(joints(other.designs[0]), abs=1e-9)


def test_regions_hold_on_curves() -> None:
    """A region around a pivot of the best linkage is where the search then looks."""
    best = run(positions=FOUR).designs[0]
    x, y = best.mechanism.fixed_pivots.input
    u, v = best.mechanism.fixed_pivots.output
    region = {"x": [min(x, u) - 5.0, max(x, u) + 5.0], "y": [min(y, v) - 5.0, max(y, v) + 5.0]}
    result = run(positions=FOUR, constraints={"fixed_pivot_region": region})
    assert result.designs
    for design in result.designs:
        assert "fixed_pivot_region" in {check.name for check in design.verification.checks if check.passed}


def test_a_pivot_off_the_curve_is_answered_with_the_nearest_on_it() -> None:
    result = run(positions=FOUR, input_side={"fixed_pivot": [10.0, -200.0]})
    assert result.designs == []
    assert result.search.complete
    assert "The nearest pivot that does is at about" in result.summary


def test_curves_are_what_the_designs_stand_on() -> None:
    result = run(positions=FOUR)
    curve = np.array([complex(*z) for branch in result.curves for z in branch.centre_points])
    for design in result.designs:
        for pivot in (design.mechanism.fixed_pivots.input, design.mechanism.fixed_pivots.output):
            assert np.abs(curve - complex(*pivot)).min() < 10.0
    assert run(positions=FOUR[:3]).curves == []


class TestDegenerate:
    """Positions in special places are answered, and said."""

    def test_translation_along_a_circle(self) -> None:
        """Every parallelogram linkage with links of the circle's radius: a family."""
        positions = [
            {"x": 40.0 * math.cos(t), "y": 40.0 * math.sin(t), "angle": 7.0} for t in (0.3, 0.8, 1.2, 1.9, 2.4)
        ]
        for n in (4, 5):
            result = run(positions=positions[:n])
            assert not result.search.complete
            assert "meets all" in result.summary
            for design in result.designs:
                assert design.mechanism.links.input == pytest.approx(40.0, rel=1e-6)

    def test_translation_off_any_circle(self) -> None:
        xs = [(0.0, 0.0), (1.0, 0.2), (2.0, -0.5), (3.5, 1.0), (4.0, 3.0)]
        positions = [{"x": x, "y": y, "angle": 0.0} for x, y in xs]
        for n in (4, 5):
            result = run(positions=positions[:n])
            assert result.designs == []
            assert result.search.complete
            assert "No pin-jointed fourbar" in result.summary

    def test_rotation_about_a_point(self) -> None:
        positions = [
            {"x": 3.0 * math.cos(t), "y": 3.0 * math.sin(t), "angle": math.degrees(t)}
            for t in (0.0, 0.3, 0.9, 1.5, 2.0)
        ]
        for n in (4, 5):
            result = run(positions=positions[:n])
            assert result.designs == []
            assert result.search.complete
            assert "rotations about one point" in result.summary

    def test_points_on_a_circle_that_the_body_turns_with(self) -> None:
        """P on a circle, the body turning at another rate: P itself is a circle point."""
        positions = [
            {"x": 50.0 * math.cos(t), "y": 50.0 * math.sin(t), "angle": 40.0 * math.sin(2.0 * t)}
            for t in (0.2, 0.5, 0.9, 1.2, 1.6)
        ]
        result = run(positions=positions, include_failed=True)
        assert result.search.candidates in (1, 6)
        pins = [joints(design)[[0, 1]] for design in result.designs]
        assert min(abs(o) + abs(a - complex(positions[0]["x"], positions[0]["y"])) for o, a in pins) < 1e-6

    def test_collinear_points(self) -> None:
        positions = [{"x": 10.0 * k, "y": 0.0, "angle": 8.0 * k * k} for k in range(5)]
        for n in (4, 5):
            result = run(positions=positions[:n])
            confirm(result, positions[:n], 0.0)
        assert "slider (PR)" in result.summary

    def test_two_directions_only(self) -> None:
        positions = [{**p, "angle": 0.0 if k < 2 else -35.0} for k, p in enumerate(FOUR)]
        result = run(positions=positions, constraints={"min_transmission_angle": 5.0})
        confirm(result, positions, 5.0)
        assert result.curves

    def test_mirrored_positions(self) -> None:
        half = [(-60.0, -10.0, 50.0), (-35.0, 4.0, 27.0)]
        triples = [*half, (0.0, 12.0, 0.0), *((-x, y, -a) for x, y, a in reversed(half))]
        positions = [{"x": x, "y": y, "angle": a} for x, y, a in triples]
        result = run(positions=positions, include_failed=True)
        confirm_passed = [design for design in result.designs if design.verification.passed]
        assert len(confirm_passed) == len(result.designs) or result.search.rejected


POSES = st.tuples(st.floats(-1.0, 1.0), st.floats(-1.0, 1.0), st.floats(-90.0, 90.0))


@pytest.mark.slow
@settings(derandomize=True, max_examples=8, deadline=None)
@given(
    seed=st.integers(0, 10_000),
    turn=st.floats(-180.0, 180.0),
    scale=st.floats(1e-2, 1e3),
    shift=st.tuples(st.floats(-50.0, 50.0), st.floats(-50.0, 50.0)),
)
def test_five_positions_moved_turned_and_scaled(
    seed: int, turn: float, scale: float, shift: tuple[float, float]
) -> None:
    """All linkages move, turn and scale with the positions."""
    planted = plant(np.random.default_rng(seed), 5)

    def moved(z: complex) -> complex:
        return complex(*shift) + scale * cmath.exp(1j * math.radians(turn)) * z

    positions = []
    for p in planted.positions:
        z = moved(complex(p["x"], p["y"]))
        positions.append({"x": z.real, "y": z.imag, "angle": p["angle"] + turn})
    one, other = run(positions=planted.positions, max_designs=12), run(positions=positions, max_designs=12)
    assert one.search.accepted == other.search.accepted
    assert one.search.rejected == other.search.rejected
    assert is_among(planted, one.designs)
    for design in one.designs:
        wanted = np.array([moved(complex(z)) for z in joints(design)])
        size = float(np.abs(wanted - wanted.mean()).max())
        assert min(np.abs(joints(found) - wanted).max() for found in other.designs) < 1e-4 * size


def test_examples_of_partly_stated_sides_are_consistent() -> None:
    for statement in (
        {"input_side": {"fixed_pivot": [40.0, None]}},
        {"output_side": {"moving_pivot": [None, -12.5]}},
        {"ground_line": {"point": [0.0, -30.0], "angle": 0.0}},
        {"input_side": {"fixed_pivot": [10.0, -200.0]}},
        {"input_side": {"rotations": [None, 20.0, None]}},
    ):
        assert parse_problem({"kind": "motion", "positions": FOUR, **statement}).find_contradictions() == []


@pytest.mark.parametrize("number", [1, 2, 3])
def test_examples_of_the_options_have_answers(number: int) -> None:
    schema_extra: Any = KINDS["motion"].problem.model_config["json_schema_extra"]
    example = dict(schema_extra["examples"][number])
    assert example.pop("kind") == "motion"
    assert len(run(**example).designs) == 3


def drifting(n: int, share: float, offset: complex = 0j) -> list[dict[str, float]]:
    """Positions of a body that hardly turns: dyads with two pins exist, the farther away the less it turns."""
    poses = [(-40.0, -30.0, -60.0), (-15.0, 4.0, -25.0), (5.0, 12.0, 7.0), (33.0, 9.0, 41.0), (60.0, -5.0, 80.0)]
    return [{"x": x + offset.real, "y": y + offset.imag, "angle": share * a} for x, y, a in poses[:n]]


@pytest.mark.parametrize("share", [1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-10, 1e-12])
def test_a_body_that_hardly_turns_is_not_proved_to_have_no_linkage(share: float) -> None:
    """Two real dyads exist, about a task size over the turn away: nothing that has them may be said to be all."""
    for sides in ({}, {"input_side": {"dyad": "RR"}, "output_side": {"dyad": "RR"}}):
        result = run(positions=drifting(5, share), **sides)
        assert result.designs == []
        assert not result.search.complete
        assert "These are all" not in result.summary
        assert "does not prove" in result.summary or result.search.candidates == 0


@pytest.mark.parametrize("share", [1e-3, 1e-5, 1e-7])
def test_an_arc_is_not_taken_for_a_rotation_about_one_point(share: float) -> None:
    """A planted fourbar that moves by a small share of its size: a linkage exists, and is not ruled out."""
    planted = plant(np.random.default_rng(3), 5)
    one, other = planted.input_side, planted.output_side
    a, b = one.moving_pivot - one.fixed_pivot, other.moving_pivot - other.fixed_pivot
    ground, p = other.fixed_pivot - one.fixed_pivot, one.coupler_vector
    poses = []
    for turn in share * np.array([0.0, 0.2, 0.45, 0.7, 1.0]):
        pin = a * cmath.exp(1j * turn)
        coupler, output = abs(one.moving_pivot - other.moving_pivot), abs(b)
        base = ground - pin
        along = (abs(base) ** 2 + coupler**2 - output**2) / (2.0 * abs(base))
        up = math.sqrt(coupler**2 - along**2)
        side = ((other.moving_pivot - one.moving_pivot) * base.conjugate()).imag
        unit = base / abs(base) * complex(along, math.copysign(up, side))
        spin = unit / (other.moving_pivot - one.moving_pivot)
        z = pin + p * spin
        poses.append({"x": z.real, "y": z.imag, "angle": math.degrees(cmath.phase(spin))})
    result = run(positions=poses)
    assert result.designs or not result.search.complete


@pytest.mark.slow
@pytest.mark.parametrize("n", [3, 4, 5])
def test_a_stated_pivot_is_not_ruled_out_by_digits_that_are_lost(n: int) -> None:
    """The images of any point of a body that moves along an arc by little are nearly in line."""
    arc = [
        {"x": 1e5 * math.sin(t), "y": 2e5 * math.sin(0.5 * t) ** 2, "angle": 1e-4 * k}
        for k, t in enumerate(1e-10 * np.array([0.0, 1.0, 2.5, 3.5, 5.0]))
    ]
    result = run(positions=arc[:n], input_side={"moving_pivot": [0.0, 0.0]})
    assert result.designs or not result.search.complete
