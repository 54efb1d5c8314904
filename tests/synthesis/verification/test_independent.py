"""Answers measured by another route: what both state is the same to a millionth."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from synthesis.dispatch import solve
from synthesis.kinds.cam.statement.segments import Law
from synthesis.model.linkage.answer import Skeleton
from synthesis.registry import parse_problem
from tests.campaign import further, sampled
from tests.support.independent import cam_motion
from tests.support.independent.cam_demands import CRITERIA, SORTS, in_units
from tests.support.independent.cam_demands import statements as demanding
from tests.support.independent.cam_laws import AT_REST, FAMILY, MIRRORED, POLYNOMIALS, law
from tests.support.independent.cam_measures import compare_cam
from tests.support.independent.cam_motion import by_law, by_polynomial, motion_at, turned
from tests.support.independent.cam_verdicts import Limit
from tests.support.independent.cams import FOLLOWERS, OPTIMIZED, cams, moves_of
from tests.support.independent.comparison import Measured
from tests.support.independent.course import Course
from tests.support.independent.drive import Drive
from tests.support.independent.extremes import greatest, least, root
from tests.support.independent.linkages import linkages
from tests.support.independent.mobility import class_of
from tests.support.independent.statements import families
from tests.support.independent.transmission import least_angles

WAVES = ("simple_harmonic", "cycloidal", "double_harmonic", "half_harmonic_start", "half_harmonic_end")
LAWS = sorted({*AT_REST, *POLYNOMIALS, *FAMILY, *MIRRORED, *WAVES, "half_cycloidal_start", "half_cycloidal_end"})


@pytest.mark.parametrize("name", further(LAWS, list(LAWS)[::2]))
def test_the_laws_written_out_are_motions(name: str) -> None:
    """From nothing to one, without a jump, and each derivative that of the one before, between sixteenths."""
    ends = np.arange(17.0) / 16.0
    u = np.linspace(ends[:-1], ends[1:], 1001, axis=1)
    s, v, a, j = law(name, u, np.broadcast_to(u.mean(axis=1, keepdims=True), u.shape))
    assert (s[0, 0], s[-1, -1]) == pytest.approx((0.0, 1.0), abs=1e-12)
    for values in (s, v):
        assert values[1:, 0] == pytest.approx(values[:-1, -1], abs=1e-12)
    step = u[0, 1] - u[0, 0]
    for values, rate in ((s, v), (v, a), (a, j)):
        assert np.gradient(values, step, axis=1)[:, 1:-1] == pytest.approx(rate[:, 1:-1], abs=2e-4)


def test_all_laws_that_can_be_stated_are_written_out() -> None:
    assert {*LAWS, "auto", "optimal"} == set(Law.__args__)


def test_a_polynomial_is_divided_where_it_turns() -> None:
    """u²(1 − u)² rises and falls: v = 0 and s = 1/16 in the middle."""
    rests = [(at, order, 0.0) for at in (0.0, 1.0) for order in (0, 1)]
    move = by_polynomial(0.0, 2.0, [*rests, (0.5, 0, 0.0625)])
    s, v, _, _ = motion_at([move], np.array([0.6]))
    assert (s[0], v[0]) == pytest.approx((0.3**2 * 0.7**2, 0.3 * 0.7 * 0.4))
    assert np.abs(move.v[:, [0, -1]]).min() < 1e-12
    names = ("at", "s", "v", "a", "j")
    across = {name: getattr(move, name)[118:122].reshape(1, -1)[:, ::4] for name in names}
    halves = turned(move._replace(**across))
    assert len(halves.v) == 2
    assert halves.v[:, 20].prod() < 0.0


def test_a_limit_is_exceeded_by_its_sense() -> None:
    assert Limit(30.0, 1).excess(33.0) == pytest.approx(0.1)
    assert Limit(30.0, -1).excess(33.0) == pytest.approx(-0.1)
    assert Limit(0.0, -1).excess(-1e-3) == math.inf


@pytest.mark.parametrize(("unit", "size"), [("cm", 0.1), ("m", 1e-3), ("in", 1.0 / 25.4)])
def test_a_statement_in_other_units_is_the_same_cam(unit: str, size: float) -> None:
    """Of those drawn in millimetres: travel, limits and dimensions have another number, angles the same."""
    drawn = [stated for _, stated in demanding(40, 5) if "length_unit" not in stated]
    for stated in drawn:
        here, there = parse_problem(stated), parse_problem(in_units(stated, unit))
        swings = stated["follower"]["type"].startswith("oscillating")
        assert there.program.travel / here.program.travel == pytest.approx(1.0 if swings else size)
        assert there.limits.pressure_angle == here.limits.pressure_angle
        assert there.limits.min_radius == pytest.approx(here.limits.min_radius * size)
    assert len(drawn) > 10


def test_every_sort_and_criterion_is_stated() -> None:
    drawn = list(demanding(200, 1))
    assert {name for name, _ in drawn} == {name for name, _ in SORTS}
    assert {stated.get("minimize") for _, stated in drawn} == {*CRITERIA, None}
    assert {stated["follower"]["type"] for _, stated in drawn} == set(FOLLOWERS)
    for _, stated in drawn:
        assert parse_problem(stated).find_contradictions() == []


def test_a_table_leaves_out_the_bends_of_a_continuous_jerk() -> None:
    """Of two sines every 3/4°, whose jerk bends where the acceleration is greatest: it was 3e-8 off."""

    def rate(order: int, at: np.ndarray) -> np.ndarray:
        return np.sin(at + order * math.pi / 2.0) + 0.1 * 2.0**order * np.sin(2.0 * at + 1.0 + order * math.pi / 2.0)

    t = np.radians(0.75 * np.arange(480.0))
    s, v, a, j = (rate(order, t) for order in range(4))
    table = SimpleNamespace(angle=np.degrees(t), s=s, v=v, a=a, j=j)
    move = cam_motion.by_table(table, t[10], math.radians(300.0), 1.0, True)
    exact = np.abs(rate(2, np.linspace(t[10], t[410], 1_000_001))).max()
    assert cam_motion.greatest(np.abs(move.a)) == pytest.approx(exact, rel=1e-9)
    for order in range(4):
        assert move.rates(order) == pytest.approx(rate(order, move.at), abs=(1e-11, 1e-10, 1e-9, 1e-6)[order])


def test_peaks_and_means_of_pieces_are_exact() -> None:
    move = by_law("cycloidal", 0.0, math.tau, 0.0, 2.0)
    assert cam_motion.greatest(move.v) == pytest.approx(2.0 / math.pi, rel=1e-12)
    assert cam_motion.least(move.a) == pytest.approx(-1.0 / math.pi, rel=1e-10)
    assert cam_motion.greatest(np.where(move.at > math.pi, move.s, -np.inf)) == pytest.approx(2.0, rel=1e-12)
    assert cam_motion.mean([move], [move.v**2]) == pytest.approx(1.5 / math.pi**2, rel=1e-12)


@pytest.mark.parametrize("end", [0.02, 0.98])
def test_a_peak_beside_the_end_of_a_piece_is_found(end: float) -> None:
    """Between the first two points, or the last two; the next piece begins lower, or the one before ends so."""
    at = np.linspace(0.0, 1.0, cam_motion.POINTS)
    peak = end + math.copysign(0.015, end - 0.5)
    assert cam_motion.greatest((5.0 - (at - peak) ** 2)[None]) == pytest.approx(5.0, abs=1e-14)
    assert cam_motion.greatest((5.0 - (at + 0.1) ** 2)[None]) == 5.0 - 0.1**2


PARALLELOGRAM: dict[str, Any] = {
    "joints": {"O2": [0.0, 0.0], "O4": [4.0, 0.0], "A": [0.0, 2.0], "B": [4.0, 2.0], "P": [2.0, 3.0]},
    "links": [
        {"name": "ground", "joints": ["O2", "O4"]},
        {"name": "input", "joints": ["O2", "A"]},
        {"name": "coupler", "joints": ["A", "B", "P"]},
        {"name": "output", "joints": ["O4", "B"]},
    ],
    "input_link": "input",
}


def test_a_linkage_is_driven_as_its_bars_allow() -> None:
    """A parallelogram: B and P move as A does, and the transmission angle is the crank's own."""
    drive, turns = Drive(Skeleton.model_validate(PARALLELOGRAM)), np.linspace(0.0, 1.0, 200)
    assert drive.follow(0.0, 1.0)
    assert np.abs(drive.joint("B", turns) - (4.0 + 2j * np.exp(1j * turns))).max() < 1e-12
    assert np.abs(drive.joint("P", turns) - (2.0 + 1j + 2j * np.exp(1j * turns))).max() < 1e-12
    assert np.abs(drive.rates_at(turns)[:, drive.names.index("P")] + 2.0 * np.exp(1j * turns)).max() < 1e-11
    assert list(least_angles(drive, 0.0, 1.0).values()) == pytest.approx([90.0 - math.degrees(1.0)])


def test_a_linkage_is_not_driven_beyond_its_toggle() -> None:
    """A triangle that opens: the crank of 2 reaches its limit where coupler and output are in line."""
    stated = PARALLELOGRAM | {"joints": {"O2": [0, 0], "O4": [4, 0], "A": [0, 2], "B": [2, 3], "P": [2, 3]}}
    skeleton = Skeleton.model_validate(stated)
    drive = Drive(skeleton)
    bars = math.hypot(2.0, 1.0) + math.hypot(2.0, 3.0)
    toggle = math.acos((16.0 + 4.0 - bars**2) / 16.0) - 0.5 * math.pi
    assert drive.follow(0.0, toggle - 1e-4)
    assert not drive.follow(0.0, toggle + 1e-4)


def test_a_linkage_keeps_to_its_branch_by_a_change_point() -> None:
    """All but a parallelogram: its other branch comes as near as a thousandth of its size, and is not taken."""
    b = 4.0 + 0.5e-6 + 2j  # a crank that is shorter by a millionth
    stated = PARALLELOGRAM | {"joints": PARALLELOGRAM["joints"] | {"A": [0.0, 2.0 - 1e-6], "B": [b.real, b.imag]}}
    drive, turns = Drive(Skeleton.model_validate(stated)), np.linspace(0.0, math.tau, 5000)
    assert drive.follow(0.0, math.tau)
    z = drive.at(turns)
    a, b_at, o4 = (z[:, drive.names.index(name)] for name in ("A", "B", "O4"))
    sense = (np.conj(b_at - a) * (b_at - o4)).imag
    assert np.all(np.sign(sense) == np.sign(sense[0]))


def test_a_block_and_a_slide_are_driven() -> None:
    """Scott-Russell's slider-crank: P stays on its line, and the crank's end is halfway between P and B."""
    skeleton = Skeleton.model_validate(
        {
            "joints": {"O2": [0.0, 0.0], "A": [0.6, 0.8], "B": [1.2, 0.0], "P": [0.0, 1.6]},
            "links": [
                {"name": "ground", "joints": ["O2"]},
                {"name": "crank", "joints": ["O2", "A"]},
                {"name": "coupler", "joints": ["A", "B", "P"]},
            ],
            "slides": [{"joint": "B", "link": "ground", "point": [1.2, 0.0], "angle": 0.0}],
            "input_link": "crank",
        }
    )
    drive, turns = Drive(skeleton), np.linspace(-0.5, 0.5, 100)
    assert drive.follow(-0.5, 0.5)
    assert np.abs(drive.joint("P", turns).real).max() < 1e-12
    assert least(lambda u: drive.joint("P", u).imag, -0.5, 0.5).value == pytest.approx(
        2.0 * math.sin(math.atan2(0.8, 0.6) - 0.5)
    )


def test_peaks_between_the_steps_are_found() -> None:
    """Of two peaks the higher one lies between two places of the grid."""
    at, value = greatest(lambda x: np.maximum(np.cos(x - 1.2345678), 0.9995 * np.cos(x - 4.0)), 0.0, 6.0, grid=61)
    assert (at, value) == pytest.approx((1.2345678, 1.0), abs=1e-6)
    assert math.isnan(greatest(lambda x: np.where(x > 1.0, np.nan, x), 0.0, 2.0).value)
    assert root(lambda x: np.cos(x), 1.0, 2.0) == pytest.approx(0.5 * math.pi, abs=1e-13)


@pytest.mark.parametrize(
    ("lengths", "motion", "code"),
    [
        ((4.0, 1.0, 3.0, 3.5), "crank_rocker", "GCRR"),
        ((1.0, 4.0, 3.0, 3.5), "double_crank", "GCCC"),
        ((4.0, 3.0, 1.0, 3.5), "double_rocker", "GRCR"),
        ((4.0, 3.0, 3.5, 1.0), "rocker_crank", "GRRC"),
        ((3.0, 5.0, 2.0, 3.5), "rocker_rocker", "RRR2"),
        ((4.0, 2.0, 4.0, 2.0), "change_point", "S"),
    ],
)
def test_links_that_turn_through_tell_the_class(lengths: tuple[float, ...], motion: str, code: str) -> None:
    """Norton, Table 2-4: ground, input, coupler, output."""
    ground, crank, coupler, output = lengths
    # B anywhere at the coupler's length from A and the output's from O4: only the lengths count.
    a, o4 = 0.5j * crank + crank * math.sqrt(0.75), complex(ground)
    reach = abs(o4 - a)
    along = (coupler**2 - output**2 + reach**2) / (2.0 * reach)
    b = a + complex(along, math.sqrt(max(coupler**2 - along**2, 0.0))) * (o4 - a) / reach
    assert class_of(0j, a, b, o4) == (motion, code)


def test_a_course_is_as_wide_as_its_smooth_curve_bulges() -> None:
    """Points of a circle: the spline through them is nearly the circle, whose arc bulges by its sagitta."""
    points = np.exp(1j * np.linspace(0.0, math.tau, 24, endpoint=False))
    course = Course(points, closed=True)
    sagitta = 1.0 - math.cos(math.pi / 24)
    place = np.array([(1.0 + 0.5 * sagitta) * np.exp(1j * math.pi / 24)])
    assert course.distances(place)[0] == pytest.approx(1.5 * sagitta)
    assert course.tolerance_used(place, np.full(24, 0.1))[0] == pytest.approx(5.0 * sagitta, rel=5e-3)
    assert course.beyond_bulges(place, 0.0)[0] < 0.0


def test_a_difference_is_seen() -> None:
    result, design = Measured(), SimpleNamespace(mechanism=SimpleNamespace(type="fourbar"))
    for name, stated in (("off", 1.0 + 2e-6), ("near", 1.0 + 2e-7), ("not stated", None), ("unknown", math.nan)):
        result.beside("motion", design, name).add("metrics.size", stated, 1.0, 1.0)
    result.beside("motion", design, "other").same("metrics.grashof", "crank_rocker", "double_crank")
    assert {difference.name for difference in result.over} == {"off", "unknown", "other"}
    assert "5 designs, 4 comparisons of 2 quantities" in result.report()


@pytest.mark.campaign
@pytest.mark.parametrize("every_demand", [False, True])
def test_cams_of_every_follower_agree(every_demand: bool) -> None:
    result = Measured()
    assert cams(2 * len(FOLLOWERS), 7, result, every_demand) >= (8 if every_demand else 10)
    assert not result.over, result.report()
    assert not result.left, result.report()
    assert len(result.differences) > 40


def optimal_moves(angles: tuple[float, float, float], lift: float, velocity: float, top: float) -> list[dict[str, Any]]:
    """A rise, a rest, a fall and a rest; the rise by a velocity on the way and below the top of a band."""
    angle, rest, fall = angles
    conditions = [{"angle": 0.5 * angle, "s": 0.5 * lift}, {"angle": 0.4 * angle, "v": velocity}]
    band = {"start": 0.2 * angle, "end": 0.3 * angle, "lower": 0.0, "upper": top}
    return [
        {"motion": "rise", "angle": angle, "lift": lift, "law": "optimal", "conditions": conditions, "bands": [band]},
        {"motion": "dwell", "angle": rest},
        {"motion": "fall", "angle": fall, "lift": lift, "law": "optimal"},
        {"motion": "dwell", "angle": 360.0 - sum(angles)},
    ]


FACES: dict[str, dict[str, Any]] = {
    "points as close as rounding": {
        "segments": optimal_moves((98.9, 91.603, 66.734), 15.191, 0.2457593528816987, 6.0764),
        "follower": {"type": "oscillating_flat", "pivot_distance": 180.0, "face_offset": 7.298},
        "limits": {
            "min_radius": 3.0,
            "velocity": 0.5690877214013846,
            "acceleration": 1.7589749642628668,
            "jerk": 11.745951345078108,
        },
        "minimize": "rms_acceleration",
    },
    "a bend beside the sharp end of a plateau": {
        "segments": optimal_moves((129.183, 77.964, 65.686), 26.574, 18.857936970414375, 10.6296),
        "follower": {"type": "translating_flat"},
        "limits": {
            "min_radius": 3.0,
            "velocity": 57.94910805881959,
            "acceleration": 181.96969743848723,
            "jerk": 1234.5378794988455,
        },
        "minimize": "peak_velocity",
    },
}


@pytest.mark.slow
@pytest.mark.parametrize("name", FACES)
def test_radius_and_width_under_a_face_agree(name: str) -> None:
    """The motion's jerk steps so often that its stretches are some thousandths of a radian."""
    stated, result = {"kind": "cam", **FACES[name]}, Measured()
    (design,) = solve(parse_problem(stated)).designs
    beside = result.beside("cam", design, name)
    compare_cam(beside, stated, moves_of(stated, design))
    beside.finish()
    assert not result.over, result.report()
    assert result.differences["cam metrics.face_width"]


QUICK = (
    "three positions",
    "function",
    "pairs",
    "quick return",
    "straight line",
    "steering",
    "parallel motion",
    "output slides in the body",
    "output slides",
    "input slides",
    "input is driven",
    "coupler is driven",
    "sides",
    "timed path",
    "tolerated path",
    "path with a stance",
    "functions",
    "body on a rocker",
    "demands of a line",
    "demands of steering",
    "parallel motion along a path",
    "positions",
)
"""Families whose answers take a second or two each."""

QUICKEST = [
    name
    for name in QUICK
    if name
    not in (
        "functions",
        "tolerated path",
        "path with a stance",
        "input is driven",
        "coupler is driven",
        "demands of a line",
        "positions",
        "parallel motion along a path",
        "timed path",
        "demands of steering",
        "parallel motion",
    )
]


@pytest.mark.slow
@pytest.mark.parametrize("name", further(QUICK, QUICKEST))
def test_a_family_agrees(name: str) -> None:
    result = Measured()
    assert linkages(3, (name,), 3, result, most=3)
    assert not result.over, result.report()
    assert not result.left, result.report()
    assert len(result.differences) >= 15


@pytest.mark.campaign
@pytest.mark.parametrize("name", ["dwell", "two dwells"])
def test_a_rest_agrees(name: str) -> None:
    """What the output moves, and for how long it keeps within the tolerance, between all steps."""
    result = Measured()
    assert linkages(1, (name,), 1, result, most=1)
    assert result.differences["dwell targets.width"]
    assert not result.over, result.report()
    assert not result.left, result.report()


@pytest.mark.campaign
def test_cognates_agree_where_two_points_are_met_at_one_place() -> None:
    """Two of the noisy points are nearest to one place of the curve: the cognate passes them in order all the same."""
    result = Measured()
    assert linkages(1, ("closed_curves",), 1, result) == 1
    assert result.differences["path cognates.visits_in_order"]
    assert not result.over, result.report()


SMALLER = {"min_radius", "min_convex_radius", "min_concave_radius", "curvature_ratio"}
"""What is on the safe side where it is stated too small."""


@pytest.mark.campaign
@pytest.mark.timeout(900)
@pytest.mark.parametrize("every_demand", [False, True])
def test_many_cams_agree(every_demand: bool) -> None:
    result = Measured()
    count = sampled(200)
    assert cams(count, 11, result, every_demand) >= (0.8 if every_demand else 0.9) * count
    lawful = [d for d in result.over if not d.name.endswith(OPTIMIZED)]
    assert not [d for d in lawful if not every_demand or d.value > 3e-6], result.report()
    assert not result.left, result.report()
    # Of optimized motions, whose jerk steps at hundreds of angles, curvature and width may err to the safe side.
    for difference in result.over:
        quantity = difference.metric.rpartition(".")[2]
        assert quantity in {*SMALLER, "face_width"}, difference
        assert (difference.stated < difference.found) == (quantity in SMALLER), difference
        assert difference.value < 0.03, difference


@pytest.mark.campaign
@pytest.mark.timeout(900)
@pytest.mark.parametrize("name", [family.name for family in families()])
def test_many_linkages_agree(name: str) -> None:
    result = Measured()
    linkages(sampled(12), (name,), 11, result, most=3)
    assert not result.over, result.report()
    assert not result.left, result.report()
