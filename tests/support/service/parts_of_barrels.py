"""Code that several tests share: parts of barrels."""

from __future__ import annotations

from typing import Any

from tests.support.service.parts_of_cams import CAM

BARREL: dict[str, Any] = {**CAM, "follower": {"type": "barrel_roller", "roller_radius": 8.0}, "rotation": "cw"}
