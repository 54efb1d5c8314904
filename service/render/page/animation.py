"""Animations as GIF: a design goes through its cycle, over and over.

Every frame is polylines; they are drawn by Pillow at twice the size and reduced, which smooths them, in one palette. A
GIF has 60 frames of 480 pixels, so that it takes about a second and a few hundred kilobytes whatever the mechanism.
"""

from __future__ import annotations

import io
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from service.render.page.svg import Box, Points

FRAMES = 60
"""Frames of a cycle."""

PIXELS = 480
"""Longer side of a frame; the shorter one is as long as what is shown, a third of it at least."""

STEP_MS = 50
"""Time of a frame, milliseconds: browsers slow down what is faster than 20 ms."""

FINER = 2
"""Oversampling: pixels drawn for each pixel of the frame, in each direction."""

MARGIN = 0.05
"""Room around what is shown, as a share of its longer side."""

COLOURS = 48
"""Of the palette, the mixtures at smooth edges included."""

ROUND = 48
"""Corners of a polygon that stands for a circle."""

MOST_CORNERS = 720
"""Corners of a polyline at most; a frame shows no more."""


@dataclass(frozen=True)
class Stroke:
    """A polyline in the mechanism's plane; ``width`` in pixels of the frame, ``fill`` where it bounds a face."""

    points: Points
    colour: str
    width: float
    closed: bool = False
    fill: str | None = None


def ring(centre: complex, radius: float) -> Points:
    """A circle."""
    return np.asarray(centre + radius * np.exp(2j * math.pi * np.arange(ROUND) / ROUND))


def animated(frames: Iterable[Sequence[Stroke]], shown: Box) -> bytes:
    """A GIF of frames that show a box of the plane, each frame's strokes in the order in which they are painted."""
    longer = max(shown.width, shown.height) or 1.0
    box = shown.grown(MARGIN * longer)
    scale = FINER * PIXELS / max(box.width, box.height)
    size = tuple(max(round(side * scale / FINER), PIXELS // 3) for side in (box.width, box.height))
    pictures: list[Image.Image] = []
    palette: Image.Image | None = None
    for strokes in frames:
        picture = Image.new("RGB", (FINER * size[0], FINER * size[1]), "white")
        pen = ImageDraw.Draw(picture)
        for stroke in strokes:
            _paint(pen, stroke, _placed(stroke.points, box, scale, size))
        smooth = picture.reduce(FINER)
        if palette is None:
            palette = smooth.quantize(COLOURS, method=Image.Quantize.MEDIANCUT)
        pictures.append(smooth.quantize(palette=palette, dither=Image.Dither.NONE))
    file = io.BytesIO()
    pictures[0].save(file, "GIF", save_all=True, append_images=pictures[1:], duration=STEP_MS, loop=0, optimize=False)
    return file.getvalue()


def _placed(points: Points, box: Box, scale: float, size: Sequence[int]) -> NDArray[np.float64]:
    """Corners on the enlarged picture, y down, at most :data:`MOST_CORNERS`, clipped to its surroundings."""
    every = -(-len(points) // MOST_CORNERS)
    kept = np.append(points[:-1:every], points[-1:]) if every > 1 else points
    middle = 0.5 * FINER * np.asarray(size, dtype=np.float64)
    centred = scale * (kept - box.centre)
    far = 4.0 * float(middle.max())
    return np.asarray(np.clip(np.column_stack([middle[0] + centred.real, middle[1] - centred.imag]), -far, far))


def _paint(pen: ImageDraw.ImageDraw, stroke: Stroke, corners: NDArray[np.float64]) -> None:
    listed = [(float(x), float(y)) for x, y in corners]
    if stroke.fill is not None and len(listed) > 2:
        pen.polygon(listed, fill=stroke.fill)
    if stroke.closed:
        listed += listed[:2]
    if stroke.width > 0.0 and len(listed) > 1:
        pen.line(listed, fill=stroke.colour, width=max(1, round(FINER * stroke.width)), joint="curve")
