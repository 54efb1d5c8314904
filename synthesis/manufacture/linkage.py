"""Dimensions and requirements of a finished fourbar or slider-crank, in the form of the compiled variants."""

from __future__ import annotations

import cmath
import dataclasses
import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Real
from kinematics.linkage.variation import Task, measure_deviations
from kinematics.linkage.variation.variants import Sort
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
"""Dimensions by the type of the mechanism, in the order of the variants; those of P come after them."""

POINT_DIMENSIONS = ("coupler_point.along", "coupler_point.across")

LIMIT_SLACK = 1e-9
"""Relative rounding at a limit."""

OPPOSITE_SHARE = 0.5
"""Share of the own assembly's miss at a target below which the opposite assembly is the one that is meant there."""


@dataclass(frozen=True, eq=False)
class Linkage:
    """A linkage by its dimensions.

    Attributes
    ----------
    type : str
        ``fourbar`` or ``slider_crank``.
    row : float, shape (n,)
        Its dimensions, those of P last, as of :func:`kinematics.linkage.variation.measure_deviations`.
    sign : int
        Its assembly: open is +1, crossed −1.
    slide_angle : float or None
        Direction of the slide, radians.
    foot : complex
        The foot of the fixed pivot on the slide's line, from which travels are counted.
    reference : float
        Input angle of the reference, radians.
    """

    type: str
    row: Real
    sign: int
    slide_angle: float | None
    foot: complex
    reference: float

    def list_names(self, *, guides: bool) -> list[str]:
        """The names of the dimensions, those of P only where it is guided."""
        return [*NAMES[self.type], *(POINT_DIMENSIONS if guides else ())]

    def mark_pivots(self, *, guides: bool) -> NDArray[np.bool_]:
        """Which of the dimensions are places of fixed pivots, or a slide's offset; the others are lengths."""
        named = self.list_names(guides=guides)
        return np.array([name.startswith("fixed_pivot") or name == "offset" for name in named])


def extract_linkage(mechanism: Any) -> Linkage | None:
    """The dimensions of the mechanism of an answer or a request; None of a type that is not built.

    Parameters
    ----------
    mechanism : a model of a mechanism
        Its fields ``fixed_pivots`` or ``fixed_pivot``, ``links``, ``slide``, ``coupler_point``, ``assembly`` and
        ``reference_input_angle`` are read; its skeleton is not looked at.
    """
    stated = mechanism.model_dump(exclude={"skeleton"})
    # A linkage that is stated by its skeleton alone has no assembly: its dimensions are not known by their names.
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
    between = (pivot - line) * along.conjugate()
    row = [pivot.real, pivot.imag, between.imag, links["crank"], links["coupler"]]
    foot = line + along * between.real
    return Linkage("slider_crank", np.array([*row, on_link.real, on_link.imag]), sign, angle, foot, reference)


@dataclass(frozen=True, eq=False)
class ManufacturedLinkage:
    """A linkage with its task, as a shop makes it.

    Attributes
    ----------
    linkage : Linkage
        As drawn.
    task : Task
        Its targets, where a target with a tolerance of the task's own is the place at which the linkage as drawn
        passes it.
    own : float, shape (t, 3)
        How far that place lies from the demanded one: x, y and angle; 0 of what has no tolerance of its own.
    limits : float, shape (t, 3)
        The task's own tolerances, infinite where there is none.
    around : bool
        Whether those of x are of the distance, in any direction.
    """

    linkage: Linkage
    task: Task
    own: Real
    limits: Real
    around: bool

    @cached_property
    def nominal_dimensions(self) -> Real:
        """The dimensions as drawn, shape (n,)."""
        return self.linkage.row[: self.task.dimensions]

    @property
    def list_names(self) -> list[str]:
        """What the dimensions are called."""
        return self.linkage.list_names(guides=self.task.guides)

    @property
    def has_own_tolerances(self) -> bool:
        """Whether the task has tolerances of its own."""
        return bool(np.isfinite(self.limits).any())

    def mark_within_own_tolerances(self, offsets: Real) -> NDArray[np.bool_]:
        """Whether variants with these offsets (v, t, 3) keep the task's own tolerances, shape (v,)."""
        off = np.abs(offsets + self.own)
        if self.around:
            off[..., 0] = off[..., 1] = np.hypot(off[..., 0], off[..., 1])
        return np.asarray((off <= self.limits * (1.0 + LIMIT_SLACK)).all(axis=(1, 2)))


def build_task(linkage: Linkage, held: RequiredTargets, units: tuple[float, float]) -> Task | str:
    """Build the task from a linkage's requirements, with the nominal inputs; a message if there is none."""
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
            return "the linkage cannot be assembled in its reference configuration"
        task = dataclasses.replace(task, angles=angles)
    return task


def find_target_inputs(
    linkage: Linkage, held: RequiredTargets, units: tuple[float, float], used: tuple[float, float] | None
) -> tuple[Task, Real] | str:
    """The same where the linkage can be assembled at every target, and its errors there (t, 3); or why it cannot."""
    task = build_task(linkage, held, units)
    if isinstance(task, str):
        return task
    row = linkage.row[: task.dimensions]
    if used is None:
        task = dataclasses.replace(task, assemblies=_choose_assemblies(task, row))
    offsets = measure_deviations(task, row[None]).offsets[0]
    if not np.isfinite(offsets).all():
        return "the linkage cannot be assembled at every target"
    return dataclasses.replace(task, used=used), offsets


def build_product(
    linkage: Linkage, held: RequiredTargets, block: Exactness, used: tuple[float, float] | None
) -> ManufacturedLinkage | str:
    """Build a linkage with its requirements; a message if this is not possible.

    Parameters
    ----------
    linkage : Linkage
        As drawn.
    held : Held
        What it is held to.
    stated : Exactness
        The block of the statement.
    used : pair of float or None
        The range of the input on which it must stay on its branch, radians.
    """
    found = find_target_inputs(linkage, held, _choose_units(block, held), used)
    if isinstance(found, str):
        return found
    task, offsets = found
    limits = np.full(offsets.shape, math.inf)
    if held.limits is not None:
        limits = np.where((held.limits > 0.0) & np.isfinite(held.limits), held.limits, math.inf)
    own = np.where(np.isfinite(limits), offsets, 0.0)
    task = dataclasses.replace(
        task,
        adjusted=block.input == "adjusted" or (block.input is None and held.free),
        points=None if task.points is None else task.points + own[:, 0] + 1j * own[:, 1],
        angles=None if task.angles is None else task.angles + own[:, 2],
    )
    return ManufacturedLinkage(linkage, task, own, limits, held.around)


def list_quality_units(quality: Quality) -> tuple[float, float]:
    """Return the quality's limits of distance and of angle (radians); infinite if not given."""
    angle = math.inf if quality.max_angle_error is None else math.radians(quality.max_angle_error)
    return quality.max_error or math.inf, angle


def _choose_units(block: Exactness, held: RequiredTargets) -> tuple[float, float]:
    """Return the units of errors: the quality's limits, or the size of the task and one radian by default."""
    if block.quality is not None:
        return list_quality_units(block.quality)
    places = held.points if held.points is not None else held.travels
    size = 1.0 if places is None else float(np.abs(places - places[0]).max())
    return size or 1.0, 1.0


def _convert_coupler_angles(linkage: Linkage, task: Task, held: RequiredTargets) -> Real | None:
    """Demanded angles of the line A → B: the body's, by how the body stands on the coupler in the reference."""
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
    """The assembly that is meant at each target, where a linkage is not held to one: the opposite if clearly nearer."""
    misses = []
    for sign in (1, -1):
        off = measure_deviations(dataclasses.replace(task, assemblies=sign * task.assemblies), row[None])
        miss = np.hypot(off.distances[0] / task.units[0], off.angles[0] / task.units[1])
        misses.append(np.where(np.isfinite(miss), miss, np.inf))
    return np.where(misses[1] < OPPOSITE_SHARE * misses[0], -task.assemblies, task.assemblies)
