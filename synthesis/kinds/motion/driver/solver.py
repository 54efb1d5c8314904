"""A driver dyad: a crank and a link that move a finished fourbar between its end positions (Norton, Sec. 3.4).

The driven link turns from the first position to the last. A pin C on it, at radius r from its fixed pivot O, moves from
C₁ to Cₙ. A crank-rocker with crank pivot O6 has its rocker's limits there if

    crank a = (|O6 Cₙ| − |O6 C₁|)/2,    link b = (|O6 Cₙ| + |O6 C₁|)/2  (or with C₁ and Cₙ exchanged),

because crank and link are collinear at both ends. So O6 is free in the plane; Norton's construction (Example 3-4)
places it on the chord, with a time ratio of 1. The stage's shape, in units of r, depends on O6 alone: shapes are ranked
by the minimum transmission angle, which occurs when the crank lies on the line O O6, and by their size. The direction
of C on the link and the radius r only rotate and scale the stage: they are chosen to make the whole small, or to place
O6 in the given region. If no ground link can be driven in this way, the coupler is driven instead
(:mod:`synthesis.kinds.motion.driver.coupler_driver`).
"""

from __future__ import annotations

import cmath
import math
from functools import partial
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Complex, Real
from kinematics.linkage.fourbar import positions
from kinematics.message import compose, join_messages
from synthesis.kinds.motion.design import MotionResult
from synthesis.kinds.motion.driver.coupler_driver import find_coupler_drivers
from synthesis.kinds.motion.driver.joints import SIZE_SCALE, build_rocker_driver, measure_diagonal
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.kinds.motion.statement.dyad_choices import DriverDyad
from synthesis.kinds.motion.verification.verify import verify
from synthesis.model.kind import Progress
from synthesis.model.linkage.answer import FourbarMechanism, LinkageDesign, SixbarMechanism
from synthesis.model.linkage.conversion import build_driven_fourbar, to_complex
from synthesis.results.candidate_log import OUTRANKED_REASON, CandidateLog, report_candidates
from synthesis.results.ranking import rank_designs
from synthesis.verification.measures import LINK_RATIO_SCALE, REACH_SCALE, list_link_lengths

MAX_SWING = math.radians(150.0)
"""Maximum swing, radians; a crank-rocker transmits larger ones badly, and 180° is impossible."""

MIN_SWING = 1e-3
"""Minimum swing, radians; a link that turns less needs no crank."""

PIVOT_DISTANCES = np.linspace(0.4, 5.0, 70)
PIVOT_DIRECTIONS = np.linspace(-np.pi, np.pi, 181)[:-1]
"""Grid of candidate positions of O6: distance from O in units of r, and direction from the middle of the swing."""

SHAPE_COUNT = 12
"""Number of best stage shapes that are tried on the linkage."""

ARM_RATIOS = np.array([0.4, 0.55, 0.75, 1.0, 1.35, 1.8])
"""Candidate values of r, relative to the length of the driven link."""

PIN_DIRECTIONS = np.linspace(-np.pi, np.pi, 49)[:-1]
"""Candidate directions of C on the driven link, radians from the line of its pins."""

USABLE_ANGLE = 20.0
"""Transmission angle, degrees; if the client sets no limit, sixbars below it are returned only if there are no
others."""

MAX_COUPLER_DRIVERS = 12
"""Maximum number of coupler drivers examined, best first."""

LENGTH_TOLERANCE = 1e-9
"""Relative tolerance of a length at its limit in this filter; the verification decides exactly."""

MAX_VERIFIED = 3
"""Maximum number of drivers verified per link, best first, until one passes."""

FOURBARS_PER_DESIGN = 4
"""Number of fourbars requested per design: some turn too far for a driver dyad."""

MIN_FOURBARS = 40
"""Minimum number of fourbars requested."""


class _Stage(NamedTuple):
    """Stage shapes in units of r, with O at 0 and the middle of the swing on the real axis: O6, crank, link, score."""

    pivot: Complex
    crank: Real
    link: Real
    score: Real


def add_driver_dyads(problem: MotionProblem, result: MotionResult, progress: Progress) -> MotionResult:
    """Add a driver dyad to each fourbar of a result and verify the sixbars."""
    request = problem.driver
    assert request is not None
    sifting = CandidateLog[LinkageDesign](problem)
    sifting.rejected.update(result.search.rejected)
    # Every accepted fourbar counts as outranked until a driver dyad is added to it.
    sifting.reject(OUTRANKED_REASON, result.search.accepted)
    usable: list[LinkageDesign] = []
    tried = 0
    for design in report_candidates(result.designs, progress, (0.9, 1.0), "motion-progress-adding-drivers"):
        if len(usable) == problem.max_designs:
            break
        tried += 1
        best = _add_best_driver(problem, design, request)
        # A linkage that can be driven from either side appears twice in the designs, but was accepted once.
        sifting.rejected[OUTRANKED_REASON] -= sifting.rejected[OUTRANKED_REASON] > 0
        # A failed driver is a rejection of this stage; the fourbar itself was good.
        kept = not sifting.insert_design(best)
        sifting.count("" if kept else "driver_dyad")
        if kept and _is_good_enough(problem, sifting.passed[-1]):
            usable.append(sifting.passed[-1])
    # Designs with poor transmission are returned only if there are no others.
    sifting.withdraw(usable or sifting.passed, OUTRANKED_REASON)
    given = compose("motion-drivers-added", accepted=sifting.accepted, fourbars=tried)
    return result.model_copy(
        update={
            "designs": sifting.select_designs(partial(rank_designs, rank_by=problem.rank_by)),
            "search": sifting.build_search(f"{result.search.method}, driver_dyad"),
            "summary": join_messages([given, result.summary]),
        }
    )


def remove_driver(problem: MotionProblem) -> MotionProblem:
    """Return the problem of the fourbar alone: pins on both sides, and no full rotation of its own input."""
    pins = {"dyad": "RR"}
    return problem.model_copy(
        update={
            "driver_dyad": False,
            # The driver dyad has the full rotation, so the fourbar's own input need not have it.
            "method": "auto" if problem.approximate or problem.has_few_tolerances else "exact",
            "max_designs": min(max(FOURBARS_PER_DESIGN * problem.max_designs, MIN_FOURBARS), 200),
            "include_failed": False,
            "layout": None,
            "input_side": problem.input_side.model_copy(update=pins),
            "output_side": problem.output_side.model_copy(update=pins),
            "constraints": problem.constraints.model_copy(update={"full_rotation": False}),
        }
    )


def _add_best_driver(
    problem: MotionProblem, design: LinkageDesign, request: DriverDyad, *, limited: bool = True
) -> LinkageDesign | None:
    """Return a fourbar with the best driver that passes, or else the best one that fails; None if no driver fits.

    Drivers that violate a limit themselves are tried only without ``limited``, or if failed designs are requested.
    """
    assert isinstance(design.mechanism, FourbarMechanism)
    best = None
    # Without the limit drivers that fail can still be shown on request.
    least = math.sin(math.radians(problem.constraints.min_transmission_angle or 0.0)) if limited else 0.0
    for link in ("input", "output", "coupler"):
        # The coupler is the last resort: it is tried only on request or if no ground link can be driven well.
        if request.link not in ("any", link) or (
            link == "coupler" and _is_good_enough(problem, best) and request.link == "any"
        ):
            continue
        if link == "coupler":
            drivers = find_coupler_drivers(design, design.mechanism, request, MAX_COUPLER_DRIVERS, least)
        else:
            drivers = sorted(_list_drivers(design, design.mechanism, link, request, least), key=lambda c: -c[0])
        # Only a few of the best are verified, because a verification costs far more than the whole grid.
        kept = [mechanism for _, mechanism in drivers if not limited or _is_within_lengths(problem, mechanism)]
        for mechanism in kept[:MAX_VERIFIED]:
            found = verify(problem, mechanism)
            if found is not None and (best is None or _get_rank(found) > _get_rank(best)):
                best = found
            if found is not None and found.verification.passed:
                break
    if best is None and limited and problem.include_failed:
        return _add_best_driver(problem, design, request, limited=False)
    return best


def _is_within_lengths(problem: MotionProblem, mechanism: SixbarMechanism) -> bool:
    """Return whether a sixbar's links satisfy the limits of lengths and link ratio, apart from rounding."""
    lengths, constraints = list_link_lengths(mechanism), problem.constraints
    length_limits, ratio = constraints.link_length, constraints.max_link_ratio
    # Without the client's own limit the transmission angle must at least be usable.
    short, long = min(lengths), max(lengths)
    within = length_limits is None or (
        short >= (1.0 - LENGTH_TOLERANCE) * length_limits.min
        and long <= (1.0 + LENGTH_TOLERANCE) * (length_limits.max or long)
    )
    return within and (ratio is None or long <= (1.0 + LENGTH_TOLERANCE) * ratio * short)


def _is_good_enough(problem: MotionProblem, design: LinkageDesign | None) -> bool:
    """Return whether a design with a driven ground link is good enough that the coupler is not tried."""
    least = USABLE_ANGLE if problem.constraints.min_transmission_angle is None else 0.0
    return design is not None and design.verification.passed and design.metrics.min_transmission_angle >= least


def _get_rank(design: LinkageDesign) -> tuple[bool, float]:
    return design.verification.passed, design.metrics.quality


def _list_drivers(
    design: LinkageDesign, mechanism: FourbarMechanism, link: str, request: DriverDyad, least: float
) -> list[tuple[float, SixbarMechanism]]:
    """List the drivers of one link with their scores, the best of each shape; ``least`` as for :func:`_list_stages`."""
    fourbar = build_driven_fourbar(mechanism)
    inputs = np.radians([target.position for target in design.targets])
    at = positions(fourbar.linkage, inputs, fourbar.assembly)
    if not at.valid.all():
        return []
    pivot = to_complex(mechanism.fixed_pivots.input if link == "input" else mechanism.fixed_pivots.output)
    arms = (at.a if link == "input" else at.b) - pivot
    turned = np.unwrap(np.angle(arms / arms[0]))
    steps = np.diff(turned)
    swing = float(turned[-1])
    # The driven link must turn in one direction only, otherwise a rocker's limits would not be its end positions.
    one_way = bool(np.all(steps > 0.0) or np.all(steps < 0.0))
    if not one_way or not MIN_SWING < abs(swing) <= MAX_SWING:
        return []
    stage = _list_stages(abs(swing), least)
    joints = np.concatenate([at.a, at.b, at.p, [to_complex(p) for p in (mechanism.fixed_pivots.input,
                                                                         mechanism.fixed_pivots.output)]])  # fmt: skip
    alone = measure_diagonal(joints)
    length = float(abs(arms[0]))
    middle = arms[0] / length * cmath.exp(0.5j * swing)
    found = []
    for n in range(len(stage.score)):
        # Shapes have their swing symmetrical about the real axis; C leads the link by an angle of PIN_DIRECTIONS.
        turn = middle * np.exp(1j * PIN_DIRECTIONS)[None, :] * (ARM_RATIOS * length)[:, None]
        o6 = pivot + stage.pivot[n] * turn
        c = pivot + turn[..., None] * np.exp(np.array([-0.5j, 0.5j]) * swing)
        around = np.stack([o6, c[..., 0], c[..., 1]], axis=-1)
        whole = measure_diagonal(
            np.concatenate([around, np.broadcast_to(joints, (*around.shape[:2], len(joints)))], axis=-1)
        )
        score = stage.score[n] / (1.0 + ((whole / alone - 1.0) / SIZE_SCALE) ** 2)
        if request.pivot_region is not None:
            score = np.where(request.pivot_region.mark_contained(o6), score, 0.0)
        k, m = np.unravel_index(int(np.argmax(score)), score.shape)
        if score[k, m] > 0.0:
            place = complex(c[k, m, 0])
            found.append((float(score[k, m]), build_rocker_driver(mechanism, link, place, complex(o6[k, m]), swing)))
    return found


def _list_stages(swing: float, least: float = 0.0) -> _Stage:
    """List the best shapes of crank-rockers with a given swing in radians, in units of the rocker.

    ``least`` is the minimum sine of the transmission angle.
    """
    pivot = (PIVOT_DISTANCES[:, None] * np.exp(1j * PIVOT_DIRECTIONS)[None, :]).ravel()
    ends = np.exp(np.array([-0.5j, 0.5j]) * swing)
    reach = ends - pivot[:, None]
    distance = np.abs(reach)
    crank, link, ground = 0.5 * np.abs(distance[:, 1] - distance[:, 0]), distance.mean(axis=1), np.abs(pivot)
    # Both ends belong to the same assembly if O lies on the same side of the link at both.
    sides = (np.conj(reach) * (0.0 - ends)).imag
    lengths = np.stack([crank, link, ground, np.ones_like(crank)])
    shortest, longest = lengths.min(axis=0), lengths.max(axis=0)
    # Grashof's condition with the crank as the shortest link; tiny cranks are no practical drivers.
    rocks = (crank == shortest) & (2.0 * (shortest + longest) < lengths.sum(axis=0)) & (crank > 0.02)
    rocks &= sides[:, 0] * sides[:, 1] > 0.0
    with np.errstate(divide="ignore", invalid="ignore"):
        # The transmission angle is extreme where the crank lies on the line of the fixed pivots, on either side.
        cosines = [(link**2 + 1.0 - (ground + sign * crank) ** 2) / (2.0 * link) for sign in (-1.0, 1.0)]
        sine = np.sqrt(np.maximum(1.0 - np.max(np.square(cosines), axis=0), 0.0))
        score = np.where(rocks & (sine >= least), sine, 0.0) / (
            (1.0 + (longest / REACH_SCALE) ** 2) * (1.0 + (longest / crank / LINK_RATIO_SCALE) ** 2)
        )
    order = np.argsort(-score, kind="stable")
    kept: list[int] = []
    for k in order:
        if len(kept) == SHAPE_COUNT or not score[k] > 0.0:
            break
        # Keep only clearly different shapes; the score varies slowly over the grid of O6.
        if all(abs(pivot[k] - pivot[m]) > 0.25 for m in kept):
            kept.append(int(k))
    return _Stage(pivot[kept], crank[kept], link[kept], score[kept])
