"""Straight-line mechanisms: find the narrowest or most even of each type, place them on the line, and verify them."""

from __future__ import annotations

import cmath
import math
from functools import partial
from typing import Literal, NamedTuple

import numpy as np

from kinematics.arrays import Real
from kinematics.linkage.planar.mechanism import GROUND
from kinematics.message import compose, join_messages
from synthesis.kinds.straight_line.design import ExactLineMechanism, StraightLineDesign, StraightLineResult
from synthesis.kinds.straight_line.exact import ExactLine, size_hart, size_peaucellier, size_scott_russell
from synthesis.kinds.straight_line.families import (
    FOURBARS,
    NORTON,
    SAMPLE_COUNT,
    Family,
    LineLimits,
    build_configuration,
    compute_chebyshev_nodes,
    make_objective,
)
from synthesis.kinds.straight_line.problem import LineMechanism, StraightLineProblem
from synthesis.kinds.straight_line.verification import verify_straight_line
from synthesis.model.kind import Progress
from synthesis.model.linkage.answer import FourbarMechanism
from synthesis.model.linkage.conversion import (
    FourbarConfiguration,
    build_fourbar,
    build_skeleton,
    build_slide,
    to_point,
)
from synthesis.numerics.narrowing import compute_merits, find_narrowest_band
from synthesis.results.candidate_log import CandidateLog
from synthesis.results.ranking import rank_designs

DEFAULT_LINK_RATIO = 5.0
"""Default maximum ratio of a fourbar's longest to its shortest link. It is needed because in several families the
straightness error decreases without end as the ratio increases."""

DEFAULT_TRANSMISSION_ANGLE = 20.0
"""Default minimum transmission angle along the line, degrees; near a toggle P moves fast and far."""

DEFAULT_STRIP_WIDTH = 0.01
"""Default width of the strip that must contain the path while its velocity is made even, as a share of the length. For
Hoeken's linkages it is instead the width for the linkage of Norton's family with the most even velocity."""

DRAW_COUNT = 160
"""Number of random proportions within a family's bounds. The best of them is refined, in addition to the classical
proportions."""

COARSE_STRIDE, COARSE_GAIN_TOLERANCE = 4, 1e-2
"""First descent: it uses one of this many samples, and ends when a step improves the objective by less than this
share."""

DEVIATION_SHARE = 0.98
"""Share of the permitted deviation that is used at the samples, because P deviates somewhat more between them."""

DESIGN_DUPLICATE_TOLERANCE = 1e-4
"""Designs whose joints agree to this share of the length are duplicates."""

MAX_VIOLATION = 1e-6
"""Maximum violation of a constraint after the search; verification decides."""

ROUNDING_PERCENT = 1e-9
"""Straightness error or velocity variation, per cent, that counts as rounding."""

EXACT_SIZERS = {"peaucellier": size_peaucellier, "hart": size_hart, "scott_russell": size_scott_russell}
"""Sizing functions of the exact types."""

Proportions = Literal["optimal", "classical", "exact"]


class _PlacedMechanism(NamedTuple):
    """Joints of a mechanism at the start of its range.

    P starts at 0 and runs to ``length`` along +x while the input turns counter-clockwise. ``exact`` is the mechanism of
    an exact line in its own frame; it is None for a fourbar.
    """

    family: LineMechanism
    proportions: Proportions
    joints: dict[str, complex]
    exact: ExactLine | None = None


def solve_straight_line(problem: StraightLineProblem, progress: Progress) -> StraightLineResult:
    """Solve a problem of a straight line."""
    sifting = CandidateLog[StraightLineDesign](problem)
    types = problem.types
    for n, name in enumerate(types):
        progress(n / len(types), compose("straight_line-searching-type", mechanism=name.replace("_", " ")))
        candidates = _find_exact(problem, name) if name in EXACT_SIZERS else _find_fourbars(problem, name)
        # Counts as one rejected candidate, so that the summary explains a missing type.
        sifting.reject("no_such_linkage", not candidates)
        sifting.verify_candidates(candidates, partial(_verify_best_side, problem))
    progress(1.0, compose("straight_line-verified"))
    designs = sifting.select_designs(partial(_rank_designs, problem))
    return StraightLineResult(
        designs=designs,
        search=sifting.build_search(compose("straight_line-method")),
        summary=_describe_result(designs, sifting),
    )


def warm_up() -> None:
    """Compile or load the kernels: one fourbar, and one mechanism of each exact type."""
    for name in ("hoeken", *EXACT_SIZERS):
        problem = StraightLineProblem(kind="straight_line", length=1.0, crank_range=60.0, mechanism=name)
        solve_straight_line(problem, lambda fraction, message: None)


def _rank_designs(problem: StraightLineProblem, designs: list[StraightLineDesign]) -> list[StraightLineDesign]:
    """Rank designs by the optimized measure; widths and variations at the level of rounding count as equal."""

    def get_objective(design: StraightLineDesign) -> float:
        metrics = design.metrics
        own = metrics.straightness_error if problem.optimize == "straightness" else metrics.velocity_variation
        return max(own, ROUNDING_PERCENT)

    def get_straightness(design: StraightLineDesign) -> float:
        return max(design.metrics.straightness_error, ROUNDING_PERCENT)

    return rank_designs(designs, problem.rank_by, {"quality": get_objective, "accuracy": get_straightness})


def _find_fourbars(problem: StraightLineProblem, name: LineMechanism) -> list[_PlacedMechanism]:
    """Return the best fourbar of a family, and the one with classical proportions."""
    family = FOURBARS[name]
    constraints = problem.constraints
    demands = LineLimits(
        math.radians(problem.get_range(name)),
        problem.optimize == "velocity",
        math.radians(
            DEFAULT_TRANSMISSION_ANGLE
            if constraints.min_transmission_angle is None
            else constraints.min_transmission_angle
        ),
        DEFAULT_LINK_RATIO if constraints.max_link_ratio is None else constraints.max_link_ratio,
    )
    nodes = compute_chebyshev_nodes(SAMPLE_COUNT)
    if name == "hoeken":
        shapes = _find_hoeken_shapes(problem, demands, nodes)
    else:
        limit = (
            0.5 * DEFAULT_STRIP_WIDTH
            if problem.max_deviation is None
            else DEVIATION_SHARE * problem.max_deviation / problem.length
        )
        shapes = _find_shapes(problem, family, demands, nodes, limit)
    made = [_place_shape(problem, family, shape, demands.span, proportions) for proportions, shape in shapes.items()]
    if len(made) == 2 and max(abs(z - made[1].joints[name]) for name, z in made[0].joints.items()) < (
        DESIGN_DUPLICATE_TOLERANCE * problem.length
    ):
        # The classical proportions are optimal here: offer them once.
        return made[:1]
    return made


def _find_hoeken_shapes(problem: StraightLineProblem, demands: LineLimits, nodes: Real) -> dict[Proportions, Real]:
    """Return the best shape with two free proportions, and the best one of Norton's family.

    The shape of Norton's family determines the required straightness of the other.
    """
    family = FOURBARS["hoeken"]
    norton = find_narrowest_band(
        make_objective(NORTON, demands, nodes), np.array(NORTON.classical), *NORTON.get_bounds()
    )
    shapes: dict[Proportions, Real] = {}
    start, limit = np.array(family.classical), np.inf
    if norton is not None:
        # Norton's family within Hoeken's: 2 L3 = 3 L1 − L2.
        start = np.array([norton.shape[0], 1.5 * norton.shape[0] - 0.5])
        if demands.velocity:
            limit = 0.5 * float(np.ptp(make_objective(NORTON, demands, nodes)(norton.shape[None]).limited))
    if problem.max_deviation is not None:
        limit = DEVIATION_SHARE * problem.max_deviation / problem.length
    starts = [start]
    if demands.velocity and problem.max_deviation is not None:
        # A strict deviation may exclude Norton's start; the straightest linkage is a feasible one.
        straightest = make_objective(family, demands._replace(velocity=False), nodes)
        fit = find_narrowest_band(straightest, np.array(family.classical), *family.get_bounds())
        starts += [] if fit is None else [fit.shape]
    values = make_objective(family, demands, nodes)
    fits = [find_narrowest_band(values, start, *family.get_bounds(), half_limit=limit) for start in starts]
    sound = [fit for fit in fits if fit is not None and fit.violation <= MAX_VIOLATION]
    if sound:
        shapes["optimal"] = min(sound, key=lambda fit: fit.half_width).shape
    if norton is not None and norton.violation <= MAX_VIOLATION:
        shapes["classical"] = starts[0]
    return shapes


def _find_shapes(
    problem: StraightLineProblem, family: Family, demands: LineLimits, nodes: Real, limit: float
) -> dict[Proportions, Real]:
    """Return the classical proportions, with only their range and direction optimized, and the best of all shapes."""
    values, coarse = make_objective(family, demands, nodes), make_objective(family, demands, nodes[::COARSE_STRIDE])
    chosen: dict[Proportions, Real] = {}
    low, high = np.array(family.low), np.array(family.high)
    # Good linkages mostly have even proportions: the power draws them towards the lower bounds.
    drawn = low + (high - low) * np.random.default_rng(problem.seed).random((DRAW_COUNT, len(low))) ** 1.5
    starts = []
    for proportions in (np.array([family.classical]), drawn):
        shapes = family.list_starts(proportions)
        # Merit combines width and violations, so that infeasible starts can be compared too.
        merit = compute_merits(coarse(shapes), limit)[2]
        if np.isfinite(merit).any():
            starts.append(shapes[int(merit.argmin())])
    if not starts:
        return {}
    # The classical proportions are fitted separately if they can be assembled.
    if np.array_equal(starts[0][: len(low)], family.classical):
        fixed = family.get_bounds(fixed=family.classical)
        first = find_narrowest_band(coarse, starts[0], *fixed, half_limit=limit, arrived=COARSE_GAIN_TOLERANCE)
        classical = None if first is None else find_narrowest_band(values, first.shape, *fixed, half_limit=limit)
        if classical is not None:
            starts[0] = classical.shape
            if classical.violation <= MAX_VIOLATION:
                chosen["classical"] = classical.shape
    fits = [
        find_narrowest_band(coarse, start, *family.get_bounds(), half_limit=limit, arrived=COARSE_GAIN_TOLERANCE)
        for start in starts
    ]
    sound = [fit for fit in fits if fit is not None and fit.violation <= MAX_VIOLATION]
    if sound:
        nearly = min(sound, key=lambda fit: fit.half_width).shape
        best = find_narrowest_band(values, nearly, *family.get_bounds(), half_limit=limit)
        if best is not None and best.violation <= MAX_VIOLATION:
            chosen["optimal"] = best.shape
    return chosen


def _place_shape(
    problem: StraightLineProblem, family: Family, shape: Real, span: float, proportions: Proportions
) -> _PlacedMechanism:
    """Scale and move a shape so that P runs from 0 to the length along +x, in the middle of its strip."""
    joints, line = build_configuration(family, shape, span)
    turned = line.direction.conjugate()
    across = (line.p * turned).imag
    origin = (line.p[0] * turned).real + 0.5j * (across.min() + across.max())
    places = (joints * turned - origin) * (problem.length / float(line.length))
    named = dict(zip(("O2", "A", "B", "O4", "P"), places.tolist(), strict=True))
    return _PlacedMechanism(family.name, proportions, named)


def _find_exact(problem: StraightLineProblem, name: LineMechanism) -> list[_PlacedMechanism]:
    exact = EXACT_SIZERS[name](problem.length, math.radians(problem.get_range(name)))
    if exact is None:
        return []
    begin = complex(exact.mechanism.joints["P"])
    joints = {joint: -1j * (complex(z) - begin) for joint, z in exact.mechanism.joints.items()}
    return [_PlacedMechanism(name, "exact", joints, exact)]


def _verify_best_side(problem: StraightLineProblem, candidate: _PlacedMechanism) -> StraightLineDesign | None:
    """Return the design whose input turns in the required direction, or in one that satisfies the constraints."""
    designs = []
    for rotation in ("ccw", "cw"):
        if problem.rotation in ("any", rotation):
            mechanism = _build_mechanism(problem, candidate, mirrored=rotation == "cw")
            # Mirroring does not change the motion, but may move pivots into their regions.
            design = verify_straight_line(problem, mechanism, candidate.family, candidate.proportions)
            if design is not None and design.verification.passed:
                return design
            designs.append(design)
    return next((design for design in designs if design is not None), None)


def _build_mechanism(
    problem: StraightLineProblem, candidate: _PlacedMechanism, *, mirrored: bool
) -> FourbarMechanism | ExactLineMechanism:
    start, along = complex(*problem.start), cmath.exp(1j * math.radians(problem.direction))
    joints = {name: start + along * (z.conjugate() if mirrored else z) for name, z in candidate.joints.items()}
    if candidate.exact is None:
        return build_fourbar(FourbarConfiguration(*(joints[name] for name in ("O2", "A", "B", "O4", "P"))))
    mechanism = candidate.exact.mechanism
    slides = []
    for given in mechanism.slides:
        # The slides pass through joints, and their lines along +y in the frame of P's line.
        turned = float(given.angle) - 0.5 * math.pi
        angle = (-turned if mirrored else turned) + math.radians(problem.direction)
        slides.append(build_slide(given.joint, given.link, joints[given.joint], angle))
    return ExactLineMechanism(
        type=candidate.family,
        fixed_pivots={name: to_point(joints[name]) for name in mechanism.links[GROUND]},
        links=candidate.exact.links,
        skeleton=build_skeleton(joints, mechanism.links, slides=slides, input_link=mechanism.input),
    )


def _describe_result(designs: list[StraightLineDesign], sifting: CandidateLog[StraightLineDesign]) -> str:
    if not sifting.passed:
        return compose("straight_line-none-found", reasons=sifting.format_reasons())
    best = designs[0].metrics
    name, variation = best.family.replace("_", "-").title(), f"{best.velocity_variation:.3g}"
    if best.straightness_error <= ROUNDING_PERCENT:
        first = compose("straight_line-first-is-exact", mechanism=name, variation=variation)
    else:
        width = f"{best.straightness_error:.3g}"
        first = compose("straight_line-first-stays-in-strip", mechanism=name, width=width, variation=variation)
    guided = any(design.metrics.runs_on_slide for design in designs)
    remark = compose("straight_line-runs-on-slide") if guided else ""
    return join_messages([compose("straight_line-mechanisms-found", count=len(sifting.passed)), first, remark])
