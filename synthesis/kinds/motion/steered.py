"""Two to four positions of which some have tolerances: linkages that use them to satisfy all demands.

Starts (:mod:`synthesis.kinds.motion.steered_starts`) meet poses that are drawn within the tolerances. Each is then made
to hold all demands at once (:mod:`synthesis.kinds.motion.steered_rows`), every position within its tolerance, and is
driven and verified like any other. Positions without a tolerance are held to rounding.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from functools import partial
from typing import NamedTuple

import numpy as np

from kinematics.linkage.fourbar import positions
from synthesis.kinds.motion.areas import box_of, side_areas
from synthesis.kinds.motion.demanded import Demanded, demanded
from synthesis.kinds.motion.design import MotionResult
from synthesis.kinds.motion.least_squares import fit_demands
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.kinds.motion.screening import SHORTEST_LINK
from synthesis.kinds.motion.steered_rows import (
    ASSEMBLY,
    BOXES,
    COSINE,
    DIRECTION,
    GIVEN,
    HOME,
    LINE,
    LINKS,
    OTHERS,
    PIVOTS,
    RATIO,
    SHORTEST,
    STEPS,
    WEIGHT_OF_HOME,
    equations,
    limits,
    steered_rows,
)
from synthesis.kinds.motion.steered_starts import Start, starts, stated_coordinates
from synthesis.kinds.motion.task import MotionTask, Real, motion_task
from synthesis.kinds.motion.verification import verify
from synthesis.model.kind import Progress
from synthesis.model.linkage_answer import FourbarMechanism, LinkageDesign, LinkageMechanism
from synthesis.model.linkages import FourbarConfiguration, body_shift, driven_fourbar, fourbar_mechanism
from synthesis.numerics.augmented_lagrangian import MAX_ROUNDS, MAX_STEPS, hold
from synthesis.numerics.portions import in_portions
from synthesis.numerics.status import Status
from synthesis.outcome.ranking import distinct, ranked
from synthesis.outcome.sifting import DEFECTS, LENGTHS, OUTRANKED, Sifting

STARTED, BETTERED = 40, 8
"""Linkages that are steered, staying near to their starts; and those of them, as many as differ, that are then brought
to where they are most usable."""

ROOMY = 4
"""Times as many are steered where obstacles, which do not steer, leave only some of them."""

STAYING = 0.3
"""Weight of the way from the start, in task sizes, in the first of these."""

WEIGHT = 10.0
"""Weight of limits in the first descent."""

SAME_LINKAGE = 0.02
"""Linkages whose joints differ by less than this share of the task's size are one answer; the better is kept."""

LEAST_ANGLE = 2.0
"""Degrees of transmission angle that are aimed at where the client sets no limit: away from toggles."""

_SHORTEST = {"double_crank": 0, "crank_rocker": 1, "double_rocker": 2}
"""The shortest link, in the order d, a, b, c, of classes of fourbars."""

REASONS = DEFECTS | LENGTHS | {"within_tolerance": "tolerance"}
"""Why a design was rejected, by the check that it failed; other checks go by their own name."""


def solve_steered(problem: MotionProblem, exact: MotionResult, progress: Progress) -> MotionResult:
    """Designs that use the tolerances, beside those that meet the positions exactly.

    Parameters
    ----------
    problem : MotionProblem
        Two to four positions.
    exact : MotionResult
        The answer with all positions met exactly.
    progress : callable
        Told how far the work is.
    """
    task = motion_task(problem)
    rows = _demanded_rows(problem, task)
    progress(0.0, "drawing poses within the tolerances")
    room = problem.space is not None and problem.space.swept
    listed = starts(problem, task, rows[:, 3:], STARTED * (ROOMY if room else 1))
    progress(0.4, f"steering {len(listed)} linkages")
    begun = [_begun(problem, task, rows, start) for start in listed]
    steered = _all_steered(rows, begun)
    sifting = Sifting[LinkageDesign](problem, REASONS)
    sifting.join(exact.search)
    sifting.passed = [design for design in exact.designs if design.verification.passed]
    sifting.failed = [design for design in exact.designs if not design.verification.passed]
    met = len(sifting.passed)
    different = _different(steered)
    let_go = [_let_go(linkage) for linkage in different[:BETTERED]]
    bettered = _all_steered(rows, let_go)
    offered = _different([*bettered, *different])
    sifting.reject("not_steered", len(begun) - len(steered) + len(let_go) - len(bettered))
    sifting.reject(OUTRANKED, len(steered) + len(bettered) - len(offered))
    progress(0.8, f"verifying {len(offered)} linkages")
    target = demanded(problem)
    sifting.sift(offered, lambda linkage: _verified(problem, task, rows, linkage.x, target))
    progress(1.0, "verified")
    return MotionResult(
        designs=sifting.designs(partial(ranked, rank_by=problem.rank_by)),
        curves=exact.curves,
        search=sifting.search("tolerance_search"),
        summary=_summary(sifting, len(listed), len(sifting.passed) - met, met),
    )


def steered_on(problem: MotionProblem, designs: Sequence[LinkageDesign]) -> list[LinkageDesign]:
    """Designs of a statement, steered on from those of a looser one; sixbars without their drivers."""
    task, target = motion_task(problem), demanded(problem)
    rows = _demanded_rows(problem, task)
    bare = (verify(problem, _fourbar_of(design.mechanism), target) for design in designs[:BETTERED])
    begun = [_let_go(_begun(problem, task, rows, _start_of(problem, task, rows, one))) for one in bare if one]
    verified = (_verified(problem, task, rows, linkage.x, target) for linkage in _different(_all_steered(rows, begun)))
    return [design for design in verified if isinstance(design, LinkageDesign) and design.verification.passed]


def _demanded_rows(problem: MotionProblem, task: MotionTask) -> Real:
    """Demanded poses and their tolerances as :func:`~synthesis.kinds.motion.steered_rows.steered_rows` takes them."""
    points = np.stack([task.points.real, task.points.imag, np.angle(task.turns)], axis=1)
    return np.ascontiguousarray(np.concatenate([points, fit_demands(problem, task).tolerances], axis=1))


def _fourbar_of(mechanism: LinkageMechanism) -> FourbarMechanism:
    """The fourbar of a linkage that is one, or that is one with a driver."""
    if isinstance(mechanism, FourbarMechanism):
        return mechanism
    joints = (complex(*mechanism.skeleton.joints[name]) for name in ("O2", "A", "B", "O4", "P"))
    return fourbar_mechanism(FourbarConfiguration(*joints), mechanism.reference_body_angle)


def _start_of(problem: MotionProblem, task: MotionTask, rows: Real, design: LinkageDesign) -> Start:
    """A driven fourbar as a start, with the poses in which it meets its targets."""
    assert isinstance(design.mechanism, FourbarMechanism)
    fourbar = driven_fourbar(design.mechanism)
    at = positions(fourbar.linkage, np.radians([target.at for target in design.targets]), fourbar.assembly)
    shift = body_shift(design.mechanism, problem.positions[0].angle)
    first = float(positions(fourbar.linkage, fourbar.reference, fourbar.assembly).coupler_angle)
    places = (at.p - task.origin) / task.size
    off = at.coupler_angle - first + shift - rows[:, 2]
    offsets = np.stack([places.real - rows[:, 0], places.imag - rows[:, 1], off - math.tau * np.round(off / math.tau)])
    poses = rows[:, :3] + offsets.T
    shares = np.divide(offsets.T, rows[:, 3:], out=np.zeros_like(poses), where=rows[:, 3:] > 0.0)
    fixed = [task.to_task(complex(pivot)) for pivot in (fourbar.linkage.input_pivot, fourbar.linkage.output_pivot)]
    back = cmath.exp(-1j * float(poses[0, 2]))
    body = [task.points[0] + back * (pin[0] - at.p[0]) / task.size for pin in (at.a, at.b)]
    return Start(np.array([*fixed, *body]), shares, poses)


class _Linkage(NamedTuple):
    """A linkage on its way: unknowns, and its setting (:mod:`synthesis.kinds.motion.steered_rows`)."""

    x: Real
    setting: Real


def _begun(problem: MotionProblem, task: MotionTask, rows: Real, start: Start) -> _Linkage:
    """A start, which is to stay near to where it is."""
    pivots = np.ascontiguousarray(start.pivots).view(np.float64)
    setting = _setting(problem, task, start)
    setting[HOME : HOME + PIVOTS], setting[WEIGHT_OF_HOME] = pivots, STAYING
    return _Linkage(np.concatenate([pivots, start.deviations[rows[:, 3:] > 0.0]]), setting)


def _let_go(linkage: _Linkage) -> _Linkage:
    """The same, free to go where it is most usable."""
    setting = linkage.setting.copy()
    setting[WEIGHT_OF_HOME] = 0.0
    return linkage._replace(setting=setting)


def _all_steered(rows: Real, begun: list[_Linkage]) -> list[_Linkage]:
    """Linkages brought to where all demands hold, without those that cannot be."""
    n = len(rows)
    ended: list[_Linkage | None] = [None] * len(begun)

    def steered(linkage: _Linkage) -> _Linkage | None:
        x, state, cost = linkage.x.copy(), np.zeros(limits(n)), np.empty(1)
        most = len(x) + OTHERS + limits(n)
        status = hold(
            steered_rows, x, rows, linkage.setting, state, most, limits(n), equations(n), WEIGHT, MAX_ROUNDS, MAX_STEPS,
            cost,
        )  # fmt: skip
        if status in (Status.IMPOSSIBLE, Status.INFEASIBLE) or not math.isfinite(cost[0]):
            return None
        return _Linkage(x, linkage.setting)

    def work(some: slice) -> None:
        ended[some] = [steered(linkage) for linkage in begun[some]]

    in_portions(work, len(begun), 1)
    return [linkage for linkage in ended if linkage is not None]


def _setting(problem: MotionProblem, task: MotionTask, start: Start) -> Real:
    """The demands as numbers, and what a start decides: which way the input turns, and in which assembly."""
    constraints = problem.constraints
    n = len(start.poses)
    setting = np.full(STEPS + n - 1, math.inf)
    o2, o4, a, b = (complex(z) for z in start.pivots)
    spins = np.exp(1j * start.poses[:, 2])
    places = start.poses[:, 0] + 1j * start.poses[:, 1]
    pins = places + spins * (a - task.points[0])
    others = places + spins * (b - task.points[0])
    turned = np.angle((pins - o2) / (pins[0] - o2))
    onward, backward = np.mod(turned, math.tau), -np.mod(-turned, math.tau)
    rises, falls = bool(np.all(np.diff(onward) > 0.0)), bool(np.all(np.diff(backward) < 0.0))
    forward = rises and not (falls and -backward[-1] < onward[-1])
    setting[DIRECTION] = 1.0 if forward else -1.0
    setting[STEPS:] = np.diff(onward if forward else backward)
    setting[ASSEMBLY] = math.copysign(1.0, float(((others - pins)[0].conjugate() * (others[0] - o4)).imag))
    setting[SHORTEST] = _SHORTEST.get(constraints.grashof, -1)
    if constraints.full_rotation and setting[SHORTEST] < 0:
        setting[SHORTEST] = 0 if abs(o4 - o2) < abs(pins[0] - o2) else 1
    setting[COSINE] = math.cos(math.radians(max(constraints.min_transmission_angle or 0.0, LEAST_ANGLE)))
    lengths = constraints.link_length
    setting[LINKS] = 0.0 if lengths is None else lengths.min / task.size
    setting[LINKS + 1] = math.inf if lengths is None or lengths.max is None else lengths.max / task.size
    setting[RATIO] = math.inf if constraints.max_link_ratio is None else constraints.max_link_ratio
    one, other = side_areas(problem)
    for k, areas in enumerate((one.fixed, other.fixed, one.moving, other.moving)):
        setting[BOXES + 4 * k : BOXES + 4 * (k + 1)] = box_of(task, areas, complex(start.pivots[k]))
    setting[GIVEN : GIVEN + PIVOTS] = stated_coordinates(task, problem)
    setting[LINE : LINE + 3] = math.nan
    if problem.ground_line is not None:
        normal = 1j * cmath.rect(1.0, math.radians(problem.ground_line.angle))
        offset = -problem.ground_line.offset(task.origin) / task.size
        setting[LINE : LINE + 3] = normal.real, normal.imag, offset
    return setting


def _different(held: list[_Linkage]) -> list[_Linkage]:
    """Linkages that differ, in the order in which they come."""
    if not held:
        return []
    joints = np.array([linkage.x[:PIVOTS] for linkage in held]).view(np.complex128)
    return [held[k] for k in distinct(joints, len(held), SAME_LINKAGE)]


def _verified(
    problem: MotionProblem, task: MotionTask, rows: Real, x: Real, target: Demanded
) -> LinkageDesign | str | None:
    """The linkage of steered unknowns, driven; either way round where both sides are stated alike."""
    pose = rows[0, :3].copy()
    free = rows[0, 3:] > 0.0
    pose[free] += rows[0, 3:][free] * x[PIVOTS : PIVOTS + int(free.sum())]
    place, spin = complex(pose[0], pose[1]), cmath.exp(1j * float(pose[2]))
    o2, o4, a, b = (complex(z) for z in np.ascontiguousarray(x[:PIVOTS]).view(np.complex128))
    o2, o4 = task.pivot(problem.input_side.fixed_pivot, o2), task.pivot(problem.output_side.fixed_pivot, o4)
    a, b = (task.to_problem(place + spin * (z - complex(task.points[0]))) for z in (a, b))
    joints = FourbarConfiguration(o2, a, b, o4, task.to_problem(place))
    if not joints.has_no_link_below(SHORTEST_LINK):
        return "degenerate"
    angle = problem.positions[0].angle + math.degrees(float(pose[2])) if free[2] else None
    return verify(problem, fourbar_mechanism(joints, angle), target)


def _summary(sifting: Sifting[LinkageDesign], started: int, steered: int, exact: int) -> str:
    if not sifting.passed:
        return (
            f"None of {started} linkages that were steered into the tolerances and demands satisfies them all "
            f"(rejected: {sifting.listed(OUTRANKED) or 'none'}). A linkage may exist that the search did not meet."
        )
    best = max(design.metrics.min_transmission_angle for design in sifting.passed)
    return (
        f"{steered} linkages that were steered into the tolerances from {started} starts satisfy all demands, and "
        f"{exact} that meet the positions exactly; the least transmission angle is up to {best:.1f}°. The tolerances "
        "were searched from poses drawn within them; a better linkage may exist."
    )
