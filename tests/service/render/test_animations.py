"""Animations: GIFs of every family, bounded in size, that move as the mechanism does."""

from __future__ import annotations

import copy
import io

import numpy as np
import pytest
from PIL import Image

from kinematics.cam.profile import space_angles
from service.render import export_design
from service.render.cam.animation import _compute_spin
from service.render.cam.scene import CamScene
from service.render.gears import turning
from service.render.gears.gearbox_animation import compute_gearbox_speeds
from service.render.gears.gearbox_layout import arrange_gearbox, arrange_layshaft
from service.render.gears.series_layout import arrange_series
from service.render.page.animation import FRAME_COUNT, FRAME_SIZE, Stroke, draw_gif, make_circle
from service.render.page.svg import Box
from synthesis.dispatch import solve
from synthesis.registry import list_examples, parse_problem
from tests.campaign import further

CAM = list_examples("cam")[0]
ARM = {"type": "oscillating_roller", "roller_radius": 8.0, "arm": 120.0, "pivot_distance": 150.0}
STATED = {
    "cam": CAM,
    "cam under an arm": CAM | {"follower": ARM, "rotation": "cw"},
    "groove": CAM | {"closure": "form"},
    "valve": list_examples("cam")[3],
    "barrel": list_examples("cam")[4],
    "motion": list_examples("motion")[0],
    "gear train": list_examples("gear_train")[0],
    "planetary train": list_examples("planetary_train")[0],
    "trains in series": list_examples("train_series")[2],
    "gearbox": list_examples("gearbox")[0],
    "layshaft gearbox": list_examples("layshaft_gearbox")[0],
}


def designed(name):
    statement = copy.deepcopy(STATED[name])
    if "arm" in name:
        for segment in statement["segments"]:
            if "lift" in segment:
                segment["lift"] = 10.0
    problem = parse_problem(statement)
    return solve(problem, lambda fraction, message: None).designs[0], problem


@pytest.mark.slow
@pytest.mark.parametrize("name", further(STATED, ("groove", "motion", "gear train", "planetary train", "gearbox")))
def test_a_cycle_in_bounded_frames(name):
    design, problem = designed(name)
    file = export_design(design, problem, "title", "gif")
    assert len(file) < 1_000_000
    assert file == export_design(design, problem, "other title", "gif")
    picture = Image.open(io.BytesIO(file))
    assert picture.format == "GIF"
    assert picture.info["loop"] == 0
    assert picture.n_frames > 0.8 * FRAME_COUNT
    assert max(picture.size) == FRAME_SIZE
    shown = []
    for k in (0, picture.n_frames // 3, picture.n_frames // 2):
        picture.seek(k)
        shown.append(np.asarray(picture.convert("L")))
    for one, other in ((0, 1), (1, 2), (0, 2)):
        assert (np.abs(shown[one].astype(int) - shown[other]) > 60).sum() > 100
    # The margin stays empty: nothing is cut off at the border.
    for frame in shown:
        border = np.concatenate([frame[:3].ravel(), frame[-3:].ravel(), frame[:, :3].ravel(), frame[:, -3:].ravel()])
        assert border.min() > 200 or name == "barrel"


@pytest.mark.parametrize("name", ["cam", "cam under an arm"])
def test_the_roller_rolls_without_slip(name):
    """At the contact the surfaces of cam and roller have one velocity along the tangent."""
    design, _ = designed(name)
    scene = CamScene(design.mechanism)
    radius = scene.roller.roller_radius
    theta = space_angles(FRAME_COUNT)
    contact = scene.contour.follow(scene.follower, theta, scene.mechanism.rotation)
    turns = np.exp(1j * scene.sense * theta)
    point, normal = contact.point * turns, contact.normal * turns
    spin = _compute_spin(scene, contact.point, np.unwrap(np.angle(-normal)), radius)

    def rate(values):
        return (values[2:] - values[:-2]) / (theta[2:] - theta[:-2])

    centre = point + radius * normal
    cam = 1j * scene.sense * point[1:-1]
    roller = rate(centre) - 1j * rate(spin) * radius * normal[1:-1]
    tangent = 1j * normal[1:-1]
    slip = ((cam - roller) * np.conj(tangent)).real
    assert np.abs(slip).max() < 0.01 * np.abs(cam).max()


def test_what_is_far_away_or_large_is_drawn_all_the_same():
    far = 1e6 * (1 + 1j)
    frames = [[Stroke(far + make_circle(complex(k), 2.0), "#000000", 2.0, closed=True)] for k in range(3)]
    many = [[Stroke(np.linspace(0.0, 1.0, 100_000) * (k + 1j), "#000000", 1.0)] for k in range(3)]
    for shown, box in ((frames, Box.enclose(far + make_circle(1j, 4.0))), (many, Box(0.0, 0.0, 2.0, 1.0))):
        picture = Image.open(io.BytesIO(draw_gif(shown, box)))
        assert np.asarray(picture.convert("L")).min() < 100


@pytest.mark.slow
def test_over_http(client):
    job = client.post("/v1/jobs", json={"problem": CAM}, headers={"Prefer": "wait=30"}).json()
    answer = client.get(f"/v1/jobs/{job['id']}/designs/0.gif")
    assert answer.status_code == 200
    assert answer.headers["content-type"] == "image/gif"
    assert Image.open(io.BytesIO(answer.content)).n_frames > 40
    assert client.get(f"/v1/jobs/{job['id']}/designs/7.gif").status_code == 404


@pytest.mark.parametrize("name", ["planetary train", "trains in series"])
def test_planets_roll_between_their_mates(name, monkeypatch):
    """At every frame the flanks in mesh move at one speed: a tooth of a planet stays in the space that it stood in."""
    design, problem = designed(name)
    layout = arrange_series(design, problem) if name == "trains in series" else None
    if layout is None:
        shown = []
        monkeypatch.setattr(turning, "draw_turning_gears", lambda gears: shown.extend(gears) or b"")
        turning.draw_planetary_animation(design, problem, "")
    else:
        shown = [turning.TurningGear(g.placed, g.speed, g.orbit, g.axis, 0, g.toothed) for g in layout]
    planets = [gear for gear in shown if gear.orbit and gear.placed.centre != gear.axis]
    assert planets
    # The equation below holds of a train that stands still too: the input turns by 1, the output by 1 over the ratio.
    ratio = design.mechanism.ratio
    turns = {gear.speed for gear in shown} | {gear.orbit for gear in planets}
    assert any(turn == pytest.approx(1.0) for turn in turns)
    assert any(turn == pytest.approx(ratio.denominator / ratio.numerator) for turn in turns)
    met = 0
    for planet in planets:
        for mate in (gear for gear in shown if gear.placed.centre == planet.axis):
            apart = abs(planet.placed.centre - planet.axis)
            sizes = planet.placed.pitch_radius, mate.placed.pitch_radius
            internal = mate.placed.gear.internal
            if apart != pytest.approx(sizes[1] - sizes[0] if internal else sum(sizes)):
                continue
            met += 1
            # Past the carrier both pitch circles roll on each other.
            rolled = [(one.speed - planet.orbit) * size for one, size in zip((planet, mate), sizes, strict=True)]
            assert rolled[0] == pytest.approx(rolled[1] if internal else -rolled[1])
            assert abs(rolled[0]) > 1e-3
    assert met >= 2 * len({planet.placed.centre for planet in planets})


def test_a_carrier_has_the_colour_of_its_part(monkeypatch):
    """Where the arms drive or are driven they are blue or green, and what is held is dark, as on the sheet."""
    roles = {"input": turning.INPUT, "output": turning.OUTPUT, "fixed": turning.GROUND}
    for ratio, order in ((4, "sun carrier ring"), (0.25, "carrier sun ring"), (-3, "sun ring carrier")):
        parts = order.split()
        stated = dict(zip(roles, parts, strict=True))
        problem = parse_problem({"kind": "planetary_train", "ratio": ratio, "arrangement": "simple", **stated})
        design = solve(problem).designs[0]
        shown = []
        monkeypatch.setattr(turning, "draw_turning_gears", lambda gears, shown=shown: shown.extend(gears) or b"")
        turning.draw_planetary_animation(design, problem, "")
        colours = {gear.placed.body: turning.GEAR_COLOURS[gear.tone] for gear in shown}
        colours["carrier"] = next(gear.arm for gear in shown if gear.placed.body == "planet")
        assert {part: colours[body] for part, body in stated.items()} == roles
        monkeypatch.undo()
        # A carrier that is held does not turn: it has no arms.
        arms = {
            stroke.colour for stroke in turning._draw_arms([turning._make_gear_outline(gear) for gear in shown], 0.3)
        }
        assert arms == ({colours["carrier"]} - {turning.GROUND})


def test_a_gearbox_goes_through_all_its_speeds():
    """The output turns as fast as each row of the answer says, in that order."""
    design, _ = designed("gearbox")
    layout = arrange_gearbox(design.mechanism)
    for row in design.metrics.speeds:
        names = [f"STAGE_{stage}_PAIR_{pair + 1}" for stage, pair in enumerate(row.engaged, 1)]
        spindle = compute_gearbox_speeds(layout, names)[names[-1], len(design.mechanism.stages)]
        assert abs(spindle) == pytest.approx(row.speed / design.mechanism.input_speed)
        assert (spindle > 0) == (len(names) % 2 == 0)
    box, _ = designed("layshaft gearbox")
    head = box.mechanism.head
    for number, gear in enumerate(box.mechanism.gears, 1):
        if gear.layshaft is not None:
            speeds = compute_gearbox_speeds(arrange_layshaft(box.mechanism), ["HEAD", f"GEAR_{number}"])
            assert 1 / speeds[f"GEAR_{number}", 2] == pytest.approx(gear.ratio.value)
            assert speeds["HEAD", 1] == pytest.approx(-head.driver / head.driven)
    if box.mechanism.reverse is not None:
        speeds = compute_gearbox_speeds(arrange_layshaft(box.mechanism), ["HEAD", "REVERSE"])
        assert 1 / speeds["REVERSE", 2] == pytest.approx(box.mechanism.reverse.ratio.value)
