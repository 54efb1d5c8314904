"""Names for the parts of one-dimensional arrays that pass many numbers to a compiled kernel at once.

A kernel cannot read the attributes of a layout. Modules therefore assign its indices and slices to constants, which
kernels see as literals:

    LIMITS = ArrayLayout(min_sine=1, boxes=8)
    MIN_SINE, BOXES = LIMITS.index("min_sine"), LIMITS.slice("boxes")
"""

from __future__ import annotations


class ArrayLayout:
    """Consecutive named parts of an array, each with its width.

    Parameters
    ----------
    first : int
        Index of the first part. A layout that continues another one begins at the other one's ``size``.
    **widths : int
        Number of entries of each part, in order.

    Attributes
    ----------
    size : int
        Index after the last part: the length of the array, unless a part of variable length follows.

    Raises
    ------
    ValueError
        For a part without entries.
    """

    def __init__(self, first: int = 0, /, **widths: int) -> None:
        self._slices: dict[str, slice] = {}
        for name, width in widths.items():
            if width < 1:
                raise ValueError(f"{name} must have at least one entry; its width is {width}")
            self._slices[name] = slice(first, first + width)
            first += width
        self.size = first

    def index(self, name: str) -> int:
        """Return the index of a part with a single entry.

        Raises
        ------
        ValueError
            If the part has several entries; use its slice.
        """
        part = self._slices[name]
        if part.stop - part.start != 1:
            raise ValueError(f"{name} has {part.stop - part.start} entries; use its slice")
        return int(part.start)

    def slice(self, name: str, last: str | None = None) -> slice:
        """Return the slice of a part, or that from a part to the end of a later one."""
        return slice(self._slices[name].start, self._slices[last or name].stop)

    def start(self, name: str) -> int:
        """Return the index of the first entry of a part."""
        return int(self._slices[name].start)
