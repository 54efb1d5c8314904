"""Code that several tests share: screening."""

from __future__ import annotations

import math
from itertools import pairwise

from synthesis.model.linkage.answer import LinkageDesign


def excess_of(design: LinkageDesign, stated: list[dict[str, float]], size: float) -> float:
    """Excess travel and turning of the body, by the design's metrics and docs/methods/ranking.md."""
    needed = sum(math.dist((p["x"], p["y"]), (q["x"], q["y"])) for p, q in pairwise(stated))
    turn = sum(abs(math.remainder(q["angle"] - p["angle"], 360.0)) for p, q in pairwise(stated))
    metrics = design.metrics
    travel = ((metrics.body_travel_ratio or 1.0) - 1.0) * needed / max(needed, size)
    return max(travel, ((metrics.body_turn_ratio or 1.0) - 1.0) * turn / max(turn, 15.0), 0.0)
