"""One mechanism of every type, stated as a client would, for the benchmarks of analyses."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from kinematics.linkage.fourbar.closed_form import Fourbar
from kinematics.linkage.planar.catalogue import make_fourbar, make_hart, make_pantograph, make_peaucellier, make_sixbar
from kinematics.linkage.planar.mechanism import Mechanism, Slide


def by_skeleton(mechanism: Mechanism) -> dict[str, Any]:
    def pair(z: Any) -> list[float]:
        return [complex(z).real, complex(z).imag]

    return {
        "type": "skeleton",
        "skeleton": {
            "joints": {name: pair(z) for name, z in mechanism.joints.items()},
            "links": [{"name": name, "joints": list(joints)} for name, joints in mechanism.links.items()],
            "slides": [
                {"joint": s.joint, "link": s.link, "point": pair(s.point), "angle": math.degrees(s.angle)}
                for s in mechanism.slides
            ],
            "input_link": mechanism.input,
        },
    }


def on_pivots(kind: str, ground: list[float], **fields: Any) -> dict[str, Any]:
    return {"type": kind, "fixed_pivots": {"input": [0.0, 0.0], "output": ground}, **fields}


FIVEBAR = {"input": 1.0, "coupler_1": 7.0, "coupler_2": 9.0, "output": 4.0}
SLIDER_CRANK = {
    "type": "slider_crank", "fixed_pivot": [0.0, 0.0], "links": {"crank": 2.0, "coupler": 7.0},
    "slide": {"point": [0.0, 1.0], "angle": 0.0},
}  # fmt: skip
SIXBARS: dict[str, tuple[dict[str, complex], tuple[str, ...]]] = {
    "watt_1": (
        {"O2": 0, "O4": 6, "A": 0.5 + 2j, "B": 6.3 + 4j, "C": 3 + 6j, "D": 8 + 7j, "E": 5 + 9j, "P": 6 + 11j},
        ("input", "output"),
    ),
    "watt_2": (
        {"O2": 0, "O4": 6, "O6": 12, "A": 0.5 + 2j, "B": 5 + 6j, "C": 7.5 + 6j, "D": 12.5 + 4j, "P": 4 + 8j},
        ("input", "rocker", "output"),
    ),
    "stephenson_1": (
        {"O2": 0, "O4": 6, "A": 0.5 + 2j, "C": -1 + 2.5j, "B": 6.3 + 5j, "D": 8 + 7j, "E": 3 + 9j},
        ("input", "output"),
    ),
    "stephenson_2": (
        {"O2": 0, "O4": 4, "A": 0.3 + 1j, "C": 0.8 + 0.6j, "B": 1.5 + 3j, "D": 3 + 2.2j, "E": 4.2 + 2j},
        ("input", "output"),
    ),
    "stephenson_3": (
        {"O2": 0, "O4": 6, "O6": 9, "A": 0.5 + 2j, "B": 5 + 6j, "C": 3 + 8j, "D": 9 + 5j, "P": 2 + 7j},
        ("input", "rocker", "output"),
    ),
}


def behind(
    lengths: tuple[float, ...],
    angle: float,
    links: dict[str, tuple[str, ...]],
    slides: tuple[Slide, ...] = (),
    **joints: complex,
) -> Mechanism:
    """A fourbar (input, coupler, output, ground, and P on the coupler's line) that drives further links or a slide."""
    first = make_fourbar(Fourbar.from_lengths(*lengths), angle)
    every = {**first.links, "rocker": first.links["output"]}
    every |= {"ground": (*first.links["ground"], *(name for name in joints if name[0] == "O"))} | links
    if "output" not in links:
        del every["output"]
    return Mechanism({**first.joints, **joints}, every, "input", slides)


def ram(joint: str, place: complex, angle: float, link: str = "ground") -> tuple[Slide]:
    return (Slide(joint, link, np.asarray(place), np.asarray(angle)),)


def dwell_in_a_slot() -> Mechanism:
    first = make_fourbar(Fourbar.from_lengths(*HOEKEN[0]), HOEKEN[1])
    p = complex(first.joints["P"])
    slot = ram("P", p, 0.2, "output")
    return behind(*HOEKEN, {"output": ("O6", "C")}, slot, O6=p - 6.0, C=p - 5.0 + 1j)


DRAG = (2.0, 2.2, 2.0, 1.0, 0.0), 0.8
DRAGGED = {"rocker": ("O4", "B", "C"), "link_5": ("C", "D")}
HOEKEN = (1.0, 2.5, 2.5, 2.0, 5.0), 0.9

STATED: dict[str, dict[str, Any]] = {
    "fourbar, crank": on_pivots("fourbar", [6.0, 0.0], links={"input": 2.0, "coupler": 7.0, "output": 9.0}),
    "fourbar, rocker": on_pivots("fourbar", [6.0, 0.0], links={"input": 5.0, "coupler": 4.0, "output": 3.2}),
    "fourbar, parallelogram": on_pivots("fourbar", [6.0, 0.0], links={"input": 2.0, "coupler": 6.0, "output": 2.0}),
    "slider-crank": SLIDER_CRANK,
    "slider-crank, driven by the slider": {**SLIDER_CRANK, "driven_by": "slider"},
    "inverted slider-crank": on_pivots(
        "inverted_slider_crank", [6.0, 0.0], links={"input": 2.0, "output": 1.0}, slide={"angle": 60.0}
    ),
    "crank-shaper": on_pivots(
        "crank_shaper", [0.0, -3.0], links={"crank": 1.0, "rocker": 5.0, "coupler": 3.0},
        slide={"point": [0.0, 2.0], "angle": 0.0},
    ),
    "Whitworth": on_pivots(
        "whitworth", [0.0, -1.0], links={"crank": 2.0, "rocker": 1.5, "coupler": 5.0},
        slide={"point": [0.0, -1.0], "angle": 0.0},
    ),
    "geared fivebar, 1 turn": on_pivots("geared_fivebar", [6.0, 0.0], links=FIVEBAR, gear_ratio=2.0, phase=60.0),
    "geared fivebar, 7 turns": on_pivots("geared_fivebar", [6.0, 0.0], links=FIVEBAR, gear_ratio=2 / 7, phase=60.0),
    **{
        f"{kind}, driven by its {link}": by_skeleton(make_sixbar(kind, joints, link))
        for kind, (joints, inputs) in SIXBARS.items()
        for link in inputs
    },
    "drag link, rocker": by_skeleton(
        behind(*DRAG, {**DRAGGED, "output": ("O6", "D")}, C=0.3 + 1.4j, O6=-6.0, D=-5.4 + 3.5j)
    ),
    "drag link, slider": by_skeleton(behind(*DRAG, DRAGGED, ram("D", 8.0, 0.0), C=0.3 + 1.4j, D=8.0)),
    "dwell, rocker": by_skeleton(
        behind(*HOEKEN, {"link_5": ("P", "D"), "output": ("O6", "D")}, O6=9.0 + 3j, D=8.0 + 6j)
    ),
    "dwell, slider": by_skeleton(behind(*HOEKEN, {"link_5": ("P", "D")}, ram("D", 9.0 + 4j, 0.0), D=9.0 + 4j)),
    "dwell, slot": by_skeleton(dwell_in_a_slot()),
    "Peaucellier's eightbar": by_skeleton(make_peaucellier(0.0, -1j, 1.0, 3.5, 2.0, 1.0)),
    "Hart's inversor": by_skeleton(make_hart(0.0, -1.0, 1.0, 5.0, 3.0, 0.4, 0.7)),
    "pantograph": by_skeleton(make_pantograph(0.0, 4.0, 0.5, 3.0, 6.0, 2.5, 0.7)),
}  # fmt: skip
