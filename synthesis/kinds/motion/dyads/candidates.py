"""Candidate dyads of one side, from the client's choices for it.

n positions leave 5 − n free choices per dyad (Norton, Table 5-3). If all are given, the dyads are solved for; if some
are open, the missing ones are sampled at random many times, which gives a *cloud* of dyads.

Free pivots are sampled around the body: the moving pivot about P in the first position, the fixed pivot about the mean
of the positions, at log-uniform distances from a small part of the task's size to a few times that size. A given area
is filled uniformly instead, and dyads with a pivot outside it are dropped.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Mapping
from dataclasses import replace
from types import MappingProxyType
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex, Real
from kinematics.message import compose
from synthesis.kinds.motion.dyads import burmester
from synthesis.kinds.motion.dyads.equations import (
    MAX_PIVOT_DISTANCE,
    REPETITION_TOLERANCE,
    DyadConditions,
    Dyads,
    Line,
    check_directions,
    refine_dyads,
    solve_dyads,
    solve_linear_family,
)
from synthesis.kinds.motion.dyads.finite_sets import SliderDyad, build_pose_rows, find_section
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.kinds.motion.statement.dyad_choices import DyadChoices, to_complete_point
from synthesis.kinds.motion.task.pivot_regions import SideAreas, inside_mask, sample_area
from synthesis.kinds.motion.task.positions import MotionTask, find_given_pivot
from synthesis.kinds.motion.task.random_points import sample_distances, sample_points_around
from synthesis.model.problem import PartialPoint

MAX_CURVE_DISTANCE = 50.0
"""Maximum distance of a pivot on Burmester's curves, in task sizes, for a dyad to be a candidate."""

NEAR_DISTANCE = 0.15
"""Distance from the body, in task sizes, within which samples of the curves are uniform in arc length; beyond it they
are uniform in its logarithm."""

SECTION_COUNT = 400
"""Number of random sections, with at most four dyads each, that sample a family without a simpler description."""

MAX_NEWTON_DYADS = 4000
"""Maximum size of a cloud whose dyads each need Newton's method: a few tenths of a second."""

NEAREST_SAMPLE_COUNT = 4000
"""Number of curve samples among which the pivot nearest to a given one is selected."""

REDUNDANCY_TOLERANCE = 1e-9
"""Independent part of a position's condition below which it counts as implied by the others. Above
:data:`~synthesis.kinds.motion.dyads.equations.REPETITION_TOLERANCE` it is independent, but only in digits that are
lost."""

MAX_REGION_DRAWS = 6
"""Maximum number of times that a whole cloud is sampled until half of it lies in the given regions."""

EQUALITY_TOLERANCE = 2e-15
"""Tolerance for equal angles (radians) and lengths (task sizes): a few rounding errors of the positions."""

POLE_ROUNDING_FACTOR = 8.0
"""Permitted motion of the pole in a rotation about it, in rounding errors of its images."""

ROTATION_TOLERANCE = 1e-9
"""Maximum rounding of the positions, relative to the body's rotation, at which a pure rotation about one point can be
distinguished from all other motions."""

_NO_DYADS = Dyads(np.empty(0, np.complex128), np.empty(0, np.complex128))


class SideMessage(NamedTuple):
    """A message about one side: its id and values, to be composed when the name of the side is known."""

    id: str
    values: Mapping[str, str | int] = MappingProxyType({})

    def write(self, side: str) -> str:
        """Compose the message; ``side`` is the id of the side's name."""
        return compose(self.id, side=compose(side), **self.values)


class Cloud(NamedTuple):
    """The dyads of one side.

    Attributes
    ----------
    dyads : Dyads
        Task coordinates, shape (count,).
    sampled : bool
        The choices leave some freedom, and these dyads are a sample.
    complete : bool
        These are provably all dyads that satisfy the client's choices, even if there are none.
    reason : SideMessage, optional
        The reason for an empty cloud.
    remarks : tuple of SideMessage
        Further remarks for the client.
    sliders : tuple of SliderDyad
        Dyads with a pivot at infinity that satisfy the choices, if all are known.
    """

    dyads: Dyads
    sampled: bool
    complete: bool
    reason: SideMessage | None = None
    remarks: tuple[SideMessage, ...] = ()
    sliders: tuple[SliderDyad, ...] = ()


def build_conditions(task: MotionTask, problem: MotionProblem, choices: DyadChoices) -> DyadConditions:
    """Convert the client's choices of one side to task coordinates and radians."""

    def to_array(pivot: complex | None) -> Complex | None:
        return None if pivot is None else np.asarray(pivot)

    def make_line(point: PartialPoint | None) -> tuple[Line, ...]:
        if point is None or to_complete_point(point) is not None:
            # A point with both coordinates is a given pivot, not a line.
            return ()
        normal, offset = (1.0 + 0j, point[0]) if point[1] is None else (1j, point[1])
        assert offset is not None
        return (Line(normal, (offset - (normal.conjugate() * task.origin).real) / task.size),)

    def to_radians(degrees: float | None) -> Real | None:
        return None if degrees is None else np.asarray(math.radians(degrees))

    vector = choices.coupler_vector
    length = None if vector is None or vector.length is None else np.asarray(vector.length / task.size)
    if vector is not None and vector.length is not None and vector.angle is not None:
        vector = length = None  # together they fix the moving pivot, which is a condition of its own
    moving = to_array(find_given_pivot(task, choices, fixed=False))
    fixed, fixed_lines = to_array(find_given_pivot(task, choices, fixed=True)), make_line(choices.fixed_pivot)
    if problem.ground_line is not None and fixed is None:
        normal = 1j * cmath.rect(1.0, math.radians(problem.ground_line.angle))
        ground = Line(normal, -problem.ground_line.offset(task.origin) / task.size)
        # With one coordinate given, the ground line determines the other; otherwise the line is the only condition.
        fixed, fixed_lines = (_intersect_lines(fixed_lines[0], ground), ()) if fixed_lines else (None, (ground,))
    return DyadConditions(
        fixed_pivot=fixed,
        moving_pivot=moving,
        fixed_lines=fixed_lines,
        moving_lines=make_line(choices.moving_pivot),
        rotations=tuple(to_radians(b) for b in choices.rotations or [None] * (len(task.points) - 1)),
        link_angle=to_radians(choices.link_angle),
        coupler_length=length,
        coupler_angle=None if vector is None else to_radians(vector.angle),
    )


def _intersect_lines(first: Line, second: Line) -> Complex:
    """Return the intersection of two lines that are not parallel."""
    return np.asarray(
        1j
        * (second.offset * first.normal - first.offset * second.normal)
        / (first.normal.conjugate() * second.normal).imag
    )


def find_side_dyads(
    task: MotionTask, problem: MotionProblem, side: int, areas: SideAreas, rng: np.random.Generator, count: int
) -> Cloud:
    """Find all dyads that one side's choices determine, or a cloud of about ``count`` if some choices are open.

    ``side`` is 0 for the input and 1 for the output; ``areas`` are those of this side.
    """
    impossible = explain_no_dyads(task)
    if impossible is not None:
        return Cloud(_NO_DYADS, False, impossible.proved, SideMessage(impossible.message_id))
    choices = (problem.input_side, problem.output_side)[side]
    conditions = build_conditions(task, problem, choices)
    essential, conditions, lost = _drop_redundant_positions(task, conditions)
    free = 5 - len(essential.points) - conditions.count()
    # With a pivot given, everything else is linear and needs neither Burmester's curve nor random conditions.
    if conditions.is_linear and (free <= 0 or _get_given_pivot(conditions) is not None):
        cloud = _sample_family(essential, conditions, areas, rng, count)
    elif free <= 0:
        cloud = _solve_section(essential, conditions, rng)
    elif free == 1 and len(essential.points) == 4:
        cloud = _sample_curve(essential, conditions, areas, rng, count)
    else:
        cloud = _sample_choices(essential, conditions, areas, rng, count)
    if len(essential.points) == len(task.points):
        return cloud
    met = SideMessage(
        "motion-dyads-nearly-meet-other-positions" if lost else "motion-dyads-meet-other-positions",
        {"positions": len(essential.points), "total": len(task.points)},
    )
    return cloud._replace(complete=cloud.complete and not lost, remarks=(met, *cloud.remarks))


class _ReducedTask(NamedTuple):
    """Task and choices without redundant positions; ``lost`` if these were independent only in lost digits."""

    task: MotionTask
    conditions: DyadConditions
    lost: bool


def _drop_redundant_positions(task: MotionTask, conditions: DyadConditions) -> _ReducedTask:
    """Drop the positions whose condition follows from those of the others.

    An example is a translation along a circle, which three positions determine. Positions with a given rotation are
    kept.
    """
    rows = build_pose_rows(task)
    s = np.linalg.svd(rows, compute_uv=False)
    # Singular values bound the independent parts from below, so usually no row needs to be examined.
    if s[-1] > REDUNDANCY_TOLERANCE:
        return _ReducedTask(task, conditions, False)
    kept: list[int] = []
    # Gram-Schmidt in order: keep a position only if its condition adds something to those kept before.
    for k, row in enumerate(rows):
        others = rows[kept]
        new = row - others.T @ np.linalg.lstsq(others.T, row, rcond=None)[0] if kept else row
        if np.linalg.norm(new) > REDUNDANCY_TOLERANCE or conditions.rotations[k] is not None:
            kept.append(k)
    if len(kept) == len(rows):
        return _ReducedTask(task, conditions, False)
    # The first position is the reference of all conditions and always stays.
    order = [0, *(k + 1 for k in kept)]
    reduced = task._replace(points=task.points[order], turns=task.turns[order])
    rotations = tuple(conditions.rotations[k] for k in kept)
    return _ReducedTask(
        reduced,
        replace(conditions, rotations=rotations),
        bool(np.any((s > REPETITION_TOLERANCE) & (s <= REDUNDANCY_TOLERANCE))),
    )


def _solve_section(task: MotionTask, conditions: DyadConditions, rng: np.random.Generator) -> Cloud:
    """Find the distinct dyads of as many conditions as a dyad has freedoms; a cloud if conditions repeat each other."""
    intersection = find_section(task, conditions)
    if not intersection.finite:
        cloud = _sample_sections(task, conditions, rng)
        return cloud._replace(remarks=(SideMessage("motion-family-of-dyads"),))
    dyads = intersection.dyads
    # Newton's method needs a square system; at a double root it would converge slowly and is left out.
    if conditions.count() == 5 - len(task.points):
        refined, converged = solve_dyads(task, conditions, dyads)
        kept = converged & ~intersection.double
        dyads = Dyads(np.where(kept, refined.fixed, dyads.fixed), np.where(kept, refined.moving, dyads.moving))
    remarks = []
    if intersection.double.any():
        remarks.append(SideMessage("motion-dyads-coincide"))
    if intersection.far:
        distance = f"{MAX_PIVOT_DISTANCE:.0e}"
        remarks.append(SideMessage("motion-dyads-far", {"count": intersection.far, "distance": distance}))
    elif not intersection.proved and not remarks:
        remarks.append(SideMessage("motion-dyads-uncountable"))
    reason = SideMessage("motion-no-pinned-dyad")
    return Cloud(dyads, False, intersection.proved, reason, tuple(remarks), intersection.sliders)


def _sample_sections(task: MotionTask, conditions: DyadConditions, rng: np.random.Generator) -> Cloud:
    """Sample dyads of a family by requiring a pivot to lie on random lines."""
    fixed, moving = [], []
    for k in range(SECTION_COUNT):
        centre = complex(sample_points_around(task.points.mean(keepdims=True), rng, 1)[0])
        normal = cmath.rect(1.0, rng.uniform(-math.pi, math.pi))
        line = Line(normal, (normal.conjugate() * centre).real)
        lines = (
            replace(conditions, fixed_lines=(*conditions.fixed_lines, line))
            if k % 2
            else replace(conditions, moving_lines=(*conditions.moving_lines, line))
        )
        # Lines for the fixed and the moving pivot alternate: each finds dyads that the other rarely meets.
        intersection = find_section(task, lines)
        # Samples farther away make no practical linkage.
        near = np.maximum(np.abs(intersection.dyads.fixed), np.abs(intersection.dyads.moving)) <= MAX_CURVE_DISTANCE
        fixed.append(intersection.dyads.fixed[near])
        moving.append(intersection.dyads.moving[near])
    reason = SideMessage("motion-no-dyad-of-family")
    return Cloud(Dyads(np.concatenate(fixed), np.concatenate(moving)), True, False, reason)


def _sample_curve(
    task: MotionTask, conditions: DyadConditions, areas: SideAreas, rng: np.random.Generator, count: int
) -> Cloud:
    """Sample dyads along Burmester's curve of four positions."""
    curve = burmester.find_burmester_curve(task, conditions)
    if curve is None:
        return _sample_sections(task, conditions, rng)
    dyads = burmester.sample_dyads(curve, make_curve_window(task), count, float(rng.uniform()))
    # Samples of the curve carry a few digits of error; project them back before they are used.
    dyads = refine_dyads(task, dyads)
    good = _inside_areas(task, areas, dyads)
    reason = SideMessage("motion-no-dyad-in-regions")
    return Cloud(Dyads(dyads.fixed[good], dyads.moving[good]), True, False, reason)


def make_curve_window(task: MotionTask) -> burmester.Window:
    """Return the region of Burmester's curves that a search samples."""
    return burmester.Window((complex(task.points.mean()), complex(task.points[0])), MAX_CURVE_DISTANCE, NEAR_DISTANCE)


def _sample_choices(
    task: MotionTask, conditions: DyadConditions, areas: SideAreas, rng: np.random.Generator, count: int
) -> Cloud:
    """Sample a cloud of dyads with two or more random freedoms."""
    # Without given numbers a step of Newton's method is exact and cheap, so the cloud can be larger.
    if _get_given_pivot(conditions) is not None or conditions.count() > 0:
        count = min(count, MAX_NEWTON_DYADS)
    fixed, moving = [], []
    for _ in range(MAX_REGION_DRAWS):
        start = _sample_pivots(task, areas, rng, count)
        for pinned, share in _add_random_conditions(task, conditions, start, areas, rng):
            dyads, kept = solve_dyads(task, pinned, share)
            kept &= _inside_areas(task, areas, dyads)
            fixed.append(dyads.fixed[kept])
            moving.append(dyads.moving[kept])
        # Half of a cloud suffices; a small region would otherwise need many more draws.
        if sum(map(len, fixed)) >= count // 2:
            break
    cloud = Dyads(np.concatenate(fixed)[:count], np.concatenate(moving)[:count])
    return Cloud(cloud, True, False, SideMessage("motion-no-dyad-found"))


def _inside_areas(task: MotionTask, areas: SideAreas, dyads: Dyads) -> NDArray[np.bool_]:
    """Return a mask of the dyads with both pivots in their areas."""
    return np.asarray(inside_mask(task, areas.fixed, dyads.fixed) & inside_mask(task, areas.moving, dyads.moving))


class ImpossibilityReason(NamedTuple):
    """The reason why there are no dyads, by its message, and whether the positions have enough digits to prove it."""

    message_id: str
    proved: bool = True


def explain_no_dyads(task: MotionTask) -> ImpossibilityReason | None:
    """Explain why no pin-jointed dyad of positive length exists for the positions; return None if some exist.

    None exists for a translation through three or more positions, unless P moves on a circle; nor for a rotation about
    one point, which would be the fixed pivot of every dyad.
    """
    # Two positions can always be reached by a dyad.
    if len(task.points) < 3:
        return None
    if np.abs(task.turns - 1.0).max() <= EQUALITY_TOLERANCE:
        sides = task.points[1:] - task.points[0]
        # For pure translations all turns are equal to one, so only the sides decide.
        if np.abs((np.conj(sides[0]) * sides).imag).max() <= EQUALITY_TOLERANCE:
            return ImpossibilityReason("motion-straight-translation")
        # For a translation along a circle |c|² is linear in c, which leaves rows of rank two.
        if np.linalg.svd(build_pose_rows(task), compute_uv=False)[2:].max(initial=0.0) <= REDUNDANCY_TOLERANCE:
            return None
        return ImpossibilityReason("motion-other-translation")
    # The position with the largest rotation gives the best-conditioned pole; test that it is fixed in all positions.
    turning = int(np.abs(task.turns - 1.0).argmax())
    pole = _find_pole(task, turning)
    turned = float(abs(task.turns[turning] - 1.0))
    # The positions carry rounding errors of the client's coordinates, which grow with the distance from the origin.
    rounding = POLE_ROUNDING_FACTOR * np.finfo(np.float64).eps * (1.0 + abs(task.origin) / task.size + abs(pole))
    # A rotation about the pole keeps it in place; if one position moves it, dyads exist.
    if np.abs(task.images(np.asarray(pole)) - pole).max() > rounding:
        return None
    if rounding > ROTATION_TOLERANCE * turned:
        return ImpossibilityReason("motion-nearly-rotation-about-point", proved=False)
    return ImpossibilityReason("motion-rotation-about-point")


def _find_pole(task: MotionTask, k: int) -> complex:
    """Return the displacement pole of positions 1 and k: the point with A_k = A."""
    turn = task.turns[k]
    return complex((task.points[k] - turn * task.points[0]) / (1.0 - turn))


def _get_given_pivot(conditions: DyadConditions) -> Complex | None:
    """Return the given pivot; None if neither is given."""
    return conditions.moving_pivot if conditions.fixed_pivot is None else conditions.fixed_pivot


def _sample_family(
    task: MotionTask, conditions: DyadConditions, areas: SideAreas, rng: np.random.Generator, count: int
) -> Cloud:
    """Solve linear conditions: one dyad, none, or a cloud if a freedom remains or a pivot is a pole."""
    family = solve_linear_family(task, conditions)
    if family.dyad is None:
        return Cloud(_NO_DYADS, False, family.proved, _explain_contradiction(task, conditions, proved=family.proved))
    free = len(family.directions)
    if not free:
        reach = max(abs(family.dyad.fixed[0]), abs(family.dyad.moving[0]))
        # A pivot that far away moves on an almost straight line.
        if reach >= MAX_PIVOT_DISTANCE:
            reason = SideMessage("motion-other-pivot-far", {"distance": f"{reach:.0e}"})
            return Cloud(_NO_DYADS, False, False, reason)
        return _select_forward(task, conditions, family.dyad, sampled=False, proved=family.proved)
    distance = sample_distances(rng, count, free)
    # Distances are positive; random signs use both directions of the family.
    moved = (distance * rng.choice([-1.0, 1.0], (count, free))) @ family.directions
    dyads = Dyads(
        family.dyad.fixed + (moved[:, 0] + 1j * moved[:, 1]), family.dyad.moving + (moved[:, 2] + 1j * moved[:, 3])
    )
    good = _inside_areas(task, areas, dyads)
    return _select_forward(task, conditions, Dyads(dyads.fixed[good], dyads.moving[good]), sampled=True, proved=False)


def _select_forward(
    task: MotionTask, conditions: DyadConditions, dyads: Dyads, *, sampled: bool, proved: bool
) -> Cloud:
    """Return the dyads that meet the given directions with positive lengths."""
    good = check_directions(task, conditions, dyads)
    reason = SideMessage("motion-negative-length")
    return Cloud(Dyads(dyads.fixed[good], dyads.moving[good]), sampled, proved, reason)


def _explain_contradiction(task: MotionTask, conditions: DyadConditions, *, proved: bool) -> SideMessage:
    """Explain why linear conditions have no solution."""
    pivot = _get_given_pivot(conditions)
    if pivot is None:
        return SideMessage("motion-rotations-without-link")
    if len(task.points) > 3:
        return SideMessage("motion-pivot-without-dyad", {"nearest": _describe_nearest(task, conditions)})
    return SideMessage("motion-pivot-on-line" if proved else "motion-pivot-nearly-on-line")


def _describe_nearest(task: MotionTask, conditions: DyadConditions) -> str:
    """Return a sentence with the pivot of a dyad that is nearest to the given one."""
    nothing = DyadConditions(rotations=(None,) * (len(task.points) - 1))
    if len(task.points) == 4:
        curve = burmester.find_burmester_curve(task, nothing)
        dyads = (
            _NO_DYADS if curve is None else burmester.sample_dyads(curve, make_curve_window(task), NEAREST_SAMPLE_COUNT)
        )
    else:
        dyads = find_section(task, nothing).dyads
    if not len(dyads.fixed):
        return compose("motion-no-nearest-pivot")
    moving = conditions.fixed_pivot is None
    pivots, stated = (dyads.moving, conditions.moving_pivot) if moving else (dyads.fixed, conditions.fixed_pivot)
    assert stated is not None
    nearest = task.to_problem(complex(pivots[np.abs(pivots - stated).argmin()]))
    return compose("motion-nearest-pivot", x=f"{nearest.real:.6g}", y=f"{nearest.imag:.6g}")


def _sample_pivots(task: MotionTask, areas: SideAreas, rng: np.random.Generator, count: int) -> Dyads:
    """Sample random fixed and moving pivots, shape (count,) each."""
    middle = task.points.mean(keepdims=True)
    fixed, moving = sample_area(task, areas.fixed, rng, count), sample_area(task, areas.moving, rng, count)
    return Dyads(
        sample_points_around(middle, rng, count) if fixed is None else fixed,
        sample_points_around(task.points[:1], rng, count) if moving is None else moving,
    )


def _add_random_conditions(
    task: MotionTask, conditions: DyadConditions, pivots: Dyads, areas: SideAreas, rng: np.random.Generator
) -> list[tuple[DyadConditions, Dyads]]:
    """Add random conditions until each dyad is determined; return each set of conditions with its starting pivots.

    If both pivots are open, half of the cloud fixes the moving pivots and half the fixed pivots: each finds dyads that
    the other rarely meets. If only one pivot has a region, all samples fix that pivot.
    """
    conditions = _project_on_lines(conditions, pivots)
    missing = 5 - len(task.points) - conditions.count()
    stated_vector = (conditions.coupler_length, conditions.coupler_angle).count(None) < 2
    # Two freedoms can fix a whole pivot, unless the client's own choices are about the link or the coupler vector.
    if missing >= 2 and _get_given_pivot(conditions) is None and not stated_vector and conditions.link_angle is None:
        # With a region for one pivot only, sample that pivot, since otherwise most dyads would miss the region.
        moving_share = 0.5 if bool(areas.moving) == bool(areas.fixed) else float(bool(areas.moving))
        half = int(len(pivots.fixed) * moving_share)
        by_moving = Dyads(pivots.fixed[:half], pivots.moving[:half])
        by_fixed = Dyads(pivots.fixed[half:], pivots.moving[half:])
        return [
            (
                _add_random_numbers(
                    task, replace(conditions, moving_pivot=by_moving.moving), by_moving, missing - 2, rng
                ),
                by_moving,
            ),
            (
                _add_random_numbers(task, replace(conditions, fixed_pivot=by_fixed.fixed), by_fixed, missing - 2, rng),
                by_fixed,
            ),
        ]
    return [(_add_random_numbers(task, conditions, pivots, missing, rng), pivots)]


def _project_on_lines(conditions: DyadConditions, pivots: Dyads) -> DyadConditions:
    """Project a pivot onto its given line, so that the remaining conditions are linear in the other pivot."""
    if conditions.fixed_lines and conditions.moving_pivot is None:
        line = conditions.fixed_lines[0]
        gap = (line.normal.conjugate() * pivots.fixed).real - line.offset
        return replace(conditions, fixed_pivot=pivots.fixed - gap * line.normal, fixed_lines=())
    if conditions.moving_lines and conditions.fixed_pivot is None:
        line = conditions.moving_lines[0]
        gap = (line.normal.conjugate() * pivots.moving).real - line.offset
        return replace(conditions, moving_pivot=pivots.moving - gap * line.normal, moving_lines=())
    return conditions


def _add_random_numbers(
    task: MotionTask, conditions: DyadConditions, pivots: Dyads, missing: int, rng: np.random.Generator
) -> DyadConditions:
    """Add ``missing`` random scalars: the other half of a coupler vector, then rotations, then a coupler angle."""
    vector = task.points[0] - pivots.moving
    if missing and conditions.fixed_pivot is None:
        if conditions.coupler_length is None and conditions.coupler_angle is not None:
            conditions, missing = replace(conditions, coupler_length=np.abs(vector)), missing - 1
        elif conditions.coupler_angle is None and conditions.coupler_length is not None:
            conditions, missing = replace(conditions, coupler_angle=np.angle(vector)), missing - 1
    rotations = list(conditions.rotations)
    # Rotations come first, as they leave linear systems; the coupler angle is the last resort.
    for k, rotation in enumerate(rotations):
        if missing and rotation is None:
            rotations[k] = rng.uniform(-np.pi, np.pi, len(vector))
            missing -= 1
    if missing:
        conditions = replace(conditions, coupler_angle=np.angle(vector))
    return replace(conditions, rotations=tuple(rotations))
