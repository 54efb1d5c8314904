"""What a kind of problem brings to the sheet of a linkage: the picture, its own tables, metrics and diagrams."""

from __future__ import annotations

from collections.abc import Mapping, Sequence, Set
from dataclasses import dataclass, field
from typing import Protocol

from service.render.page.blocks import Block
from service.render.page.diagrams import Diagram
from service.render.page.svg import Box, Element

Rows = Sequence[tuple[str, str]]
"""Names and values."""


class Picture(Protocol):
    """A drawing of a linkage that knows how high it must be."""

    @property
    def box(self) -> Box:
        """What it shows, in the linkage's coordinates."""

    @property
    def wide(self) -> bool:
        """Whether it takes the whole width, with the tables below it."""

    def draw(self, width: float) -> tuple[list[Element], float]:
        """Its parts at the left border below the title, in a width in pixels, and the y below them."""


@dataclass(frozen=True)
class Content:
    """All of a sheet that depends on the kind.

    Parameters
    ----------
    name : str
        What the mechanism is called.
    words : str
        The same and what it is in particular, for the line below the title.
    described : str
        What the picture shows, for a reader who does not see it.
    picture : Picture
    tables : sequence of Block
        Between dimensions and checks: targets, limits, dwells, the line.
    left_out : set of str
        Fields of the metrics that the words have already, or that mean nothing to this kind.
    titles : mapping of str to str
        What fields of the metrics are called where their own names do not say enough.
    standing : str
        Where the linkage stands in its reference configuration.
    more_dimensions : sequence of (str, str)
        Rows between the links and the joints.
    hidden : set of str
        Joints that mean nothing to this kind.
    dimensions : Block, optional
        In place of the usual block.
    diagrams : sequence of Diagram
        Below the picture.
    marks : sequence of float
        Angles that the diagrams mark, degrees.
    """

    name: str
    words: str
    described: str
    picture: Picture
    tables: Sequence[Block] = ()
    left_out: Set[str] = frozenset()
    titles: Mapping[str, str] = field(default_factory=dict)
    standing: str = "at the first target"
    more_dimensions: Rows = ()
    hidden: Set[str] = frozenset()
    dimensions: Block | None = None
    diagrams: Sequence[Diagram] = ()
    marks: Sequence[float] = ()
