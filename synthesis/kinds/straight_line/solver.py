"""Straight-line mechanisms: find the narrowest or most even of each type, place them on the line, and verify them."""

from __future__ import annotations

import cmath
import math
from functools import partial
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.linkage.planar.mechanism import GROUND
from synthesis.kinds.straight_line.design import ExactLineMechanism, StraightLineDesign, StraightLineResult
from synthesis.kinds.straight_line.exact import ExactLine, hart, peaucellier, scott_russell
from synthesis.kinds.straight_line.families import (
    FOURBARS,
    NORTON,
    SAMPLES,
    Family,
    LineLimits,
    chebyshev_nodes,
    configuration,
    values_of,
)
from synthesis.kinds.straight_line.problem import LineMechanism, StraightLineProblem
from synthesis.kinds.straight_line.verification import verify_straight_line
from synthesis.model.counting import counted
from synthesis.model.kind import Progress
from synthesis.model.linkage_answer import FourbarMechanism
from synthesis.model.linkages import FourbarConfiguration, fourbar_mechanism, skeleton, slide, to_point
from synthesis.numerics.narrowing import merits, narrowest
from synthesis.outcome.ranking import ranked
from synthesis.outcome.sifting import Sifting

Real = NDArray[np.float64]

LINK_RATIO = 5.0
"""Default maximum of the longest link over the shortest of a fourbar: several families grow ever straighter with more
uneven links."""

TRANSMISSION = 20.0
"""Default minimum transmission angle along the line, degrees; at a toggle P runs fast and far."""

STRAIGHT = 0.01
"""Default width of the strip that must contain the line while its velocity is made even, as a share of its length; for
Hoeken's linkages it is the width of Norton's family at its most even."""

DRAWN = 160
"""Number of random proportions in a family's bounds, of which the best is improved next to the classical ones."""

COARSER, NEARLY = 4, 1e-2
"""A first descent uses every fourth sample, and ends when a step gains less than this share."""

KEPT = 0.98
"""Share of a required deviation that is used: between two samples P is somewhat farther off."""

SAME_DESIGN = 1e-4
"""Designs whose joints agree to this share of the length are duplicates."""

SLACK = 1e-6
"""Maximum violation of a constraint after the search; verification decides."""

ROUNDING = 1e-9
"""Straightness errors and velocity variations, per cent, below this are rounding."""

EXACT = {"peaucellier": peaucellier, "hart": hart, "scott_russell": scott_russell}
"""Sizing functions of the exact types."""

Proportions = Literal["optimal", "classical", "exact"]


class _PlacedMechanism(NamedTuple):
    """Joints of a mechanism at the start of its range: P begins at 0 and runs to ``length`` along +x, input ccw.

    ``exact`` is the mechanism of an exact line in its own frame, None for a fourbar.
    """

    family: LineMechanism
    proportions: Proportions
    joints: dict[str, complex]
    exact: ExactLine | None = None


def solve_straight_line(problem: StraightLineProblem, progress: Progress) -> StraightLineResult:
    """Solve a problem of a straight line."""
    sifting = Sifting[StraightLineDesign](problem)
    types = problem.types
    for n, name in enumerate(types):
        progress(n / len(types), f"searching {name.replace('_', ' ')} linkages")
        candidates = _exact(problem, name) if name in EXACT else _fourbars(problem, name)
        # Counts as one rejected candidate, so that the summary explains a missing type.
        sifting.reject("no_such_linkage", not candidates)
        sifting.sift(candidates, partial(_best_side, problem))
    progress(1.0, "verified")
    return StraightLineResult(
        designs=sifting.designs(partial(_ranked, problem)),
        search=sifting.search("sequential linear programming in each family; exact mechanisms by their dimensions"),
        summary=_summary(problem, sifting),
    )


def warm_up() -> None:
    """Compile or load the kernels: one fourbar, and one mechanism of each exact type."""
    for name in ("hoeken", *EXACT):
        problem = StraightLineProblem(kind="straight_line", length=1.0, crank_range=60.0, mechanism=name)
        solve_straight_line(problem, lambda fraction, message: None)


def _ranked(problem: StraightLineProblem, designs: list[StraightLineDesign]) -> list[StraightLineDesign]:
    """Rank designs by the optimized measure; widths and variations at the level of rounding count as equal."""

    def optimized(design: StraightLineDesign) -> float:
        metrics = design.metrics
        own = metrics.straightness_error if problem.optimize == "straightness" else metrics.velocity_variation
        return max(own, ROUNDING)

    def straightness(design: StraightLineDesign) -> float:
        return max(design.metrics.straightness_error, ROUNDING)

    return ranked(designs, problem.rank_by, {"quality": optimized, "accuracy": straightness})


def _fourbars(problem: StraightLineProblem, name: LineMechanism) -> list[_PlacedMechanism]:
    """Return the best of a family of fourbars, and the one of classical proportions."""
    family = FOURBARS[name]
    constraints = problem.constraints
    demands = LineLimits(
        math.radians(problem.range_of(name)),
        problem.optimize == "velocity",
        math.radians(
            TRANSMISSION if constraints.min_transmission_angle is None else constraints.min_transmission_angle
        ),
        LINK_RATIO if constraints.max_link_ratio is None else constraints.max_link_ratio,
    )
    nodes = chebyshev_nodes(SAMPLES)
    if name == "hoeken":
        shapes = _hoeken(problem, demands, nodes)
    else:
        limit = 0.5 * STRAIGHT if problem.max_deviation is None else KEPT * problem.max_deviation / problem.length
        shapes = _shapes(problem, family, demands, nodes, limit)
    made = [_placed(problem, family, shape, demands.span, proportions) for proportions, shape in shapes.items()]
    if len(made) == 2 and max(abs(z - made[1].joints[name]) for name, z in made[0].joints.items()) < (
        SAME_DESIGN * problem.length
    ):
        # The classical proportions are optimal here: offer them once.
        return made[:1]
    return made


def _hoeken(problem: StraightLineProblem, demands: LineLimits, nodes: Real) -> dict[Proportions, Real]:
    """Return the best of both free proportions, and the best of Norton's family, which sets the required
    straightness."""
    family = FOURBARS["hoeken"]
    norton = narrowest(values_of(NORTON, demands, nodes), np.array(NORTON.classical), *NORTON.bounds())
    shapes: dict[Proportions, Real] = {}
    start, limit = np.array(family.classical), np.inf
    if norton is not None:
        # Norton's family within Hoeken's: 2 L3 = 3 L1 − L2.
        start = np.array([norton.shape[0], 1.5 * norton.shape[0] - 0.5])
        if demands.velocity:
            limit = 0.5 * float(np.ptp(values_of(NORTON, demands, nodes)(norton.shape[None]).limited))
    if problem.max_deviation is not None:
        limit = KEPT * problem.max_deviation / problem.length
    starts = [start]
    if demands.velocity and problem.max_deviation is not None:
        # A strict deviation may exclude Norton's start; the straightest linkage is a feasible one.
        straightest = values_of(family, demands._replace(velocity=False), nodes)
        fit = narrowest(straightest, np.array(family.classical), *family.bounds())
        starts += [] if fit is None else [fit.shape]
    values = values_of(family, demands, nodes)
    fits = [narrowest(values, start, *family.bounds(), half_limit=limit) for start in starts]
    sound = [fit for fit in fits if fit is not None and fit.violation <= SLACK]
    if sound:
        shapes["optimal"] = min(sound, key=lambda fit: fit.half_width).shape
    if norton is not None and norton.violation <= SLACK:
        shapes["classical"] = starts[0]
    return shapes


def _shapes(
    problem: StraightLineProblem, family: Family, demands: LineLimits, nodes: Real, limit: float
) -> dict[Proportions, Real]:
    """Return the best of classical proportions, in its range and direction alone, and the best of all."""
    values, coarse = values_of(family, demands, nodes), values_of(family, demands, nodes[::COARSER])
    chosen: dict[Proportions, Real] = {}
    low, high = np.array(family.low), np.array(family.high)
    # Good linkages mostly have even proportions: the power draws them towards the lower bounds.
    drawn = low + (high - low) * np.random.default_rng(problem.seed).random((DRAWN, len(low))) ** 1.5
    starts = []
    for proportions in (np.array([family.classical]), drawn):
        shapes = family.beginnings(proportions)
        # Merit combines width and violations, so that infeasible starts can be compared too.
        merit = merits(coarse(shapes), limit)[2]
        if np.isfinite(merit).any():
            starts.append(shapes[int(merit.argmin())])
    if not starts:
        return {}
    # The classical proportions have a finite merit, and their own fit.
    if np.array_equal(starts[0][: len(low)], family.classical):
        fixed = family.bounds(fixed=family.classical)
        first = narrowest(coarse, starts[0], *fixed, half_limit=limit, arrived=NEARLY)
        classical = None if first is None else narrowest(values, first.shape, *fixed, half_limit=limit)
        if classical is not None:
            starts[0] = classical.shape
            if classical.violation <= SLACK:
                chosen["classical"] = classical.shape
    fits = [narrowest(coarse, start, *family.bounds(), half_limit=limit, arrived=NEARLY) for start in starts]
    sound = [fit for fit in fits if fit is not None and fit.violation <= SLACK]
    if sound:
        nearly = min(sound, key=lambda fit: fit.half_width).shape
        best = narrowest(values, nearly, *family.bounds(), half_limit=limit)
        if best is not None and best.violation <= SLACK:
            chosen["optimal"] = best.shape
    return chosen


def _placed(
    problem: StraightLineProblem, family: Family, shape: Real, span: float, proportions: Proportions
) -> _PlacedMechanism:
    """Scale and move a shape so that P runs from 0 to the length along +x, in the middle of its strip."""
    joints, line = configuration(family, shape, span)
    turned = line.direction.conjugate()
    across = (line.p * turned).imag
    origin = (line.p[0] * turned).real + 0.5j * (across.min() + across.max())
    places = (joints * turned - origin) * (problem.length / float(line.length))
    named = dict(zip(("O2", "A", "B", "O4", "P"), places.tolist(), strict=True))
    return _PlacedMechanism(family.name, proportions, named)


def _exact(problem: StraightLineProblem, name: LineMechanism) -> list[_PlacedMechanism]:
    exact = EXACT[name](problem.length, math.radians(problem.range_of(name)))
    if exact is None:
        return []
    begin = complex(exact.mechanism.joints["P"])
    joints = {joint: -1j * (complex(z) - begin) for joint, z in exact.mechanism.joints.items()}
    return [_PlacedMechanism(name, "exact", joints, exact)]


def _best_side(problem: StraightLineProblem, candidate: _PlacedMechanism) -> StraightLineDesign | None:
    """Return the design with the input turning in the required direction, or in one that satisfies the constraints."""
    designs = []
    for rotation in ("ccw", "cw"):
        if problem.rotation in ("any", rotation):
            mechanism = _mechanism(problem, candidate, mirrored=rotation == "cw")
            # Mirroring does not change the motion, but may move pivots into their regions.
            design = verify_straight_line(problem, mechanism, candidate.family, candidate.proportions)
            if design is not None and design.verification.passed:
                return design
            designs.append(design)
    return next((design for design in designs if design is not None), None)


def _mechanism(
    problem: StraightLineProblem, candidate: _PlacedMechanism, *, mirrored: bool
) -> FourbarMechanism | ExactLineMechanism:
    start, along = complex(*problem.start), cmath.exp(1j * math.radians(problem.direction))
    joints = {name: start + along * (z.conjugate() if mirrored else z) for name, z in candidate.joints.items()}
    if candidate.exact is None:
        return fourbar_mechanism(FourbarConfiguration(*(joints[name] for name in ("O2", "A", "B", "O4", "P"))))
    mechanism = candidate.exact.mechanism
    slides = []
    for given in mechanism.slides:
        # The slides pass through joints, and their lines along +y in the frame of P's line.
        turned = float(given.angle) - 0.5 * math.pi
        angle = (-turned if mirrored else turned) + math.radians(problem.direction)
        slides.append(slide(given.joint, given.link, joints[given.joint], angle))
    return ExactLineMechanism(
        type=candidate.family,
        fixed_pivots={name: to_point(joints[name]) for name in mechanism.links[GROUND]},
        links=candidate.exact.links,
        skeleton=skeleton(joints, mechanism.links, slides=slides, input_link=mechanism.input),
    )


def _summary(problem: StraightLineProblem, sifting: Sifting[StraightLineDesign]) -> str:
    if not sifting.passed:
        return (
            f"No straight-line mechanism was found that satisfies all constraints ({sifting.listed()}). One may still "
            "exist."
        )
    best = _ranked(problem, sifting.passed)[0].metrics
    exact = best.straightness_error <= ROUNDING
    kept = "follows the line exactly" if exact else f"stays in a strip of {best.straightness_error:.3g} % of the length"
    name = best.family.replace("_", "-").title()
    return (
        f"{counted(len(sifting.passed), 'straight-line mechanism')} found. The first, {name}'s, {kept}; "
        f"its velocity varies by {best.velocity_variation:.3g} %."
    )
