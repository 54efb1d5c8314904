"""Names of array types, shared by all packages: one name for each kind of number."""

from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

Real = NDArray[np.float64]
"""Real numbers in double precision: lengths, angles in radians, residuals."""

Complex = NDArray[np.complex128]
"""Points and vectors of the plane as complex numbers x + iy, in double precision."""

Numbers = NDArray[np.inexact]
"""Real or complex numbers: arithmetic that is the same for both."""

Integers = NDArray[np.int64]
"""Whole numbers: counts, indices, tooth numbers, branch signs."""

Mask = NDArray[np.bool_]
"""Truth values: which rows of a batch are selected."""

Scalar = TypeVar("Scalar", bound=np.generic)
"""Type of an array's elements, for functions that return elements of the type they are given."""
