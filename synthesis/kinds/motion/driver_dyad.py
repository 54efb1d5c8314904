"""A driver dyad: a crank and a link that move a finished fourbar between its end positions (Norton, Sec. 3.4).

The driven link turns from the first position to the last. A pin C on it, at radius r from its fixed pivot O, moves from
C₁ to Cₙ. A crank-rocker with crank pivot O6 has its rocker's limits there if

    crank a = (|O6 Cₙ| − |O6 C₁|)/2,    link b = (|O6 Cₙ| + |O6 C₁|)/2  (or with C₁ and Cₙ exchanged),

because crank and link are collinear at both ends. So O6 is free in the plane; Norton's construction (Example 3-4)
places it on the chord, with a time ratio of 1. The stage's shape, in units of r, depends on O6 alone: shapes are ranked
by the minimum transmission angle, which occurs when the crank lies on the line O O6, and by their size. The direction
of C on the link and the radius r only rotate and scale the stage: they are chosen to make the whole small, or to place
O6 in the given region. If no ground link can be driven in this way, the coupler is (:mod:`coupler_driver`).
"""

from __future__ import annotations

import cmath
import math
from functools import partial
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.linkage.fourbar import positions
from synthesis.kinds.motion.coupler_driver import coupler_drivers
from synthesis.kinds.motion.design import MotionResult
from synthesis.kinds.motion.driver_joints import ROOM, diagonal, rocker_driven
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.kinds.motion.stated_dyads import DriverDyad
from synthesis.kinds.motion.verification import verify
from synthesis.model.counting import agreeing, counted, grouped
from synthesis.model.kind import Progress
from synthesis.model.linkage_answer import FourbarMechanism, LinkageDesign, SixbarMechanism
from synthesis.model.linkages import driven_fourbar, to_complex
from synthesis.outcome.ranking import ranked
from synthesis.outcome.sifting import OUTRANKED, Sifting, reported
from synthesis.proof.measures import BULKY, UNEVEN, link_lengths

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

WIDEST_SWING = math.radians(150.0)
"""Maximum swing, radians; a crank-rocker transmits larger ones badly, and 180° is impossible."""

LEAST_SWING = 1e-3
"""Minimum swing, radians; a link that turns less needs no crank."""

DISTANCES = np.linspace(0.4, 5.0, 70)
DIRECTIONS = np.linspace(-np.pi, np.pi, 181)[:-1]
"""Grid of candidate positions of O6: distance from O in units of r, and direction from the middle of the swing."""

SHAPES = 12
"""Number of best stage shapes that are tried on the linkage."""

ARMS = np.array([0.4, 0.55, 0.75, 1.0, 1.35, 1.8])
"""Candidate values of r, relative to the length of the driven link."""

PLACES = np.linspace(-np.pi, np.pi, 49)[:-1]
"""Candidate directions of C on the driven link, radians from the line of its pins."""

USABLE = 20.0
"""Transmission angle, degrees; if the client sets no limit, sixbars below it are returned only if there are no
others."""

LOOKED_AT = 12
"""Maximum number of coupler drivers examined, best first."""

ROUNDING = 1e-9
"""Relative tolerance of a length at its limit in this filter; the verification decides exactly."""

TRIED = 3
"""Maximum number of drivers verified per link, best first, until one passes."""

SPARE = 4
"""Number of fourbars requested per design: some turn too far for a driver dyad."""

LEAST_SPARE = 40
"""Minimum number of fourbars requested."""


class _Stage(NamedTuple):
    """Stage shapes in units of r, with O at 0 and the middle of the swing on the real axis: O6, crank, link, score."""

    pivot: Complex
    crank: Real
    link: Real
    score: Real


def with_driver_dyads(problem: MotionProblem, result: MotionResult, progress: Progress) -> MotionResult:
    """Add a driver dyad to each fourbar of a result and verify the sixbars."""
    wanted = problem.driver
    assert wanted is not None
    sifting = Sifting[LinkageDesign](problem)
    sifting.rejected.update(result.search.rejected)
    sifting.reject(OUTRANKED, result.search.accepted)
    usable: list[LinkageDesign] = []
    tried = 0
    for design in reported(result.designs, progress, (0.9, 1.0), "adding driver dyads"):
        if len(usable) == problem.max_designs:
            break
        tried += 1
        best = _driven(problem, design, wanted)
        # A linkage that can be driven from either side appears twice in the designs, but was accepted once.
        sifting.rejected[OUTRANKED] -= sifting.rejected[OUTRANKED] > 0
        kept = not sifting.keep(best)
        sifting.count("" if kept else "driver_dyad")
        if kept and _sound(problem, sifting.passed[-1]):
            usable.append(sifting.passed[-1])
    # Designs with poor transmission are returned only if there are no others.
    sifting.withdraw(usable or sifting.passed, OUTRANKED)
    were = agreeing(sifting.accepted, "was", "were")
    of = f"{grouped(sifting.accepted)} of {counted(tried, 'fourbar')}"
    given = f"{of} {were} given a driver dyad with a fully rotating crank."
    return result.model_copy(
        update={
            "designs": sifting.designs(partial(ranked, rank_by=problem.rank_by)),
            "search": sifting.search(f"{result.search.method}, driver_dyad"),
            "summary": f"{given} {result.summary}",
        }
    )


def undriven(problem: MotionProblem) -> MotionProblem:
    """Return the problem of the fourbar alone: pins on both sides, and no full rotation of its own input."""
    pins = {"dyad": "RR"}
    return problem.model_copy(
        update={
            "driver_dyad": False,
            "method": "auto" if problem.approximate or problem.few_tolerated else "exact",
            "max_designs": min(max(SPARE * problem.max_designs, LEAST_SPARE), 200),
            "include_failed": False,
            "layout": None,
            "input_side": problem.input_side.model_copy(update=pins),
            "output_side": problem.output_side.model_copy(update=pins),
            "constraints": problem.constraints.model_copy(update={"full_rotation": False}),
        }
    )


def _driven(
    problem: MotionProblem, design: LinkageDesign, wanted: DriverDyad, *, limited: bool = True
) -> LinkageDesign | None:
    """Return a fourbar with the best driver that passes, or else the best one that fails; None if no driver fits.

    Drivers that violate a limit themselves are tried only without ``limited``, or if failed designs are requested.
    """
    assert isinstance(design.mechanism, FourbarMechanism)
    best = None
    least = math.sin(math.radians(problem.constraints.min_transmission_angle or 0.0)) if limited else 0.0
    for link in ("input", "output", "coupler"):
        # The coupler is the last resort: it is tried only on request or if no ground link can be driven well.
        if wanted.link not in ("any", link) or (link == "coupler" and _sound(problem, best) and wanted.link == "any"):
            continue
        if link == "coupler":
            drivers = coupler_drivers(design, design.mechanism, wanted, LOOKED_AT, least)
        else:
            drivers = sorted(_drivers(design, design.mechanism, link, wanted, least), key=lambda c: -c[0])
        kept = [mechanism for _, mechanism in drivers if not limited or _keeps_lengths(problem, mechanism)]
        for mechanism in kept[:TRIED]:
            found = verify(problem, mechanism)
            if found is not None and (best is None or _worth(found) > _worth(best)):
                best = found
            if found is not None and found.verification.passed:
                break
    if best is None and limited and problem.include_failed:
        return _driven(problem, design, wanted, limited=False)
    return best


def _keeps_lengths(problem: MotionProblem, mechanism: SixbarMechanism) -> bool:
    """Return whether a sixbar's links satisfy the limits of lengths and link ratio, apart from rounding."""
    lengths, constraints = link_lengths(mechanism), problem.constraints
    stated, ratio = constraints.link_length, constraints.max_link_ratio
    short, long = min(lengths), max(lengths)
    within = stated is None or (
        short >= (1.0 - ROUNDING) * stated.min and long <= (1.0 + ROUNDING) * (stated.max or long)
    )
    return within and (ratio is None or long <= (1.0 + ROUNDING) * ratio * short)


def _sound(problem: MotionProblem, design: LinkageDesign | None) -> bool:
    """Return whether a design with a driven ground link is good enough that the coupler is not tried."""
    least = USABLE if problem.constraints.min_transmission_angle is None else 0.0
    return design is not None and design.verification.passed and design.metrics.min_transmission_angle >= least


def _worth(design: LinkageDesign) -> tuple[bool, float]:
    return design.verification.passed, design.metrics.quality


def _drivers(
    design: LinkageDesign, mechanism: FourbarMechanism, link: str, wanted: DriverDyad, least: float
) -> list[tuple[float, SixbarMechanism]]:
    """List the drivers of one link with their scores, the best of each shape; ``least`` as for :func:`_stages`."""
    fourbar = driven_fourbar(mechanism)
    inputs = np.radians([target.at for target in design.targets])
    at = positions(fourbar.linkage, inputs, fourbar.assembly)
    if not at.valid.all():
        return []
    pivot = to_complex(mechanism.fixed_pivots.input if link == "input" else mechanism.fixed_pivots.output)
    arms = (at.a if link == "input" else at.b) - pivot
    turned = np.unwrap(np.angle(arms / arms[0]))
    steps = np.diff(turned)
    swing = float(turned[-1])
    one_way = bool(np.all(steps > 0.0) or np.all(steps < 0.0))
    if not one_way or not LEAST_SWING < abs(swing) <= WIDEST_SWING:
        return []
    stage = _stages(abs(swing), least)
    joints = np.concatenate([at.a, at.b, at.p, [to_complex(p) for p in (mechanism.fixed_pivots.input,
                                                                         mechanism.fixed_pivots.output)]])  # fmt: skip
    alone = diagonal(joints)
    length = float(abs(arms[0]))
    middle = arms[0] / length * cmath.exp(0.5j * swing)
    found = []
    for n in range(len(stage.score)):
        # Shapes have their swing symmetrical about the real axis; C leads the link by an angle of PLACES.
        turn = middle * np.exp(1j * PLACES)[None, :] * (ARMS * length)[:, None]
        o6 = pivot + stage.pivot[n] * turn
        c = pivot + turn[..., None] * np.exp(np.array([-0.5j, 0.5j]) * swing)
        around = np.stack([o6, c[..., 0], c[..., 1]], axis=-1)
        whole = diagonal(np.concatenate([around, np.broadcast_to(joints, (*around.shape[:2], len(joints)))], axis=-1))
        score = stage.score[n] / (1.0 + ((whole / alone - 1.0) / ROOM) ** 2)
        if wanted.pivot_region is not None:
            score = np.where(wanted.pivot_region.contains_each(o6), score, 0.0)
        k, m = np.unravel_index(int(np.argmax(score)), score.shape)
        if score[k, m] > 0.0:
            place = complex(c[k, m, 0])
            found.append((float(score[k, m]), rocker_driven(mechanism, link, place, complex(o6[k, m]), swing)))
    return found


def _stages(swing: float, least: float = 0.0) -> _Stage:
    """List the best shapes of crank-rockers with a given swing in radians, in units of the rocker.

    ``least`` is the minimum sine of the transmission angle.
    """
    pivot = (DISTANCES[:, None] * np.exp(1j * DIRECTIONS)[None, :]).ravel()
    ends = np.exp(np.array([-0.5j, 0.5j]) * swing)
    reach = ends - pivot[:, None]
    distance = np.abs(reach)
    crank, link, ground = 0.5 * np.abs(distance[:, 1] - distance[:, 0]), distance.mean(axis=1), np.abs(pivot)
    # Both ends belong to the same assembly if O lies on the same side of the link at both.
    sides = (np.conj(reach) * (0.0 - ends)).imag
    lengths = np.stack([crank, link, ground, np.ones_like(crank)])
    shortest, longest = lengths.min(axis=0), lengths.max(axis=0)
    rocks = (crank == shortest) & (2.0 * (shortest + longest) < lengths.sum(axis=0)) & (crank > 0.02)
    rocks &= sides[:, 0] * sides[:, 1] > 0.0
    with np.errstate(divide="ignore", invalid="ignore"):
        cosines = [(link**2 + 1.0 - (ground + sign * crank) ** 2) / (2.0 * link) for sign in (-1.0, 1.0)]
        sine = np.sqrt(np.maximum(1.0 - np.max(np.square(cosines), axis=0), 0.0))
        score = np.where(rocks & (sine >= least), sine, 0.0) / (
            (1.0 + (longest / BULKY) ** 2) * (1.0 + (longest / crank / UNEVEN) ** 2)
        )
    order = np.argsort(-score, kind="stable")
    kept: list[int] = []
    for k in order:
        if len(kept) == SHAPES or not score[k] > 0.0:
            break
        # Keep only clearly different shapes; the score varies slowly over the grid of O6.
        if all(abs(pivot[k] - pivot[m]) > 0.25 for m in kept):
            kept.append(int(k))
    return _Stage(pivot[kept], crank[kept], link[kept], score[kept])
