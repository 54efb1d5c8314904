"""Code that several tests share: parts of gears."""

from __future__ import annotations

PAIR = {"kind": "gear_train", "ratio": "7/3", "max_stages": 1, "max_designs": 1, "module": 2.0}


SET = {"kind": "planetary_train", "ratio": "4", "max_designs": 1, "arrangement": "simple", "teeth": {"max": 80}}


WORM = {"kind": "gear_train", "ratio": 20, "max_designs": 1, "module": 1.5,
        "stages": [{"type": "worm", "driver": 2, "driven": 40, "hand": "left"}]}  # fmt: skip


BEVELS = {"kind": "gear_train", "ratio": "3/2", "max_designs": 1, "module": 2.0,
          "stages": [{"type": "bevel", "driver": 20, "driven": 30, "shaft_angle": 75.0}]}  # fmt: skip
