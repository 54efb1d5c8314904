"""``POST /v1/imports``: curves of drawings, tables and pictures as points, by shapes that are known without it."""

import io
import math
import time

import ezdxf
import numpy as np
import pytest
import shapely
from ezdxf.math import BSpline
from scipy.interpolate import CubicSpline

from tests.support.service.answers import finished
from tests.support.service.drawn_files import dxf, page
from tests.support.service.imports import TABLES, blob, found, picture, read

SVG = "image/svg+xml"
DXF = "image/vnd.dxf"
CSV = "text/csv"
PNG = "image/png"
PAGE = {"width": "100mm", "height": "100mm", "viewBox": "0 0 100 100"}


def only(client, content, media_type="application/octet-stream", **query):
    (curve,) = found(client, content, media_type, **query)["curves"]
    return curve


def refused(client, content, status, media_type="application/octet-stream", **query):
    answer = read(client, content, media_type, **query)
    assert answer.status_code == status, answer.text
    assert answer.headers["content-type"] == "application/problem+json"
    return answer.json()


def places(curve):
    return np.array([complex(point["x"], point["y"]) for point in curve["points"]])


def chords(curve):
    """The chords of a curve as a geometry."""
    z = places(curve)
    z = np.append(z, z[0]) if curve["closed"] else z
    return shapely.LineString(np.stack([z.real, z.imag], axis=1))


def away(curve, points):
    """The greatest distance of points from the chords of a curve."""
    return float(shapely.distance(chords(curve), shapely.points(points.real, points.imag)).max())


def cubic(p, t):
    return (1 - t) ** 3 * p[0] + 3 * (1 - t) ** 2 * t * p[1] + 3 * (1 - t) * t**2 * p[2] + t**3 * p[3]


T = np.linspace(0.0, 1.0, 2001)


# Drawings.


@pytest.mark.slow
def test_an_open_curve_of_an_svg_in_the_unit_that_is_asked_for(client):
    drawing = page(
        '<g transform="translate(5 0)"><path id="way" d="M10 90 C20 40 60 40 70 80"/></g>',
        width="200mm", height="200mm", viewBox="0 0 100 100",
    )  # fmt: skip
    answer = found(client, drawing, SVG)
    assert (answer["format"], answer["millimetres_per_unit"], answer["length_unit"]) == ("svg", 2.0, "mm")
    (curve,) = answer["curves"]
    assert (curve["element"], curve["id"], curve["closed"], curve["joined"]) == ("path", "way", False, 1)
    # Turned over and moved by hand.
    true = 2 * cubic(np.array([15 + 10j, 25 + 60j, 65 + 60j, 75 + 20j]), T)
    assert places(curve)[[0, -1]] == pytest.approx(true[[0, -1]])
    assert away(curve, true) <= curve["tolerance"] * (1 + 1e-9)
    assert curve["tolerance"] <= 5e-4 * max(np.ptp(true.real), np.ptp(true.imag)) * (1 + 1e-6)
    assert curve["length"] == pytest.approx(np.abs(np.diff(true)).sum(), rel=1e-6)
    assert 8 < len(curve["points"]) < 60
    for unit, factor in (("cm", 0.1), ("m", 1e-3), ("in", 1 / 25.4)):
        other = found(client, drawing, SVG, length_unit=unit)
        assert (other["length_unit"], other["scale"]) == (unit, pytest.approx(2 * factor))
        assert places(other["curves"][0]) == pytest.approx(factor * places(curve))
        assert other["curves"][0]["length"] == pytest.approx(factor * curve["length"])
    unstated = found(client, page('<path d="M0 0h9"/>', viewBox="0 0 9 9"), SVG, length_unit="in")
    assert (unstated["length_unit"], unstated["millimetres_per_unit"], unstated["scale"]) == (None, None, 1)


def test_points_stand_close_where_a_curve_bends_and_far_apart_where_it_does_not(client):
    ellipse = page('<ellipse cx="50" cy="50" rx="48" ry="6"/>', **PAGE)
    for tolerance in (1.0, 0.1, 0.01):
        curve = only(client, ellipse, tolerance=tolerance)
        assert curve["closed"]
        turn = np.linspace(0, 2 * np.pi, 20_001)
        true = 50 + 50j + 48 * np.cos(turn) + 6j * np.sin(turn)
        assert away(curve, true) <= tolerance
        assert curve["tolerance"] <= tolerance
        z = places(curve)
        steps = np.abs(np.diff(z))
        blunt, sharp = steps[np.abs(z[:-1].real - 50) < 10], steps[np.abs(z[:-1].real - 50) > 46]
        # The radii of curvature are 48²/6 and 6²/48; chords go with their roots.
        assert blunt.mean() > 4 * sharp.mean()
        # No more than a third above what equal sagittas would take: ∮ds/√(8ρt).
        radius = np.abs(48 * np.sin(turn) - 6j * np.cos(turn)) ** 3 / (48 * 6)
        least = np.sum(np.abs(np.diff(true)) / np.sqrt(8 * tolerance * radius[1:]))
        assert len(z) < 1.34 * least + 8
    assert only(client, ellipse)["length"] == pytest.approx(np.abs(np.diff(true)).sum(), rel=1e-6)


def test_a_curve_has_no_more_points_than_it_may(client):
    disc = page('<circle cx="50" cy="50" r="40"/>', **PAGE)
    assert len(only(client, disc)["points"]) > 60
    for most in (3, 10, 24):
        curve = only(client, disc, max_points=most)
        z = places(curve)
        assert 0.9 * most <= len(z) <= most
        assert np.abs(z - (50 + 50j)) == pytest.approx(np.full(len(z), 40), rel=1e-6)
        turn = np.exp(1j * np.linspace(0, 2 * np.pi, 5000))
        assert away(curve, 50 + 50j + 40 * turn) == pytest.approx(curve["tolerance"], rel=0.02)
    # Ten thousand stated vertices, and a rectangle of which one corner goes.
    way = np.linspace(0, 2 * np.pi, 10_001)[:-1]
    many = " ".join(f"{50 + 40 * math.cos(t):.5f},{50 + 20 * math.sin(t):.5f}" for t in way)
    curve = only(client, page(f'<polygon points="{many}"/>', **PAGE))
    assert 900 <= len(curve["points"]) <= 1000
    assert away(curve, 50 + 50j + 40 * np.cos(way) - 20j * np.sin(way)) <= curve["tolerance"] + 1e-5 < 0.01
    assert len(only(client, page('<rect width="9" height="5"/>', **PAGE), max_points=3)["points"]) == 3


def test_corners_stay_as_they_stand_and_go_with_a_tolerance_that_is_asked_for(client):
    drawing = page('<path d="M0 100L10 100 20 99.9 30 100 30 100 40 90"/>', **PAGE)
    stated = only(client, drawing)
    assert places(stated) == pytest.approx(np.array([0, 10, 20 + 0.1j, 30, 40 + 10j]))
    assert stated["tolerance"] == 0
    thin = only(client, drawing, tolerance=0.2)
    assert places(thin) == pytest.approx(np.array([0, 30, 40 + 10j]))
    assert thin["tolerance"] == pytest.approx(0.1)


def test_loose_pieces_become_one_curve_in_its_order(client):
    pieces = page(
        '<path d="M30 10L20 10"/><path d="M10 10L20 10"/><line x1="40" y1="20" x2="30" y2="10"/>'
        '<path id="alone" d="M60 60h5"/><path d="M0 50h9v9"/><path d="M9 59h-9v-9"/>',
        **PAGE,
    )
    curves = found(client, pieces)["curves"]
    assert [(one["closed"], one["joined"]) for one in curves] == [(False, 3), (False, 1), (True, 2)]
    chain = places(curves[0])
    expected = np.array([10 + 90j, 20 + 90j, 30 + 90j, 40 + 80j])
    assert chain == pytest.approx(expected) or chain == pytest.approx(expected[::-1])
    assert len(curves[2]["points"]) == 4
    assert curves[2]["length"] == pytest.approx(36)
    # Three ends at one place are a fork: there the curves end.
    fork = found(client, page('<path d="M0 0h9"/><path d="M9 0v9"/><path d="M9 0l5 5"/>'))["curves"]
    assert [one["joined"] for one in fork] == [1, 1, 1]


def test_ends_that_nearly_meet_are_one_point_and_small_steps_within_a_curve_stay(client):
    pieces = '<path d="M0 0h30"/><path d="M30.00001 0v40"/><path d="M30 40.00001L0 0.00001"/>'
    steps = "".join(f"l0.001 {0.001 * (-1) ** k}" for k in range(99))
    ring, fine = found(client, page(f'{pieces}<path d="M500 0{steps}"/>'))["curves"]
    assert (ring["closed"], ring["joined"], len(ring["points"])) == (True, 3, 3)
    assert ring["length"] == pytest.approx(120, rel=1e-5)
    assert len(fine["points"]) == 100
    assert fine["length"] == pytest.approx(0.099 * math.sqrt(2))


@pytest.mark.slow
def test_any_curve_lies_within_its_tolerance(client):
    rng = np.random.default_rng(7)
    for trial in range(40):
        count = rng.integers(1, 5)
        corners = rng.normal(size=(3 * count + 1, 2)) * 10 ** rng.uniform(-2, 2)
        if trial % 3 == 0:
            corners = np.round(corners)  # some fall together
        if trial % 5 == 0:
            corners[:, 1] *= 1e-3  # folded
        z = corners @ np.array([1, 1j])
        if not np.ptp(z.real):
            continue
        told = "".join(
            "C" + " ".join(f"{x!r} {y!r}" for x, y in corners[k : k + 3].tolist()) for k in range(1, len(z), 3)
        )
        closed = trial % 4 == 0
        drawing = page(f'<path d="M{corners[0, 0]} {corners[0, 1]}{told}{"Z" if closed else ""}"/>')
        tolerance = float(np.ptp(corners) * 10 ** rng.uniform(-5, -0.5))
        most = (3, 50, 1000)[trial % 3]
        curve = only(client, drawing, tolerance=tolerance, max_points=most)
        true = np.conj(np.concatenate([cubic(z[k : k + 4], T) for k in range(0, len(z) - 1, 3)]))
        true = np.append(true, true[0]) if closed else true
        assert away(curve, true) <= curve["tolerance"] * (1 + 1e-6) + 1e-9 * np.abs(z).max(), trial
        assert len(curve["points"]) <= most
        assert curve["tolerance"] <= tolerance or most < 1000
        assert curve["length"] == pytest.approx(np.abs(np.diff(true)).sum(), rel=5e-3)


def test_curves_of_a_dxf(client):
    spline = BSpline([(0, 30), (10, 50), (30, 25), (50, 40), (60, 30)], order=4)

    def draw(space):
        space.add_lwpolyline([(0, 0, 1), (10, 0, 0), (20, 0, 0)], format="xyb", dxfattribs={"layer": "TRACK"})
        space.add_spline(dxfattribs={"layer": "WAY"}).apply_construction_tool(spline)
        space.add_arc((100, 0), 10, 0, 90)
        space.add_line((100, 10), (90, 10))
        space.add_ellipse((0, 100), (20, 0), 0.5, 0, math.pi)
        block = space.doc.blocks.new("HINGE")
        block.add_circle((5, 0), 2)
        space.add_blockref("HINGE", (50, 50), dxfattribs={"xscale": 3, "yscale": 3, "layer": "PINS"})

    answer = found(client, dxf(draw, units=5), DXF, tolerance=1e-3)
    assert (answer["format"], answer["millimetres_per_unit"], answer["scale"]) == ("dxf", 10.0, 10.0)
    track, way, bow, ellipse, pin = answer["curves"]
    assert [one["layer"] for one in answer["curves"]] == ["TRACK", "WAY", "0", "0", "PINS"]
    # A bulge of 1 is half a circle, to the right of the chord's middle.
    z = places(track)
    assert np.abs(z[:-1] - 50) == pytest.approx(np.full(len(z) - 1, 50), abs=1e-3)
    assert z.imag.min() == pytest.approx(-50, abs=1e-2)
    assert track["length"] == pytest.approx(50 * math.pi + 100, rel=1e-6)
    true = np.array([10 * complex(p.x, p.y) for p in spline.points(np.linspace(0, spline.max_t, 3000))])
    assert away(way, true) <= 1e-3
    assert bow["joined"] == 2
    assert bow["length"] == pytest.approx(50 * math.pi + 100, rel=1e-6)
    assert not ellipse["closed"]
    assert places(ellipse)[[0, -1]] == pytest.approx(np.array([200 + 1000j, -200 + 1000j]))
    assert (pin["name"], pin["closed"]) == ("HINGE", True)
    assert np.abs(places(pin) - (650 + 500j)) == pytest.approx(np.full(len(pin["points"]), 60), rel=1e-6)


def test_what_gives_no_curve_is_told(client):
    drawing = page(
        '<path d="M0 0h9"/><text id="t">Lid</text><path id="odd" d="M0 0 L 5 x"/><circle id="far" cx="1e300" r="1"/>'
    )
    answer = found(client, drawing)
    assert len(answer["curves"]) == 1
    assert answer["left_out_count"] == 3
    reasons = {one["id"]: one["reason"] for one in answer["left_out"]}
    assert "text" in reasons["t"]
    assert "path data" in reasons["odd"]
    assert "beyond" in reasons["far"]
    nothing = refused(client, page('<text id="t">Lid</text>'), 422)
    assert nothing["type"] == "/problems/invalid-drawing"
    assert nothing["errors"] == [{"path": "/t", "detail": "It is text; turn it into paths."}]
    assert "draws nothing" in refused(client, page(""), 422)["detail"]


def test_what_is_next_to_nothing_gives_no_curve_and_what_is_closed_stays_around_something(client):
    drawing = page(
        '<path id="fro" d="M0 0h9z"/><path id="dot" d="M5 5h1e-9"/><path id="point" d="M5 5z"/>'
        '<circle id="disc" cx="50" cy="50" r="9"/>'
    )
    for query in ({}, {"tolerance": 1e8}):
        answer = found(client, drawing, **query)
        (disc,) = answer["curves"]
        assert disc["closed"]
        assert len(disc["points"]) >= 3
        assert shapely.Polygon(chords(disc)).area > 80
        reasons = {one["id"]: one["reason"] for one in answer["left_out"]}
        assert "encloses no area" in reasons["fro"]
        assert "gap" in reasons["dot"]


def test_of_very_many_curves_the_largest_are_told(client):
    lines = "".join(f'<path id="p{k}" d="M0 {k}h{k % 50 + 1}"/>' for k in range(1200))
    answer = found(client, page(lines + '<path id="long" d="M-9 -9h99"/>'))
    assert len(answer["curves"]) == 1000
    assert answer["curves"][-1]["id"] == "long"
    assert answer["left_out_count"] == 201
    assert min(one["length"] for one in answer["curves"]) >= 9
    assert "smaller" in answer["left_out"][0]["reason"]


# Round trips.


def test_a_path_that_is_drawn_as_svg_comes_back(client):
    rng = np.random.default_rng(5)
    way = np.cumsum(rng.normal(size=60)) + 1j * np.cumsum(rng.normal(size=60))
    # As a drawing program writes it: y downwards on a page in millimetres, in a group that is turned and moved.
    low = complex(way.real.min(), way.imag.min())
    tall = float(np.ptp(way.imag))
    turn = np.exp(1j * np.radians(30))
    on_page = complex(0, tall) + np.conj(way - low)
    inside = (on_page - (3 + 2j)) / turn
    points = " ".join(f"{z.real!r},{z.imag!r}" for z in inside.tolist())
    drawing = page(
        f'<g transform="translate(3 2) rotate(30)"><polyline points="{points}"/></g>',
        width="50mm", height=f"{tall!r}mm", viewBox=f"0 0 50 {tall!r}",
    )  # fmt: skip
    curve = only(client, drawing, SVG)
    assert places(curve) == pytest.approx(way - low, abs=1e-6)
    assert curve["length"] == pytest.approx(np.abs(np.diff(way)).sum(), abs=1e-6)
    # A smooth one, as cubics: its points lie on it.
    smooth = CubicSpline(np.arange(len(way)), np.stack([way.real, way.imag], axis=1))
    ends = [complex(*smooth(k)) for k in range(len(way))]
    slopes = [complex(*smooth(k, 1)) / 3 for k in range(len(way))]
    pairs = [(ends[k] + slopes[k], ends[k + 1] - slopes[k + 1], ends[k + 1]) for k in range(len(way) - 1)]
    told = "".join("C" + " ".join(f"{z.real!r} {-z.imag!r}" for z in three) for three in pairs)
    curve = only(client, page(f'<path d="M{ends[0].real!r} {-ends[0].imag!r}{told}"/>', viewBox="0 0 9 9"), SVG)
    found_ = places(curve) - 9j
    dense = smooth(np.linspace(0, len(way) - 1, 60_001)) @ np.array([1, 1j])
    nearest = np.array([np.abs(dense - z).min() for z in found_])
    assert nearest.max() < 2e-3  # the distance of the dense points from one another
    lined = shapely.LineString(np.stack([dense.real, dense.imag], axis=1))
    assert shapely.distance(lined, shapely.points(found_.real, found_.imag)).max() < 1e-6


def test_an_outline_that_is_drawn_as_dxf_comes_back(client):
    rng = np.random.default_rng(6)
    outline = (20 + 5 * rng.random(40)) * np.exp(2j * np.pi * np.arange(40) / 40)

    def draw(space):
        space.add_lwpolyline([(z.real, z.imag) for z in outline], close=True)

    curve = only(client, dxf(draw, units=4), DXF)
    assert curve["closed"]
    assert places(curve) == pytest.approx(outline, abs=1e-6)


@pytest.mark.slow
def test_the_coupler_curve_of_a_design_comes_back_from_its_own_drawing(client):
    problem = {
        "kind": "motion",
        "positions": [{"x": 0.0, "y": 0.0, "angle": 0.0}, {"x": 10.0, "y": 5.0, "angle": 30.0}],
        "input_side": {"fixed_pivot": [0.0, -20.0], "rotations": [60.0]},
        "output_side": {"fixed_pivot": [20.0, -20.0], "rotations": [50.0]},
    }
    job = finished(client, problem)
    drawing = client.get(f"/v1/jobs/{job['id']}/designs/0.dxf").raise_for_status().content
    curves = found(client, drawing, DXF, tolerance=1e-5, max_points=10_000)["curves"]
    (coupler,) = [one for one in curves if one["layer"] == "COUPLER_CURVE"]
    # ezdxf follows the spline of the file by itself.
    (spline,) = ezdxf.read(io.StringIO(drawing.decode())).modelspace().query("SPLINE[layer=='COUPLER_CURVE']")
    tool = spline.construction_tool()
    dense = np.array([complex(p.x, p.y) for p in tool.points(np.linspace(0, tool.max_t, 20_000))])
    assert away(coupler, dense) < 1e-5 * 1.001
    lined = shapely.LineString(np.stack([dense.real, dense.imag], axis=1))
    z = places(coupler)
    assert shapely.distance(lined, shapely.points(z.real, z.imag)).max() < 1e-6 * np.abs(z).max()


@pytest.mark.parametrize("what", TABLES)
def test_tables_of_all_sorts(client, what):
    answer = found(client, TABLES[what].encode(), CSV)
    assert (answer["format"], answer["length_unit"], answer["millimetres_per_unit"]) == ("csv", None, None)
    (curve,) = answer["curves"]
    assert curve["points"] == [{"x": 0, "y": 1.5}, {"x": 2, "y": -3}]
    assert curve["length"] == pytest.approx(math.hypot(2, 4.5))
    assert (curve["closed"], curve["tolerance"], curve["element"]) == (False, 0, "points")


def test_a_table_with_a_unit_with_several_curves_and_with_one_that_comes_back(client):
    answer = found(client, b"x [cm];y [cm]\n0;0\n1;0\n1;1\n0;0\n\n5;5\n6;6\n", CSV, length_unit="mm")
    assert (answer["length_unit"], answer["scale"], answer["millimetres_per_unit"]) == ("mm", 10, 10)
    triangle, line = answer["curves"]
    assert triangle["closed"]
    assert places(triangle) == pytest.approx(np.array([0, 10, 10 + 10j]))
    assert triangle["name"] == "x, y"
    assert places(line) == pytest.approx(np.array([50 + 50j, 60 + 60j]))
    assert found(client, "x,y\n0,0\n1,1\n".encode("utf-16"), CSV)["curves"]


@pytest.mark.parametrize(
    ("table", "status", "word"),
    [
        ("x,y\n0,0\n1,b\n", 400, "Line 3"),
        ("x,y\n0,0\n1\n", 400, "Line 3"),
        ("0,0\n1,nan\n", 400, "Line 2"),
        ("0,0\n1,1e400\n", 422, "Line 2"),
        ("x,y\n", 422, "no points"),
        ("", 422, "no rows"),
        ("x\n1\n2\n", 422, "one column"),
        ("1,1\n1,1\n1,1\n", 422, "no curve"),
        ("0,0\n1," + "9" * 5000, 400, "Line 2"),
        ("0,0\n" + "1," * 5000, 400, "Line 2"),
        ("0,0\n1,1\0", 415, "neither"),
        ("0,0\n1,１\n", 400, "Line 2"),
    ],
)
def test_tables_that_are_none(client, table, status, word):
    assert word in str(refused(client, table.encode(), status, CSV))


def ellipse_about(centre, rx, ry, curve):
    """How far the points of a curve are from an ellipse, along the ray from its centre."""
    z = places(curve) - centre
    unit = np.hypot(z.real / rx, z.imag / ry)
    return float((np.abs(z) * np.abs(1 - 1 / unit)).max())


@pytest.mark.parametrize(
    ("content", "within"),
    [
        (picture(200, blob()), 0.15),
        (picture(200, blob(), colours=16), 0.2),
        (picture(200, blob(255), ground=0), 0.15),
        (picture(200, blob(90), ground=160), 0.15),
        (picture(200, blob((200, 30, 30, 255)), mode="RGBA", ground=(0, 0, 0, 0)), 0.15),
        (picture(200, blob((255, 255, 255, 255)), mode="RGBA", ground=(255, 255, 255, 0)), 0.15),
        (picture(200, blob(), finer=1), 0.8),
        (picture(200, blob(0), finer=1, mode="1", ground=1), 0.8),
    ],
    ids=["grey rim", "16 greys", "light on dark", "pale", "opaque", "white on nothing", "steps", "black and white"],
)  # fmt: skip
def test_the_outline_in_a_picture_to_a_fraction_of_a_pixel(client, content, within):
    answer = found(client, content, PNG)
    assert (answer["format"], answer["length_unit"], answer["scale"]) == ("png", None, 1)
    (curve,) = answer["curves"]
    assert (curve["element"], curve["closed"]) == ("contour", True)
    # y upwards, from the lower edge.
    assert ellipse_about(60 + 120j, 40, 20, curve) < within
    assert shapely.LinearRing(chords(curve).coords).is_ccw
    assert len(curve["points"]) < 200
    assert curve["length"] == pytest.approx(193.77, rel=0.01)  # Ramanujan's second formula


def test_the_scale_of_a_picture(client):
    stated = picture(200, blob(), dpi=(508, 508))
    answer = found(client, stated, PNG)
    assert answer["length_unit"] == "mm"
    assert answer["millimetres_per_unit"] == pytest.approx(0.05, rel=1e-3)  # whole pixels by the metre
    assert ellipse_about(3 + 6j, 2, 1, answer["curves"][0]) < 0.01
    inches = found(client, stated, PNG, length_unit="in")
    assert inches["length_unit"] == "in"
    assert ellipse_about((3 + 6j) / 25.4, 2 / 25.4, 1 / 25.4, inches["curves"][0]) < 0.01 / 25.4
    told = found(client, stated, PNG, pixel_size=0.5, length_unit="cm")
    assert (told["length_unit"], told["scale"], told["millimetres_per_unit"]) == ("cm", 0.5, 5)
    assert ellipse_about(30 + 60j, 20, 10, told["curves"][0]) < 0.1
    unlike = found(client, picture(200, blob(), dpi=(254, 508)), PNG)
    assert ellipse_about(6 + 6j, 4, 1, unlike["curves"][0]) < 0.02
    fine = only(client, stated, PNG, tolerance=0.1)
    assert len(fine["points"]) < len(answer["curves"][0]["points"]) / 2
    assert refused(client, b"0,0\n1,1\n", 422, CSV, pixel_size=2)["errors"][0]["path"] == "/query/pixel_size"


def test_holes_strokes_and_specks_of_a_picture(client):
    def draw(pen, k):
        pen.rectangle([20 * k, 20 * k, 120 * k, 120 * k], fill=0)
        pen.rectangle([50 * k, 50 * k, 90 * k, 90 * k], fill=255)
        pen.line([(130 * k, 20 * k), (190 * k, 80 * k)], fill=0, width=1)
        pen.point((150, 180), fill=0)

    answer = found(client, picture(200, draw, finer=1), PNG)
    outer, line, hole = answer["curves"]
    assert shapely.Polygon(chords(outer)).area == pytest.approx(101**2, rel=0.01)
    assert shapely.Polygon(chords(hole)).area == pytest.approx(41**2, rel=0.01)
    assert not shapely.LinearRing(chords(hole).coords).is_ccw
    # A line one pixel wide, aslant, is one contour and not sixty.
    assert line["length"] == pytest.approx(2 * 60 * math.sqrt(2), rel=0.05)
    assert answer["left_out_count"] == 1
    assert "few pixels" in answer["left_out"][0]["reason"]


# What it is for: statements that take the curves as they come.


@pytest.mark.slow
def test_an_imported_curve_is_a_path(client):
    # Four points of an SVG polyline are met exactly.
    drawing = page('<polyline points="0,60 10,45 25,40 40,48"/>', **PAGE)
    curve = only(client, drawing, SVG)
    job = finished(client, {"kind": "path", "points": curve["points"], "max_designs": 1})
    assert job["status"] == "succeeded"
    assert [(p["x"], p["y"]) for p in job["problem"]["points"]] == [(0, 40), (10, 55), (25, 60), (40, 52)]
    (design,) = job["result"]["designs"]
    assert design["verification"]["passed"]


def test_imported_curves_are_outline_and_obstacle(client):
    room = page('<circle id="post" cx="50" cy="450" r="20"/><path id="lid" d="M0 0h20v10h-20z"/>')
    curves = {one["id"]: [[p["x"], p["y"]] for p in one["points"]] for one in found(client, room, SVG)["curves"]}
    problem = {
        "kind": "motion",
        "positions": [{"x": 0.0, "y": 0.0, "angle": 0.0}, {"x": 10.0, "y": 5.0, "angle": 30.0}],
        "input_side": {"fixed_pivot": [0.0, -20.0], "rotations": [60.0]},
        "output_side": {"fixed_pivot": [20.0, -20.0], "rotations": [50.0]},
        "space": {"obstacles": [{"polygon": curves["post"]}], "body": {"outline": curves["lid"]}},
    }
    job = finished(client, problem)
    assert job["problem"]["space"]["obstacles"][0]["polygon"] == curves["post"]
    assert job["problem"]["space"]["body"]["outline"] == curves["lid"]
    assert job["status"] == "succeeded"


def tabulated(points):
    """A follower's motion through a table of cam angles and displacements, once around, as segments of a cam."""
    angle, lift = np.array(points).T
    spline = CubicSpline(np.radians(angle), lift, bc_type="periodic")

    def state(k, at):
        speed, rate = (float(spline(np.radians(angle[k]), order)) for order in (1, 2))
        return {"angle": at, "s": float(lift[k]), "v": speed, "a": rate}

    last = len(angle) - 1
    return [
        {"motion": "polynomial", "angle": wide, "conditions": [state(k, 0.0), state((k + 1) % last, wide)]}
        for k, wide in enumerate(np.diff(angle).tolist())
    ]


@pytest.mark.slow
def test_an_imported_table_is_the_motion_of_a_follower(client):
    angle = np.linspace(0.0, 360.0, 37)
    lift = 10.0 - 10.0 * np.cos(np.radians(angle)) + 2.0 * np.sin(2.0 * np.radians(angle)) ** 2
    lift[-1] = lift[0]
    table = "angle;s\n" + "".join(f"{a:g};{s:.6f}\n".replace(".", ",") for a, s in zip(angle, lift, strict=True))
    curve = only(client, table.encode(), CSV)
    points = [(p["x"], p["y"]) for p in curve["points"]]
    assert len(points) == 37
    problem = {
        "kind": "cam",
        "segments": tabulated(points),
        "follower": {"type": "translating_roller", "roller_radius": 5.0},
        "limits": {"pressure_angle": 30.0},
    }
    job = finished(client, problem)
    (design,) = job["result"]["designs"]
    assert design["verification"]["passed"]
    program = design["mechanism"]["program"]
    at = np.interp(angle, program["angle"], program["s"])
    assert at == pytest.approx(lift, abs=2e-3)


# What is asked wrongly.


def test_what_is_asked_wrongly(client):
    line = page('<path d="M0 0h9"/>')
    for name, value in (
        ("tolerance", 0), ("tolerance", "nan"), ("tolerance", 2e9), ("max_points", 2), ("max_points", 10_001),
        ("pixel_size", 0), ("pixel_size", "inf"), ("length_unit", "ft"), ("length_unit", ""),
    ):  # fmt: skip
        assert refused(client, line, 422, **{name: value})["errors"][0]["path"] == f"/query/{name}"
    assert refused(client, line, 415, "application/json")["type"] == "/problems/unsupported-media-type"
    assert "image/png" in read(client, line, "text/html").headers["accept"]
    # A table is announced as one, or as nothing.
    assert refused(client, b"0,0\n1,1\n", 415, SVG)["type"] == "/problems/unsupported-media-type"
    assert read(client, b"0,0\n1,1\n").status_code == 200
    assert read(client, line, CSV).json()["format"] == "svg"
    packed = client.post("/v1/imports", content=line, headers={"Content-Encoding": "gzip"})
    assert packed.status_code == 415
    assert client.post("/v1/imports", content=b" " * (1 << 20) + line).status_code == 413
    assert client.get("/v1/imports").status_code == 405


def test_it_takes_a_moment(client):
    drawing = page('<ellipse rx="30" ry="10"/>' * 50)
    found(client, drawing)
    began = time.monotonic()
    found(client, drawing)
    assert time.monotonic() - began < 5.0
