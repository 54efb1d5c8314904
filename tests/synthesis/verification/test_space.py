"""Zones, and the room of a linkage: shapes against shapely's own, the screen against the sweep."""

import numpy as np
import pytest
import shapely

from synthesis.dispatch import solve
from synthesis.kinds.motion.exact.clearance_filter import check_fourbar_clearance
from synthesis.kinds.motion.exact.dyad_pairs import make_pairs
from synthesis.model.linkage.workspace import Space
from synthesis.model.linkage.zones import AnyZone, Zone
from synthesis.registry import parse_problem
from synthesis.verification.reconstruction import rebuild_mechanism
from synthesis.verification.workspace import FirstPosition, check_space, list_moving_parts
from tests.campaign import further
from tests.support.synthesis.space import LID

HOOK = Zone.model_validate({"polygon": [[0, 0], [40, 0], [40, 30], [30, 30], [30, 10], [0, 10]]})
DISC = Zone.model_validate({"circle": {"center": [-20.0, 5.0], "radius": 8.0}})
SHAPES = {
    "polygon": (HOOK, shapely.Polygon(HOOK.polygon)),
    "circle": (DISC, shapely.Point(-20.0, 5.0).buffer(8.0, quad_segs=4096)),
    "any of both": (
        AnyZone([HOOK, DISC]),
        shapely.Polygon(HOOK.polygon) | shapely.Point(-20.0, 5.0).buffer(8.0, quad_segs=4096),
    ),
}
ROOMS = {
    "shelf": {
        "obstacles": [{"polygon": [[-260, 300], [-5, 300], [-5, 320], [-260, 320]]}],
        "clearance": 5.0,
        "link_width": 20.0,
    },
    "post, all round": {"obstacles": [{"circle": {"center": [-60, 330], "radius": 30}}], "over": "cycle"},
    "body": {
        "obstacles": [{"circle": {"center": [380, -100], "radius": 20}}],
        "body": {"outline": [[0, -300], [20, -300], [20, 290], [0, 290]]},
    },
    "box": {"box": [[-500.0, -450.0], [650.0, 750.0]]},
}


@pytest.mark.parametrize("name", SHAPES)
def test_a_zone_is_its_shape(name):
    zone, shape = SHAPES[name]
    rng = np.random.default_rng(1)
    points = rng.uniform(-60.0, 60.0, 500) + 1j * rng.uniform(-40.0, 60.0, 500)
    away = shapely.distance(shape, shapely.points(points.real, points.imag))
    assert zone.compute_distances(points) == pytest.approx(away, abs=1e-5)
    drawn = zone.sample_points(rng, 4000)
    assert (zone.compute_distances(drawn) == 0.0).all()
    # Even over the area: half of it has half of the points.
    left, low, right, high = shape.bounds
    for part in (shapely.box(left, low, 0.5 * (left + right), high), shapely.box(left, low, right, 0.5 * (low + high))):
        share = np.mean(shapely.contains_xy(part, drawn.real, drawn.imag))
        assert share == pytest.approx((shape & part).area / shape.area, abs=0.03)
    assert zone.bounds == pytest.approx((left, right, low, high), abs=1e-5)


def test_a_point_on_the_edge_is_in_the_zone():
    assert (HOOK.compute_distances(np.array([20.0 + 10.0j, 30.0 + 20.0j, 20.0 + (10.0 + 1e-9) * 1j])) == 0.0).all()
    assert HOOK.compute_distances(np.array([20.0 + 15.0j]))[0] == pytest.approx(5.0)


@pytest.mark.slow
@pytest.mark.parametrize("name", further(ROOMS, ["body"]))
def test_what_the_screen_drops_would_fail_the_sweep(name):
    """A sample of pairs, each driven and swept: none that the screen drops keeps its room, and few that it passes
    break it."""
    problem = parse_problem({**LID, "space": ROOMS[name]})
    pairs = make_pairs(problem)
    score = pairs.screen_pairs(problem.constraints, 10.0).score
    sound = np.flatnonzero(score.ravel() > 0.0)
    chosen = np.random.default_rng(2).choice(sound, 60, replace=False)
    i, j = np.unravel_index(chosen, score.shape)
    joints = [pairs.inputs.fixed[i], pairs.inputs.moving[i], pairs.outputs.moving[j], pairs.outputs.fixed[j]]
    kept = check_fourbar_clearance(problem, pairs.task, np.stack(joints, axis=1))
    swept = []
    for pair in zip(i.tolist(), j.tolist(), strict=True):
        design = pairs.verify_pair(pair)
        mechanism = rebuild_mechanism(design.mechanism, from_skeleton=True)
        first = FirstPosition(0j, complex(mechanism.joints["P"]), 0.0)
        swept.append(all(check.passed for check in check_space(problem.space, mechanism, design.metrics, first)))
    assert not (np.array(swept) & ~kept).any()
    assert (kept & ~np.array(swept)).sum() <= 8
    assert 0 < kept.sum() < len(kept)


def test_a_body_is_where_the_linkage_has_it():
    """A first position that is missed moves the body with the linkage, and its zones with the body."""
    first = FirstPosition(1.0 + 2.0j, 3.0 - 1.0j, 0.5)
    places = np.array([4.0 + 5.0j, -1.0 + 0.5j])
    assert first.map_to_body(first.map_to_reference(places)) == pytest.approx(places)
    assert first.map_to_reference(np.array([1.0 + 2.0j]))[0] == pytest.approx(3.0 - 1.0j)
    assert np.angle(np.diff(first.map_to_reference(places)) / np.diff(places))[0] == pytest.approx(0.5)


def test_what_is_drawn_on_the_body_goes_with_it():
    space = Space.model_validate(
        {
            "body": {"outline": [[0, 0], [2, 0], [2, 1]]},
            "obstacles": [{"circle": {"center": [5, 5], "radius": 1}}],
            "moving_pivots": {
                "input": {"circle": {"center": [1, 0], "radius": 0.5}, "frame": "body"},
                "output": [
                    {"polygon": [[0, 0], [2, 0], [2, 1]]},
                    {"polygon": [[0, 0], [2, 0], [2, 1]], "frame": "body"},
                ],
            },
        }
    )
    gone = space.move_with_body(0j, 10.0 + 0j, 1j)  # a quarter of a turn
    assert np.array(gone.body.outline) == pytest.approx(np.array([[10, 0], [10, 2], [9, 2]]))
    assert gone.moving_pivots.input[0].circle.center == pytest.approx((10.0, 1.0))
    plane, body = gone.moving_pivots.output
    assert plane == space.moving_pivots.output[0]
    assert np.array(body.polygon) == pytest.approx(np.array([[10, 0], [10, 2], [9, 2]]))
    assert gone.obstacles == space.obstacles


def test_parts_are_hulls_of_joints_and_the_body():
    problem = parse_problem({**LID, "space": ROOMS["body"]})
    design = solve(problem).designs[0]
    mechanism = rebuild_mechanism(design.mechanism, from_skeleton=True)
    parts = list_moving_parts(problem.space, mechanism, FirstPosition(0j, complex(mechanism.joints["P"]), 0.0))
    assert [part.link for part in parts] == ["input", "coupler", "output", "coupler"]
    assert [len(part.points) for part in parts] == [2, 2, 2, 4]
    bare = list_moving_parts(Space(link_width=8.0), mechanism, None)
    assert [(part.link, len(part.points), part.radius) for part in bare] == [
        ("input", 2, 4.0),
        ("coupler", 3, 4.0),
        ("output", 2, 4.0),
    ]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("dyad", "side"),
    further([("PR", "output_side"), ("RP", "output_side"), ("PR", "input_side")], [("PR", "input_side")]),
)
def test_sliders_keep_their_zones(dyad, side):
    """The side of a slide has a pin and no fixed pivot, that of a block a fixed pivot and no pin."""
    wide = {"polygon": [[-900, -900], [900, -900], [900, 900], [-900, 900]]}
    name = side.removesuffix("_side")
    other = "output" if name == "input" else "input"
    zones = {"moving_pivots": {name: wide}} if dyad == "PR" else {"fixed_pivots": {name: wide}}
    zones.setdefault("fixed_pivots", {})[other] = {"polygon": [[-900, -900], [0, -900], [0, 900], [-900, 900]]}
    designs = solve(parse_problem({**LID, side: {"dyad": dyad}, "space": zones})).designs
    assert designs
    for design in designs:
        assert design.mechanism.skeleton.joints["O2"][0] <= 1e-6
        assert design.verification.passed
    none = {"fixed_pivots": {name: wide}} if dyad == "PR" else {"moving_pivots": {name: wide}}
    assert not solve(parse_problem({**LID, side: {"dyad": dyad}, "space": none})).designs


@pytest.mark.slow
def test_where_nothing_fits_the_nearest_miss_tells_by_how_much():
    shelf = {"polygon": [[-3000, 300], [3000, 300], [3000, 320], [-3000, 320]]}
    result = solve(parse_problem({**LID, "space": {"obstacles": [shelf], "box": [[-100, -100], [300, 500]]}}))
    assert not result.designs
    gaps = {gap.check: gap for gap in result.nearest_miss.gaps}
    assert gaps["box"].value > 0.0 or gaps["obstacles"].value < 0.0
    if gaps["obstacles"].value < 0.0:
        assert f"overlaps an obstacle by {-gaps['obstacles'].value:.4g} mm" in result.summary
