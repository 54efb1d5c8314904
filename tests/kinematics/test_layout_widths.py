"""The greatest width of links, against the layouts in planes just below and above it."""

from __future__ import annotations

import math

import pytest

from kinematics.linkage.fourbar import Fourbar
from kinematics.linkage.layout import arrange_divided, arrange_planes, find_greatest_width, list_divisions
from kinematics.linkage.planar import catalogue
from kinematics.linkage.planar.mechanism import Mechanism

TURN = (0.0, 2.0 * math.pi)

MECHANISMS: dict[str, Mechanism] = {
    "crank-rocker": catalogue.make_fourbar(Fourbar(0.0, 4.0, 1.0, 3.5, 3.0, 1.0 + 1.0j), 0.3),
    "drag link": catalogue.make_fourbar(Fourbar(0.0, 1.0, 2.0, 2.2, 2.1), 0.3),
    "slider-crank": catalogue.make_slider_crank(0.4j, 0.0, 0.0, 1.0, 3.0, 0.3),
}


def is_buildable(mechanism: Mechanism, width: float) -> bool:
    """Whether planes exist for links and pins of a width, whichever way shafts are held."""
    sizes = {"link_width": width, "pin_diameter": width, "gap": 0.0}
    layouts = [
        arrange_planes(mechanism, *TURN, link_width=width, pin_diameter=width, gap=0.0, through=through, whole=True)
        for through in (False, True)
    ]
    divided = [arrange_divided(mechanism, *TURN, way, **sizes) for way in list_divisions(mechanism)]
    return any(not layout.clashes for layout in [*layouts, *divided])


@pytest.mark.parametrize("name", MECHANISMS)
def test_layouts_exist_below_the_greatest_width_and_not_above(name: str) -> None:
    mechanism = MECHANISMS[name]
    width = find_greatest_width(mechanism, *TURN)
    assert width > 0.0
    assert is_buildable(mechanism, 0.98 * width)
    assert not is_buildable(mechanism, 1.02 * width)


def test_a_crank_that_is_an_eccentric_leaves_no_width() -> None:
    thin = catalogue.make_fourbar(Fourbar(0.0, 4.0, 0.01, 3.5, 3.0), 0.3)
    assert find_greatest_width(thin, *TURN) == pytest.approx(0.01)
