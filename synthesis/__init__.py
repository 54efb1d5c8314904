"""Which mechanism does what is asked: solvers, verification and ranking.

The door is :func:`synthesis.dispatch.solve`. Importing it loads the compiled kernels, which whoever only needs the
models (:mod:`synthesis.problems`, :mod:`synthesis.designs`) does not wait for.
"""
