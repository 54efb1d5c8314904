"""The task of one linkage, and variants of the linkage driven to the targets of that task."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from kinematics.arrays import Complex, Integers, Real
from kinematics.errors import ShapeError
from kinematics.linkage.variation import kernels, loops

Sort = Literal["poses", "points", "outputs"]

_SORT_CODES: dict[Sort, int] = {"poses": loops.POSES, "points": loops.POINTS, "outputs": loops.OUTPUTS}


@dataclass(frozen=True, eq=False)
class Task:
    """The t targets of a fourbar or a slider-crank, and how it is driven to each of them.

    Attributes
    ----------
    sort : {"poses", "points", "outputs"}
        Poses of the coupler's body, positions of P, or positions of the output at given inputs.
    assemblies : int, shape (t,)
        Assembly signs as for :func:`kinematics.linkage.positions`.
    inputs : float, shape (t,)
        Nominal inputs, radians, continuous.
    slide_angle : float or None
        Direction of a slider-crank's slide, radians; None for a fourbar.
    points : complex, shape (t,), or None
        Required positions of P, for poses and points.
    angles : float, shape (t,), or None
        Absolute angles, radians: of the line A → B for poses, of O4 → B for outputs of a fourbar.
    travels : float, shape (t,), or None
        Outputs of a slider: its positions along the slide, from ``origin``.
    origin : complex
        Point from which travels are counted.
    used : pair of float or None
        Range of inputs over which the linkage must stay on its branch; its ends move with the inputs at the targets.
        None without such a constraint.
    adjusted : bool
        Whether the input of a variant is adjusted from the nominal one to come closest to each target. Outputs are
        always evaluated at the nominal input.
    units : pair of float
        Units of distance, and of angle in radians, for the comparison of misses; infinite: ignored.
    greatest : bool
        Whether the closest input minimizes the larger of distance and angle, or else the sum of their squares.
    on_ground : pair of bool
        Whether the angles of input and output are counted from the ground line, so that they rotate with it.
    ground_angle : float
        Nominal direction of the ground line, radians.
    """

    sort: Sort
    assemblies: Integers
    inputs: Real
    slide_angle: float | None = None
    points: Complex | None = None
    angles: Real | None = None
    travels: Real | None = None
    origin: complex = 0j
    used: tuple[float, float] | None = None
    adjusted: bool = True
    units: tuple[float, float] = (1.0, 1.0)
    greatest: bool = True
    on_ground: tuple[bool, bool] = (False, False)
    ground_angle: float = 0.0

    @property
    def slides(self) -> bool:
        """Whether the linkage is a slider-crank."""
        return self.slide_angle is not None

    @property
    def slide_direction(self) -> complex:
        """Unit vector along the slide; 1 for a fourbar."""
        angle = self.slide_angle or 0.0
        return complex(math.cos(angle), math.sin(angle))

    @property
    def guides(self) -> bool:
        """Whether there is a point P."""
        return self.sort != "outputs"

    @property
    def dimensions(self) -> int:
        """Number of dimensions of a variant."""
        return (5 if self.slides else 7) + 2 * self.guides

    @cached_property
    def rows(self) -> Real:
        """Targets in the kernels' layout, shape (t, 7)."""
        count = len(self.inputs)
        rows = np.zeros((count, 7))
        rows[:, 0], rows[:, 1] = np.cos(self.inputs), np.sin(self.inputs)
        if self.travels is not None:
            rows[:, 2] = self.travels + (self.origin * self.slide_direction.conjugate()).real
        elif self.points is not None:
            rows[:, 2], rows[:, 3] = self.points.real, self.points.imag
        if self.angles is not None:
            rows[:, 4], rows[:, 5] = np.cos(self.angles), np.sin(self.angles)
        rows[:, 6] = self.assemblies
        return rows

    @property
    def margins(self) -> Real:
        """Extension of the range beyond the smallest and largest input of a target; NaN without a range."""
        if self.used is None:
            return np.full(2, np.nan)
        low, high = sorted(self.used)
        # A range inside the targets adds nothing beyond them.
        return np.maximum([self.inputs.min() - low, high - self.inputs.max()], 0.0)

    def variants(self, dimensions: ArrayLike) -> Real:
        """Return rows of dimensions in the kernels' layout.

        Raises
        ------
        ShapeError
            For rows of another length.
        """
        rows = np.ascontiguousarray(dimensions, np.float64)
        if rows.ndim != 2 or rows.shape[1] != self.dimensions:
            raise ShapeError(variants=rows.shape, task=(len(self.inputs), self.dimensions))
        return rows

    @property
    def drive(self) -> loops.Drive:
        """Settings of the kernels that drive variants."""
        before, after = self.margins
        return loops.Drive(
            _SORT_CODES[self.sort],
            self.slides,
            self.slide_direction.real,
            self.slide_direction.imag,
            self.adjusted,
            self.greatest,
            1.0 / self.units[0],
            1.0 / self.units[1],
            float(before),
            float(after),
        )

    @property
    def _with_ground(self) -> Real:
        """Change of the settings, in the kernels' layout, per radian of rotation of the ground line."""
        return np.array([1.0, -1.0]) * self.on_ground

    def build_settings(self, rows: Real, given: ArrayLike | None = None) -> Real:
        """Build the settings of each variant in the kernels' layout, shape (v, 2), or (0, 2) without settings.

        Raises
        ------
        ShapeError
            For settings of another number of variants.
        """
        if given is None and (self.slides or not any(self.on_ground)):
            return np.empty((0, 2))
        settings = np.zeros((len(rows), 2))
        if given is not None:
            if np.shape(given) != settings.shape:
                raise ShapeError(settings=np.shape(given), variants=rows.shape)
            settings += np.asarray(given, np.float64)
            # A dial turned forward lowers the output that is read.
            settings[:, 1] *= 1.0 if self.guides else -1.0
        if not self.slides:
            ground = (rows[:, 2] - rows[:, 0]) + 1j * (rows[:, 3] - rows[:, 1])
            settings += np.angle(ground * np.exp(-1j * self.ground_angle))[:, None] * self._with_ground
        return settings


class Deviations(NamedTuple):
    """Variants at targets; NaN where a variant cannot be assembled, all NaN if it leaves its branch.

    Attributes
    ----------
    distances, angles : float, shape (v, t)
        Lengths and radians, at least zero; zero for quantities that the task does not have.
    offsets : float, shape (v, t, 3)
        x, y and angle minus the target; for the output of a slider x is its travel.
    inputs : float, shape (v, t)
        Radians.
    """

    distances: Real
    angles: Real
    offsets: Real
    inputs: Real


def measure_deviations(task: Task, variants: ArrayLike, settings: ArrayLike | None = None) -> Deviations:
    """Measure variants of a linkage driven to all of its targets.

    Parameters
    ----------
    task : Task
        The targets.
    variants : float, shape (v, n)
        Dimensions. Fourbar: O2 (x, y), O4 (x, y), input, coupler, output, and P along A → B and to its left.
        Slider-crank: O2 (x, y), the offset (distance of O2 to the left of the slide), crank, coupler, and P. A task of
        outputs has no P.
    settings : float, shape (v, 2), optional
        Error of the input's setting, radians; and additional rotation of the body on its link, radians, or shift of
        the output's dial, radians or length units.

    Raises
    ------
    ShapeError
        For another number of dimensions, or of settings.
    """
    rows = task.variants(variants)
    shape = len(rows), len(task.inputs)
    offsets, inputs = np.empty((*shape, 3)), np.empty(shape)
    kernels.measure_deviations(
        task.drive, rows, task.rows, task.inputs, task.build_settings(rows, settings), offsets, inputs
    )
    return Deviations(np.hypot(offsets[..., 0], offsets[..., 1]), np.abs(offsets[..., 2]), offsets, inputs)


def measure_shares(task: Task, variants: ArrayLike, settings: ArrayLike | None = None) -> Real:
    """Measure the largest share of its limit that each variant uses at any target: at most 1 if it satisfies all.

    The units of the task are the limits, and the input minimizes the larger share.

    Returns
    -------
    float, shape (v,)
        Infinite where a variant cannot be assembled or leaves its branch. A value above 1 is the first violation, not
        the largest.
    """
    rows = task.variants(variants)
    share = np.empty(len(rows))
    kernels.measure_shares(task.drive, rows, task.rows, task.inputs, task.build_settings(rows, settings), share)
    return share


def measure_squares(task: Task, variants: ArrayLike, most: float = math.inf, settings: ArrayLike | None = None) -> Real:
    """Measure the sum over the targets of the squared misses of each variant, in the units of the task.

    Parameters
    ----------
    task : Task
        The targets; its ``greatest`` selects the objective of an adjusted input.
    variants, settings
        As for :func:`measure_deviations`.
    most : float
        Limit above which a sum is not completed.

    Returns
    -------
    float, shape (v,)
        Infinite above ``most``, and where a variant cannot be assembled or leaves its branch.
    """
    rows = task.variants(variants)
    square = np.empty(len(rows))
    kernels.measure_squares(task.drive, rows, task.rows, task.inputs, task.build_settings(rows, settings), most, square)
    return square
