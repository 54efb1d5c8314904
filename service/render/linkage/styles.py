"""The line styles of linkage drawings, by what they show: one for the drawings, their keys and their tables."""

from __future__ import annotations

from service.render.page.symbols import CURVE, DEMANDED, GROUND, INPUT, PALE

Style = dict[str, str | float | None]

GROUND_LINE: Style = {"stroke": GROUND, "stroke_width": 1.3, "stroke_dasharray": "12 4 2 4"}
"""From fixed pivot to fixed pivot."""

WHOLE_PATH: Style = {"stroke": CURVE, "stroke_width": 0.9}
"""The path of a joint over the cycle."""

USED_PATH: Style = {"stroke": CURVE, "stroke_width": 2.2}
"""The part of it from the first target to the last."""

TARGET_CURVE: Style = {"stroke": DEMANDED, "stroke_width": 6.0, "stroke_opacity": 0.3}
"""A curve that is demanded as a whole."""

STANCE: Style = {"stroke": DEMANDED, "stroke_width": 2.6, "stroke_linecap": "round"}
"""The part of a path that is to be straight."""

MISS: Style = {"stroke": DEMANDED, "stroke_width": 1.6}
"""From a demanded point to where the linkage passes it."""

LIMIT: Style = {"stroke": INPUT, "stroke_width": 2.0}
"""A tick at a limit of the input."""

GHOST_WIDTH = 2.4
GHOST: Style = {"stroke": PALE, "stroke_width": GHOST_WIDTH}
"""A link at another target than the first."""
