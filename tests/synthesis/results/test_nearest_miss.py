"""Where no design satisfies all demands the answer says what comes nearest, and what is within reach."""

import math
from dataclasses import replace

import pytest

from synthesis import parse_problem, solve
from synthesis.dispatch import SEARCH_SHARE
from synthesis.nearest_miss import find_nearest_miss
from synthesis.registry import KINDS, list_examples
from synthesis.results.time_budget import SearchBudget
from tests.campaign import further
from tests.support.synthesis.drawn_poses import LID, ZONES

POSITIONS = [{"x": x, "y": y, "angle": a} for x, y, a in ((0.0, 0.0, 0.0), (20.0, 10.0, 25.0), (45.0, 8.0, 60.0))]


def limited(statement, **constraints):
    return {**statement, "constraints": {**statement.get("constraints", {}), **constraints}}


def motion(**constraints):
    return limited({"kind": "motion", "positions": POSITIONS}, **constraints)


OUT_OF_REACH = {
    "path": limited({**list_examples("path")[1], "method": "exact"}, min_transmission_angle=88.5),
    "function": limited(
        {**list_examples("function")[1], "zeros": {"input": 0.0, "output": 0.0}}, min_transmission_angle=88.5
    ),
    "quick_return": limited(list_examples("quick_return")[0], min_transmission_angle=88.5),
    "straight_line": limited(list_examples("straight_line")[0], min_transmission_angle=88.5),
    "dwell": limited(list_examples("dwell")[1], min_transmission_angle=88.5),
    "parallel_motion": limited(list_examples("parallel_motion")[0], min_transmission_angle=88.5),
}


@pytest.mark.parametrize("kind", further(OUT_OF_REACH, [kind for kind in OUT_OF_REACH if kind != "dwell"]))
def test_a_limit_out_of_reach_is_told_with_the_design_that_comes_nearest(kind):
    result = solve(parse_problem(OUT_OF_REACH[kind]))
    assert result.designs == []
    miss = result.nearest_miss
    (gap,) = miss.gaps
    assert (gap.check, gap.limit, gap.dimension) == ("transmission_angle", 88.5, "angle")
    assert gap.value == miss.design.metrics.min_transmission_angle < 88.5
    assert miss.reachable.model_dump() == {"min_transmission_angle": gap.value}
    assert [check.name for check in miss.design.verification.checks if not check.passed] == ["transmission_angle"]


@pytest.mark.parametrize("kind", ["path", "quick_return", "straight_line"])
def test_what_is_said_to_be_within_reach_is(kind):
    reachable = solve(parse_problem(OUT_OF_REACH[kind])).nearest_miss.reachable.min_transmission_angle
    within = limited(OUT_OF_REACH[kind], min_transmission_angle=reachable - 1e-6)
    result = solve(parse_problem(within))
    assert result.designs
    assert result.nearest_miss is None
    assert result.designs[0].verification.passed


def test_where_all_designs_are_known_nothing_beyond_is_within_reach():
    statement = OUT_OF_REACH["quick_return"]
    result = solve(parse_problem(statement))
    assert result.search.complete
    reachable = result.nearest_miss.reachable.min_transmission_angle
    assert solve(parse_problem(limited(statement, min_transmission_angle=reachable + 1e-6))).designs == []


@pytest.mark.slow
def test_the_gap_of_a_zone_is_the_distance_of_the_pivots_from_it():
    zone = {"x": [300.0, 310.0], "y": [-5.0, 5.0]}
    result = solve(parse_problem(motion(fixed_pivot_region=zone)))
    assert result.designs == []
    (gap,) = result.nearest_miss.gaps
    joints = result.nearest_miss.design.mechanism.skeleton.joints
    outside = max(
        math.hypot(max(300.0 - x, 0.0, x - 310.0), max(-5.0 - y, 0.0, y - 5.0)) for x, y in (joints["O2"], joints["O4"])
    )
    assert (gap.check, gap.limit, gap.dimension) == ("fixed_pivot_region", 0.0, "length")
    assert gap.value == pytest.approx(outside, rel=1e-12)
    # Nearer than where designs lie that nothing draws there.
    free = solve(parse_problem(motion()))
    assert gap.value < min(300.0 - design.mechanism.skeleton.joints["O4"][0] for design in free.designs)


def test_two_limits_each_out_of_reach_are_told_with_what_the_other_leaves():
    result = solve(parse_problem(motion(min_transmission_angle=85.0, max_link_ratio=1.05)))
    assert result.designs == []
    reachable = result.nearest_miss.reachable
    assert reachable.min_transmission_angle < 85.0
    assert reachable.max_link_ratio > 1.05


@pytest.mark.parametrize(
    ("statement", "check", "measure"),
    [
        ({"kind": "gear_train", "ratio": "pi", "tolerance": 0.0, "max_stages": 1}, "ratio_error", "relative_error"),
        ({**list_examples("planetary_train")[0], "ratio": 5.4321, "tolerance": 0.0}, "ratio", "error"),
        ({**list_examples("layshaft_gearbox")[0], "tolerance": 0.0001}, "ratios", "max_error"),
    ],
    ids=["gear_train", "planetary_train", "layshaft_gearbox"],
)
def test_of_gears_it_is_the_most_exact_ratio(statement, check, measure):
    result = solve(parse_problem(statement))
    assert result.designs == []
    (gap,) = result.nearest_miss.gaps
    assert (gap.check, gap.limit) == (check, statement["tolerance"])
    assert gap.value == abs(getattr(result.nearest_miss.design.metrics, measure)) > statement["tolerance"]
    rougher = solve(parse_problem({**statement, "tolerance": gap.value * (1.0 + 1e-9)}))
    assert rougher.designs


def test_there_is_none_where_a_design_passes():
    assert solve(parse_problem(motion())).nearest_miss is None


def test_progress_never_goes_back():
    shares = []
    solve(parse_problem(motion(min_transmission_angle=89.9)), lambda share, _: shares.append(share))
    assert shares == sorted(shares)
    assert shares[-1] == 1.0
    assert SEARCH_SHARE in shares


def test_a_design_found_without_a_demand_that_keeps_it_is_an_answer():
    """A solver that loses its designs when a limit is stated, though they are far within it."""
    problem = parse_problem(motion(min_transmission_angle=5.0, max_link_ratio=50.0))
    kind = KINDS["motion"]

    def spoilt(statement, progress):
        result = kind.solve(statement, progress)
        return result.model_copy(update={"designs": []}) if statement.constraints.max_link_ratio else result

    found = find_nearest_miss(problem, replace(kind, solve=spoilt), lambda *_: None)
    assert found.nearest_miss is None
    assert found.sound
    for design in found.sound:
        checks = {check.name: check for check in design.verification.checks}
        assert design.verification.passed
        assert checks["link_ratio"].value <= 50.0
        assert checks["transmission_angle"].value >= 5.0


def test_a_limit_that_a_kind_sets_itself_is_no_demand_of_the_clients():
    """Functions keep to a link ratio of 100 unless another is stated; that is never left out."""
    problem = parse_problem(OUT_OF_REACH["function"])
    kind = KINDS["function"]
    asked = []

    def recorded(statement, progress):
        asked.append(statement.constraints)
        return kind.solve(statement, progress)

    find_nearest_miss(problem, replace(kind, solve=recorded), lambda *_: None)
    assert asked
    assert {constraints.max_link_ratio for constraints in asked} == {100.0}


@pytest.mark.campaign
@pytest.mark.parametrize(("angle", "count"), [(300.0, 1), (150.0, 2)])
def test_of_a_dwell_out_of_reach_the_longest_that_was_found_is_told(angle, count):
    statement = {
        "kind": "dwell", "dwell_angle": angle, "count": count, "output": {"type": "slider", "stroke": 50.0},
    }  # fmt: skip
    result = solve(parse_problem(statement))
    assert result.designs == []
    miss = result.nearest_miss
    assert "dwell_1" in {gap.check for gap in miss.gaps}
    longest = miss.reachable.dwell_angle
    assert 0.2 * angle < longest < angle
    assert f"The longest dwells found are {longest:.4g}°" in result.summary
    # The miss rests for so long; state that, and there is an answer.
    assert min(rest.width for rest in miss.design.targets) >= longest
    assert solve(parse_problem({**statement, "dwell_angle": longest})).designs


@pytest.mark.slow
@pytest.mark.parametrize("seconds", [0.5, 3.0, 30.0])
def test_no_search_is_begun_that_the_allowance_has_no_room_for(seconds):
    """Searches that take so long, by a clock of the test's: the first is made, and others while one more fits."""
    problem = parse_problem(motion(min_transmission_angle=85.0, fixed_pivot_region={"x": [20, 30], "y": [-60, -50]}))
    kind = replace(KINDS["motion"], nearer=None)
    spent = [0.0]

    def slow(statement, progress):
        spent[0] += seconds
        return kind.solve(statement, progress)

    budget = SearchBudget(4.0, lambda: spent[0])
    found = find_nearest_miss(problem, replace(kind, solve=slow), lambda *_: None, budget)
    assert found.nearest_miss is not None, "the best found so far is told"
    assert spent[0] <= max(4.0, seconds)
    assert spent[0] + seconds > 4.0 or len(found.nearest_miss.gaps) == 1


@pytest.mark.campaign
def test_what_comes_nearest_does_not_hang_on_the_unit_of_length():
    zone = {"x": (20.0, 30.0), "y": (-60.0, -50.0)}
    told = []
    for scale in (1.0, 1e-3, 1e3):
        positions = [{"x": scale * p["x"], "y": scale * p["y"], "angle": p["angle"]} for p in POSITIONS]
        region = {axis: [scale * end for end in ends] for axis, ends in zone.items()}
        constraints = {"min_transmission_angle": 85.0, "fixed_pivot_region": region}
        result = solve(parse_problem({"kind": "motion", "positions": positions, "constraints": constraints}))
        told.append([(gap.check, gap.value) for gap in result.nearest_miss.gaps])
    assert [[name for name, _ in gaps] for gaps in told] == [[name for name, _ in told[0]]] * 3
    for gaps in told[1:]:
        for (name, value), (_, first) in zip(gaps, told[0], strict=True):
            assert name == "transmission_angle", "the zone is more than two sizes of the task away"
            assert value == pytest.approx(first, rel=1e-6)


@pytest.mark.campaign
def test_zones_of_the_linkage_are_not_for_the_joints_of_its_driver():
    """As in every answer; a gap of a zone is one of pivots that the zone is for."""
    statement = {"kind": "motion", "positions": LID, "driver_dyad": True, "constraints": ZONES}
    problem = parse_problem(limited(statement, min_transmission_angle=89.0))
    miss = solve(problem).nearest_miss
    joints = {name: complex(*place) for name, place in miss.design.mechanism.skeleton.joints.items()}
    assert not problem.constraints.fixed_pivot_region.contains(joints["O6"])
    outside = max(map(problem.constraints.fixed_pivot_region.compute_distance, (joints["O2"], joints["O4"])))
    told = {check.name: check.value for check in miss.design.verification.checks}
    assert told["fixed_pivot_region"] == pytest.approx(outside, abs=1e-9)
    assert [gap.check for gap in miss.gaps] == ["transmission_angle"]


@pytest.mark.campaign
def test_a_limit_beside_tolerances_is_approached_by_continuation():
    """No search at any step: what is at hand is steered on, far beyond what leaving the limit out met."""
    statement = {"kind": "motion", "positions": LID, "constraints": {"fixed_pivot_region": ZONES["fixed_pivot_region"]}}
    problem = parse_problem(limited(statement, link_length={"max": 20.0}))
    kind = KINDS["motion"]
    searched = []

    def recorded(stated, progress):
        searched.append(kind.solve(stated, progress))
        return searched[-1]

    found = find_nearest_miss(problem, replace(kind, solve=recorded), lambda *_: None)
    longest = min(max(design.mechanism.links.model_dump().values()) for result in searched for design in result.designs)
    designs = found.sound or [found.nearest_miss.design]
    assert max(designs[0].mechanism.links.model_dump().values()) < 0.8 * longest
    for design in found.sound:
        assert design.verification.passed
