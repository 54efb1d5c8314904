"""Strokes of an output as roots of its rate, against the geometry of limit positions."""

from __future__ import annotations

import math

import numpy as np
import pytest

from kinematics.errors import DimensionError
from kinematics.linkage.fourbar import CROSSED_ASSEMBLY, OPEN_ASSEMBLY, Fourbar, barker_type
from kinematics.linkage.planar import catalogue
from kinematics.linkage.planar.strokes import find_reversals, find_strokes
from tests.cases import cases


def dead_centres(a, b, c, d):
    """Crank rotation from extension to overlap, and the rocker's: by the law of cosines in the two triangles."""

    def corner(side, one, other):
        return math.acos((one * one + other * other - side * side) / (2.0 * one * other))

    crank = corner(c, d, a + b), math.pi + corner(c, d, b - a)
    rocker = math.pi - corner(a + b, c, d), math.pi - corner(b - a, c, d)
    return crank[1] - crank[0], rocker[1] - rocker[0]


def crank_rockers(count, seed):
    rng = np.random.default_rng(seed)
    lengths = rng.uniform(0.1, 2.0, (40 * count, 4))
    a, b, c, d = lengths.T
    return lengths[barker_type(Fourbar.from_lengths(a, b, c, d)) == 2][:count]


@pytest.mark.parametrize("lengths", crank_rockers(25, 1), ids=str)
@pytest.mark.parametrize("assembly", [OPEN_ASSEMBLY, CROSSED_ASSEMBLY])
def test_a_crank_rocker_has_the_strokes_of_its_dead_centres(lengths, assembly):
    a, b, c, d = lengths
    mechanism = catalogue.make_fourbar(Fourbar.from_lengths(a, b, c, d), 0.3, assembly)
    found = find_strokes(mechanism, "output")
    rotation, swing = dead_centres(a, b, c, d)
    assert found is not None
    # Angles at a dead centre have as many digits as the triangle's height, which goes with the root of its cosine's.
    assert found.slow == pytest.approx(max(rotation, 2.0 * math.pi - rotation), abs=1e-7)
    assert found.travel == pytest.approx(abs(swing), abs=1e-7)
    assert found.slow + found.fast == pytest.approx(2.0 * math.pi, abs=1e-14)
    assert found.time_ratio >= 1.0


@pytest.mark.parametrize("reference", [0.0, 1.0])
def test_a_reference_at_a_limit_position_hides_none(reference):
    # At input angle 0 of this linkage crank and coupler extend each other, and B lies on the circle about O4.
    o4 = 3.0 - 2.0j
    linkage = Fourbar(0.0, o4, 1.0, 3.0, abs(4.0 - o4))
    side = OPEN_ASSEMBLY if ((o4 - 1.0).conjugate() * 3.0).imag > 0.0 else CROSSED_ASSEMBLY
    found = find_strokes(catalogue.make_fourbar(linkage, reference, side), "output")
    assert found is not None
    assert min(abs(math.remainder(at, 2.0 * math.pi)) for at in found.inputs) < 1e-12


def test_the_in_line_slider_crank_has_equal_strokes_of_two_cranks():
    found = find_strokes(catalogue.make_slider_crank(2.0 + 1.0j, 2.0 + 1.0j, 0.4, 1.5, 4.0, 0.7), "B")
    assert found is not None
    assert found.time_ratio == pytest.approx(1.0, abs=1e-13)
    assert found.travel == pytest.approx(3.0, rel=1e-14)


@pytest.mark.parametrize("ratio", [0.2, 0.5, 0.9])
def test_the_crank_shaper_has_the_ratio_of_its_rocker(ratio):
    found = find_strokes(catalogue.make_quick_return(0.0, -2.0j, 2.0 * ratio, 5.0, 6.0, 2.9j, 0.0, 0.2), "rocker")
    swing = 2.0 * math.asin(ratio)
    assert found is not None
    assert found.travel == pytest.approx(swing, abs=1e-13)
    assert found.time_ratio == pytest.approx((math.pi + swing) / (math.pi - swing), rel=1e-12)


def test_what_turns_through_or_stops_has_no_strokes():
    double_crank = catalogue.make_fourbar(Fourbar.from_lengths(3.0, 3.5, 4.0, 1.0), 0.3)
    assert find_strokes(double_crank, "output") is None
    assert len(find_reversals(double_crank, "output").inputs) == 0
    rocker = catalogue.make_fourbar(Fourbar.from_lengths(3.0, 2.0, 3.0, 3.5), 0.6)
    assert not find_reversals(rocker, "output").full
    assert find_strokes(rocker, "output") is None


def test_a_driven_slider_is_refused():
    with pytest.raises(DimensionError, match="link that turns"):
        find_reversals(catalogue.make_slider_crank(0.0, 0.0, 0.0, 1.0, 3.0, 0.5, driven_by="slider"), "crank")


@pytest.mark.parametrize("case", cases("quick_return_fourbar", "quick_return"))
def test_norton_example_3_9_as_constructed(case):
    """His construction with a rocker of 1 and a construction angle of 30°, driven."""
    psi, ratio = math.radians(case.inputs["swing"]), case.inputs["time_ratio"]
    beta = 2.0 * math.pi / (1.0 + ratio)
    delta = abs(math.pi - beta)
    # B1, B2 on the rocker; lines at 30° through B1 and at 30° + δ through B2 meet in O2.
    b1, b2 = 1.0 + 0j, complex(math.cos(psi), math.sin(psi))
    u, v = (complex(math.cos(x), math.sin(x)) for x in (math.radians(30.0), math.radians(30.0) + delta))
    t = ((b2 - b1) * v.conjugate()).imag / (u * v.conjugate()).imag
    o2 = b1 + t * u
    one, other = abs(b1 - o2), abs(b2 - o2)
    a, b = 0.5 * abs(one - other), 0.5 * (one + other)
    far = b1 if one > other else b2
    pin = o2 + a * (far - o2) / abs(far - o2)
    side = OPEN_ASSEMBLY if ((0.0 - pin).conjugate() * (far - pin)).imag > 0.0 else CROSSED_ASSEMBLY
    linkage = Fourbar(o2, 0.0, a, b, 1.0)
    angle = float(np.angle(pin - o2))
    found = find_strokes(catalogue.make_fourbar(linkage, angle, side), "output")
    assert found is not None
    case.check(
        alpha=math.degrees(2.0 * math.pi - beta),
        beta=math.degrees(beta),
        delta=math.degrees(delta),
        achieved_alpha=math.degrees(found.fast),
        achieved_swing=math.degrees(found.travel),
        barker="GCRR" if int(barker_type(linkage)) == 2 else "",
    )
