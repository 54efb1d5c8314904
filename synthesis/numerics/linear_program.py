"""One small dense linear program, solved by HiGHS (Huangfu & Hall 2018, doi:10.1007/s12532-017-0130-5).

Sequences of linear programs solve hundreds of them, each with some ten unknowns and up to three hundred rows. The
simplex method takes half a millisecond for one. ``scipy.optimize.linprog`` spends six times as long on checking and
presolving it, so that HiGHS is called directly.
"""

from __future__ import annotations

from typing import NamedTuple

import highspy
import numpy as np
from numpy.typing import NDArray

Real = NDArray[np.float64]


class Least(NamedTuple):
    """Where a linear program is least, and its value there."""

    at: Real
    value: float


def least(cost: Real, rows: Real, limits: Real, low: Real, high: Real) -> Least | None:
    """Minimise cost · x subject to rows x ≤ limits and low ≤ x ≤ high.

    Parameters
    ----------
    cost, low, high : float, shape (n,)
        Bounds may be infinite.
    rows : float, shape (m, n)
    limits : float, shape (m,)

    Returns
    -------
    Least or None
        None where nothing fulfils the rows, where the cost falls without end, and where a number is not finite.
    """
    if not all(np.isfinite(given).all() for given in (cost, rows, limits)):
        return None
    program = highspy.Highs()
    program.setOptionValue("output_flag", False)
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
    return Least(np.array(program.getSolution().col_value), float(program.getInfo().objective_function_value))
