"""Code that several tests share: parts of gearboxes."""

from __future__ import annotations

BOX = {"kind": "gearbox", "input_speed": 200.0, "speeds": {"min": 100.0, "ratio": 1.6, "count": 3}, "structure": [3],
       "tooth_sum": {"min": 60, "max": 90}, "max_designs": 1}  # fmt: skip
"""Two gears that slide together, and one by itself."""
