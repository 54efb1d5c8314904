"""Springs against gravity: closed forms, other routes to the same numbers, bounds that nothing beats, proofs that fail.

The lever is Herder's basic gravity equilibrator, k a b = W c (*Energy-free Systems*, 2001, ch. 2).
"""

from __future__ import annotations

import cmath
import copy
import math
from typing import Any

import numpy as np
import pytest
from scipy.optimize import linprog

from kinematics.dynamics.reactions import compute_reactions
from synthesis.analyses.linkages.requested_motion import place_machine
from synthesis.dispatch import solve
from synthesis.kinds.spring_balancing import branching, program
from synthesis.kinds.spring_balancing.branching import branch_and_bound
from synthesis.kinds.spring_balancing.effects import Setting, compute_effects, find_hull
from synthesis.kinds.spring_balancing.program import NO_SOLUTION, BestParameters
from synthesis.kinds.spring_balancing.spring_parameters import Spring, compute_spring_drive, evaluate_springs
from synthesis.kinds.spring_balancing.verification import (
    build_answer,
    build_answer_machine,
    measure_outside,
)
from synthesis.numerics.conic import solve_conic_program
from synthesis.registry import list_examples
from tests.support.synthesis.balanced_linkages import pair
from tests.support.synthesis.sprung_linkages import GRAVITY, both_open, fourbar, lever, missed, problem_of, slider_crank

Statement = dict[str, Any]

LEVER, REAL, BOTH, SOUGHT = list_examples("spring_balancing")


def best(statement: Statement) -> Any:
    result = solve(problem_of(statement))
    assert result.designs, result.summary
    assert result.designs[0].verification.passed
    return result.designs[0]


def with_spring(statement: Statement, **more: Any) -> Statement:
    """The statement with its first spring alone, and that changed."""
    return {**statement, "springs": [{**statement["springs"][0], **more}]}


def test_a_lever_is_balanced_by_the_rate_of_the_closed_form() -> None:
    a, b = 0.25, 0.15
    ends = [{"link": "ground", "point": [0.0, 250.0]}, {"link": "lever", "point": [150.0, 0.0]}]
    design = best({**LEVER, "springs": [{"ends": ends}]})
    assert design.springs[0].rate == pytest.approx(5.0 * GRAVITY * 0.3 / (a * b), rel=1e-12)
    assert design.metrics.exact
    assert design.metrics.drive < 1e-12 * design.metrics.unbalanced_drive
    assert design.metrics.energy_variation < 1e-12
    assert design.metrics.unbalanced_drive == pytest.approx(5.0 * GRAVITY * 0.3, rel=1e-6)


@pytest.mark.parametrize("beyond", [1.0000001, 1.000001, 1.00001, 1.0001])
def test_a_balance_that_is_nearly_exact_is_an_answer(beyond: float) -> None:
    """The rate is given and off by a little: what is left is that share, and no share of it is the bound's distance."""
    ends = [{"link": "ground", "point": [0.0, 250.0]}, {"link": "lever", "point": [200.0, 0.0]}]
    rate = beyond * 5.0 * GRAVITY * 0.3 / (0.25 * 0.2)
    result = solve(problem_of({**LEVER, "springs": [{"ends": ends, "rate": rate}]}))
    assert result.designs, result.summary
    metrics = result.designs[0].metrics
    assert result.search.complete
    assert metrics.value == pytest.approx(beyond - 1.0, rel=1e-6)
    assert metrics.value - 3e-7 <= metrics.bound <= metrics.value


def test_where_the_solver_gives_no_bound_the_springs_are_answered_without_proof(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    proved = solve(problem_of(REAL))
    monkeypatch.setattr(
        program, "solve_conic_program", lambda *stated: solve_conic_program(*stated)._replace(dual=-np.inf)
    )
    result = solve(problem_of(REAL))
    assert result.designs, result.summary
    assert proved.search.complete
    assert not result.search.complete
    assert result.designs[0].metrics.bound == 0.0
    assert result.designs[0].metrics.value == pytest.approx(proved.designs[0].metrics.value, rel=1e-4)
    assert "The values in between are undecided" in result.summary


def test_of_exact_springs_the_softest_is_given() -> None:
    design = best(LEVER)
    assert design.springs[0].ends[1].point == pytest.approx((200.0, 0.0), abs=1e-6)
    assert design.springs[0].rate == pytest.approx(5.0 * GRAVITY * 0.3 / (0.25 * 0.2), rel=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("make", [lever, lambda rng: lever(rng, both=True), fourbar])
def test_planted_springs_are_found_exactly(make: Any) -> None:
    rng = np.random.default_rng(11)
    for _ in range(4):
        result = solve(problem_of(make(rng)))
        design = result.designs[0]
        assert result.search.complete
        assert design.verification.passed
        assert design.metrics.exact
        assert design.metrics.energy_variation < 1e-9


def random_springs(rng: np.random.Generator, setting: Setting) -> list[Spring]:
    """Springs of the set that a problem asks for."""
    scale, found = setting.task.machine.scale, []
    for n, spring in enumerate(setting.problem.springs):
        low, high = spring.rates
        rate = float(rng.uniform(low, 1e3 if high is None else high))
        if spring.links is not None:
            found.append(Spring(n, (), rate, float(rng.uniform(-2.0, 2.0)), 0.0))
            continue
        ends = tuple(complex(rng.dirichlet(np.ones(len(end))) @ end) for end in setting.list_corners(spring))
        shortest, longest = spring.free_lengths
        free = scale * float(rng.uniform(shortest, longest or 0.0))
        found.append(Spring(n, ends, rate, free, float(rng.uniform(*spring.preloads))))
    return found


@pytest.mark.parametrize("statement", [LEVER, REAL, BOTH, SOUGHT], ids=["lever", "real", "both", "sought"])
def test_what_springs_do_is_what_the_reactions_say(statement: Statement) -> None:
    setting = Setting(problem_of(statement))
    rng = np.random.default_rng(3)
    for _ in range(3):
        springs = [
            spring._replace(
                free=min(spring.free, float(setting.compute_lengths(setting.problem.springs[n], spring.ends).min()))
            )
            if spring.ends
            else spring
            for n, spring in enumerate(random_springs(rng, setting))
        ]
        machine = build_answer_machine(setting.problem, *build_answer(setting, springs))
        found = compute_reactions(machine, place_machine(machine, setting.at, 0.0)).drive
        mine = setting.fixed + sum(compute_spring_drive(setting, spring) for spring in springs)
        assert np.abs(found - mine).max() < 1e-12 * np.abs(mine).max()


def test_a_spring_within_an_area_is_springs_at_its_corners() -> None:
    setting = Setting(problem_of(BOTH))
    (spring,) = setting.problem.springs
    corners = setting.list_corners(spring)
    rng = np.random.default_rng(4)
    one, other = (rng.dirichlet(np.ones(len(end))) for end in corners)
    point = [np.array([one @ corners[0]]), np.array([other @ corners[1]])]
    alone = compute_effects(setting, spring, point).drive[0]
    together = np.outer(one, other).ravel() @ compute_effects(setting, spring, corners).drive
    assert np.abs(alone - together).max() < 1e-12 * np.abs(alone).max()


def test_the_program_is_the_linear_program_of_another_solver() -> None:
    """All positions of a grid, the limits written out again: rates, free lengths, forces, and tension everywhere."""
    statement = with_spring(REAL, max_force=60.0, max_preload=5.0)
    statement["springs"][0].pop("max_deflection")
    design, setting = best(statement), Setting(problem_of(statement))
    (spring,) = setting.problem.springs
    ends = [complex(end[0]) for end in setting.list_corners(spring)]
    length = setting.compute_lengths(spring, ends)
    along, shorter, _ = compute_effects(setting, spring, setting.list_corners(spring)).drive
    ones = np.ones(len(length))
    drive = np.stack([along, shorter, -shorter], axis=1)
    cost = [0.0, 0.0, 0.0, 1.0]
    rows = [np.column_stack([drive, -ones]), np.column_stack([-drive, -ones])]
    limits = [-setting.fixed, setting.fixed]
    for row, limit in (
        ([0.06, -1.0, 0.0, 0.0], 0.0),
        ([-min(0.12, float(length.min())), 1.0, 0.0, 0.0], 0.0),
        ([float(length.max()), -1.0, 1.0, 0.0], 60.0),
    ):
        rows.append(np.array([row]))
        limits.append(np.array([limit]))
    bounds = [(0.0, 5000.0), (0.0, None), (0.0, 5.0), (0.0, None)]
    found = linprog(cost, np.concatenate(rows), np.concatenate(limits), bounds=bounds)
    assert found.status == 0
    assert design.metrics.drive == pytest.approx(found.fun, rel=2e-5)
    assert design.metrics.bound <= found.fun / setting.peak


@pytest.mark.parametrize("norm", ["max", "rms"])
@pytest.mark.parametrize("make", [missed, both_open, slider_crank])
def test_no_springs_of_the_set_go_below_the_bound(make: Any, norm: str) -> None:
    rng = np.random.default_rng(7)
    problem = problem_of({**make(rng), "norm": norm})
    result, setting = solve(problem), Setting(problem)
    design = result.designs[0]
    assert result.search.complete
    assert design.verification.passed
    assert design.metrics.bound <= design.metrics.value
    assert design.metrics.gap <= 2e-3
    for _ in range(100):
        springs = random_springs(rng, setting)
        allowed = all(
            stated.form is None or spring.free <= setting.compute_lengths(stated, spring.ends).min()
            for stated, spring in zip(problem.springs, springs, strict=True)
        )
        if allowed:
            assert evaluate_springs(setting, springs) >= design.metrics.bound


def test_branching_proves_what_no_end_of_a_grid_betters() -> None:
    """The best rate for every pair of places of a grid, by the mean square in closed form."""
    problem = problem_of({**BOTH, "norm": "rms"})
    setting = Setting(problem)
    (spring,) = problem.springs
    corners = setting.list_corners(spring)
    found = branch_and_bound(setting, corners and [corners], lambda share: None)
    assert found.proved
    shares = [(i / 12.0, j / 12.0, 1.0 - (i + j) / 12.0) for i in range(13) for j in range(13 - i)]
    least = np.inf
    for first in shares:
        ends = [np.array([np.array(first) @ corners[0]]), corners[1]]
        low, high = compute_effects(setting, spring, ends).drive
        for part in np.linspace(0.0, 1.0, 13):
            effect = part * low + (1.0 - part) * high
            rate = float(np.clip(-(effect @ setting.fixed) / (effect @ effect), 0.0, 2000.0))
            least = min(least, float(np.sqrt(((setting.fixed + rate * effect) ** 2).mean())))
    least /= float(np.sqrt((setting.fixed**2).mean()))
    assert found.bound <= found.value <= least * (1.0 + 1e-6)
    assert least <= found.value * 1.05


def test_a_part_whose_program_failed_keeps_the_bound_of_what_it_is_a_part_of(monkeypatch: pytest.MonkeyPatch) -> None:
    """The whole promises half of what it could, and one of its halves fails: no more is known than that promise."""
    setting = Setting(problem_of(BOTH))
    places = [setting.list_corners(setting.problem.springs[0])]
    solved_at, promised = branching.solve_at, 0.5 * branching.solve_at(setting, places).bound
    parts = []

    def failing(setting: Setting, places: branching.Places, *, bounded: bool = True) -> BestParameters:
        found = solved_at(setting, places, bounded=bounded)
        if not bounded:
            parts.append(found)
            return NO_SOLUTION if len(parts) == 1 else found
        return found._replace(bound=promised)

    monkeypatch.setattr(branching, "solve_at", failing)
    found = branch_and_bound(setting, places, lambda share: None)
    assert len(parts) >= 2
    assert found.bound == promised < 0.9 * found.value
    assert not found.proved


def test_where_the_search_ends_before_anything_is_found_nothing_is_proved(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(branching, "MAX_NODES", 0)
    setting = Setting(problem_of(BOTH))
    assert (
        branch_and_bound(setting, [setting.list_corners(setting.problem.springs[0])], lambda share: None).status
        == "failed"
    )


@pytest.mark.slow
def test_a_search_is_no_worse_than_springs_that_are_known() -> None:
    """Real springs with both ends open: random ones of the set with their best rates, planted by nothing else."""
    problem = problem_of({**SOUGHT, "norm": "max"})
    design, setting = solve(problem).designs[0], Setting(problem)
    assert design.verification.passed
    assert design.metrics.bound is None
    (spring,) = problem.springs
    rng, least = np.random.default_rng(9), np.inf
    few = setting.thin_positions(100)
    for _ in range(400):
        ends = [np.array([complex(rng.dirichlet(np.ones(len(end))) @ end)]) for end in setting.list_corners(spring)]
        along, shorter, _ = compute_effects(few, spring, ends).drive
        length = setting.compute_lengths(spring, [complex(end[0]) for end in ends])
        free = float(rng.uniform(0.05, min(0.15, max(float(length.min()), 0.05))))
        if free > length.min():
            continue
        effect = along + free * shorter
        for rate in np.linspace(50.0, 800.0, 16):
            least = min(least, float(np.abs(few.fixed + rate * effect).max()) / setting.peak)
    assert design.metrics.value <= least


@pytest.mark.slow
def test_a_search_is_the_same_again_and_another_with_another_seed() -> None:
    one, other = (solve(problem_of({**SOUGHT, "max_designs": 1})).model_dump() for _ in range(2))
    assert one == other
    assert solve(problem_of({**SOUGHT, "max_designs": 1, "seed": 4})).model_dump()["designs"] != one["designs"][:1]


LIMITS: dict[str, Statement] = {
    "max_rate": {"max_rate": 60.0},
    "min_rate": {"min_rate": 700.0},
    "min_free_length": {"min_free_length": 100.0},
    "max_force": {"max_force": 8.0},
    "max_deflection": {"max_deflection": 158.0},
    "max_preload": {"max_free_length": 62.0, "max_rate": 120.0, "preload": 5.0, "max_preload": 6.0},
}


@pytest.mark.parametrize("limit", LIMITS)
def test_limits_are_kept_and_cost_something(limit: str) -> None:
    free, held = best(with_spring(REAL)), best(with_spring(REAL, **LIMITS[limit]))
    assert held.metrics.bound > free.metrics.value
    (spring,) = held.springs
    stated = {**REAL["springs"][0], **LIMITS[limit]}
    slack = 1.0 + 1e-6
    assert stated.get("min_rate", 0.0) / slack <= spring.rate <= stated["max_rate"] * slack
    assert (
        stated["min_free_length"] / slack
        <= spring.free_length
        <= min(stated["max_free_length"], spring.min_length) * slack
    )
    assert stated.get("preload", 0.0) <= spring.preload <= stated["max_preload"]
    assert spring.max_length - spring.free_length <= stated["max_deflection"] * slack
    assert spring.max_force <= stated.get("max_force", np.inf) * slack
    if limit != "max_preload":
        assert held.metrics.value <= 1.0


@pytest.mark.slow
def test_lengths_and_forces_are_kept_where_an_end_is_sought() -> None:
    whole = best(BOTH)
    free = whole.springs[0]
    short = best(with_spring(BOTH, max_length=0.9 * free.max_length))
    weak = best(with_spring(BOTH, max_force=0.8 * free.max_force))
    assert short.springs[0].max_length <= 0.9 * free.max_length * (1.0 + 1e-4)
    assert weak.springs[0].max_force <= 0.8 * free.max_force * (1.0 + 1e-4)
    # No longer convex: a length that must not be undercut.
    given = {"link": "input", "point": [80.0, 120.0]}
    long = best(with_spring(BOTH, ends=[BOTH["springs"][0]["ends"][0], given], min_length=1.1 * free.min_length))
    assert long.springs[0].min_length >= 1.1 * free.min_length * (1.0 - 1e-4)
    assert long.metrics.bound is None
    for design in (short, weak, long):
        assert design.metrics.value >= whole.metrics.bound


def test_a_compression_spring_pushes_and_is_warned_of_where_it_buckles() -> None:
    ends = [{"link": "ground", "point": [0.0, -150.0]}, {"link": "lever", "point": [150.0, 0.0]}]
    spring = {
        "ends": ends,
        "min_free_length": 50.0,
        "max_free_length": 500.0,
        "form": "compression",
        "min_length": 30.0,
    }
    stated = {**LEVER, "motion": {"from": -20.0, "to": 60.0}, "springs": [{**spring, "diameter": 20.0}]}
    design = best(stated)
    (found,) = design.springs
    assert found.free_length >= found.max_length * (1.0 - 1e-6)
    assert found.min_length >= 30.0
    assert design.metrics.value < 0.35
    assert design.dynamics["springs"][0]["one_sided"] == "push"
    assert ["buckles" in warning for warning in design.warnings] == [True]
    assert best(with_spring(stated, diameter=found.free_length)).warnings == []


def test_a_torsion_spring_keeps_its_torque() -> None:
    springs = [{"links": ["ground", "lever"], "max_torsion": 100.0}]
    free = best({**LEVER, "springs": springs})
    assert free.metrics.value < 0.4
    springs = [{**springs[0], "max_torque": 5.0, "max_free_angle": 500.0}]
    held = best({**LEVER, "springs": springs})
    assert held.springs[0].max_torque <= 5.0 * (1.0 + 1e-6)
    assert held.metrics.bound > free.metrics.value
    # The best straight line through W c cos θ is known by its mean square: compare with a fit.
    springs = [{"links": ["ground", "lever"]}]
    design, setting = best({**LEVER, "springs": springs, "norm": "rms"}), Setting(problem_of(LEVER))
    fitted = np.polyval(np.polyfit(setting.at, setting.fixed, 1), setting.at)
    assert design.metrics.rms_drive == pytest.approx(float(np.sqrt(((setting.fixed - fitted) ** 2).mean())), rel=1e-4)


def test_where_no_springs_keep_their_limits_that_is_proved() -> None:
    result = solve(problem_of(with_spring(LEVER, min_rate=500.0, max_force=1.0)))
    assert result.designs == []
    assert result.search.complete
    assert result.summary.startswith("None exists")


def test_loads_and_springs_that_are_there_already_count() -> None:
    load = {"link": "lever", "point": [400.0, 0.0], "force": {"constant": [0.0, -20.0]}}
    torque = {"link": "lever", "torque": {"constant": 2.0}}
    spring = {
        "ends": [{"link": "ground", "point": [0.0, 250.0]}, {"link": "lever", "point": [100.0, 0.0]}],
        "rate": 90.0,
    }
    ends = [{"link": "ground", "point": [0.0, 200.0]}, {"link": "lever", "point": [150.0, 0.0]}]
    dynamics = {**LEVER["dynamics"], "loads": [load], "springs": [spring]}
    design = best({**LEVER, "dynamics": dynamics, "springs": [{"ends": ends}]})
    moment = 5.0 * GRAVITY * 0.3 + 20.0 * 0.4 - 90.0 * 0.25 * 0.1
    assert design.metrics.exact
    assert design.springs[0].rate == pytest.approx(moment / (0.2 * 0.15), rel=1e-9)
    assert len(design.dynamics["springs"]) == 2
    steady = best({**LEVER, "dynamics": {**dynamics, "loads": [load, torque]}, "springs": [{"ends": ends}]})
    assert not steady.metrics.exact
    # A turning load has no potential, and nothing is told of one.
    turning = {**load, "frame": "link"}
    told = best({**LEVER, "dynamics": {**LEVER["dynamics"], "loads": [turning]}, "springs": [{"ends": ends}]})
    assert told.metrics.energy_variation is None


def test_at_a_speed_the_drive_of_inertia_is_balanced_too() -> None:
    """A lever that is swung with an acceleration: the torque grows by I α, which this spring does not even out."""
    moved = {**LEVER, "motion": {"from": -60.0, "to": 80.0, "speed": 2.0, "acceleration": 5.0}}
    slow, fast = best({**LEVER}), best(moved)
    assert fast.metrics.unbalanced_drive > slow.metrics.unbalanced_drive + 1.0
    assert fast.metrics.energy_variation is None
    assert fast.metrics.value > 0.01


def turned(statement: Statement, angle: float, shift: complex) -> Statement:
    """The whole statement of a skeleton, turned and moved."""
    turn = cmath.rect(1.0, math.radians(angle))

    def moved(point: Any) -> list[float]:
        return pair(complex(*point) * turn + shift)

    other = copy.deepcopy(statement)
    joints = other["mechanism"]["skeleton"]["joints"]
    other["mechanism"]["skeleton"]["joints"] = {name: moved(z) for name, z in joints.items()}
    other["motion"] = {name: value + angle for name, value in statement["motion"].items()}
    other["dynamics"]["gravity"] = {"angle": 270.0 + angle}
    for body in other["dynamics"]["bodies"].values():
        body["cg"] = moved(body["cg"])
    for spring in other["springs"]:
        for end in spring["ends"]:
            if "point" in end:
                end["point"] = moved(end["point"])
            else:
                end["within"] = [moved(corner) for corner in end["within"]]
    return other


@pytest.mark.slow
def test_a_frame_that_is_turned_and_moved_changes_nothing() -> None:
    rng = np.random.default_rng(21)
    statement = both_open(rng)
    one, other = best(statement), best(turned(statement, 73.0, complex(300.0, -150.0)))
    assert other.metrics.value == pytest.approx(one.metrics.value, rel=2e-3)
    assert other.metrics.unbalanced_drive == pytest.approx(one.metrics.unbalanced_drive, rel=1e-6)


@pytest.mark.parametrize("unit", ["m", "in"])
def test_units_change_nothing_but_the_numbers(unit: str) -> None:
    metres = {"m": 1.0, "in": 0.0254}[unit]
    one = best(LEVER)
    scaled = json_scaled({**LEVER, "length_unit": unit}, 1e-3 / metres)
    other = best(scaled)
    assert other.springs[0].rate == pytest.approx(one.springs[0].rate, rel=1e-9)
    assert other.metrics.unbalanced_drive == pytest.approx(one.metrics.unbalanced_drive, rel=1e-12)


def json_scaled(statement: Statement, by: float) -> Statement:
    other = copy.deepcopy(statement)
    other["mechanism"]["skeleton"]["joints"]["A"][0] *= by
    other["dynamics"]["bodies"]["lever"]["cg"][0] *= by
    ends = other["springs"][0]["ends"]
    ends[0]["point"] = [by * x for x in ends[0]["point"]]
    ends[1]["within"] = [[by * x for x in corner] for corner in ends[1]["within"]]
    return other


def test_twice_the_weight_takes_twice_the_rate() -> None:
    heavy = copy.deepcopy(LEVER)
    heavy["dynamics"]["bodies"]["lever"]["mass"] *= 2.0
    assert best(heavy).springs[0].rate == pytest.approx(2.0 * best(LEVER).springs[0].rate, rel=1e-9)


@pytest.mark.parametrize("steady", [True, False])
def test_the_energy_is_said_to_be_constant_where_that_is_checked(steady: bool) -> None:
    """A load that is a table has no potential here, though it be zero."""
    torque = {"constant": 0.0} if steady else {"table": [[-90.0, 0.0], [90.0, 0.0]]}
    dynamics = {**LEVER["dynamics"], "loads": [{"link": "lever", "torque": torque}]}
    result = solve(problem_of({**LEVER, "dynamics": dynamics}))
    metrics = result.designs[0].metrics
    assert metrics.exact
    assert (metrics.energy_variation is not None) == steady
    assert ("energy" in result.summary) == steady
    assert result.summary.startswith("The springs balance the linkage exactly")


def test_a_slider_that_drives_is_held_by_springs() -> None:
    skeleton = {
        "joints": {"A": [0.0, 0.0], "B": [100.0, 100.0], "O": [200.0, 0.0]},
        "links": [
            {"name": "ground", "joints": ["O"]},
            {"name": "rod", "joints": ["A", "B"]},
            {"name": "rocker", "joints": ["O", "B"]},
        ],
        "slides": [{"joint": "A", "link": "ground", "point": [0.0, 0.0], "angle": 0.0}],
        "input_link": "A",
    }
    weights = {"rod": {"mass": 2.0, "cg": [50.0, 50.0]}, "rocker": {"mass": 2.0, "cg": [150.0, 50.0]}}
    area = [[200.0, 100.0], [250.0, 200.0], [150.0, 200.0]]
    springs = [{"ends": [{"link": "ground", "within": area}, {"link": "rocker", "point": [150.0, 50.0]}]}]
    stated = {
        "kind": "spring_balancing",
        "mechanism": {"type": "skeleton", "skeleton": skeleton},
        "motion": {"from": -30.0, "to": 40.0},
        "dynamics": {"gravity": {}, "bodies": weights},
        "springs": springs,
    }
    design = best(stated)
    # Half of the rod's weight and half of its own hang on the rocker's end: W c of a lever, pulled straight up.
    moment = 2.0 * GRAVITY * (0.5 + 0.5)
    (spring,) = design.springs
    anchor = complex(*spring.ends[0].point) - 200.0
    assert design.metrics.exact
    assert abs(anchor.real) < 1e-6
    assert spring.rate * 1e-3 * abs(anchor) * 0.5 == pytest.approx(moment, rel=1e-9)


def test_places_between_corners() -> None:
    square = find_hull(np.array([0.0, 1.0, 1.0 + 1.0j, 1.0j, 0.5 + 0.5j, 0.5]))
    assert len(square) == 4
    assert measure_outside(square, 0.3 + 0.9j) == 0.0
    assert measure_outside(square, 1.5 + 0.5j) == pytest.approx(0.5)
    assert measure_outside(np.array([0.0, 2.0]), 1.0 + 0.25j) == pytest.approx(0.25)
