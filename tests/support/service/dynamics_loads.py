"""Code that several tests share: dynamics loads."""

from __future__ import annotations

REACH = 0.1
"""Metres: the length of the crank."""

ALONE = {
    "type": "skeleton",
    "skeleton": {
        "joints": {"O2": [0.0, 0.0], "P": [1e3 * REACH, 0.0]},
        "links": [{"name": "ground", "joints": ["O2"]}, {"name": "input", "joints": ["O2", "P"]}],
        "input_link": "input",
    },
}
