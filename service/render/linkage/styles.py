"""Line styles of linkage drawings, shared by the drawings, their keys and their tables."""

from __future__ import annotations

from service.render.page.symbols import CURVE, GROUND, INPUT, PALE, TARGET_COLOUR

Style = dict[str, str | float | None]

GROUND_LINE: Style = {"stroke": GROUND, "stroke_width": 1.3, "stroke_dasharray": "12 4 2 4"}
"""Line between the fixed pivots."""

WHOLE_PATH: Style = {"stroke": CURVE, "stroke_width": 0.9}
"""Path of a joint over the cycle."""

USED_PATH: Style = {"stroke": CURVE, "stroke_width": 2.2}
"""Part of that path from the first target to the last."""

TARGET_CURVE: Style = {"stroke": TARGET_COLOUR, "stroke_width": 6.0, "stroke_opacity": 0.3}
"""Target curve that is required as a whole."""

STANCE_LINE: Style = {"stroke": TARGET_COLOUR, "stroke_width": 2.6, "stroke_linecap": "round"}
"""Part of a path that is required to be straight."""

MISS_LINE: Style = {"stroke": TARGET_COLOUR, "stroke_width": 1.6}
"""Line from a target point to the position of the linkage there."""

LIMIT_TICK: Style = {"stroke": INPUT, "stroke_width": 2.0}
"""Tick at a limit of the input."""

GHOST_WIDTH = 2.4
GHOST_LINE: Style = {"stroke": PALE, "stroke_width": GHOST_WIDTH}
"""Link at a target other than the first."""
