"""Planted tasks of fitting into a room: a linkage that is known to fit, and whether the service finds one that does.

A random linkage is driven over its used range, and a room is drawn around what it sweeps, so that it fits by 2 mm:
zones of its pivots, a box, obstacles, and for a carried body its outline (:mod:`~tests.support.fit.room`). The
statement is solved as the service solves it, and every design of the answer is driven again by another route in steps
of 0.05 degrees and held against the room by shapely (:mod:`~tests.support.fit.verdict`). A row, a module with
``tasks(count, seed)``, plants the tasks of one kind.
"""
