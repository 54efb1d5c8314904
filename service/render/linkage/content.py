"""Content that a kind of problem adds to the sheet of a linkage: the picture, its own tables, metrics and diagrams."""

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
    """A drawing of a linkage that determines its own height."""

    @property
    def box(self) -> Box:
        """Box of the drawing, in the linkage's coordinates."""

    @property
    def wide(self) -> bool:
        """Whether the drawing takes the full width, with the tables below it."""

    def draw(self, width: float) -> tuple[list[Element], float]:
        """Draw the parts at the left border below the title, in a width in pixels; return them and the y below them."""


@dataclass(frozen=True)
class Content:
    """All parts of a sheet that depend on the kind.

    Parameters
    ----------
    name : str
        Name of the mechanism.
    words : str
        The name with its particulars, for the subtitle.
    described : str
        Description of the picture for readers who cannot see it.
    picture : Picture
    tables : sequence of Block
        Blocks between dimensions and checks: targets, limits, dwells, the line.
    left_out : set of str
        Fields of the metrics that the words already contain, or that do not apply to this kind.
    titles : mapping of str to str
        Titles of metrics whose field names are too terse.
    standing : str
        Description of the reference configuration.
    more_dimensions : sequence of (str, str)
        Additional rows between the links and the joints.
    hidden : set of str
        Joints that are not listed for this kind.
    dimensions : Block, optional
        Replacement for the standard block of dimensions.
    diagrams : sequence of Diagram
        Diagrams below the picture.
    marks : sequence of float
        Angles marked in the diagrams, degrees.
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
