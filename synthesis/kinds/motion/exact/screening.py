"""Screening of all pairs of an input dyad and an output dyad, in a compiled kernel.

Both dyads carry the same body, so the positions of all four joints at every target are known and no linkage has to be
solved. The screening decides whether one motion of the input meets all targets:

* Assembly. At target k the sign of (B − A) × (B − O4) gives the assembly; it must be the same at all targets.
* Order. The input turns in one direction: its rotations ρ_k from the first target, taken modulo a full turn, must rise
  (turning counter-clockwise) or fall (clockwise). With two targets both directions are possible, and the shorter is
  taken. This depends on the input dyad alone; if it fails and order is required, all its pairs are rejected.
* Toggles and transmission. The diagonal f = |O4 − A| decides both. While the input turns, f has its extremes at the
  ends of the range or where the input lies on the ground line. So the range contains no toggle if
  cos γ = (b² + c² − f²) / 2bc stays within ±1 there, and its largest magnitude is the cosine of the minimum
  transmission angle.

The score of a feasible pair is :func:`synthesis.verification.measures.compute_quality`, multiplied by a factor for the
input's rotation (:func:`synthesis.verification.body_motion.compute_ease`; the body's path length is measured only for
designs). The verdicts only select candidates; every returned design is verified by the analysis core from its
dimensions.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.compiling import njit
from synthesis.kinds.motion.dyads.equations import Dyads
from synthesis.kinds.motion.task.positions import MotionTask
from synthesis.model.linkage.problem import Constraints
from synthesis.verification.body_motion import compute_ease
from synthesis.verification.measures import compute_quality

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
"""Possible verdicts on a pair; the kernel returns the index."""

LIMIT_REASONS = frozenset({"link_length", "link_ratio", "grashof", "full_rotation", "transmission_angle"})
"""Verdicts on pairs that move correctly, or may do so, and violate a limit."""

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

TOGGLE_COSINE = 1.0 - 1e-9
"""|cos γ| from which coupler and output count as collinear (a toggle or change point), given the rounding of long
links."""

MIN_LINK_SHARE = 1e-4
"""Minimum length of a link, relative to the longest; below it the linkage is degenerate."""

ANY_GRASHOF, CRANK_ROCKER, DOUBLE_CRANK, DOUBLE_ROCKER, NON_GRASHOF = range(5)
_GRASHOF_CODES = {
    "any": ANY_GRASHOF,
    "crank_rocker": CRANK_ROCKER,
    "double_crank": DOUBLE_CRANK,
    "double_rocker": DOUBLE_ROCKER,
    "non_grashof": NON_GRASHOF,
}


BY_QUALITY, BY_SIZE, BY_TRANSMISSION = range(3)
_RANKING_CODES = {"quality": BY_QUALITY, "accuracy": BY_QUALITY, "size": BY_SIZE, "transmission_angle": BY_TRANSMISSION}
"""Quantity that the score measures, by ``rank_by``. Exact designs all have the same accuracy."""

PAST_TOGGLE_SINE = 1e-3
"""Sine used in the score as the transmission angle of a motion through a toggle, so that such a pair ranks low."""


class ScreeningConstraints(NamedTuple):
    """The client's constraints in the kernel's form; lengths in task units."""

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
    """Verdicts (index into :data:`REASONS`) and scores of all pairs, shape (inputs, outputs).

    Scores are positive for feasible pairs (higher is better) and 0 for all others.
    """

    verdict: NDArray[np.int8]
    score: NDArray[np.float32]

    def count_rejections(self) -> dict[str, int]:
        """Count the rejected pairs by reason, for reasons that occur."""
        counts = np.zeros(len(REASONS), np.int64)
        _count(self.verdict, counts)
        return {name: int(n) for name, n in zip(REASONS, counts, strict=True) if n and name != "sound"}


def make_screening_constraints(
    constraints: Constraints, task: MotionTask, least_transmission_angle: float, rank_by: str = "quality"
) -> ScreeningConstraints:
    """Convert constraints to task units; the minimum transmission angle, degrees, is a separate argument."""
    limits = constraints.link_length
    return ScreeningConstraints(
        least_transmission_cosine=math.cos(math.radians(least_transmission_angle)),
        grashof=_GRASHOF_CODES[constraints.grashof],
        full_rotation=constraints.full_rotation,
        same_branch=constraints.same_branch,
        in_order=constraints.in_order,
        shortest=0.0 if limits is None else limits.min / task.size,
        longest=math.inf if limits is None or limits.max is None else limits.max / task.size,
        link_ratio=math.inf if constraints.max_link_ratio is None else constraints.max_link_ratio,
        rank_by=_RANKING_CODES[rank_by],
    )


def screen(task: MotionTask, inputs: Dyads, outputs: Dyads, constraints: ScreeningConstraints) -> Screening:
    """Screen every pair of an input and an output dyad.

    Parameters
    ----------
    task : MotionTask
        n positions.
    inputs, outputs : Dyads
        Shapes (i,) and (o,), task coordinates.
    constraints : ScreeningConstraints
        The constraints on a pair.
    """
    shape = (len(inputs.fixed), len(outputs.fixed))
    # The verdict of dyads that the kernel skips.
    verdict, score = np.full(shape, ORDER_DEFECT, np.int8), np.zeros(shape, np.float32)
    _screen(
        np.ascontiguousarray(task.images(inputs.moving)),
        np.ascontiguousarray(inputs.fixed),
        np.ascontiguousarray(task.images(outputs.moving)),
        np.ascontiguousarray(outputs.fixed),
        task.points,
        constraints,
        verdict,
        score,
    )
    return Screening(verdict, score)


@njit(cache=True, nogil=True, error_model="numpy")
def _screen(
    a_images: NDArray[np.complex128],
    o2s: NDArray[np.complex128],
    b_images: NDArray[np.complex128],
    o4s: NDArray[np.complex128],
    points: NDArray[np.complex128],
    constraints: ScreeningConstraints,
    verdict: NDArray[np.int8],
    score: NDArray[np.float32],
) -> None:
    """Screen all pairs in place; pairs of an input dyad with an order defect keep the initial verdict and score."""
    n = a_images.shape[1]
    turned = np.empty((2, n))
    inputs, outputs = _compute_lengths(a_images, o2s), _compute_lengths(b_images, o4s)
    for i in range(len(o2s)):
        o2 = o2s[i]
        in_order = _compute_turns(a_images[i], o2, turned)
        if constraints.in_order and not (in_order[0] or in_order[1]):
            continue  # an order defect with every output
        # Sorted rotations serve the test of branches for all outputs.
        around = np.sort(turned[0])
        _screen_row(
            i,
            a_images,
            o2,
            inputs[i],
            b_images,
            o4s,
            outputs,
            turned,
            around,
            in_order,
            points,
            constraints,
            verdict,
            score,
        )


@njit(cache=True, nogil=True)
def _count(verdict: NDArray[np.int8], counts: NDArray[np.int64]) -> None:
    """Count each verdict. A loop is faster here: NumPy's bincount would first widen millions of int8 values."""
    for row in verdict:
        for reason in row:
            counts[reason] += 1


@njit(cache=True, nogil=True)
def _compute_lengths(images: NDArray[np.complex128], pivots: NDArray[np.complex128]) -> NDArray[np.float64]:
    """Return the link lengths of dyads, task units."""
    lengths = np.empty(len(pivots))
    for i in range(len(pivots)):
        lengths[i] = abs(images[i, 0] - pivots[i])
    return lengths


@njit(cache=True, nogil=True)
def _cross(u: complex, v: complex) -> float:
    return u.real * v.imag - u.imag * v.real


@njit(cache=True, nogil=True)
def _compute_abs(z: complex) -> float:
    """Return |z| without the overflow protection of ``abs``; valid for numbers of moderate size."""
    return math.sqrt(z.real * z.real + z.imag * z.imag)


@njit(cache=True, nogil=True)
def _compute_turns(a: NDArray[np.complex128], o2: complex, turned: NDArray[np.float64]) -> tuple[bool, bool]:
    """Fill the input rotations from the first target, counter-clockwise (row 0) and clockwise (row 1), radians.

    Return for each direction whether the targets are met in order.
    """
    n = len(a)
    # Multiplication by the conjugate subtracts angles without trigonometry.
    first = (a[0] - o2).conjugate()
    for k in range(n):
        rotation = 0.0
        if k > 0:
            z = (a[k] - o2) * first
            rotation = math.atan2(z.imag, z.real)
        # Both directions measured over a full turn: 0 to 2π, and −2π to 0.
        turned[0, k] = rotation if rotation >= 0.0 else rotation + 2.0 * math.pi
        turned[1, k] = rotation if rotation <= 0.0 else rotation - 2.0 * math.pi
    rising = falling = True
    for k in range(1, n):
        rising = rising and turned[0, k] > turned[0, k - 1]
        falling = falling and turned[1, k] < turned[1, k - 1]
    return rising, falling


@njit(cache=True, nogil=True, error_model="numpy")
def _screen_row(
    i: int,
    a_images: NDArray[np.complex128],
    o2: complex,
    a: float,
    b_images: NDArray[np.complex128],
    o4s: NDArray[np.complex128],
    outputs: NDArray[np.float64],
    turned: NDArray[np.float64],
    around: NDArray[np.float64],
    in_order: tuple[bool, bool],
    points: NDArray[np.complex128],
    constraints: ScreeningConstraints,
    verdict: NDArray[np.int8],
    score: NDArray[np.float32],
) -> None:
    """Screen the pairs of one input dyad with all outputs.

    This is one long loop because passing arrays to a function for each pair would cost more than the tests themselves.
    """
    n = a_images.shape[1]
    for j in range(len(o4s)):
        o4, c = o4s[j], outputs[j]
        ground = o4 - o2
        b, d = _compute_abs(b_images[j, 0] - a_images[i, 0]), _compute_abs(ground)
        shortest, longest = min(a, b, c, d), max(a, b, c, d)
        # Extremely short links make all later tests meaningless.
        if shortest <= MIN_LINK_SHARE * longest:
            verdict[i, j] = DEGENERATE
            continue
        if shortest < constraints.shortest or longest > constraints.longest:
            verdict[i, j] = LINK_LENGTH
            continue
        if longest > constraints.link_ratio * shortest:
            verdict[i, j] = LINK_RATIO
            continue
        # Strict: a change point (equality) has an undetermined motion.
        grashof = 2.0 * (shortest + longest) < a + b + c + d
        if constraints.grashof != ANY_GRASHOF:
            crank = grashof and shortest == a
            good = (
                (constraints.grashof == CRANK_ROCKER and crank)
                or (constraints.grashof == DOUBLE_CRANK and grashof and shortest == d)
                or (constraints.grashof == DOUBLE_ROCKER and grashof and shortest == b)
                or (constraints.grashof == NON_GRASHOF and not grashof)
            )
            if not good:
                verdict[i, j] = GRASHOF
                continue
        # Cheapest tests come first: most pairs are rejected before the targets are compared.
        input_turns_through = grashof and shortest in (a, d)
        if constraints.full_rotation and not input_turns_through:
            verdict[i, j] = FULL_ROTATION
            continue

        one_assembly = True
        first_cross = _cross(b_images[j, 0] - a_images[i, 0], b_images[j, 0] - o4)
        for k in range(1, n):
            if not first_cross * _cross(b_images[j, k] - a_images[i, k], b_images[j, k] - o4) > 0.0:
                one_assembly = False
                break
        if input_turns_through and not one_assembly:
            verdict[i, j] = CIRCUIT_DEFECT
            continue
        if grashof and not input_turns_through:
            # A Grashof rocker swings on one side of the ground line only; the two sides are different circuits.
            one_side = True
            first_lateral = _cross(ground, a_images[i, 0] - o2)
            for k in range(1, n):
                one_side = one_side and first_lateral * _cross(ground, a_images[i, k] - o2) > 0.0
            if not one_side:
                verdict[i, j] = CIRCUIT_DEFECT
                continue

        best = 2.0  # largest |cos γ| over the chosen range; above 1 no range is free of toggles
        swept = 0.0  # rotation of the input over that range, radians
        # Without one assembly at all targets no range can work.
        if one_assembly:
            first, last = (a_images[i, 0] - o2) * ground.conjugate(), (a_images[i, n - 1] - o2) * ground.conjugate()
            near, far = min(first.real, last.real) / (a * d), max(first.real, last.real) / (a * d)
            shorter = 0 if turned[0, n - 1] <= -turned[1, n - 1] else 1
            for way in (1 - shorter, shorter):  # the shorter range overwrites the longer one if it has no toggle
                if in_order[way]:
                    folded, stretched = _check_ground_line(first, last, turned[way, n - 1])
                    worst = _find_larger_cosine(a, b, c, d, -1.0 if folded else near, 1.0 if stretched else far)
                    if worst < TOGGLE_COSINE:
                        best, swept = worst, abs(turned[way, n - 1])
            if best >= TOGGLE_COSINE:
                # No ordered range works: tell an order defect from a branch defect by allowing any order.
                out_of_order, around_all = _find_unordered_range(a, b, c, d, math.atan2(first.imag, first.real), around)
                if out_of_order < TOGGLE_COSINE:
                    if constraints.in_order:
                        verdict[i, j] = ORDER_DEFECT
                        continue
                    best, swept = out_of_order, around_all
        if best >= TOGGLE_COSINE:
            if constraints.same_branch:
                verdict[i, j] = BRANCH_DEFECT
                continue
            best = 1.0
        if best > constraints.least_transmission_cosine:
            verdict[i, j] = TRANSMISSION_ANGLE
            continue
        # A motion through a toggle still gets a rank, below all others.
        sine = max(math.sqrt(1.0 - best * best), PAST_TOGGLE_SINE)
        verdict[i, j] = SOUND
        if constraints.rank_by == BY_TRANSMISSION:
            score[i, j] = sine
        elif constraints.rank_by == BY_SIZE:
            # Smaller is better, and scores are positive.
            score[i, j] = 1.0 / _measure_diagonal(a_images, i, o2, b_images, j, o4, points)
        else:
            reach = max(longest, _compute_abs(a_images[i, 0]), _compute_abs(b_images[j, 0]))
            score[i, j] = compute_quality(sine, reach, longest / shortest) * compute_ease(swept, 0.0)


@njit(cache=True, nogil=True)
def _measure_diagonal(
    a_images: NDArray[np.complex128],
    i: int,
    o2: complex,
    b_images: NDArray[np.complex128],
    j: int,
    o4: complex,
    points: NDArray[np.complex128],
) -> float:
    """Return the diagonal of the bounding box of all joints and the body's point at all targets."""
    left, right = min(o2.real, o4.real), max(o2.real, o4.real)
    low, high = min(o2.imag, o4.imag), max(o2.imag, o4.imag)
    for k in range(len(points)):
        for z in (a_images[i, k], b_images[j, k], points[k]):
            left, right = min(left, z.real), max(right, z.real)
            low, high = min(low, z.imag), max(high, z.imag)
    return math.hypot(right - left, high - low)


@njit(cache=True, nogil=True)
def _find_unordered_range(
    a: float, b: float, c: float, d: float, delta: float, around: NDArray[np.float64]
) -> tuple[float, float]:
    """Return the largest |cos γ| over the shortest toggle-free range through all targets, and that range, radians.

    |cos γ| is 2 if there is no such range. A range omits one of the gaps between neighbouring targets; ``around`` holds
    the input rotations of the targets in ascending order.
    """
    best, longest = 2.0, 0.0
    # The range that omits the widest gap is the shortest one.
    for k in range(len(around)):
        after = around[k + 1] if k + 1 < len(around) else around[0] + 2.0 * math.pi
        gap = after - around[k]
        worst = _find_worst_cosine(a, b, c, d, delta + after, delta + around[k] + 2.0 * math.pi)
        if worst < TOGGLE_COSINE and gap > longest:
            best, longest = worst, gap
    return best, 2.0 * math.pi - longest


@njit(cache=True, nogil=True)
def _find_worst_cosine(a: float, b: float, c: float, d: float, start: float, end: float) -> float:
    """Return the largest |cos γ| while the input turns up from start to end; above 1 if it passes a toggle."""
    turn = 2.0 * math.pi
    # |cos γ| has interior extremes only where the input lies on the ground line, at multiples of π.
    near, far = min(math.cos(start), math.cos(end)), max(math.cos(start), math.cos(end))
    if math.floor(end / turn) >= math.ceil(start / turn):
        far = 1.0
    if math.floor((end - math.pi) / turn) >= math.ceil((start - math.pi) / turn):
        near = -1.0
    return _find_larger_cosine(a, b, c, d, near, far)


@njit(cache=True, nogil=True)
def _check_ground_line(first: complex, last: complex, turned: float) -> tuple[bool, bool]:
    """Return whether an input turning from first to last points away from O4 in between, and whether towards it.

    The two are directions relative to the ground line; the turn, within one revolution, fixes the direction of motion.
    """
    # A clockwise turn is the mirror image of a counter-clockwise one.
    start, end = (first.imag, last.imag) if turned >= 0.0 else (-first.imag, -last.imag)
    # Up to half a turn: the ground line is passed if the imaginary part changes its sign in the right direction.
    if abs(turned) <= math.pi:
        return start >= 0.0 and end <= 0.0, start <= 0.0 and end >= 0.0
    return not (start < 0.0 and end > 0.0), not (start > 0.0 and end < 0.0)


@njit(cache=True, nogil=True)
def _find_larger_cosine(a: float, b: float, c: float, d: float, near: float, far: float) -> float:
    """Return the larger |cos γ| of two input angles, given by their cosines relative to the ground line."""
    # cos γ is linear in the cosine of the input angle, so its extremes are at the ends.
    constant = b * b + c * c - a * a - d * d
    gamma_one = (constant + 2.0 * a * d * far) / (2.0 * b * c)
    gamma_two = (constant + 2.0 * a * d * near) / (2.0 * b * c)
    return max(abs(gamma_one), abs(gamma_two))
