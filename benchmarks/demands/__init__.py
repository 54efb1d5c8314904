"""Planted problems with demands: is what has an answer answered, how well, and how soon.

Each row is a module of this package with a function ``tasks``; see :mod:`tests.support.demands.task`.
"""
