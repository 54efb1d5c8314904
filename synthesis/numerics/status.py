"""How a descent has ended: not converging is a status, never an exception.

The same distinctions as in SciPy's ``optimize._lsq``. A descent that has not converged has still come to its best
point, and may go on from there.
"""

from __future__ import annotations

from enum import IntEnum


class Status(IntEnum):
    """Why a descent has ended; positive where it has converged."""

    INFEASIBLE = -4
    """Limits do not hold at the end, though multipliers were renewed as often as is allowed."""
    STALLED = -3
    """No step decreases the cost, however large the damping, though one should."""
    SINGULAR = -2
    """The normal equations have no finite solution."""
    IMPOSSIBLE = -1
    """The start itself is outside the problem's domain."""
    STEP_LIMIT = 0
    """As many steps as are allowed have been tried."""
    GRADIENT = 1
    """The linear model expects a decrease below rounding."""
    COST = 2
    """Two steps in turn have changed the cost by less than the tolerance."""
    STEP = 3
    """The step is below rounding."""
    ZERO = 4
    """The cost itself is rounding."""

    @property
    def converged(self) -> bool:
        """Whether the end is a stationary point, to the tolerance asked for."""
        return self > 0
