"""The proof of a design: it is driven by the analysis core and measured, from its dimensions alone.

Here stands what is the same for every kind of problem: a mechanism rebuilt from what an answer states
(:mod:`~synthesis.verification.reconstruction`), extremes of what it does
(:mod:`~synthesis.verification.refined_extremes`), what is measured of every driven linkage
(:mod:`~synthesis.verification.measures`), and measured values against limits (:mod:`~synthesis.verification.checks`,
:mod:`~synthesis.verification.constraints`). What only one kind demands (its targets, its rests, its dials) is driven
and checked in that kind's folder, in ``verification`` and what that imports; a module here imports no kind.
"""
