"""Number format of a sheet: few digits, a true minus sign, and a dash for missing values."""

from __future__ import annotations

import math

PLAIN_RANGE = 1e-3, 1e6
"""Range of magnitudes that are written without an exponent."""

ROUNDING_SHARE = 1e-12
"""Share of the mechanism's size below which a coordinate is a rounding error of zero."""

MISSING_VALUE = "–"


def format_length(value: float, size: float = 0.0, digits: int = 6, most: int = 15) -> str:
    """Format a length to ``digits`` significant digits.

    ``size`` is the size of the mechanism. A value that is a rounding error relative to it is written as zero. A larger
    value gets more digits, up to ``most``, so that coordinates far from the origin still distinguish the points of the
    mechanism.
    """
    if not math.isfinite(value):
        return MISSING_VALUE
    if value == 0.0 or abs(value) < ROUNDING_SHARE * size:
        return "0"
    if 0.0 < size < abs(value):
        # Coordinates far from the origin need more digits to distinguish neighbouring points.
        digits = min(most, digits + math.ceil(math.log10(abs(value) / size)))
    if PLAIN_RANGE[0] <= abs(float(f"{value:.{digits - 1}e}")) < max(PLAIN_RANGE[1], 10.0**digits):
        decimals = max(0, digits - 1 - math.floor(math.log10(abs(value))))
        text = f"{value:.{decimals}f}"
        return _replace_minus(text.rstrip("0").rstrip(".") if "." in text else text)
    mantissa, exponent = f"{value:.{digits - 1}e}".split("e")
    return _replace_minus(f"{mantissa.rstrip('0').rstrip('.')}e{int(exponent)}")


def format_angle(degrees: float, decimals: int = 3) -> str:
    """Format an angle in degrees, with its unit sign."""
    if not math.isfinite(degrees):
        return MISSING_VALUE
    text = f"{degrees:.{decimals}f}"
    if decimals:
        text = text.rstrip("0").rstrip(".")
    return _replace_minus("0" if text == "-0" else text) + "°"


def format_small(value: float) -> str:
    """Format a residual or similar value to two digits."""
    return format_length(value, digits=2)


def _replace_minus(text: str) -> str:
    return text.replace("-", "−")
