"""Analyses of every type of linkage, and of those at the edge of what a linkage is."""

import copy
import math
import time

import numpy as np
import pytest

from synthesis.analyses import get_family, parse_request
from synthesis.dispatch import solve
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.mechanisms import MechanismError
from tests.campaign import further
from tests.kinematics.mechanism_sampling import EVERY
from tests.support.synthesis.analyses import stated

DOCUMENTED = MotionProblem.model_config["json_schema_extra"]["examples"]

FOURBAR = {
    "type": "fourbar",
    "fixed_pivots": {"input": [0.0, 0.0], "output": [6.0, 0.0]},
    "links": {"input": 2.0, "coupler": 7.0, "output": 9.0},
    "coupler_point": {"distance": 6.0, "angle": 30.0},
}


def answer(mechanism, **motion):
    return parse_request(
        {"mechanism": mechanism, "motion": motion} if motion else {"mechanism": mechanism}
    ).build_answer()


@pytest.mark.parametrize("name", EVERY)
def test_every_type_has_all_quantities(name):
    mechanism = stated(name)
    found = answer(mechanism)
    names = {link["name"] for link in mechanism["skeleton"]["links"]} - {"ground"}
    assert set(found["links"]) == names
    assert set(found["joints"]) == set(mechanism["skeleton"]["joints"])
    assert len(found["slides"]) == len(mechanism["skeleton"]["slides"])
    assert found["classification"]["mobility"] == 1
    (here,) = [b for circuit in found["circuits"] for b in circuit["branches"] if b["reference"]]
    ends = [] if here["full"] else [here["from"], here["to"]]
    period = 1e300 if mechanism["skeleton"]["input_link"] not in names else 360.0
    assert all(min(abs((end - t + period / 2) % period - period / 2) for t in found["toggles"]) < 1e-6 for end in ends)
    assert found["limits"]
    grounded = set(found["torque_ratio"])
    assert grounded <= set(found["limits"])
    one = answer(mechanism, at=(here["from"] + here["to"]) / 2.0)
    links = len(mechanism["skeleton"]["links"])
    assert len(one["instant_centers"]) == links * (links - 1) // 2


@pytest.mark.parametrize("name", ["watt_1 driven by its input", "drag link and slider", "Peaucellier"])
def test_dimensions_beside_a_skeleton_must_be_its_own(name):
    mechanism = stated(name)
    link = next(n for n in mechanism["links"] if n != "ground")
    wrong = copy.deepcopy(mechanism)
    wrong["links"][link] *= 1.01
    with pytest.raises(MechanismError) as told:
        answer(wrong, at=0.0)
    assert told.value.path == f"/links/{link}"
    with pytest.raises(MechanismError) as told:
        answer({**mechanism, "links": {"other": 1e3}}, at=0.0)
    assert told.value.path == "/links/other"
    with pytest.raises(MechanismError) as told:
        answer({**mechanism, "fixed_pivots": {"O2": [77.0, 0.0]}}, at=0.0)
    assert told.value.path == "/fixed_pivots/O2"
    ground = next(link["joints"][0] for link in mechanism["skeleton"]["links"] if link["name"] == "ground")
    answer({**mechanism, "fixed_pivots": {"input": mechanism["skeleton"]["joints"][ground]}}, at=0.0)


def test_a_skeleton_beside_dimensions_must_have_them_and_is_driven():
    by_dimensions = answer(FOURBAR, at=75.0)
    joints = {n: [track["x"][0], track["y"][0]] for n, track in by_dimensions["joints"].items()}
    names = {"ground": ["O2", "O4"], "input": ["O2", "A"], "coupler": ["A", "B", "P"], "output": ["O4", "B"]}
    skeleton = {
        "joints": joints, "links": [{"name": n, "joints": j} for n, j in names.items()], "input_link": "input",
    }  # fmt: skip
    both = {**FOURBAR, "skeleton": skeleton, "reference_body_angle": 12.0}
    assert answer(both, at=75.0)["joints"]["B"]["x"] == pytest.approx(by_dimensions["joints"]["B"]["x"])
    moved = copy.deepcopy(both)
    moved["skeleton"]["joints"]["P"][0] += 0.01
    with pytest.raises(MechanismError) as told:
        answer(moved, at=75.0)
    assert told.value.path == "/skeleton/joints"


def coordinates(found):
    return {n: np.array([t["x"], t["y"]], float) for n, t in found["joints"].items()}


@pytest.mark.parametrize("scale", [1e-9, 1e-3, 1e8])
def test_a_unit_of_length_changes_nothing_but_lengths(scale):
    small = copy.deepcopy(FOURBAR)
    small["fixed_pivots"]["output"][0] *= scale
    small["links"] = {n: length * scale for n, length in small["links"].items()}
    small["coupler_point"]["distance"] *= scale
    found, expected = answer(small), answer(FOURBAR)
    for name, track in coordinates(expected).items():
        assert np.allclose(coordinates(found)[name] / scale, track, atol=1e-9)
    assert found["limits"]["output"] == pytest.approx(expected["limits"]["output"])
    assert found["classification"] == expected["classification"]


@pytest.mark.parametrize(
    ("links", "ground"),
    [((2.0, 6.0, 2.0), 6.0), ((2.0, 2.0, 6.0), 6.0), ((6.0, 2.0, 2.0), 6.0), ((2.0, 5.0, 3.0), 6.0)],
    ids=["parallelogram", "kite", "kite, long crank", "S + L = P + Q"],
)
@pytest.mark.parametrize("turn", [0.0, 17.0])
def test_at_change_points_the_answer_is_right_or_null(links, ground, turn):
    """Links keep their lengths wherever numbers are given, also in degrees that are change points."""
    o4 = [ground * math.cos(math.radians(turn)), ground * math.sin(math.radians(turn))]
    a, b, c = links
    mechanism = {
        "type": "fourbar", "fixed_pivots": {"input": [0.0, 0.0], "output": o4},
        "links": {"input": a, "coupler": b, "output": c}, "coupler_point": {"distance": 3.0, "angle": 0.0},
    }  # fmt: skip
    found = answer(mechanism, **{"from": turn - 180.0, "to": turn + 180.0, "steps": 72})
    assert found["classification"]["grashof"] == "change_point" or found["classification"]["barker"] > 8
    assert len(found["circuits"]) == 1
    joints, valid = coordinates(found), np.array(found["valid"])
    assert valid.sum() >= 10
    for one, other, length in (("O2", "A", a), ("A", "B", b), ("O4", "B", c), ("A", "P", 3.0)):
        gap = np.hypot(*(joints[one] - joints[other]))
        assert (np.isfinite(gap) == valid).all()
        assert np.allclose(gap[valid], length, atol=1e-9)
    for track in found["links"].values():
        assert np.isfinite(np.array(track["angle"], float)[valid]).all()


def test_a_collinear_coupler_point_stays_on_the_line():
    found = answer({**FOURBAR, "coupler_point": {"distance": 3.5, "angle": 180.0}})
    joints = coordinates(found)
    along = (joints["B"] - joints["A"]) / 7.0
    assert np.allclose(joints["P"], joints["A"] - 3.5 * along, atol=1e-12)


def test_a_link_without_length_in_a_skeleton_is_refused():
    mechanism = stated("fourbar")
    mechanism["links"] = {}
    mechanism["skeleton"]["joints"]["B"] = mechanism["skeleton"]["joints"]["A"]
    with pytest.raises(ValueError, match="length of coupler"):
        answer(mechanism, at=0.0)


DRIVEN = {
    "type": "slider_crank", "fixed_pivot": [0.0, 0.0], "links": {"crank": 2.0, "coupler": 7.0},
    "slide": {"point": [0.0, 1.0], "angle": 0.0}, "driven_by": "slider",
}  # fmt: skip


def test_a_driven_slider_goes_between_its_toggles_unless_told_otherwise():
    found = answer(DRIVEN)
    ends = [math.sqrt(5.0**2 - 1.0), math.sqrt(9.0**2 - 1.0)]
    assert [found["input_angle"][0], found["input_angle"][-1]] == pytest.approx(ends)
    assert found["toggles"] == pytest.approx([-ends[1], -ends[0], *ends]), "of both circuits"
    assert all(found["valid"])
    with pytest.raises(MechanismError):
        answer(DRIVEN, at=7.0, speed_rpm=60.0)


def test_a_slider_runs_in_time_by_lengths():
    found = answer(DRIVEN, time={"start": 0.0, "end": 1.0, "step": 0.25}, at=6.0, speed=1.0, acceleration=0.5)
    t = np.array(found["time"])
    assert found["input_angle"] == pytest.approx(list(6.0 + t + 0.25 * t * t))
    assert found["slides"]["B"]["velocity"] == pytest.approx(list(1.0 + 0.5 * t))


@pytest.mark.parametrize("mechanism", [FOURBAR, stated("stephenson_2 driven by its input")], ids=["dyads", "class III"])
def test_a_run_in_time_that_turns_back_passes_the_same_positions_again(mechanism):
    """It stands still at 0.5 s; before and after, positions and accelerations are the same, velocities opposite."""
    start = math.degrees(parse_request({"mechanism": mechanism}).mechanism.build_mechanism().reference_input)
    found = answer(mechanism, time={"start": 0.0, "end": 1.0, "step": 0.05}, at=start, speed=0.02, acceleration=-0.04)
    assert all(found["valid"])
    assert found["input_angle"][10] == pytest.approx(max(found["input_angle"]))
    for track in found["joints"].values():
        for name, sign in (("x", 1.0), ("vx", -1.0), ("ax", 1.0), ("jy", -1.0)):
            values = np.array(track[name], float)
            assert values == pytest.approx(sign * values[::-1], abs=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("example", further(DOCUMENTED, DOCUMENTED[::3]))
def test_the_designs_of_the_documented_problems_move(example):
    """Whatever a solver gives as a mechanism can be stated as it is, with its skeleton beside its dimensions."""
    result = solve(MotionProblem.model_validate(example), lambda _fraction, _message: None)
    assert result.designs
    for design in result.designs:
        mechanism = design.model_dump(mode="json")["mechanism"]
        moved = get_family(mechanism).request.analyze_cycle(mechanism, 36)
        assert sum(moved["valid"]) > 30


def test_joints_that_coincide_may_differ_by_rounding():
    """P on B of a slider-crank far from the origin: as a design states it, rounding leaves some 1e-14 between them."""
    o2, a, b = complex(3e3, 4e3), complex(3e3, 4e3) + 2.0 * np.exp(0.7j), complex(3e3 + 9.0, 4e3)
    coupler = abs(b - a)
    mechanism = {
        "type": "slider_crank",
        "fixed_pivot": [o2.real, o2.imag],
        "links": {"crank": abs(a - o2), "coupler": coupler},
        "slide": {"point": [b.real, b.imag], "angle": 0.0},
        "coupler_point": {"distance": coupler, "angle": 0.0},
        "assembly": "open",
        "skeleton": {
            "joints": {"O2": [o2.real, o2.imag], "A": [a.real, a.imag], "B": [b.real, b.imag],
                       "P": [b.real + 3e-13, b.imag]},
            "links": [{"name": "ground", "joints": ["O2"]}, {"name": "crank", "joints": ["O2", "A"]},
                      {"name": "coupler", "joints": ["A", "B", "P"]}],
            "slides": [{"joint": "B", "link": "ground", "point": [b.real, b.imag], "angle": 0.0}],
            "input_link": "crank",
        },
    }  # fmt: skip
    answer = parse_request({"mechanism": mechanism, "motion": {"at": math.degrees(0.7)}}).build_answer()
    assert answer["joints"]["P"]["x"] == pytest.approx(answer["joints"]["B"]["x"])


@pytest.mark.parametrize("name", EVERY)
def test_the_joints_along_a_branch_keep_every_link(name):
    """Rigid bodies on each branch, other places on another one, and the reference on its own."""
    mechanism = stated(name)
    skeleton = mechanism["skeleton"]
    found = parse_request({"mechanism": mechanism, "include": ["branches"]}).build_answer()
    joints = {n: complex(*z) for n, z in skeleton["joints"].items()}
    size = max(abs(one - other) for one in joints.values() for other in joints.values())
    listed = [branch for circuit in found["circuits"] for branch in circuit["branches"]]
    if listed[0]["joints"] is None:
        assert skeleton["input_link"] not in {link["name"] for link in skeleton["links"]} or "stephenson" in name
        return
    paths = []
    for branch in listed:
        at = {n: np.array(z["x"]) + 1j * np.array(z["y"]) for n, z in branch["joints"].items()}
        paths.append(np.stack(list(at.values())))
        known = np.isfinite(paths[-1]).all(axis=0)
        assert known.mean() > 0.97, "but for rounding at a toggle it can be assembled"
        for link in skeleton["links"]:
            for one, other in zip(link["joints"], link["joints"][1:], strict=False):
                length = np.abs(at[one] - at[other])[known]
                assert np.allclose(length, abs(joints[one] - joints[other]), atol=1e-6 * size)
    here = next(k for k, branch in enumerate(listed) if branch["reference"])
    reference = np.array([joints[n] for n in listed[here]["joints"]])
    away = [np.nanmin(np.abs(path - reference[:, None]).max(axis=0)) for path in paths]
    assert away[here] <= min(away) + 1e-9 * size
    for k, path in enumerate(paths):
        assert all(np.nanmax(np.abs(path - other)) > 1e-3 * size for other in paths[:k]), "no branch is listed twice"


def test_branches_are_for_any_linkage_and_the_rest_for_fourbars():
    skeleton = stated("watt_1 driven by its input")
    asked = parse_request({"mechanism": skeleton, "include": ["branches", "cognates"]})
    with pytest.raises(MechanismError, match="fourbar has cognates"):
        asked.build_answer()
    plain = parse_request({"mechanism": FOURBAR, "motion": {"at": 30.0}}).build_answer()
    assert "joints" not in plain["circuits"][0]["branches"][0]


FIVEBAR = {
    "type": "geared_fivebar",
    "fixed_pivots": {"input": [0.0, 0.0], "output": [6.0, 0.0]},
    "links": {"input": 1.0, "coupler_1": 7.0, "coupler_2": 9.0, "output": 4.0},
}


def test_gears_that_hold_the_output_still_make_a_fourbar():
    """With a ratio of 0 the output's pin does not move: O2, A, C and that pin."""
    found = answer({**FIVEBAR, "gear_ratio": 0.0, "phase": 60.0}, **{"from": 0.0, "to": 360.0, "steps": 36})
    pin = [6.0 + 4.0 * math.cos(math.pi / 3.0), 4.0 * math.sin(math.pi / 3.0)]
    fourbar = {
        "type": "fourbar", "fixed_pivots": {"input": [0.0, 0.0], "output": pin},
        "links": {"input": 1.0, "coupler": 7.0, "output": 9.0},
        "assembly": "open", "coupler_point": {"distance": 0.0, "angle": 0.0},
    }  # fmt: skip
    same = answer(fourbar, **{"from": 0.0, "to": 360.0, "steps": 36})
    assert all(found["valid"])
    assert found["joints"]["C"]["x"] == pytest.approx(same["joints"]["B"]["x"], abs=1e-12)
    assert [len(circuit["branches"]) for circuit in found["circuits"]] == [1, 1]


@pytest.mark.parametrize("ratio", [0.5, -1.5, 2.0 / 3.0])
def test_a_geared_fivebar_that_closes_in_a_later_turn_alone_is_found_there(ratio):
    """The coupler pins are held apart by 8 at least, which they are only where both are turned away from each other."""
    statement = {
        "type": "geared_fivebar",
        "fixed_pivots": {"input": [0.0, 0.0], "output": [4.0, 0.0]},
        "links": {"input": 2.0, "coupler_1": 10.0, "coupler_2": 2.0, "output": 3.0},
        "gear_ratio": ratio,
        "phase": 90.0,
    }
    turn = np.radians(np.arange(0.0, 360.0, 0.1))
    apart = 4.0 + 3.0 * np.exp(1j * (ratio * turn + math.radians(90.0))) - 2.0 * np.exp(1j * turn)
    assert np.abs(apart).max() < 8.0, "not in the first turn"
    found = answer(statement, **{"from": 0.0, "to": 1080.0, "steps": 1080})
    valid = np.array(found["valid"])
    assert 0 < valid.sum() < 360
    assert not valid[:360].any()
    joints = {name: np.array(at["x"])[valid] + 1j * np.array(at["y"])[valid] for name, at in found["joints"].items()}
    assert abs(joints["C"] - joints["A"]) == pytest.approx(10.0, rel=1e-12)
    assert abs(joints["C"] - joints["B"]) == pytest.approx(2.0, rel=1e-12)


def test_gears_of_many_turns_are_searched_by_their_turns_alone():
    """A hundred turns of the input are one of the output; what is to be looked at grows with the turns, no faster."""
    begun = time.process_time()
    slow = answer({**FIVEBAR, "gear_ratio": 0.01, "phase": 60.0})
    assert time.process_time() - begun < 1.0
    (branch,) = [b for circuit in slow["circuits"] for b in circuit["branches"] if b["reference"]]
    assert branch["full"] is False
    assert len(slow["toggles"]) == 30


def test_a_slide_passes_on_force_by_virtual_work():
    """Norton, Sec. 6.5: what goes in as torque and speed comes out as force and speed; driven back, the reciprocal."""
    by_crank = {**DRIVEN, "driven_by": "crank"}
    forward = answer(by_crank, at=50.0)
    force, speed = forward["force_ratio"]["B"][0], forward["slides"]["B"]["velocity"][0]
    assert force * speed == pytest.approx(1.0)
    assert forward["torque_ratio"] == {}
    back = answer(DRIVEN, at=forward["slides"]["B"]["position"][0], speed=1.0)
    assert abs(back["torque_ratio"]["crank"][0]) == pytest.approx(abs(speed))
    assert back["force_ratio"] == {}


def test_what_is_left_out_is_said():
    assert answer(FOURBAR, at=40.0)["notes"] == []
    free = answer(stated("stephenson_2 driven by its output"))
    assert set(free["transmission_angle"]) == {None} or all(math.isnan(x) for x in free["transmission_angle"])
    note, _ = free["notes"]
    assert note.startswith("transmission_angle: ")
    assert any(math.isfinite(x) for x in free["torque_ratio"]["input"])
    endless = answer({**FIVEBAR, "gear_ratio": math.sqrt(2.0), "phase": 60.0})
    note, _ = endless["notes"]
    assert endless["circuits"] == []
    assert note.startswith("circuits, toggles, limits: ")
    assert sum(endless["valid"]) > 300


def test_a_joint_on_two_slides():
    """A slider-crank whose slider pin runs in the slot of a lever: tan of the lever's angle is x over its height."""
    a = 2.0 * complex(math.cos(0.9), math.sin(0.9))
    b = a.real + math.sqrt(49.0 - a.imag**2)
    lever = math.degrees(math.atan2(5.0, b - 1.0))
    mechanism = {
        "type": "skeleton",
        "skeleton": {
            "joints": {"O2": [0.0, 0.0], "O4": [1.0, -5.0], "A": [a.real, a.imag], "B": [b, 0.0], "C": [b, 2.0]},
            "links": [{"name": "ground", "joints": ["O2", "O4"]}, {"name": "crank", "joints": ["O2", "A"]},
                      {"name": "coupler", "joints": ["A", "B"]}, {"name": "lever", "joints": ["O4", "C"]}],
            "slides": [{"joint": "B", "link": "ground", "point": [b, 0.0], "angle": 0.0},
                       {"joint": "B", "link": "lever", "point": [b, 0.0], "angle": lever}],
            "input_link": "crank",
        },
    }  # fmt: skip
    found = answer(mechanism)
    assert all(found["valid"])
    assert set(found["slides"]) == {"B_0", "B_1"}
    assert set(found["force_ratio"]) == {"B_0"}
    theta = np.radians(found["input_angle"])
    x = 2.0 * np.cos(theta) + np.sqrt(49.0 - (2.0 * np.sin(theta)) ** 2)
    assert found["joints"]["B"]["x"] == pytest.approx(list(x))
    turned = np.radians(np.array(found["links"]["lever"]["angle"]) - math.degrees(math.atan2(7.0, b - 1.0)) + lever)
    assert list((x - 1.0) * np.sin(turned)) == pytest.approx(list(5.0 * np.cos(turned)), abs=1e-9)
    assert found["limits"]["B_0"] == pytest.approx([5.0 - b, 9.0 - b])
