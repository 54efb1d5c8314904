"""How near parts come to each other: bounds against motion, distances against samples, sweeps against dense drives."""

import numpy as np
import pytest
import shapely

from kinematics.errors import DimensionError
from kinematics.linkage import Fourbar, catalogue
from kinematics.linkage.clearance import Part, find_free_inputs, find_free_ranges, sweep_pairs
from kinematics.linkage.clearance.outlines import build_stretches, measure_distance, measure_distances
from kinematics.linkage.clearance.scene import Scene
from kinematics.linkage.planar.drive import drive
from tests.campaign import further
from tests.kinematics.mechanism_sampling import EVERY, take

ROUNDING = 3e-9
"""Share of the size by which positions are known after a small step near a toggle."""

ARM = 2.0
CRANK_ROCKER = catalogue.make_fourbar(Fourbar.from_lengths(ARM, 7.0, 9.0, 6.0), input_angle=0.5)
"""Its crank turns through."""


def one(name, seed):
    rng = np.random.default_rng([seed, list(EVERY).index(name)])
    return rng, take(EVERY[name](rng, 3), 0)


def carried(mechanism, part, inputs):
    """Where the points of a part are at inputs, shape (n, k), from two joints of its link; NaN where nowhere."""
    if part.link == "ground":
        return np.repeat(part.points[None], len(inputs), axis=0)
    first, second = mechanism.links[part.link][:2]
    joints = drive(mechanism, inputs, order=0).joints
    a, b = joints[first][0][:, None], joints[second][0][:, None]
    start = complex(mechanism.joints[first])
    return a + (b - a) * (part.points - start) / (complex(mechanism.joints[second]) - start)


def along(points, n):
    """Points of a bar, shape (…, 2) to (…, n)."""
    return points[..., :1] + (points[..., 1:] - points[..., :1]) * np.linspace(0.0, 1.0, n)


def bar_distance(first, second):
    """Distance of bars, shapes (n, 2), from samples of the first to the second: at most half a sample too great."""
    z, a, d = along(first, 401), second[:, :1], np.diff(second, axis=1)
    share = np.clip(((z - a) * np.conj(d)).real / np.abs(d) ** 2, 0.0, 1.0)
    return np.abs(z - a - share * d).min(axis=1)


def bars(mechanism):
    """The links but the ground, from their first joint to their second."""
    return [
        Part(link, np.array([complex(mechanism.joints[joint]) for joint in joints[:2]]), 0.0)
        for link, joints in mechanism.links.items()
        if link != "ground"
    ]


POST = Part("ground", np.array([0.1234 + 5.678j]), 0.0)
"""On no joint."""


def nearer(scene, middle, half):
    """By how much each pair of a scene may come nearer within a half of an input; where one is the post, its move."""
    count = len(scene.pairs)
    return scene.distances(np.arange(count), np.full(count, middle), np.full(count, half))[1]


@pytest.mark.parametrize("name", further(EVERY, list(EVERY)[::3]))
def test_nothing_moves_farther_than_its_bound(name):
    rng, mechanism = one(name, 1)
    corner = np.array([1.0 + 1.0j])
    parts = [part._replace(points=np.concatenate([part.points, part.points[:1] + corner])) for part in bars(mechanism)]
    scene = Scene(mechanism, [*parts, POST], [(n, len(parts)) for n in range(len(parts))])
    start = float(mechanism.reference_input)
    seen = 0
    for half in scene.unit * 10.0 ** rng.uniform(-6.0, -0.3, 40):
        middle = start + scene.unit * rng.uniform(-1.0, 1.0)
        inputs = np.concatenate([[middle, middle - half, middle + half], middle + half * rng.uniform(-1.0, 1.0, 40)])
        for part, bound in zip(parts, nearer(scene, middle, half), strict=True):
            places = carried(mechanism, part, inputs)
            if not np.isfinite(places[0]).all():
                continue
            moved = np.abs(places - places[0])
            assert np.nanmax(moved) <= bound + ROUNDING * scene.size
            seen += 1
    assert seen >= 10


@pytest.mark.parametrize("name", EVERY)
def test_bounds_are_of_the_order_of_the_motion(name):
    """With a millionth of a radian they are a few times what a part moves: else nothing would ever be decided."""
    _, mechanism = one(name, 2)
    parts = bars(mechanism)
    scene = Scene(mechanism, [*parts, POST], [(n, len(parts)) for n in range(len(parts))])
    start, half = float(mechanism.reference_input), 1e-6 * scene.unit
    motion = drive(mechanism, np.array([start]), order=1)
    for part, bound in zip(parts, nearer(scene, start, half), strict=True):
        joints = mechanism.links[part.link]
        speeds = [abs(motion.joints[joint][1, 0]) for joint in joints]
        turning = abs(motion.angles[part.link][1, 0]) * abs(np.ptp(part.points))
        assert bound <= 50.0 * half * (max(speeds) + turning)


@pytest.mark.parametrize("name", EVERY)
def test_no_pair_comes_nearer_than_its_bound(name):
    """Bars of links that share a joint or do not, and discs about every joint, by whichever link they are given."""
    rng, mechanism = one(name, 3)
    parts = bars(mechanism)
    parts += [
        Part(link, np.array([complex(mechanism.joints[joint])]), 0.0)
        for link, joints in mechanism.links.items()
        for joint in joints
    ]
    pairs = [(n, m) for n in range(len(parts)) for m in range(n)]
    scene = Scene(mechanism, parts, pairs)
    start = float(mechanism.reference_input)
    every = np.arange(len(pairs))
    seen = 0
    for half in scene.unit * 10.0 ** rng.uniform(-5.0, -0.3, 12):
        middle = start + scene.unit * rng.uniform(-0.5, 0.5)
        inputs = middle + half * np.array([0.0, -1.0, 1.0, *rng.uniform(-1.0, 1.0, 9)])
        of, at = np.repeat(every, len(inputs)), np.tile(inputs, len(pairs))
        apart = scene.distances(of, at, np.zeros(len(at)))[0].reshape(len(pairs), -1)
        known = np.isfinite(apart[:, 0])
        most = np.nanmax(apart[known, :1] - apart[known], axis=1)
        assert (most <= nearer(scene, middle, half)[known] + ROUNDING * scene.size).all()
        seen += int(known.sum())
    assert seen >= len(pairs)


def test_parts_of_one_link_keep_their_distance_as_it_is():
    """The pins at both ends of the coupler stand on it, though the crank and the rocker carry them too."""
    a, b = (complex(CRANK_ROCKER.joints[name]) for name in "AB")
    pins = [Part("input", np.array([a]), 0.1), Part("output", np.array([b]), 0.1)]
    scene = Scene(CRANK_ROCKER, [*pins, Part("input", np.array([a + 1e-9]), 0.1)], [(0, 1), (2, 1)])
    held, free = nearer(scene, 0.5, 0.2)
    assert held == 0.0
    assert free > 0.0


def test_a_point_that_lies_at_a_joint_of_other_links_only_is_not_carried_by_them():
    """A tracing point over the fixed pivot of the crank, as the mechanism is drawn, moves away from it."""
    over = Part("coupler", np.array([complex(CRANK_ROCKER.joints["O2"])]), 0.0)
    post = Part("ground", over.points + 5.0, 0.0)
    scene = Scene(CRANK_ROCKER, [over, post], [(0, 1)])
    assert nearer(scene, 0.5, 0.1)[0] > 0.0


def shape(points):
    """A point, a line or a polygon of shapely's."""
    pairs = np.stack([points.real, points.imag], axis=1)
    return [shapely.Point, shapely.LineString, shapely.Polygon][min(len(pairs), 3) - 1](
        pairs[0] if len(pairs) == 1 else pairs
    )


def test_distances_of_cores_are_those_of_shapely():
    rng = np.random.default_rng(3)
    seen = set()
    for _ in range(600):
        cores = []
        for _ in range(2):
            k = int(rng.integers(1, 8))
            angles = np.sort(rng.uniform(0.0, 2.0 * np.pi, k))
            centre = complex(*rng.uniform(-2.0, 2.0, 2))
            cores.append(centre + rng.uniform(0.2, 2.0, k) * np.exp(1j * angles))  # a star, seldom convex
        found, apart = measure_distance(*cores), shape(cores[0]).distance(shape(cores[1]))
        assert found == (pytest.approx(apart, abs=1e-12) if apart > 0.0 else -np.inf)
        crossing = shape(cores[0]).boundary.intersects(shape(cores[1]).boundary)
        seen.add((apart > 0.0, crossing))
    assert seen == {(True, False), (False, False), (False, True)}


def outline(rng, corners):
    """A point, a bar, or a polygon with teeth, some of them as long as it is."""
    spread = 10.0 ** rng.uniform(-2.0, 1.0)
    if corners < 3:
        return spread * (rng.normal(size=corners) + 1j * rng.normal(size=corners))
    angles = np.sort(rng.uniform(0.0, 2.0 * np.pi, corners))
    return spread * rng.uniform(0.3, 1.0, corners) ** rng.integers(0, 3) * np.exp(1j * angles)


def test_many_edges_are_as_far_apart_as_every_edge_says():
    """Outlines of up to a thousand edges: the same number as of all pairs of edges, also where they meet or touch."""
    rng = np.random.default_rng(8)
    met = touched = 0
    for _ in range(300):
        cores = [outline(rng, int(count)) for count in 10.0 ** rng.uniform(0.0, 2.5, 2)]
        cores[1] = cores[1] + rng.normal() * 3.0 + 1j * rng.normal()
        if rng.random() < 0.2 and len(cores[1]) > 2:
            cores[0] = cores[0] - cores[0][0] + cores[1][rng.integers(len(cores[1]))]  # a corner on a corner
        vertices = np.concatenate(cores)
        starts = np.array([0, len(cores[0]), len(vertices)])
        # Quarter turns, since these leave nothing to rounding.
        turn = 1j ** rng.integers(0, 4, (2, 1)) if rng.random() < 0.5 else np.ones((2, 1), np.complex128)
        turn = turn.real.round() + 1j * turn.imag.round()
        shift = rng.normal(size=(2, 1)) * (turn != 1.0) + 0j
        parts, every = np.arange(2), np.zeros((1, 2), np.int64)
        tree = build_stretches(vertices, starts)
        found = measure_distances(vertices, starts, parts, parts[None], every, turn, shift, tree)[0]
        first, second = (turn[n, 0] * cores[n] + shift[n, 0] for n in range(2))
        assert found == max(measure_distance(first, second), -1e-6)
        met += found == -1e-6
        touched += found == 0.0
    assert met > 50
    assert touched > 0
    assert met + touched < 250


@pytest.mark.slow
@pytest.mark.parametrize("name", further(EVERY, list(EVERY)[::3]))
def test_least_distances_agree_with_a_dense_drive(name):
    rng, mechanism = one(name, 4)
    scene = Scene(mechanism, bars(mechanism), [(0, 0)])
    start, reach = float(mechanism.reference_input), 0.2 * scene.unit
    inputs = np.linspace(start - reach, start + reach, 4001)
    valid = drive(mechanism, inputs, order=0).valid
    near = np.flatnonzero(~valid)
    low = inputs[near[near < 2000].max(initial=-1) + 1]
    high = inputs[near[near > 2000].min(initial=4001) - 1]
    inputs = np.linspace(low, high, 2001)
    wall = Part("ground", np.array([complex(*rng.normal(size=2)) * scene.size for _ in range(2)]), 0.0)
    parts = [*bars(mechanism), wall]
    pairs = [(n, len(parts) - 1) for n in range(len(parts) - 1)] + [(0, n) for n in range(1, len(parts) - 1)]
    for pair, found in zip(pairs, sweep_pairs(mechanism, parts, pairs, low, high, 0.0), strict=True):
        places = [carried(mechanism, parts[n], inputs) for n in pair]
        dense = np.nanmin(bar_distance(*places))
        assert found.decided
        assert found.least == pytest.approx(dense, abs=5e-3 * scene.size)
        assert found.keeps == (found.least >= -1e-9 * scene.size)
        assert low <= found.at <= high


@pytest.mark.slow
@pytest.mark.parametrize(
    "name", further(EVERY, [name for name in EVERY if not name.startswith(("stephenson_2", "dwell"))][::2])
)
def test_the_nearest_of_all_pairs_is_that_of_each(name):
    """The same least distance, and the same word on whether all keep one that most, some or none of them keep."""
    rng, mechanism = one(name, 6)
    size = Scene(mechanism, bars(mechanism), [(0, 0)]).size
    start = float(mechanism.reference_input)
    reach = 0.05 * Scene(mechanism, bars(mechanism), [(0, 0)]).unit
    posts = [Part("ground", size * (rng.normal(size=1) + 1j * rng.normal(size=1)), 0.02 * size) for _ in range(4)]
    parts = [*bars(mechanism), *posts]
    pairs = [(n, m) for n in range(len(parts) - 4) for m in range(len(parts) - 4, len(parts))]
    each = sweep_pairs(mechanism, parts, pairs, start, start + reach, 0.0)
    distances = sorted(pair.least for pair in each)
    for wanted in (distances[0] - 0.01 * size, distances[0] + 1e-6 * size, distances[len(pairs) // 2], 9.0 * size):
        each = sweep_pairs(mechanism, parts, pairs, start, start + reach, wanted)
        every = sweep_pairs(mechanism, parts, pairs, start, start + reach, wanted, nearest="all")
        assert min(pair.least for pair in every) == pytest.approx(distances[0], abs=1e-7 * size)
        assert all(pair.keeps for pair in every) == all(pair.keeps for pair in each)
        for alone, together in zip(each, every, strict=True):
            assert alone.keeps or not together.keeps
            assert together.least >= alone.least - 1e-9 * size


def test_a_crank_passes_a_point_at_a_distance_that_is_known():
    parts = [Part("input", np.array([ARM + 0.0j]) * np.exp(0.5j), 0.25), Part("ground", np.array([3.0 + 4.0j]), 0.5)]
    exact = abs(3.0 + 4.0j) - ARM - 0.75
    for wanted, kept in ((exact - 1e-6, True), (exact + 1e-6, False)):
        (found,) = sweep_pairs(CRANK_ROCKER, parts, [(0, 1)], 0.0, 2.0 * np.pi, wanted)
        assert (found.keeps, found.decided) == (kept, True)
        assert found.least == pytest.approx(exact, abs=1e-9)
        assert found.at == pytest.approx(np.angle(3.0 + 4.0j), abs=1e-4)


@pytest.mark.parametrize(
    "name",
    further(
        ["fourbar", "crank-shaper", "slider-crank driven by its slider", "stephenson_2 driven by its input"],
        ["fourbar", "slider-crank driven by its slider"],
    ),
)
def test_nothing_in_the_way_is_passed_over(name):
    """A dot that a bar touches at one input only, anywhere in the range, however short the moment."""
    rng, mechanism = one(name, 5)
    unit = Scene(mechanism, bars(mechanism), [(0, 0)]).unit
    start = float(mechanism.reference_input)
    inputs = np.linspace(start, start + 0.3 * unit, 500)
    valid = drive(mechanism, inputs, order=0).valid
    high = inputs[np.flatnonzero(~valid).min(initial=500) - 1]
    for part in bars(mechanism):
        for at in rng.uniform(start, high, 5):
            bar = carried(mechanism, part, np.array([at]))[0]
            normal = 1j * np.diff(bar)[0]
            dot = Part("ground", bar[1:] + 1e-5 * normal, 0.0)
            (found,) = sweep_pairs(mechanism, [part, dot], [(0, 1)], start, high, 2e-5 * abs(normal))
            assert not found.keeps
            assert found.least <= 1e-5 * abs(normal) * (1.0 + 1e-6)


@pytest.mark.slow
def test_free_inputs_are_free_and_nearly_all_of_them():
    part = bars(CRANK_ROCKER)[1]
    inputs = np.linspace(0.0, 2.0 * np.pi, 20001)
    places = carried(CRANK_ROCKER, part, inputs)
    middle = carried(CRANK_ROCKER, part, np.array([1.0]))[0].mean()
    post = Part("ground", np.array([middle]), 0.3)
    apart = bar_distance(places, np.repeat(middle + np.array([[0.0, 1e-7]]), len(inputs), axis=0)) - 0.3
    fine = 1e-4
    free = find_free_inputs(CRANK_ROCKER, [part, post], [(0, 1)], 0.0, 2.0 * np.pi, 0.1, fine)
    assert 1 <= len(free) <= 4
    within = np.zeros(len(inputs), np.bool_)
    for low, high in free:
        within |= (inputs >= low) & (inputs <= high)
    assert (apart[within] >= 0.1 - 1e-4).all()
    assert 0.1 < within.mean() < 0.9
    assert within.mean() == pytest.approx((apart >= 0.1).mean(), abs=1e-3)


def test_each_pair_has_its_own_free_ranges():
    """What is free for all of them is free for each."""
    parts = bars(CRANK_ROCKER)
    middle = carried(CRANK_ROCKER, parts[1], np.array([1.0]))[0].mean()
    parts += [Part("ground", np.array([middle]), 0.3), Part("ground", np.array([middle + 2.0]), 0.3)]
    pairs = [(1, 3), (1, 4), (0, 3)]
    asked = (0.0, 2.0 * np.pi, 0.1, 1e-4)
    each = find_free_ranges(CRANK_ROCKER, parts, pairs, *asked)
    assert each == [find_free_inputs(CRANK_ROCKER, parts, [pair], *asked) for pair in pairs]
    inputs = np.linspace(0.0, 2.0 * np.pi, 5001)
    within = [np.any([(low <= inputs) & (inputs <= high) for low, high in own], axis=0) for own in each]
    both = find_free_inputs(CRANK_ROCKER, parts, pairs, *asked)
    assert (np.any([(low <= inputs) & (inputs <= high) for low, high in both], axis=0) == np.all(within, axis=0)).all()


def test_a_part_that_is_far_away_is_free_all_over_even_where_the_bound_is_coarse():
    """Where links turn fast for a small step of the input only the finest parts of the range decide."""
    joints = {
        "O2": 0.4398 - 0.3674j,
        "O4": 0.9769 + 0.9345j,
        "A": -0.8472 - 1.0942j,
        "C": 0.3491 + 0.196j,
        "B": 0.8008 - 0.5754j,
        "D": -2.0371 + 0.0719j,
        "E": 0.4141 - 0.1078j,
    }
    mechanism = catalogue.make_sixbar("stephenson_2", joints, "output")
    parts = [*bars(mechanism), Part("ground", np.array([4.0]), 0.1)]
    at = float(mechanism.reference_input)
    pairs = [(n, len(parts) - 1) for n in range(len(parts) - 1)]
    for own in find_free_ranges(mechanism, parts, pairs, at - np.pi, at + np.pi, 0.1, 1e-4):
        assert len(own) == 1


def test_overlapping_outlines_say_by_how_much():
    """Bars that share a pin: their cores meet, so that the outlines overlap by both radii."""
    parts = [part._replace(radius=0.2) for part in bars(CRANK_ROCKER)]
    (found,) = sweep_pairs(CRANK_ROCKER, parts, [(0, 1)], 0.0, 1.0, 0.0)
    assert (found.least, found.keeps, found.decided) == (pytest.approx(-0.4, abs=1e-4), False, True)


@pytest.mark.slow
def test_what_cannot_be_reached_is_not_kept():
    """A range that the mechanism does not reach the end of: nothing is proven there."""
    rocker = catalogue.make_fourbar(Fourbar.from_lengths(5.0, 4.0, 3.0, 7.0), input_angle=0.9)
    part = bars(rocker)[0]
    far = Part("ground", np.array([100.0 + 0.0j]), 0.0)
    (found,) = sweep_pairs(rocker, [part, far], [(0, 1)], 0.9, 3.0, 1.0)
    assert (found.keeps, found.decided) == (False, False)


@pytest.mark.parametrize(
    ("part", "low", "high"),
    [
        (Part("lever", np.array([0j]), 0.0), 0.0, 1.0),
        (Part("input", np.empty(0, np.complex128), 0.0), 0.0, 1.0),
        (Part("input", np.array([np.nan + 0j]), 0.0), 0.0, 1.0),
        (Part("input", np.array([0j]), -1.0), 0.0, 1.0),
        (Part("input", np.array([0j]), 0.0), 1.0, 0.0),
        (Part("input", np.array([0j]), 0.0), 0.0, np.inf),
    ],
)
def test_what_makes_no_sense_is_refused(part, low, high):
    with pytest.raises(DimensionError):
        sweep_pairs(CRANK_ROCKER, [part, bars(CRANK_ROCKER)[0]], [(0, 1)], low, high, 0.0)


@pytest.mark.parametrize(
    ("first", "second", "found"),
    [
        ([0, 2], [1 - 1j, 1 + 1j], -np.inf),  # bars that cross
        ([0, 2], [1, 1 + 1j], 0.0),  # that touch
        ([0, 2], [0, 2], 0.0),  # that lie on each other
        ([1 + 1j], [0, 2, 2 + 2j, 2j], -np.inf),  # a point inside
        ([1 + 0j], [0, 2, 2 + 2j, 2j], 0.0),  # on an edge
        ([-1 - 1j, 3 + 3j], [0, 2, 2 + 2j, 2j], -np.inf),  # a bar along the diagonal
        ([0.5 + 0.5j, 1 + 0.5j, 1 + 1j], [0, 2, 2 + 2j, 2j], -np.inf),  # a polygon inside another
        ([2, 4, 4 + 2j, 2 + 2j], [0, 2, 2 + 2j, 2j], 0.0),  # side by side
        ([0, 2, 2 + 2j, 2j], [0, 2, 2 + 2j, 2j], 0.0),  # one and the same touch all round
        ([5 + 1j], [0, 2, 2 + 2j, 2j], 3.0),
    ],
)
def test_cores_that_meet_are_nearer_than_those_that_touch(first, second, found):
    cores = np.array(first, np.complex128), np.array(second, np.complex128)
    assert measure_distance(*cores) == found
    assert measure_distance(*cores[::-1]) == found


def test_links_without_width_that_cross_do_not_keep_even_no_distance():
    crossing = Part("ground", np.array([1.0 + 0.5j, 3.0 + 3.0j]), 0.0)
    (found,) = sweep_pairs(CRANK_ROCKER, [bars(CRANK_ROCKER)[0], crossing], [(0, 1)], 0.0, 2.0 * np.pi, 0.0)
    assert (found.keeps, found.decided) == (False, True)
    assert found.least < 0.0
