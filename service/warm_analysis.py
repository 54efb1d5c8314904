"""Warm-up of the analysis core: its kernels are compiled or loaded from their cache.

The processes that answer requests are forked from one that has done this (:mod:`service.answers`); missing kernels are
compiled ahead in other processes (:mod:`service.server.precompile`).
"""

from __future__ import annotations

from service.loading import IMPORTS
from synthesis.model.json_object import JsonObject


def warm_up() -> None:
    """Compile the kernels of the analysis core, or load them from their cache, by running an analysis of each sort."""
    with IMPORTS:
        from synthesis.analyses import list_families, parse_request

    for family in list_families():
        family.request.build_example().build_answer()
    for mechanism in (_SLIDER_CRANK, _CLASS_III, _REDUNDANT):
        parse_request({"mechanism": mechanism, "dynamics": {}}).build_answer()
    rubbing = {"friction": {"pins": {"B": {"mu": 0.1, "radius": 0.1}}}}
    parse_request({"mechanism": _SLIDER_CRANK, "motion": {"at": 30.0}, "dynamics": rubbing}).build_answer()
    fourbar = list_families()[0].request.build_example().model_dump(mode="json", exclude_unset=True)["mechanism"]
    for mechanism in (_SLIDER_CRANK, fourbar):
        for block in (_LAYOUT, _TARGETS, _MANUFACTURE):
            parse_request({"mechanism": mechanism, **block}).build_answer()
    parse_request({"mechanism": fourbar, **_TOPICS}).build_answer()


# Optional blocks whose kernels the examples do not call: a request with one of them must not wait for the compiler.
_LAYOUT: JsonObject = {"layout": {"link_width": 1.0, "pin_diameter": 0.4, "thickness": 0.3}}
_TARGETS: JsonObject = {"targets": [{"x": 1.0, "y": 2.0}, {"x": 2.0, "y": 3.0}]}
_MANUFACTURE: JsonObject = {**_TARGETS, "manufacture": {"tolerances": {"length": 0.1}}}
_TOPICS: JsonObject = {"include": ["cognates", "centrodes", "curvature", "coupler_curve", "branches"]}

_SLIDER_CRANK = {
    "type": "slider_crank",
    "fixed_pivot": [0.0, 0.0],
    "links": {"crank": 2.0, "coupler": 7.0},
    "slide": {"point": [0.0, 1.0], "angle": 0.0},
}
_REDUNDANT = {
    "type": "skeleton",
    "skeleton": {
        "joints": {"O": [0.0, 0.0], "P": [1.0, 0.0], "Q": [0.0, 1.0]},
        "links": [
            {"name": "ground", "joints": ["O"]},
            {"name": "input", "joints": ["O", "P"]},
            {"name": "output", "joints": ["O", "Q"]},
        ],
        "gears": [{"links": ["input", "output"], "ratio": -1.0}] * 2,
        "input_link": "input",
    },
}
_CLASS_III = {
    "type": "stephenson_2",
    "skeleton": {
        "joints": {
            "O2": [0.0, 0.0], "O4": [4.0, 0.0], "A": [0.3, 1.0], "C": [0.8, 0.6],
            "B": [1.5, 3.0], "D": [3.0, 2.2], "E": [4.2, 2.0],
        },
        "links": [
            {"name": "ground", "joints": ["O2", "O4"]},
            {"name": "input", "joints": ["O2", "A", "C"]},
            {"name": "link_3", "joints": ["A", "B"]},
            {"name": "link_4", "joints": ["B", "D", "E"]},
            {"name": "link_5", "joints": ["C", "D"]},
            {"name": "output", "joints": ["O4", "E"]},
        ],
        "input_link": "input",
    },
}  # fmt: skip
