"""Indexing drives: closed forms of Geneva drives, outlines of their wheels and locking discs, ratchets."""

from __future__ import annotations

from kinematics.indexing.geneva import Geneva, Motion

__all__ = ["Geneva", "Motion"]
