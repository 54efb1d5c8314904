"""Geneva drives: values of the literature, laws of the closed forms, and a proof that notices what is changed."""

from __future__ import annotations

import cmath
import itertools
import math
from typing import Any

import numpy as np
import pytest

from kinematics.indexing.drag_link import CrankCourse, DragLink
from kinematics.indexing.geneva import Drive, Geneva
from kinematics.indexing.ratchet import Ratchet
from kinematics.linkage.planar.catalogue import make_quick_return
from kinematics.linkage.planar.drive import drive as core_drive
from synthesis.dispatch import solve
from synthesis.kinds.indexing.forces import Load, find_peaks
from synthesis.kinds.indexing.plane import compute_margins
from synthesis.kinds.indexing.verification.ratchet import verify_ratchet
from synthesis.kinds.indexing.verification.verify import verify_indexing
from synthesis.registry import list_examples, parse_problem
from tests.campaign import further

DRIVES: tuple[Drive, ...] = ("geneva_external", "geneva_internal", "geneva_spherical")

# The handbooks' table of external drives by stations (Johnson 1956, Rothbart 1956, reprinted since): index (degrees of
# the crank), greatest velocity and acceleration, and the acceleration as the roller enters; per radian of the crank.
# Of 3 stations 31.44 and of 4 stations 5.409 are printed, where the closed forms have 31.392 and 5.407.
EXTERNAL = [
    (3, 60.0, 6.46, 31.44, 1.732),
    (4, 90.0, 2.41, 5.409, 1.000),
    (5, 108.0, 1.43, 2.299, 0.727),
    (6, 120.0, 1.00, 1.350, 0.577),
    (7, 128.57, 0.766, 0.928, 0.482),
    (8, 135.0, 0.620, 0.700, 0.414),
    (9, 140.0, 0.520, 0.559, 0.364),
    (10, 144.0, 0.447, 0.465, 0.325),
    (11, 147.27, 0.392, 0.398, 0.294),
    (12, 150.0, 0.349, 0.348, 0.268),
]

# The same of internal drives: greatest velocity λ/(1 + λ), acceleration tan(π/n), at the ends.
INTERNAL = [
    (3, 300.0, 0.464, 1.732),
    (4, 270.0, 0.414, 1.000),
    (5, 252.0, 0.370, 0.727),
    (6, 240.0, 0.333, 0.577),
    (8, 225.0, 0.277, 0.414),
    (10, 216.0, 0.236, 0.325),
    (12, 210.0, 0.206, 0.268),
]


def solved(**changes: Any) -> Any:
    base = {"kind": "indexing", "drive": "geneva_external", "stations": 6, "roller_diameter": 10.0, "speed_rpm": 60.0}
    return solve(parse_problem(base | changes), lambda fraction, message: None)


def at(drive: Geneva, angle: float) -> Any:
    return drive.motion(np.array(angle))


@pytest.mark.parametrize(("stations", "index", "velocity", "acceleration", "entry"), EXTERNAL)
def test_published_external_drives(
    stations: int, index: float, velocity: float, acceleration: float, entry: float
) -> None:
    drive = Geneva.shock_free("geneva_external", stations)
    assert math.degrees(2.0 * drive.half) == pytest.approx(index, abs=0.005)
    assert float(at(drive, 0.0).v) == pytest.approx(velocity, abs=0.005 if velocity > 1.0 else 5.1e-4)
    peak = abs(float(at(drive, drive.peak_angle).a))
    assert peak == pytest.approx(acceleration, rel=2e-3 if stations < 5 else 1e-3)
    assert float(at(drive, -drive.half).a) == pytest.approx(entry, abs=5.1e-4)
    assert float(at(drive, 0.0).a) == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize(("stations", "index", "velocity", "acceleration"), INTERNAL)
def test_published_internal_drives(stations: int, index: float, velocity: float, acceleration: float) -> None:
    drive = Geneva.shock_free("geneva_internal", stations)
    assert math.degrees(2.0 * drive.half) == pytest.approx(index, abs=0.005)
    assert float(at(drive, 0.0).v) == pytest.approx(velocity, abs=5.1e-4)
    assert abs(float(at(drive, drive.peak_angle).a)) == pytest.approx(acceleration, abs=5.1e-4)
    assert drive.peak_angle == drive.half


def test_four_stations_as_textbooks_have_them() -> None:
    # Norton, Design of Machinery, section 3.10; the middle's jerk is -sqrt2 (4 + ...) = -48.04.
    drive = Geneva.shock_free("geneva_external", 4)
    assert float(at(drive, 0.0).v) == pytest.approx(1.0 + math.sqrt(2.0), rel=1e-12)
    assert math.degrees(drive.peak_angle) == pytest.approx(11.0 + 28.0 / 60.0, abs=0.01)
    assert float(at(drive, 0.0).j) == pytest.approx(-48.04, abs=5e-3)


@pytest.mark.parametrize("drive", DRIVES)
@pytest.mark.parametrize("stations", further(range(3, 13), [3, 4, 7, 12]))
def test_closed_forms_are_the_derivatives_of_the_geometry(drive: Drive, stations: int) -> None:
    form = Geneva.shock_free(drive, stations)
    # Differentiated by Chebyshev's polynomials on short pieces, where rounding leaves third derivatives ten digits.
    for centre in np.linspace(-0.9, 0.9, 7) * form.half:
        width = 0.12 * form.half
        nodes = np.cos(np.pi * (np.arange(24) + 0.5) / 24)
        alpha = centre + width * nodes
        if drive == "geneva_spherical":
            cone = math.pi / stations
            place = math.cos(cone) + 1j * math.sin(cone) * np.sin(alpha)
        else:
            side = -1.0 if drive == "geneva_external" else 1.0
            place = 1.0 + side * math.sin(math.pi / stations) * np.exp(1j * alpha)
        turned = np.angle(place) * (-1.0 if drive == "geneva_external" else 1.0)
        fitted = np.polynomial.Chebyshev.fit(alpha, turned, 16, domain=[centre - width, centre + width])
        found = at(form, float(centre))
        size = max(1.0, float(abs(found.j)))
        assert fitted(centre) == pytest.approx(float(found.s), abs=1e-12)
        assert fitted.deriv(1)(centre) == pytest.approx(float(found.v), rel=1e-9, abs=1e-10)
        assert fitted.deriv(2)(centre) == pytest.approx(float(found.a), rel=1e-8, abs=1e-8 * size)
        assert fitted.deriv(3)(centre) == pytest.approx(float(found.j), rel=1e-6, abs=1e-6 * size)


@pytest.mark.parametrize("stations", [3, 4, 5, 6, 8, 12])
def test_a_driven_slotted_link_is_an_external_drive(stations: int) -> None:
    """The roller in its slot is an inverted slider: the analysis core drives one with the same crank and ground."""
    drive = Geneva.shock_free("geneva_external", stations)
    ratio = drive.ratio
    # A crank shaper with its crank at 1 and its link about 0; its ram is not looked at.
    alpha = np.linspace(-0.95, 0.95, 65) * drive.half
    mechanism = make_quick_return(1.0 + 0j, 0j, ratio, 2.0, 9.0, 1.0j, 0.0, math.pi + float(alpha[0]))
    moved = core_drive(mechanism, math.pi + alpha)
    assert moved.valid.all()
    link = moved.angles["rocker"]
    found = drive.motion(alpha)
    for order, told in enumerate(found):
        off = -(link[order] - link[order, 32] * (order == 0)) - told
        assert np.abs(off).max() < 1e-9 * max(1.0, np.abs(told).max())


@pytest.mark.parametrize("drive", DRIVES)
def test_a_turn_of_the_crank_is_one_station_for_each_roller(drive: Drive) -> None:
    form = Geneva.shock_free(drive, 5)
    rollers = 3 if drive == "geneva_external" else 1
    turned = form.wheel_motion(np.array([0.0, 2.0 * math.pi, 20.0 * math.pi]), rollers)
    assert turned.s == pytest.approx(np.array([0.0, 1.0, 10.0]) * rollers * 2.0 * math.pi / 5.0)
    resting = form.wheel_motion(np.array([2.0 * form.half + 0.01]), rollers)
    assert (float(resting.v[0]), float(resting.a[0])) == (0.0, 0.0)


@pytest.mark.slow
@pytest.mark.parametrize(
    "example", [one for one in list_examples("indexing") if one["drive"] != "ratchet" and "driver" not in one]
)
def test_a_changed_dimension_is_noticed(example: dict[str, Any]) -> None:
    problem = parse_problem(example)
    design = solve(problem, lambda fraction, message: None).designs[0]
    assert verify_indexing(problem, design).verification.passed
    mechanism = design.mechanism
    changes: list[tuple[str, dict[str, Any]]] = [
        ("roller_in_slot", {"roller_diameter": 1.05 * mechanism.roller_diameter})
    ]
    if mechanism.type == "geneva_spherical":
        changes += [
            ("reaches_next_station", {"cone_angle": mechanism.cone_angle + 0.01}),
            ("disc_clears_wheel", {"cap_offset": 0.0}),
            ("wall", {"locking_arc_angle": mechanism.locking_arc_angle + 0.5}),
        ]
    else:
        disc = mechanism.disc
        larger = disc.model_copy(update={"outer_radius": [1.02 * radius for radius in disc.outer_radius]})
        profile = mechanism.profile
        thinner = profile.model_copy(update={"y": [1.01 * y for y in profile.y]})
        changes += [
            ("reaches_next_station", {"crank_radius": 1.0001 * mechanism.crank_radius}),
            ("disc_clears_wheel", {"disc": larger}),
            ("walls_as_told", {"profile": thinner}),
        ]
    for name, change in changes:
        broken = design.model_copy(update={"mechanism": mechanism.model_copy(update=change)})
        failed = [check.name for check in verify_indexing(problem, broken).verification.checks if not check.passed]
        assert name in failed, (name, failed)


@pytest.mark.slow
def test_forces_that_are_told_wrong_are_noticed() -> None:
    problem = parse_problem(list_examples("indexing")[0])
    design = solve(problem, lambda fraction, message: None).designs[0]
    doubled = design.course.model_copy(update={"pin_force": [2.0 * force for force in design.course.pin_force]})
    peaky = design.metrics.model_copy(update={"peak_pin_force": 0.99 * design.metrics.peak_pin_force})
    for change, name in (({"course": doubled}, "forces_by_reactions"), ({"metrics": peaky}, "peaks")):
        checked = verify_indexing(problem, design.model_copy(update=change))
        assert name in [check.name for check in checked.verification.checks if not check.passed]


def test_the_smallest_drive_stands_at_its_demand() -> None:
    wanted = {"stations": 8, "wall_thickness": 4.0, "wheel_shaft_diameter": 25.0, "rollers": 1}
    design = solved(**wanted).designs[0]
    assert design.verification.passed
    assert design.metrics.sized_by in ("locking_disc", "web", "bore")
    problem = parse_problem(
        {**wanted, "kind": "indexing", "drive": "geneva_external", "roller_diameter": 10.0, "speed_rpm": 60.0}
    )
    drive = Geneva.shock_free("geneva_external", 8)
    size = design.mechanism.center_distance
    assert min(compute_margins(problem, drive, 1.000001 * size).values()) > 0.0
    assert min(compute_margins(problem, drive, 0.99999 * size).values()) < 0.0


def test_a_pin_force_sets_the_size_and_is_met() -> None:
    (design,) = solved(load_inertia=0.05, rollers=1, constraints={"pin_force": 20.0}).designs
    assert design.metrics.sized_by == "pin_force"
    assert design.metrics.peak_pin_force == pytest.approx(20.0, rel=1e-9)
    load, drive = Load(0.05, 0.0, 2.0 * math.pi), Geneva.shock_free("geneva_external", 6)
    assert find_peaks(CrankCourse(drive), load, 1.0).pin_force / 20.0 == pytest.approx(
        design.mechanism.center_distance / 1000.0
    )


def test_rollers_shorten_the_rest() -> None:
    result = solved(stations=4, center_distance=100.0)
    assert [design.mechanism.rollers for design in result.designs] == [1, 2, 3]
    assert [design.dwell_share for design in result.designs] == pytest.approx([0.75, 0.5, 0.25])
    assert result.search.complete


def test_an_entry_with_a_shock_is_refused_unless_it_is_allowed() -> None:
    wanted = {"center_distance": 80.0, "crank_radius": 41.0, "wall_thickness": 2.0, "rollers": 1}
    wanted |= {"clearances": {"slot": 0.3}}
    refused = solved(**wanted)
    assert not refused.designs
    assert refused.search.rejected == {"shock_free_entry": 1}
    (design,) = solved(**wanted, constraints={"shock_free": False}).designs
    assert design.metrics.entry_speed > 0.01
    # tan of the angle between slot and the roller's path, by the sine rule.
    assert design.index_angle < 120.0


RATCHET: dict[str, Any] = {
    "kind": "indexing",
    "drive": "ratchet",
    "stations": 36,
    "wall_thickness": 5.0,
    "load_torque": 40.0,
}


def ratchets(**changes: Any) -> Any:
    return solve(parse_problem(RATCHET | changes), lambda fraction, message: None)


def test_teeth_and_pawls_that_give_the_stops() -> None:
    found = [(one.mechanism.teeth, len(one.mechanism.pawls)) for one in ratchets().designs]
    assert found == [(36, 1), (18, 2), (12, 3)]
    shared = [(one.mechanism.teeth, len(one.mechanism.pawls)) for one in ratchets(pawls={"overlap": 2}).designs]
    assert shared == [(36, 2), (18, 4), (12, 6)]
    halved = ratchets(pawls={"overlap": 2, "wheel_radius": 60.0}).designs[0].metrics.tooth_force
    assert 2.0 * halved == pytest.approx(ratchets(pawls={"wheel_radius": 60.0}).designs[0].metrics.tooth_force)


def test_a_ratchet_locks_where_its_face_leans_over_enough() -> None:
    (straight, *_) = ratchets(include_failed=True, pawls={"face_angle": 5.0, "friction": 0.15}).designs
    failed = [check.name for check in straight.verification.checks if not check.passed]
    assert failed == ["locking_angle"]
    (sought, *_) = ratchets(pawls={"friction": 0.15, "reserve": 0.0}).designs
    assert sought.metrics.locking_angle == pytest.approx(math.degrees(math.atan(0.15)), abs=1e-9)
    # By the statics of a pawl that is about to slide out: the friction that holds it just holds it.
    wheel = Ratchet(36, 50.0, 3.0, math.radians(14.0), 50.0)
    mu = math.tan(wheel.locking_angle)
    normal, outward = -1j * cmath.exp(-1j * wheel.face), cmath.exp(-1j * wheel.face)
    force = normal + mu * outward
    moment = ((wheel.tip - wheel.pivot).conjugate() * force).imag
    assert moment == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("count", [1, 2, 3])
def test_a_changed_ratchet_is_noticed(count: int) -> None:
    problem = parse_problem(RATCHET | {"pawls": {"count": count}, "wheel_shaft_diameter": 20.0})
    (design,) = solve(problem, lambda fraction, message: None).designs
    assert design.verification.passed
    mechanism = design.mechanism
    moved = mechanism.pawls[-1].model_copy(
        update={"nose": (mechanism.pawls[-1].nose[0] + 0.01, mechanism.pawls[-1].nose[1])}
    )
    profile = mechanism.profile
    changes: list[tuple[str, dict[str, Any]]] = [
        ("equal_stops", {"pawls": [*mechanism.pawls[:-1], moved]}),
        ("equal_stops", {"profile": profile.model_copy(update={"y": [1.001 * y for y in profile.y]})}),
        ("pawl_rides", {"pawl_length": 1.1 * mechanism.pawl_length}),
        ("pawls_at_every_stop", {"overlap": 2}),
    ]
    for name, change in changes:
        broken = design.model_copy(update={"mechanism": mechanism.model_copy(update=change)})
        failed = [check.name for check in verify_ratchet(problem, broken).verification.checks if not check.passed]
        assert name in failed, (name, failed)


def test_a_pawl_falls_behind_each_tooth() -> None:
    wheel = Ratchet(24, 50.0, 4.0, math.radians(15.0), 40.0)
    angle = wheel.overtravel + wheel.pitch * np.array([1e-9, 0.5, 1.0 - 1e-9, 1.0 + 1e-9])
    low, half, high, fallen = wheel.pawl_lift(angle)
    assert high == pytest.approx(wheel.lift, abs=1e-6)
    assert low == pytest.approx(fallen, abs=1e-6)
    assert low < half < high


@pytest.fixture(scope="module")
def dragged() -> Any:
    problem = parse_problem(next(one for one in list_examples("indexing") if one.get("driver") == "drag_link"))
    return problem, solve(problem, lambda fraction, message: None).designs[0]


def test_a_drag_link_lowers_the_peak_acceleration(dragged: Any) -> None:
    _, design = dragged
    assert design.verification.passed
    assert design.metrics.peak_acceleration < 0.25 * 5.407
    assert design.metrics.min_transmission_angle >= 40.0
    assert design.dwell_share >= 0.6
    assert design.program.s[-1] == pytest.approx(90.0, abs=1e-9)


def test_a_changed_drag_link_is_noticed(dragged: Any) -> None:
    problem, design = dragged
    link = design.mechanism.drag_link
    for name, change in (
        ("program_is_driven", {"coupler": 1.001 * link.coupler}),
        ("reaches_next_station", {"entry_angle": link.entry_angle + 0.1}),
        ("program_is_driven", {"crank_offset": link.crank_offset + 0.1}),
    ):
        changed = design.mechanism.model_copy(update={"drag_link": link.model_copy(update=change)})
        checked = verify_indexing(problem, design.model_copy(update={"mechanism": changed}))
        assert name in [check.name for check in checked.verification.checks if not check.passed]


def test_a_drag_link_is_differentiated_and_turns_through() -> None:
    link = DragLink(2.0, 1.8, 2.2)
    angle = np.linspace(0.0, 2.0 * math.pi, 4001)
    moved = link.output_motion(angle)
    assert moved.s[-1] - moved.s[0] == pytest.approx(2.0 * math.pi)
    for value, rate in itertools.pairwise(moved):
        assert np.gradient(value, angle)[1:-1] == pytest.approx(rate[1:-1], abs=1e-4)
    assert float(link.output_motion(np.array(link.find_input_angle(1.0))).s) == pytest.approx(1.0, abs=1e-14)


def test_no_room_for_walls() -> None:
    result = solved(stations=24, center_distance=40.0)
    assert not result.designs
    assert result.search.rejected == {"no_room_for_walls": 2}


@pytest.mark.parametrize("drive", further(DRIVES, DRIVES[1:2]))
def test_slots_wider_than_the_wheel_are_no_drive(drive: str) -> None:
    size = {"sphere_radius": 5.0} if drive == "geneva_spherical" else {"center_distance": 8.0}
    result = solved(drive=drive, stations=5, clearances={"slot": 30.0}, **size)
    assert not result.designs
    assert result.search.rejected.keys() == {"no_room_for_walls"}


@pytest.mark.slow
def test_a_crescent_is_as_thick_as_a_wall_at_a_stated_size() -> None:
    thin = solved(drive="geneva_internal", center_distance=44.0, wall_thickness=5.0)
    assert not thin.designs
    assert thin.search.rejected == {"crescent": 1}
    smallest = solved(drive="geneva_internal", wall_thickness=5.0).designs[0]
    assert smallest.metrics.sized_by == "crescent"
    disc = smallest.mechanism.disc
    assert min(np.subtract(disc.outer_radius, disc.inner_radius)) == pytest.approx(5.0, rel=1e-6)


@pytest.mark.slow
def test_a_wheel_that_rattles_in_its_disc_is_not_held() -> None:
    wanted = {"center_distance": 80.0, "roller_diameter": 12.0, "rollers": 1}
    loose = solved(**wanted, clearances={"locking": 16.0})
    assert not loose.designs
    assert loose.search.rejected == {"play": 1}
    assert not loose.search.complete
    (tight,) = solved(**wanted, clearances={"locking": 1.0}).designs
    assert 0.5 < tight.metrics.play < 1.0
    # A small disc may fit into a slot; the wheel is held before.
    (small,) = solved(stations=8, rollers=1).designs
    assert small.metrics.sized_by == "locking_disc"
    assert small.metrics.play < 1e-3


@pytest.mark.slow
@pytest.mark.parametrize("drive", ["geneva_external", "geneva_spherical"])
def test_no_size_below_the_smallest_is_taken(drive: str) -> None:
    spherical = drive == "geneva_spherical"
    wanted = {"drive": drive, "stations": 4 if spherical else 8, "rollers": 1}
    (smallest,) = solved(**wanted).designs
    assert smallest.metrics.sized_by == "locking_disc"
    name = "sphere_radius" if spherical else "center_distance"
    least = getattr(smallest.mechanism, name)
    below = solved(**wanted, **{name: 0.999 * least})
    assert not below.designs
    assert below.search.rejected == {"locking_cap" if spherical else "locking_disc": 1}
    assert solved(**wanted, **{name: least * (1.0 + 1e-9)}).designs


def test_a_stated_face_angle_sets_the_size_at_which_it_locks() -> None:
    pawls = {"count": 1, "face_angle": 15.0, "tooth_height": 10.0}
    (design,) = ratchets(wall_thickness=2.0, load_torque=10.0, pawls=pawls).designs
    assert design.metrics.sized_by == "locking_angle"
    assert design.metrics.locking_angle == pytest.approx(design.metrics.friction_angle + 2.0, abs=1e-6)
    smaller = pawls | {"wheel_radius": 0.99 * design.mechanism.wheel_radius}
    assert not ratchets(wall_thickness=2.0, load_torque=10.0, pawls=smaller).designs


def test_a_height_that_is_chosen_proves_nothing() -> None:
    wanted = {"wall_thickness": 4.0, "wheel_shaft_diameter": 90.0}
    high = ratchets(**wanted, pawls={"count": 1, "wheel_radius": 50.0})
    assert not high.designs
    assert not high.search.complete
    assert high.summary.startswith("None found")
    assert ratchets(**wanted, pawls={"count": 1, "wheel_radius": 50.0, "tooth_height": 0.9}).designs


@pytest.mark.slow
def test_a_roller_that_enters_obliquely_needs_a_wide_slot() -> None:
    wanted = {"stations": 4, "center_distance": 100.0, "crank_radius": 85.0, "roller_diameter": 12.0}
    wanted |= {"constraints": {"shock_free": False}}
    struck = solved(**wanted, rollers=1)
    assert not struck.designs
    assert struck.search.rejected == {"roller_clears_wheel": 1}
    # 3/100 of a radian before it enters, beside the wheel at rest, by hand.
    (design,) = solved(**wanted, rollers=1, include_failed=True).designs
    mechanism = design.mechanism
    half = 0.5 * math.radians(design.index_angle)
    slot = cmath.phase(100.0 - 85.0 * cmath.exp(1j * half))
    place = (100.0 - 85.0 * cmath.exp(1j * (half + 0.03))) * cmath.exp(-1j * slot)
    outline = np.array(mechanism.profile.x) + 1j * np.array(mechanism.profile.y)
    assert np.abs(outline - place).min() < 5.2
    wide = solved(**wanted, clearances={"slot": 2.3})
    # The index is short, so that more rollers than of a drive without shock leave a rest.
    assert [one.mechanism.rollers for one in wide.designs] == [1, 2, 3, 4, 5]
    assert wide.designs[3].dwell_share == pytest.approx(1.0 - 4.0 * 22.587 / 360.0, abs=1e-4)


@pytest.mark.slow
def test_a_crank_typed_with_six_digits_enters_without_shock() -> None:
    for typed in (70.7107, 70.7106):
        (design,) = solved(stations=4, center_distance=100.0, crank_radius=typed, rollers=1).designs
        assert design.mechanism.crank_radius == pytest.approx(100.0 * math.sqrt(0.5), rel=1e-12)
    other = solved(stations=4, center_distance=100.0, crank_radius=70.72, rollers=1)
    assert not other.designs


def broken_by(problem: Any, design: Any, part: str, change: dict[str, Any]) -> set[str]:
    verify = verify_ratchet if problem.drive == "ratchet" else verify_indexing
    changed = design.model_copy(update={part: getattr(design, part).model_copy(update=change)})
    return {check.name for check in verify(problem, changed).verification.checks if not check.passed}


@pytest.mark.slow
def test_what_is_told_is_measured_again() -> None:
    base = {"kind": "indexing", "drive": "geneva_internal", "stations": 4, "roller_diameter": 10.0, "speed_rpm": 60.0}
    problem = parse_problem(base | {"constraints": {"steady_share": 0.2}})
    design = solve(problem, lambda fraction, message: None).designs[0]
    share = design.metrics.steady_share
    assert broken_by(problem, design, "metrics", {"steady_share": share + 0.01}) == {"steady_as_told"}
    thin = design.mechanism.ring_radius - 1.0
    assert broken_by(problem, design, "mechanism", {"ring_radius": thin}) == {"ring", "size_as_told"}
    demanding = parse_problem(base | {"constraints": {"steady_share": share + 0.01}})
    lying = design.model_copy(update={"metrics": design.metrics.model_copy(update={"steady_share": 0.9})})
    failed = {check.name for check in verify_indexing(demanding, lying).verification.checks if not check.passed}
    assert failed == {"steady_as_told", "steady_share"}
    problem = parse_problem(RATCHET)
    design = solve(problem, lambda fraction, message: None).designs[0]
    assert broken_by(problem, design, "metrics", {"lift": 1.01 * design.metrics.lift}) == {"lift_as_told"}
    assert "overtravel_as_told" in broken_by(
        problem, design, "metrics", {"overtravel": 0.9 * design.metrics.overtravel}
    )


def test_the_profile_of_a_hemisphere_is_what_its_bore_is_measured_on() -> None:
    problem = parse_problem(next(one for one in list_examples("indexing") if one["drive"] == "geneva_spherical"))
    design = solve(problem, lambda fraction, message: None).designs[0]
    profile = design.mechanism.profile
    deeper = profile.model_copy(update={"x": [0.5 * x for x in profile.x], "y": [0.5 * y for y in profile.y]})
    assert "bore" in broken_by(problem, design, "mechanism", {"profile": deeper})
