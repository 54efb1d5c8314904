"""Burmester's curves of four positions: the one-parameter family of all dyads, sampled evenly on every branch.

Three conditions leave a three-dimensional space for the points x of :mod:`synthesis.kinds.motion.dyads.finite_sets`, in
which the variety's quadrics meet in a curve of degree four; O/p and A/p along it are the centre-point curve and the
circle-point curve, both circular cubics. The combination of the quadrics |A_k − O|² = |A_j − O|² is ruled by the lines

    A_k − O = e^{iβ} (A_j − O),        β the rotation of the link from position j to position k.

With X = A_k − O and Y = A_j − O as coordinates (two complex linear forms, hence all four real ones) the line is
X = uρ, Y = conj(u)ρ with u = e^{iβ/2}, and meets the curve where another quadric vanishes, a quadratic form in ρ whose
coefficients are trigonometric polynomials of degree one in β:

    a ρ₁² + 2b ρ₁ρ₂ + c ρ₂² = 0,       Δ(β) = b² − ac.

So the curve covers the circle of β twice where Δ > 0. Δ has at most four zeros: between two of them the two sheets of
the root join to one closed loop; without zeros each sheet is a loop. This gives every real branch without tracing.
With β = middle − half · cos t each loop is smooth in t, and the sheet is the sign of sin t.

If the body has only two orientations (parallel positions), the point p = A = O = 0 is a vertex of the ruled quadric,
X and Y satisfy a linear equation n·(X, Y) = 0, and each line from the vertex meets the curve once more: one loop,

    ρ = i (ū n₁ + u n₂),        x = 2B(x₀, v) x₀ − B(x₀, x₀) v,

with x₀ any point of the line, v the vertex and B the other quadric.

A loop passes through p = 0 where a cubic runs to infinity along its asymptote; branches are cut there, and at the edge
of the window of interest. If the curve is reducible, whole lines of the ruling may belong to it (a body point that has
the same location in three positions is a circle point for every centre on a line); they are sampled separately.
"""

from __future__ import annotations

import math
from itertools import combinations, pairwise
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Complex, Real
from synthesis.kinds.motion.dyads.equations import DyadConditions, Dyads
from synthesis.kinds.motion.dyads.finite_sets import (
    VARIETY_FORMS,
    build_condition_rows,
    build_pose_rows,
    find_null_space,
)
from synthesis.kinds.motion.task.positions import MotionTask

COARSE_SAMPLE_COUNT = 512
"""Number of samples of a loop before they are spread evenly."""

RESAMPLING_COUNT = 3
"""Number of passes that redistribute the samples; each pass knows the arc length between them better."""

UNIT_CIRCLE_TOLERANCE = 1e-6
"""Distance from the unit circle up to which a zero of Δ counts as real. A spurious zero only splits a loop at a thin
part."""

RULING_TOLERANCE = 1e-7
"""Norm of the quadratic form on a line of the ruling, relative to the largest on the curve, below which the whole line
belongs to the curve."""

MIN_CONDITION = 1e-9
"""Minimum reciprocal condition number of (X, Y) as coordinates; below it half of the digits are lost."""

EVEN_SHARE = 0.2
"""Weight of an even spread in the parameter, relative to arc length, while the arc length is not yet known."""

MAX_STEP = 0.3
"""Maximum arc length counted for one step between samples, relative to the unit of arc length: a coarsely sampled part
of a branch must not attract all samples."""

MAX_GAP_STEPS = 3.0
"""Maximum distance of neighbouring samples, in steps of arc length; beyond it the branch left the window between
them."""

MIN_BRANCH_SAMPLES = 8
"""Minimum number of samples of a branch."""

INFINITY_TOLERANCE = 1e-9
"""Absolute value of p in a unit point x below which a pivot counts as infinitely far away."""

CURVE_TOLERANCE = 1e-9
"""Maximum misfit of the quadrics, relative to p, for a sample to be a dyad. The ends of very thin loops exceed it;
candidates are refined before they are verified."""


class Loop(NamedTuple):
    """A closed loop of the curve: β = middle − half · cos t on both sheets, or a full turn of β on one (half = π)."""

    middle: float
    half: float
    sheet: int  # ±1: the loop is one sheet; 0: it consists of both


class Branch(NamedTuple):
    """A connected branch of both curves, in order; task coordinates, shape (k,) each."""

    dyads: Dyads
    closed: bool


class Cone(NamedTuple):
    """The vertex v (shape (7,)), the equation n·(X, Y) = 0 (shape (2,), complex), and the other quadric (7, 7)."""

    vertex: Real
    normal: Complex
    quadric: Real

    def points(self, back: Real, beta: Real) -> Real:
        """Return the point of the curve on the line of each β: unit vectors (len(beta), 7)."""
        u = np.exp(0.5j * beta)
        # This ρ satisfies n·(X, Y) = 0 for every β, so x₀ is a real point of the line.
        start = _place_on_line(back, beta, 1j * (np.conj(u) * self.normal[0] + u * self.normal[1]))
        own = np.einsum("ki,ij,kj->k", start, self.quadric, start)
        # The line through the vertex and x₀ meets the quadric in the vertex and in this one point.
        return _normalize_points(
            2.0 * (start @ self.quadric @ self.vertex)[:, None] * start - own[:, None] * self.vertex
        )


class BurmesterCurve(NamedTuple):
    """Burmester's curve in a three-dimensional solution space.

    Attributes
    ----------
    back : float64, shape (7, 4)
        Linear map from (Re X, Im X, Re Y, Im Y) to x.
    coefficients : float64, shape (3, 3)
        a, b, c (rows) as combinations of 1, cos β, sin β.
    loops : tuple of Loop
        Every real branch.
    lines : tuple of float
        β of lines of the ruling that belong to the curve.
    cone : Cone or None
        Only for positions with two orientations.
    """

    back: Real
    coefficients: Real
    loops: tuple[Loop, ...]
    lines: tuple[float, ...]
    cone: Cone | None = None

    def points(self, loop: Loop, t: Real) -> Real:
        """Return unit points x (len(t), 7) of a loop at parameters t in [0, 2π), continuous up to sign."""
        if self.cone is not None:
            return self.cone.points(self.back, t)
        beta = loop.middle - loop.half * np.cos(t) if loop.sheet == 0 else loop.middle + t
        a, b, c = self.coefficients @ np.stack([np.ones_like(beta), np.cos(beta), np.sin(beta)])
        # Rounding makes Δ slightly negative at the ends of a loop, where it vanishes.
        root = np.sqrt(np.maximum(b * b - a * c, 0.0)) * (np.sign(np.sin(t)) if loop.sheet == 0 else loop.sheet)
        # Use the form of each root of the quadratic that does not suffer cancellation.
        adding = b * root > 0.0
        first = np.where(adding, -b - root, c)
        second = np.where(adding, a, -b + root)
        # a ρ₁² + 2b ρ₁ρ₂ + c ρ₂² with ρ₁ : ρ₂ = (−b − root) : a  and  c : (−b + root) are the same root.
        rho = first + 1j * second
        return _normalize_points(_place_on_line(self.back, beta, rho))

    def line_points(self, beta: float, t: Real) -> Real:
        """Return unit points x (len(t), 7) of a line that belongs to the curve, t in [0, π)."""
        return _normalize_points(_place_on_line(self.back, np.full_like(t, beta), np.exp(1j * t)))


def find_burmester_curve(task: MotionTask, conditions: DyadConditions) -> BurmesterCurve | None:
    """Find the curve of all dyads of four positions, or of fewer with linear conditions that leave one freedom.

    Return None if the conditions leave another number of freedoms, or a family of dyads for every β.
    """
    basis = find_null_space(np.concatenate([build_pose_rows(task), build_condition_rows(task, conditions)]))
    if basis.shape[1] != 4:
        return None
    # Rank 3 occurs only for two orientations of the body; it is tried if no pair gives four coordinates.
    for rank in (4, 3):
        ruling = _find_ruling(task, basis, rank)
        if ruling is not None:
            break
    else:
        return None
    back = basis @ ruling.back
    # The lines lie on the real part of turn · quadrics; its imaginary part intersects them.
    quadric = np.tensordot([ruling.turn.imag, ruling.turn.real], VARIETY_FORMS, 1)
    coefficients = _expand_quadratic(back.T @ quadric @ back)
    if rank == 3:
        cone = Cone(basis @ ruling.vertex, ruling.normal.view(np.complex128), quadric)
        return BurmesterCurve(back, coefficients, (Loop(0.0, math.pi, 1),), (), cone)
    return BurmesterCurve(back, coefficients, _find_loops(coefficients), _find_ruled_lines(coefficients))


class Window(NamedTuple):
    """Region of interest of a curve and its measure of arc length, in task coordinates.

    Attributes
    ----------
    centres : complex, shape (2,)
        Centres of the regions of the fixed and the moving pivot.
    reach : float
        Radius of the regions.
    near : float
        Arc length is measured relative to the distance from the centre, or to this value if that is smaller; infinite
        for plain arc length.
    """

    centres: tuple[complex, complex]
    reach: float
    near: float

    def contains(self, dyads: Dyads) -> np.ndarray:
        """Return a mask of the dyads with both pivots within reach."""
        fixed, moving = self.centres
        # The farther of the two pivots decides, because both must be practical.
        return np.asarray(np.maximum(np.abs(dyads.fixed - fixed), np.abs(dyads.moving - moving)) <= self.reach)

    def distances(self, dyads: Dyads) -> Real:
        """Return the distance of each dyad from the previous one, over both pivots together."""
        squares = np.zeros(len(dyads.fixed) - 1)
        for pivots, centre in zip(dyads, self.centres, strict=True):
            step = np.abs(np.diff(pivots))
            if not math.isinf(self.near):
                away = np.abs(pivots - centre)
                # The nearer end of the step gives the scale, so that a step towards the centre is not underestimated.
                step = step / np.hypot(self.near, np.minimum(away[1:], away[:-1]))
            squares += step * step
        return np.sqrt(squares)


class _Strand(NamedTuple):
    """One loop or line with parameters t over one period, and the arc length from the first parameter to each."""

    loop: Loop | float
    t: Real
    arc: Real


def sample_dyads(curve: BurmesterCurve, window: Window, count: int, phase: float = 0.5) -> Dyads:
    """Sample about ``count`` dyads, evenly along all branches; ``phase``, 0 to 1, shifts the samples."""
    strands = _make_strands(curve, window)
    total = sum(strand.arc[-1] for strand in strands)
    fixed, moving = [], []
    for strand in strands:
        # Each branch has its share of the samples by arc length; tiny branches may get none.
        number = int(count * strand.arc[-1] / total) if total > 0.0 else 0
        if number:
            t = np.interp((np.arange(number) + phase) * strand.arc[-1] / number, strand.arc, strand.t)
            dyads, finite, _ = _evaluate_dyads(curve, strand.loop, t)
            kept = finite & window.contains(dyads)
            fixed.append(dyads.fixed[kept])
            moving.append(dyads.moving[kept])
    none = np.empty(0, np.complex128)
    return Dyads(np.concatenate([none, *fixed]), np.concatenate([none, *moving]))


def sample_branches(curve: BurmesterCurve, window: Window, count: int) -> list[Branch]:
    """Sample all branches inside a window, with about ``count`` samples at equal arc length."""
    strands = _make_strands(curve, window)
    total = sum(strand.arc[-1] for strand in strands)
    found = []
    for strand in strands:
        # A curve that is drawn must show small branches, too.
        number = max(int(count * strand.arc[-1] / total), MIN_BRANCH_SAMPLES) if strand.arc[-1] > 0.0 else 0
        if number:
            t = np.interp(np.arange(number) * strand.arc[-1] / number, strand.arc, strand.t)
            found += _cut_branches(curve, window, strand.loop, t, MAX_GAP_STEPS * strand.arc[-1] / number)
    return found


def _cut_branches(curve: BurmesterCurve, window: Window, loop: Loop | float, t: Real, gap: float) -> list[Branch]:
    """Cut a loop where it leaves the window or passes through infinity, which shows as a gap between samples."""
    # Add the first sample again one period later, so that the step that closes the loop is examined like all others.
    dyads, finite, through = _evaluate_dyads(curve, loop, np.append(t, t[0] + _parameter_period(loop)))
    inside = finite & window.contains(dyads)
    joined = inside[1:] & inside[:-1] & ~through & (window.distances(dyads) <= gap)
    if joined.all():
        return [Branch(Dyads(dyads.fixed[:-1], dyads.moving[:-1]), closed=True)]
    # Start after a gap, so that no branch is split at the first sample; each run of joined samples is one branch.
    start = int(np.flatnonzero(~joined)[0]) + 1
    order = (np.arange(len(t)) + start) % len(t)
    pieces, run = [], [] if not inside[order[0]] else [order[0]]
    for one, other in pairwise(order):
        if not joined[one]:
            pieces.append(run)
            run = []
        if inside[other]:
            run.append(other)
    pieces.append(run)
    return [Branch(Dyads(dyads.fixed[run], dyads.moving[run]), closed=False) for run in pieces if len(run) > 1]


def _make_strands(curve: BurmesterCurve, window: Window) -> list[_Strand]:
    loops: list[Loop | float] = [*curve.loops, *curve.lines]
    return [_spread_samples(curve, window, loop) for loop in loops]


def _spread_samples(curve: BurmesterCurve, window: Window, loop: Loop | float) -> _Strand:
    """Choose parameters of a loop at roughly equal steps of its arc length inside the window."""
    # One more than the steps: the last sample repeats the first, one period later.
    t = np.linspace(0.0, _parameter_period(loop), COARSE_SAMPLE_COUNT + 1)
    arc = np.zeros_like(t)
    for k in range(RESAMPLING_COUNT + 1):
        dyads, finite, through = _evaluate_dyads(curve, loop, t)
        inside = finite & window.contains(dyads)
        with np.errstate(invalid="ignore", over="ignore"):
            steps = window.distances(dyads)
        cap = MAX_STEP * (window.reach if math.isinf(window.near) else 1.0)
        # Steps outside the window or through infinity have no arc length, so no samples are spent there.
        steps = np.where((inside[1:] | inside[:-1]) & ~through, np.minimum(np.nan_to_num(steps, nan=cap), cap), 0.0)
        arc = np.concatenate([[0.0], np.cumsum(steps)])
        if k == RESAMPLING_COUNT or arc[-1] == 0.0:
            break
        # Keep a share of the samples even in the parameter, so that missed parts can still be found.
        even = arc / arc[-1] + EVEN_SHARE * t / t[-1]
        t = np.interp(np.linspace(0.0, even[-1], COARSE_SAMPLE_COUNT + 1), even, t)
    return _Strand(loop, t, arc)


def _parameter_period(loop: Loop | float) -> float:
    """Return the parameter's period: a full turn for a loop, half a turn for a line."""
    return 2.0 * math.pi if isinstance(loop, Loop) else math.pi


def _evaluate_dyads(curve: BurmesterCurve, loop: Loop | float, t: Real) -> tuple[Dyads, np.ndarray, np.ndarray]:
    """Return dyads at parameters t, a mask of the finite and exact ones, and whether infinity lies before the next."""
    points = curve.points(loop, t) if isinstance(loop, Loop) else curve.line_points(loop, t)
    misfit = np.abs(np.einsum("ki,qij,kj->kq", points, VARIETY_FORMS, points)).max(axis=1)
    p = points[:, 0]
    # A pivot is a quotient by p, so its error grows as p shrinks: compare the misfit with p.
    finite = (np.abs(p) > INFINITY_TOLERANCE) & (misfit <= CURVE_TOLERANCE * np.minimum(np.abs(p), 1.0))
    # Divide the masked points by one instead, to avoid warnings.
    divisor = np.where(np.abs(p) > INFINITY_TOLERANCE, p, 1.0).astype(np.complex128)
    dyads = Dyads((points[:, 3] + 1j * points[:, 4]) / divisor, (points[:, 1] + 1j * points[:, 2]) / divisor)
    # x is continuous up to sign: p changes sign relative to x only where the curve passes through infinity.
    same_sign = (points[1:] * points[:-1]).sum(axis=1) > 0.0
    through = (p[1:] * p[:-1] > 0.0) != same_sign
    return dyads, finite, through


class _Ruling(NamedTuple):
    """Ruling of a pair of positions: the map from (X, Y) to coordinates of the space (4, 4), and the turn between them.

    For rank three also the coordinates of the vertex, and the equation of X and Y, shape (4,) each.
    """

    back: Real
    turn: complex
    vertex: Real
    normal: Real


def _find_ruling(task: MotionTask, basis: Real, rank: int) -> _Ruling | None:
    """Find the pair of positions whose X and Y, of the given rank, are the best-conditioned coordinates, if any."""
    best: _Ruling | None = None
    condition = MIN_CONDITION
    for j, k in combinations(range(len(task.points)), 2):
        forms = np.concatenate([_build_link_forms(task, k), _build_link_forms(task, j)]) @ basis
        u, s, vh = np.linalg.svd(forms)
        # The smallest singular value that counts decides how many digits survive the change of coordinates.
        if s[rank - 1] > condition * s[0]:
            condition = float(s[rank - 1] / s[0])
            back = (vh[:rank].T / s[:rank]) @ u[:, :rank].T
            best = _Ruling(back, complex(task.turns[k] - task.turns[j]), vh[-1], np.ascontiguousarray(u[:, -1]))
    return best


def _place_on_line(back: Real, beta: Real, rho: Complex) -> Real:
    """Return x of X = uρ, Y = conj(u)ρ with u = e^{iβ/2}: shape (len(beta), 7)."""
    u = np.exp(0.5j * beta)
    x, y = u * rho, np.conj(u) * rho
    points: Real = np.stack([x.real, x.imag, y.real, y.imag], axis=1) @ back.T
    return points


def _normalize_points(points: Real) -> Real:
    size = np.linalg.norm(points, axis=1)
    # A zero point stays zero and is later rejected because p vanishes.
    unit: Real = points / np.where(size > 0.0, size, 1.0)[:, None]
    return unit


def _build_link_forms(task: MotionTask, k: int) -> Real:
    """Return A_k − O = p c + r A − O, real and imaginary part, as linear forms in x: (2, 7)."""
    r = complex(task.turns[k])
    c = complex(task.points[k]) - r * complex(task.points[0])
    return np.array(
        [
            [c.real, r.real, -r.imag, -1.0, 0.0, 0.0, 0.0],
            [c.imag, r.imag, r.real, 0.0, -1.0, 0.0, 0.0],
        ]
    )


def _expand_quadratic(form: Real) -> Real:
    """Return a, b, c (rows; combinations of 1, cos β, sin β) of a form in (X, Y) on the lines of the ruling."""
    values = []
    # Three values determine a trigonometric polynomial of degree one.
    for beta in (0.0, math.pi / 2.0, math.pi):
        cos, sin = math.cos(beta / 2.0), math.sin(beta / 2.0)
        line = np.array([[cos, -sin], [sin, cos], [cos, sin], [-sin, cos]])
        on_line = line.T @ form @ line
        values.append([on_line[0, 0], on_line[0, 1], on_line[1, 1]])
    start, quarter, half = np.array(values)
    mean = (start + half) / 2.0
    return np.stack([mean, (start - half) / 2.0, quarter - mean], axis=1)


def _find_loops(coefficients: Real) -> tuple[Loop, ...]:
    """Find all intervals of β in which Δ is positive."""
    a, b, c = coefficients

    def evaluate_discriminant(beta: float) -> float:
        wave = np.array([1.0, math.cos(beta), math.sin(beta)])
        return float((b @ wave) ** 2 - (a @ wave) * (c @ wave))

    zeros = _find_zeros(_multiply_waves(b, b) - _multiply_waves(a, c))
    if not len(zeros):
        # Without zeros Δ has one sign everywhere: two full loops or no real curve.
        return (Loop(0.0, math.pi, 1), Loop(0.0, math.pi, -1)) if evaluate_discriminant(0.0) > 0.0 else ()
    # The last interval passes through π, so it ends at the first zero one turn later.
    ends = np.append(zeros[1:], zeros[0] + 2.0 * math.pi)
    loops = [Loop(float(low + high) / 2.0, float(high - low) / 2.0, 0) for low, high in zip(zeros, ends, strict=True)]
    return tuple(loop for loop in loops if evaluate_discriminant(loop.middle) > 0.0)


def _find_ruled_lines(coefficients: Real) -> tuple[float, ...]:
    """Find β at which a, b and c vanish together: double zeros of a² + 2b² + c², hence zeros of its derivative."""
    a, b, c = coefficients
    # The weight 2 counts the mixed coefficient b twice, as in the norm of the symmetric form.
    squares = _multiply_waves(a, a) + 2.0 * _multiply_waves(b, b) + _multiply_waves(c, c)
    kept: list[float] = []
    # Differentiation multiplies each Fourier coefficient by i times its degree.
    for beta in _find_zeros(squares * 1j * np.arange(-2, 3)):
        size = np.linalg.norm(coefficients @ np.array([1.0, math.cos(beta), math.sin(beta)]))
        if size <= RULING_TOLERANCE * np.linalg.norm(coefficients):
            kept.append(float(beta))
    return tuple(kept)


def _multiply_waves(f: Real, g: Real) -> Complex:
    """Return the Fourier coefficients, degrees −2 to 2, of the product of two combinations of 1, cos β, sin β."""
    one, other = (np.array([(h[1] + 1j * h[2]) / 2.0, h[0], (h[1] - 1j * h[2]) / 2.0]) for h in (f, g))
    product: Complex = np.convolve(one, other)
    return product


def _find_zeros(fourier: Complex) -> Real:
    """Find the real zeros, ascending in [−π, π], of a real trigonometric polynomial with degrees −2 to 2."""
    size = np.abs(fourier).max()
    if size == 0.0:
        return np.empty(0)
    roots = np.roots(fourier[::-1] / size)
    # On the unit circle e^{iβ} is a root for a real β.
    zeros: Real = np.sort(np.angle(roots[np.abs(np.abs(roots) - 1.0) <= UNIT_CIRCLE_TOLERANCE]))
    return zeros
