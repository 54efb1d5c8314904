"""Designs with manufacturing errors: effects of small deviations in the dimensions (docs/mechanisms/manufacture.md).

The compiled motion of variants is :mod:`kinematics.linkage.variation`. Here a design and its requirements become a task
for it (:mod:`~synthesis.manufacture.linkage`), samples become a yield (:mod:`~synthesis.manufacture.yield_sampling`),
and derivatives and corners become a report (:mod:`~synthesis.manufacture.report`).
"""
