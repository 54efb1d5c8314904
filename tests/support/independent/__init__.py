"""Answers measured by another route than that of the service: every number that both have, and how far they differ.

Linkages (:mod:`~tests.support.independent.linkages`): tasks of all kinds, with and without demands, are solved, and
each mechanism of an answer is driven from its skeleton alone by Newton's iteration on what keeps its length; extremes
are closed in between the steps. Cams (:mod:`~tests.support.independent.cams`): laws and curves of the textbooks,
written out, and motions that are optimized, from the table of the design.

Differences are relative to the scale of each quantity: a right angle or a turn for angles, the size of the task for
places, the value itself for lengths, ratios, errors and rates. :mod:`~tests.support.independent.quantities` lists all
that designs state, and what of it is no measure.
"""
