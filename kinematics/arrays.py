"""Names of array types, shared by all packages: one word for one kind of number."""

import numpy as np
from numpy.typing import NDArray

Real = NDArray[np.float64]
"""Real numbers in double precision: lengths, angles in radians, residuals."""

Complex = NDArray[np.complex128]
"""Points and vectors of the plane as complex numbers x + iy, in double precision."""

Integers = NDArray[np.int64]
"""Whole numbers: counts, indices, tooth numbers, branch signs."""

Mask = NDArray[np.bool_]
"""Truth values: which rows of a batch are selected."""
