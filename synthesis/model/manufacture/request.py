"""Models of the block ``manufacture`` of a statement: manufacturing accuracy of a linkage, and its required quality.

See docs/mechanisms/manufacture.md. This module also defines the description of a task that the block needs from each
kind, and the requirements on a design at its targets.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray
from pydantic import ConfigDict, Field

from kinematics.arrays import Real
from kinematics.message import compose
from synthesis.model.dimension import ANGLE, LENGTH
from synthesis.model.problem import Contradiction, Count, Flag, NonNegative, PositiveLength, Sizable, Statement

MAX_SAMPLES = 1_000_000
"""Maximum number of linkages sampled for a yield."""

MAX_STOCK = 20
"""Maximum number of link lengths in stock."""

MAX_DRIVEN = 5_000_000
"""Maximum number of samples times targets of a design: they take a few seconds of one core."""

CONFIDENCE_LEVEL = 0.99
"""Confidence level of the interval of a yield."""


class Rounding(Statement):
    """Grid of a shop: dimensions are whole multiples of these steps."""

    length: PositiveLength = Field(
        description="Step of every link length, and of the position of P along its link and across it."
    )
    coordinates: PositiveLength = Field(
        description="Step of the coordinates of fixed pivots, and of the offset of a slide."
    )


class Stock(Statement):
    """Available links."""

    links: Annotated[list[PositiveLength], Field(min_length=1, max_length=MAX_STOCK)] = Field(
        description="Lengths of available moving links; every moving link of a design has one of these lengths."
    )


class Tolerances(Statement):
    """Maximum errors of dimensions in either direction; all errors are independent."""

    length: Annotated[NonNegative, LENGTH] = Field(
        default=0.0, description="Tolerance of every link length, and of P's position along its link and across it."
    )
    pivot: Annotated[NonNegative, LENGTH] = Field(
        default=0.0, description="Tolerance of each coordinate of a fixed pivot, and of the offset of a slide."
    )
    pin_clearance: Annotated[NonNegative, LENGTH] = Field(
        default=0.0,
        description="Maximum distance of the centre of each pin from that of its hole: half the difference of their "
        "diameters.",
    )

    @property
    def off(self) -> bool:
        """Whether any dimension has a tolerance above 0."""
        return self.length > 0.0 or self.pivot > 0.0


class Quality(Statement):
    """Requirements for a manufactured linkage to be good."""

    model_config = ConfigDict(populate_by_name=True, serialize_by_alias=True)

    max_error: PositiveLength | None = Field(
        default=None, description="Maximum distance of P from each target, or of a slider from its target position."
    )
    max_angle_error: Annotated[float, ANGLE, Field(strict=True, gt=0.0, le=180.0), Sizable] | None = Field(
        default=None, description="Maximum error of the body's or the output's angle at each target, degrees."
    )
    yield_: Annotated[float, Field(strict=True, gt=0.0, lt=1.0)] | None = Field(
        default=None,
        alias="yield",
        description="Required share of good linkages. It counts as satisfied if the lower end of the confidence "
        "interval of the sampled yield reaches it.",
    )


class Exactness(Statement):
    """Manufacturing accuracy of a linkage, and the quality that it must keep (docs/mechanisms/manufacture.md)."""

    tolerances: Tolerances | None = None
    distribution: Literal["uniform", "normal"] = Field(
        default="uniform",
        description="Distribution of every dimension: uniform within its tolerance, or normal with a third of the "
        "tolerance as standard deviation.",
    )
    quality: Quality | None = None
    input: Literal["adjusted", "fixed"] | None = Field(
        default=None,
        description="adjusted: at each target the input is set so that the linkage comes nearest; fixed: the input is "
        "that of the exact design. By default adjusted, but fixed if the task gives inputs.",
    )
    samples: Annotated[Count, Field(ge=100, le=MAX_SAMPLES)] = Field(
        default=100_000, description="Number of random linkages that are sampled for the yield of a design."
    )
    seed: Annotated[Count, Field(ge=0, le=2**53 - 1)] | None = Field(
        default=None, description="Seed of the random samples; by default that of the problem."
    )

    @property
    def is_sampled(self) -> bool:
        """Whether a yield is sampled: some dimension has a tolerance, and a quality is required."""
        return self.tolerances is not None and self.tolerances.off and self.quality is not None

    @property
    def is_gridded(self) -> bool:
        """Whether linkages are searched on a grid or from a stock."""
        return False

    def find_task_errors(self, task: ManufactureTask) -> list[Contradiction]:
        """Return fields that do not suit the task or exceed a limit, with paths below the block."""
        listed = []
        tolerances = self.tolerances
        if tolerances is not None and not tolerances.off and tolerances.pin_clearance == 0.0:
            listed.append(Contradiction("/tolerances", compose("model-tolerances-zero")))
        judged = self.quality is not None and (not self.is_gridded or self.quality.yield_ is not None)
        if tolerances is not None and tolerances.pin_clearance > 0.0 and not tolerances.off and judged:
            detail = compose("model-quality-needs-dimension-tolerances")
            listed.append(Contradiction("/tolerances", detail))
        if self.input == "adjusted" and not task.free_inputs:
            listed.append(Contradiction("/input", compose("model-inputs-given-by-task")))
        quality = self.quality
        if quality is not None and quality.max_error is None and quality.max_angle_error is None:
            detail = compose("model-quality-empty")
            listed.append(Contradiction("/quality", detail))
        if quality is not None and quality.max_error is not None and not task.distances:
            detail = compose("model-quality-only-angles")
            listed.append(Contradiction("/quality/max_error", detail))
        if quality is not None and quality.max_angle_error is not None and not task.angles:
            detail = compose("model-quality-without-angles")
            listed.append(Contradiction("/quality/max_angle_error", detail))
        if self.is_sampled and self.samples * task.targets > MAX_DRIVEN:
            most = MAX_DRIVEN // task.targets
            detail = compose("model-too-many-samples", targets=task.targets, samples=most)
            listed.append(Contradiction("/samples", detail))
        return listed


class Manufacture(Exactness):
    """Manufacture of a linkage, and the quality that it must keep (docs/mechanisms/manufacture.md)."""

    round: Rounding | None = Field(
        default=None, description="Replace each design by the best linkage on this grid near it."
    )
    stock: Stock | None = Field(
        default=None, description="Replace each design by the best linkage near it that uses these links."
    )
    widest: Flag = Field(
        default=False,
        description="Find the widest tolerances that still give each design the required yield, the cheapest first.",
    )

    @property
    def required_yield(self) -> float | None:
        """Required yield; None if none is required."""
        return None if self.quality is None else self.quality.yield_

    @property
    def is_gridded(self) -> bool:
        """Whether designs are searched on a grid or from a stock."""
        return self.round is not None or self.stock is not None

    def find_errors(self, task: ManufactureTask) -> list[Contradiction]:
        """Return errors that the validation of single fields cannot find, with paths below the block."""
        listed = [*self._validate_blocks(), *self.find_task_errors(task)]
        if self.is_gridded and task.ungridded:
            listed.append(Contradiction("/round" if self.round is not None else "/stock", task.ungridded))
        wanted = self.required_yield
        if self.widest and (wanted is None or not self.is_sampled):
            detail = compose("model-widest-needs-yield")
            listed.append(Contradiction("/widest", detail))
        if wanted is not None and self.samples < (needed := count_required_samples(wanted)):
            listed.append(
                Contradiction("/samples", compose("model-yield-needs-samples", share=f"{wanted:g}", samples=needed))
            )
        return listed

    def _validate_blocks(self) -> list[Contradiction]:
        """Return errors of a block that is empty, or that lacks fields that its other fields need."""
        if self.tolerances is not None or (self.is_gridded and self.required_yield is None):
            return []
        if self.is_gridded:
            return [Contradiction("/tolerances", compose("model-yield-needs-tolerances"))]
        if self.quality is None:
            return [Contradiction("", compose("model-manufacture-empty"))]
        return [Contradiction("/tolerances", compose("model-quality-needs-tolerances"))]


def list_fixed_coordinates(
    fixed: tuple[tuple[float | None, float | None] | None, tuple[float | None, float | None] | None],
) -> frozenset[str]:
    """Return the names of the coordinates of fixed pivots that are given, as dimensions of all types of mechanisms."""
    named = ("fixed_pivots.input", "fixed_pivot"), ("fixed_pivots.output",)
    return frozenset(
        f"{name}.{axis}"
        for names, pivot in zip(named, fixed, strict=True)
        for name in names
        for axis, value in zip("xy", pivot or (None, None), strict=True)
        if value is not None
    )


def count_required_samples(demanded: float) -> int:
    """Return the number of samples that prove a yield if all of them are good."""
    # The interval is two-sided: n good samples of n prove the yield y if yⁿ ≤ (1 − confidence)/2.
    return math.ceil(math.log(0.5 * (1.0 - CONFIDENCE_LEVEL)) / math.log(demanded))


class ManufactureTask(NamedTuple):
    """Description of a task for the block ``manufacture``.

    Attributes
    ----------
    distances, angles : bool
        Whether the targets have positions, and whether they have angles.
    free_inputs : bool
        Whether the inputs at the targets are free.
    targets : int
        Number of targets.
    ungridded : str
        Reason why no linkage on a grid can satisfy the statement; empty if one can.
    """

    distances: bool
    angles: bool
    free_inputs: bool
    targets: int
    ungridded: str = ""


@dataclass(frozen=True, eq=False)
class RequiredTargets:
    """Requirements on a design at its t targets, and its inputs there.

    Attributes
    ----------
    inputs : float, shape (t,)
        Input angles, radians, continuous along the motion.
    points : complex, shape (t,), or None
        Required positions of P.
    angles : float, shape (t,), or None
        Required absolute angles, radians: of the body if there are points, otherwise of the output.
    travels : float, shape (t,), or None
        Required positions of a slider along its line, from the foot of the fixed pivot.
    body : float
        Absolute angle of the body in the reference configuration, radians.
    free : bool
        Whether the inputs are free.
    limits : float, shape (t, 3), or None
        Tolerances of the task itself in x, y and angle (radians): 0 for exact, infinite for unlimited.
    around : bool
        Whether the limit in x is a limit of the distance in any direction.
    size : float
        Length that is equivalent to one radian when errors of both are added.
    on_ground : pair of bool
        Whether the angles of input and output are counted from the ground line, and rotate with it on a grid.
    kept : set of str
        Names of the dimensions given by the task, which a grid leaves unchanged.
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
