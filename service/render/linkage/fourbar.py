"""What the drawing of a fourbar shows: configurations at the targets, the coupler curve, the input's range.

Everything is in mechanism coordinates; :mod:`service.render.linkage.fourbar_panel` puts it into a panel. All positions
come from the analysis core. A target that the mechanism's own assembly misses is shown with the other assembly where
that one meets the demanded position, so that a design with a branch defect is seen as what it is.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from kinematics.linkage.fourbar import Fourbar, positions, toggle_angles, traverse
from service.render.linkage.motion import Demand, DrivenLinkage, demands_of, stance_curve, target_curve
from service.render.page.svg import Box, Points
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.kinds.path.curve_placement import placed
from synthesis.kinds.path.design import PathDesign
from synthesis.kinds.path.problem import PathProblem
from synthesis.model.linkage_answer import FourbarMechanism, LinkageDesign
from synthesis.model.linkages import DrivenFourbar, driven_fourbar

Real = NDArray[np.float64]

MEETS = 1e-6
"""A configuration meets a position when it misses by less than this share of the task's size, and than this angle in
radians: far below what is visible, far above rounding."""

AT_LIMIT, INSIDE = 1e-6, 1e-9
"""Input angles, radians, beyond a limit by less than the first count as at the limit, and are moved inside it by the
second: a target at a toggle stays visible."""

SWEPT_SAMPLES = 33
"""Points of the path of A, whose box alone is asked for."""

CURVE_SAMPLES = 121
"""First sample points on a coupler curve; more are put where it is fast."""

CURVE_STEP = 0.01
"""Longest step between sample points, as a share of the curve's extent."""

REFINEMENTS = 5
"""Times that long steps are halved."""

OTHERS = 9
"""Linkages that are drawn beside the first at most: none where more points are demanded, some of more positions."""

MARKED = 24
"""Targets that are drawn and listed at most; more are thinned to this number, evenly, keeping first and last."""

SMALL_MOTION, SMALL_PART = 0.15, 0.04
"""All moving joints together, or one group of joints, within this share of the drawing's diagonal get a detail."""

REST_SHARE = 0.25
"""The part of the curve that is not used widens the shown box by at most this share of its diagonal on each side."""


@dataclass(frozen=True)
class Configuration:
    """The linkage at one target; ``own`` is False where it stands in the other assembly than at the first target."""

    index: int
    input_angle: float
    assembly: int
    own: bool
    a: complex
    b: complex
    p: complex
    body_angle: float


@dataclass(frozen=True)
class Scene:
    """All that is drawn of one fourbar, in mechanism coordinates; angles in radians.

    ``configurations`` are those that can be assembled, by target. ``used`` and ``rest`` are polylines of P, with NaN
    where the linkage does not close: over the input angles that the targets need, and over the whole branch (and the
    other branch, where a target lies on it). ``limits`` are the ends of the input's range, None for a crank; ``start``
    and ``end`` the input angles at the first and at the last target. ``target`` is the curve that is matched as a
    whole, where the problem is that; its first point alone is a target then. ``stance`` are the points of a stance.
    ``demanded`` counts all demands, of which
    ``demands`` are those that are drawn, and ``met`` those at which the linkage can be assembled.
    """

    linkage: Fourbar
    configurations: list[Configuration]
    demands: list[Demand]
    used: Points
    rest: list[Points]
    limits: tuple[float, float] | None
    start: float
    end: float
    demanded: int
    met: int
    target: Points | None = None
    stance: Points | None = None

    @property
    def guides_a_body(self) -> bool:
        """Whether angles are demanded, and not points only."""
        return any(demand.angle is not None for demand in self.demands)

    @property
    def others(self) -> list[Configuration]:
        """The configurations that are drawn beside the first: none where they would hide the path of a point."""
        others = [c for c in self.configurations if c.index != 0]
        if len(others) <= OTHERS:
            return others
        return [others[k] for k in spread(len(others), OTHERS)] if self.guides_a_body else []

    @property
    def misses(self) -> bool:
        """Whether some demanded point is missed."""
        places = {demand.index: demand.point for demand in self.demands if demand.angle is None}
        size = max((abs(z - w) for z in places.values() for w in places.values()), default=0.0)
        return any(c.index in places and abs(c.p - places[c.index]) > MEETS * size for c in self.configurations)

    @property
    def o2(self) -> complex:
        """Fixed pivot of the input."""
        return complex(self.linkage.input_pivot)

    @property
    def o4(self) -> complex:
        """Fixed pivot of the output."""
        return complex(self.linkage.output_pivot)

    def moving(self) -> list[complex]:
        """A, B and P at all targets, and the demanded points."""
        joints = [joint for c in self.configurations for joint in (c.a, c.b, c.p)]
        target = [] if self.target is None else list(self.target)
        return [*joints, *(demand.point for demand in self.demands), *target]

    def swept(self) -> Points:
        """Path of A as far as the input reaches, coarsely."""
        start, end = self.limits or (0.0, math.tau)
        return np.asarray(positions(self.linkage, np.linspace(start, end, SWEPT_SAMPLES)).a)

    def box(self) -> Box:
        """What the drawing must show: all joints and the used curve whole, the rest of the curve in part."""
        needed = Box.around(np.array([self.o2, self.o4, *self.moving(), *self.used]))
        widest = needed.grown(REST_SHARE * needed.diagonal)
        for curve in (*self.rest, self.swept()):
            if not np.all(np.isnan(curve)):
                needed = needed.united(Box.around(curve).united(needed).common(widest))
        return needed


def fourbar_of(design: LinkageDesign) -> FourbarMechanism:
    """The fourbar that a design is."""
    mechanism = design.mechanism
    assert isinstance(mechanism, FourbarMechanism)
    return mechanism


def scene(design: LinkageDesign, problem: MotionProblem | PathProblem, motion: DrivenLinkage) -> Scene:
    """What is drawn of a fourbar design, with its motion, and of the problem that it answers."""
    driven = driven_fourbar(fourbar_of(design))
    linkage = driven.linkage
    if isinstance(problem, PathProblem) and isinstance(design, PathDesign):
        problem = placed(problem, design)
    target = target_curve(problem)
    demands = demands_of(problem)[: None if target is None else 1]
    configurations = _configurations(design, driven, demands)
    start = end = driven.reference
    used = (start, end)
    if configurations:
        angles = np.array([c.input_angle for c in configurations])
        way = traverse(linkage, angles, np.array([c.assembly for c in configurations]))
        start, end, used = float(way.angles[0]), float(way.angles[-1]), (way.start, way.end)
    if target is not None and configurations:
        inputs = [math.radians(met.at) for met in design.targets]
        turned = inputs[0] + math.copysign(math.tau, inputs[-1] - inputs[0])
        end = turned if isinstance(problem, PathProblem) and problem.closed else inputs[-1]
        used = (min(start, end, *inputs), max(start, end, *inputs))
    lower, upper = motion.limits or (start, start + math.tau)
    assemblies = sorted(
        {driven.assembly, *(c.assembly for c in configurations)}, key=lambda sign: sign != driven.assembly
    )
    curve = _curve(linkage, *used, driven.assembly)
    rest = [_curve(linkage, lower, upper, sign) for sign in assemblies]
    kept = set(spread(len(demands), MARKED))
    shown = [demand for demand in demands if demand.index in kept]
    standing = [c for c in configurations if c.index in kept]
    return Scene(
        linkage, standing, shown, curve, rest, motion.limits, start, end, len(demands), len(configurations), target,
        stance_curve(problem),
    )  # fmt: skip


def spread(count: int, most: int) -> list[int]:
    """At most ``most`` of ``count`` places, evenly spread, with both ends.

    >>> spread(3, 5), spread(200, 5)
    ([0, 1, 2], [0, 50, 100, 149, 199])
    """
    if count <= most:
        return list(range(count))
    return sorted({round(k * (count - 1) / (most - 1)) for k in range(most)})


def _configurations(design: LinkageDesign, driven: DrivenFourbar, demands: list[Demand]) -> list[Configuration]:
    """The linkage at each target, in the assembly that meets it; without targets where it cannot be assembled."""
    toggles = toggle_angles(driven.linkage)
    reference = _assembled(driven.linkage, toggles, driven.reference, driven.assembly)
    if reference is None:
        return []
    first = demands[0]
    spread = max(abs(d.point - first.point) for d in demands)
    size = spread if spread > 0.0 else float(driven.linkage.coupler)
    configurations = []
    for target in design.targets:
        if not (0 <= target.index < len(demands) and math.isfinite(target.at)):
            continue
        demand = demands[target.index]
        choices = []
        for sign in (driven.assembly, -driven.assembly):
            at = _assembled(driven.linkage, toggles, math.radians(target.at), sign)
            if at is None:
                continue
            a, b, p, coupler_angle = at
            body_angle = (first.angle or 0.0) + coupler_angle - reference[3]
            miss = abs(p - demand.point) / size
            if demand.angle is not None:
                miss = max(miss, abs(math.remainder(body_angle - demand.angle, math.tau)))
            configuration = Configuration(
                target.index, math.radians(target.at), sign, sign == driven.assembly, a, b, p, body_angle
            )
            choices.append((miss > MEETS, not configuration.own, configuration))
        if choices:
            configurations.append(min(choices, key=lambda choice: choice[:2])[2])
    return configurations


def _assembled(
    linkage: Fourbar, toggles: Real, angle: float, assembly: int
) -> tuple[complex, complex, complex, float] | None:
    """A, B, P and coupler angle; None if it cannot close. An angle at a limit (``AT_LIMIT``) is moved inside it."""
    off = np.remainder(toggles - angle + np.pi, 2.0 * np.pi) - np.pi
    nearest = float(off[np.argmin(np.abs(off))]) if off.size else math.inf
    shifts = (0.0, nearest + INSIDE, nearest - INSIDE) if abs(nearest) < AT_LIMIT else (0.0,)
    for shift in shifts:
        at = positions(linkage, angle + shift, assembly)
        if at.valid:
            return complex(at.a), complex(at.b), complex(at.p), float(at.coupler_angle)
    return None


def _curve(linkage: Fourbar, start: float, end: float, assembly: int) -> Points:
    """P over a range of input angles, sampled densely near the ends (which may be toggles) and where P is fast."""
    share = 0.5 * (1.0 - np.cos(np.linspace(0.0, np.pi, CURVE_SAMPLES)))
    angles = start + (end - start) * share
    points = positions(linkage, angles, assembly).p
    for _ in range(REFINEMENTS):
        if np.all(np.isnan(points)):
            break
        long = np.flatnonzero(np.abs(np.diff(points)) > CURVE_STEP * Box.around(points).diagonal)
        if long.size == 0:
            break
        between = 0.5 * (angles[long] + angles[long + 1])
        angles = np.insert(angles, long + 1, between)
        points = np.insert(points, long + 1, positions(linkage, between, assembly).p)
    return points


def details(scene: Scene, whole: Box) -> list[Box]:
    """At most two parts of the mechanism that are too small to be read beside the rest, the most telling first."""
    first = scene.configurations[0] if scene.configurations else None
    demanded = [demand.point for demand in scene.demands] if scene.target is None else list(scene.target)
    groups = [(SMALL_MOTION, scene.moving()), (SMALL_PART, [*demanded, *(c.p for c in scene.configurations)])]
    if first is not None:
        cranks = [c.a for c in scene.configurations]
        groups += [
            (SMALL_PART, [first.a, first.b]),
            (SMALL_PART, [scene.o2, *cranks]),
            (SMALL_PART, [scene.o4, *(c.b for c in scene.configurations)]),
        ]
    groups.append((SMALL_PART, [scene.o2, scene.o4]))
    parts: list[Box] = []
    for share, points in groups:
        box = Box.around(np.array(points))
        small = 0.0 < box.diagonal < share * whole.diagonal
        seen = any(held.holds(box.centre) and box.diagonal > SMALL_PART * held.diagonal for held in parts)
        if small and not seen and len(parts) < 2:
            parts.append(box)
    return parts
