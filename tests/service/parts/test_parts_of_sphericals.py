"""Parts of spherical Geneva drives: carved bodies, the roller against the slots, and all of it by HTTP."""

from __future__ import annotations

import io
import math
from dataclasses import replace
from itertools import pairwise
from typing import Any

import ezdxf
import numpy as np
import pytest

from kinematics.arrays import Real
from kinematics.indexing.drag_link import CrankCourse
from kinematics.indexing.geneva import Geneva
from service.parts.assembly.interference import find_overlaps
from service.parts.assembly.model import Carrier, Placement
from service.parts.assembly.sizes import PartsQuery
from service.parts.gears.upright import make_frame
from service.parts.geometry.cut_solids import BoreCut, ConeCut, Cut, CutBody, HalfSpaceCut, SlotCut
from service.parts.geometry.regions import Disc, Loop, measure_area
from service.parts.indexing.spherical_geneva import ON_ROLLER, WHEEL_LINK, SphericalMotion
from service.parts.registry import make_parts
from synthesis.dispatch import solve
from synthesis.registry import parse_problem
from tests.support.service.answers import finished
from tests.support.service.parts import bill, parts, refused
from tests.support.service.parts_of_sphericals import SPHERICAL

BALL = Loop((0j, 10.0 + 0.0j, 10.0j), (0.0, math.tan(math.pi / 8.0), 0.0))
WHOLE = 2.0 / 3.0 * math.pi * 10.0**3
BORE = 2.0 / 3.0 * math.pi * (10.0**3 - 96.0**1.5)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("cut", "taken", "inside", "outside"),
    [
        (ConeCut(0.7, 0.4), WHOLE / 2.0 * (1.0 - math.cos(0.4)), (0.7 + 0.41, 1e-3), (0.7 - 0.39, 1e-3)),
        (
            HalfSpaceCut(2.0, -6.0),
            math.pi / 6.0 * 4.0**2 * 26.0,
            (2.0 + math.acos(-0.59 / 0.9), 0.1),
            (2.0 + math.pi, 0.1),
        ),
        (BoreCut(Disc(0j, 2.0)), BORE, (0.3, 1.3), (0.3, 1.4)),
        (SlotCut(0.5, 1.2, 2.0, open=False), BORE - 16.0 / 3.0 / math.tan(1.2), (0.5, 0.9), (0.5, 1.1)),
    ],
)
def test_half_a_ball_less_a_cut_has_the_volume_of_the_formula(
    cut: Cut, taken: float, inside: tuple[float, float], outside: tuple[float, float]
) -> None:
    """By its mesh, and by its sections; and points 9 from the centre are on the side they are."""
    body = CutBody(BALL, (cut,))
    assert body.volume == pytest.approx(WHOLE - taken, rel=1e-3)
    levels = np.linspace(0.0, 10.0, 201)
    sections = [body.cut_between(low, high) for low, high in pairwise(levels.tolist())]
    areas = [measure_area(outer) - sum(map(measure_area, holes)) for one in sections for outer, holes in one]
    assert sum(areas) * 0.05 == pytest.approx(WHOLE - taken, rel=0.005)
    for (azimuth, elevation), held in ((inside, True), (outside, False)):
        flat = 9.0 * math.cos(elevation)
        point = [flat * math.cos(azimuth), flat * math.sin(azimuth), 9.0 * math.sin(elevation)]
        assert body.find_inside(np.array([point]), 1e-3).tolist() == [held]


@pytest.mark.parametrize("stations", [3, 4, 8])
def test_the_roller_goes_up_and_down_the_meridian_of_a_slot_that_the_wheel_turns(stations: int) -> None:
    cone = math.pi / stations
    frames = (make_frame(np.array([1.0, 0.0, 0.0]), np.zeros(3)), make_frame(np.array([0.0, 1.0, 0.0]), np.zeros(3)))
    motion = SphericalMotion(1.0, CrankCourse(Geneva.shock_free("geneva_spherical", stations)), cone, frames)
    state = np.linspace(0.0, math.pi, 19)
    roller, wheel = (motion.compute_placement(carrier, state) for carrier in (ON_ROLLER, Carrier(WHEEL_LINK, None)))
    assert roller.frame is not None
    assert wheel.frame is not None
    seen = roller.frame.axes[:, :, 2] @ wheel.frame.axes
    back = (seen[:, 0] + 1j * seen[:, 1]) / wheel.turn
    # The slot of the reference configuration, at which the roller enters the rim.
    assert np.angle(back / np.exp(1j * (math.pi + cone))) == pytest.approx(0.0, abs=1e-12)
    assert np.arcsin(seen[:, 2])[[0, 9, 18]] == pytest.approx([0.0, cone, 0.0], abs=1e-12)
    assert np.abs(np.linalg.det(roller.frame.axes) - 1.0).max() < 1e-12
    resting = motion.compute_placement(Carrier(WHEEL_LINK, None), np.array([math.pi, 4.0, 6.28]))
    assert np.ptp(np.angle(resting.turn)) < 1e-9


@pytest.mark.campaign
def test_a_spherical_drive_is_had_as_parts(server: Any) -> None:
    job = finished(server.client, SPHERICAL)
    place = f"/v1/jobs/{job['id']}/designs/0"
    files = parts(server.client, place)
    assert {"wheel", "crank", "roller", "base", "pin_roller"} <= set(bill(files))
    document = ezdxf.read(io.StringIO(files["dxf/wheel.dxf"].decode()))
    assert not document.audit().has_errors
    drawn = [entity.dxf.layer for entity in document.modelspace().query("SPLINE")]
    assert (drawn.count("SLOTS"), drawn.count("HOLLOWS")) == (4, 4)
    (edge,) = document.modelspace().query("LWPOLYLINE")
    assert np.ptp([point[0] for point in edge.get_points()]) == pytest.approx(math.tau * 50.0, rel=1e-9)
    answer = refused(server.client, place, 422, pin=9.0)
    assert answer["errors"][0]["path"] == "/query/pin"


@pytest.mark.campaign
@pytest.mark.parametrize("stations", [3, 4, 8])
def test_a_roller_that_leaves_its_slot_too_late_would_be_found(stations: int) -> None:
    """The parts keep apart; with the wheel a little ahead of its crank they meet."""
    problem = parse_problem({**SPHERICAL, "stations": stations, "sphere_radius": 25.0 * (2 + stations / 2)})
    design = solve(problem, lambda _fraction, _message: None).designs[0]
    whole = make_parts(design, problem, PartsQuery())
    assert find_overlaps(whole, 216) == []
    ahead = replace(whole, motion=Ahead(**vars(whole.motion)))
    assert {"wheel"} <= {name for found in find_overlaps(ahead, 72) for name in found.parts}


class Ahead(SphericalMotion):
    """A wheel that is turned by two degrees too much."""

    def compute_placement(self, carrier: Carrier, state: Real) -> Placement:
        at = super().compute_placement(carrier, state)
        return at._replace(turn=at.turn * np.exp(-0.035j)) if carrier.link == WHEEL_LINK else at
