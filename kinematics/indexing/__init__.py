"""Drives that turn a wheel by steps: closed forms of Geneva drives, the outlines of their wheels and locking discs."""

from __future__ import annotations

from kinematics.indexing.geneva import Geneva, Motion

__all__ = ["Geneva", "Motion"]
