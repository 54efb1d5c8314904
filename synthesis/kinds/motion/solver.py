"""Motion generation: dyads for both sides, all pairs screened, the best distinct ones verified.

Where the positions and the client's choices determine both dyads there is one linkage, or a few, and each is verified.
Where some freedom is left, that side is a cloud of dyads (:mod:`synthesis.kinds.motion.choices`), every pair is
screened (:mod:`synthesis.kinds.motion.screening`), and the best that differ from one another are verified until enough
have passed.

Where both sides are stated alike they have the same dyads, as for five positions, and two of them make one fourbar that
may be driven from either side. It counts as one candidate; each way of driving it that passes is an answer.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping

import numpy as np

from synthesis.kinds.motion.burmester import (
    Window,
    branches,
    burmester_curve,
)
from synthesis.kinds.motion.choices import Cloud, side_dyads
from synthesis.kinds.motion.demanded import demanded
from synthesis.kinds.motion.design import BurmesterBranch, MotionResult
from synthesis.kinds.motion.driver_dyad import undriven, with_driver_dyads
from synthesis.kinds.motion.dyads import DyadConditions, Dyads
from synthesis.kinds.motion.least_squares import solve_least_squares
from synthesis.kinds.motion.problem import (
    DyadChoices,
    MotionProblem,
    whole_point,
)
from synthesis.kinds.motion.screening import (
    SHORTEST_LINK,
    Screening,
    demands,
    screen,
)
from synthesis.kinds.motion.slider_search import (
    beside_sliders,
    solve_sliders,
    with_sliders,
)
from synthesis.kinds.motion.task import MotionTask, motion_task
from synthesis.kinds.motion.verification import verify
from synthesis.model.answer import Search
from synthesis.model.kind import Progress
from synthesis.model.linkage_answer import LinkageDesign
from synthesis.model.linkage_statement import Constraints
from synthesis.model.linkages import (
    FourbarConfiguration,
    fourbar_mechanism,
    to_point,
)
from synthesis.outcome.ranking import distinct, ranked

USABLE_TRANSMISSION_ANGLES = 30.0, 20.0, 10.0, 0.0
"""Degrees. Where the client sets no limit, a search offers linkages below each of these only if it met none that
reaches it; practice wants 30 to 40 at least (Norton, Sec. 4.10)."""

CLOUD_PAIR = 1200
"""Dyads a side when both sides are open: 1.4 million pairs."""

CLOUD_SINGLE = 40_000
"""Dyads of an open side when the other is determined."""

CURVE_PAIR, CURVE_SINGLE = 1600, 8000
"""The same for dyads of Burmester's curve, which has one dimension to fill but reaches far."""

CURVES_REACH = 4.0
"""Burmester's curves are returned up to this many task sizes from the body, or half as far again as designs reach."""

CURVES_SAMPLES = 400
"""Samples of Burmester's curves that are returned, all branches together."""

SHORTLIST = 4000
"""Best-scored pairs from which distinct ones are chosen."""

APART = 0.25 * 0.5 ** np.arange(6)
"""Distinct designs move some joint by at least this share of the task's size: the first at which enough are found."""

ATTEMPTS = 5
"""Pairs verified at most, for each design wanted: verification seldom refuses what screening has passed."""

LEAST_ATTEMPTS = 100
"""Pairs tried at least before a search gives up."""

_REASONS = {
    "reaches_targets": "residual",
    "same_circuit": "circuit_defect",
    "same_branch": "branch_defect",
    "visits_in_order": "order_defect",
    "shortest_link": "link_length",
    "longest_link": "link_length",
}
"""Why a design was rejected, by the check it failed; other checks go by their own name."""

_NUMERICAL = {"degenerate", "residual", "cannot_be_driven"}
"""Reasons that say what could not be shown, not what cannot be; a search with one of them proves nothing."""

_EITHER_WAY = {"degenerate", "residual", "cannot_be_driven", "circuit_defect"}
"""Reasons that hold whichever side drives."""


def solve_motion(problem: MotionProblem, progress: Progress) -> MotionResult:
    """Solve a motion-generation problem, each way of asking by its own method."""
    if problem.driver is not None:
        bare = solve_motion(undriven(problem), lambda fraction, message: progress(0.8 * fraction, message))
        return with_driver_dyads(problem, bare, progress)
    if problem.approximate:
        return solve_least_squares(problem, progress)
    if problem.slider is not None:
        return solve_sliders(problem, problem.slider, progress)
    result = _solve_fourbars(problem, progress)
    return result if result.designs else with_sliders(problem, result, progress)


def _solve_fourbars(problem: MotionProblem, progress: Progress) -> MotionResult:
    """Fourbars for two to five positions."""
    task = motion_task(problem)
    rng = np.random.default_rng(problem.seed)
    progress(0.0, "finding dyads")
    sides = problem.input_side, problem.output_side
    pair, single = (CURVE_PAIR, CURVE_SINGLE) if len(task.points) == 4 else (CLOUD_PAIR, CLOUD_SINGLE)
    clouds = [side_dyads(task, problem, sides[0], rng, pair)]
    alike = sides[0] == sides[1]
    clouds.append(clouds[0] if alike and not clouds[0].sampled else side_dyads(task, problem, sides[1], rng, pair))
    for k in (0, 1):
        if clouds[k].sampled and not clouds[1 - k].sampled:
            clouds[k] = side_dyads(task, problem, sides[k], rng, single)
    pairs = _Pairs(problem, task, *clouds)
    for name, cloud in zip(("input", "output"), clouds, strict=True):
        if not len(cloud.dyads.fixed):
            return pairs.none(cloud, name)
    if pairs.sampled:
        return pairs.searched(progress)
    result = pairs.determined(progress)
    return beside_sliders(problem, result, pairs.sliders, progress) if pairs.sliders else result


class _Pairs:
    """The pairs of input and output dyads of one problem, and what becomes of them."""

    def __init__(self, problem: MotionProblem, task: MotionTask, inputs: Cloud, outputs: Cloud) -> None:
        self.problem, self.task, self.demanded = problem, task, demanded(problem)
        self.inputs, self.outputs = inputs.dyads, outputs.dyads
        self.sampled = inputs.sampled or outputs.sampled
        self.complete = inputs.complete and outputs.complete
        self.alike = inputs is outputs
        self.sliders = inputs.sliders + outputs.sliders
        self.remarks = _remarks(problem, inputs, outputs)
        self.accepted = 0
        self.passed: list[LinkageDesign] = []
        self.failed: list[LinkageDesign] = []
        self.rejected: Counter[str] = Counter()

    def determined(self, progress: Progress) -> MotionResult:
        """Verify every pair of a few determined dyads; of two that serve either side, both ways of driving."""
        count = 0
        for i in range(len(self.inputs.fixed)):
            for j in range(i + 1 if self.alike else 0, len(self.outputs.fixed)):
                verdicts = [self._verify(i, j)]
                if self.alike and verdicts[0] not in _EITHER_WAY:
                    verdicts.append(self._verify(j, i))
                self._count(verdicts)
                count += 1
        progress(1.0, "verified")
        complete = self.complete and not _NUMERICAL & self.rejected.keys()
        return self._result("exact", complete, count, self._summary_of_determined(count, complete))

    def searched(self, progress: Progress) -> MotionResult:
        """Screen all pairs and verify the best distinct ones."""
        count = len(self.inputs.fixed) * len(self.outputs.fixed)
        progress(0.1, f"screening {count} pairs of dyads")
        limit = self.problem.constraints.min_transmission_angle
        for least in USABLE_TRANSMISSION_ANGLES if limit is None else (limit,):
            screening = self._screened(self.problem.constraints, least)
            if screening.score.any() or "transmission_angle" not in screening.rejected():
                break
        sound = int(np.count_nonzero(screening.score))
        progress(0.8, f"verifying the best of {sound} pairs that passed the screening")
        self.rejected.update(screening.rejected())
        tried = 0
        for i, j in self._best(screening):
            tried += 1
            self._count([self._verify(i, j)])
            if len(self.passed) == self.problem.max_designs:
                break
        if sound > tried:
            self.rejected["outranked"] = sound - tried
        if self.problem.include_failed and len(self.passed) < self.problem.max_designs:
            self._add_failed()
        progress(1.0, "verified")
        return self._result("dyad_search", False, count, self._summary_of_search(count, sound))

    def none(self, cloud: Cloud, side: str) -> MotionResult:
        """The answer when one side has no dyad at all, with the reason."""
        method = "dyad_search" if self.sampled else "exact"
        return self._result(method, cloud.complete, 0, cloud.reason.replace("the side", f"the {side} side"))

    def _count(self, verdicts: list[str]) -> None:
        """Count a candidate by the verdicts on the ways in which it can be driven: accepted if one passes."""
        if "" in verdicts:
            self.accepted += 1
        else:
            self.rejected[verdicts[0]] += 1

    def _verify(self, i: int, j: int) -> str:
        """Drive the linkage of an input and an output dyad, and put it where it belongs.

        The answer is why it was rejected; empty where it passed.
        """
        o2, a = self._pivots(self.problem.input_side, self.inputs, i)
        o4, b = self._pivots(self.problem.output_side, self.outputs, j)
        lengths = abs(a - o2), abs(b - a), abs(b - o4), abs(o4 - o2)
        if min(lengths) <= SHORTEST_LINK * max(lengths):
            return "degenerate"
        mechanism = fourbar_mechanism(FourbarConfiguration(o2, a, b, o4, self.task.origin))
        design = verify(self.problem, mechanism, self.demanded)
        if design is None:
            return "cannot_be_driven"
        if design.verification.passed:
            self.passed.append(design)
            return ""
        self.failed.append(design)
        name = next(check.name for check in design.verification.checks if not check.passed)
        return _REASONS.get(name, name)

    def _pivots(self, side: DyadChoices, dyads: Dyads, n: int) -> tuple[complex, complex]:
        """Fixed and moving pivot of a dyad in the problem's coordinates; those that the client stated, as stated."""
        stated = side.fixed_pivot, side.moving_pivot
        found = self.task.to_problem(complex(dyads.fixed[n])), self.task.to_problem(complex(dyads.moving[n]))
        wholes = map(whole_point, stated)
        fixed, moving = (f if s is None else s for s, f in zip(wholes, found, strict=True))
        return fixed, moving

    def _screened(self, constraints: Constraints, least_transmission_angle: float) -> Screening:
        wanted = demands(constraints, self.task, least_transmission_angle, self.problem.rank_by)
        return screen(self.task, self.inputs, self.outputs, wanted)

    def _best(self, screening: Screening) -> list[tuple[int, int]]:
        """The best-scored pairs that differ from one another, best first."""
        count = max(ATTEMPTS * self.problem.max_designs, LEAST_ATTEMPTS)
        score = screening.score.ravel()
        shortlist = np.argpartition(-score, min(SHORTLIST, score.size - 1))[:SHORTLIST]
        shortlist = shortlist[score[shortlist] > 0.0]
        shortlist = shortlist[np.lexsort((shortlist, -score[shortlist]))]
        i, j = np.unravel_index(shortlist, screening.score.shape)
        joints = np.stack(
            [self.inputs.fixed[i], self.inputs.moving[i], self.outputs.moving[j], self.outputs.fixed[j]], axis=1
        )
        chosen: list[int] = []
        for apart in APART:
            chosen = distinct(joints, count, float(apart))
            if len(chosen) >= min(count, len(joints)):
                break
        return [(int(i[k]), int(j[k])) for k in chosen]

    def _add_failed(self) -> None:
        """Add the best linkages that move as the task demands but break a limit of the client's."""
        demanded = self.problem.constraints
        motion_alone = Constraints(same_branch=demanded.same_branch, in_order=demanded.in_order)
        for i, j in self._best(self._screened(motion_alone, 0.0))[: self.problem.max_designs]:
            passed = len(self.passed)
            self._verify(i, j)
            del self.passed[passed:]  # what passes was met by the search already

    def _result(self, method: str, complete: bool, candidates: int, summary: str) -> MotionResult:
        shown = [*self.passed, *(self.failed if self.problem.include_failed else [])]
        designs = ranked(shown, self.problem.rank_by)[: self.problem.max_designs]
        return MotionResult(
            designs=designs,
            curves=_curves(self.task, designs),
            search=Search(
                method=method,
                complete=complete,
                candidates=candidates,
                accepted=self.accepted,
                rejected=dict(self.rejected),
                seed=self.problem.seed,
            ),
            summary=" ".join([summary, *self.remarks]),
        )

    def _summary_of_determined(self, count: int, complete: bool) -> str:
        verb = "carries" if self.accepted == 1 else "carry"
        noun = "linkage" if count == 1 else "linkages"
        if self.alike:
            dyads = len(self.inputs.fixed)
            text = f"{dyads} dyad{'s' * (dyads > 1)} with two pins {'make' if dyads > 1 else 'makes'} {count} {noun}"
            text += f", of which {self.accepted} {verb} the body through all positions." if count else "."
            if self.accepted and len(self.passed) > self.accepted:
                text += f" {len(self.passed) - self.accepted} can be driven from either side."
        else:
            text = f"{self.accepted} of {count} {noun} with the stated choices {verb} the body through all positions."
        if self.rejected:
            text += f" Rejected: {_listed(self.rejected)}."
        if not self.passed:
            text += " These are all, so no fourbar exists." if complete else " That does not prove that none exists."
        return text

    def _summary_of_search(self, count: int, sound: int) -> str:
        if not self.passed:
            reasons = {name: n for name, n in self.rejected.items() if name != "outranked"}
            return (
                f"None of the {count} pairs of dyads that were tried makes a linkage that satisfies all demands "
                f"(rejected: {_listed(reasons)}). A linkage may exist that the search did not meet."
            )
        best = max(design.metrics.min_transmission_angle for design in self.passed)
        text = (
            f"{sound} of {count} pairs of dyads passed the screening; the best {len(self.passed)} distinct ones were "
            f"driven and verified, with a least transmission angle of up to {best:.1f}°."
        )
        if best < USABLE_TRANSMISSION_ANGLES[0]:
            text += f" None that was found reaches {USABLE_TRANSMISSION_ANGLES[0]:.0f}°."
        return text


def _listed(counts: Mapping[str, int]) -> str:
    return ", ".join(f"{name.replace('_', ' ')} {n}" for name, n in counts.items())


def _remarks(problem: MotionProblem, inputs: Cloud, outputs: Cloud) -> list[str]:
    """What a client should know of the dyads beside the linkages."""
    remarks = []
    clouds = {"side": inputs} if inputs is outputs else {"input side": inputs, "output side": outputs}
    for name, cloud in clouds.items():
        if cloud.remark:
            remarks.append(cloud.remark.replace("the side", f"the {name}").strip())
        if cloud.sliders:
            count = len(cloud.sliders)
            kinds = " and ".join(sorted({slider.kind for slider in cloud.sliders}))
            remarks.append(
                f"{count} more dyad{'s' * (count > 1)} of the {name} {'have' if count > 1 else 'has'} a pivot "
                f"at infinity: a slider ({kinds})."
            )
    return list(dict.fromkeys(remarks))


def _curves(task: MotionTask, designs: list[LinkageDesign]) -> list[BurmesterBranch]:
    """Burmester's curves of a task of four positions for drawing, wide enough for the designs."""
    if len(task.points) != 4:
        return []
    curve = burmester_curve(task, DyadConditions(rotations=(None,) * 3))
    if curve is None:
        return []
    pivots = [joint for design in designs for joint in design.mechanism.skeleton.joints.values()]
    reach = max((abs(task.to_task(complex(*pivot))) for pivot in pivots), default=0.0)
    centres = complex(task.points.mean()), complex(task.points[0])
    window = Window(centres, max(CURVES_REACH, 1.5 * reach), math.inf)
    return [
        BurmesterBranch(
            centre_points=[to_point(task.to_problem(complex(z))) for z in branch.dyads.fixed],
            circle_points=[to_point(task.to_problem(complex(z))) for z in branch.dyads.moving],
            closed=branch.closed,
        )
        for branch in branches(curve, window, CURVES_SAMPLES)
    ]
