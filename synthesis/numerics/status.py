"""Status of a descent; failure to converge is a status, never an exception.

The statuses are those of SciPy's ``optimize._lsq``. A descent that has not converged still returns its best point and
may continue from there.
"""

from __future__ import annotations

from enum import IntEnum


class Status(IntEnum):
    """Reason why a descent ended; positive if it converged."""

    INFEASIBLE = -4
    """Limits are violated at the end although the multipliers were updated as often as permitted."""
    NO_DECREASE = -3
    """No step decreases the cost at any damping although the linear model predicts a decrease."""
    SINGULAR = -2
    """The normal equations have no finite solution."""
    IMPOSSIBLE = -1
    """The start itself is outside the problem's domain."""
    STEP_LIMIT = 0
    """The maximum number of steps was reached."""
    GRADIENT = 1
    """The linear model predicts a decrease below rounding."""
    COST = 2
    """Two consecutive steps changed the cost by less than the tolerance."""
    STEP = 3
    """The step is below rounding."""
    ZERO = 4
    """The cost itself is rounding."""

    @property
    def is_converged(self) -> bool:
        """Whether the end is a stationary point to the given tolerance."""
        return self > 0
