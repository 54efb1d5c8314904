"""Linkages as they are made: variants of one linkage, whose dimensions are a little off, driven to its targets."""

from kinematics.linkage.variation.driven import Deviations, Task, deviations, shares, squares

__all__ = ["Deviations", "Task", "deviations", "shares", "squares"]
