"""Verification of a design: the analysis core drives and measures it, from its dimensions alone.

This package contains the parts common to all kinds of problems: the mechanism rebuilt from an answer
(:mod:`~synthesis.verification.reconstruction`), extremes of its motion
(:mod:`~kinematics.linkage.refined_extremes`), measured properties of every driven linkage
(:mod:`~synthesis.verification.measures`), and comparisons of measured values with limits
(:mod:`~synthesis.verification.checks`, :mod:`~synthesis.verification.constraints`). Requirements of a single kind, such
as targets, dwells or dials, are checked in the folder ``verification`` of that kind. The modules here import no kind.
"""
