"""Manufactured linkages: variants of one linkage with perturbed dimensions, driven to its targets."""

from kinematics.linkage.variation.variants import Deviations, Task, measure_deviations, measure_shares, measure_squares

__all__ = ["Deviations", "Task", "measure_deviations", "measure_shares", "measure_squares"]
