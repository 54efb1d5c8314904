"""The picture of a fourbar: the main panel, details of small parts, and the key to the line styles."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from service.render.linkage.fourbar import Scene, details, fourbar_of
from service.render.linkage.fourbar_canvas import Detail
from service.render.linkage.fourbar_panel import FOOT, MARGIN, panel
from service.render.linkage.styles import GHOST, LIMIT, MISS, TARGET_CURVE, USED_PATH, WHOLE_PATH
from service.render.page.sheet import EDGE, fitted
from service.render.page.svg import Box, Element, Viewport, element, line, text, text_width
from service.render.page.symbols import DEMANDED, GREY
from synthesis.model.linkage_answer import LinkageDesign

WIDE = 1.7
"""Ratio of width to height above which the tables are placed below the drawing instead of next to it."""

BESIDE_HEIGHT, BELOW_HEIGHT = (560.0, 860.0), (330.0, 620.0)
"""Minimum and maximum height of the main panel with tables next to it, and with tables below it, pixels."""

SAMPLE, SAMPLE_GAP, KEY_SIZE, MAX_GAP = 28.0, 6.0, 10.5, 26.0
"""Dimensions of the key: width of a sample with its gap, that gap, font size, maximum space between entries; pixels."""

SAMPLES = {"used": USED_PATH, "rest": WHOLE_PATH, "ghost": GHOST, "curve": TARGET_CURVE, "miss": MISS}
"""Line styles of the key."""

DETAIL_HEIGHT, KEY_HEIGHT, APART = 300.0, 30.0, 10.0
"""Heights of a detail and of the key, and space between panels, pixels."""


@dataclass(frozen=True)
class FourbarPicture:
    """A fourbar at its targets."""

    scene: Scene
    unit: str

    @cached_property
    def box(self) -> Box:
        """Box of the content."""
        return self.scene.box()

    @property
    def wide(self) -> bool:
        """Whether the drawing is so wide that the tables are placed below it."""
        return self.box.width > WIDE * self.box.height

    def draw(self, width: float) -> tuple[list[Element], float]:
        """Draw the main panel, details below it and the key; return them and the y below."""
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
    """Describe the linkage in words: its sizes and the number of targets shown."""
    mechanism = fourbar_of(design)
    sizes = ", ".join(f"{name} {value:.6g} {unit}" for name, value in mechanism.links)
    met = f"shown at {shown.met} of {shown.demanded} target positions"
    if len(shown.demands) < shown.demanded:
        met = f"{met}, of which {len(shown.demands)} are drawn"
    if shown.target is not None:
        met = f"shown at the first of {len(design.targets)} points of the target curve"
    return f"a fourbar linkage, {mechanism.assembly} assembly: {sizes}; {met}"


def _key(shown: Scene, y: float, width: float) -> Element:
    """Draw the key to the line styles."""
    entries = [
        ("target", "target position" if shown.guides_a_body else "target point"),
        ("used", "path of P, used"),
        ("rest", "rest of branch"),
        *([("ghost", "other targets")] if shown.others else []),
        *([("curve", "target curve")] if shown.target is not None else []),
        *([("miss", "error")] if shown.misses else []),
    ]
    if shown.limits is not None:
        entries.append(("limit", "input limit"))
    group = element("g", data_key="true")
    # Distribute the remaining width between the entries.
    spare = width - sum(SAMPLE + text_width(words, KEY_SIZE) for _, words in entries)
    x = EDGE
    for kind, words in entries:
        group.add(*_sample(kind, complex(x, y - 4.0), SAMPLE - SAMPLE_GAP))
        group.add(text(x + SAMPLE, y, words, KEY_SIZE, fill=GREY))
        x += SAMPLE + text_width(words, KEY_SIZE) + min(MAX_GAP, spare / max(1, len(entries) - 1))
    return group


def _sample(kind: str, at: complex, width: float) -> list[Element]:
    end, middle = at + width, at + 0.5 * width
    if kind == "target":
        ring = element("circle", cx=at.real + 5.0, cy=at.imag, r=4.5, fill="none", stroke=DEMANDED, stroke_width=1.5)
        return [line(at + 5.0, end, stroke=DEMANDED, stroke_width=3.5, stroke_opacity=0.35), ring]
    if kind == "limit":
        return [line(middle - 7j, middle + 7j, **LIMIT)]
    return [line(at, end, **SAMPLES[kind])]
