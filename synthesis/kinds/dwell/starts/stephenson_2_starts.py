"""Find starts for Stephenson II dwell sixbars: random ones that turn through, scored by their motion."""

from __future__ import annotations

import math

import numpy as np

from kinematics.arrays import Complex, Integers, Real
from kinematics.compiling import njit
from synthesis.kinds.dwell.motion.outputs import CYCLE_SAMPLE_COUNT
from synthesis.kinds.dwell.motion.program_score import MAX_LOG_RANGE_ERROR, locate_rests
from synthesis.kinds.dwell.motion.score import ROCKER_CODE, add_shortcomings
from synthesis.kinds.dwell.refine.stephenson_2 import compute_pin_distances, drive_shapes
from synthesis.kinds.dwell.refine.stephenson_2_cycle import (
    BEGIN_INDEX,
    FIXED_INDEX,
    LEG_COUNT,
    SHORTEST_INDEX,
    B,
    C,
    D,
    E,
    drive_triad,
)
from synthesis.kinds.dwell.starts.coupler_curve_starts import (
    UNEVENNESS_WEIGHT,
    Requirements,
    Start,
    compute_dwell_begins,
    count_samples,
    select_promising,
)

DRAW_COUNT, ROUND_COUNT = 200_000, 3
"""Number of sixbars drawn at a time, of which one in forty turns through and transmits enough, and number of rounds."""

MIN_START_SINE = 0.15
"""Minimum sine of a start's transmission angle, regardless of the required angle."""

GROUND_RANGE, CRANK_RANGE, LEG_RANGE, OFFSET_RANGE = (0.5, 5.0), (0.3, 3.0), (0.3, 4.0), (0.2, 2.0)
"""Ranges of drawn lengths: O2–O4, O2–C, links 3 and 5 relative to O2–A; E from the middle of B–D relative to B–D."""

PARALLELOGRAM_SHARE, PARALLELOGRAM_DEVIATION = 0.2, 0.1
"""Share of starts that are nearly parallelograms, and the deviation of their pins from that, relative to O2–A."""

OPPOSITE_RANGE, LONG_LEG_RANGE, OUTPUT_RANGE = (0.5, 2.0), (1.5, 5.0), (0.4, 2.0)
"""Ranges of their lengths: O2–C, opposite to O2–A, links 3 and 5, and O4–E."""


def find_triad_starts(required: Requirements, rng: np.random.Generator, most: int) -> list[Start]:
    """Find the most promising shapes, best first."""
    dwells, places, way, transmission, link_ratio = required
    lengths, least = np.array([count_samples(dwell) for dwell in dwells]), math.sin(transmission)
    found: list[Start] = []
    for _ in range(ROUND_COUNT):
        shapes = draw_shapes(rng, DRAW_COUNT, len(dwells))
        pins = compute_pin_distances(shapes)
        scores = UNEVENNESS_WEIGHT * np.log(np.maximum(pins.max(axis=1) / pins.min(axis=1) / link_ratio, 1.0))
        begins, ends = np.zeros((DRAW_COUNT, len(dwells)), np.int64), np.zeros((DRAW_COUNT, len(dwells)))
        score_triads(shapes, lengths, np.array(places), way, least, scores, begins, ends)
        for n in select_promising(scores, np.arange(DRAW_COUNT), most):
            # The middle of the values allowed by the link ratio, on a logarithmic scale.
            shapes[n, SHORTEST_INDEX] = math.sqrt(pins[n].min() * pins[n].max() / link_ratio)
            at = shapes[n, BEGIN_INDEX] + begins[n] * (math.tau / CYCLE_SAMPLE_COUNT)
            shape = _place_at_dwell(shapes[n], compute_dwell_begins(at, lengths, np.array(dwells)))
            found.append(Start(shape, 1, tuple(ends[n].tolist()), float(scores[n])))
    return sorted(found, key=lambda start: start.score)[:most]


def draw_shapes(rng: np.random.Generator, count: int, dwells: int) -> Real:
    """Draw ``count`` random shapes for a number of dwells: general ones, and some near parallelograms."""
    near = round(PARALLELOGRAM_SHARE * count)
    return np.concatenate([draw_near_parallelograms(rng, near, dwells), draw_general(rng, count - near, dwells)])


def draw_general(rng: np.random.Generator, count: int, dwells: int) -> Real:
    """Draw shapes with the crank in any position, and their pins relative to it."""
    crank, carried = np.exp(2j * np.pi * rng.random(count)), _draw_arms(rng, count, CRANK_RANGE)
    b, d = crank + _draw_arms(rng, count, LEG_RANGE), carried * crank + _draw_arms(rng, count, LEG_RANGE)
    e = 0.5 * (b + d) + np.abs(d - b) * _draw_arms(rng, count, OFFSET_RANGE)
    return _assemble_shapes(
        crank, carried, b, d, e, np.abs(_draw_arms(rng, count, GROUND_RANGE)).astype(np.complex128), dwells
    )


def draw_near_parallelograms(rng: np.random.Generator, count: int, dwells: int) -> Real:
    """Draw shapes in which A B D C is nearly a parallelogram, with E relative to B D like O2 relative to A C.

    In an exact parallelogram E stands still while the crank turns.
    """

    def draw_deviation() -> Complex:
        return np.asarray(PARALLELOGRAM_DEVIATION * (rng.standard_normal(count) + 1j * rng.standard_normal(count)))

    crank, carried = (
        np.exp(2j * np.pi * rng.random(count)),
        draw_deviation() - np.abs(_draw_arms(rng, count, OPPOSITE_RANGE)),
    )
    leg = _draw_arms(rng, count, LONG_LEG_RANGE)
    b, d, e = crank + leg + draw_deviation(), carried * crank + leg + draw_deviation(), leg + draw_deviation()
    return _assemble_shapes(crank, carried, b, d, e, e + _draw_arms(rng, count, OUTPUT_RANGE), dwells)


def _draw_arms(rng: np.random.Generator, count: int, lengths: tuple[float, float]) -> Complex:
    """Draw vectors in all directions with evenly spread logarithms of their lengths."""
    size = np.exp(rng.uniform(math.log(lengths[0]), math.log(lengths[1]), count))
    return np.asarray(size * np.exp(2j * np.pi * rng.random(count)))


def _assemble_shapes(
    crank: Complex, carried: Complex, b: Complex, d: Complex, e: Complex, o4: Complex, dwells: int
) -> Real:
    """Assemble shapes from pins with O2 at the origin; ``carried`` is C in the frame of the crank."""
    # Rotate everything so that O4 lies on the positive real axis.
    back = np.conj(o4) / np.abs(o4)
    shapes = np.zeros((len(crank), BEGIN_INDEX + dwells))
    shapes[:, FIXED_INDEX], shapes[:, BEGIN_INDEX] = np.abs(o4), np.angle(crank * back)
    for at, pin in ((C, carried), (B, b * back), (D, d * back), (E, e * back)):
        shapes[:, at], shapes[:, at + 1] = pin.real, pin.imag
    return shapes


@njit(cache=True, nogil=True, error_model="numpy")
def score_triads(
    shapes: Real,
    lengths: Integers,
    places: Real,
    way: float,
    least: float,
    scores: Real,
    begins: Integers,
    ends: Real,
) -> None:
    """Drive every sixbar through its turn and add its shortcomings of rest, range and transmission to its score.

    Parameters
    ----------
    shapes : float, shape (m, ...)
    lengths, places : int and float, shape (k,)
        Number of samples of each dwell, and its share of the range; NaN for either end.
    way, least : float
        The range, radians, and the minimum sine of a transmission angle.
    scores : float, shape (m,)
        Added to: infinite for unsuitable starts.
    begins, ends : int and float, shape (m, k)
        Filled: first step of each dwell, and its share of the range.
    """
    course, sines = np.empty(CYCLE_SAMPLE_COUNT), np.empty((CYCLE_SAMPLE_COUNT, LEG_COUNT))
    nowhere, no_pins = np.empty(0), np.empty((0, LEG_COUNT), np.complex128)
    no_curve = np.empty(0, np.complex128)
    at, share = np.empty(len(lengths), np.int64), np.empty(len(lengths))
    for i in range(len(shapes)):
        if not drive_triad(shapes[i], nowhere, MIN_START_SINE, no_pins, course, sines):
            scores[i] = np.inf
            continue
        low, span = course.min(), course.max() - course.min()
        # An output that swings by half a turn may as well turn through.
        if not (span < math.pi and abs(math.log(span / way)) < MAX_LOG_RANGE_ERROR):
            scores[i] = np.inf
            continue
        scores[i] += locate_rests(course, low, span, lengths, places, at, share)
        scores[i] = add_shortcomings(scores[i], ROCKER_CODE, no_curve, span, way, least, sines.min())
        begins[i], ends[i] = at, share


def _place_at_dwell(shape: Real, begins: Real) -> Real:
    """Return a shape with its pins at the beginning of the first dwell, and the angles at which the dwells begin."""
    (b, d, e), stood = drive_shapes(shape[None], begins[None, :1], CYCLE_SAMPLE_COUNT).pins[0, 0], shape.copy()
    for at, pin in ((B, b), (D, d), (E, e)):
        stood[at], stood[at + 1] = pin.real, pin.imag
    stood[BEGIN_INDEX:] = np.remainder(begins + math.pi, math.tau) - math.pi
    return stood


def warm_up() -> None:
    """Compile or load the kernels."""
    shapes = draw_shapes(np.random.default_rng(0), 64, 1)
    begins, ends = np.zeros((64, 1), np.int64), np.zeros((64, 1))
    score_triads(shapes, np.array([5]), np.zeros(1), 1.0, 0.4, np.zeros(64), begins, ends)
    drive_shapes(shapes, np.empty((64, 0)), CYCLE_SAMPLE_COUNT)
