"""``POST /v1/outlines``: the outlines of SVG and DXF drawings, by areas and places that are known without it."""

import math

import numpy as np
import pytest
import shapely
from ezdxf.math import BSpline, ConstructionEllipse, closed_uniform_bspline

from tests.support.service.drawn_files import DXF, PLAIN, SVG, dxf, found, page, read, refused
from tests.support.service.outlines import SHAPES


def corners(outline):
    return np.array(outline["polygon"])


@pytest.mark.slow
def test_the_units_and_the_page_of_an_svg(client):
    drawing = page(
        '<rect id="frame" x="20" y="10" width="100" height="40"/>',
        width="210mm",
        height="148.5mm",
        viewBox="0 0 420 297",
    )
    own = found(client, drawing)
    assert own["format"] == "svg"
    assert own["millimetres_per_unit"] == pytest.approx(0.5)
    assert own["length_unit"] is None
    (outline,) = own["outlines"]
    # y is up from the lower edge of the page.
    assert corners(outline).min(axis=0) == pytest.approx([20, 297 - 50])
    assert outline["area"] == pytest.approx(4000)
    assert shapely.Polygon(outline["polygon"]).exterior.is_ccw
    assert (outline["element"], outline["id"], outline["joined"]) == ("rect", "frame", 1)
    for unit, factor in (("mm", 0.5), ("cm", 0.05), ("m", 5e-4), ("in", 0.5 / 25.4)):
        other = found(client, drawing, length_unit=unit)
        assert other["length_unit"] == unit
        assert other["scale"] == pytest.approx(factor)
        assert corners(other["outlines"][0]) == pytest.approx(factor * corners(outline))
        assert other["outlines"][0]["area"] == pytest.approx(4000 * factor**2)
        assert other["tolerance"] == pytest.approx(factor * own["tolerance"])


@pytest.mark.slow
@pytest.mark.parametrize(
    ("attributes", "millimetres", "low"),
    [
        ({}, None, [0, -10]),
        ({"width": "200", "height": "100"}, None, [0, 90]),
        ({"width": "200px", "height": "100px", "viewBox": "0 0 20 10"}, None, [0, 0]),
        ({"width": "2in", "height": "1in", "viewBox": "0 0 20 10"}, 2.54, [0, 0]),
        ({"width": "2in", "viewBox": "-5 -5 20 20"}, 2.54, [5, 5]),
        ({"width": "100%", "height": "100%", "viewBox": "0 0 20 10"}, None, [0, 0]),
        # It is fitted into the page by one scale, or by two where it says so; then the smaller one is the unit.
        ({"width": "200mm", "height": "50mm", "viewBox": "0 0 20 10"}, 5.0, [0, 0]),
    ],
)  # fmt: skip
def test_pages_of_all_sorts(client, attributes, millimetres, low):
    answer = found(client, page('<rect width="20" height="10"/>', **attributes), length_unit="mm")
    assert answer["millimetres_per_unit"] == (None if millimetres is None else pytest.approx(millimetres))
    assert answer["length_unit"] == (None if millimetres is None else "mm")
    scale = millimetres or 1.0
    place = corners(answer["outlines"][0])
    assert place.min(axis=0) == pytest.approx(scale * np.array(low))
    assert np.ptp(place, axis=0) == pytest.approx([20 * scale, 10 * scale])


def test_a_page_that_is_stretched(client):
    stretched = page(
        '<circle r="1" cx="1" cy="1"/>', width="40mm", height="10mm", viewBox="0 0 2 2", preserveAspectRatio="none"
    )
    (outline,) = found(client, stretched, length_unit="mm")["outlines"]
    assert np.ptp(corners(outline), axis=0) == pytest.approx([40, 10], rel=1e-3)


@pytest.mark.parametrize("shape", [shape for shape, known in SHAPES.items() if known])
def test_shapes_of_an_svg(client, shape):
    area, middle = SHAPES[shape]
    drawing = page(shape, viewBox="0 0 100 100")
    answer = found(client, drawing, tolerance=1e-3)
    (outline,) = answer["outlines"]
    polygon = shapely.Polygon(outline["polygon"])
    assert outline["area"] == pytest.approx(polygon.area)
    assert outline["area"] == pytest.approx(area, abs=1e-3 * polygon.length)
    west, south, east, north = polygon.bounds
    assert ((west + east) / 2, (south + north) / 2) == pytest.approx(middle, abs=2e-3)
    coarse = found(client, drawing, tolerance=1.0)["outlines"][0]
    assert abs(coarse["area"] - area) <= polygon.length
    assert len(coarse["polygon"]) <= len(outline["polygon"])


@pytest.mark.slow
def test_a_curve_lies_within_the_tolerance_and_not_in_more_points_than_it_takes(client):
    for tolerance in (1.0, 0.1, 0.01, 0.003):
        answer = found(client, page('<ellipse rx="300" ry="100" transform="rotate(30)"/>'), tolerance=tolerance)
        polygon = answer["outlines"][0]["polygon"]
        way = np.linspace(0, 2 * np.pi, 20_000)
        turn = np.exp(-1j * np.pi / 6)
        ellipse = turn * (300 * np.cos(way) + 100j * np.sin(way))
        ring = shapely.LinearRing(polygon)
        away = shapely.distance(ring, shapely.points(ellipse.real, ellipse.imag))
        assert away.max() <= tolerance
        # A circle around it takes a chord for each angle 2 acos(1 - tolerance/r).
        assert len(polygon) < 1.5 * math.pi / math.acos(1 - tolerance / 300) + 16


def test_circles_come_back_as_circles(client):
    round_ = page(
        '<circle id="a" cx="10" cy="20" r="5" transform="rotate(20) scale(2)"/>'
        '<ellipse id="b" cx="100" cy="20" rx="5" ry="5"/>'
        '<path id="c" d="M145 20a5 5 0 1 0 10 0a5 5 0 1 0-10 0z"/>'
        '<path id="d" d="m205 20c0 2.7614-2.2386 5-5 5s-5-2.2386-5-5 2.2386-5 5-5 5 2.2386 5 5z"/>'
        # No circles: one that is stretched, and a polygon of sixty corners.
        '<circle id="e" r="5" transform="translate(250 20) scale(1 1.01)"/>'
        '<polygon id="f" points="{}"/>'.format(
            " ".join(f"{300 + 5 * math.cos(t):.6f},{20 + 5 * math.sin(t):.6f}" for t in np.arange(60) * math.pi / 30)
        ),
    )
    outlines = {one["id"]: one for one in found(client, round_)["outlines"]}
    middle = 2 * complex(10, 20) * np.exp(1j * math.radians(20))
    assert outlines["a"]["circle"] == {
        "center": pytest.approx([middle.real, -middle.imag]),
        "radius": pytest.approx(10),
    }
    assert outlines["a"]["area"] == pytest.approx(math.pi * 100)
    for name, x in (("b", 100), ("c", 150), ("d", 200)):
        assert outlines[name]["circle"]["center"] == pytest.approx([x, -20], abs=1e-4)
        assert outlines[name]["circle"]["radius"] == pytest.approx(5, rel=5e-4)
        assert outlines[name]["polygon"] is None
    assert outlines["e"]["circle"] is outlines["f"]["circle"] is None
    assert len(outlines["f"]["polygon"]) == 60


def test_layers_and_names_of_an_svg_and_what_is_hidden(client):
    drawing = page(
        '<g inkscape:label="Wall" id="layer1"><rect id="r1" width="9" height="9"/>'
        '<g style="fill:none;display:none"><rect id="no" width="9" height="9"/></g></g>'
        '<g id="layer2"><path id="p" d="M0 0h9v9z"><title>Lid &amp; hinge</title></path></g>'
        '<rect id="bare" width="9" height="9"/><rect id="gone" display="none" width="9" height="9"/>'
        '<clipPath><rect id="clip" width="9" height="9"/></clipPath>'
    )
    told = [(one["id"], one["layer"], one["name"]) for one in found(client, drawing)["outlines"]]
    assert told == [("r1", "Wall", None), ("p", "layer2", "Lid & hinge"), ("bare", None, None)]


def test_what_is_left_out_is_told_with_its_reason(client):
    drawing = page(
        '<rect id="good" width="9" height="9"/><path id="open" d="M0 0h30v10"/>'
        '<polygon id="bow" points="0,0 10,10 10,0 0,10"/><polygon id="flat" points="0,0 10,10 5,5"/>'
        '<path id="odd" d="M0 0 L 5 x"/><path id="lead" d="M0 0 L 10 010e 3"/><text id="t">Lid</text>'
        '<rect id="turned" width="9" height="9" transform="spin(3)"/><rect id="share" width="50%" height="9"/>'
        '<use id="nothing" href="#missing"/><use id="away" href="https://example.org/x.svg#a"/>'
        '<circle id="far" r="1" cx="1e300"/><image id="pic" href="x.png"/>'
        '<svg id="inner" width="50%" height="9" viewBox="0 0 1 1"><rect width="1" height="1"/></svg>'
        '<svg id="whole" viewBox="0 0 1 1"><rect width="1" height="1"/></svg>'
        '<path id="t1" d="M50 50h9"/><path id="t2" d="M50 50v9"/><path id="t3" d="M50 50h-9"/>'
    )
    answer = found(client, drawing)
    assert [one["id"] for one in answer["outlines"]] == ["good"]
    reasons = {one["id"]: one["reason"] for one in answer["left_out"]}
    assert answer["left_out_count"] == len(reasons) == 17
    for name, word in {
        "open": "open: its ends are 31.62 apart", "bow": "meets itself (Self-intersection[5 -5])", "flat": "no area",
        "odd": "at character 8", "lead": "path data is wrong", "t": "text", "turned": "transform", "share": "width",
        "nothing": "not in the drawing", "away": "not in the drawing", "far": "1e+09", "pic": "picture",
        "inner": "depends on the page", "whole": "depends on the page",
        "t1": "more than two", "t2": "more than two", "t3": "more than two",
    }.items():  # fmt: skip
        assert word in reasons[name].replace("More", "more"), name


def test_lines_and_arcs_are_joined_at_their_ends(client):
    def slot(space):
        space.add_line((0, 0), (40, 0))
        space.add_line((40.0, 20.0000001), (0, 20))  # the other way round, and with a gap of rounding
        space.add_arc((0, 10), 10, 90, 270)
        space.add_arc((40, 10), 10, 270, 90)

    answer = found(client, dxf(slot, units=4), tolerance=0.01)
    (outline,) = answer["outlines"]
    assert outline["joined"] == 4
    assert outline["area"] == pytest.approx(800 + math.pi * 100, abs=0.01 * 150)
    assert answer["left_out_count"] == 0
    ring = page("".join(f'<line x1="{a}" y1="{b}" x2="{c}" y2="{d}"/>' for a, b, c, d in
                        ((0, 0, 30, 0), (30, 40, 30, 0), (30, 40, 0, 0))))  # fmt: skip
    (outline,) = found(client, ring)["outlines"]
    assert (outline["joined"], outline["area"]) == (3, pytest.approx(600))


def test_entities_of_a_dxf(client):
    tilted = ConstructionEllipse.from_arc((100, 0), 7)

    def draw(space):
        space.doc.layers.add("WALL")
        space.doc.layers.add("HIDDEN").off()
        square = [(0, 0), (10, 0), (10, 10), (0, 10)]
        space.add_lwpolyline(square, close=True, dxfattribs={"layer": "WALL"})
        space.add_lwpolyline([(20, 0, 1), (30, 0, 1)], format="xyb", close=True)
        space.add_lwpolyline([(40, 0, 0), (60, 0, 1), (60, 10, 0), (40, 10, 0)], format="xyb", close=True)
        space.add_polyline2d([(70, 0), (80, 0), (80, 5)], close=True)
        space.add_circle((0, 50), 8)
        space.add_circle((-30, 50), 8, dxfattribs={"extrusion": (0, 0, -1)})
        space.add_ellipse((60, 50), (10, 10), 0.5)
        space.add_spline().apply_construction_tool(BSpline.from_ellipse(tilted))
        space.add_spline().apply_construction_tool(closed_uniform_bspline(square))
        space.add_lwpolyline(square, close=True, dxfattribs={"layer": "HIDDEN"})
        space.add_line((0, 0), (0, 99))
        space.add_lwpolyline(square, close=True, dxfattribs={"extrusion": (1, 0, 1)})
        space.add_mtext("Lid")

    answer = found(client, dxf(draw, units=5), tolerance=0.01, length_unit="mm")
    assert (answer["millimetres_per_unit"], answer["length_unit"], answer["scale"]) == (10.0, "mm", 10.0)
    outlines = answer["outlines"]
    assert [one["element"] for one in outlines] == [
        "LWPOLYLINE", "LWPOLYLINE", "LWPOLYLINE", "POLYLINE", "CIRCLE", "CIRCLE", "ELLIPSE", "SPLINE", "SPLINE",
    ]  # fmt: skip
    assert [one["layer"] for one in outlines][:2] == ["WALL", "0"]
    assert all(one["id"] for one in outlines)
    circles = {k: one["circle"] for k, one in enumerate(outlines) if one["circle"]}
    assert {k: (*one["center"], one["radius"]) for k, one in circles.items()} == {
        1: pytest.approx((250, 0, 50)), 4: pytest.approx((0, 500, 80)), 5: pytest.approx((300, 500, 80)),
        7: pytest.approx((1000, 0, 70), abs=1e-3),
    }  # fmt: skip
    areas = [one["area"] / 100 for one in outlines]
    assert areas[0] == pytest.approx(100)
    assert areas[2] == pytest.approx(200 + math.pi * 12.5, abs=2e-2)
    assert areas[3] == pytest.approx(25)
    assert areas[6] == pytest.approx(math.pi * 200 * 0.5, abs=5e-2)
    # Against the basis functions of uniform cubics, sampled.
    t = np.linspace(0, 1, 2001)[:-1]
    basis = np.stack([(1 - t) ** 3, 3 * t**3 - 6 * t**2 + 4, -3 * t**3 + 3 * t**2 + 3 * t + 1, t**3]) / 6
    square = np.array([0, 10, 10 + 10j, 10j])
    ring = np.concatenate([np.roll(square, -k)[:4] @ basis for k in range(4)])
    assert areas[8] == pytest.approx(shapely.Polygon(np.stack([ring.real, ring.imag], 1)).area, rel=1e-3)
    reasons = [(one["element"], one["reason"]) for one in answer["left_out"]]
    assert [name for name, _ in reasons] == ["LWPOLYLINE", "MTEXT", "LINE"]
    assert "plane" in reasons[0][1]


def test_blocks_of_a_dxf_are_read_where_they_are_inserted(client):
    def draw(space):
        inner = space.doc.blocks.new("HINGE")
        inner.add_lwpolyline([(0, 0), (4, 0), (4, 3)], close=True)
        inner.add_circle((10, 0), 1, dxfattribs={"layer": "PINS"})
        outer = space.doc.blocks.new("DOOR")
        outer.add_blockref("HINGE", (100, 0))
        space.add_blockref("DOOR", (0, 50), dxfattribs={"rotation": 90, "xscale": 2, "yscale": 2, "layer": "LID"})
        space.add_blockref(
            "HINGE", (0, 0), dxfattribs={"row_count": 2, "row_spacing": 20, "column_count": 3, "column_spacing": 30}
        )

    outlines = found(client, dxf(draw))["outlines"]
    assert len(outlines) == 2 * 7
    triangle, pin = outlines[:2]
    assert triangle["name"] == "HINGE"
    assert (triangle["layer"], pin["layer"]) == ("LID", "PINS")
    assert triangle["area"] == pytest.approx(24)
    assert pin["circle"] == {"center": pytest.approx([0, 50 + 220]), "radius": pytest.approx(2)}
    assert outlines[-1]["circle"]["center"] == pytest.approx([70, 20])


@pytest.mark.parametrize("text", [PLAIN, PLAIN.replace("\n", "\r\n"), "999\nby hand\n" + PLAIN, "  " + PLAIN])
def test_a_dxf_with_nothing_but_entities(client, text):
    answer = found(client, text.encode())
    assert (answer["format"], answer["millimetres_per_unit"], answer["length_unit"]) == ("dxf", None, None)
    assert answer["outlines"][0]["circle"] == {"center": [3, 4], "radius": 5}


@pytest.mark.parametrize("media_type", [SVG, DXF, "application/dxf", "application/octet-stream", None])
def test_what_a_drawing_is_is_seen_by_its_beginning(client, media_type):
    for drawing in (page('<rect width="9" height="9"/>'), PLAIN.encode()):
        assert read(client, drawing, media_type).status_code == 200


def test_text_in_other_encodings_and_with_a_document_type(client):
    inside = '<rect id="ä" width="9" height="9"/>'
    doctype = '<!DOCTYPE svg PUBLIC "-//W3C//DTD SVG 1.1//EN" "http://www.w3.org/Graphics/SVG/1.1/DTD/svg11.dtd">'
    text = page(inside).decode()
    for content in (
        f'<?xml version="1.0" encoding="UTF-8"?>{doctype}{text}'.encode(),
        f'<?xml version="1.0" encoding="ISO-8859-1"?>{text}'.encode("latin-1"),
        f'<?xml version="1.0" encoding="UTF-16"?>{text}'.encode("utf-16"),
        b"\xef\xbb\xbf" + text.encode(),
    ):
        assert found(client, content)["outlines"][0]["id"] == "ä"


def test_a_long_polyline_is_thinned_within_the_tolerance(client):
    way = np.linspace(0, 2 * np.pi, 3001)[:-1]
    points = " ".join(f"{100 * math.cos(t):.4f},{60 * math.sin(t):.4f}" for t in way)
    (outline,) = found(client, page(f'<polygon points="{points}"/>'), tolerance=0.05)["outlines"]
    assert len(outline["polygon"]) <= 1000
    ring = shapely.LinearRing(outline["polygon"])
    assert max(ring.distance(shapely.Point(100 * math.cos(t), 60 * math.sin(t))) for t in way) <= 0.05


@pytest.mark.slow
def test_it_answers_the_same_again_and_as_a_statement_takes_it(client):
    drawing = page('<circle r="20" cx="50" cy="-400"/><rect x="200" y="-420" width="30" height="30" rx="9"/>')
    answer = found(client, drawing)
    assert found(client, drawing) == answer
    zones = [{name: one[name] for name in ("polygon", "circle") if one[name]} for one in answer["outlines"]]
    # Everything is chosen, so that there is one linkage and nothing to search.
    problem = {
        "kind": "motion",
        "positions": [{"x": 0.0, "y": 0.0, "angle": 0.0}, {"x": 10.0, "y": 5.0, "angle": 30.0}],
        "input_side": {"fixed_pivot": [0.0, -20.0], "rotations": [60.0]},
        "output_side": {"fixed_pivot": [20.0, -20.0], "rotations": [50.0]},
        "space": {"obstacles": zones},
    }
    job = client.post("/v1/jobs", json={"problem": problem}, headers={"Prefer": "wait=30"}).raise_for_status().json()
    assert job["problem"]["space"]["obstacles"][0]["circle"] == zones[0]["circle"]
    assert len(job["problem"]["space"]["obstacles"][1]["polygon"]) == len(zones[1]["polygon"])


# What is refused.


def test_no_closed_outline(client):
    told = refused(client, page('<path id="a/b" d="M0 0h9"/><text>x</text>'), 422)
    assert told["type"] == "/problems/invalid-drawing"
    assert told["errors"] == [
        {"path": "/text", "detail": "It is text; turn it into paths."},
        {"path": "/a~1b", "detail": "It is open: its ends are 9 apart."},
    ]
    assert "draws nothing" in refused(client, page(""), 422)["detail"]
    bow = refused(client, page('<polygon id="bow" points="0,0 10,10 10,0 0,10"/>'), 422)
    assert bow["errors"][0]["path"] == "/bow"
    assert "meets itself" in bow["errors"][0]["detail"]
    assert "draws nothing" in refused(client, dxf(lambda space: None), 422)["detail"]


FOREIGN = {
    "binary DXF": b"AutoCAD Binary DXF\r\n\x1a\x00\x00\x00SECTION",
    "DWG": b"AC1027\0\0\0\0",
    "compressed": b"\x1f\x8b\x08\0",
    "neither": b"%PDF-1.7",
    "neither SVG": b"",
}


@pytest.mark.parametrize("what", FOREIGN)
def test_files_of_other_formats(client, what):
    told = refused(client, FOREIGN[what], 415)
    assert told["type"] == "/problems/unsupported-media-type"
    assert what in told["detail"]


BROKEN = {
    "not well-formed": b"<svg xmlns='http://www.w3.org/2000/svg'><g></svg>",
    "unfinished": b"<svg xmlns='http://www.w3.org/2000/svg'><rect width='9'",
    "not <svg>": b"<html><body/></html>",
    "not well-formed XML": page("\0<rect width='9' height='9'/>"),
    "declares XML entities": b'<!DOCTYPE svg [<!ENTITY a "aaa">]><svg xmlns="http://www.w3.org/2000/svg">&a;</svg>',
    "XML entities": b'<!DOCTYPE svg [<!ENTITY x SYSTEM "file:///etc/passwd">]><svg><text>&x;</text></svg>',
    "entities": b'<!DOCTYPE svg [<!ENTITY % p SYSTEM "http://127.0.0.1:9/x.dtd"> %p;]><svg/>',
    "encoding": b'<?xml version="1.0" encoding="x-unheard-of"?><svg/>',
    "viewBox": page("", viewBox="0 0 -5 5"),
    "numbers of its viewBox": page("", viewBox="0 0 a 5"),
    "NUL": PLAIN.encode() + b"\0",
    "EOF": PLAIN.encode()[:-8],
    "number": PLAIN.replace("5.0", "i.5").encode(),
    "DXF": b"0\nSECTION\n2\nENTITIES\n0\nCIRCLE\nnine\n0\nEOF\n",
}


@pytest.mark.parametrize("what", BROKEN)
def test_broken_drawings(client, what):
    told = refused(client, BROKEN[what], 400)
    assert told["type"] == "/problems/malformed-drawing"
    assert what.split()[-1] in told["detail"] or what == "unfinished"
    assert "passwd" not in told["detail"]


def test_what_is_asked_wrongly(client):
    rect = page('<rect width="9" height="9"/>')
    assert refused(client, rect, 415, "application/json")["type"] == "/problems/unsupported-media-type"
    assert "image/svg+xml" in read(client, rect, "text/plain").headers["accept"]
    packed = client.post("/v1/outlines", content=rect, headers={"Content-Encoding": "gzip"})
    assert packed.status_code == 415
    for name, value in (("tolerance", 0), ("tolerance", "nan"), ("tolerance", -1), ("length_unit", "ft")):
        told = refused(client, rect, 422, **{name: value})
        assert told["errors"][0]["path"] == f"/query/{name}"
    too_large = client.post("/v1/outlines", content=b" " * (1 << 20) + rect)
    assert too_large.status_code == 413
    assert client.get("/v1/outlines").status_code == 405
