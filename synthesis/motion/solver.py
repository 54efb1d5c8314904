"""Motion generation: dyads for both sides, all pairs screened, the best distinct ones verified.

Where the client's choices determine both dyads the answer is complete. Where some are open, both sides become clouds
of dyads (:mod:`choices`), every pair is screened (:mod:`screening`), and the best that differ from one another are
verified until enough have passed.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator

import numpy as np

from synthesis.designs import Design, Result, Search
from synthesis.linkages import FourbarConfiguration, fourbar_mechanism
from synthesis.motion.choices import Cloud, can_have_dyads, side_dyads
from synthesis.motion.dyads import Dyads
from synthesis.motion.screening import SHORTEST_LINK, Screening, demands, screen
from synthesis.motion.task import MotionTask, motion_task
from synthesis.problems import MotionProblem
from synthesis.ranking import distinct, ranked
from synthesis.verification import verify

Progress = Callable[[float, str], None]

USABLE_TRANSMISSION_ANGLE = 30.0
"""Degrees. Where choices are open and the client sets no limit, linkages below this are offered only if none reaches
it; practice wants 30 to 40 at least (Norton, Sec. 4.10)."""

CLOUD_PAIR = 1200
"""Dyads a side when both sides are open: 1.4 million pairs."""

CLOUD_SINGLE = 40_000
"""Dyads of an open side when the other is determined."""

SHORTLIST = 4000
"""Best-scored pairs from which distinct ones are chosen."""

APART = 0.25
"""Distinct designs move some joint by at least this share of the task's size; halved until enough are found, four times
at most."""

_REASONS = {
    "reaches_targets": "residual",
    "same_circuit": "circuit_defect",
    "same_branch": "branch_defect",
    "visits_in_order": "order_defect",
    "shortest_link": "link_length",
    "longest_link": "link_length",
}
"""Why a design was rejected, by the check it failed; other checks go by their own name."""


def solve_motion(problem: MotionProblem, progress: Progress) -> Result:
    """Solve a motion-generation problem of two or three positions."""
    task = motion_task(problem)
    rng = np.random.default_rng(problem.seed)
    progress(0.0, "finding dyads")
    sides = problem.input_side, problem.output_side
    free = 5 - len(task.points)
    open_sides = [side.count() < free for side in sides]
    count = CLOUD_PAIR if all(open_sides) else CLOUD_SINGLE
    inputs, outputs = (side_dyads(task, side, problem.constraints, rng, count) for side in sides)
    search = _determined_pairs if not any(open_sides) else _searched_pairs
    if not len(inputs.dyads.fixed) or not len(outputs.dyads.fixed):
        return _none_exists(problem, task, inputs, outputs)
    return search(problem, task, inputs, outputs, progress)


def _determined_pairs(
    problem: MotionProblem, task: MotionTask, inputs: Cloud, outputs: Cloud, progress: Progress
) -> Result:
    """Verify every pair of a few determined dyads."""
    rejected: Counter[str] = Counter()
    designs = []
    pairs = [(i, j) for i in range(len(inputs.dyads.fixed)) for j in range(len(outputs.dyads.fixed))]
    for i, j in pairs:
        design = _verified(problem, task, inputs.dyads, outputs.dyads, i, j)
        if design is None:
            rejected["degenerate"] += 1
        elif design.verification.passed:
            designs.append(design)
        else:
            rejected[_reason(design)] += 1
            if problem.include_failed:
                designs.append(design)
    progress(1.0, "verified")
    accepted = sum(design.verification.passed for design in designs)
    complete = inputs.complete and outputs.complete
    return Result(
        designs=ranked(designs, problem.rank_by)[: problem.max_designs],
        search=Search(
            method="exact",
            complete=complete,
            candidates=len(pairs),
            accepted=accepted,
            rejected=dict(rejected),
            seed=problem.seed,
        ),
        summary=_summary_of_determined(problem, len(pairs), accepted, rejected, complete),
    )


def _searched_pairs(
    problem: MotionProblem, task: MotionTask, inputs: Cloud, outputs: Cloud, progress: Progress
) -> Result:
    """Screen all pairs of two clouds and verify the best distinct ones."""
    limit = problem.constraints.min_transmission_angle
    progress(0.1, f"screening {len(inputs.dyads.fixed) * len(outputs.dyads.fixed)} pairs of dyads")
    wanted = demands(problem.constraints, task, USABLE_TRANSMISSION_ANGLE if limit is None else limit)
    screening = screen(task, inputs.dyads, outputs.dyads, wanted)
    if limit is None and not screening.score.any():
        wanted = demands(problem.constraints, task, 0.0)
        screening = screen(task, inputs.dyads, outputs.dyads, wanted)
    rejected = Counter(screening.rejected())
    sound = int(np.count_nonzero(screening.score))
    progress(0.8, f"verifying the best of {sound} sound pairs")
    designs: list[Design] = []
    passed = 0
    for i, j in _best_pairs(task, inputs.dyads, outputs.dyads, screening, 5 * problem.max_designs):
        design = _verified(problem, task, inputs.dyads, outputs.dyads, i, j)
        if design is None or not design.verification.passed:
            rejected["degenerate" if design is None else _reason(design)] += 1
            sound -= 1
            if design is not None and problem.include_failed:
                designs.append(design)
            continue
        designs.append(design)
        passed += 1
        if passed == problem.max_designs:
            break
    progress(1.0, "verified")
    designs = ranked(designs, problem.rank_by)[: problem.max_designs]
    return Result(
        designs=designs,
        search=Search(
            method="dyad_search",
            complete=False,
            candidates=int(screening.verdict.size),
            accepted=sound,
            rejected=dict(rejected),
            seed=problem.seed,
        ),
        summary=_summary_of_search(designs, screening, sound),
    )


def _best_pairs(
    task: MotionTask, inputs: Dyads, outputs: Dyads, screening: Screening, count: int
) -> Iterator[tuple[int, int]]:
    """The best-scored pairs that differ from one another, best first."""
    score = screening.score.ravel()
    shortlist = np.argpartition(-score, min(SHORTLIST, score.size - 1))[:SHORTLIST]
    shortlist = shortlist[score[shortlist] > 0.0]
    shortlist = shortlist[np.lexsort((shortlist, -score[shortlist]))]
    i, j = np.unravel_index(shortlist, screening.score.shape)
    joints = np.stack([inputs.fixed[i], inputs.moving[i], outputs.moving[j], outputs.fixed[j]], axis=1)
    apart = APART
    chosen = distinct(joints, count, apart)
    while len(chosen) < min(count, len(joints)) and apart > APART / 20.0:
        apart /= 2.0
        chosen = distinct(joints, count, apart)
    return iter([(int(i[k]), int(j[k])) for k in chosen])


def _verified(problem: MotionProblem, task: MotionTask, inputs: Dyads, outputs: Dyads, i: int, j: int) -> Design | None:
    """The linkage of two dyads, driven and measured; None where it has no links to speak of or cannot be driven."""
    o2, a = task.to_problem(complex(inputs.fixed[i])), task.to_problem(complex(inputs.moving[i]))
    o4, b = task.to_problem(complex(outputs.fixed[j])), task.to_problem(complex(outputs.moving[j]))
    lengths = abs(a - o2), abs(b - a), abs(b - o4), abs(o4 - o2)
    if min(lengths) <= SHORTEST_LINK * max(lengths):
        return None
    return verify(problem, fourbar_mechanism(FourbarConfiguration(o2, a, b, o4, task.origin)))


def _reason(design: Design) -> str:
    """Name of the first failed check, as a reason for rejection."""
    name = next(check.name for check in design.verification.checks if not check.passed)
    return _REASONS.get(name, name)


def _none_exists(problem: MotionProblem, task: MotionTask, inputs: Cloud, outputs: Cloud) -> Result:
    """The answer when one side has no dyad at all, with the reason."""
    if not can_have_dyads(task):
        if np.allclose(task.turns, 1.0, rtol=0.0, atol=1e-12):
            reason = (
                "The positions are a translation along a straight line: every point of the body moves on a line, "
                "so only a slider can guide it and no pin-jointed fourbar exists."
            )
        else:
            reason = (
                "The positions are a rotation about one point: a pin joint there carries the body, "
                "and every dyad would have it for its fixed pivot, so no fourbar exists."
            )
        complete = True
    else:
        side, cloud = ("input", inputs) if not len(inputs.dyads.fixed) else ("output", outputs)
        complete = cloud.complete and cloud.degeneracy == "slider"
        reason = {
            "slider": f"The {side} side's pivot has its images on one straight line: "
            "a slider, not a pin-jointed link, would guide it. No design exists with these choices.",
            "undetermined": f"No dyad was found for the choices of the {side} side: they are met by no link of "
            "positive length, or they do not determine one.",
            "pole": f"The fixed pivot of the {side} side is the pole about which the body turns: the link "
            "would turn with the body as one piece. Choose another pivot.",
            None: f"No dyad was found for the choices of the {side} side.",
        }[cloud.degeneracy]
    return Result(
        designs=[],
        search=Search(method="exact", complete=complete, candidates=0, accepted=0, rejected={}, seed=problem.seed),
        summary=reason,
    )


def _summary_of_determined(
    problem: MotionProblem, candidates: int, accepted: int, rejected: Counter[str], complete: bool
) -> str:
    n = len(problem.positions)
    noun = "linkage" if candidates == 1 else "linkages"
    text = f"{accepted} of {candidates} {noun} with the stated choices carries the body through all {n} positions."
    if accepted != 1:
        text = text.replace("carries", "carry")
    if rejected:
        text += " Rejected: " + _listed(rejected) + "."
    if not accepted and complete:
        text += " These are all, so no design exists."
    return text


def _summary_of_search(designs: list[Design], screening: Screening, sound: int) -> str:
    pairs = screening.verdict.size
    passed = [design for design in designs if design.verification.passed]
    if not passed:
        return (
            f"None of {pairs} pairs of dyads that were tried makes a linkage that satisfies all demands "
            f"(rejected: {_listed(screening.rejected())}). A linkage may exist that the search did not meet."
        )
    best = max(design.metrics.min_transmission_angle for design in passed)
    text = (
        f"{sound} of {pairs} pairs of dyads make a sound linkage; the best {len(passed)} distinct ones are returned, "
        f"with a least transmission angle of up to {best:.1f}°."
    )
    if best < USABLE_TRANSMISSION_ANGLE:
        text += f" None that was found reaches {USABLE_TRANSMISSION_ANGLE:.0f}°."
    return text


def _listed(counts: Counter[str] | dict[str, int]) -> str:
    return ", ".join(f"{name.replace('_', ' ')} {n}" for name, n in counts.items())
