"""Dimensions and requirements of a finished fourbar or slider-crank, in the form of the compiled variants."""

from __future__ import annotations

import cmath
import dataclasses
import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel

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
"""Names of the dimensions by the type of the mechanism, in the order of the variants; those of P follow."""

POINT_DIMENSIONS = ("coupler_point.along", "coupler_point.across")

LIMIT_SLACK = 1e-9
"""Relative rounding at a limit."""

OPPOSITE_SHARE = 0.5
"""Share of the own assembly's miss at a target below which the opposite assembly is taken to be the intended one
there."""


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
        """Return the names of the dimensions; those of P only if it is guided."""
        return [*NAMES[self.type], *(POINT_DIMENSIONS if guides else ())]

    def mark_pivots(self, *, guides: bool) -> NDArray[np.bool_]:
        """Return a mask of dimensions that are coordinates of fixed pivots, or a slide's offset; the others are
        lengths."""
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
    # A linkage given by its skeleton alone has no assembly and no named dimensions; a driven slider is not supported.
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
    # Split the vector from the line's point into its parts along the slide (the foot) and across it (the offset).
    between = (pivot - line) * along.conjugate()
    row = [pivot.real, pivot.imag, between.imag, links["crank"], links["coupler"]]
    foot = line + along * between.real
    return Linkage("slider_crank", np.array([*row, on_link.real, on_link.imag]), sign, angle, foot, reference)


@dataclass(frozen=True, eq=False)
class ManufacturedLinkage:
    """A linkage with its task, as manufactured.

    Attributes
    ----------
    linkage : Linkage
        As drawn.
    task : Task
        Its targets. A target with a tolerance of the task's own is replaced by the place at which the nominal linkage
        passes it.
    own : float, shape (t, 3)
        Offset of that place from the requested one: x, y and angle; 0 without a tolerance of its own.
    limits : float, shape (t, 3)
        The task's own tolerances, infinite without one.
    around : bool
        Whether those of x limit the distance, in any direction.
    """

    linkage: Linkage
    task: Task
    own: Real
    limits: Real
    around: bool

    @cached_property
    def nominal_dimensions(self) -> Real:
        """Return the nominal dimensions, shape (n,)."""
        return self.linkage.row[: self.task.dimensions]

    @property
    def list_names(self) -> list[str]:
        """Names of the dimensions."""
        return self.linkage.list_names(guides=self.task.guides)

    @property
    def has_own_tolerances(self) -> bool:
        """Whether the task has tolerances of its own."""
        return bool(np.isfinite(self.limits).any())

    def mark_within_own_tolerances(self, offsets: Real) -> NDArray[np.bool_]:
        """Return a mask of variants, given their offsets (v, t, 3), that satisfy the task's own tolerances, shape
        (v,)."""
        off = np.abs(offsets + self.own)
        # A tolerance of the point limits its distance, so both coordinates get the same value.
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
    """Return the task and the errors (t, 3) of a linkage that can be assembled at every target; else a message."""
    task = build_task(linkage, held, units)
    if isinstance(task, str):
        return task
    row = linkage.row[: task.dimensions]
    # Without a used range each target may be met in either assembly.
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
    held : RequiredTargets
        Its requirements.
    block : Exactness
        The block of the request.
    used : pair of float or None
        The range of the input on which it must stay on its branch, radians.
    """
    found = find_target_inputs(linkage, held, _choose_units(block, held), used)
    if isinstance(found, str):
        return found
    task, offsets = found
    limits = np.full(offsets.shape, math.inf)
    if held.limits is not None:
        # A tolerance of 0 means an exact target, which manufacturing can never meet; quality limits apply there
        # instead.
        limits = np.where((held.limits > 0.0) & np.isfinite(held.limits), held.limits, math.inf)
    own = np.where(np.isfinite(limits), offsets, 0.0)
    task = dataclasses.replace(
        task,
        adjusted=block.input == "adjusted" or (block.input is None and held.free),
        # Move such targets to the place that the nominal linkage reaches, so that errors count from there.
        points=None if task.points is None else task.points + own[:, 0] + 1j * own[:, 1],
        angles=None if task.angles is None else task.angles + own[:, 2],
    )
    return ManufacturedLinkage(linkage, task, own, limits, held.around)


def list_quality_units(quality: Quality) -> tuple[float, float]:
    """Return the quality's limits of distance and of angle (radians); infinite if not given."""
    angle = math.inf if quality.max_angle_error is None else math.radians(quality.max_angle_error)
    # No limit is an infinite one, which any error satisfies.
    return quality.max_error or math.inf, angle


def _choose_units(block: Exactness, held: RequiredTargets) -> tuple[float, float]:
    """Return the units of errors: the quality's limits, or the size of the task and one radian by default."""
    if block.quality is not None:
        return list_quality_units(block.quality)
    places = held.points if held.points is not None else held.travels
    size = 1.0 if places is None else float(np.abs(places - places[0]).max())
    return size or 1.0, 1.0


def _convert_coupler_angles(linkage: Linkage, task: Task, held: RequiredTargets) -> Real | None:
    """Convert requested angles of the body to angles of the line A → B, by the body's angle on the coupler in the
    reference."""
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
    """Choose the intended assembly at each target of a linkage without a fixed one: the opposite if clearly nearer."""
    misses = []
    for sign in (1, -1):
        off = measure_deviations(dataclasses.replace(task, assemblies=sign * task.assemblies), row[None])
        miss = np.hypot(off.distances[0] / task.units[0], off.angles[0] / task.units[1])
        misses.append(np.where(np.isfinite(miss), miss, np.inf))
    return np.where(misses[1] < OPPOSITE_SHARE * misses[0], -task.assemblies, task.assemblies)
