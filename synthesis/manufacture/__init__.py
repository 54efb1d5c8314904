"""Linkages as a shop makes them: what a design does when its dimensions are a little off (docs/manufacture.md).

The compiled motion of variants is :mod:`kinematics.linkage.variation`; here a design and what it is held to become a
task of that (:mod:`~synthesis.manufacture.linkage`), samples become a yield
(:mod:`~synthesis.manufacture.yield_sampling`), and derivatives and corners an answer
(:mod:`~synthesis.manufacture.report`).
"""
