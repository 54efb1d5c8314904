"""Colours of parts, by what they are."""

from __future__ import annotations

LINK_COLOURS = ("#1f5a9e", "#b8600b", "#22734a", "#5b3a8c", "#a3195b", "#1b7f86", "#8a6d1a", "#6b4b3a")
BASE_COLOUR, BLOCK_COLOUR = "#76818c", "#c2a14a"
