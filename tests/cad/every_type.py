"""A statement for every kind of problem and every type of mechanism of its answers, and why some have no parts."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any, NamedTuple

from tests.service.stated.linkages import DWELL, LINE, STEERING
from tests.service.stated.linkages import MOTION as THREE
from tests.service.stated.sixbars import DWELL as PLACED_DWELL
from tests.service.stated.sixbars import FUNCTION
from tests.service.stated.sixbars import PATH as FITTED_PATH
from tests.support.service.parts import MOTION, SLIDER
from tests.support.service.parts_of_barrels import BARREL
from tests.support.service.parts_of_cams import PROBLEMS as DRIVES
from tests.support.service.parts_of_gears import BEVELS, PAIR, SET, WORM
from tests.support.service.parts_of_sphericals import SPHERICAL
from tests.support.service.sixbar_jobs import TASK as SIXBAR_MOTION
from tests.support.service.sixbar_paths import TASK as SIXBAR_PATH

Key = tuple[str, str]
"""A kind of problem and a type of mechanism."""

QUICK = {"kind": "quick_return", "time_ratio": 1.4, "max_designs": 1}
TURNS = {"output": {"type": "rocker", "swing": 40.0}}
SLIDES = {"output": {"type": "slider", "stroke": 40.0}}


class Row(NamedTuple):
    """A statement, which of its designs is made, and what is asked of its parts."""

    statement: dict[str, Any]
    number: int = 0
    query: Mapping[str, Any] = MappingProxyType({})


def _sixbar(statement: dict[str, Any], mechanism: str, number: int = 0) -> Row:
    return Row({**statement, "mechanisms": [mechanism], "max_designs": number + 1}, number)


def _quick(mechanism: str, scale: float = 1.0, **more: float) -> Row:
    return Row({**QUICK, "mechanism": mechanism, **more}, 0, {"scale": scale})


def _example(kind: str, mechanism: str) -> Row:
    """The first example of a kind whose answer begins with the type of mechanism."""
    from synthesis.registry import list_examples

    found = {"rotor": "rotor", "skeleton": "linkage"}
    return Row(
        next(one for one in list_examples(kind) if one.get("object", "linkage") == found.get(mechanism, "linkage"))
    )


MADE: dict[Key, Row] = {
    ("motion", "fourbar"): Row(MOTION),
    ("motion", "slider_crank"): Row(SLIDER),
    ("motion", "inverted_slider_crank"): Row({**THREE, "output_side": {"dyad": "RP"}, "max_designs": 1}),
    ("motion", "watt_1"): _sixbar(SIXBAR_MOTION, "watt_1"),
    ("motion", "watt_2"): Row({**MOTION, "driver_dyad": True}),
    ("motion", "stephenson_1"): _sixbar(SIXBAR_MOTION, "stephenson_1"),
    ("motion", "stephenson_2"): _sixbar(SIXBAR_MOTION, "stephenson_2"),
    ("motion", "stephenson_3"): Row({**MOTION, "driver_dyad": {"link": "coupler"}}),
    ("motion", "eightbar"): _sixbar(SIXBAR_MOTION, "eightbar"),
    ("path", "fourbar"): Row({"kind": "path", "points": SIXBAR_PATH["points"][:5], "max_designs": 1}),
    ("path", "slider_crank"): Row(
        {"kind": "path", "points": SIXBAR_PATH["points"], "mechanism": "slider_crank", "max_designs": 1}
    ),
    ("path", "geared_fivebar"): Row(
        {
            "kind": "path", "mechanism": "geared_fivebar", "gear_ratio": -1.0, "method": "least_squares",
            "closed": True, "max_designs": 1,
            "points": [{"x": x, "y": y} for x, y in (
                (32.0, 6.0), (29.0, 13.0), (22.0, 19.0), (13.0, 22.0), (5.0, 21.0), (1.0, 16.0), (3.0, 10.0),
                (10.0, 5.0), (20.0, 3.0), (27.0, 3.0),
            )],
        }
    ),
    ("path", "watt_1"): _sixbar(FITTED_PATH, "watt_1"),
    ("path", "stephenson_1"): _sixbar(FITTED_PATH, "stephenson_1")._replace(query={"scale": 2.0}),
    # Links 3 and 5 often pass over the input shaft on both sides, where no planes separate them: constrain the planes.
    ("path", "stephenson_2"): _sixbar(
        {**FITTED_PATH, "layout": {"link_width": 2.0, "pin_diameter": 1.0, "thickness": 1.0, "max_planes": 8}},
        "stephenson_2",
    ),
    ("path", "stephenson_3"): _sixbar(FITTED_PATH, "stephenson_3"),
    ("path", "eightbar"): _sixbar(
        {**FITTED_PATH, "layout": {"link_width": 2.0, "pin_diameter": 1.0, "thickness": 1.0, "max_planes": 10}},
        "eightbar",
    ),
    ("quick_return", "fourbar"): _quick("fourbar", swing=60.0, scale=2.5),
    ("quick_return", "slider_crank"): _quick("offset_slider_crank", stroke=100.0),
    ("quick_return", "crank_shaper"): _quick("crank_shaper", stroke=100.0),
    ("quick_return", "whitworth"): _quick("whitworth", stroke=100.0),
    ("quick_return", "drag_link_rocker"): _quick("drag_link_rocker", swing=60.0, scale=7.0),
    ("quick_return", "drag_link_slider"): _quick("drag_link_slider", stroke=100.0),
    ("straight_line", "fourbar"): Row({**LINE, "max_designs": 1}),
    ("straight_line", "peaucellier"): Row({**LINE, "mechanism": "peaucellier"}),
    ("straight_line", "hart"): Row({**LINE, "mechanism": "hart", "crank_range": 60.0}),
    ("straight_line", "scott_russell"): Row({**LINE, "mechanism": "scott_russell", "crank_range": 60.0}),
    ("steering", "fourbar"): Row({**STEERING, "mechanism": "ackermann", "max_designs": 1}),
    ("steering", "davis"): Row({**STEERING, "mechanism": "davis"}),
    ("dwell", "dwell_rocker"): Row({**DWELL, "max_designs": 1}),
    ("dwell", "dwell_slider"): Row({**DWELL, **SLIDES, "max_designs": 1}),
    ("dwell", "dwell_slot"): Row({**DWELL, "mechanism": "straight_slot"}),
    ("dwell", "dwell_watt_rocker"): Row({**PLACED_DWELL, **TURNS}),
    ("dwell", "dwell_watt_slider"): Row({**PLACED_DWELL, **SLIDES, "max_designs": 6}, 5),
    ("parallel_motion", "watt_1"): _example("parallel_motion", "watt_1"),
    ("gear_train", "gear_train"): Row(PAIR),
    ("planetary_train", "planetary_train"): Row({**SET, "fixed": "ring"}),
    ("train_series", "train_series"): Row(
        {"kind": "train_series", "ratio": "6", "units": [{"type": "gear_train", "max_stages": 1}] * 2, "max_designs": 1}
    ),
    ("gearbox", "gearbox"): Row(
        {
            "kind": "gearbox", "input_speed": 200.0, "speeds": {"min": 100.0, "ratio": 1.25, "count": 6},
            "tooth_sum": {"min": 40, "max": 60}, "max_designs": 1,
        }
    ),
    ("layshaft_gearbox", "layshaft_gearbox"): Row(
        {
            "kind": "layshaft_gearbox", "ratios": [2.0, 1.0], "reverse": 2.2, "teeth": {"min": 14, "max": 40},
            "tooth_sum": {"min": 36, "max": 50}, "interference": "report", "module": 3.0, "max_designs": 1,
        }
    ),
    ("function", "fourbar"): _example("function", "fourbar"),
    ("function", "slider_crank"): Row(
        {
            "kind": "function", "mechanism": "slider_crank", "function": {"name": "logarithm", "x": [1.0, 10.0]},
            "input_range": 80.0, "output_range": 50.0, "precision_points": 4, "max_designs": 1,
        }
    ),
    ("function", "watt_2"): _sixbar(FUNCTION, "watt_2"),
    ("function", "stephenson_2"): _sixbar(FUNCTION, "stephenson_2"),
    ("function", "stephenson_3"): _sixbar(FUNCTION, "stephenson_3"),
    ("function", "eightbar"): _sixbar(FUNCTION, "eightbar"),
    ("cam", "cam"): Row(DRIVES["roller"]),
    ("cam", "barrel_cam"): Row(BARREL),
    ("balancing", "skeleton"): _example("balancing", "skeleton"),
    ("spring_balancing", "skeleton"): _example("spring_balancing", "skeleton"),
    ("flywheel", "flywheel"): _example("flywheel", "flywheel"),
    ("indexing", "geneva_external"): Row(DRIVES["external"]),
    ("indexing", "geneva_internal"): Row(DRIVES["internal"]),
    ("indexing", "geneva_spherical"): Row(SPHERICAL),
    ("indexing", "ratchet"): Row(DRIVES["ratchet"]),
}  # fmt: skip
"""One design of each."""

STAGES: dict[Key, Row] = {
    ("gear_train", "bevel"): Row(BEVELS, 0, {"process": "laser"}),
    ("gear_train", "worm"): Row(WORM, 0, {"process": "laser"}),
}
"""Trains whose shafts are not parallel, which have the type of all trains: by the type of their stage."""

REFUSED: dict[Key, tuple[Row, str]] = {
    ("dwell", "dwell_stephenson_2"): (Row({**DWELL, "mechanism": "stephenson_2"}), "cannot be built in planes"),
    ("balancing", "rotor"): (_example("balancing", "rotor"), "no shape of it"),
    ("engine", "engine"): (_example("engine", "engine"), "no diameter or width of a bore, journal or web"),
}  # fmt: skip
"""Why there are none of the others, in words of the answer."""

NEVER: tuple[Key, ...] = (
    ("motion", "geared_fivebar"),
    ("path", "inverted_slider_crank"),
    ("path", "watt_2"),
    ("function", "watt_1"),
    ("function", "stephenson_1"),
)
"""What the schema of an answer has, whose model several kinds share, and what the kind takes no statement for."""
