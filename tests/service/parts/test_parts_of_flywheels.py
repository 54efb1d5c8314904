"""Parts of flywheels through the API, weighed by another route, and why there are none of rotors and engines."""

from __future__ import annotations

import io
import math
from itertools import pairwise
from typing import Any

import ezdxf
import numpy as np
import pytest
import shapely
from ezdxf.math import bulge_center

from synthesis.registry import list_examples
from tests.service.stated.shafts import FLYWHEEL
from tests.support.service.answers import finished
from tests.support.service.parts import bill, parts, refused


def plate(text: bytes) -> shapely.Polygon:
    """What a drawing cuts, its arcs as fine polygons."""
    rings = []
    for entity in ezdxf.read(io.StringIO(text.decode())).modelspace().query("CIRCLE LWPOLYLINE"):
        if entity.dxftype() == "CIRCLE":
            rings.append(shapely.Point(*entity.dxf.center.xyz[:2]).buffer(entity.dxf.radius, quad_segs=20_000))
            continue
        corners = [(complex(x, y), bulge) for x, y, bulge in entity.get_points("xyb")]
        around = []
        for (start, bulge), (end, _) in pairwise([*corners, corners[0]]):
            around.append(np.array([start]))
            if bulge:
                centre = complex(*bulge_center((start.real, start.imag), (end.real, end.imag), bulge))
                around.append(centre + (start - centre) * np.exp(1j * np.linspace(0.0, 4.0 * math.atan(bulge), 2000)))
        places = np.concatenate(around)
        rings.append(shapely.Polygon(np.column_stack([places.real, places.imag])))
    outer = max(rings, key=lambda ring: ring.area)
    return outer.difference(shapely.union_all([ring for ring in rings if ring is not outer]))


@pytest.mark.slow
@pytest.mark.parametrize("form", ["disc", "rim"])
def test_a_flywheel_is_cut_with_the_mass_of_the_answer_beside_what_is_told(client: Any, form: str) -> None:
    job = finished(client, {**FLYWHEEL, "form": form})
    place = f"/v1/jobs/{job['id']}/designs/0"
    (design,) = client.get(f"/v1/jobs/{job['id']}").json()["result"]["designs"]
    wheel, mass = design["mechanism"], design["metrics"]["mass"]
    files = parts(client, place, bore=40)
    row = bill(files)["flywheel"]
    assert float(row["width"]) == pytest.approx(2.0 * wheel["radius"], abs=1e-3)
    assert float(row["thickness"]) == pytest.approx(wheel["thickness"], abs=1e-3)
    cut = plate(files["dxf/flywheel.dxf"])
    to_kg = wheel["density"] * 1e-9 * wheel["thickness"]
    assert float(row["mass"]) == pytest.approx(to_kg * cut.area, rel=1e-5)
    # What the answer counts: a disc without its bore, a ring without what is within it.
    full = shapely.Polygon(cut.exterior)
    counted = full.difference(full.centroid.buffer(wheel["inner_radius"], quad_segs=20_000))
    assert to_kg * counted.area == pytest.approx(mass, rel=1e-5)
    # No window reaches into the rim, and nothing but the bore is missing of a disc.
    assert counted.difference(cut).area == pytest.approx(math.pi * 20.0**2 if form == "disc" else 0.0, rel=0.1, abs=1.0)
    assert f"{mass:.6g} kg" in files["README.txt"].decode()
    view = client.get(f"{place}/assembly?bore=40").json()
    on = next(k for k, carrier in enumerate(view["carriers"]) if carrier["link"] == "flywheel_shaft")
    turning = {part["name"] for part in view["parts"] if part["carrier"] == on}
    assert {"flywheel", "pin_flywheel_shaft", "key_flywheel_shaft_1"} <= turning


def test_a_bore_too_wide_for_a_flywheel_is_refused_with_one_that_does(client: Any) -> None:
    job = finished(client, {**FLYWHEEL, "form": "rim"})
    place = f"/v1/jobs/{job['id']}/designs/0"
    (error,) = refused(client, place, 422, bore=199)["errors"]
    assert error["path"] == "/query/bore"
    most = float(error["detail"].split("use at most ")[1].split()[0])
    assert bill(parts(client, place, bore=most))["pin_flywheel_shaft"]["width"] == f"{most:g}"
    answer = refused(client, place, 422, face_width=20)
    assert answer["errors"][0]["path"] == "/query/face_width"


ROTOR = next(one for one in list_examples("balancing") if one.get("object") == "rotor")


@pytest.mark.parametrize(
    ("problem", "reason"),
    [(ROTOR, "no shape of it; use"), (list_examples("engine")[0], "bore, journal or web; use")],
    ids=["rotor", "engine"],
)
def test_what_states_no_shape_says_why_and_what_to_ask_for(client: Any, problem: Any, reason: str) -> None:
    job = finished(client, problem)
    place = f"/v1/jobs/{job['id']}/designs/0"
    assert reason in refused(client, place, 409)["detail"]
    for form in ("csv", "dxf"):
        assert client.get(f"{place}.{form}").status_code == 200
