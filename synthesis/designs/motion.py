"""Answers to problems of motion generation."""

from __future__ import annotations

from synthesis.designs.base import Result
from synthesis.designs.linkage import LinkageDesign


class MotionResult(Result[LinkageDesign]):
    """Linkages that carry the body through the positions."""
