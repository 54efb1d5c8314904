"""The picture of a fourbar: the main panel, details of what is too small in it, and the key to the line styles."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from service.render.linkage.fourbar import Scene, details, fourbar_of
from service.render.linkage.fourbar_canvas import Detail
from service.render.linkage.fourbar_panel import FOOT, MARGIN, panel
from service.render.page.sheet import EDGE, fitted
from service.render.page.svg import Box, Element, Viewport, element, line, text, text_width
from service.render.page.symbols import CURVE, DEMANDED, GREY, INPUT, PALE
from synthesis.model.linkage_answer import LinkageDesign

WIDE = 1.7
"""Drawings wider than this in proportion to their height have their tables below instead of beside them."""

BESIDE_HEIGHT, BELOW_HEIGHT = (560.0, 860.0), (330.0, 620.0)
"""Least and greatest height of the main panel with tables beside it, and with tables below it, pixels."""

DETAIL_HEIGHT, KEY_HEIGHT, APART = 300.0, 30.0, 10.0
"""Heights of a detail and of the key, and space between panels, pixels."""


@dataclass(frozen=True)
class FourbarPicture:
    """A fourbar at its targets."""

    scene: Scene
    unit: str

    @cached_property
    def box(self) -> Box:
        """What it shows."""
        return self.scene.box()

    @property
    def wide(self) -> bool:
        """Whether it is so wide that the tables stand below it."""
        return self.box.width > WIDE * self.box.height

    def draw(self, width: float) -> tuple[list[Element], float]:
        """Main panel, details below it and key, and the y below them."""
        heights = BELOW_HEIGHT if self.wide else BESIDE_HEIGHT
        main = fitted(self.box, width, heights, MARGIN, FOOT, spare=0.0)
        bottom = main.panel.high
        small = []
        for k, part in enumerate(boxes := details(self.scene, self.box)):
            share = (width - APART * (len(boxes) - 1)) / len(boxes)
            left, top = EDGE + k * (share + APART), bottom + APART
            viewport = Viewport.fit(part, Box(left, top, left + share, top + DETAIL_HEIGHT), MARGIN, FOOT)
            small.append(Detail(part, f"detail {k + 1}", viewport))
        parts = [panel(self.scene, main, "main", self.unit, small)]
        parts += [panel(self.scene, detail.viewport, detail.name, self.unit, []) for detail in small]
        if small:
            bottom += APART + DETAIL_HEIGHT
        parts.append(_key(self.scene, bottom + 18.0, width))
        return parts, bottom + KEY_HEIGHT


def description(design: LinkageDesign, unit: str, shown: Scene) -> str:
    """The linkage in words, with its sizes and how many demands it is shown at."""
    mechanism = fourbar_of(design)
    sizes = ", ".join(f"{name} {value:.6g} {unit}" for name, value in mechanism.links)
    met = f"shown at {shown.met} of {shown.demanded} demanded positions"
    if len(shown.demands) < shown.demanded:
        met = f"{met}, of which {len(shown.demands)} are drawn"
    if shown.target is not None:
        met = f"shown at the first of {len(design.targets)} points of the demanded curve"
    return f"a fourbar linkage, {mechanism.assembly} assembly: {sizes}; {met}"


def _key(shown: Scene, y: float, width: float) -> Element:
    """What the line styles mean."""
    entries = [
        ("target", "demanded position" if shown.guides_a_body else "demanded point"),
        ("used", "path of P, used"),
        ("rest", "rest of branch"),
        *([("ghost", "other targets")] if shown.others else []),
        *([("curve", "demanded curve")] if shown.target is not None else []),
        *([("miss", "missed by")] if shown.misses else []),
    ]
    if shown.limits is not None:
        entries.append(("limit", "input limit"))
    group = element("g", data_key="true")
    sample, size = 22.0, 10.5
    spare = width - sum(sample + 6.0 + text_width(words, size) for _, words in entries)
    x = EDGE
    for kind, words in entries:
        group.add(*_sample(kind, complex(x, y - 4.0), sample))
        group.add(text(x + sample + 6.0, y, words, size, fill=GREY))
        x += sample + 6.0 + text_width(words, size) + min(26.0, spare / max(1, len(entries) - 1))
    return group


def _sample(kind: str, at: complex, width: float) -> list[Element]:
    end, middle = at + width, at + 0.5 * width
    if kind == "target":
        ring = element("circle", cx=at.real + 5.0, cy=at.imag, r=4.5, fill="none", stroke=DEMANDED, stroke_width=1.5)
        return [line(at + 5.0, end, stroke=DEMANDED, stroke_width=3.5, stroke_opacity=0.35), ring]
    if kind == "curve":
        return [line(at, end, stroke=DEMANDED, stroke_width=6.0, stroke_opacity=0.3)]
    if kind == "miss":
        return [line(at, end, stroke=DEMANDED, stroke_width=1.6)]
    if kind == "limit":
        return [line(middle - 7j, middle + 7j, stroke=INPUT, stroke_width=2.0)]
    stroke, weight = {"used": (CURVE, 2.2), "rest": (CURVE, 0.9), "ghost": (PALE, 2.4)}[kind]
    return [line(at, end, stroke=stroke, stroke_width=weight)]
