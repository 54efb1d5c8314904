"""Residuals and constraints of a fourbar that carries a body through poses, each within its tolerance.

The unknowns are the pivots O2, O4, A and B (A and B with the body in the first target pose, task coordinates) and, for
each coordinate of a pose with a tolerance, its deviation in units of the tolerance. The constraints are inequalities
(g ≥ 0) and equations (h = 0) of :mod:`synthesis.numerics.augmented_lagrangian`:

=================== ==== ============================================================
constraint          g, h margin
=================== ==== ============================================================
workspace           g    of :mod:`synthesis.fit.workspace_margins`, if there is one
tolerance           g    1 ∓ deviation
pivot regions       g    distance from each side of a box; moving pivots in the first pose
link lengths        g    ln(l / l_min), ln(l_max / l)
link ratio          g    ln(ratio · lᵢ / lₖ)
transmission angle  g    cos γ_min ∓ cos γ, at the ends of the used range and on the ground line if it is passed
Grashof             g    P + Q − L − S for each L; the shortest link S is that of the start
one circuit         g    sin γ in each pose, in the assembly of the start
order               g    input rotation from each pose to the next, and the rest of a full turn
the links' lengths  h    |A_k − O2| − |A − O2|, |B_k − O4| − |B − O4|
given coordinates   h    distance along each axis; of fixed pivots from the ground line
=================== ==== ============================================================

The minimised residuals keep the linkage usable: cosines of transmission angles, lengths of links, and deviations. A
weighted term can keep it near its start, so that many starts lead to different linkages. Derivatives are central
differences: a fourbar has few unknowns, and the functions are smooth. The derivatives of workspace margins come from
:mod:`synthesis.kinds.motion.constrained.clearance_residuals`.
"""

from __future__ import annotations

import math

import numpy as np

from kinematics.arrays import Complex, Real
from kinematics.compiling import njit
from synthesis.fit.workspace_margins import count_margins
from synthesis.kinds.motion.constrained.clearance_residuals import append_room_rows
from synthesis.numerics.array_layout import ArrayLayout
from synthesis.numerics.augmented_lagrangian import append_limit_rows
from synthesis.numerics.levenberg import ROWS

PIVOT_COORDINATE_COUNT = 8
"""Number of unknowns that are coordinates of pivots."""

BOX_SIZE = 4
"""Number of sides of a box: x min, x max, y min, y max."""

SETTING = ArrayLayout(
    direction=1,
    assembly=1,
    shortest=1,
    cosine=1,
    min_link=1,
    max_link=1,
    ratio=1,
    fixed_boxes=2 * BOX_SIZE,
    moving_boxes=2 * BOX_SIZE,
    given_coordinates=PIVOT_COORDINATE_COUNT,
    line=3,
    home_pivots=PIVOT_COORDINATE_COUNT,
    home_weight=1,
)
"""Setting of a fit. The input's rotations from each pose to the next follow, known to half a turn. The workspace
parameters (:mod:`synthesis.fit.workspace`), if any, come last."""

DIRECTION, ASSEMBLY = SETTING.index("direction"), SETTING.index("assembly")
"""Direction of the input, ±1; sign of the assembly."""

SHORTEST = SETTING.index("shortest")
"""Required shortest link, 0 to 3 for d, a, b, c; −1 if open."""

COSINE = SETTING.index("cosine")
"""Cosine of the minimum transmission angle."""

MIN_LINK, MAX_LINK = SETTING.index("min_link"), SETTING.index("max_link")
"""Minimum and maximum length of a link; 0 and infinite if open."""

RATIO = SETTING.index("ratio")
"""Maximum link ratio; infinite if open."""

FIXED_BOXES, MOVING_BOXES = SETTING.slice("fixed_boxes"), SETTING.slice("moving_boxes")
"""Boxes of O2 and O4, and of A and B."""

BOXES = SETTING.slice("fixed_boxes", "moving_boxes")
"""Boxes of O2, O4, A and B."""

GIVEN_COORDINATES = SETTING.slice("given_coordinates")
"""Given coordinates of O2, O4, A and B; NaN if open."""

LINE = SETTING.slice("line")
"""Ground line: unit normal and offset; NaN if open."""

HOME_PIVOTS, HOME_WEIGHT_INDEX = SETTING.slice("home_pivots"), SETTING.index("home_weight")
"""Pivots to stay near, and the weight of that term."""

STEPS = SETTING.size
"""Index of the input's first rotation from one pose to the next."""

FIXED_RESIDUAL_COUNT = 14 + 8
"""Number of residuals other than those of deviations."""

LIMIT_TIGHTENING = 1e-7
"""Amount by which limits are tightened relative to their verification, in shares of a tolerance, transmission cosines
and logarithms of lengths."""

MIN_INPUT_STEP = 1e-3
"""Minimum rotation of the input from one pose to the next, radians."""

MIN_SINE = 1e-3
"""Minimum sine of the transmission angle in each pose, so that the linkage stays in its assembly."""

MIN_LENGTH = 1e-6
"""Minimum length of a link, task sizes; below it the linkage is degenerate."""

DIFFERENCE_STEP = 1e-5
"""Step of the unknowns for finite differences."""

COSINE_WEIGHT, RATIO_WEIGHT, LENGTH_WEIGHT, ARM_WEIGHT, DEVIATION_WEIGHT = 0.3, 0.15, 0.05, 0.05, 0.05
"""Weights of the minimised residuals: cosines of transmission angles, logarithms of links over their geometric mean,
lengths of links and distances of moving pivots from P in task sizes, and deviations in tolerances."""


@njit(cache=True, nogil=True)
def count_equations(poses: int) -> int:
    """Return the number of equations: the last margins, which must be zero."""
    return 2 * (poses - 1) + PIVOT_COORDINATE_COUNT + 2


@njit(cache=True, nogil=True)
def count_pose_margins(poses: int) -> int:
    """Return the number of all margins."""
    # Deviations, boxes, lengths, ratios, transmission, Grashof, circuit, order, equations.
    return 6 * poses + 16 + 8 + 12 + 8 + 3 + poses + poses + count_equations(poses)


@njit(cache=True, nogil=True)
def _cross(u: complex, v: complex) -> float:
    return u.real * v.imag - u.imag * v.real


@njit(cache=True, nogil=True)
def _evaluate_input_steps(a: Complex, o2: complex, setting: Real, margins: Real, m: int) -> float:
    """Write the margins of the input's rotations from index m on; return their sum."""
    n, turned = len(a), 0.0
    for k in range(n - 1):
        step = (a[k + 1] - o2) * (a[k] - o2).conjugate()
        # Unwrap the rotation towards its value at the start, so that it changes continuously during the fit.
        off = math.atan2(step.imag, step.real) - setting[STEPS + k]
        step_turned = setting[STEPS + k] + off - 2.0 * math.pi * round(off / (2.0 * math.pi))
        margins[m + k] = setting[DIRECTION] * step_turned - MIN_INPUT_STEP
        turned += step_turned
    margins[m + n - 1] = 2.0 * math.pi - MIN_INPUT_STEP - abs(turned)
    return turned


@njit(cache=True, nogil=True)
def _evaluate_equations(x: Real, a: Complex, b: Complex, lengths: Real, setting: Real, margins: Real, m: int) -> None:
    """Write the margins of the equations from index m on: constant links, given coordinates, and a given line."""
    o2, o4 = complex(x[0], x[1]), complex(x[2], x[3])
    for k in range(len(a) - 1):
        # Constant link lengths, the equations of the problem.
        margins[m], margins[m + 1] = abs(a[k + 1] - o2) - lengths[1], abs(b[k + 1] - o4) - lengths[3]
        m += 2
    given, line = setting[GIVEN_COORDINATES], setting[LINE]
    for k in range(PIVOT_COORDINATE_COUNT):
        if not math.isnan(given[k]):
            margins[m + k] = x[k] - given[k]
    m += PIVOT_COORDINATE_COUNT
    if not math.isnan(line[0]):
        for k in range(2):
            margins[m + k] = line[0] * x[2 * k] + line[1] * x[2 * k + 1] - line[2]


@njit(cache=True, nogil=True)
def _write_soft_residuals(
    x: Real, lengths: Real, arm_a: complex, arm_b: complex, setting: Real, residuals: Real, rows: int
) -> int:
    """Write the weak residuals that prefer usual proportions and the start's pivots; return the number of rows."""
    # Deviation from the geometric mean favours links of similar length, independently of the size.
    mean = np.log(lengths).mean()
    for k in range(4):
        residuals[rows + 2 * k] = RATIO_WEIGHT * (math.log(lengths[k]) - mean)
        residuals[rows + 2 * k + 1] = LENGTH_WEIGHT * lengths[k]
    residuals[rows + 8], residuals[rows + 9] = ARM_WEIGHT * abs(arm_a), ARM_WEIGHT * abs(arm_b)
    rows += 10
    home = setting[HOME_PIVOTS]
    for k in range(PIVOT_COORDINATE_COUNT):
        residuals[rows + k] = setting[HOME_WEIGHT_INDEX] * (x[k] - home[k])
    return rows + PIVOT_COORDINATE_COUNT


@njit(cache=True, nogil=True)
def _evaluate_transmission(
    a: Complex, o2: complex, o4: complex, lengths: Real, turned: float, setting: Real, residuals: Real, margins: Real,
    rows: int, m: int,
) -> None:  # fmt: skip
    """Write four residuals and four pairs of margins of transmission angles, where they can be extreme.

    These are the crank on the ground line, if the input's range contains it, and the first and the last position.
    """
    n, d, crank, coupler, output = len(a), lengths[0], lengths[1], lengths[2], lengths[3]
    ground = o4 - o2
    first = (a[0] - o2) * ground.conjugate()
    start = math.atan2(first.imag, first.real)
    low, high = min(start, start + turned), max(start, start + turned)
    for k in range(4):
        if k < 2:
            # Find the multiple of π (even for k = 0, odd for k = 1) that lies in the used range.
            passed = 2.0 * math.pi * math.ceil((low - k * math.pi) / (2.0 * math.pi)) + k * math.pi
            used = passed <= high
            # On the ground line the diagonal is the difference or the sum of ground and crank.
            diagonal = d - crank if k == 0 else d + crank
        else:
            used = True
            diagonal = abs(o4 - a[0 if k == 2 else n - 1])
        cosine = (coupler * coupler + output * output - diagonal * diagonal) / (2.0 * coupler * output)
        # Always a residual, even if 0: the number of rows must not change between difference steps.
        residuals[rows] = 0.0
        if used:
            residuals[rows] = COSINE_WEIGHT * cosine
            margins[m], margins[m + 1] = (
                setting[COSINE] - LIMIT_TIGHTENING - cosine,
                setting[COSINE] - LIMIT_TIGHTENING + cosine,
            )
        rows += 1
        m += 2


@njit(cache=True, nogil=True)
def _evaluate_margins(x: Real, points: Real, setting: Real, residuals: Real, margins: Real) -> int:
    """Write residuals and margins at x; return the number of residuals, or −1 if a link has no length."""
    n = len(points)
    o2, o4 = complex(x[0], x[1]), complex(x[2], x[3])
    arm_a, arm_b = complex(x[4] - points[0, 0], x[5] - points[0, 1]), complex(x[6] - points[0, 0], x[7] - points[0, 1])
    # Infinite margins bear no load; those that apply are overwritten below.
    margins[:] = np.inf
    a, b = np.empty(n, np.complex128), np.empty(n, np.complex128)
    at, m, rows = PIVOT_COORDINATE_COUNT, 0, 0
    pose = np.empty(3)
    for k in range(n):
        for c in range(3):
            pose[c] = points[k, c]
            if points[k, 3 + c] > 0.0:
                pose[c] += points[k, 3 + c] * x[at]
                # Tightened, so that a tolerance used to the limit passes verification after rounding.
                margins[m], margins[m + 1] = 1.0 - LIMIT_TIGHTENING - x[at], 1.0 - LIMIT_TIGHTENING + x[at]
                residuals[rows] = DEVIATION_WEIGHT * x[at]
                at += 1
                rows += 1
            # Reserve both margins of every coordinate, since multipliers belong to fixed places.
            m += 2
        spin, place = complex(math.cos(pose[2]), math.sin(pose[2])), complex(pose[0], pose[1])
        a[k], b[k] = place + spin * arm_a, place + spin * arm_b
    lengths = np.array([abs(o4 - o2), abs(a[0] - o2), abs(b[0] - a[0]), abs(b[0] - o4)])
    if not lengths.min() > MIN_LENGTH:
        return -1
    boxes = setting[BOXES]
    for pivot in range(4):
        z, box = (o2, o4, a[0], b[0])[pivot], boxes[BOX_SIZE * pivot :]
        margins[m], margins[m + 1] = z.real - box[0], box[1] - z.real
        margins[m + 2], margins[m + 3] = z.imag - box[2], box[3] - z.imag
        m += 4
    m = _evaluate_length_margins(lengths, setting, margins, m)
    # Margins of order follow those of transmission (8), Grashof (3) and circuit (n).
    turned = _evaluate_input_steps(a, o2, setting, margins, m + 8 + 3 + n)
    _evaluate_transmission(a, o2, o4, lengths, turned, setting, residuals, margins, rows, m)
    rows += 4
    m += 8
    shortest = int(setting[SHORTEST])
    if shortest >= 0:
        # P + Q − L − S = sum − 2 (L + S), for each possible longest link.
        around = lengths.sum()
        place_of = m
        for k in range(4):
            if k != shortest:
                margins[place_of] = around - 2.0 * (lengths[k] + lengths[shortest]) - MIN_LENGTH * around
                place_of += 1
    m += 3
    for k in range(n):
        # The sign of the cross product gives the assembly; at 0 the linkage is at a toggle.
        margins[m + k] = setting[ASSEMBLY] * _cross(b[k] - a[k], b[k] - o4) / (lengths[2] * lengths[3]) - MIN_SINE
    m += 2 * n
    _evaluate_equations(x, a, b, lengths, setting, margins, m)
    return _write_soft_residuals(x, lengths, arm_a, arm_b, setting, residuals, rows)


@njit(cache=True, nogil=True)
def _evaluate_length_margins(lengths: Real, setting: Real, margins: Real, m: int) -> int:
    """Write the logarithmic margins of link lengths and link ratios from index m on; return the next index."""
    for i in range(4):
        if setting[MIN_LINK] > 0.0:
            margins[m] = math.log(lengths[i] / setting[MIN_LINK]) - LIMIT_TIGHTENING
        if setting[MAX_LINK] < np.inf:
            margins[m + 1] = math.log(setting[MAX_LINK] / lengths[i]) - LIMIT_TIGHTENING
        m += 2
    for i in range(4):
        for k in range(4):
            if i != k:
                if setting[RATIO] < np.inf:
                    margins[m] = math.log(setting[RATIO] * lengths[i] / lengths[k]) - LIMIT_TIGHTENING
                m += 1
    return m


@njit(ROWS, cache=True, nogil=True)
def evaluate_rows(
    x: Real, points: Real, setting: Real, multipliers: Real, state: Real, residuals: Real, jacobian: Real
) -> int:
    """Evaluate residuals and limits with their Jacobian; see :data:`synthesis.numerics.levenberg.ROWS`.

    ``points`` are rows (x, y, angle, and the tolerance of each; 0 if exact) in task units and radians; ``state`` holds
    only the margins, those of the workspace first.
    """
    n, unknowns = len(points), x.size
    count = count_pose_margins(n)
    steps, room = setting[STEPS : STEPS + n - 1], setting[STEPS + n - 1 :]
    roomy = count_margins(room)
    own = state[roomy:]
    rows = _evaluate_margins(x, points, setting, residuals, own)
    if rows < 0:
        return -1
    gradients = np.zeros((count, unknowns))
    # One work array, restored after each difference.
    changed = x.copy()
    ahead, behind = np.empty(rows), np.empty(rows)
    further, back = np.empty(count), np.empty(count)
    for i in range(unknowns):
        changed[i] = x[i] + DIFFERENCE_STEP
        if _evaluate_margins(changed, points, setting, ahead, further) < 0:
            return -1
        changed[i] = x[i] - DIFFERENCE_STEP
        if _evaluate_margins(changed, points, setting, behind, back) < 0:
            return -1
        changed[i] = x[i]
        for k in range(rows):
            jacobian[k, i] = (ahead[k] - behind[k]) / (2.0 * DIFFERENCE_STEP)
        for k in range(count):
            # A margin at the ground line exists only while the line is passed: use a one-sided difference there.
            if own[k] == np.inf or (further[k] == np.inf and back[k] == np.inf):
                continue
            if back[k] == np.inf:
                gradients[k, i] = (further[k] - own[k]) / DIFFERENCE_STEP
            elif further[k] == np.inf:
                gradients[k, i] = (own[k] - back[k]) / DIFFERENCE_STEP
            else:
                gradients[k, i] = (further[k] - back[k]) / (2.0 * DIFFERENCE_STEP)
    if roomy > 0:
        rows = append_room_rows(
            x, points, setting[ASSEMBLY], steps, room, multipliers, state[:roomy], residuals, jacobian, rows
        )
        if rows < 0:
            return -1
    # Equations are the last margins of the fit.
    return int(append_limit_rows(own, gradients, count_equations(n), multipliers[roomy:], residuals, jacobian, rows))
