"""The canvas of a fourbar: a panel with its viewport, visibility tests, and strokes that labels avoid.

The functions that draw links, curves and targets take a canvas and add to its root from back to front.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Complex
from service.render.linkage.fourbar import Configuration, FourbarScene
from service.render.page.labels import Labels
from service.render.page.sheet import draw_clipping_panel
from service.render.page.svg import Box, Element, Viewport, draw_circle, draw_path

FRAME_CLEARANCE = 12.0
"""Marks closer to the frame of a detail than this, pixels, appear only in the detail."""

FULL_SIZE_DISTANCE, MIN_SIZE_FACTOR = 30.0, 0.4
"""Distance of joints on the sheet, pixels, at which the linkage is drawn in full size, and the minimum size factor."""


class Detail(NamedTuple):
    """A part of the mechanism that is drawn again in another panel, with that panel's name and viewport."""

    box: Box
    name: str
    viewport: Viewport


class Canvas:
    """A panel that clips its content.

    Attributes
    ----------
    scene : FourbarScene
        The content.
    viewport : Viewport
        The map to the panel; recorded on the root as ``data-scale``, ``data-centre`` and ``data-middle``.
    labels : Labels
        Labels of this panel.
    root : Element
        The element that receives the strokes.
    first : Configuration or None
        The linkage at the first target, if it can be assembled there.
    size : float
        Factor on link widths and joint sizes: below 1 if the joints are close together on the sheet.
    frames : list of (Detail, Box)
        Parts shown in other panels, with their frames in this one.
    """

    def __init__(self, scene: FourbarScene, viewport: Viewport, name: str, details: Sequence[Detail]) -> None:
        self.scene, self.viewport = scene, viewport
        self.labels = Labels(viewport.panel.grow(-3.0))
        self.root = draw_clipping_panel(
            viewport.panel,
            name,
            data_scale=repr(viewport.scale),
            data_centre=f"{viewport.centre.real!r} {viewport.centre.imag!r}",
            data_middle=f"{viewport.middle.real!r} {viewport.middle.imag!r}",
        )
        self.first = next((c for c in scene.configurations if c.index == 0), None)
        self.frames = [(detail, self._find_frame(detail)) for detail in details]
        self.size = self._compute_link_size()

    def to_sheet(self, point: complex) -> complex:
        """Map a mechanism point to the sheet."""
        return self.viewport.point(point)

    def is_visible(self, point: complex) -> bool:
        """Return whether a mechanism point lies in the panel."""
        return self.viewport.panel.holds(self.to_sheet(point))

    def is_readable(self, point: complex) -> bool:
        """Return whether a point is visible here and not left to a detail, which shows its marks and labels."""
        at = self.to_sheet(point)
        return self.viewport.panel.holds(at) and not any(
            frame.grow(FRAME_CLEARANCE).holds(at) and detail.viewport.panel.holds(detail.viewport.point(point))
            for detail, frame in self.frames
        )

    def make_arc(self, radius: float, start: float, end: float) -> Complex:
        """Return an arc about O2 on the sheet; radius in pixels, angles in radians."""
        count = max(3, math.ceil(abs(end - start) / math.tau * 180))
        return np.asarray(self.to_sheet(self.scene.o2) + radius * np.exp(-1j * np.linspace(start, end, count)))

    def draw_segment(
        self, start: complex, end: complex, weight: float, /, **style: str | float | None
    ) -> Element | None:
        """Draw a straight part of a link, clipped to the panel; ``weight`` is the cost of a label that covers it."""
        pieces = self.viewport.clip_to_panel(np.array([start, end]))
        self.labels.add_obstacles(pieces, weight)
        return draw_path(pieces, **style)

    def draw_joint(
        self, group: Element, name: str, joint: complex, radius: float, /, **style: str | float | None
    ) -> None:
        """Add a joint's circle to a group; invisible joints are left out."""
        at = self.to_sheet(joint)
        if self.viewport.panel.grow(radius).holds(at):
            group.add(draw_circle(at, radius, data_joint=name, **style))
            self.labels.add_obstacles(
                [np.array([at - radius, at + radius, at, at - 1j * radius, at + 1j * radius])], 4.0
            )

    def list_ends(self, c: Configuration) -> list[tuple[complex, complex]]:
        """Return input, coupler and output as lines from joint to joint."""
        return [(self.scene.o2, c.a), (c.a, c.b), (c.b, self.scene.o4)]

    def _compute_link_size(self) -> float:
        if self.first is None:
            return 1.0
        # Only visible links limit the size.
        spans = [
            abs(v - u) * self.viewport.scale
            for u, v in self.list_ends(self.first)
            if self.is_visible(u) or self.is_visible(v)
        ]
        return min(1.0, max(MIN_SIZE_FACTOR, min(spans, default=FULL_SIZE_DISTANCE) / FULL_SIZE_DISTANCE))

    def _find_frame(self, detail: Detail) -> Box:
        at = self.to_sheet(detail.box.centre)
        # Frames of tiny details must remain visible.
        half = [max(9.0, 0.5 * self.viewport.scale * side + 8.0) for side in (detail.box.width, detail.box.height)]
        return Box(at.real - half[0], at.imag - half[1], at.real + half[0], at.imag + half[1])
