"""Trains whose stages are stated one by one: against a brute force, and by what gears of each type have to do."""

from __future__ import annotations

import itertools
import math
from fractions import Fraction
from typing import Any

import numpy as np
import pytest

from kinematics.gear.bevel import BevelCones
from kinematics.gear.train import OrdinaryTrain, TrainStage
from kinematics.gear.worm import WormDrive
from synthesis.analyses import parse_request
from synthesis.dispatch import solve
from synthesis.kinds.gear_train.verification import verify
from synthesis.mechanisms.base import MechanismError
from synthesis.registry import parse_problem
from tests.campaign import sampled
from tests.support.independent import typed_trains
from tests.support.problems.gears import compare_typed
from tests.support.synthesis.typed_trains import BEVEL, HELICAL, INTERNAL, Statement, faults, solved, stated

WORM: Statement = {"type": "worm", "driver": 2, "driven": 40}


@pytest.mark.slow
def test_a_brute_force_finds_the_same() -> None:
    tasks = typed_trains.statements(60, 5)
    small = [
        one for one in tasks if math.prod(len(typed_trains.allowed(one, k)) for k in range(len(one["stages"]))) < 2e4
    ]
    found = compare_typed(small)
    assert found.faults == []
    assert found.some >= 12


@pytest.mark.campaign
@pytest.mark.timeout(3600)
def test_a_brute_force_finds_the_same_in_many_tasks() -> None:
    count = sampled(200)
    found = compare_typed(typed_trains.statements(count, 0))
    assert found.faults == []
    assert found.some > 0.5 * count
    # About one task in twenty has no train.
    assert found.none > 0 or count < 100


def test_the_brute_force_tells_a_difference() -> None:
    statement = typed_trains.statements(1, 3)[0]
    best = typed_trains.nearest(statement)
    assert best is not None
    answer = solve(parse_problem(statement), lambda fraction, message: None).model_dump()
    assert typed_trains.same_answer(answer, best) is None
    assert typed_trains.same_answer(answer, best._replace(ties=best.ties + 1)) is not None
    assert typed_trains.same_answer(answer, best._replace(ratio=-best.ratio)) is not None
    assert typed_trains.same_answer(answer, None) is not None


def test_a_ring_keeps_the_direction() -> None:
    outside, inside = solved({"type": "external"}, ratio="-4").designs[0], solved(INTERNAL, ratio="4").designs[0]
    for design, way in ((outside, "opposite"), (inside, "same")):
        assert design.metrics.shafts is not None
        assert [shaft.turns for shaft in design.metrics.shafts] == ["same", way]
        assert design.metrics.shafts[-1].axis is None
    assert faults({"type": "external"}, ratio="4", direction="same") == ["/direction"]
    assert faults(INTERNAL, ratio="-4") == ["/ratio"]
    assert faults(INTERNAL, {"type": "external"}, INTERNAL, ratio="-4") == []


@pytest.mark.parametrize("ratio", ["35/18", "2", "40/21", "8/3", "3"])
@pytest.mark.parametrize("ring", ["driver", "driven"])
def test_rings_are_as_a_pair_tells_them(ring: str, ratio: str) -> None:
    """Every internal stage that is answered is sound as a `gear_pair`, and shortened no more than that takes."""
    asked = str(1 / Fraction(ratio)) if ring == "driver" else ratio
    result = solved(INTERNAL | {"ring": ring}, ratio=asked, teeth={"min": 18, "max": 70}, max_designs=20)
    assert len(result.designs) > 5
    for design in result.designs:
        stage = design.mechanism.stages[0]
        assert (stage.driver > stage.driven) == (ring == "driver")
        assert stage.addendum is not None
        addenda = sorted((stage.addendum.driver, stage.addendum.driven))[::-1]
        pair: Statement = {
            "type": "gear_pair",
            "teeth": sorted((stage.driver, stage.driven)),
            "internal": True,
            "addendum": addenda,
        }
        told = parse_request({"mechanism": pair}).build_answer()
        assert told["sound"]
        assert told["contact_ratio"] == pytest.approx(design.metrics.meshes[0].contact_ratio, rel=1e-12)
        if addenda[1] < 1.0:
            longer = {**pair, "addendum": [addenda[0], addenda[1] + 2e-6]}
            assert not parse_request({"mechanism": longer}).build_answer()["sound"]


def test_rings_hardly_larger_than_their_pinions_are_left_out() -> None:
    """A difference of teeth at which tips would foul is no stage, however near its ratio is."""
    beyond = solved(INTERNAL, ratio="1.05", teeth={"min": 30, "max": 60})
    assert beyond.designs == []
    assert "out of reach" in beyond.summary
    result = solved(INTERNAL, ratio="1.05", teeth={"min": 30, "max": 60}, tolerance=0.2, max_designs=10)
    least = min(design.mechanism.stages[0].driven - design.mechanism.stages[0].driver for design in result.designs)
    assert 5 <= least <= 9
    fouling = {"type": "gear_pair", "teeth": [40, 42], "internal": True, "addendum": [1.0, 0.9]}
    assert parse_request({"mechanism": fouling}).build_answer()["tips_foul"]


def test_a_helical_stage_is_a_spur_stage_of_its_plane_of_rotation() -> None:
    spur = solved({"type": "external"}, ratio="3", teeth={"min": 20, "max": 60}, module=2.0).designs[0]
    stage = HELICAL | {"face_width": 25.0}
    design = solved(stage, ratio="3", teeth={"min": 20, "max": 60}, module=2.0).designs[0]
    mesh, made = design.metrics.meshes[0], design.mechanism.stages[0]
    assert made.helix_angle == 20.0
    cosine = math.cos(math.radians(20.0))
    assert mesh.centre_distance == pytest.approx(spur.metrics.meshes[0].centre_distance / cosine, rel=1e-12)
    assert mesh.transverse_module == pytest.approx(2.0 / cosine)
    assert mesh.overlap_ratio == pytest.approx(25.0 * math.sin(math.radians(20.0)) / (2.0 * math.pi))
    assert mesh.total_contact_ratio == pytest.approx(mesh.contact_ratio + mesh.overlap_ratio)
    pair = {"type": "gear_pair", "teeth": [made.driver, made.driven], "module": 2.0, "helix_angle": 20.0}
    told = parse_request({"mechanism": pair}).build_answer()
    assert told["contact_ratio"] == pytest.approx(mesh.contact_ratio, rel=1e-12)
    assert told["centre_distance"] == pytest.approx(mesh.centre_distance, rel=1e-12)


def test_helical_gears_may_have_fewer_teeth() -> None:
    """Without a least tooth number it is that of the normal plane: 18 for spur gears, 15 at 20°, 12 at 30°."""
    for angle, least in ((0.0, 18), (20.0, 15), (30.0, 12)):
        stage = HELICAL | {"helix_angle": angle} if angle else {"type": "external"}
        best = solved(stage, ratio=f"{100}/{least}").designs[0]
        assert (best.mechanism.stages[0].driver, best.metrics.meshes[0].undercut) == (least, False)
        fewer = solved(stage, ratio=f"{100}/{least - 1}", teeth={"min": least - 1, "max": 100}).designs[0]
        assert fewer.metrics.meshes[0].undercut


def test_helical_stages_of_one_angle_are_reverted() -> None:
    teeth = {"min": 17, "max": 80}
    stages = HELICAL, HELICAL | {"helix_angle": -20.0}
    both = solved(*stages, ratio="9", reverted=True, teeth=teeth, max_designs=5)
    spur = solved({"type": "external"}, {"type": "external"}, ratio="9", reverted=True, teeth=teeth, max_designs=5)
    assert both.designs[0].metrics.relative_error == spur.designs[0].metrics.relative_error
    unlike = solved(HELICAL, {"type": "external"}, ratio="9", reverted=True, teeth=teeth, tolerance=0.01)
    assert unlike.designs == []
    assert unlike.search.complete


def test_stages_alike_are_those_of_a_number_of_stages() -> None:
    """Two external stages are the trains of two stages that `max_stages` gives, , by the same ranking."""
    fields: Statement = {"ratio": "pi", "teeth": {"min": 15, "max": 50}, "max_designs": 8}
    typed = solved({"type": "external"}, {"type": "external"}, **fields)
    plain = solve(parse_problem({"kind": "gear_train", "max_stages": 2, **fields}), lambda fraction, message: None)
    numbers = [
        [sorted((stage.driver, stage.driven) for stage in design.mechanism.stages) for design in result.designs]
        for result in (typed, plain)
    ]
    assert numbers[0] == [meshes for meshes in numbers[1] if len(meshes) == 2]


def test_the_order_of_stages_is_kept() -> None:
    one = solved(INTERNAL, {"type": "external"}, ratio="12").designs[0]
    other = solved({"type": "external"}, INTERNAL, ratio="12").designs[0]
    assert [stage.type for stage in one.mechanism.stages] == ["internal", "external"]
    assert [stage.type for stage in other.mechanism.stages] == ["external", "internal"]
    assert one.metrics.total_teeth == other.metrics.total_teeth


@pytest.mark.parametrize(
    "change",
    [
        {"type": "external"},
        {"helix_angle": -20.0},
        {"helix_angle": 21.0},
        {"driver": 19},
    ],
)
def test_verification_refuses_another_stage(change: Statement) -> None:
    problem = stated(HELICAL, INTERNAL, ratio="9")
    made = solve(problem, lambda fraction, message: None).designs[0].mechanism
    assert verify(problem, made).verification.passed
    first = made.stages[0].model_copy(update=change)
    found = verify(problem, made.model_copy(update={"stages": [first, *made.stages[1:]]}))
    assert not found.verification.passed


def test_verification_refuses_a_ring_that_does_not_run() -> None:
    problem = stated(INTERNAL, ratio="3")
    made = solve(problem, lambda fraction, message: None).designs[0].mechanism
    stage = made.stages[0]
    assert stage.addendum is not None
    longer = stage.addendum.model_copy(update={"driven": stage.addendum.driven + 0.01})
    found = verify(problem, made.model_copy(update={"stages": [stage.model_copy(update={"addendum": longer})]}))
    assert not found.verification.passed


def contact_velocities(stage: TrainStage) -> tuple[np.ndarray, np.ndarray]:
    """Velocities of driver and driven gear at the pitch point, as bodies that turn about the axes of their shafts.

    The axes are those of the train, the gears placed beside them by lengths alone.
    """
    train = OrdinaryTrain((stage,))
    one, two = train.axes
    speeds = [float(speed) for speed in train.speeds[0]]
    aside = np.array([1.0, 0.0, 0.0])
    if stage.kind == "bevel":
        # The apex at the origin, the driver before it; the pitch point on both cones.
        cone = train.stages[0].cones(train.pressure_angle).cones[0]
        point = math.sin(cone) * aside - math.cos(cone) * one
        arms = point, point
    elif stage.kind == "worm":
        radii = [0.5 * d for d in (stage.quotient * stage.module, stage.driven * stage.module)]
        arms = radii[0] * aside, -radii[1] * aside
    else:
        radii = [0.5 * stage.module * teeth for teeth in stage.gears]
        inside = -1.0 if stage.kind == "internal" else 1.0
        arms = radii[0] * aside, -inside * radii[1] * aside
    return np.cross(speeds[0] * one, arms[0]), np.cross(speeds[1] * two, arms[1])


@pytest.mark.parametrize("driver", [18, 40])
@pytest.mark.parametrize("kind", ["external", "internal", "bevel"])
def test_gears_roll_on_one_another(kind: Any, driver: int) -> None:
    """At the pitch point both have one velocity: the sense of rotation by mechanics, not by a rule."""
    for angle in (50.0, 90.0, 120.0):
        stage = TrainStage(driver, 30, 2.0, kind=kind, shaft_angle=math.radians(angle))
        one, two = contact_velocities(stage)
        assert one == pytest.approx(two, abs=1e-12)
        assert np.linalg.norm(one) > 0.1


@pytest.mark.parametrize("left_handed", [False, True])
def test_a_worm_takes_its_gear_along_its_threads(left_handed: bool) -> None:
    """The velocities differ along the threads only: they have one component normal to them."""
    stage = TrainStage(3, 40, 2.0, kind="worm", quotient=9.0, left_handed=left_handed)
    train = OrdinaryTrain((stage,))
    one, two = contact_velocities(stage)
    lead = stage.worm(train.pressure_angle).lead_angle
    # A right-handed thread at +x runs along +y, the way a point turns about +z, while it goes on along +z.
    along = np.array([0.0, math.cos(lead), math.sin(lead) * (-1.0 if left_handed else 1.0)])
    normal = np.array([0.0, -along[2], along[1]])
    assert float(normal @ one) == pytest.approx(float(normal @ two), rel=1e-12)
    assert train.ratio == Fraction(-40 if left_handed else 40, 3)


@pytest.mark.parametrize("kinds", list(itertools.product(["bevel", "worm"], repeat=2)))
def test_axes_are_unit_vectors_at_the_stated_angles(kinds: tuple[Any, Any]) -> None:
    train = OrdinaryTrain(tuple(TrainStage(4, 30, kind=kind, shaft_angle=math.radians(70.0)) for kind in kinds))
    for kind, one, two in zip(kinds, train.axes, train.axes[1:], strict=False):
        assert np.linalg.norm(two) == pytest.approx(1.0)
        # Away from the apex the driven shaft and the driver's stand at the shaft angle.
        assert float(one @ two) == pytest.approx(-math.cos(math.radians(70.0)) if kind == "bevel" else 0.0)


def test_bevel_cones_of_the_textbook_and_at_other_angles() -> None:
    """Norton, Sec. 9.5: at a right angle tan γ = z₁/z₂; at any angle the cones roll, r = R sin γ."""
    right = BevelCones(20, 40, 2.0, 0.5 * math.pi)
    assert [math.degrees(cone) for cone in right.cones] == pytest.approx([26.565, 63.435], abs=5e-4)
    for driver, driven, angle in ((20, 40, 70.0), (40, 20, 110.0), (25, 25, 60.0)):
        pair = BevelCones(driver, driven, 2.0, math.radians(angle))
        assert sum(pair.cones) == pytest.approx(math.radians(angle))
        for radius, cone in zip(pair.pitch_radii, pair.cones, strict=True):
            assert radius == pytest.approx(pair.cone_distance * math.sin(cone))


def test_worm_efficiency_of_the_textbook() -> None:
    """Shigley's Table 13-6: per cent with f = 0.05, by the lead angle in degrees; φ_n = 14.5°."""
    printed = {1.0: 25.2, 2.5: 45.7, 5.0: 62.6, 7.5: 71.3, 10.0: 76.6, 15.0: 82.7}
    for degrees, percent in printed.items():
        worm = WormDrive(1, 40, 1.0, 1.0 / math.tan(math.radians(degrees)), math.radians(14.5))
        assert 100.0 * worm.efficiency(0.05) == pytest.approx(percent, abs=0.06)


@pytest.mark.parametrize("friction", [0.0, 0.04, 0.2])
def test_forces_of_a_worm_keep_power_and_balance(friction: float) -> None:
    """What the gear gains over what the worm spends is the efficiency; the friction lies along the thread."""
    worm = WormDrive(2, 40, 3.0, 10.0)
    forces = worm.forces(10.0, friction)
    gear_torque = forces.gear * 0.5 * worm.dimensions.gear_diameter
    assert gear_torque / worm.dimensions.ratio / 10.0 == pytest.approx(worm.efficiency(friction), rel=1e-12)
    assert worm.is_locking(friction) == (friction >= 0.2)


@pytest.mark.parametrize(
    ("stage", "paths"),
    [
        ({"type": "helical"}, ["/stages/0/helix_angle"]),
        ({"type": "helical", "helix_angle": 0.0}, ["/stages/0/helix_angle"]),
        ({"type": "external", "helix_angle": 10.0}, ["/stages/0/helix_angle"]),
        ({"type": "external", "face_width": 10.0}, ["/stages/0/face_width"]),
        ({"type": "external", "ring": "driver"}, ["/stages/0/ring"]),
        ({"type": "bevel"}, ["/stages/0/driver", "/stages/0/driven"]),
        ({"type": "bevel", "driver": 2, "driven": 30}, ["/stages/0/driver"]),
        ({"type": "worm", "driver": 7, "driven": 30}, ["/stages/0/driver"]),
        ({"type": "worm", "driver": 1, "driven": 2}, ["/stages/0/driven"]),
        ({"type": "bevel", "driver": {"min": 3, "max": 200}, "driven": {"min": 3, "max": 200}}, ["/stages/0/driven"]),
        (WORM | {"shaft_angle": 90.0}, ["/stages/0/shaft_angle"]),
        (BEVEL | {"hand": "left", "friction": 0.1}, ["/stages/0/hand", "/stages/0/friction"]),
    ],
)
def test_what_a_type_has_not_is_refused_where_it_stands(stage: Statement, paths: list[str]) -> None:
    assert sorted(faults(stage)) == sorted(paths)


STRENGTH = {"power_kw": 1.0, "speed_rpm": 1000.0, "allowable_contact": [800.0, 750.0]}


@pytest.mark.parametrize(
    ("stages", "fields", "path"),
    [
        ([BEVEL], {"direction": "same"}, "/direction"),
        ([WORM], {"ratio": "-20"}, "/ratio"),
        ([WORM, INTERNAL], {"reverted": True}, "/stages/0/type"),
        ([INTERNAL], {"reverted": True}, "/reverted"),
        ([INTERNAL], {"max_stages": 2}, "/max_stages"),
        ([INTERNAL], {"stock": [20, 30]}, "/stock"),
        ([INTERNAL], {"centre_distance": 40.0}, "/stages/0/type"),
        ([BEVEL], {"modules": [1.0, 2.0]}, "/stages/0/type"),
        ([WORM], {"strength": STRENGTH}, "/stages/0/type"),
        ([INTERNAL], {"strength": STRENGTH | {"allowable_bending": [200.0, 180.0]}}, "/strength/allowable_bending"),
    ],
)
def test_what_does_not_go_together_is_refused_where_it_stands(stages: Any, fields: Statement, path: str) -> None:
    assert path in faults(*stages, **fields)


def best_pair(teeth: tuple[int, int], demands: Statement, distance: float) -> bool:
    """Whether some split of the shifts is sound as a `gear_pair` tells it, on a grid."""
    plain: Statement = {"type": "gear_pair", "teeth": list(teeth), "module": 1.5, "helix_angle": demands["angle"]}
    # The sum of shifts that leaves no play at the distance, by bisection of the play.
    low, high = -0.9, 1.2

    def told(first: float, total: float) -> Any:
        shift = {"shift": [first, total - first], "centre_distance": distance}
        return parse_request({"mechanism": plain | shift}).build_answer()

    for _ in range(60):
        middle = 0.5 * (low + high)
        try:
            loose = told(0.5 * middle, middle)["backlash"] > 0.0
        except MechanismError:
            # So much shift that the tips would have to be cut off altogether.
            loose = False
        low, high = (middle, high) if loose else (low, middle)
    least, most = demands["shift"]
    for first in np.linspace(max(least, low - most), min(most, low - least), 41):
        if max(least, low - most) > min(most, low - least):
            return False
        try:
            pair = told(float(first), low)
        except MechanismError:
            continue
        thick = [gear["tip_thickness"] for gear in pair["gears"]]
        # Sound teeth on a limit of play; the rest as it is demanded.
        cut = any(gear["undercut"] or gear["fillet_interference"] for gear in pair["gears"])
        if not cut and None not in thick and min(thick) >= 1.5 * demands["tip"] and pair["contact_ratio"] >= 1.2:
            return True
    return False


def test_helical_stages_are_fitted_to_a_distance() -> None:
    """Of all pairs at a distance the search has those of which a `gear_pair` with some split of shifts is sound."""
    demands: Statement = {"angle": 22.0, "shift": (-0.3, 0.4), "tip": 0.5}
    stage, distance = HELICAL | {"helix_angle": 22.0}, 33.0
    fields: Statement = {
        "modules": [1.5],
        "centre_distance": distance,
        "shift": {"min": -0.3, "max": 0.4},
        "min_tip_thickness": 0.5,
        "teeth": {"min": 16, "max": 26},
    }
    verdicts = []
    for a, b in itertools.combinations_with_replacement(range(16, 27), 2):
        if not 38 <= a + b <= 43 or a % 3:
            continue
        one = stage | {"driver": a, "driven": b}
        found = bool(solved(one, ratio=f"{b}/{a}", **fields).designs)
        verdicts.append(found)
        assert found == best_pair((a, b), demands, distance), (a, b)
    assert set(verdicts) == {False, True}
    best = solved(stage, ratio="1.3", **fields).designs[0]
    made, mesh = best.mechanism.stages[0], best.metrics.meshes[0]
    assert made.shift is not None
    pair = {
        "type": "gear_pair",
        "teeth": [made.driver, made.driven],
        "module": 1.5,
        "helix_angle": 22.0,
        "shift": [made.shift.driver, made.shift.driven],
    }
    told = parse_request({"mechanism": pair}).build_answer()
    assert told["centre_distance"] == pytest.approx(distance, rel=1e-9)
    assert mesh.tip_thickness is not None
    assert told["contact_ratio"] == pytest.approx(mesh.contact_ratio, rel=1e-9)
    assert [gear["tip_thickness"] for gear in told["gears"]] == pytest.approx(
        [mesh.tip_thickness.driver, mesh.tip_thickness.driven], rel=1e-9
    )


def test_helical_and_spur_stages_agree_on_a_distance() -> None:
    """Coaxial stages of different angles, which pitch circles never make so, by their shifts."""
    result = solved(
        HELICAL, {"type": "external"}, ratio="4", reverted=True, modules=[1.0, 1.5], centre_distance=48.0,
        teeth={"min": 17, "max": 60}, max_designs=3,
    )  # fmt: skip
    assert result.search.complete
    for design in result.designs:
        assert design.metrics.centre_distances == pytest.approx([48.0, 48.0], rel=1e-12)
        assert [mesh.backlash for mesh in design.metrics.meshes] == pytest.approx([0.0, 0.0], abs=1e-12)
    open_distance = solved(
        HELICAL, {"type": "external"}, ratio="4", reverted=True, modules=[1.0], shift={"min": -0.2, "max": 0.5},
        teeth={"min": 17, "max": 40},
    )  # fmt: skip
    one, two = open_distance.designs[0].metrics.centre_distances
    assert one == pytest.approx(two, rel=1e-12)


@pytest.mark.slow
def test_a_ring_carries_a_power() -> None:
    result = solved(INTERNAL, ratio="3", module=2.0, strength=STRENGTH)
    assert result.designs[0].metrics.strength is not None
    contact = [gear.contact_safety for mesh in result.designs[0].metrics.strength for gear in mesh.gears]
    assert min(safety for safety in contact if safety is not None) == pytest.approx(1.0, abs=1e-6)


def test_an_empty_answer_is_a_proof() -> None:
    result = solved(BEVEL, WORM, ratio="31", tolerance=0.0)
    assert result.designs == []
    assert result.search.complete
    assert "out of reach" in result.summary
    both = solved(BEVEL, WORM, {"type": "external"}, ratio="43.7", tolerance=1e-5, teeth={"min": 20, "max": 40})
    assert both.designs == []
    assert both.search.complete
    every = min(abs(30 * Fraction(b, a) / Fraction("43.7") - 1) for a in range(20, 41) for b in range(20, 41))
    assert both.search.least_error == pytest.approx(float(every))
