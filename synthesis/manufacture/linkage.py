"""Dimensions and requirements of a finished fourbar or slider-crank, in the form of the compiled variation code."""

from __future__ import annotations

import cmath
import dataclasses
import math
from dataclasses import dataclass
from functools import cached_property
from typing import Self

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel

from kinematics.arrays import Real
from kinematics.linkage.variation import Task, measure_deviations
from kinematics.linkage.variation.variants import Sort
from kinematics.message import compose
from synthesis.model.manufacture.request import Exactness, Quality, RequiredTargets

NAMES = {
    "fourbar": (
        "fixed_pivots.input.x",
        "fixed_pivots.input.y",
        "fixed_pivots.output.x",
        "fixed_pivots.output.y",
        "links.input",
        "links.coupler",
        "links.output",
    ),
    "slider_crank": ("fixed_pivot.x", "fixed_pivot.y", "offset", "links.crank", "links.coupler"),
}
"""Names of the dimensions by type of mechanism, in the order of :mod:`kinematics.linkage.variation`, without P's."""

POINT_DIMENSIONS = ("coupler_point.along", "coupler_point.across")

LIMIT_SLACK = 1e-9
"""Relative slack of a limit, for rounding."""

OPPOSITE_SHARE = 0.5
"""Share of the linkage's error at a target: if the opposite assembly has a smaller error than this share, it is assumed
to be the intended assembly at that target."""


@dataclass(frozen=True, eq=False)
class Linkage:
    """A linkage by its dimensions.

    Attributes
    ----------
    type : str
        ``fourbar`` or ``slider_crank``.
    row : float, shape (n,)
        Dimensions, those of P last, in the order of :func:`kinematics.linkage.variation.measure_deviations`.
    sign : int
        Assembly: +1 for open, −1 for crossed.
    slide_angle : float or None
        Direction of the slide, radians; None for a fourbar.
    foot : complex
        Foot of the fixed pivot on the slide's line, from which positions of the slider are counted.
    reference : float
        Input angle in the reference configuration, radians.
    """

    type: str
    row: Real
    sign: int
    slide_angle: float | None
    foot: complex
    reference: float

    def list_names(self, *, guides: bool) -> list[str]:
        """Return the names of the dimensions; those of P only if it is guided."""
        return [*NAMES[self.type], *(POINT_DIMENSIONS if guides else ())]

    def mark_pivots(self, *, guides: bool) -> NDArray[np.bool_]:
        """Return a mask of the dimensions that are coordinates of fixed pivots or the offset of a slide.

        All other dimensions are lengths.
        """
        named = self.list_names(guides=guides)
        return np.array([name.startswith("fixed_pivot") or name == "offset" for name in named])


def extract_linkage(mechanism: BaseModel) -> Linkage | None:
    """Extract the dimensions of the mechanism of an answer or a request; None for an unsupported type.

    Parameters
    ----------
    mechanism : a model of a mechanism
        Its fields ``fixed_pivots`` or ``fixed_pivot``, ``links``, ``slide``, ``coupler_point``, ``assembly`` and
        ``reference_input_angle`` are used; its skeleton is ignored.
    """
    stated = mechanism.model_dump(exclude={"skeleton"})
    # A linkage given by its skeleton alone has no assembly and no named dimensions. A driving slider is not supported.
    if stated["type"] not in NAMES or "assembly" not in stated or stated.get("driven_by") == "slider":
        return None
    point = stated["coupler_point"]
    on_link = cmath.rect(point["distance"], math.radians(point["angle"]))
    links, sign = stated["links"], 1 if stated["assembly"] == "open" else -1
    reference = math.radians(stated.get("reference_input_angle") or 0.0)
    if stated["type"] == "fourbar":
        pivots = stated["fixed_pivots"]
        row = [*pivots["input"], *pivots["output"], links["input"], links["coupler"], links["output"]]
        return Linkage("fourbar", np.array([*row, on_link.real, on_link.imag]), sign, None, 0j, reference)
    pivot, line = complex(*stated["fixed_pivot"]), complex(*stated["slide"]["point"])
    angle = math.radians(stated["slide"]["angle"])
    along = cmath.exp(1j * angle)
    # Resolve the vector from the line's point to the pivot along the slide (the foot) and across it (the offset).
    between = (pivot - line) * along.conjugate()
    row = [pivot.real, pivot.imag, between.imag, links["crank"], links["coupler"]]
    foot = line + along * between.real
    return Linkage("slider_crank", np.array([*row, on_link.real, on_link.imag]), sign, angle, foot, reference)


@dataclass(frozen=True, eq=False)
class ManufacturedLinkage:
    """A linkage with its targets, for the evaluation of manufactured variants.

    Attributes
    ----------
    linkage : Linkage
        The nominal linkage, as drawn.
    task : Task
        Targets of the linkage. A target for which the task itself gives a tolerance is replaced by the place that the
        nominal linkage reaches.
    own : float, shape (t, 3)
        Offset of that place from the requested one in x, y and angle; 0 without such a tolerance.
    limits : float, shape (t, 3)
        Tolerances given by the task itself, in x, y and angle (radians); infinite if there is none.
    around : bool
        Whether the tolerance in x limits the distance in any direction.
    """

    linkage: Linkage
    task: Task
    own: Real
    limits: Real
    around: bool

    @cached_property
    def nominal_dimensions(self) -> Real:
        """Nominal dimensions, shape (n,)."""
        return self.linkage.row[: self.task.dimensions]

    @property
    def list_names(self) -> list[str]:
        """Names of the dimensions."""
        return self.linkage.list_names(guides=self.task.guides)

    @property
    def has_own_tolerances(self) -> bool:
        """Whether the task itself gives tolerances for targets."""
        return bool(np.isfinite(self.limits).any())

    def select_target(self, index: int) -> Self:
        """Return the same linkage with one of its targets."""
        one = slice(index, index + 1)
        task = dataclasses.replace(
            self.task,
            assemblies=self.task.assemblies[one],
            inputs=self.task.inputs[one],
            points=None if self.task.points is None else self.task.points[one],
            angles=None if self.task.angles is None else self.task.angles[one],
            travels=None if self.task.travels is None else self.task.travels[one],
        )
        return dataclasses.replace(self, task=task, own=self.own[one], limits=self.limits[one])

    def mark_within_own_tolerances(self, offsets: Real) -> NDArray[np.bool_]:
        """Return a mask, shape (v,), of the variants that satisfy the tolerances given by the task itself.

        ``offsets`` are the offsets of the variants from the targets of :attr:`task`, shape (v, t, 3).
        """
        off = np.abs(offsets + self.own)
        # If the tolerance limits the distance, compare the distance instead of both coordinates.
        if self.around:
            off[..., 0] = off[..., 1] = np.hypot(off[..., 0], off[..., 1])
        return np.asarray((off <= self.limits * (1.0 + LIMIT_SLACK)).all(axis=(1, 2)))


def build_task(linkage: Linkage, held: RequiredTargets, units: tuple[float, float]) -> Task | str:
    """Build the task from a linkage's requirements, with the nominal inputs; return a message if this is impossible."""
    sort: Sort = "outputs" if held.points is None else "points" if held.angles is None else "poses"
    task = Task(
        sort,
        np.full(len(held.inputs), linkage.sign, np.int64),
        held.inputs,
        slide_angle=linkage.slide_angle,
        points=held.points,
        angles=held.angles,
        travels=held.travels,
        origin=linkage.foot,
        adjusted=False,
        units=units,
    )
    if sort == "poses":
        angles = _convert_coupler_angles(linkage, task, held)
        if angles is None:
            return compose("manufacture-not-assembled-at-reference")
        task = dataclasses.replace(task, angles=angles)
    return task


def find_target_inputs(
    linkage: Linkage, held: RequiredTargets, units: tuple[float, float], used: tuple[float, float] | None
) -> tuple[Task, Real] | str:
    """Return the task of a linkage, and its errors at the targets, shape (t, 3).

    Return a message if the linkage cannot be assembled at every target. ``used`` is the range of the input, radians, on
    which it must stay on its branch.
    """
    task = build_task(linkage, held, units)
    if isinstance(task, str):
        return task
    row = linkage.row[: task.dimensions]
    # Without a used range, each target may be met in either assembly.
    if used is None:
        task = dataclasses.replace(task, assemblies=_choose_assemblies(task, row))
    offsets = measure_deviations(task, row[None]).offsets[0]
    if not np.isfinite(offsets).all():
        return compose("manufacture-not-assembled-at-targets")
    return dataclasses.replace(task, used=used), offsets


def build_product(
    linkage: Linkage, held: RequiredTargets, block: Exactness, used: tuple[float, float] | None
) -> ManufacturedLinkage | str:
    """Build the description of a linkage for manufacture; return a message if this is impossible.

    Parameters
    ----------
    linkage : Linkage
        The nominal linkage, as drawn.
    held : RequiredTargets
        Requirements on the linkage at its targets.
    block : Exactness
        The block of the request.
    used : pair of float or None
        Range of the input, radians, on which the linkage must stay on its branch; None without this requirement.
    """
    found = find_target_inputs(linkage, held, _choose_units(block, held), used)
    if isinstance(found, str):
        return found
    task, offsets = found
    limits = np.full(offsets.shape, math.inf)
    if held.limits is not None:
        # A tolerance of 0 means an exact target, which no manufactured linkage can meet. The limits of the quality
        # apply to such targets instead.
        limits = np.where((held.limits > 0.0) & np.isfinite(held.limits), held.limits, math.inf)
    own = np.where(np.isfinite(limits), offsets, 0.0)
    task = dataclasses.replace(
        task,
        adjusted=block.input == "adjusted" or (block.input is None and held.free),
        # Replace targets with tolerances by the places that the nominal linkage reaches: errors are counted from there.
        points=None if task.points is None else task.points + own[:, 0] + 1j * own[:, 1],
        angles=None if task.angles is None else task.angles + own[:, 2],
    )
    return ManufacturedLinkage(linkage, task, own, limits, held.around)


def list_quality_units(quality: Quality) -> tuple[float, float]:
    """Return the quality's limits of distance and of angle (radians); infinite if not given."""
    angle = math.inf if quality.max_angle_error is None else math.radians(quality.max_angle_error)
    # An infinite limit is satisfied by any error.
    return quality.max_error or math.inf, angle


def _choose_units(block: Exactness, held: RequiredTargets) -> tuple[float, float]:
    """Return the units of errors: the quality's limits, or the size of the task and one radian by default."""
    if block.quality is not None:
        return list_quality_units(block.quality)
    places = held.points if held.points is not None else held.travels
    size = 1.0 if places is None else float(np.abs(places - places[0]).max())
    return size or 1.0, 1.0


def _convert_coupler_angles(linkage: Linkage, task: Task, held: RequiredTargets) -> Real | None:
    """Convert requested angles of the body to angles of the line A → B.

    The angle between the body and that line follows from the reference configuration. Return None if the linkage cannot
    be assembled there.
    """
    assert held.angles is not None
    at = dataclasses.replace(
        task,
        assemblies=task.assemblies[:1],
        inputs=np.array([linkage.reference]),
        points=np.zeros(1, np.complex128),
        angles=np.array([held.body]),
    )
    turned = measure_deviations(at, linkage.row[None]).offsets[0, 0, 2]
    return held.angles + turned if math.isfinite(turned) else None


def _choose_assemblies(task: Task, row: Real) -> NDArray[np.int64]:
    """Choose the intended assembly at each target: the linkage's own, or the opposite one if it is clearly nearer."""
    misses = []
    for sign in (1, -1):
        off = measure_deviations(dataclasses.replace(task, assemblies=sign * task.assemblies), row[None])
        miss = np.hypot(off.distances[0] / task.units[0], off.angles[0] / task.units[1])
        misses.append(np.where(np.isfinite(miss), miss, np.inf))
    return np.where(misses[1] < OPPOSITE_SHARE * misses[0], -task.assemblies, task.assemblies)
