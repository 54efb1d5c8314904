"""Five points with their crank angles: all fourbars, by two problems of motion generation.

The crank W and the coupler vector Z of the input dyad satisfy, with crank rotations β_k given and those of the coupler
α_k not (Norton 5.35),

    W (e^{iβ_k} − 1) + Z (e^{iα_k} − 1) = δ_k.

In motion generation the α_k are given instead. As the equation is the same in both, the dyads of a body that is rotated
by β_k are the solutions, with W and Z exchanged: a fixed pivot O and a moving pivot A′ stand for O2 = O and
A = O + P − A′. There are at most four (:mod:`synthesis.kinds.motion.dyads.finite_sets`). Each determines the coupler's
rotation,

    e^{iα_k} = (Z + δ_k − W (e^{iβ_k} − 1)) / Z,

and its output links are the dyads of that motion: at most four again, of which one is the input link itself. There are
at most twelve fourbars, and each comes with the cognate whose input turns with it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from kinematics.arrays import Complex, Real
from kinematics.message import compose
from synthesis.kinds.motion.dyads.equations import DyadConditions, refine_dyads
from synthesis.kinds.motion.dyads.finite_sets import find_section
from synthesis.kinds.motion.task.positions import MotionTask
from synthesis.kinds.path.design import PathResult, TimedDyads
from synthesis.kinds.path.exact.underdetermined_fit import find_exact_fits
from synthesis.kinds.path.problem import PathProblem
from synthesis.kinds.path.results import MIN_LINK_SHARE, MIN_SEPARATION, PathCandidateLog, join_sentences
from synthesis.model.kind import Progress
from synthesis.model.linkage.conversion import FourbarConfiguration

POINT_COUNT = 5

DYAD_TOLERANCE = 1e-6
"""Distance of pivots, in task sizes and in shares of its own reach, below which an output link is the input link."""


class TimedFourbars(NamedTuple):
    """All fourbars through five points at their crank angles, in task coordinates.

    ``joints`` are O2, A, B, O4 at the first point (rows of four; P is at 0). ``proved`` is true if no others exist,
    except sliders, of which ``sliders`` were found. ``inputs`` is the number of input dyads.
    """

    joints: Complex
    inputs: int
    sliders: int
    proved: bool


def compute_timed_fourbars(points: Complex, turns: Real) -> TimedFourbars:
    """Compute all fourbars whose coupler point is at five points at the corresponding five crank rotations.

    Parameters
    ----------
    points : complex, shape (5,)
        In task coordinates: the first is 0, the maximum distance is 1.
    turns : float, shape (5,)
        Rotations of the crank from the first point, radians; the first is 0.
    """
    free = DyadConditions(rotations=(None,) * (POINT_COUNT - 1))
    exchanged = MotionTask(points, np.exp(1j * turns), 0j, 1.0)
    inputs = find_section(exchanged, free)
    dyads = refine_dyads(exchanged, inputs.dyads) if len(inputs.dyads.fixed) else inputs.dyads
    proved, sliders = inputs.finite and inputs.proved, len(inputs.sliders)
    linkages = []
    for o2, moving in zip(dyads.fixed, dyads.moving, strict=True):
        crank, arm = -moving, moving - o2
        if abs(crank) < MIN_LINK_SHARE or abs(arm) < MIN_LINK_SHARE:
            # P on the crank's pin: its path is the crank's circle, with any output link.
            proved = False
            continue
        rotations = (arm + points - crank * (np.exp(1j * turns) - 1.0)) / arm
        task = MotionTask(points, rotations / np.abs(rotations), 0j, 1.0)
        outputs = find_section(task, free)
        # Completeness requires that every single step found all of its solutions.
        proved = proved and outputs.finite and outputs.proved
        sliders += len(outputs.sliders)
        if not len(outputs.dyads.fixed):
            continue
        links = refine_dyads(task, outputs.dyads)
        a = o2 + crank
        for o4, b in zip(links.fixed, links.moving, strict=True):
            reach = 1.0 + abs(o2) + abs(a)
            # One of the output dyads is the input dyad itself; it would make a linkage of two equal links.
            if max(abs(o4 - o2), abs(b - a)) > DYAD_TOLERANCE * reach:
                linkages.append((o2, a, b, o4))
    return TimedFourbars(np.array(linkages, np.complex128).reshape(-1, 4), len(dyads.fixed), sliders, proved)


def solve_timed(problem: PathProblem, progress: Progress) -> PathResult:
    """Solve a problem of points that are met exactly at prescribed crank angles."""
    if len(problem.points) == POINT_COUNT and problem.crank_phase == "free" and not problem.fixed_pivots.count_given():
        return _solve_five_points(problem, progress)
    harvest = PathCandidateLog(problem, apart=MIN_SEPARATION)
    for design in find_exact_fits(problem, progress):
        harvest.record_candidate(design)
    progress(1.0, compose("path-verified"))
    return harvest.build_result("timed_family", complete=False, summary=_describe_family(problem, harvest))


def _solve_five_points(problem: PathProblem, progress: Progress) -> PathResult:
    """Solve five points with free phase and pivots completely."""
    given = np.array([point.point for point in problem.points])
    size = problem.task_size
    points, turns = (given - given[0]) / size, np.array(problem.crank_turns)
    # The opposite direction is another problem with its own solutions.
    ways = (turns, -turns) if problem.crank_direction == "either" else (turns,)
    harvest = PathCandidateLog(problem)
    inputs = fourbars = sliders = 0
    proved = True
    for n, way in enumerate(ways):
        progress(n / len(ways), compose("path-computing-dyads"))
        solved = compute_timed_fourbars(points, way)
        inputs, sliders, proved = inputs + solved.inputs, sliders + solved.sliders, proved and solved.proved
        fourbars += len(solved.joints)
        for o2, a, b, o4 in given[0] + size * solved.joints:
            harvest.drive(FourbarConfiguration(*map(complex, (o2, a, b, o4, given[0]))))
    progress(1.0, compose("path-verified"))
    complete, passed = proved and not harvest.unproven, len(harvest.passed)
    summary = join_sentences(
        [
            compose("path-five-points-with-timing", inputs=inputs, fourbars=fourbars, passed=passed),
            harvest.describe_reasons(),
            compose("path-dyads-with-slider", count=sliders) if sliders else "",
            harvest.describe_completeness(complete=complete),
        ]
    )
    result = harvest.build_result("timed_dyads", complete=complete, summary=summary)
    return result.model_copy(update={"timed": TimedDyads(inputs=inputs, fourbars=fourbars, sliders=sliders)})


def _describe_family(problem: PathProblem, harvest: PathCandidateLog) -> str:
    """Describe the designs found for points that leave freedom."""
    passed = len(harvest.passed)
    text = compose("path-family-with-timing", passed=passed, count=harvest.candidates, points=len(problem.points))
    return join_sentences([text, harvest.describe_reasons(), harvest.describe_completeness(complete=False)])
