"""Effects of small deviations in the dimensions of a design (docs/mechanisms/manufacture.md).

:mod:`kinematics.linkage.variation` drives variants of a linkage in compiled code. Here a design and its requirements
are converted to a task for it (:mod:`~synthesis.manufacture.linkage`), samples give a yield
(:mod:`~synthesis.manufacture.yield_sampling`), and derivatives and corners of the tolerances give a report
(:mod:`~synthesis.manufacture.report`).
"""
