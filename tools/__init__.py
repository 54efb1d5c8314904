"""What makes the data that the package stores; not installed with it.

Run from the repository's root: ``python -m tools.path_starts nine --output /tmp/start.npz`` solves a random problem of
path generation anew, and what it writes may take the place of ``synthesis/kinds/path/nine_point_start.npz``. Each
program says with ``--help`` what it makes. Seeds are fixed, so that a run gives the same file again up to rounding.
"""
