"""The block ``manufacture`` of a statement: how exactly a shop makes a linkage, and what it must then still do.

See docs/manufacture.md. What a kind says of its task to it, and what a design is held to at its targets, are here too.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray
from pydantic import ConfigDict, Field

from synthesis.model.dimension import ANGLE, LENGTH
from synthesis.model.statement import Contradiction, Count, Flag, NonNegative, PositiveLength, Sizable, Statement

Real = NDArray[np.float64]

MOST_SAMPLES = 1_000_000

MOST_STOCK = 20
"""Lengths of links that may be in stock."""

MOST_DRIVEN = 5_000_000
"""Samples of a design times its targets: some seconds of one core."""

CONFIDENCE = 0.99
"""Of the interval of a yield."""


class Rounding(Statement):
    """The grid of a shop: dimensions are whole multiples of these."""

    length: PositiveLength = Field(description="Of every link, and of P's place on its link, along it and across.")
    coordinates: PositiveLength = Field(description="Of fixed pivots, and of the offset of a slide.")


class Stock(Statement):
    """Links that there are."""

    links: Annotated[list[PositiveLength], Field(min_length=1, max_length=MOST_STOCK)] = Field(
        description="Lengths of moving links; every link of a design has one of them."
    )


class Tolerances(Statement):
    """How far dimensions may be off, either way; each of them independently of all others."""

    length: Annotated[NonNegative, LENGTH] = Field(
        default=0.0, description="Of every link, and of P's place on its link, along it and across."
    )
    pivot: Annotated[NonNegative, LENGTH] = Field(
        default=0.0, description="Of each coordinate of a fixed pivot, and of the offset of a slide."
    )
    pin_clearance: Annotated[NonNegative, LENGTH] = Field(
        default=0.0,
        description="How far the centre of each pin may lie from that of its hole: half of their diameters' "
        "difference.",
    )

    @property
    def off(self) -> bool:
        """Whether any dimension is off."""
        return self.length > 0.0 or self.pivot > 0.0


class Quality(Statement):
    """What a linkage must still do as it is made, to be good."""

    model_config = ConfigDict(populate_by_name=True, serialize_by_alias=True)

    max_error: PositiveLength | None = Field(
        default=None, description="Greatest distance of P from each target, or of a slider from its place."
    )
    max_angle_error: Annotated[float, ANGLE, Field(strict=True, gt=0.0, le=180.0), Sizable] | None = Field(
        default=None, description="Greatest difference of the body's angle, or the output's, at each target, degrees."
    )
    yield_: Annotated[float, Field(strict=True, gt=0.0, lt=1.0)] | None = Field(
        default=None,
        alias="yield",
        description="Share of the linkages made that must be good: a demand. It counts as kept where the lower end of "
        "the interval of the sampled yield reaches it.",
    )


class Exactness(Statement):
    """How exactly a linkage is made, and what it must then still do (docs/manufacture.md)."""

    tolerances: Tolerances | None = None
    distribution: Literal["uniform", "normal"] = Field(
        default="uniform",
        description="Of every dimension: evenly within its tolerance, or normal with a third of the tolerance as its "
        "standard deviation.",
    )
    quality: Quality | None = None
    input: Literal["adjusted", "fixed"] | None = Field(
        default=None,
        description="adjusted: the input is set to where the linkage comes nearest to each target; fixed: it stands "
        "as drawn. Left out: adjusted, and fixed where the task states inputs.",
    )
    samples: Annotated[Count, Field(ge=100, le=MOST_SAMPLES)] = Field(
        default=100_000, description="Linkages that are drawn by chance for the yield of a design."
    )
    seed: Annotated[Count, Field(ge=0, le=2**53 - 1)] | None = Field(
        default=None, description="Of what is drawn by chance; left out, that of the problem."
    )

    @property
    def sampled(self) -> bool:
        """Whether there is a yield: some dimension is off, and something is to be kept."""
        return self.tolerances is not None and self.tolerances.off and self.quality is not None

    @property
    def gridded(self) -> bool:
        """Whether linkages are looked for on a grid, or of a stock."""
        return False

    def faults_beside(self, task: Made) -> list[Contradiction]:
        """What is stated and the task does not have, or too much of it, with paths below the block."""
        listed = []
        tolerances = self.tolerances
        if tolerances is not None and not tolerances.off and tolerances.pin_clearance == 0.0:
            listed.append(Contradiction("/tolerances", "nothing is off: state one above 0"))
        judged = self.quality is not None and (not self.gridded or self.quality.yield_ is not None)
        if tolerances is not None and tolerances.pin_clearance > 0.0 and not tolerances.off and judged:
            detail = "a quality is kept or not by how far dimensions are off: state length or pivot"
            listed.append(Contradiction("/tolerances", detail))
        if self.input == "adjusted" and not task.free_inputs:
            listed.append(Contradiction("/input", "the task states the inputs at its targets; leave it out, or fixed"))
        quality = self.quality
        if quality is not None and quality.max_error is None and quality.max_angle_error is None:
            detail = "says not when a linkage is good; state max_error or max_angle_error"
            listed.append(Contradiction("/quality", detail))
        if quality is not None and quality.max_error is not None and not task.distances:
            detail = "the task asks for angles alone; state max_angle_error"
            listed.append(Contradiction("/quality/max_error", detail))
        if quality is not None and quality.max_angle_error is not None and not task.angles:
            detail = "the task asks for no angles; state max_error"
            listed.append(Contradiction("/quality/max_angle_error", detail))
        if self.sampled and self.samples * task.targets > MOST_DRIVEN:
            most = MOST_DRIVEN // task.targets
            detail = f"for {task.targets} targets are too many; state {most} at most"
            listed.append(Contradiction("/samples", detail))
        return listed


class Manufacture(Exactness):
    """How a linkage is made, and what is asked of it as it is made (docs/manufacture.md)."""

    round: Rounding | None = Field(
        default=None, description="Find the best linkage on this grid beside each design; it is what is answered."
    )
    stock: Stock | None = Field(default=None, description="Find the best linkage of these links beside each design.")
    widest: Flag = Field(
        default=False,
        description="Find the widest tolerances that still give the demanded yield to each design, the cheapest first.",
    )

    @property
    def demanded_yield(self) -> float | None:
        """The yield that designs are held to."""
        return None if self.quality is None else self.quality.yield_

    @property
    def gridded(self) -> bool:
        """Whether designs are looked for on a grid, or of a stock."""
        return self.round is not None or self.stock is not None

    def faults(self, task: Made) -> list[Contradiction]:
        """What no single field shows, with paths below the block."""
        listed = [*self._missing(), *self.faults_beside(task)]
        if self.gridded and task.ungridded:
            listed.append(Contradiction("/round" if self.round is not None else "/stock", task.ungridded))
        wanted = self.demanded_yield
        if self.widest and (wanted is None or not self.sampled):
            detail = "asks for what still gives a yield; state tolerances of dimensions, and quality.yield"
            listed.append(Contradiction("/widest", detail))
        if wanted is not None and self.samples < (needed := needed_samples(wanted)):
            listed.append(Contradiction("/samples", f"cannot show a yield of {wanted:g}; {needed} or more can"))
        return listed

    def _missing(self) -> list[Contradiction]:
        """Blocks that say nothing, or ask what cannot be told."""
        if self.tolerances is not None or (self.gridded and self.demanded_yield is None):
            return []
        if self.gridded:
            return [Contradiction("/tolerances", "missing: what is made exactly has no yield")]
        if self.quality is None:
            return [Contradiction("", "says nothing of how it is made; state tolerances, round or stock")]
        return [Contradiction("/tolerances", "missing: a quality is kept or not by how exactly a linkage is made")]


def kept_pivots(
    fixed: tuple[tuple[float | None, float | None] | None, tuple[float | None, float | None] | None],
) -> frozenset[str]:
    """Names of the coordinates that are stated of the fixed pivots of input and output, of any type of mechanism."""
    named = ("fixed_pivots.input", "fixed_pivot"), ("fixed_pivots.output",)
    return frozenset(
        f"{name}.{axis}"
        for names, pivot in zip(named, fixed, strict=True)
        for name in names
        for axis, value in zip("xy", pivot or (None, None), strict=True)
        if value is not None
    )


def needed_samples(demanded: float) -> int:
    """Samples of which, if all are good, a yield is shown."""
    return math.ceil(math.log(0.5 * (1.0 - CONFIDENCE)) / math.log(demanded))


class Made(NamedTuple):
    """What a kind says of its task to the block: what is demanded at its targets, and how many there are.

    Attributes
    ----------
    distances, angles : bool
        Whether places, and whether angles, are demanded.
    free_inputs : bool
        Whether the inputs at the targets are free.
    targets : int
        Their number.
    ungridded : str
        Why no linkage on a grid can keep what is stated; empty where one can.
    """

    distances: bool
    angles: bool
    free_inputs: bool
    targets: int
    ungridded: str = ""


@dataclass(frozen=True, eq=False)
class Held:
    """What a design is held to at its t targets, and the inputs at which it stands there.

    Attributes
    ----------
    inputs : float, shape (t,)
        Radians, in one run.
    points : complex, shape (t,), or None
        Demanded places of P.
    angles : float, shape (t,), or None
        Demanded absolute angles of the body where there are points, else of the output, radians.
    travels : float, shape (t,), or None
        Demanded places of a slider along its line, from the foot of the fixed pivot.
    body : float
        Absolute angle of the body where the linkage stands in its reference, radians.
    free : bool
        Whether the inputs are free.
    limits : float, shape (t, 3), or None
        How far the design may be off in x, y and angle (radians) by the task's own tolerances; 0 and infinite where
        there is none.
    around : bool
        Whether the limit in x is one of the distance, in any direction.
    size : float
        The length that counts as much as a radian where errors of both are added.
    on_ground : pair of bool
        Whether input, and output, are counted from the ground line, and turn with it on a grid.
    kept : set of str
        Names of the dimensions that are stated, and stay as they are on a grid.
    """

    inputs: Real
    points: NDArray[np.complex128] | None = None
    angles: Real | None = None
    travels: Real | None = None
    body: float = 0.0
    free: bool = True
    limits: Real | None = None
    around: bool = False
    size: float = 1.0
    on_ground: tuple[bool, bool] = (False, False)
    kept: frozenset[str] = frozenset()
