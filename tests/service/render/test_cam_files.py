"""Files of cams: the sheet's parts and places, the drawing's splines and arcs, the inspection table."""

from __future__ import annotations

import csv
import io
import math
from functools import cache
from typing import Any
from xml.etree import ElementTree

import ezdxf
import numpy as np
import pytest
from ezdxf.path import make_path

from service.render import export_design
from service.render.cam.animation import _draw_holder
from service.render.cam.scene import CamScene
from service.render.page.diagrams import find_ticks
from synthesis.kinds.cam.design import CamDesign
from synthesis.kinds.cam.problem import CamProblem
from synthesis.kinds.cam.solver import solve_cam

FOLLOWERS: dict[str, dict[str, Any]] = {
    "translating_roller": {"roller_radius": 8.0, "offset": 5.0},
    "oscillating_roller": {"roller_radius": 8.0, "arm": 80.0, "pivot_distance": 100.0, "sense": -1},
    "translating_flat": {"base_radius": 30.0},
    "oscillating_flat": {"pivot_distance": 120.0, "face_offset": 6.0, "base_radius": 45.0},
}

SVG = "{http://www.w3.org/2000/svg}"


@cache
def solved(kind: str, rotation: str = "ccw") -> tuple[CamDesign, CamProblem]:
    problem = CamProblem.model_validate(
        {
            "kind": "cam",
            "segments": [
                {"motion": "rise", "angle": 120.0, "lift": 10.0, "law": "cycloidal"},
                {"motion": "dwell", "angle": 60.0},
                {"motion": "return", "angle": 180.0, "law": "modified_sine"},
            ],
            "follower": {"type": kind, **FOLLOWERS[kind]},
            "rotation": rotation,
            "profile_points": 360,
        }
    )
    result = solve_cam(problem, lambda _fraction, _message: None)
    assert result.designs, result.summary
    return result.designs[0], problem


def sheet(kind: str, rotation: str = "ccw", title: str = "A cam") -> ElementTree.Element:
    return ElementTree.fromstring(export_design(*solved(kind, rotation), title, "svg"))


def part(drawing: ElementTree.Element, name: str) -> ElementTree.Element | None:
    return next((found for found in drawing.iter() if found.get("data-part") == name), None)


@pytest.mark.parametrize("kind", FOLLOWERS)
def test_a_sheet_shows_every_part_of_its_cam(kind: str) -> None:
    drawing = sheet(kind)
    roller = kind.endswith("roller")
    for name in ("profile", "base circle", "follower", "other positions", "cam angles", "centre", "rotation"):
        assert part(drawing, name) is not None, name
    for name in ("prime circle", "pitch curve"):
        assert (part(drawing, name) is not None) is roller
    diagrams = {found.get("data-diagram") for found in drawing.iter()} - {None}
    expected = {"s", "v", "a", "j", "curvature"}
    assert diagrams == (expected | {"pressure_angle"} if kind != "translating_flat" else expected)
    blocks = {found.get("data-block") for found in drawing.iter()} - {None}
    assert {"dimensions", "segments", "checks", "metrics"} <= blocks


@pytest.mark.parametrize("kind", FOLLOWERS)
def test_a_sheet_stands_alone(kind: str) -> None:
    text = export_design(*solved(kind), "A <cam> & more", "svg")
    drawing = ElementTree.fromstring(text)
    assert "nan" not in text
    assert "inf" not in text.replace("info", "")
    assert not [found for found in drawing.iter() if found.get("id") or found.tag in (f"{SVG}script", f"{SVG}style")]
    assert drawing.find(f"{SVG}title").text == "A <cam> & more"
    assert text == export_design(*solved(kind), "A <cam> & more", "svg")
    height, width = float(drawing.get("height")), float(drawing.get("width"))
    for found in drawing.iter(f"{SVG}text"):
        assert 0.0 <= float(found.get("x")) <= width
        assert 0.0 <= float(found.get("y")) <= height


def circles(group: ElementTree.Element) -> list[tuple[complex, float]]:
    return [(complex(float(c.get("cx")), float(c.get("cy"))), float(c.get("r"))) for c in group.iter(f"{SVG}circle")]


@pytest.mark.parametrize("rotation", ["ccw", "cw"])
def test_places_on_the_sheet_are_those_of_the_cam(rotation: str) -> None:
    design, _ = solved("translating_roller", rotation)
    drawing = sheet("translating_roller", rotation)
    ((centre, base),) = circles_of(drawing, "base circle")
    ((_, prime),) = circles_of(drawing, "prime circle")
    assert prime / base == pytest.approx(
        design.mechanism.prime_radius / (design.mechanism.prime_radius - 8.0), abs=1e-3
    )
    scale = prime / design.mechanism.prime_radius
    roller, radius = circles(part(drawing, "follower"))[0]
    place = (roller - centre).conjugate() / scale
    assert radius / scale == pytest.approx(8.0, abs=0.05)
    pitch = design.mechanism.pitch_curve
    assert place == pytest.approx(complex(pitch.x[0], pitch.y[0]), abs=0.05)
    # An offset that lowers the pressure angle of the rise is on the side that the cam turns away from.
    assert (place.imag < 0.0) is (rotation == "ccw")
    assert part(drawing, "rotation").get("data-rotation") == rotation
    envelope = circles(part(drawing, "other positions"))
    profile = [complex(x, y) for x, y in zip(design.mechanism.profile.x, design.mechanism.profile.y, strict=True)]
    for at, reach in envelope:
        place = (at - centre).conjugate() / scale
        assert min(abs(place - point) for point in profile) == pytest.approx(reach / scale, abs=0.05)


def circles_of(drawing: ElementTree.Element, name: str) -> list[tuple[complex, float]]:
    found = part(drawing, name)
    assert found is not None
    return circles(found)


@pytest.mark.parametrize("rotation", ["ccw", "cw"])
@pytest.mark.parametrize("kind", ["translating_flat", "oscillating_flat"])
def test_drawn_faces_lie_along_the_profile(kind: str, rotation: str) -> None:
    scene = CamScene(solved(kind, rotation)[0].mechanism)
    every = 20
    for k, (start, end) in enumerate(scene.list_faces(every)):
        along = (end - start) / abs(end - start)
        height = ((scene.profile - start) * np.conj(along)).imag
        # The whole cam is on one side of every face and touches it.
        assert min(height.max(), -height.min()) == pytest.approx(0.0, abs=2e-3), k
        if scene.pivot is not None:
            pivot = scene.pivot * scene.find_station(float(scene.angle[k * every]))
            assert abs(((pivot - start) * np.conj(along)).imag) == pytest.approx(6.0, abs=1e-4)


@pytest.mark.parametrize("rotation", ["ccw", "cw"])
def test_an_animated_face_lies_along_the_turned_profile(rotation: str) -> None:
    scene = CamScene(solved("oscillating_flat", rotation)[0].mechanism)
    theta = np.radians(np.arange(0.0, 360.0, 15.0))
    contact = scene.contour.follow(scene.follower, theta, scene.mechanism.rotation)
    for turn, point in zip(np.exp(1j * scene.sense * theta), contact.point, strict=True):
        start, end = _draw_holder(scene, complex(point * turn), 0j, 0.0)[0].points
        along = (end - start) / abs(end - start)
        height = ((scene.profile * turn - start) * np.conj(along)).imag
        assert min(height.max(), -height.min()) == pytest.approx(0.0, abs=2e-3)


def drawing_of(kind: str) -> ezdxf.document.Drawing:
    return ezdxf.read(io.StringIO(export_design(*solved(kind), "A cam", "dxf")))


@pytest.mark.slow
@pytest.mark.parametrize("kind", FOLLOWERS)
def test_a_dxf_is_sound_and_layered(kind: str) -> None:
    document = drawing_of(kind)
    audit = document.audit()
    assert not audit.errors
    assert not audit.fixes
    assert document.units == ezdxf.units.MM
    layers = {entity.dxf.layer for entity in document.modelspace()}
    expected = {"PROFILE", "PROFILE_ARCS", "BASE_CIRCLE", "FOLLOWER", "CENTRE"}
    assert layers == (expected | {"PRIME_CIRCLE", "PITCH_CURVE"} if kind.endswith("roller") else expected)
    assert export_design(*solved(kind), "A cam", "dxf") == export_design(*solved(kind), "A cam", "dxf")


def distances(points: np.ndarray, curve: np.ndarray) -> np.ndarray:
    """From each point to the nearest chord of a dense curve that ends where it begins."""
    start, chord = curve[:-1], np.diff(curve)
    start, chord = start[chord != 0.0], chord[chord != 0.0]
    share = ((points[:, None] - start) * np.conj(chord)).real / np.abs(chord) ** 2
    return np.abs(points[:, None] - start - np.clip(share, 0.0, 1.0) * chord).min(axis=1)


@pytest.mark.parametrize("kind", FOLLOWERS)
def test_splines_and_arcs_follow_the_profile(kind: str) -> None:
    scene = CamScene(solved(kind)[0].mechanism)
    space = drawing_of(kind).modelspace()
    (spline,), (arcs,) = space.query("SPLINE[layer=='PROFILE']"), space.query("LWPOLYLINE[layer=='PROFILE_ARCS']")
    size = scene.base_radius
    tool = spline.construction_tool()
    flat = np.array([complex(p.x, p.y) for p in tool.approximate(8 * len(scene.profile))])
    assert distances(scene.profile, flat).max() < 2e-5 * size
    between = np.radians(scene.angle + 0.5)
    fine = scene.contour.follow(scene.follower, between, scene.mechanism.rotation).point
    assert distances(fine, flat).max() < 2e-5 * size
    assert distances(np.exp(1e-3j) * fine, flat).max() > 2e-5 * size
    assert spline.closed
    polyline = np.array([complex(p.x, p.y) for p in make_path(arcs).flattening(1e-6 * size)])
    assert distances(scene.profile, polyline).max() < 3e-5 * size
    assert len(arcs) < len(scene.profile)
    assert turns_at_vertices(arcs).max() < 1e-6


def turns_at_vertices(polyline: ezdxf.entities.LWPolyline) -> np.ndarray:
    """Angles between the arcs that meet at each vertex."""
    rows = np.array(list(polyline.get_points("xyb")))
    at, sweep = rows[:, 0] + 1j * rows[:, 1], 4.0 * np.arctan(rows[:, 2])
    chord = np.roll(at, -1) - at
    leaves, arrives = chord * np.exp(-0.5j * sweep), chord * np.exp(0.5j * sweep)
    return np.abs(np.angle(leaves * np.conj(np.roll(arrives, 1))))


@pytest.mark.parametrize("kind", FOLLOWERS)
def test_the_table_lists_program_contact_and_profile(kind: str) -> None:
    design, _ = solved(kind)
    text = export_design(design, solved(kind)[1], "A cam", "csv")
    lines = [line for line in text.splitlines() if not line.startswith("#")]
    rows = list(csv.DictReader(lines))
    assert len(rows) == len(design.mechanism.program.angle)
    column = {name.split(" [")[0]: np.array([float(row[name] or "nan") for row in rows]) for name in rows[0]}
    assert column["s"] == pytest.approx(design.mechanism.program.s, abs=1e-9)
    assert column["profile_radius"] == pytest.approx(np.hypot(column["profile_x"], column["profile_y"]))
    polar = column["profile_radius"] * np.exp(1j * np.radians(column["profile_polar_angle"]))
    assert polar.imag == pytest.approx(column["profile_y"], abs=1e-6)
    assert column["profile_x"] == pytest.approx(design.mechanism.profile.x, abs=1e-3)
    assert ("roller_centre_x" in column) is kind.endswith("roller")
    if kind.endswith("roller"):
        off = np.hypot(column["roller_centre_x"] - column["profile_x"], column["roller_centre_y"] - column["profile_y"])
        assert off == pytest.approx(np.full(len(rows), 8.0), abs=1e-5)
        measured = design.metrics.max_pressure_angle_rise, design.metrics.max_pressure_angle_fall
        assert np.nanmax(column["pressure_angle"]) == pytest.approx(max(measured), abs=0.05)


def test_ticks_are_round_and_cover_the_values() -> None:
    for low, high in ((0.0, 1.0), (-3.7, 12.2), (1e-7, 3e-7), (5.0, 5.0), (0.0, 0.0), (-1e6, -2e5)):
        marks = find_ticks([low, high])
        assert marks[0] <= low + 1e-9 * abs(low)
        assert marks[-1] >= high - 1e-9 * abs(high)
        assert 2 <= len(marks) <= 8
        step = marks[1] - marks[0]
        digit = step / 10.0 ** math.floor(math.log10(step) + 1e-9)
        assert min(abs(digit - round_one) for round_one in (1.0, 2.0, 5.0, 10.0)) < 1e-6
