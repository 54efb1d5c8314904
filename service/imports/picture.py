"""Outlines in a picture, dark on light, light on dark or opaque on transparent, to a fraction of a pixel.

A sample lies in the middle of its pixel; the origin of x and y is the lower left corner of the picture.
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
from kinematics.message import compose
from service.imports.contours import TooManyCrossings, trace_contours
from service.imports.limits import MAX_CROSSINGS, MAX_PIXELS
from service.outlines.faults import MalformedDrawing, UnsuitableDrawing

BROKEN_FILE_ERRORS = (
    OSError, EOFError, SyntaxError, ValueError, IndexError, struct.error, zlib.error, Image.DecompressionBombError,
)  # fmt: skip
"""Errors of the library for broken files, according to its sources; any other error is a defect."""

Samples = NDArray[np.uint8]
"""Lightness or opacity: 0 is black or transparent, 255 is white or opaque."""

MIN_CONTRAST = 25
"""Minimum difference between the darkest and the lightest sample."""

MIN_CONTOUR_CROSSINGS = 12
"""Minimum number of crossings of a contour; shorter ones enclose three pixels or fewer."""

STEPPED_SHARE = 0.5
"""Share of crossings midway between two samples from which a contour counts as stepped: its edge has no grey."""

_PASS_COUNT = 10
_INWARD_FACTOR, _OUTWARD_FACTOR = 0.33, -0.34
"""Factors of Taubin, Curve and surface smoothing without shrinkage (ICCV 1995): steps become lines, areas are kept."""

FINE_TOLERANCE, COARSE_TOLERANCE = 0.1, 0.5
"""Default tolerances for thinning a contour, pixels: smooth contours, and stepped ones."""


@dataclass(frozen=True)
class Picture:
    """Contours of a picture: in pixels, longest first.

    The other fields are: whether each contour was stepped, the number of omitted specks, and the size of a pixel in
    millimetres.
    """

    contours: list[Complex]
    stepped: list[bool]
    specks: int
    millimetres: tuple[float, float] | None


def read_picture(content: bytes) -> Picture:
    """Find the contours in a PNG picture.

    Raises
    ------
    MalformedDrawing
        If it is not a complete PNG file.
    UnsuitableDrawing
        If it has too many pixels or contours, or too little contrast.
    """
    samples, alpha, millimetres = _read_samples(content)
    field, level = _build_field(samples, alpha)
    try:
        found = trace_contours(field, level, MAX_CROSSINGS)
    except TooManyCrossings:
        raise UnsuitableDrawing(compose("imports-contours-too-long", limit=MAX_CROSSINGS)) from None
    # The padding shifts the samples by 1, and a sample lies in the middle of its pixel, at 1/2: together the crossings
    # are shifted by 1/2.
    kept = [one - complex(0.5, 0.5) for one in found if len(one) >= MIN_CONTOUR_CROSSINGS]
    stepped = [_is_stepped(one) for one in kept]
    smooth = [_smooth_contour(one) if steps else one for one, steps in zip(kept, stepped, strict=True)]
    order = sorted(range(len(smooth)), key=lambda k: -float(np.abs(np.diff(smooth[k])).sum()))
    return Picture([smooth[k] for k in order], [stepped[k] for k in order], len(found) - len(kept), millimetres)


def _read_samples(content: bytes) -> tuple[Samples, Samples | None, tuple[float, float] | None]:
    """Return lightness with rows upwards, opacity if there is any, and the size of a pixel in x and y, millimetres."""
    # Read the size from the header first: the library would refuse very large pictures with its own message.
    _check_size(int.from_bytes(content[16:20], "big"), int.from_bytes(content[20:24], "big"))
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            picture = Image.open(io.BytesIO(content), formats=("PNG",))
            _check_size(*picture.size)
            picture.load()
    except UnsuitableDrawing:
        raise
    except BROKEN_FILE_ERRORS as error:
        raise MalformedDrawing(compose("imports-png-unreadable", error=type(error).__name__)) from None
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


def _check_size(width: int, height: int) -> None:
    if width * height > MAX_PIXELS:
        raise UnsuitableDrawing(compose("imports-too-many-pixels", width=width, height=height, limit=MAX_PIXELS))


def _build_field(lightness: Samples, opacity: Samples | None) -> tuple[Samples, float]:
    """Return the drawing as high samples on a low background with a low rim, and the level between the two."""
    if opacity is not None and opacity.min() < 128 <= opacity.max():
        # In a partly transparent picture the opaque part is the drawing, independent of its colour.
        return np.pad(opacity, 1), 127.5
    least, most = int(lightness.min()), int(lightness.max())
    if most - least < MIN_CONTRAST:
        raise UnsuitableDrawing(compose("imports-contrast-too-low"))
    middle = 0.5 * (least + most)
    # The level must differ from every sample: samples are integers, so a fraction is added if necessary.
    level = middle if middle % 1.0 else middle + 0.25
    rim = np.concatenate([lightness[0], lightness[-1], lightness[:, 0], lightness[:, -1]])
    # The majority of the rim decides whether the background is dark or light.
    if float((rim > level).mean()) < 0.5:
        return np.pad(lightness, 1, constant_values=least), level
    return np.pad(~lightness, 1, constant_values=255 - most), 255.0 - level


def _is_stepped(contour: Complex) -> bool:
    # One coordinate of a crossing is that of a sample; the other one is midway if both samples are pure black or white.
    twice = 2.0 * np.stack([contour.real, contour.imag])
    return bool((np.abs(twice - np.round(twice)).max(axis=0) < 1e-6).mean() > STEPPED_SHARE)


def _smooth_contour(contour: Complex) -> Complex:
    for _ in range(_PASS_COUNT):
        for share in (_INWARD_FACTOR, _OUTWARD_FACTOR):
            contour = contour + share * (0.5 * (np.roll(contour, 1) + np.roll(contour, -1)) - contour)
    return contour
