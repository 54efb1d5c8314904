"""Which mechanism does what is asked: solvers, verification and ranking.

The door is :func:`synthesis.dispatch.solve`; the kinds of problems are folders of :mod:`synthesis.kinds`.
"""
