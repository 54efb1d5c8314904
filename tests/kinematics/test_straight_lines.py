"""Straight-line linkages of Rao's chapter 4, driven and measured."""

import numpy as np
import pytest

from kinematics.linkage import catalogue
from kinematics.linkage.drive import drive
from kinematics.linkage.fourbar import CROSSED, OPEN, Fourbar
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
    assembly = CROSSED if given["side"] < 0 else OPEN
    line = across(locus(catalogue.fourbar(linkage, np.radians(degrees[0]), assembly), degrees))
    deviation, length = np.abs(line.imag).max(), np.ptp(line.real)
    case.check(max_dev=deviation, length=length, ratio=deviation / length)


@pytest.mark.parametrize("case", cases("exact_line", "straight_line"))
def test_scott_russell_draws_an_exact_line(case):
    r = case.inputs["r"]
    degrees = np.linspace(-85.0, 85.0, 171)
    mechanism = catalogue.slider_crank(0.0, 0.0, 0.0, r, r, 0.1, OPEN, -r)
    points = locus(mechanism, degrees)
    assert np.isclose(np.ptp(points.imag), 4.0 * r * np.sin(np.radians(85.0)))
    case.check(max_dev=np.abs(across(points).imag).max())


@pytest.mark.parametrize("case", cases("watt_mean_position", "straight_line"))
def test_watts_mean_position(case):
    """There the coupler's middle is the ground's: between the two positions around the nearest one, in proportion."""
    given = case.inputs
    linkage = Fourbar.from_lengths(given["arm"], 2.0 * given["half"], given["arm"], given["O2O4"], given["half"])
    degrees = np.linspace(0.0, 30.0, 30001)
    points = locus(catalogue.fourbar(linkage, 0.2, CROSSED), degrees)
    nearest = int(np.abs(points - given["O2O4"] / 2.0).argmin())
    assert abs(points[nearest] - given["O2O4"] / 2.0) < 1e-3
    before, after = points[nearest - 1], points[nearest + 1]
    share = ((given["O2O4"] / 2.0 - before) / (after - before)).real
    case.check(angle=degrees[nearest - 1] + share * (degrees[nearest + 1] - degrees[nearest - 1]))
