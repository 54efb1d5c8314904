"""The outlines in a picture: what is dark on light, light on dark, or opaque on nothing, to a fraction of a pixel.

A sample stands in the middle of its pixel; x and y begin at the lower left corner of the picture.
"""

from __future__ import annotations

import io
import struct
import warnings
import zlib
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from kinematics.arrays import Complex
from service.imports.contours import TooMany, contours
from service.imports.limits import MOST_CROSSINGS, MOST_PIXELS
from service.outlines.faults import MalformedDrawing, UnsuitableDrawing

BROKEN = (
    OSError, EOFError, SyntaxError, ValueError, IndexError, struct.error, zlib.error, Image.DecompressionBombError,
)  # fmt: skip
"""What the library raises of broken files, by its sources; anything else is a defect."""

Samples = NDArray[np.uint8]
"""0 is black, or nothing; 255 is white, or opaque."""

LEAST_CONTRAST = 25
"""Between the darkest and the lightest sample."""

SPECK = 12
"""Contours of fewer crossings go around some three pixels or less."""

STEPPED = 0.5
"""A contour of which this share of the crossings lies midway between two samples has steps: its rim had no grey."""

_PASSES = 10
_INWARD, _OUTWARD = 0.33, -0.34
"""Taubin, Curve and surface smoothing without shrinkage (ICCV 1995): steps become lines, and the area stays."""

FINE, COARSE = 0.1, 0.5
"""Pixels within which a contour is thinned where none are asked for: smooth, and such as had steps."""


@dataclass(frozen=True)
class Picture:
    """Contours in pixels, the longest first; whether each had steps; how many specks were left out; a pixel's size."""

    contours: list[Complex]
    stepped: list[bool]
    specks: int
    millimetres: tuple[float, float] | None


def picture_of(content: bytes) -> Picture:
    """The contours in a PNG picture.

    Raises
    ------
    Malformed
        It is no PNG, or not a whole one.
    Unsuitable
        It has too many pixels or contours, or nothing that stands out.
    """
    samples, alpha, millimetres = _samples(content)
    field, level = _field(samples, alpha)
    try:
        found = contours(field, level, MOST_CROSSINGS)
    except TooMany:
        raise UnsuitableDrawing(
            f"The contours of the picture have more than {MOST_CROSSINGS} points; is it a photograph? Send a drawing "
            "in two colours."
        ) from None
    # Rows run downwards in the file, and were turned over; the rim is one sample wide, and samples lie in the middle.
    kept = [one - complex(0.5, 0.5) for one in found if len(one) >= SPECK]
    stepped = [_stepped(one) for one in kept]
    smooth = [_smoothed(one) if steps else one for one, steps in zip(kept, stepped, strict=True)]
    order = sorted(range(len(smooth)), key=lambda k: -float(np.abs(np.diff(smooth[k])).sum()))
    return Picture([smooth[k] for k in order], [stepped[k] for k in order], len(found) - len(kept), millimetres)


def _samples(content: bytes) -> tuple[Samples, Samples | None, tuple[float, float] | None]:
    """Lightness, rows upwards; opacity where any is stated; millimetres of a pixel across and up."""
    # Where it begins as it must; the library would refuse the largest in words of its own.
    _bounded(int.from_bytes(content[16:20], "big"), int.from_bytes(content[20:24], "big"))
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            picture = Image.open(io.BytesIO(content), formats=("PNG",))
            _bounded(*picture.size)
            picture.load()
    except UnsuitableDrawing:
        raise
    except BROKEN as error:
        raise MalformedDrawing(f"The picture cannot be read as PNG ({type(error).__name__}).") from None
    density = picture.info.get("dpi")
    opacity = None
    if picture.mode.startswith("I"):
        lightness = (np.asarray(picture) >> 8).astype(np.uint8)
    elif "A" in picture.getbands() or "transparency" in picture.info:
        whole = picture.convert("RGBA")
        opacity = np.asarray(whole.getchannel("A"))
        lightness = np.asarray(whole.convert("L"))
    else:
        lightness = np.asarray(picture.convert("L"))
    millimetres = None
    if density and all(1e-3 < side < 1e9 for side in density):
        millimetres = (25.4 / float(density[0]), 25.4 / float(density[1]))
    return lightness[::-1], None if opacity is None else opacity[::-1], millimetres


def _bounded(width: int, height: int) -> None:
    if width * height > MOST_PIXELS:
        raise UnsuitableDrawing(f"The picture has {width} × {height} pixels, more than {MOST_PIXELS}.")


def _field(lightness: Samples, opacity: Samples | None) -> tuple[Samples, float]:
    """What stands out as high samples, with a rim of what does not around it; and the level between the two."""
    if opacity is not None and opacity.min() < 128 <= opacity.max():
        # The drawing is what is opaque, whatever its colour.
        return np.pad(opacity, 1), 127.5
    least, most = int(lightness.min()), int(lightness.max())
    if most - least < LEAST_CONTRAST:
        raise UnsuitableDrawing(
            "Nothing stands out in the picture; it takes something dark on light, or the other way."
        )
    middle = 0.5 * (least + most)
    # No sample has the level itself.
    level = middle if middle % 1.0 else middle + 0.25
    rim = np.concatenate([lightness[0], lightness[-1], lightness[:, 0], lightness[:, -1]])
    # What most of the rim is, is the ground.
    if float((rim > level).mean()) < 0.5:
        return np.pad(lightness, 1, constant_values=least), level
    return np.pad(~lightness, 1, constant_values=255 - most), 255.0 - level


def _stepped(contour: Complex) -> bool:
    # Of a crossing one coordinate is that of a sample; the other is in the middle where both samples are pure.
    twice = 2.0 * np.stack([contour.real, contour.imag])
    return bool((np.abs(twice - np.round(twice)).max(axis=0) < 1e-6).mean() > STEPPED)


def _smoothed(contour: Complex) -> Complex:
    for _ in range(_PASSES):
        for share in (_INWARD, _OUTWARD):
            contour = contour + share * (0.5 * (np.roll(contour, 1) + np.roll(contour, -1)) - contour)
    return contour
