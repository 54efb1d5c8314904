"""The address at which PMKS+ opens a design, read by a decoder of its own that reads PMKS+'s own templates."""

from __future__ import annotations

import cmath
import math
from typing import Any, NamedTuple

import pytest

from service.simulation.pmks import write_pmks
from service.simulation.query import NotSimulated
from synthesis.mechanisms.skeleton import assemble_skeleton
from synthesis.model.linkage.given_linkage import SkeletonSpec
from tests.support.service.answers import finished
from tests.support.service.parts import MOTION, SLIDER

BASE = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz_-"

HEAD = "2P.Ay,1E8.K,0.1011."
TEMPLATES = {
    # PMKS-Web/PMKSWeb, src/app/component/MODALS/templates/template-linkages.ts
    "4-Bar": HEAD + "MA,A,0mv,0VU,0.GB,B,0e_,E6,0.GC,C,l1,WW,0.KD,D,qD,0Pk,0.."
    "YRAB,AB,Fe,Fe,0ix,08i,c5cae9,A,B,,.YRBC,BC,Fe,Fe,32,NJ,303e9f,B,C,,.YRCD,CD,Fe,Fe,nd,3P,0d125a,C,D,,...N_v",
    "Slider_Crank": HEAD + "MA,A,0mA,0c,0.GB,B,0Yt,bK,0.GC,C,il,H-,0.LD,D,il,H-,0.."
    "YRAB,AB,Fe,Fe,0fW,IN,c5cae9,A,B,,.YRBC,BC,Fe,Fe,4y,Rf,303e9f,B,C,,.YPCD,CD,Fe,0,0,0,,C,D,,...N_j",
    "Whitworth_Quick_Return": HEAD + "MA,A,0,0,0.GB,B,0,ku,0.KC,C,Fe,0,0.GD,D,095,1A7,0.HP,P,0,ku,0,CD,C,D.."
    "YRAB,AB,Fe,Fe,0,NS,c5cae9,A,B,,.YRCD,CD,Fe,Fe,3H,b4,303e9f,C,D,,.YPBP,BP,Fe,0,0,0,,B,P,,...N_w",
}


class Joint(NamedTuple):
    flags: int
    place: complex
    angle: float
    slot: tuple[str, ...]


def whole(text: str) -> int:
    sign = -1 if text[0] == "0" and len(text) > 1 else 1
    total = 0
    for character in text:
        total = 64 * total + BASE.index(character)
    return sign * total


def decoded(model: str) -> tuple[int, list[int], dict[str, Joint], dict[str, tuple[str, tuple[str, ...]]]]:
    """Settings, numbers, joints, and links by their sort and joints."""
    text, check = model[:-1], model[-1]
    assert BASE[len(text) % 62] == check
    head, joints_, links_ = text.split("..")[0], text.split("..")[0].split(".")[4:], text.split("..", 1)[1]
    flags, decimals, integers, enums = head.split(".")[:4]
    assert enums == "1011"
    assert len(decimals.split(",")) == 2
    joints = {}
    for record in joints_:
        first, name, x, y, angle, *slot = record.split(",")
        assert first[1:] == name
        joints[name] = Joint(BASE.index(first[0]), complex(whole(x), whole(y)) / 1000, whole(angle) / 1000, tuple(slot))
    records, forces, active = links_.split(".")[:-3], links_.split(".")[-2], links_.split(".")[-1]
    assert (forces, active) == ("", "N_")
    links = {}
    for record in records:
        first, name, mass, _inertia, _x, _y, _colour, *members = record.split(",")
        assert first == f"Y{first[1]}{name}"
        assert whole(mass) == 1000
        assert members[-2:] == ["", ""]
        links[name] = first[1], tuple(members[:-2])
    return whole(flags.lstrip("0") or "0"), [whole(one) for one in integers.split(",")], joints, links


@pytest.mark.parametrize("name", TEMPLATES)
def test_the_decoder_reads_templates_of_pmks(name: str) -> None:
    flags, integers, joints, links = decoded(TEMPLATES[name])
    assert (flags, integers) == (153, [20, 0])
    assert joints["A"].flags == 2 + 4 + 16
    assert all(set(members) <= joints.keys() for _, members in links.values())
    assert [sort for sort, _ in links.values()].count("P") == (name != "4-Bar")


@pytest.mark.parametrize(("problem", "slides"), [(MOTION, 0), (SLIDER, 1)])
def test_a_design_stands_in_its_address(client: Any, problem: dict[str, Any], slides: int) -> None:
    job = finished(client, {**problem, "dynamics": {"speed_rpm": -30.0}})
    answer = client.get(f"/v1/jobs/{job['id']}/designs/0/pmks")
    assert answer.status_code == 200, answer.text
    told = answer.json()
    address, model = told["url"].split("?")
    assert address == "https://app.pmksplus.com/"
    flags, integers, joints, links = decoded(model)
    assert (flags & 1, integers[0]) == (1, 30)
    skeleton = job["result"]["designs"][0]["mechanism"]["skeleton"]
    at = [complex(*place) for place in skeleton["joints"].values()]
    letters = dict(zip(skeleton["joints"], "ABCDEFGHIJ", strict=False))
    for name, place in zip(skeleton["joints"], at, strict=True):
        assert joints[letters[name]].place == pytest.approx(told["scale"] * (place - at[0]), abs=7.1e-4)
    assert 5.0 <= told["scale"] * max(abs(a - b) for a in at for b in at) <= 50.0
    stated = {
        "".join(letters[joint] for joint in link["joints"]) for link in skeleton["links"] if link["name"] != "ground"
    }
    assert {name for name, (sort, _) in links.items() if sort == "R"} == stated
    ground = next(link["joints"] for link in skeleton["links"] if link["name"] == "ground")
    pinned = {letters[joint] for joint in ground}
    assert {name for name, joint in joints.items() if joint.flags & 4 and not joint.flags & 1} == pinned
    (driven,) = (name for name, joint in joints.items() if joint.flags & 2)
    assert driven == letters["O2"]
    assert [sort for sort, _ in links.values()].count("P") == slides
    for pin, own in (members for sort, members in links.values() if sort == "P"):
        assert joints[own].place == joints[pin].place
        assert joints[own].flags == 1 + 4 + 16
        apart = joints[own].angle - math.radians(skeleton["slides"][0]["angle"])
        assert abs(math.sin(apart)) < 1e-3


def skeleton_of(gears: list[Any]) -> Any:
    """An inverted slider-crank, or a geared fivebar."""
    crank = {"O2": [0.0, 0.0], "A": [5.0, 3.0], "O4": [20.0, 0.0], "B": [20.0, 10.0]}
    links = [{"name": "ground", "joints": ["O2", "O4"]}, {"name": "crank", "joints": ["O2", "A"]}]
    stated: dict[str, Any] = {"joints": crank, "links": links, "input_link": "crank", "slides": [], "gears": gears}
    if gears:
        crank["C"] = [15.0, 30.0]
        links += [
            {"name": name, "joints": listed}
            for name, listed in (("a", ["A", "C"]), ("b", ["B", "C"]), ("rocker", ["O4", "B"]))
        ]
    else:
        links.append({"name": "rocker", "joints": ["O4", "B"]})
        angle = math.degrees(cmath.phase(-15.0 + 3.0j))
        stated["slides"] = [{"joint": "A", "link": "rocker", "point": [20.0, 0.0], "angle": angle}]
    return assemble_skeleton(SkeletonSpec.model_validate(stated))


def test_a_slot_of_a_link_lies_through_two_of_its_points() -> None:
    _, _, joints, links = decoded(write_pmks(skeleton_of([]), 60.0).url.split("?")[1])
    (own,) = (name for name, joint in joints.items() if joint.flags & 1)
    carrier, one, other = joints[own].slot
    sort, members = links[carrier]
    assert sort == "R"
    assert {one, other} <= set(members)
    assert own not in members
    line = joints[other].place - joints[one].place
    pivot = joints["C"].place - joints[one].place  # O4, on the line
    assert abs((pivot * line.conjugate()).imag) / abs(line) < 2e-3
    assert links[f"B{own}"] == ("P", ("B", own))


def test_gears_cannot_be_opened() -> None:
    with pytest.raises(NotSimulated, match="does not support gears"):
        write_pmks(skeleton_of([{"links": ["crank", "rocker"], "ratio": -2.0}]), 60.0)


def test_what_is_no_linkage_is_told(client: Any) -> None:
    job = finished(client, {"kind": "gear_train", "ratio": 1.5, "max_stages": 1, "max_designs": 1})
    assert client.get(f"/v1/jobs/{job['id']}/designs/0/pmks").status_code == 404
