"""Number format of a sheet: few digits, a true minus sign, and a dash for missing values."""

from __future__ import annotations

import math

PLAIN = 1e-3, 1e6
"""Range of magnitudes that are written without an exponent."""

ROUNDING = 1e-12
"""Share of the mechanism's size below which a coordinate is a rounding error of zero."""

NONE = "–"


def length(value: float, size: float = 0.0, digits: int = 6, most: int = 15) -> str:
    """Format a length to ``digits`` significant digits.

    ``size`` is that of the mechanism: a value that is a rounding error of it is written as zero, and one beyond it
    gets more digits, up to ``most``, so that coordinates far from the origin still distinguish its points.
    """
    if not math.isfinite(value):
        return NONE
    if value == 0.0 or abs(value) < ROUNDING * size:
        return "0"
    if 0.0 < size < abs(value):
        # Coordinates far from the origin need more digits to distinguish neighbouring points.
        digits = min(most, digits + math.ceil(math.log10(abs(value) / size)))
    if PLAIN[0] <= abs(float(f"{value:.{digits - 1}e}")) < max(PLAIN[1], 10.0**digits):
        decimals = max(0, digits - 1 - math.floor(math.log10(abs(value))))
        text = f"{value:.{decimals}f}"
        return _signed(text.rstrip("0").rstrip(".") if "." in text else text)
    mantissa, exponent = f"{value:.{digits - 1}e}".split("e")
    return _signed(f"{mantissa.rstrip('0').rstrip('.')}e{int(exponent)}")


def angle(degrees: float, decimals: int = 3) -> str:
    """Format an angle in degrees, with its unit sign."""
    if not math.isfinite(degrees):
        return NONE
    text = f"{degrees:.{decimals}f}"
    if decimals:
        text = text.rstrip("0").rstrip(".")
    return _signed("0" if text == "-0" else text) + "°"


def small(value: float) -> str:
    """Format a residual or similar value to two digits."""
    return length(value, digits=2)


def _signed(text: str) -> str:
    return text.replace("-", "−")
