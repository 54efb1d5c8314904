"""Small dense linear programs, solved by HiGHS (Huangfu & Hall 2018, doi:10.1007/s12532-017-0130-5).

Sequential linear programming solves hundreds of programs with about ten unknowns and up to three hundred rows. The
simplex method takes half a millisecond for each. ``scipy.optimize.linprog`` spends six times as long on checks and
presolving, so that this module calls HiGHS directly.
"""

from __future__ import annotations

from typing import NamedTuple

import highspy
import numpy as np

from kinematics.arrays import Real


class LinearMinimum(NamedTuple):
    """Minimizer of a linear program and the minimum."""

    at: Real
    value: float


def solve_linear_program(cost: Real, rows: Real, limits: Real, low: Real, high: Real) -> LinearMinimum | None:
    """Minimize cost · x subject to rows x ≤ limits and low ≤ x ≤ high.

    Parameters
    ----------
    cost, low, high : float, shape (n,)
        Cost, and bounds of x, which may be infinite.
    rows : float, shape (m, n)
    limits : float, shape (m,)

    Returns
    -------
    LinearMinimum or None
        None if the program is infeasible or unbounded, or if a number is not finite.
    """
    # HiGHS does not define its behaviour for NaN.
    if not all(np.isfinite(given).all() for given in (cost, rows, limits)):
        return None
    program = highspy.Highs()
    program.setOptionValue("output_flag", False)
    # Presolving takes longer than the simplex method on programs of this size.
    program.setOptionValue("presolve", "off")
    m, n = rows.shape
    program.passModel(
        n,
        m,
        m * n,
        int(highspy.MatrixFormat.kRowwise),
        int(highspy.ObjSense.kMinimize),
        0.0,
        cost,
        low,
        high,
        np.full(m, -np.inf),
        limits,
        np.arange(0, m * n, n, dtype=np.int32),
        np.tile(np.arange(n, dtype=np.int32), m),
        rows.ravel(),
        np.zeros(n, dtype=np.int32),
    )
    program.run()
    if program.getModelStatus() != highspy.HighsModelStatus.kOptimal:
        return None
    return LinearMinimum(np.array(program.getSolution().col_value), float(program.getInfo().objective_function_value))
