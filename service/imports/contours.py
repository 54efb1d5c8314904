"""Contours of a field of samples by marching squares, as closed curves between its points.

Where the field passes the level between two neighbouring samples, it is taken to run straight from one to the other,
and a contour crosses there (Lorensen and Cline, Computer Graphics 21 (1987), 163–169, in the plane). Each crossing lies
on the side of two squares, and each square leads from one of its crossings to another; so every crossing has one that
follows it, and the contours are the cycles. Higher values lie to the left of a contour: around an island it runs
counter-clockwise. In a square whose corners are high and low in turn, the high ones are joined unless the mean of the
four is lower than the level: lines that are one pixel wide hold together.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex

# The sides of a square: bottom, right, top, left. Corners count 1, 2, 4, 8 from lower left, counter-clockwise. From
# which side to which a contour goes, with the high corners on its left.
_BOTTOM, _RIGHT, _TOP, _LEFT = range(4)
_WAYS: dict[int, tuple[tuple[int, int], ...]] = {
    1: ((_BOTTOM, _LEFT),),
    2: ((_RIGHT, _BOTTOM),),
    3: ((_RIGHT, _LEFT),),
    4: ((_TOP, _RIGHT),),
    6: ((_TOP, _BOTTOM),),
    7: ((_TOP, _LEFT),),
    8: ((_LEFT, _TOP),),
    9: ((_BOTTOM, _TOP),),
    11: ((_RIGHT, _TOP),),
    12: ((_LEFT, _RIGHT),),
    13: ((_BOTTOM, _RIGHT),),
    14: ((_LEFT, _BOTTOM),),
}
_JOINED = {5: ((_BOTTOM, _RIGHT), (_TOP, _LEFT)), 10: ((_LEFT, _BOTTOM), (_RIGHT, _TOP))}
"""With a high middle, which joins the high corners."""
_APART = {5: ((_BOTTOM, _LEFT), (_TOP, _RIGHT)), 10: ((_RIGHT, _BOTTOM), (_LEFT, _TOP))}


class TooMany(ValueError):
    """There are more crossings than were allowed."""


def contours(field: NDArray[np.uint8], level: float, most: int) -> list[Complex]:
    """The contours of a field at a level, each as the crossings along it, complex; the first is not repeated.

    Parameters
    ----------
    field : uint8, shape (rows, columns)
        Samples at x = column, y = row. Its rim is below the level, so that every contour is closed.
    level : float
        No sample has it.
    most : int
        Crossings at most.

    Raises
    ------
    TooMany
        There are more.
    """
    high = field > level
    # The sides of squares that a contour crosses, by their places in the raveled field, ascending.
    across, up = np.flatnonzero(_differ(high, 1)), np.flatnonzero(_differ(high, 0))
    if len(across) + len(up) > most:
        raise TooMany
    if not len(across):
        return []
    columns = field.shape[1]
    points = np.concatenate([_crossings(field, level, across, 1), _crossings(field, level, up, columns)])
    following = _following(field, level, high, across, up)
    return [points[cycle] for cycle in _cycles(following)]


def _differ(high: NDArray[np.bool_], axis: int) -> NDArray[np.bool_]:
    """Which samples are on another side of the level than the next one along an axis; the last ones are not."""
    differ = np.zeros_like(high)
    here = (slice(None), slice(None, -1)) if axis == 1 else (slice(None, -1), slice(None))
    there = (slice(None), slice(1, None)) if axis == 1 else (slice(1, None), slice(None))
    np.not_equal(high[here], high[there], out=differ[here])
    return differ


def _crossings(field: NDArray[np.uint8], level: float, sides: NDArray[np.int64], step: int) -> Complex:
    """Where the field passes the level between samples and those ``step`` places farther."""
    samples = field.ravel()
    first, second = samples[sides].astype(float), samples[sides + step].astype(float)
    row, column = np.divmod(sides, field.shape[1])
    share = (level - first) / (second - first)
    return np.asarray(column + 1j * row + (share if step == 1 else 1j * share))


def _following(
    field: NDArray[np.uint8],
    level: float,
    high: NDArray[np.bool_],
    across: NDArray[np.int64],
    up: NDArray[np.int64],
) -> NDArray[np.int64]:
    """The crossing that follows each one along its contour; those across come first."""
    columns = field.shape[1]
    # Every square that is crossed has a crossed side at its lower left or upper right corner.
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
            [(_WAYS[value], here)]
            if value in _WAYS
            else [(_JOINED[value], here & joined), (_APART[value], here & ~joined)]
        ):
            for start, end in ways:
                following[sides[start, where]] = sides[end, where]
    return following


def _cycles(following: NDArray[np.int64]) -> list[NDArray[np.int64]]:
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
