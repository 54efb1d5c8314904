"""Programs that generate the data files, pictures and pages of the project; they are not installed with the package.

Run them from the root of the repository. For example, ``python -m tools.path_starts nine --output /tmp/start.npz``
solves a random problem of path generation, and its output can replace ``synthesis/kinds/path/nine_point_start.npz``.
The option ``--help`` of each program describes its output. Seeds are fixed, so a run reproduces the stored file up to
rounding.
"""
