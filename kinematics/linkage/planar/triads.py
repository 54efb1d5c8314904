"""Mechanisms that no sequence of dyads closes (class III), followed from the reference by certified continuation.

With u_l = e^{iφ_l} for the moving links and z = e^{i(θ − θ_ref)} for the input, every loop of pins is linear in these,

    F(φ, θ) = C u + k z + c = 0,

one complex row per loop; the number of real equations equals that of the unknown rotations φ. A solution is followed in
θ by steps that cannot jump to another one: by the affine covariant Newton–Kantorovich theorem (Deuflhard and Heindl,
SIAM J. Numer. Anal. 16 (1979) 1), with J = ∂F/∂φ at the solution φ for θ, there is exactly one solution in a ball
around φ for every θ' with

    η ω ≤ 1/2,    η ≥ ‖J⁻¹ k (z' − z)‖,    ω ≥ ‖J⁻¹ (J(φ₂) − J(φ₁))‖ / ‖φ₂ − φ₁‖ in the ball, of radius 2η;

the ball is the same for all of them, so it is the continuation of φ. Near a toggle J⁻¹ grows along one direction, to
which the rates of the links, t, converge. The norm is therefore ‖φ‖ = max |y| with φ = y₀ t + ε (y₁, …), the last on
all links but the fastest: ε, the scale across t, is chosen to make the step as long as possible. With A = J⁻¹ C u in
these coordinates the second derivative is Re A, known at φ, and over the ball it changes by no more than |A| times the
links' rotations. Therefore ω = ω₀ + 2 η ω₁, and η may be as large as 1/(ω₀ + √(ω₀² + 4 ω₁)), for each row of A. A
toggle is approached by steps that are a large part of the distance to it.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Complex, Integers, Real
from kinematics.compiling import njit
from kinematics.linkage.planar.mechanism import GROUND, Mechanism, TopologyError

MIN_CERTIFIED_STEP = 1e-12
"""Certified step, radians, below which the position is a toggle: its distance is up to 100 times as large, 1e-10."""

CONVERGENCE_TOLERANCE = 1e-14
"""Newton correction, radians, at which a position counts as solved."""


MAX_NODES = 100_000
"""Maximum number of certified steps: links of very different lengths would need too many, and positions beyond are then
reported as not reached."""

NODE_BATCH = 256
"""Initial number of steps per batch; later batches double the number of nodes."""

SAFE_SHARE = 0.9
"""Share of the certified step that is taken: at its end Newton's method would no longer converge quadratically."""

MIN_NORM_SHARE = 1e-9
"""Minimum ε in the norm of the certificate; at a distance of 1e-10 from a toggle the optimum is about 1e-5."""

MIN_RECIPROCAL_CONDITION = 1e-12
"""Reciprocal condition of the equations below which derivatives are undefined: no correct digits would remain."""

FULL_TURN = 2.0 * np.pi

MAX_NEWTON_STEPS = 20
"""Maximum number of Newton steps; from inside the ball three or four suffice."""

MIN_NEWTON_STEPS = 3
"""Number of steps after which a correction that is not halved is rounding: in the ball each is at most half the
last."""

CLOSURE_TOLERANCE = 1e-13
"""Maximum misfit of the loops, as a share of the size: where the equations are almost singular, rounding may keep
Newton's method from the solution that the theorem guarantees, and no position is returned."""


class Loops(NamedTuple):
    """Loop equations of one design: C (loops, links), k and c (loops,), and the names of the unknown links in order."""

    coefficients: Complex
    by_input: Complex
    fixed: Complex
    links: tuple[str, ...]


def build_loop_equations(mechanism: Mechanism, joints: dict[str, complex]) -> Loops:
    """Build the loops of a pin-jointed mechanism from a tree of its links; ``joints``: one design, unit coordinates.

    Raises
    ------
    TopologyError
        For a mechanism with slides or gears, or driven by a slide.
    """
    if mechanism.slides or mechanism.gears:
        raise TopologyError("kinematics-slides-and-gears-need-dyads")
    unknown = tuple(link for link in mechanism.links if link not in (GROUND, mechanism.input))
    column = {link: n for n, link in enumerate(unknown)}
    width = len(unknown) + 2  # unknown links, input, ground

    def build_vector_row(link: str, start: str, end: str) -> Complex:
        row = np.zeros(width, np.complex128)
        index = column.get(link, width - 2 if link == mechanism.input else width - 1)
        row[index] = joints[end] - joints[start]
        return row

    # Position of each joint as a row over (unknown links, input, ground); reaching a joint twice closes a loop.
    place: dict[str, Complex] = {}
    reached = [GROUND]
    for joint in mechanism.links[GROUND]:
        place[joint] = np.zeros(width, np.complex128)
        place[joint][-1] = joints[joint]
    rows: list[Complex] = []
    waiting = [mechanism.input, *unknown]
    while waiting:
        link = next((w for w in waiting if any(j in place for j in mechanism.links[w])), None)
        if link is None:
            raise TopologyError("kinematics-link-apart", link=repr(waiting[0]))
        waiting.remove(link)
        reached.append(link)
        pin = next(j for j in mechanism.links[link] if j in place)
        for joint in mechanism.links[link]:
            here = place[pin] + build_vector_row(link, pin, joint)
            if joint in place and joint != pin:
                rows.append(here - place[joint])
            elif joint not in place:
                place[joint] = here
    matrix = np.array(rows)
    return Loops(
        np.ascontiguousarray(matrix[:, : len(unknown)]),
        np.ascontiguousarray(matrix[:, -2]),
        np.ascontiguousarray(matrix[:, -1]),
        unknown,
    )


class Track:
    """Solutions of one design's loops along its input, extended on demand.

    Certified steps from the reference are stored: each *node* is an input rotation with its solution, and the next node
    lies at the end of its certified step. Positions in between follow by Newton's method from a node.
    """

    def __init__(self, loops: Loops) -> None:
        self._loops = loops
        self._sides = {side: _Side(loops, side) for side in (1.0, -1.0)}

    @property
    def first_step(self) -> float:
        """Certified step at the reference, radians; below :data:`MIN_CERTIFIED_STEP` the reference is a toggle."""
        return self._sides[1.0].first_step

    def find_rotations(self, rotation: Real) -> Real:
        """Find rotations of the unknown links for input rotations from the reference; NaN if unreachable.

        An input is reached by its own rotation or, if a toggle lies before it, by the smallest rotation that differs by
        full turns.

        Parameters
        ----------
        rotation : float, shape (N,)
            Input rotations, radians, in any order, not reduced by full turns.

        Returns
        -------
        float, shape (links, N)
        """
        found = self.follow(rotation)
        # Try the same input with other numbers of full turns.
        lost = np.flatnonzero(np.isnan(found[0]) & np.isfinite(rotation))
        least = np.mod(rotation + np.pi, FULL_TURN) - np.pi
        turns = 0
        while len(lost) and not all(side.is_ended_before(FULL_TURN * (turns - 0.5)) for side in self._sides.values()):
            for away in (-1.0, 1.0) if turns else (0.0,):
                found[:, lost] = self.follow(least[lost] + away * np.copysign(FULL_TURN * turns, least[lost]))
                lost = lost[np.isnan(found[0, lost])]
            turns += 1
        return found

    @property
    def has_given_up(self) -> bool:
        """Whether a continuation was abandoned before its end: unreached positions may then exist."""
        return any(side.given_up for side in self._sides.values())

    def follow(self, rotation: Real) -> Real:
        """Follow each input by its own rotation only; NaN if a toggle lies before it. See :meth:`find_rotations`."""
        found = np.full((len(self._loops.links), len(rotation)), np.nan)
        for sign, side in self._sides.items():
            chosen = np.flatnonzero(sign * rotation >= 0.0)
            if len(chosen):
                found[:, chosen] = side.find_rotations(rotation[chosen])
        return found


class _Side:
    """Nodes of a track in one sense of rotation, in which the input is counted as positive."""

    def __init__(self, loops: Loops, sign: float) -> None:
        self._equations = loops.coefficients, loops.by_input, loops.fixed
        self._sign = sign
        self._nodes, self._reach = np.zeros(1), np.zeros(1)
        self._angles = np.zeros((1, len(loops.links)))
        self._ended = self.given_up = False
        self._reach[0] = _compute_reach(*self._equations, 0.0, self._angles[0])

    @property
    def first_step(self) -> float:
        return float(self._reach[0])

    def is_ended_before(self, rotation: float) -> bool:
        """Return whether a toggle lies within this rotation."""
        self._extend(rotation)
        return self._ended and float(self._nodes[-1] + self._reach[-1]) < rotation

    def find_rotations(self, rotation: Real) -> Real:
        """Find rotations of the unknown links for input rotations of this sense; NaN if unreachable."""
        ahead = self._sign * rotation
        self._extend(float(ahead.max()))
        node = np.searchsorted(self._nodes, ahead, side="right") - 1
        found = np.full((len(rotation), self._angles.shape[1]), np.nan)
        _solve_near(*self._equations, self._sign * self._nodes, self._reach, self._angles, node, rotation, found)
        return found.T

    def _extend(self, target: float) -> None:
        """Add nodes until the certified steps reach the target or the track ends."""
        while not self._ended and self._nodes[-1] + self._reach[-1] < target:
            if len(self._nodes) > MAX_NODES:
                self._ended = self.given_up = True
                return
            room = max(NODE_BATCH, min(len(self._nodes), MAX_NODES - len(self._nodes) + 2))
            nodes, reach, angles = np.empty(room), np.empty(room), np.empty((room, self._angles.shape[1]))
            nodes[0], reach[0], angles[0] = self._nodes[-1], self._reach[-1], self._angles[-1]
            count, self._ended, lost = _follow_nodes(*self._equations, self._sign, target, nodes, reach, angles)
            self.given_up = self.given_up or lost
            self._nodes = np.concatenate([self._nodes, nodes[1:count]])
            self._reach = np.concatenate([self._reach, reach[1:count]])
            self._angles = np.concatenate([self._angles, angles[1:count]])


def compute_rates(loops: Loops, rotation: Real, angles: Real, input_rates: Real) -> Real:
    """Compute time derivatives of the unknown rotations, shape (n, links, N); NaN at toggles.

    ``input_rates`` holds the input's speed, acceleration and jerk, or the first n of them, shape (n, N).
    """
    out = np.empty((len(input_rates), *angles.shape))
    _fill_rates(loops.coefficients, loops.by_input, rotation, angles, input_rates, out)
    return out


@njit(cache=True, nogil=True)
def _compute_reach(c: Complex, k: Complex, fixed: Complex, at: float, phi: Real) -> float:
    """Compute the certified step at a solution; 0 where the equations are singular."""
    links = len(phi)
    value, inverse = np.empty(links), np.empty((links, links))
    evaluate(c, k, fixed, phi, at, value, inverse)
    return _certify_step(c, k, phi, at, inverse) if np.isfinite(invert(inverse)) else 0.0


@njit(cache=True, nogil=True)
def _follow_nodes(
    c: Complex, k: Complex, fixed: Complex, sign: float, target: float, nodes: Real, reach: Real, angles: Real
) -> tuple[int, bool, bool]:
    """Add nodes after the known first one until the target is passed.

    Returns the number of nodes, whether the track ends there (at a toggle or because Newton's method failed), and
    whether Newton's method failed.
    """
    links = c.shape[1]
    phi, value = angles[0].copy(), np.empty(links)
    inverse, slope = np.empty((links, links)), np.empty(links)
    evaluate(c, k, fixed, phi, sign * nodes[0], value, inverse)
    invert(inverse)
    for n in range(1, len(nodes)):
        step = reach[n - 1]
        if step < MIN_CERTIFIED_STEP:
            return n, True, False
        if nodes[n - 1] + step >= target:
            return n, False, False
        at, to = sign * nodes[n - 1], sign * (nodes[n - 1] + step)
        # The theorem guarantees a solution, but rounding may prevent convergence.
        if not _solve_newton(c, k, fixed, phi, at, to, value, inverse, slope):
            return n, True, True
        nodes[n], angles[n] = nodes[n - 1] + step, phi
        # Newton's last inverse belongs to the solution, up to a correction of rounding size.
        reach[n] = _certify_step(c, k, phi, to, inverse) if np.isfinite(inverse).all() else 0.0
    return len(nodes), False, False


@njit(cache=True, nogil=True)
def _solve_near(
    c: Complex,
    k: Complex,
    fixed: Complex,
    nodes: Real,
    reach: Real,
    angles: Real,
    node: Integers,
    rotation: Real,
    found: Real,
) -> None:
    """Solve at rotations within the certified steps of their nodes; others stay unchanged."""
    links = c.shape[1]
    value, slope, inverse = np.empty(links), np.empty(links), np.empty((links, links))
    for n in range(len(rotation)):
        at = nodes[node[n]]
        if not abs(rotation[n] - at) <= reach[node[n]]:
            continue
        phi = found[n]
        phi[:] = angles[node[n]]
        if rotation[n] != at:
            evaluate(c, k, fixed, phi, at, value, inverse)
            invert(inverse)
            if not _solve_newton(c, k, fixed, phi, at, rotation[n], value, inverse, slope):
                phi[:] = np.nan


@njit(cache=True, nogil=True)
def _solve_newton(
    c: Complex, k: Complex, fixed: Complex, phi: Real, at: float, to: float, value: Real, inverse: Real, slope: Real
) -> bool:
    """Move a solution from one input to another within its certified step; ``inverse`` is J⁻¹ before and after.

    Returns whether the loops close there.
    """
    loops = len(k)
    # Predictor along the tangent, then Newton corrections.
    turned = 1j * complex(math.cos(at), math.sin(at)) * (to - at)
    for row in range(loops):
        slope[row] = (k[row] * turned).real
        slope[row + loops] = (k[row] * turned).imag
    _subtract(phi, inverse, slope)
    last = np.inf
    for n in range(MAX_NEWTON_STEPS):
        evaluate(c, k, fixed, phi, to, value, inverse)
        invert(inverse)
        change = _subtract(phi, inverse, value)
        if change < CONVERGENCE_TOLERANCE:
            return True
        if n > MIN_NEWTON_STEPS and change > 0.5 * last:
            break
        last = change
    evaluate(c, k, fixed, phi, to, value, inverse)
    misfit = np.abs(value).max()
    invert(inverse)
    return bool(misfit < CLOSURE_TOLERANCE)


@njit(cache=True, nogil=True)
def _fill_rates(c: Complex, k: Complex, rotation: Real, angles: Real, given: Real, out: Real) -> None:
    """Solve the differentiated loops, order by order: J φ⁽ⁿ⁾ = −(terms of lower orders)."""
    loops, links = c.shape
    value, inverse, right = np.empty(links), np.empty((links, links)), np.empty(links)
    phi, solved = np.empty(links), np.empty((3, links))
    none = np.zeros(loops, np.complex128)
    for n in range(len(rotation)):
        for link in range(links):
            phi[link] = angles[link, n]
        evaluate(c, k, none, phi, rotation[n], value, inverse)
        largest = 0.0
        for row in range(links):
            total = 0.0
            for col in range(links):
                total += abs(inverse[row, col])
            largest = max(largest, total)
        sound = invert(inverse) * largest < 1.0 / MIN_RECIPROCAL_CONDITION
        w1 = given[0, n]
        w2 = given[1, n] if len(given) > 1 else 0.0
        w3 = given[2, n] if len(given) > 2 else 0.0
        z = complex(math.cos(rotation[n]), math.sin(rotation[n]))
        for order in range(len(given)):
            if order == 0:
                turned = 1j * w1 * z
            elif order == 1:
                turned = complex(-w1 * w1, w2) * z
            else:
                turned = complex(-3.0 * w1 * w2, w3 - w1**3) * z
            for row in range(loops):
                total_z = k[row] * turned
                for link in range(links):
                    u = complex(math.cos(phi[link]), math.sin(phi[link]))
                    if order == 1:
                        total_z += c[row, link] * u * -(solved[0, link] ** 2)
                    elif order == 2:
                        total_z += (
                            c[row, link]
                            * u
                            * complex(-3.0 * solved[0, link] * solved[1, link], -(solved[0, link] ** 3))
                        )
                right[row], right[row + loops] = total_z.real, total_z.imag
            for link in range(links):
                total = 0.0
                for col in range(links):
                    total -= inverse[link, col] * right[col]
                solved[order, link] = total
                out[order, link, n] = total if sound else np.nan


@njit(cache=True, nogil=True)
def _certify_step(c: Complex, k: Complex, phi: Real, at: float, inverse: Real) -> float:
    """Certify a step: 90 % of the range within which the continuation is the only solution."""
    loops, links = c.shape
    z = complex(math.cos(at), math.sin(at))
    rate, bend = np.empty(links), np.empty(links)
    a = np.empty((links, links), np.complex128)
    for row in range(links):
        by_input = 0j
        for loop in range(loops):
            by_input += complex(inverse[row, loop], -inverse[row, loop + loops]) * k[loop]
        by_input *= z
        rate[row], bend[row] = by_input.imag, by_input.real
    fastest = np.argmax(np.abs(rate))
    # Avoid a division by zero if the input moves no link.
    eta = max(abs(rate[fastest]), 1e-300)
    t = rate / (eta if rate[fastest] >= 0.0 else -eta)
    t[fastest] = 1.0
    for col in range(links):
        u = complex(math.cos(phi[col]), math.sin(phi[col]))
        for row in range(links):
            by_link = 0j
            for loop in range(loops):
                by_link += complex(inverse[row, loop], -inverse[row, loop + loops]) * c[loop, col]
            a[row, col] = by_link * u
    for row in range(links):
        if row != fastest:
            bend[row] -= t[row] * bend[fastest]
            for col in range(links):
                a[row, col] -= t[row] * a[fastest, col]
    along, across, beside = np.zeros(links), np.zeros(links), np.zeros(links)
    for row in range(links):
        for col in range(links):
            along[row] += a[row, col].real * t[col] * t[col]
            if col != fastest:
                across[row] += 2.0 * abs(a[row, col].real * t[col])
                beside[row] += abs(a[row, col].real)
    best, share = 0.0, 1.0
    # Halve ε while the certified step grows.
    while share > MIN_NORM_SHARE:
        ball = np.inf
        for row in range(links):
            second = abs(along[row]) + share * (across[row] + share * beside[row])
            third = 0.0
            for col in range(links):
                weight = abs(t[col]) + (share if col != fastest else 0.0)
                third += abs(a[row, col]) * weight**3
            if row != fastest:
                second, third = second / share, third / share
            ball = min(ball, 1.0 / max(second + math.sqrt(second * second + 4.0 * third), 1e-300))
        step = 2.0 * ball / (eta + math.sqrt(eta * eta + 2.0 * abs(bend[fastest]) * ball))
        for row in range(links):
            if row != fastest and bend[row] != 0.0:
                step = min(step, math.sqrt(2.0 * share * ball / abs(bend[row])))
        if step <= best:
            break
        best, share = step, share * 0.5
    return SAFE_SHARE * best


@njit(cache=True, nogil=True)
def evaluate(c: Complex, k: Complex, fixed: Complex, phi: Real, at: float, value: Real, jacobian: Real) -> None:
    """Fill F and ∂F/∂φ, real parts above imaginary ones: shapes (links,) and (links, links)."""
    loops, links = c.shape
    z = complex(math.cos(at), math.sin(at))
    for row in range(loops):
        total = k[row] * z + fixed[row]
        for col in range(links):
            term = c[row, col] * complex(math.cos(phi[col]), math.sin(phi[col]))
            total += term
            jacobian[row, col] = -term.imag
            jacobian[row + loops, col] = term.real
        value[row] = total.real
        value[row + loops] = total.imag


@njit(cache=True, nogil=True)
def _subtract(phi: Real, matrix: Real, vector: Real) -> float:
    """Subtract matrix · vector from phi, in place; return the largest change."""
    largest = 0.0
    for row in range(len(phi)):
        change = 0.0
        for col in range(len(vector)):
            change += matrix[row, col] * vector[col]
        phi[row] -= change
        largest = max(largest, abs(change))
    return largest


@njit(cache=True, nogil=True)
def invert(matrix: Real) -> float:
    """Invert in place by Gauss–Jordan elimination with row pivoting; return the largest row sum of the inverse.

    The matrices are small and inverted at every step: a library call would cost more than the work itself.
    """
    n = len(matrix)
    order = np.arange(n)
    for col in range(n):
        pivot = col
        for row in range(col + 1, n):
            if abs(matrix[row, col]) > abs(matrix[pivot, col]):
                pivot = row
        # Exactly singular; nearly singular matrices are judged by the norm of the inverse.
        if matrix[pivot, col] == 0.0:
            return np.inf
        if pivot != col:
            for j in range(n):
                matrix[col, j], matrix[pivot, j] = matrix[pivot, j], matrix[col, j]
            order[col], order[pivot] = order[pivot], order[col]
        scale = 1.0 / matrix[col, col]
        matrix[col, col] = 1.0
        for j in range(n):
            matrix[col, j] *= scale
        for row in range(n):
            if row != col:
                factor = matrix[row, col]
                matrix[row, col] = 0.0
                for j in range(n):
                    matrix[row, j] -= factor * matrix[col, j]
    norm = 0.0
    unordered = matrix.copy()
    for row in range(n):
        total = 0.0
        for col in range(n):
            matrix[row, order[col]] = unordered[row, col]
            total += abs(unordered[row, col])
        norm = max(norm, total)
    return norm
