"""Clearance between the parts of a mechanism, and to its surroundings, over a whole motion.

:func:`sweep_pairs` decides whether pairs of parts keep a distance at *every* input of a range, not at samples of it:
between two positions no point moves farther than :mod:`enclosures` allows, and :mod:`sweep` refines until that decides.
"""

from kinematics.linkage.clearance.outlines import Part
from kinematics.linkage.clearance.sweep import SweepResult, find_free_inputs, find_free_ranges, sweep_pairs

__all__ = ["Part", "SweepResult", "find_free_inputs", "find_free_ranges", "sweep_pairs"]
