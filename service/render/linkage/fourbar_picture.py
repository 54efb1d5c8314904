"""The picture of a fourbar: the main panel, details of small parts, and the key to the line styles."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from service.render.linkage.fourbar import FourbarScene, find_details, get_fourbar
from service.render.linkage.fourbar_canvas import Detail
from service.render.linkage.fourbar_panel import MARGIN, MARGIN_BELOW, draw_fourbar_panel
from service.render.linkage.styles import GHOST_LINE, LIMIT_TICK, MISS_LINE, TARGET_CURVE, USED_PATH, WHOLE_PATH
from service.render.page.sheet import BORDER, fit_panel
from service.render.page.svg import Box, Element, Viewport, draw_line, draw_text, estimate_text_width, make_element
from service.render.page.symbols import GREY, TARGET_COLOUR
from synthesis.model.linkage.answer import LinkageDesign

WIDE_RATIO = 1.7
"""Ratio of width to height above which the tables are placed below the drawing instead of next to it."""

NARROW_HEIGHTS, WIDE_HEIGHTS = (560.0, 860.0), (330.0, 620.0)
"""Minimum and maximum height of the main panel with tables next to it, and with tables below it, pixels."""

SAMPLE_WIDTH, SAMPLE_GAP, KEY_FONT_SIZE, MAX_KEY_GAP = 28.0, 6.0, 10.5, 26.0
"""Dimensions of the key: width of a sample with its gap, that gap, font size, maximum space between entries; pixels."""

KEY_STYLES = {"used": USED_PATH, "rest": WHOLE_PATH, "ghost": GHOST_LINE, "curve": TARGET_CURVE, "miss": MISS_LINE}
"""Line styles of the key."""

DETAIL_HEIGHT, KEY_HEIGHT, PANEL_GAP = 300.0, 30.0, 10.0
"""Heights of a detail and of the key, and space between panels, pixels."""


@dataclass(frozen=True)
class FourbarPicture:
    """A fourbar at its targets."""

    scene: FourbarScene
    unit: str

    @cached_property
    def box(self) -> Box:
        """Box of the content."""
        return self.scene.find_box()

    @property
    def wide(self) -> bool:
        """Whether the drawing is so wide that the tables are placed below it."""
        return self.box.width > WIDE_RATIO * self.box.height

    def draw(self, width: float) -> tuple[list[Element], float]:
        """Draw the main panel, details below it and the key; return them and the y below."""
        heights = WIDE_HEIGHTS if self.wide else NARROW_HEIGHTS
        main = fit_panel(self.box, width, heights, MARGIN, MARGIN_BELOW, spare=0.0)
        bottom = main.panel.high
        small = []
        for k, part in enumerate(boxes := find_details(self.scene, self.box)):
            share = (width - PANEL_GAP * (len(boxes) - 1)) / len(boxes)
            left, top = BORDER + k * (share + PANEL_GAP), bottom + PANEL_GAP
            viewport = Viewport.fit(part, Box(left, top, left + share, top + DETAIL_HEIGHT), MARGIN, MARGIN_BELOW)
            small.append(Detail(part, f"detail {k + 1}", viewport))
        parts = [draw_fourbar_panel(self.scene, main, "main", self.unit, small)]
        parts += [draw_fourbar_panel(self.scene, detail.viewport, detail.name, self.unit, []) for detail in small]
        if small:
            bottom += PANEL_GAP + DETAIL_HEIGHT
        parts.append(_draw_key(self.scene, bottom + 18.0, width))
        return parts, bottom + KEY_HEIGHT


def describe_fourbar(design: LinkageDesign, unit: str, shown: FourbarScene) -> str:
    """Describe the linkage in words: its sizes and the number of targets shown."""
    mechanism = get_fourbar(design)
    sizes = ", ".join(f"{name} {value:.6g} {unit}" for name, value in mechanism.links)
    met = f"shown at {shown.met} of {shown.demanded} target positions"
    if len(shown.demands) < shown.demanded:
        met = f"{met}, of which {len(shown.demands)} are drawn"
    if shown.target is not None:
        met = f"shown at the first of {len(design.targets)} points of the target curve"
    return f"a fourbar linkage, {mechanism.assembly} assembly: {sizes}; {met}"


def _draw_key(shown: FourbarScene, y: float, width: float) -> Element:
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
    group = make_element("g", data_key="true")
    # Distribute the remaining width between the entries.
    spare = width - sum(SAMPLE_WIDTH + estimate_text_width(words, KEY_FONT_SIZE) for _, words in entries)
    x = BORDER
    for kind, words in entries:
        group.add(*_draw_sample(kind, complex(x, y - 4.0), SAMPLE_WIDTH - SAMPLE_GAP))
        group.add(draw_text(x + SAMPLE_WIDTH, y, words, KEY_FONT_SIZE, fill=GREY))
        x += (
            SAMPLE_WIDTH
            + estimate_text_width(words, KEY_FONT_SIZE)
            + min(MAX_KEY_GAP, spare / max(1, len(entries) - 1))
        )
    return group


def _draw_sample(kind: str, at: complex, width: float) -> list[Element]:
    end, middle = at + width, at + 0.5 * width
    if kind == "target":
        ring = make_element(
            "circle", cx=at.real + 5.0, cy=at.imag, r=4.5, fill="none", stroke=TARGET_COLOUR, stroke_width=1.5
        )
        return [draw_line(at + 5.0, end, stroke=TARGET_COLOUR, stroke_width=3.5, stroke_opacity=0.35), ring]
    if kind == "limit":
        return [draw_line(middle - 7j, middle + 7j, **LIMIT_TICK)]
    return [draw_line(at, end, **KEY_STYLES[kind])]
