"""Content of a fourbar's drawing: configurations at the targets, the coupler curve, the input's range.

Everything is in mechanism coordinates; :mod:`service.render.linkage.fourbar_panel` draws it in a panel. All positions
come from the analysis core. If the mechanism's own assembly misses a target and the other assembly meets it, the target
is shown with the other assembly, so that a branch defect is visible.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from kinematics.arrays import Complex, Real
from kinematics.linkage.fourbar import Fourbar, find_toggle_angles, positions, traverse
from service.render.linkage.motion import Demand, DrivenLinkage, get_stance_curve, get_target_curve, list_demands
from service.render.page.svg import Box
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.kinds.path.curve.placement import place_problem
from synthesis.kinds.path.design import PathDesign
from synthesis.kinds.path.problem import PathProblem
from synthesis.model.linkage.answer import FourbarMechanism, LinkageDesign
from synthesis.model.linkage.conversion import DrivenFourbar, build_driven_fourbar

MISS_TOLERANCE = 1e-6
"""Maximum deviation with which a configuration meets a target: as a share of the task's size, and as an angle in
radians. It is far below visible deviations and far above rounding errors.
"""

LIMIT_TOLERANCE, LIMIT_SHIFT = 1e-6, 1e-9
"""Distance of an input angle from a limit up to which it counts as lying at the limit, and shift by which it is moved
inside, radians. The shift keeps a target at a toggle visible.
"""

CRANK_PATH_SAMPLES = 33
"""Number of points of the path of A, used only for its box."""

CURVE_SAMPLES = 121
"""Initial number of sample points on a coupler curve; more are added where it is fast."""

MAX_CURVE_STEP = 0.01
"""Longest step between sample points, as a share of the curve's extent."""

MAX_REFINEMENTS = 5
"""Maximum number of times that long steps are halved."""

MAX_GHOSTS = 9
"""Maximum number of pale linkages. With more targets, point tasks show none and position tasks a selection."""

MAX_TARGETS = 24
"""Maximum number of targets that are drawn and listed; more are thinned evenly, keeping first and last."""

SMALL_MOTION_SHARE, SMALL_PART_SHARE = 0.15, 0.04
"""Maximum size of the box of all moving joints, and of the box of a group of joints, as shares of the diagonal, for
which a detail is drawn.
"""

MAX_REST_SHARE = 0.25
"""Limit, as a share of the diagonal, by which the unused part of the curve enlarges the shown box on each side."""


@dataclass(frozen=True)
class Configuration:
    """The linkage at one target; ``own`` is False if it has the other assembly than at the first target."""

    index: int
    input_angle: float
    assembly: int
    own: bool
    a: complex
    b: complex
    p: complex
    body_angle: float


@dataclass(frozen=True)
class FourbarScene:
    """Content of one fourbar's drawing, in mechanism coordinates; angles in radians.

    ``configurations`` are those that can be assembled, by target. ``used`` and ``rest`` are polylines of P, with NaN
    where the linkage does not close: ``used`` over the input angles that the targets need, ``rest`` over the whole
    branch (and the other branch, if a target lies on it). ``limits`` are the ends of the input's range, None for a
    crank. ``start`` and ``end`` are the input angles at the first and the last target. ``target`` is the curve that is
    matched as a whole, if any; then only its first point is a target. ``stance`` holds the points of a stance.
    ``demanded`` counts all targets, ``demands`` are those that are drawn, and ``met`` counts those at which the linkage
    can be assembled.
    """

    linkage: Fourbar
    configurations: list[Configuration]
    demands: list[Demand]
    used: Complex
    rest: list[Complex]
    limits: tuple[float, float] | None
    start: float
    end: float
    demanded: int
    met: int
    target: Complex | None = None
    stance: Complex | None = None

    @property
    def guides_a_body(self) -> bool:
        """Whether angles are required, not only points."""
        return any(demand.angle is not None for demand in self.demands)

    @property
    def others(self) -> list[Configuration]:
        """Configurations that are drawn pale; none if they would hide the path of a point."""
        others = [c for c in self.configurations if c.index != 0]
        if len(others) <= MAX_GHOSTS:
            return others
        return [others[k] for k in select_indices(len(others), MAX_GHOSTS)] if self.guides_a_body else []

    @property
    def misses(self) -> bool:
        """Whether a required point is missed."""
        places = {demand.index: demand.point for demand in self.demands if demand.angle is None}
        size = max((abs(z - w) for z in places.values() for w in places.values()), default=0.0)
        return any(
            c.index in places and abs(c.p - places[c.index]) > MISS_TOLERANCE * size for c in self.configurations
        )

    @property
    def o2(self) -> complex:
        """Fixed pivot of the input."""
        return complex(self.linkage.input_pivot)

    @property
    def o4(self) -> complex:
        """Fixed pivot of the output."""
        return complex(self.linkage.output_pivot)

    def list_moving(self) -> list[complex]:
        """Return A, B and P at all targets, and the target points."""
        joints = [joint for c in self.configurations for joint in (c.a, c.b, c.p)]
        target = [] if self.target is None else list(self.target)
        return [*joints, *(demand.point for demand in self.demands), *target]

    def sample_crank_path(self) -> Complex:
        """Return a coarse path of A over the input's range."""
        start, end = self.limits or (0.0, math.tau)
        return np.asarray(positions(self.linkage, np.linspace(start, end, CRANK_PATH_SAMPLES)).a)

    def find_box(self) -> Box:
        """Return the box of the content: all joints and the used curve in full, the rest of the curve in part."""
        needed = Box.enclose(np.array([self.o2, self.o4, *self.list_moving(), *self.used]))
        widest = needed.grow(MAX_REST_SHARE * needed.diagonal)
        # Unused parts of the curve may enlarge the box only by a limited share.
        for curve in (*self.rest, self.sample_crank_path()):
            if not np.all(np.isnan(curve)):
                needed = needed.merge_with(Box.enclose(curve).merge_with(needed).intersect_with(widest))
        return needed


def get_fourbar(design: LinkageDesign) -> FourbarMechanism:
    """Return the fourbar of a design."""
    mechanism = design.mechanism
    assert isinstance(mechanism, FourbarMechanism)
    return mechanism


def build_scene(design: LinkageDesign, problem: MotionProblem | PathProblem, motion: DrivenLinkage) -> FourbarScene:
    """Build the content of a fourbar design with its motion and its problem."""
    driven = build_driven_fourbar(get_fourbar(design))
    linkage = driven.linkage
    if isinstance(problem, PathProblem) and isinstance(design, PathDesign):
        problem = place_problem(problem, design)
    target = get_target_curve(problem)
    # A curve that is matched as a whole has only its first point as a target.
    demands = list_demands(problem)[: None if target is None else 1]
    configurations = _find_configurations(design, driven, demands)
    start = end = driven.reference
    used = (start, end)
    if configurations:
        angles = np.array([c.input_angle for c in configurations])
        way = traverse(linkage, angles, np.array([c.assembly for c in configurations]))
        start, end, used = float(way.angles[0]), float(way.angles[-1]), (way.start, way.end)
    if target is not None and configurations:
        inputs = [math.radians(met.position) for met in design.targets]
        # A closed curve needs a full turn in the direction of the targets.
        turned = inputs[0] + math.copysign(math.tau, inputs[-1] - inputs[0])
        end = turned if isinstance(problem, PathProblem) and problem.closed else inputs[-1]
        used = (min(start, end, *inputs), max(start, end, *inputs))
    lower, upper = motion.limits or (start, start + math.tau)
    assemblies = sorted(
        {driven.assembly, *(c.assembly for c in configurations)}, key=lambda sign: sign != driven.assembly
    )
    curve = _sample_curve(linkage, *used, driven.assembly)
    rest = [_sample_curve(linkage, lower, upper, sign) for sign in assemblies]
    kept = set(select_indices(len(demands), MAX_TARGETS))
    shown = [demand for demand in demands if demand.index in kept]
    standing = [c for c in configurations if c.index in kept]
    return FourbarScene(
        linkage, standing, shown, curve, rest, motion.limits, start, end, len(demands), len(configurations), target,
        get_stance_curve(problem),
    )  # fmt: skip


def select_indices(count: int, most: int) -> list[int]:
    """Return at most ``most`` of ``count`` indices, evenly spread, including both ends.

    >>> select_indices(3, 5), select_indices(200, 5)
    ([0, 1, 2], [0, 50, 100, 149, 199])
    """
    if count <= most:
        return list(range(count))
    return sorted({round(k * (count - 1) / (most - 1)) for k in range(most)})


def _find_configurations(design: LinkageDesign, driven: DrivenFourbar, demands: list[Demand]) -> list[Configuration]:
    """Return the linkage at each target, in the assembly that meets it; targets without an assembly are left out."""
    toggles = find_toggle_angles(driven.linkage)
    reference = _assemble(driven.linkage, toggles, driven.reference, driven.assembly)
    if reference is None:
        return []
    first = demands[0]
    spread = max(abs(d.point - first.point) for d in demands)
    # One target has no extent: measure misses by the coupler's length.
    size = spread if spread > 0.0 else float(driven.linkage.coupler)
    configurations = []
    for target in design.targets:
        if not (0 <= target.index < len(demands) and math.isfinite(target.position)):
            continue
        # Try both assemblies; a hit beats a miss, then the mechanism's own assembly wins.
        demand = demands[target.index]
        choices = []
        for sign in (driven.assembly, -driven.assembly):
            at = _assemble(driven.linkage, toggles, math.radians(target.position), sign)
            if at is None:
                continue
            a, b, p, coupler_angle = at
            body_angle = (first.angle or 0.0) + coupler_angle - reference[3]
            miss = abs(p - demand.point) / size
            if demand.angle is not None:
                # Angles are compared modulo a full turn.
                miss = max(miss, abs(math.remainder(body_angle - demand.angle, math.tau)))
            configuration = Configuration(
                target.index, math.radians(target.position), sign, sign == driven.assembly, a, b, p, body_angle
            )
            choices.append((miss > MISS_TOLERANCE, not configuration.own, configuration))
        if choices:
            configurations.append(min(choices, key=lambda choice: choice[:2])[2])
    return configurations


def _assemble(
    linkage: Fourbar, toggles: Real, angle: float, assembly: int
) -> tuple[complex, complex, complex, float] | None:
    """Return A, B, P and the coupler angle at an input angle; None if the linkage cannot be assembled there.

    An angle within :data:`LIMIT_TOLERANCE` of a toggle is also tried slightly on either side of the toggle.
    """
    off = np.remainder(toggles - angle + np.pi, 2.0 * np.pi) - np.pi
    # Distance to the nearest toggle; cranks have none.
    nearest = float(off[np.argmin(np.abs(off))]) if off.size else math.inf
    shifts = (0.0, nearest + LIMIT_SHIFT, nearest - LIMIT_SHIFT) if abs(nearest) < LIMIT_TOLERANCE else (0.0,)
    for shift in shifts:
        at = positions(linkage, angle + shift, assembly)
        if at.valid:
            return complex(at.a), complex(at.b), complex(at.p), float(at.coupler_angle)
    return None


def _sample_curve(linkage: Fourbar, start: float, end: float, assembly: int) -> Complex:
    """Sample P over a range of input angles, densely near the ends (which may be toggles) and where P is fast."""
    # Cosine spacing is dense at both ends, where P is fastest near toggles.
    share = 0.5 * (1.0 - np.cos(np.linspace(0.0, np.pi, CURVE_SAMPLES)))
    angles = start + (end - start) * share
    points = positions(linkage, angles, assembly).p
    for _ in range(MAX_REFINEMENTS):
        if np.all(np.isnan(points)):
            break
        long = np.flatnonzero(np.abs(np.diff(points)) > MAX_CURVE_STEP * Box.enclose(points).diagonal)
        if long.size == 0:
            break
        # Halve every long step.
        between = 0.5 * (angles[long] + angles[long + 1])
        angles = np.insert(angles, long + 1, between)
        points = np.insert(points, long + 1, positions(linkage, between, assembly).p)
    return points


def find_details(scene: FourbarScene, whole: Box) -> list[Box]:
    """Return at most two parts of the mechanism that are too small to read in the whole, most informative first."""
    first = scene.configurations[0] if scene.configurations else None
    demanded = [demand.point for demand in scene.demands] if scene.target is None else list(scene.target)
    groups = [
        (SMALL_MOTION_SHARE, scene.list_moving()),
        (SMALL_PART_SHARE, [*demanded, *(c.p for c in scene.configurations)]),
    ]
    if first is not None:
        cranks = [c.a for c in scene.configurations]
        groups += [
            (SMALL_PART_SHARE, [first.a, first.b]),
            (SMALL_PART_SHARE, [scene.o2, *cranks]),
            (SMALL_PART_SHARE, [scene.o4, *(c.b for c in scene.configurations)]),
        ]
    groups.append((SMALL_PART_SHARE, [scene.o2, scene.o4]))
    parts: list[Box] = []
    for share, points in groups:
        box = Box.enclose(np.array(points))
        # Coincident points are no detail.
        small = 0.0 < box.diagonal < share * whole.diagonal
        # A detail inside another detail is not drawn again.
        seen = any(held.holds(box.centre) and box.diagonal > SMALL_PART_SHARE * held.diagonal for held in parts)
        if small and not seen and len(parts) < 2:
            parts.append(box)
    return parts
