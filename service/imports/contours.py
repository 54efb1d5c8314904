"""Contours of a field of samples by marching squares, as closed curves between the samples.

If the field passes the level between two neighbouring samples, it is interpolated linearly, and a contour crosses the
line between them there (the plane case of Lorensen and Cline, Computer Graphics 21 (1987), 163–169). Each crossing lies
on the common side of two squares, and each square connects its crossings in pairs. So each crossing has exactly one
successor, and the contours are the cycles. Higher values lie to the left of a contour, which therefore runs
counter-clockwise around an island. In a square whose corners are alternately high and low, the high corners are joined
unless the mean of the four is below the level. This keeps lines one pixel wide connected.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex

# The sides of a square: bottom, right, top, left. The key is the sum of the high corners, which count 1, 2, 4, 8 from
# the lower left, counter-clockwise. The value has the sides from and to which contours run, high corners on the left.
_BOTTOM_SIDE, _RIGHT_SIDE, _TOP_SIDE, _LEFT_SIDE = range(4)
_SIDE_PAIRS: dict[int, tuple[tuple[int, int], ...]] = {
    1: ((_BOTTOM_SIDE, _LEFT_SIDE),),
    2: ((_RIGHT_SIDE, _BOTTOM_SIDE),),
    3: ((_RIGHT_SIDE, _LEFT_SIDE),),
    4: ((_TOP_SIDE, _RIGHT_SIDE),),
    6: ((_TOP_SIDE, _BOTTOM_SIDE),),
    7: ((_TOP_SIDE, _LEFT_SIDE),),
    8: ((_LEFT_SIDE, _TOP_SIDE),),
    9: ((_BOTTOM_SIDE, _TOP_SIDE),),
    11: ((_RIGHT_SIDE, _TOP_SIDE),),
    12: ((_LEFT_SIDE, _RIGHT_SIDE),),
    13: ((_BOTTOM_SIDE, _RIGHT_SIDE),),
    14: ((_LEFT_SIDE, _BOTTOM_SIDE),),
}
_JOINED_PAIRS = {
    5: ((_BOTTOM_SIDE, _RIGHT_SIDE), (_TOP_SIDE, _LEFT_SIDE)),
    10: ((_LEFT_SIDE, _BOTTOM_SIDE), (_RIGHT_SIDE, _TOP_SIDE)),
}
"""Connections in the two ambiguous squares if their centre is high and joins the high corners."""
_SEPARATE_PAIRS = {
    5: ((_BOTTOM_SIDE, _LEFT_SIDE), (_TOP_SIDE, _RIGHT_SIDE)),
    10: ((_RIGHT_SIDE, _BOTTOM_SIDE), (_LEFT_SIDE, _TOP_SIDE)),
}


class TooManyCrossings(ValueError):
    """The contours have more crossings than allowed."""


def trace_contours(field: NDArray[np.uint8], level: float, most: int) -> list[Complex]:
    """Return the contours of a field at a level, each as its crossings x + iy in order, without repeating the first.

    Parameters
    ----------
    field : uint8, shape (rows, columns)
        Samples at x = column, y = row. The rim must be below the level, so that every contour is closed.
    level : float
        Level of the contours; no sample may be equal to it.
    most : int
        Maximum number of crossings.

    Raises
    ------
    TooManyCrossings
        If there are more crossings.
    """
    high = field > level
    # The sides of squares that contours cross, as ascending indices into the raveled field.
    across, up = np.flatnonzero(_mark_crossings(high, 1)), np.flatnonzero(_mark_crossings(high, 0))
    if len(across) + len(up) > most:
        raise TooManyCrossings
    if not len(across):
        return []
    columns = field.shape[1]
    points = np.concatenate([_locate_crossings(field, level, across, 1), _locate_crossings(field, level, up, columns)])
    following = _link_crossings(field, level, high, across, up)
    return [points[cycle] for cycle in _collect_cycles(following)]


def _mark_crossings(high: NDArray[np.bool_], axis: int) -> NDArray[np.bool_]:
    """Mark the samples on another side of the level than the next one along an axis; the last ones are never marked."""
    differ = np.zeros_like(high)
    here = (slice(None), slice(None, -1)) if axis == 1 else (slice(None, -1), slice(None))
    there = (slice(None), slice(1, None)) if axis == 1 else (slice(1, None), slice(None))
    np.not_equal(high[here], high[there], out=differ[here])
    return differ


def _locate_crossings(field: NDArray[np.uint8], level: float, sides: NDArray[np.int64], step: int) -> Complex:
    """Return where the field passes the level between the given samples and those ``step`` indices later."""
    samples = field.ravel()
    first, second = samples[sides].astype(float), samples[sides + step].astype(float)
    row, column = np.divmod(sides, field.shape[1])
    share = (level - first) / (second - first)
    return np.asarray(column + 1j * row + (share if step == 1 else 1j * share))


def _link_crossings(
    field: NDArray[np.uint8],
    level: float,
    high: NDArray[np.bool_],
    across: NDArray[np.int64],
    up: NDArray[np.int64],
) -> NDArray[np.int64]:
    """Return the index of the next crossing along the contour for each crossing; those of ``across`` come first."""
    columns = field.shape[1]
    # The squares on both sides of each crossed side.
    squares = np.unique(np.concatenate([across, across - columns, up, up - 1]))
    corners = [squares, squares + 1, squares + columns + 1, squares + columns]
    case = sum(high.ravel()[corner].astype(np.uint8) << k for k, corner in enumerate(corners))
    joined = sum(field.ravel()[corner].astype(float) for corner in corners) >= 4.0 * level

    def number(sides: NDArray[np.int64], of: NDArray[np.int64], first: int) -> NDArray[np.int64]:
        return np.asarray(first + np.searchsorted(of, sides))

    sides = np.stack(
        [
            number(squares, across, 0),
            number(squares + 1, up, len(across)),
            number(squares + columns, across, 0),
            number(squares, up, len(across)),
        ]
    )
    following = np.full(len(across) + len(up), -1)
    for value in range(1, 15):
        here = case == value
        for ways, where in (
            [(_SIDE_PAIRS[value], here)]
            if value in _SIDE_PAIRS
            else [(_JOINED_PAIRS[value], here & joined), (_SEPARATE_PAIRS[value], here & ~joined)]
        ):
            for start, end in ways:
                following[sides[start, where]] = sides[end, where]
    return following


def _collect_cycles(following: NDArray[np.int64]) -> list[NDArray[np.int64]]:
    after = following.tolist()
    seen = bytearray(len(after))
    cycles = []
    for begin in range(len(after)):
        if seen[begin]:
            continue
        cycle, at = [], begin
        while not seen[at]:
            seen[at] = 1
            cycle.append(at)
            at = after[at]
        cycles.append(np.array(cycle))
    return cycles
