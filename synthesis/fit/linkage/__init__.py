"""The engine that fits linkages of any topology: a table of nodes, one closure, residuals and constraints.

A topology (:mod:`~synthesis.fit.linkage.topology`) lists the pins and points of a linkage in the order in which they
close. The unknowns are the coordinates of all nodes in one reference position: lengths, assemblies and the place of the
linkage follow from them. :mod:`~synthesis.fit.linkage.closure` moves the nodes and differentiates them,
:mod:`~synthesis.fit.linkage.residuals` writes the rows of a fit for the descents of :mod:`synthesis.numerics`,
:mod:`~synthesis.fit.linkage.margins` its constraints, and :mod:`~synthesis.fit.linkage.population` draws random
linkages that rotate fully.
"""
