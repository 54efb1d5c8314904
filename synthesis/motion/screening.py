"""Screening of all pairs of an input dyad and an output dyad, in a compiled kernel.

Both dyads carry the same body, so the positions of all four joints at every target are known; no linkage is solved for.
What has to be decided for a pair is whether one motion of the input meets the targets:

* Assembly. At target k the sign of (B − A) × (B − O4) tells the assembly; all targets must agree.
* Order. The input turns one way: its rotations ρ_k from the first target, taken modulo a full turn, must rise
  (turning counter-clockwise) or fall (clockwise). With two targets both ways are open, and the shorter is taken. The
  input dyad alone decides it; where it fails and order is demanded, that is the verdict on all its pairs.
* Toggles and transmission. The diagonal f = |O4 − A| decides both. While the input turns, f has its extremes at the
  ends of the range or where the input lies on the ground line, so the range holds no toggle when
  cos γ = (b² + c² − f²) / 2bc stays within ±1 there, and its largest magnitude is the cosine of the least
  transmission angle.

The score of a sound pair is :func:`synthesis.ranking.quality`. The verdicts are for choosing among candidates only;
what is returned to a client is verified by the analysis core from the dimensions.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from synthesis.motion.dyads import Dyads
from synthesis.motion.task import MotionTask
from synthesis.problems import Constraints
from synthesis.ranking import quality

REASONS = (
    "sound",
    "degenerate",
    "link_length",
    "link_ratio",
    "grashof",
    "full_rotation",
    "circuit_defect",
    "branch_defect",
    "order_defect",
    "transmission_angle",
)
"""What becomes of a pair; the kernel returns the index."""

(
    SOUND,
    DEGENERATE,
    LINK_LENGTH,
    LINK_RATIO,
    GRASHOF,
    FULL_ROTATION,
    CIRCUIT_DEFECT,
    BRANCH_DEFECT,
    ORDER_DEFECT,
    TRANSMISSION_ANGLE,
) = range(len(REASONS))

FOLDED = 1.0 - 1e-9
"""|cos γ| from which coupler and output count as in line: a toggle or change point, to the rounding of long links."""

SHORTEST_LINK = 1e-4
"""A link shorter than this share of the longest is no link: the linkage is degenerate."""

ANY, CRANK_ROCKER, DOUBLE_CRANK, DOUBLE_ROCKER, NON_GRASHOF = range(5)
_GRASHOF_DEMAND = {
    "any": ANY,
    "crank_rocker": CRANK_ROCKER,
    "double_crank": DOUBLE_CRANK,
    "double_rocker": DOUBLE_ROCKER,
    "non_grashof": NON_GRASHOF,
}


BY_QUALITY, BY_SIZE, BY_TRANSMISSION = range(3)
_RANKING = {"quality": BY_QUALITY, "accuracy": BY_QUALITY, "size": BY_SIZE, "transmission_angle": BY_TRANSMISSION}
"""What the score goes by. Exact designs are all alike in accuracy."""

PAST_TOGGLE = 1e-3
"""Sine that stands for the transmission angle of a motion past a toggle in a score, so that it counts for little."""


class Demands(NamedTuple):
    """The client's constraints as the kernel takes them; lengths in task units."""

    least_transmission_cosine: float
    grashof: int
    full_rotation: bool
    same_branch: bool
    in_order: bool
    shortest: float
    longest: float
    link_ratio: float
    rank_by: int


class Screening(NamedTuple):
    """Verdicts of all pairs, index into :data:`REASONS`, and scores, shape (inputs, outputs).

    Scores are positive for sound pairs, higher is better, and 0 for all others.
    """

    verdict: NDArray[np.int8]
    score: NDArray[np.float32]

    def rejected(self) -> dict[str, int]:
        """How many pairs were rejected for each reason that occurred."""
        counts = np.bincount(self.verdict.ravel(), minlength=len(REASONS))
        return {name: int(n) for name, n in zip(REASONS, counts, strict=True) if n and name != "sound"}


def demands(
    constraints: Constraints, task: MotionTask, least_transmission_angle: float, rank_by: str = "quality"
) -> Demands:
    """Constraints in task units; the least transmission angle, degrees, is given apart."""
    limits = constraints.link_length
    return Demands(
        least_transmission_cosine=math.cos(math.radians(least_transmission_angle)),
        grashof=_GRASHOF_DEMAND[constraints.grashof],
        full_rotation=constraints.full_rotation,
        same_branch=constraints.same_branch,
        in_order=constraints.in_order,
        shortest=0.0 if limits is None else limits.min / task.size,
        longest=math.inf if limits is None or limits.max is None else limits.max / task.size,
        link_ratio=math.inf if constraints.max_link_ratio is None else constraints.max_link_ratio,
        rank_by=_RANKING[rank_by],
    )


def screen(task: MotionTask, inputs: Dyads, outputs: Dyads, wanted: Demands) -> Screening:
    """Screen every pair of an input and an output dyad.

    Parameters
    ----------
    task : MotionTask
        n positions.
    inputs, outputs : Dyads
        Shapes (i,) and (o,), task coordinates.
    wanted : Demands
        What a pair must satisfy.
    """
    shape = (len(inputs.fixed), len(outputs.fixed))
    verdict, score = np.full(shape, ORDER_DEFECT, np.int8), np.zeros(shape, np.float32)
    _screen(
        np.ascontiguousarray(task.images(inputs.moving)),
        np.ascontiguousarray(inputs.fixed),
        np.ascontiguousarray(task.images(outputs.moving)),
        np.ascontiguousarray(outputs.fixed),
        task.points,
        wanted,
        verdict,
        score,
    )
    return Screening(verdict, score)


@njit(cache=True, nogil=True)
def _screen(
    a_images: NDArray[np.complex128],
    o2s: NDArray[np.complex128],
    b_images: NDArray[np.complex128],
    o4s: NDArray[np.complex128],
    points: NDArray[np.complex128],
    wanted: Demands,
    verdict: NDArray[np.int8],
    score: NDArray[np.float32],
) -> None:
    """Judge all pairs; those that are not judged keep the verdict and score that they have."""
    n = a_images.shape[1]
    turned = np.empty((2, n))
    for i in range(len(o2s)):
        o2 = o2s[i]
        in_order = _turns(a_images[i], o2, turned)
        if wanted.in_order and not (in_order[0] or in_order[1]):
            continue  # an order defect with every output
        for j in range(len(o4s)):
            verdict[i, j], score[i, j] = _judge(a_images[i], o2, b_images[j], o4s[j], turned, in_order, points, wanted)


@njit(cache=True, nogil=True)
def _turns(a: NDArray[np.complex128], o2: complex, turned: NDArray[np.float64]) -> tuple[bool, bool]:
    """Input rotations from the first target, counter-clockwise (row 0) and clockwise; which way they are in order."""
    n = len(a)
    first = (a[0] - o2).conjugate()
    for k in range(n):
        rotation = 0.0
        if k > 0:
            z = (a[k] - o2) * first
            rotation = math.atan2(z.imag, z.real)
        turned[0, k] = rotation if rotation >= 0.0 else rotation + 2.0 * math.pi
        turned[1, k] = rotation if rotation <= 0.0 else rotation - 2.0 * math.pi
    rising = falling = True
    for k in range(1, n):
        rising = rising and turned[0, k] > turned[0, k - 1]
        falling = falling and turned[1, k] < turned[1, k - 1]
    return rising, falling


@njit(cache=True, nogil=True)
def _judge(
    a_k: NDArray[np.complex128],
    o2: complex,
    b_k: NDArray[np.complex128],
    o4: complex,
    turned: NDArray[np.float64],
    in_order: tuple[bool, bool],
    points: NDArray[np.complex128],
    wanted: Demands,
) -> tuple[int, float]:
    n = len(a_k)
    ground = o4 - o2
    a, b, c, d = abs(a_k[0] - o2), abs(b_k[0] - a_k[0]), abs(b_k[0] - o4), abs(ground)
    shortest, longest = min(a, b, c, d), max(a, b, c, d)
    if shortest <= SHORTEST_LINK * longest:
        return DEGENERATE, 0.0
    if shortest < wanted.shortest or longest > wanted.longest:
        return LINK_LENGTH, 0.0
    if longest > wanted.link_ratio * shortest:
        return LINK_RATIO, 0.0
    grashof = 2.0 * (shortest + longest) < a + b + c + d
    if wanted.grashof != ANY:
        crank = grashof and shortest == a
        good = (
            (wanted.grashof == CRANK_ROCKER and crank)
            or (wanted.grashof == DOUBLE_CRANK and grashof and shortest == d)
            or (wanted.grashof == DOUBLE_ROCKER and grashof and shortest == b)
            or (wanted.grashof == NON_GRASHOF and not grashof)
        )
        if not good:
            return GRASHOF, 0.0
    input_turns_through = grashof and shortest in (a, d)
    if wanted.full_rotation and not input_turns_through:
        return FULL_ROTATION, 0.0

    one_assembly = True
    one_side = True
    assembly = 0.0
    side = 0.0
    for k in range(n):
        coupler, output = b_k[k] - a_k[k], b_k[k] - o4
        cross = coupler.real * output.imag - coupler.imag * output.real
        crank = a_k[k] - o2
        lateral = ground.real * crank.imag - ground.imag * crank.real
        if k == 0:
            assembly, side = cross, lateral
        one_assembly = one_assembly and assembly * cross > 0.0
        one_side = one_side and side * lateral > 0.0
    if input_turns_through and not one_assembly:
        return CIRCUIT_DEFECT, 0.0
    if grashof and not input_turns_through and not one_side:
        return CIRCUIT_DEFECT, 0.0

    best = 2.0  # largest |cos γ| on the way that is taken; above 1 none is free of toggles
    if one_assembly:
        first = (a_k[0] - o2) * ground.conjugate()
        delta = math.atan2(first.imag, first.real)
        shorter = 0 if turned[0, n - 1] <= -turned[1, n - 1] else 1
        for way in (1 - shorter, shorter):  # the shorter way that is free of toggles has the last word
            if in_order[way]:
                worst = _worst_cosine(a, b, c, d, delta, delta + turned[way, n - 1])
                if worst < FOLDED:
                    best = worst
        if best >= FOLDED:
            out_of_order = _out_of_order(a, b, c, d, delta, turned[0])
            if out_of_order < FOLDED:
                if wanted.in_order:
                    return ORDER_DEFECT, 0.0
                best = out_of_order
    if best >= FOLDED:
        if wanted.same_branch:
            return BRANCH_DEFECT, 0.0
        best = 1.0
    if best > wanted.least_transmission_cosine:
        return TRANSMISSION_ANGLE, 0.0
    sine = max(math.sqrt(1.0 - best * best), PAST_TOGGLE)
    if wanted.rank_by == BY_TRANSMISSION:
        return SOUND, sine
    if wanted.rank_by == BY_SIZE:
        return SOUND, 1.0 / _size(a_k, o2, b_k, o4, points)
    reach = max(longest, max(abs(a_k[0]), abs(b_k[0])))
    return SOUND, quality(sine, reach, longest / shortest)


@njit(cache=True, nogil=True)
def _size(
    a_k: NDArray[np.complex128], o2: complex, b_k: NDArray[np.complex128], o4: complex, points: NDArray[np.complex128]
) -> float:
    """Diagonal of the box around all joints and the body's point at all targets."""
    left, right = min(o2.real, o4.real), max(o2.real, o4.real)
    low, high = min(o2.imag, o4.imag), max(o2.imag, o4.imag)
    for k in range(len(a_k)):
        for z in (a_k[k], b_k[k], points[k]):
            left, right = min(left, z.real), max(right, z.real)
            low, high = min(low, z.imag), max(high, z.imag)
    return math.hypot(right - left, high - low)


@njit(cache=True, nogil=True)
def _out_of_order(a: float, b: float, c: float, d: float, delta: float, turned: NDArray[np.float64]) -> float:
    """Largest |cos γ| over the shortest toggle-free range that covers all targets; 2 when there is none.

    Such a range leaves out one of the gaps between neighbouring targets.
    """
    around = np.sort(turned)
    best, longest = 2.0, 0.0
    for k in range(len(around)):
        after = around[k + 1] if k + 1 < len(around) else around[0] + 2.0 * math.pi
        gap = after - around[k]
        worst = _worst_cosine(a, b, c, d, delta + after, delta + around[k] + 2.0 * math.pi)
        if worst < FOLDED and gap > longest:
            best, longest = worst, gap
    return best


@njit(cache=True, nogil=True)
def _worst_cosine(a: float, b: float, c: float, d: float, start: float, end: float) -> float:
    """Largest |cos γ| while the input turns from start to end (angles from the ground line); above 1 past a toggle."""
    low, high = min(start, end), max(start, end)
    near = min(math.cos(low), math.cos(high))
    far = max(math.cos(low), math.cos(high))
    if math.floor(high / (2.0 * math.pi)) >= math.ceil(low / (2.0 * math.pi)):
        far = 1.0
    if math.floor((high - math.pi) / (2.0 * math.pi)) >= math.ceil((low - math.pi) / (2.0 * math.pi)):
        near = -1.0
    constant = b * b + c * c - a * a - d * d
    gamma_one = (constant + 2.0 * a * d * far) / (2.0 * b * c)
    gamma_two = (constant + 2.0 * a * d * near) / (2.0 * b * c)
    return max(abs(gamma_one), abs(gamma_two))
