"""Code that several tests share: function optimality."""

from __future__ import annotations

CLASSICAL = {
    "x^1.5, 1 to 4": {"name": "power", "exponent": 1.5, "x": [1.0, 4.0]},
    "log x, 1 to 2": {"name": "logarithm", "x": [1.0, 2.0]},
    "sin x, 0 to 90°": {"name": "sine", "x": [0.0, 90.0]},
    "e^x, 0 to 1": {"name": "exponential", "x": [0.0, 1.0]},
    "1/x, 1 to 2": {"name": "reciprocal", "x": [1.0, 2.0]},
    "tan x, 0 to 45°": {"name": "tangent", "x": [0.0, 45.0]},
}
RANGES = ((60.0, 60.0), (60.0, 120.0), (90.0, 90.0), (120.0, 60.0), (120.0, 120.0))
