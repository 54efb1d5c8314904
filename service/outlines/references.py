"""Number of entities of a DXF drawing after the insertion of its blocks, counted without expanding them.

The count must precede expansion: a drawing of some hundred bytes can nest blocks and insert each a thousand times.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable

from ezdxf.entities.dxfentity import DXFEntity
from ezdxf.entities.insert import Insert

from kinematics.message import compose
from service.outlines.faults import UnsuitableDrawing
from service.outlines.limits import MAX_DEPTH, MAX_ELEMENTS

Shown = Callable[[DXFEntity], bool]


def require_countable(entities: Iterable[DXFEntity], shown: Shown) -> None:
    """Refuse a drawing with too many entities, counting those of blocks at each insertion.

    Parameters
    ----------
    entities : iterable of DXFEntity
        Entities of the model space.
    shown : callable
        Returns whether an entity is visible. The blocks of invisible inserts are not counted.

    Raises
    ------
    UnsuitableDrawing
        If there are more than :data:`~service.outlines.limits.MAX_ELEMENTS` entities, if blocks are nested too deeply,
        or if a block contains itself.
    """
    if _Counter(shown).count(entities, 0) > MAX_ELEMENTS:
        raise UnsuitableDrawing(compose("outlines-too-many-entities", limit=MAX_ELEMENTS))


def grid_of(insert: Insert) -> tuple[int, int]:
    """Return the numbers of rows and columns in which an insert repeats its block."""
    rows, columns = (max(int(insert.dxf.get(name, 1)), 1) for name in ("row_count", "column_count"))
    return rows, columns


class _Counter:
    """Counts entities. The count of each block is computed once, however often the block is inserted."""

    def __init__(self, shown: Shown) -> None:
        self._shown = shown
        self._counts: dict[str, int] = {}
        self._open: set[str] = set()

    def count(self, entities: Iterable[DXFEntity], depth: int) -> int:
        """Return the number of entities, counting those of blocks at each insertion."""
        total = 0
        for entity in entities:
            total += 1
            if isinstance(entity, Insert) and self._shown(entity):
                rows, columns = grid_of(entity)
                # Empty blocks count as one element per copy, because each copy takes time.
                total += rows * columns * max(self._count_block(entity, depth), 1)
        return total

    def _count_block(self, insert: Insert, depth: int) -> int:
        block = insert.block()
        if block is None:
            return 0
        name = str(block.name).lower()
        if name in self._open or depth >= MAX_DEPTH:
            raise UnsuitableDrawing(compose("outlines-blocks-in-blocks", limit=MAX_DEPTH))
        if name not in self._counts:
            self._open.add(name)
            self._counts[name] = self.count(block, depth + 1)
            self._open.remove(name)
        return self._counts[name]
