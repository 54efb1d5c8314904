"""Straight-line linkages of Rao's chapter 4, driven and measured."""

import numpy as np
import pytest

from kinematics.errors import DimensionError
from kinematics.linkage.fourbar.closed_form import CROSSED_ASSEMBLY, OPEN_ASSEMBLY, Fourbar
from kinematics.linkage.planar import catalogue
from kinematics.linkage.planar.drive import drive
from tests.cases import cases


def locus(mechanism, degrees):
    motion = drive(mechanism, np.radians(degrees), order=0)
    assert motion.valid.all()
    return motion.joints["P"][0]


def across(points):
    """Positions along and across the line of least squared distances."""
    offset = points - points.mean()
    direction = np.sqrt((offset**2).mean())
    return offset * np.conj(direction) / abs(direction)


@pytest.mark.parametrize("case", cases("straight_line_locus", "straight_line"))
def test_how_straight_a_locus_is(case):
    given = case.inputs
    lengths = (given[name] for name in ("crank", "coupler", "rocker", "ground"))
    linkage = Fourbar.from_lengths(*lengths, complex(given["px"], given["py"]))
    degrees = np.linspace(given["t0"], given["t1"], 61)
    assembly = CROSSED_ASSEMBLY if given["side"] < 0 else OPEN_ASSEMBLY
    line = across(locus(catalogue.make_fourbar(linkage, np.radians(degrees[0]), assembly), degrees))
    deviation, length = np.abs(line.imag).max(), np.ptp(line.real)
    case.check(max_dev=deviation, length=length, ratio=deviation / length)


@pytest.mark.parametrize("case", cases("exact_line", "straight_line"))
def test_scott_russell_draws_an_exact_line(case):
    r = case.inputs["r"]
    degrees = np.linspace(-85.0, 85.0, 171)
    mechanism = catalogue.make_slider_crank(0.0, 0.0, 0.0, r, r, 0.1, OPEN_ASSEMBLY, -r)
    points = locus(mechanism, degrees)
    assert np.isclose(np.ptp(points.imag), 4.0 * r * np.sin(np.radians(85.0)))
    case.check(max_dev=np.abs(across(points).imag).max())


@pytest.mark.parametrize("case", cases("watt_mean_position", "straight_line"))
def test_watts_mean_position(case):
    """There the coupler's middle is the ground's: between the two positions around the nearest one, in proportion."""
    given = case.inputs
    linkage = Fourbar.from_lengths(given["arm"], 2.0 * given["half"], given["arm"], given["O2O4"], given["half"])
    degrees = np.linspace(0.0, 30.0, 30001)
    points = locus(catalogue.make_fourbar(linkage, 0.2, CROSSED_ASSEMBLY), degrees)
    nearest = int(np.abs(points - given["O2O4"] / 2.0).argmin())
    assert abs(points[nearest] - given["O2O4"] / 2.0) < 1e-3
    before, after = points[nearest - 1], points[nearest + 1]
    share = ((given["O2O4"] / 2.0 - before) / (after - before)).real
    case.check(angle=degrees[nearest - 1] + share * (degrees[nearest + 1] - degrees[nearest - 1]))


@pytest.mark.parametrize("case", cases("inversor_line", "straight_line"))
def test_inversors_draw_an_exact_line(case):
    """Rao's cells, driven: the product of the distances is constant, the three points in line, the locus straight."""
    given = case.inputs
    r = given["r"]
    if given["mech"] == "peaucellier":
        # Rao's circle of diameter 3 = a − b touches what the cell reaches in one point; a wider one draws as well.
        with pytest.raises(DimensionError):
            catalogue.make_peaucellier(0.0, -r, r, given["a"], given["b"], 0.3)
        r = 2.0 * r
        mechanism = catalogue.make_peaucellier(0.0, -r, r, given["a"], given["b"], 0.3)
        degrees = np.linspace(-60.0, 60.0, 181)
        constant = given["a"] ** 2 - given["b"] ** 2
    else:
        mechanism = catalogue.make_hart(0.0, -r, r, given["long"], given["short"], given["f"], 2.0)
        bases = np.linspace(given["x0"], given["x1"], 181)
        degrees = 2.0 * np.degrees(np.arccos(given["f"] * bases / (2.0 * r)))
        constant = given["f"] * (1.0 - given["f"]) * (given["long"] ** 2 - given["short"] ** 2)
    motion = drive(mechanism, np.radians(degrees), order=0)
    assert motion.valid.all()
    points = motion.joints["P"][0]
    assert np.ptp(points.imag) > 0.3
    pin, point = motion.joints["A"][0] + r, points + r
    product = np.abs(pin) * np.abs(point)
    case.check(
        max_dev=np.abs(across(points).imag).max(),
        product_spread=np.ptp(product),
        product=product[0],
        expected_product=constant,
        OX=abs(points.real.mean() + r) * r / given["r"],
        collinear=np.abs((pin * point.conj()).imag).max() / product[0],
    )


@pytest.mark.parametrize("case", cases("pantograph", "straight_line"))
def test_the_pantograph_enlarges(case):
    """Q at OQ from the pivot while P is at the ratio of it, all through a turn of the crank that carries P."""
    given = case.inputs
    ratio, reach = given["ratio"], given["DQ"]
    near, far = given["OA"], given["OA"] / ratio
    # The crank takes P round a circle through the printed place.
    mechanism = catalogue.make_pantograph(ratio * reach - 3.0, 0.0, 3.0, near, far, 20.0, 0.0)
    motion = drive(mechanism, np.linspace(0.0, 2.0 * np.pi, 181), order=0)
    assert motion.valid.all()
    p, q, b = (motion.joints[name][0] for name in ("P", "Q", "B"))
    assert np.abs(q - p / ratio).max() < 1e-12 * reach
    assert np.ptp(np.abs(p)) > 5.0
    case.check(OP=abs(p[0]), OB=np.abs(b)[0])
    assert np.isclose(abs(q[0]), reach)


@pytest.mark.parametrize(
    ("made", "what"),
    [
        (lambda: catalogue.make_hart(0.0, -1.2, 1.2, 4.0, 1.5, 0.4, 0.1), "input_angle"),
        (lambda: catalogue.make_hart(0.0, -1.2, 1.2, 1.5, 4.0, 0.4, 2.0), "short"),
        (lambda: catalogue.make_hart(0.0, -1.2, 1.2, 4.0, 1.5, 1.0, 2.0), "share"),
        (lambda: catalogue.make_hart(0.0, -1.2, 1.2, 4.0, 1.5, 0.4, 2.0, 0), "side"),
        (lambda: catalogue.make_pantograph(5.0, 0.0, 6.0, 10.0, 40.0, 20.0, 1.0), "input_angle"),
        (lambda: catalogue.make_pantograph(22.0, 0.0, 3.0, 10.0, 10.0, 20.0, 1.0), "far"),
    ],
)
def test_impossible_dimensions_are_refused(made, what):
    with pytest.raises(DimensionError, match=what):
        made()
