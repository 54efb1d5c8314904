"""Redraw the assemblies shown in ``docs/mechanisms/parts.md``: ``python -m tools.parts_pictures`` (takes seconds).

Each assembly is that of a design for a problem defined in this module, built with the options of a request for parts.
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
"""Part sizes in the first request on the page: lengths in the unit of the problem, and the process."""

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
"""Title, problem and requested part options of each picture, by the name of its file."""


def drawn(title: str, problem: dict[str, Any], query: dict[str, Any]) -> tuple[str, str]:
    """Solve a problem and return the assembly sheet and the isometric picture of its first design, as SVG."""
    stated = parse_problem({**problem, "max_designs": 1})
    design = solve(stated, lambda _fraction, _message: None).designs[0]
    assembly = make_parts(design, stated, PartsQuery(**query))
    picture = draw_isometric_sheet(assembly, title, assembly.motion.reference)
    return draw_assembly_sheet(assembly, list_items(assembly), title), picture


def main() -> None:
    """Write all pictures to the folder of the documentation."""
    for name, (title, problem, query) in PICTURES.items():
        drawing, picture = drawn(title, problem, query)
        (DOCS / f"parts_{name}.svg").write_text(drawing, encoding="utf-8")
        if name == "fourbar":
            (DOCS / "parts_isometric.svg").write_text(picture, encoding="utf-8")


if __name__ == "__main__":
    main()
