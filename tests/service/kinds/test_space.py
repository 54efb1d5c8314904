"""The room of a linkage through HTTP: every field of it, on kinds of every sort; and what is refused."""

import copy
import math

import numpy as np
import pytest
import shapely

from kinematics.linkage.planar.drive import drive
from kinematics.linkage.planar.mechanism import GearPair, Mechanism, Slide
from synthesis.model.linkage.workspace import Space
from synthesis.registry import list_examples
from tests.campaign import further
from tests.service.stated.linkages import FITTED as SIX
from tests.statements import fields
from tests.support.service.answers import finished
from tests.support.service.space import TURNS
from tests.support.synthesis.space import LID

STEP = math.radians(0.25)
"""Of the input, at which shapes are looked at."""

FITTED = {"kind": "motion", **SIX, "max_designs": 3}
SHELF = {"polygon": [[-260.0, 300.0], [-5.0, 300.0], [-5.0, 320.0], [-260.0, 320.0]]}
POST = {"circle": {"center": [-60.0, 330.0], "radius": 30.0}}
WALL = {"polygon": [[-300.0, 0.0], [-20.0, 0.0], [-20.0, 250.0], [-150.0, 120.0], [-300.0, 250.0]]}
ROUND = {"circle": {"center": [-100.0, 0.0], "radius": 120.0}}
ELSEWHERE = {"polygon": [[400.0, -400.0], [700.0, -400.0], [700.0, 0.0], [400.0, 0.0]]}
POINTS = {
    "kind": "path",
    "points": [
        {"x": 4.0, "y": 3.0},
        {"x": 3.2, "y": 4.2},
        {"x": 2.0, "y": 4.5},
        {"x": 0.8, "y": 4.0},
        {"x": 0.2, "y": 3.0},
    ],
    "rounds": 1,
    "max_designs": 3,
}
CORNER = {"polygon": [[500.0, 300.0], [560.0, 300.0], [560.0, 380.0]]}
BESIDE = {"polygon": [[700.0, 300.0], [800.0, 300.0], [800.0, 340.0], [700.0, 340.0]]}
BETWEEN = {"circle": {"center": [640.0, 180.0], "radius": 60.0}}
BELOW = {"polygon": [[-3.0, -2.0], [0.0, -2.0], [0.0, 1.0], [-3.0, 1.0]]}
PILLAR = {"polygon": [[1.6, 1.0], [2.4, 1.0], [2.4, 2.5], [1.6, 2.5]]}
LEAF = [[0.0, -300.0], [20.0, -300.0], [20.0, 100.0], [0.0, 100.0]]


def with_space(problem, **space):
    return {**copy.deepcopy(problem), "space": space}


def mechanism_of(skeleton):
    return Mechanism(
        {name: complex(*place) for name, place in skeleton["joints"].items()},
        {link["name"]: tuple(link["joints"]) for link in skeleton["links"]},
        skeleton["input_link"],
        tuple(
            Slide(s["joint"], s["link"], np.asarray(complex(*s["point"])), np.asarray(math.radians(s["angle"])))
            for s in skeleton.get("slides", [])
        ),
        tuple(GearPair(*gear["links"], gear["ratio"]) for gear in skeleton.get("gears", [])),
    )


def joints_of(design):
    return {name: complex(*place) for name, place in design["mechanism"]["skeleton"]["joints"].items()}


def swept_shapes(design, space, problem):
    """The moving parts over the used range as geometry, from the skeleton: shape (parts, inputs)."""
    mechanism = mechanism_of(design["mechanism"]["skeleton"])
    low, high = sorted(np.radians(design["metrics"]["used_range"]))
    if space.get("over") == "cycle":
        low, high = 0.0, 2.0 * math.pi
    inputs = np.linspace(low, high, max(int((high - low) / STEP), 2))
    motion = drive(mechanism, inputs, order=0)
    body = space.get("body", {}).get("outline")
    shapes = []
    for link, joints in mechanism.links.items():
        if link == "ground":
            continue
        kept = [joint for joint in joints if not (body and joint == "P")]
        places = np.stack([motion.joints[joint][0] for joint in kept], axis=1)[motion.valid]
        hulls = shapely.convex_hull(shapely.multipoints(np.stack([places.real, places.imag], axis=-1)))
        width = space.get("link_width", 0.0)
        shapes.append(shapely.buffer(hulls, 0.5 * width) if width else hulls)
    if body:
        first = problem["positions"][0]
        local = np.array([complex(*corner) for corner in body]) - complex(first["x"], first["y"])
        stands = design["mechanism"].get("reference_body_angle")
        off = 0.0 if stands is None else math.radians(stands - first["angle"])
        turned = np.exp(1j * (motion.angles["coupler"][0] - mechanism.link_angle("coupler") + off))[motion.valid]
        places = motion.joints["P"][0][motion.valid][:, None] + turned[:, None] * local
        shapes.append(shapely.polygons(np.stack([places.real, places.imag], axis=-1)))
    return np.stack(shapes)


def geometry(zone):
    if "circle" in zone:
        return shapely.Point(zone["circle"]["center"]).buffer(zone["circle"]["radius"], quad_segs=256)
    return shapely.Polygon(zone["polygon"])


def one_of(zones):
    return shapely.unary_union([geometry(zone) for zone in (zones if isinstance(zones, list) else [zones])])


KEPT = {
    "zones of fixed pivots": (LID, {"fixed_pivots": {"input": WALL, "output": [ROUND, ELSEWHERE]}}),
    "zones of moving pivots": (LID, {"moving_pivots": {"input": ROUND, "output": [WALL, {**ROUND, "frame": "body"}]}}),
    "zones of a fit": (FITTED, {"fixed_pivots": {"input": {"circle": {"center": [20.0, -20.0], "radius": 300.0}}}}),
    "box": (LID, {"box": [[-400.0, -420.0], [620.0, 720.0]], "link_width": 20.0}),
    "obstacles": (LID, {"obstacles": [SHELF, POST], "clearance": 5.0, "link_width": 20.0}),
    "body": (LID, {"body": {"outline": LEAF}, "obstacles": [SHELF], "clearance": 5.0}),
    "path": (POINTS, {"fixed_pivots": {"input": BELOW}, "obstacles": [PILLAR], "link_width": 0.2, "clearance": 0.1}),
    "function": (
        TURNS,
        {
            "fixed_pivots": {"input": CORNER, "output": BESIDE},
            "obstacles": [BETWEEN],
            "link_width": 8.0,
            "clearance": 3.0,
        },
    ),
    "cycle": (LID, {"obstacles": [{"circle": {"center": [450.0, -300.0], "radius": 30.0}}], "over": "cycle"}),
}


SLOW = ("obstacles", "cycle")


@pytest.mark.slow
@pytest.mark.parametrize("name", further(KEPT, [name for name in KEPT if name not in SLOW]))
def test_designs_fit_into_their_room(client, name):
    problem, space = KEPT[name]
    job = finished(client, with_space(problem, **space))
    assert job["status"] == "succeeded", job["error"]
    designs = job["result"]["designs"]
    assert designs
    for design in designs:
        assert design["verification"]["passed"]
        joints = joints_of(design)
        for demand, pins in (("fixed_pivots", ("O2", "O4")), ("moving_pivots", ("A", "B"))):
            for side, pin in zip(("input", "output"), pins, strict=True):
                zones = space.get(demand, {}).get(side)
                if zones is not None:
                    assert one_of(zones).distance(shapely.Point(joints[pin].real, joints[pin].imag)) <= 1e-2
        shapes = swept_shapes(design, space, problem)
        for zone in space.get("obstacles", []):
            apart = shapely.distance(shapes, geometry(zone)).min()
            assert apart >= space.get("clearance", 0.0) - 1e-2
        if "box" in space:
            (left, low), (right, high) = space["box"]
            bounds = shapely.bounds(shapes)
            assert (
                bounds.reshape(-1, 4) @ np.diag([1, 1, -1, -1]) >= np.array([left, low, -right, -high]) - 1e-6
            ).all()


ROWS = {
    "fixed_pivots": ({}, {"fixed_pivots": {"input": WALL}}),
    "fixed_pivots.input": ({"fixed_pivots": {"input": WALL}}, {"fixed_pivots": {"input": ROUND}}),
    "fixed_pivots.output": ({"fixed_pivots": {"input": WALL}}, {"fixed_pivots": {"input": WALL, "output": ROUND}}),
    "moving_pivots": ({}, {"moving_pivots": {"input": WALL}}),
    "moving_pivots.input": ({"moving_pivots": {"input": WALL}}, {"moving_pivots": {"input": ROUND}}),
    "moving_pivots.output": ({"moving_pivots": {"input": WALL}}, {"moving_pivots": {"input": WALL, "output": ROUND}}),
    "moving_pivots.input.frame": (
        {"moving_pivots": {"input": ELSEWHERE}},
        {"moving_pivots": {"input": {**ELSEWHERE, "frame": "body"}}},
    ),
    "box": ({}, {"box": [[-400.0, -400.0], [600.0, 700.0]]}),
    "body": ({"obstacles": [SHELF]}, {"obstacles": [SHELF], "body": {"outline": LEAF}}),
    "body.outline": (
        {"obstacles": [SHELF], "body": {"outline": LEAF}},
        {"obstacles": [SHELF], "body": {"outline": [[0.0, -300.0], [20.0, -300.0], [20.0, 290.0]]}},
    ),
    "obstacles": ({"obstacles": [SHELF]}, {"obstacles": [SHELF, POST]}),
    "clearance": ({"obstacles": [SHELF]}, {"obstacles": [SHELF], "clearance": 40.0}),
    "link_width": ({"obstacles": [SHELF]}, {"obstacles": [SHELF], "link_width": 40.0}),
    "over": ({"obstacles": [POST]}, {"obstacles": [POST], "over": "cycle"}),
}
"""Each field beside a room that is the same without it."""

SHAPES = {
    "polygon": (WALL, {"polygon": [[-300.0, 0.0], [-20.0, 0.0], [-20.0, 250.0]]}),
    "circle": (WALL, ROUND),
    "circle.center": (ROUND, {"circle": {"center": [-100.0, 40.0], "radius": 120.0}}),
    "circle.radius": (ROUND, {"circle": {"center": [-100.0, 0.0], "radius": 60.0}}),
}
for _field, _zones in SHAPES.items():
    for _demand in ("fixed_pivots", "moving_pivots"):
        for _side in ("input", "output"):
            ROWS[f"{_demand}.{_side}.{_field}"] = tuple({_demand: {_side: zone}} for zone in _zones)
            ROWS[f"{_demand}.{_side}[].{_field}"] = tuple({_demand: {_side: [zone]}} for zone in _zones)
for _field, _zones in {
    "polygon": (SHELF, {"polygon": [*SHELF["polygon"][:2], [120.0, 420.0]]}),
    "circle": (SHELF, POST),
    "circle.center": (POST, {"circle": {"center": [350.0, -120.0], "radius": 30.0}}),
    "circle.radius": (POST, {"circle": {"center": [-60.0, 330.0], "radius": 60.0}}),
}.items():
    ROWS[f"obstacles[].{_field}"] = tuple({"obstacles": [zone]} for zone in _zones)
for _place in ("input[]", "output", "output[]"):
    _side, _listed = _place.removesuffix("[]"), _place.endswith("[]")
    _zone = ELSEWHERE, {**ELSEWHERE, "frame": "body"}
    ROWS[f"moving_pivots.{_place}.frame"] = tuple(
        {"moving_pivots": {_side: [zone] if _listed else zone}} for zone in _zone
    )


QUICK = [
    name
    for name in ROWS
    if "[]" not in name and "output" not in name and not name.endswith((".circle", ".radius", ".center", ".frame"))
]
"""A row of each demand."""


def test_every_field_of_a_space_has_a_row():
    assert fields(Space.model_json_schema()).keys() == ROWS.keys()


@pytest.mark.slow
@pytest.mark.parametrize("name", further(ROWS, list(QUICK)[::2]))
def test_a_field_of_a_space_makes_another_answer(client, name):
    # Where a body lies differs from where it is to lie only in a fit.
    problem = FITTED if "frame" in name else LID
    before, after = (finished(client, with_space(problem, **space)) for space in ROWS[name])
    assert before["status"] == after["status"] == "succeeded", (before["error"], after["error"])
    assert before["result"] != after["result"], "the field is ignored"


OTHERS = {
    "path": {"kind": "path", "points": [{"x": 1.0 * k, "y": 0.3 * k * (4 - k)} for k in range(5)], "rounds": 1},
    "function": list_examples("function")[0],
    "quick_return": list_examples("quick_return")[0],
    "straight_line": {"kind": "straight_line", "length": 100.0},
}


@pytest.mark.timeout(400)  # three searches of a path, each of which may take half a minute beside other work
@pytest.mark.parametrize("kind", further(OTHERS, ["quick_return"]))
def test_every_kind_of_linkage_has_its_room_measured(client, kind):
    bare = finished(client, OTHERS[kind])
    assert bare["result"]["designs"], bare["result"]["summary"]
    joints = np.array(list(joints_of(bare["result"]["designs"][0]).values()))
    size = float(np.abs(joints - joints[0]).max())
    post = joints.mean() + 4.0 * size * np.exp(1j)
    far = {
        "box": [[-1e6, -1e6], [1e6, 1e6]],
        "obstacles": [{"circle": {"center": [post.real, post.imag], "radius": 1e-3 * size}}],
    }
    fitting = finished(client, with_space(OTHERS[kind], **far))
    assert fitting["status"] == "succeeded", fitting["error"]
    for design in fitting["result"]["designs"]:
        checks = {check["name"]: check for check in design["verification"]["checks"]}
        assert checks["box"]["passed"]
        assert checks["obstacles"]["passed"]
        shapes = swept_shapes(design, {}, OTHERS[kind])
        nearest = shapely.distance(shapes, shapely.Point(post.real, post.imag)).min() - 1e-3 * size
        # Between its quarters of a degree a linkage comes nearer by the square of them.
        assert nearest - 1e-3 * size <= checks["obstacles"]["value"] <= nearest + 1e-9 * size
    tiny = finished(client, with_space(OTHERS[kind], box=[[9e5, 9e5], [9.1e5, 9.1e5]]))
    assert tiny["status"] == "succeeded", tiny["error"]
    assert not tiny["result"]["designs"]


@pytest.mark.parametrize(
    ("space", "path"),
    [
        ({"box": [[1.0, 0.0], [0.0, 1.0]]}, "/problem/space/box"),
        ({"link_width": -1.0}, "/problem/space/link_width"),
        ({"clearance": -1.0}, "/problem/space/clearance"),
        ({"obstacles": [{}]}, "/problem/space/obstacles/0"),
        ({"obstacles": [{**POST, **SHELF}]}, "/problem/space/obstacles/0"),
        (
            {"obstacles": [{"circle": {"center": [0.0, 0.0], "radius": 0.0}}]},
            "/problem/space/obstacles/0/circle/radius",
        ),
        ({"obstacles": [{"polygon": [[0, 0], [2, 2], [2, 0], [0, 2]]}]}, "/problem/space/obstacles/0/polygon"),
        ({"obstacles": [{"polygon": [[0, 0], [1, 1], [2, 2]]}]}, "/problem/space/obstacles/0/polygon"),
        ({"obstacles": [{"polygon": [[0, 0], [1, 1]]}]}, "/problem/space/obstacles/0/polygon"),
        ({"obstacles": [{"polygon": [[k, k * k] for k in range(1001)]}]}, "/problem/space/obstacles/0/polygon"),
        ({"obstacles": [{"circle": {"center": [0.0, 0.0], "radius": 5.0}}]}, "/problem/space/obstacles/0"),
        ({"obstacles": [SHELF], "body": {"outline": [[-60, 290], [0, 290], [0, 310]]}}, "/problem/space/obstacles/0"),
        ({"box": [[1.0, -900.0], [900.0, 900.0]]}, "/problem/space/box"),
        ({"over": "sometimes"}, "/problem/space/over"),
    ],
)
def test_what_leaves_no_room_is_refused_with_its_path(client, space, path):
    answer = client.post("/v1/jobs", json={"problem": with_space(LID, **space)})
    assert answer.status_code == 422, answer.text
    assert [error["path"] for error in answer.json()["errors"]] == [path]


@pytest.mark.parametrize(
    ("space", "path"),
    [
        ({"body": {"outline": LEAF}}, "/problem/space/body"),
        ({"moving_pivots": {"output": {**WALL, "frame": "body"}}}, "/problem/space/moving_pivots/output"),
    ],
)
def test_a_body_is_that_of_a_motion(client, space, path):
    answer = client.post("/v1/jobs", json={"problem": with_space(OTHERS["straight_line"], **space)})
    assert answer.status_code == 422, answer.text
    assert [error["path"] for error in answer.json()["errors"]] == [path]


def test_an_empty_room_changes_nothing(client):
    bare, empty = finished(client, LID), finished(client, with_space(LID))
    assert bare["result"] == empty["result"]


def test_a_room_of_a_path_is_that_of_the_sixbar(client):
    problem = {"kind": "parallel_motion", "path": with_space(OTHERS["path"], box=[[-1e3, -1e3], [1e3, 1e3]])}
    answer = client.post("/v1/jobs", json={"problem": problem})
    assert answer.status_code == 422, answer.text
    assert [error["path"] for error in answer.json()["errors"]] == ["/problem/path/space"]


TOLERATED = {
    "kind": "motion",
    "positions": [
        {"x": 0.0, "y": 0.0, "angle": 0.0},
        {"x": 230.0, "y": 240.0, "angle": 40.0, "tolerance": {"x": 40.0, "y": 40.0, "angle": 15.0}},
        {"x": 190.0, "y": 470.0, "angle": 85.0, "tolerance": {"x": 30.0, "y": 30.0, "angle": 3.0}},
    ],
    "max_designs": 3,
}
ASIDE = {"polygon": [[-700.0, -500.0], [-600.0, -500.0], [-600.0, 900.0], [-700.0, 900.0]]}
WITH_MORE = {
    "tolerances": TOLERATED,
    "tolerances, first too": {
        **TOLERATED,
        "positions": [
            {**TOLERATED["positions"][0], "tolerance": {"x": 5.0, "y": 5.0, "angle": 5.0}},
            *TOLERATED["positions"][1:],
        ],
    },
    "tolerances and a slider": {**TOLERATED, "output_side": {"dyad": "PR"}},
    "slider": {**LID, "output_side": {"dyad": "PR"}, "max_designs": 3},
    "driver dyad": {**LID, "driver_dyad": True, "max_designs": 2},
    "constraints": {**LID, "constraints": {"min_transmission_angle": 40.0, "max_link_ratio": 4.0}, "max_designs": 3},
    "layout": {
        **LID,
        "layout": {"link_width": 20.0, "pin_diameter": 8.0, "thickness": 5.0, "max_planes": 3},
        "max_designs": 3,
    },
    "four positions": {
        **LID,
        "positions": [*LID["positions"], {"x": 120.0, "y": 560.0, "angle": 110.0}],
        "max_designs": 3,
    },
}
"""What else a motion can state."""


@pytest.mark.slow
@pytest.mark.parametrize(
    "name", further(WITH_MORE, ["tolerances and a slider", "slider", "constraints", "layout", "four positions"])
)
def test_a_room_is_kept_beside_other_demands(client, name):
    space = {"obstacles": [ASIDE], "clearance": 5.0, "link_width": 10.0, "body": {"outline": LEAF}}
    job = finished(client, with_space(WITH_MORE[name], **space))
    assert job["status"] == "succeeded", job["error"]
    designs = job["result"]["designs"]
    assert designs, job["result"]["summary"]
    for design in designs:
        checks = {check["name"]: check for check in design["verification"]["checks"]}
        assert design["verification"]["passed"]
        assert checks["obstacles"]["limit"] == 5.0
        shapes = swept_shapes(design, space, WITH_MORE[name])
        nearest = shapely.distance(shapes, geometry(ASIDE)).min()
        size = float(np.abs(np.array(list(joints_of(design).values()))).max())
        assert nearest - 2e-3 * size <= checks["obstacles"]["value"] <= nearest + 1e-6 * size
        assert nearest >= 5.0


@pytest.mark.slow
def test_designs_that_fail_are_measured_too(client):
    problem = {
        **with_space(LID, obstacles=[SHELF]),
        "constraints": {"min_transmission_angle": 89.0},
        "include_failed": True,
    }
    designs = finished(client, problem)["result"]["designs"]
    assert designs
    assert all("obstacles" in {check["name"] for check in d["verification"]["checks"]} for d in designs)
