"""Colours of parts by kind."""

from __future__ import annotations

LINK_COLOURS = ("#b8600b", "#1f5a9e", "#22734a", "#5b3a8c", "#a3195b", "#1b7f86", "#8a6d1a", "#6b4b3a")
"""Link colours; the first is that of the input, as in the studio."""

BASE_COLOUR, BLOCK_COLOUR = "#76818c", "#c2a14a"
