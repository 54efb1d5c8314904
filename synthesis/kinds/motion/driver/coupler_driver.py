"""A driver dyad on the coupler: a crank and a link that move a finished fourbar by a point of its coupler.

If the fourbar's ground links turn too far for a rocker, or one of them reverses, a pin C of the coupler is moved along
its path instead. This gives a Stephenson III sixbar, driven from its far pivot. With C₁ and Cₙ the ends of the path and
r the distance of C from the crank's pivot O6, crank a and link b are the same as for a driven rocker,

    a = |rₙ − r₁|/2,    b = (rₙ + r₁)/2.

The crank rotates fully, with the body's end positions at its two dead centres, if r is monotonic from C₁ to Cₙ. The
link pushes along D C, and its transmission angle is the angle to the normal of C's path. Input and output are the other
two legs of a triad, with transmission angles of their own. All three are evaluated for both assemblies of the dyad at
each position of C. C and O6 are free; all pairs from a grid of both are evaluated.
"""

from __future__ import annotations

import math

import numpy as np

from kinematics.arrays import Complex, Real
from kinematics.compiling import njit
from kinematics.linkage.fourbar import positions
from synthesis.kinds.motion.driver.joints import SIZE_SCALE, build_coupler_driver, measure_diagonal
from synthesis.kinds.motion.statement.dyad_choices import DriverDyad
from synthesis.model.linkage.answer import FourbarMechanism, LinkageDesign, SixbarMechanism
from synthesis.model.linkage.conversion import build_driven_fourbar
from synthesis.verification.measures import LINK_RATIO_SCALE

STEP_COUNT = 49
"""Number of evaluated points of C's path; the verification covers the motion between them."""

PIN_DISTANCES = np.array([0.0, 0.35, 0.7, 1.1, 1.6])
"""Candidate distances of C from the coupler's midpoint, in lengths of the coupler."""

PIN_DIRECTIONS = np.linspace(-np.pi, np.pi, 17)[:-1]
"""Candidate directions of C on the coupler, radians from its line A → B."""

PIVOT_DISTANCES = np.geomspace(0.6, 5.0, 11)
PIVOT_DIRECTIONS = np.linspace(-np.pi, np.pi, 49)[:-1]
"""Grid of candidate positions of O6: distance from the midpoint of the chord C₁ Cₙ in chord lengths, and direction."""

MIN_SINE = 0.1
"""Minimum sine of the transmission angle: drivers below 6° are dropped."""

MIN_CHORD = 1e-3
"""Minimum chord of C's path, as a share of the linkage's size; shorter ones cannot drive the linkage."""

MIN_SEPARATION = 0.3
"""Minimum difference of the returned drivers in C and O6 together, as a share of the linkage's size."""


def find_coupler_drivers(
    design: LinkageDesign, mechanism: FourbarMechanism, wanted: DriverDyad, count: int, least: float = 0.0
) -> list[tuple[float, SixbarMechanism]]:
    """Find the best drivers of a fourbar's coupler, at most ``count``, with their scores, best first.

    ``least`` is the minimum sine of the transmission angle.
    """
    fourbar = build_driven_fourbar(mechanism)
    inputs = np.radians([target.position for target in design.targets])
    steps = np.diff(inputs)
    # If the input reverses on the way, C would pass through the same place twice; one crank turn cannot do that.
    if not (np.all(steps > 0.0) or np.all(steps < 0.0)):
        return []
    at = positions(fourbar.linkage, np.linspace(inputs[0], inputs[-1], STEP_COUNT), fourbar.assembly)
    if not at.valid.all():
        return []
    joints = np.concatenate([at.a, at.b, at.p, [fourbar.linkage.input_pivot, fourbar.linkage.output_pivot]])
    alone = float(measure_diagonal(joints))
    pins, paths = _trace_paths(at.a, at.b)
    # A pin that hardly moves needs a crank of almost no length.
    long = np.abs(paths[:, -1] - paths[:, 0]) > MIN_CHORD * alone
    pins, paths = pins[long], paths[long]
    chord = paths[:, -1] - paths[:, 0]
    around = (PIVOT_DISTANCES[:, None] * np.exp(1j * PIVOT_DIRECTIONS)).ravel()
    # O6 lies around the middle of C's path, at distances in units of its chord.
    pivots = 0.5 * (paths[:, :1] + paths[:, -1:]) + chord[:, None] * around
    along = np.gradient(paths, axis=1)
    score = np.ones(pivots.shape)
    if wanted.pivot_region is not None:
        score[~wanted.pivot_region.mark_contained(pivots)] = 0.0
        if not score.any():
            return []
    arms = [pin - pivot for pin, pivot in ((at.a, joints[-2]), (at.b, joints[-1]))]
    bars = np.array([at.a, at.b, *(arm / np.abs(arm) for arm in arms)])
    compute_min_sines(paths, along / np.maximum(np.abs(along), np.finfo(np.float64).tiny), pivots, bars, score)
    score[score < least] = 0.0
    # The limit is known in advance, so drivers that violate it are not verified.
    first, last = (np.abs(paths[:, k, None] - pivots) for k in (0, -1))
    with np.errstate(divide="ignore"):
        # The triangle of crank and link degenerates if C's distance from O6 does not change.
        uneven = (first + last) / np.abs(last - first)
    score = score / (1.0 + ((_measure_diagonals(joints, paths, pivots) / alone - 1.0) / SIZE_SCALE) ** 2)
    score = score / (1.0 + (uneven / LINK_RATIO_SCALE) ** 2)
    found: list[tuple[float, SixbarMechanism]] = []
    kept: list[tuple[complex, complex]] = []
    for flat in np.argsort(-score, axis=None, kind="stable"):
        k, m = np.unravel_index(int(flat), score.shape)
        if len(found) == count or not score[k, m] > 0.0:
            break
        o6, c = complex(pivots[k, m]), complex(paths[k, 0])
        # Neighbours on the grid give nearly the same driver, so keep only clearly different ones.
        if all(abs(o6 - z) + abs(c - w) > MIN_SEPARATION * alone for z, w in kept):
            kept.append((o6, c))
            found.append((float(score[k, m]), build_coupler_driver(mechanism, c, o6, complex(paths[k, -1]))))
    return found


def _measure_diagonals(joints: Complex, paths: Complex, pivots: Complex) -> Real:
    """Return the diagonal of the box around a linkage's joints, the ends of C's path and O6; shape pins × pivots."""

    def measure_span(of: Complex, ends: Complex, more: Complex, part: str) -> Real:
        given, path, other = (getattr(z, part) for z in (of, ends, more))
        low, high = np.minimum(given.min(), path.min(axis=1)), np.maximum(given.max(), path.max(axis=1))
        return np.asarray(np.maximum(high[:, None], other) - np.minimum(low[:, None], other))

    ends = paths[:, [0, -1]]
    return np.hypot(*(measure_span(joints, ends, pivots, part) for part in ("real", "imag")))


def _trace_paths(a: Complex, b: Complex) -> tuple[Complex, Complex]:
    """Return the pins C in the coupler's frame (A at 0, B at 1), and their paths, shape (pins, steps)."""
    pins: Complex = np.unique(0.5 + (PIN_DISTANCES[:, None] * np.exp(1j * PIN_DIRECTIONS)).ravel())
    return pins, a + (b - a) * pins[:, None]


@njit(cache=True, nogil=True, error_model="numpy")
def _compute_sine(
    pin: complex, leg: complex, one: complex, on_one: complex, other: complex, on_other: complex
) -> float:
    """Return the sine of a leg's transmission angle: between the leg and the normal of its pin's path.

    The two other legs of the triad guide the pin. They are given by unit vectors and by any point on each of their
    lines (:mod:`kinematics.linkage.planar.triad_transmission`).
    """
    arm, other_arm = on_one - pin, on_other - pin
    moment = arm.real * one.imag - arm.imag * one.real
    other_moment = other_arm.real * other.imag - other_arm.imag * other.real
    way = other_moment * one - moment * other
    size = abs(way)
    return abs(leg.real * way.imag - leg.imag * way.real) / size if size > 0.0 else 0.0


@njit(cache=True, nogil=True, error_model="numpy")
def compute_min_sines(paths: Complex, along: Complex, pivots: Complex, bars: Complex, least: Real) -> None:
    """Write the minimum sine of the transmission angles into ``least``, shape pins × pivots.

    The sine is 0 if C's distance from O6 is not monotonic. Entries that are 0 on input are skipped and stay 0.
    ``paths`` and their unit tangents ``along`` have shape pins × steps, ``pivots`` pins × pivots. ``bars`` (4, steps)
    holds A, B, and the directions of the input and of the output.
    """
    pins, steps = paths.shape
    for k in range(pins):
        for m in range(pivots.shape[1]):
            if least[k, m] == 0.0:
                continue
            o6 = pivots[k, m]
            first, last = abs(paths[k, 0] - o6), abs(paths[k, steps - 1] - o6)
            crank, link = 0.5 * abs(last - first), 0.5 * (last + first)
            before, found = first, 1.0
            for n in range(steps):
                c = paths[k, n]
                reach = o6 - c
                r = abs(reach)
                # C's distance from O6 must change in one direction only, as the crank needs one half turn for it.
                if n and not (r - before) * (last - first) > 0.0:
                    found = 0.0
                    break
                before = r
                # The link's direction differs from that of O6 by the angle of the triangle (r, link, crank) at C.
                forward = reach * along[k, n].conjugate() / r
                # The sign of the angle is that of the assembly; the crank passes both halves of its turn, so both
                # must transmit.
                cosine = min(max((r * r + link * link - crank * crank) / (2.0 * r * link), -1.0), 1.0)
                sine = math.sqrt(1.0 - cosine * cosine)
                one, other = forward.real * cosine - forward.imag * sine, forward.real * cosine + forward.imag * sine
                found = min(found, abs(one), abs(other))
                if not found >= MIN_SINE:
                    found = 0.0
                    break
                a, b, arm, rocker = bars[0, n], bars[1, n], bars[2, n], bars[3, n]
                for side in (1.0, -1.0):
                    pushing = reach / r * complex(cosine, side * sine)
                    found = min(
                        found,
                        _compute_sine(a, arm, rocker, b, pushing, c),
                        _compute_sine(b, rocker, arm, a, pushing, c),
                    )
                if not found >= MIN_SINE:
                    found = 0.0
                    break
            least[k, m] = found
