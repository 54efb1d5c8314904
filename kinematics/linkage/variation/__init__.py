"""Manufactured linkages: variants of one linkage with perturbed dimensions, driven to its targets."""

from kinematics.linkage.variation.driven import Deviations, Task, deviations, shares, squares

__all__ = ["Deviations", "Task", "deviations", "shares", "squares"]
