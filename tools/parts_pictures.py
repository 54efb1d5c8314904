"""Draws the assemblies of ``docs/mechanisms/parts.md`` anew: ``python -m tools.parts_pictures``, seconds.

Each is a design of a problem that is stated here, made as a request would have it.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from service.parts.assembly.items import list_items
from service.parts.assembly.sizes import PartsQuery
from service.parts.drawings.assembly_sheet import draw_assembly_sheet
from service.parts.drawings.isometric import draw_isometric_sheet
from service.parts.registry import make_parts
from synthesis.dispatch import solve
from synthesis.registry import parse_problem

DOCS = Path(__file__).parents[1] / "docs" / "images"

PLACES = [(0.0, 0.0, 0.0), (40.0, 15.0, -25.0), (75.0, 5.0, -60.0)]
FOURBAR: dict[str, Any] = {
    "kind": "motion",
    "positions": [{"x": x, "y": y, "angle": angle} for x, y, angle in PLACES],
    "length_unit": "mm",
}
SIZES: dict[str, Any] = {"process": "print", "width": 15.0, "pin": 5.0, "thickness": 4.0}
"""Of the request that begins the page."""

CAM: dict[str, Any] = {
    "kind": "cam",
    "length_unit": "mm",
    "segments": [
        {"motion": "rise", "angle": 120.0, "lift": 20.0, "law": "modified_sine"},
        {"motion": "dwell", "angle": 60.0},
        {"motion": "return", "angle": 120.0, "law": "cycloidal"},
        {"motion": "dwell", "angle": 60.0},
    ],
    "follower": {"type": "translating_roller", "roller_radius": 8.0, "offset": 5.0},
}
PICTURES: dict[str, tuple[str, dict[str, Any], dict[str, Any]]] = {
    "fourbar": ("A fourbar, printed", FOURBAR, SIZES),
    "shaper": (
        "A crank shaper, cut from sheet",
        {"kind": "quick_return", "mechanism": "crank_shaper", "time_ratio": 1.4, "stroke": 100.0, "length_unit": "mm"},
        {},
    ),
    "whitworth": (
        "A Whitworth quick return, cut from sheet",
        {"kind": "quick_return", "mechanism": "whitworth", "time_ratio": 1.8, "stroke": 100.0, "length_unit": "mm"},
        {},
    ),
    "planetary": (
        "Planetary train 1:4",
        {
            "kind": "planetary_train",
            "ratio": "4",
            "fixed": "ring",
            "arrangement": "simple",
            "module": 2.0,
            "teeth": {"max": 80},
        },
        {},
    ),
    "cam": ("A cam with a roller follower, cut from sheet", CAM, {}),
    "geneva": (
        "A Geneva drive of six stations, cut from sheet",
        {
            "kind": "indexing",
            "drive": "geneva_external",
            "stations": 6,
            "rollers": 1,
            "center_distance": 80.0,
            "roller_diameter": 10.0,
            "speed_rpm": 60.0,
        },
        {},
    ),
}
"""By name: a title, a problem, and what is asked of its parts."""


def drawn(title: str, problem: dict[str, Any], query: dict[str, Any]) -> tuple[str, str]:
    """The drawing of an assembly, and its picture."""
    stated = parse_problem({**problem, "max_designs": 1})
    design = solve(stated, lambda _fraction, _message: None).designs[0]
    assembly = make_parts(design, stated, PartsQuery(**query))
    picture = draw_isometric_sheet(assembly, title, assembly.motion.reference)
    return draw_assembly_sheet(assembly, list_items(assembly), title), picture


def main() -> None:
    """Write the files."""
    for name, (title, problem, query) in PICTURES.items():
        drawing, picture = drawn(title, problem, query)
        (DOCS / f"parts_{name}.svg").write_text(drawing, encoding="utf-8")
        if name == "fourbar":
            (DOCS / "parts_isometric.svg").write_text(picture, encoding="utf-8")


if __name__ == "__main__":
    main()
