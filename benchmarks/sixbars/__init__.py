"""Sixbars: how many tasks have a sound one, how good it is, how long that takes, and whether what is claimed is true.

    python -m benchmarks.sixbars ROW [--tasks N] [--seed 0]

A row is a module of this package with a function ``table(tasks, seed)`` that prints it, and ``TASKS``, how many are
drawn where nothing is said. Times are of a processor, and of the wall.
"""
