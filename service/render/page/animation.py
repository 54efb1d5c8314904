"""Animations as GIF: a design moves through its cycle in a loop.

Every frame consists of polylines. Pillow draws them at twice the size and reduces the picture, which smooths them, to
one palette. A GIF has 60 frames of 480 pixels: about a second of work and a few hundred kilobytes for any mechanism.
"""

from __future__ import annotations

import io
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from kinematics.arrays import Complex
from service.render.page.svg import Box

FRAME_COUNT = 60
"""Number of frames in a cycle."""

FRAME_SIZE = 480
"""Longer side of a frame, pixels; the shorter side follows from the content, but is at least a third of it."""

FRAME_MILLISECONDS = 50
"""Duration of a frame, milliseconds; browsers slow down animations faster than 20 ms."""

OVERSAMPLING = 2
"""Oversampling factor in each direction."""

MARGIN_SHARE = 0.05
"""Margin around the content as a share of its longer side."""

PALETTE_SIZE = 48
"""Number of colours in the palette, including the mixed colours of smoothed edges."""

CIRCLE_CORNERS = 48
"""Number of corners of a polygon that represents a circle."""

MAX_CORNERS = 720
"""Maximum number of corners of a polyline; a frame cannot show more."""


@dataclass(frozen=True)
class Stroke:
    """A polyline in the mechanism's plane; ``width`` in pixels of the frame, ``fill`` if it bounds a face."""

    points: Complex
    colour: str
    width: float
    closed: bool = False
    fill: str | None = None


def make_circle(centre: complex, radius: float) -> Complex:
    """Return a circle as a polygon."""
    return np.asarray(centre + radius * np.exp(2j * math.pi * np.arange(CIRCLE_CORNERS) / CIRCLE_CORNERS))


def draw_gif(frames: Iterable[Sequence[Stroke]], shown: Box) -> bytes:
    """Draw a GIF whose frames show a box of the plane; strokes are painted in order."""
    longer = max(shown.width, shown.height) or 1.0
    # Strokes at the edge need a margin, or half their width is cut off.
    box = shown.grow(MARGIN_SHARE * longer)
    scale = OVERSAMPLING * FRAME_SIZE / max(box.width, box.height)
    size = tuple(max(round(side * scale / OVERSAMPLING), FRAME_SIZE // 3) for side in (box.width, box.height))
    pictures: list[Image.Image] = []
    palette: Image.Image | None = None
    for strokes in frames:
        picture = Image.new("RGB", (OVERSAMPLING * size[0], OVERSAMPLING * size[1]), "white")
        pen = ImageDraw.Draw(picture)
        for stroke in strokes:
            _draw_stroke(pen, stroke, _place_corners(stroke.points, box, scale, size))
        smooth = picture.reduce(OVERSAMPLING)
        # The first frame's palette serves all frames, so that colours do not flicker.
        if palette is None:
            palette = smooth.quantize(PALETTE_SIZE, method=Image.Quantize.MEDIANCUT)
        pictures.append(smooth.quantize(palette=palette, dither=Image.Dither.NONE))
    file = io.BytesIO()
    pictures[0].save(
        file, "GIF", save_all=True, append_images=pictures[1:], duration=FRAME_MILLISECONDS, loop=0, optimize=False
    )
    return file.getvalue()


def _place_corners(points: Complex, box: Box, scale: float, size: Sequence[int]) -> NDArray[np.float64]:
    """Return corners on the oversampled picture, y down, at most :data:`MAX_CORNERS`, clipped to its neighbourhood."""
    # Ceiling division: thin to at most the maximum.
    every = -(-len(points) // MAX_CORNERS)
    kept = np.append(points[:-1:every], points[-1:]) if every > 1 else points
    middle = 0.5 * OVERSAMPLING * np.asarray(size, dtype=np.float64)
    centred = scale * (kept - box.centre)
    # Pillow overflows on coordinates far outside the picture.
    far = 4.0 * float(middle.max())
    return np.asarray(np.clip(np.column_stack([middle[0] + centred.real, middle[1] - centred.imag]), -far, far))


def _draw_stroke(pen: ImageDraw.ImageDraw, stroke: Stroke, corners: NDArray[np.float64]) -> None:
    listed = [(float(x), float(y)) for x, y in corners]
    if stroke.fill is not None and len(listed) > 2:
        pen.polygon(listed, fill=stroke.fill)
    if stroke.closed:
        # Overlap by one segment, so that the closing corner gets a curved joint, too.
        listed += listed[:2]
    if stroke.width > 0.0 and len(listed) > 1:
        pen.line(listed, fill=stroke.colour, width=max(1, round(OVERSAMPLING * stroke.width)), joint="curve")
