"""The proof of a design: it is driven by the analysis core and measured, from its dimensions alone.

Here stands what is the same for every kind of problem: a mechanism rebuilt from what an answer states
(:mod:`~synthesis.proof.rebuilt`), extremes of what it does (:mod:`~synthesis.proof.closer`), what is measured of every
driven linkage (:mod:`~synthesis.proof.measures`), and measured values against limits (:mod:`~synthesis.proof.checks`,
:mod:`~synthesis.proof.constraints`). What only one kind demands (its targets, its rests, its dials) is driven and
checked in that kind's folder, in ``verification`` and what that imports; a module here imports no kind.
"""
