"""Find starts for Stephenson II dwell sixbars: random ones that turn through, scored by their motion."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from kinematics.compiling import njit
from synthesis.kinds.dwell.candidates import UNEVEN, Asked, Start, beginning, promising, samples_of
from synthesis.kinds.dwell.outputs import CYCLE
from synthesis.kinds.dwell.programs import WAY_APART, rests
from synthesis.kinds.dwell.scoring import ROCKER, lacking
from synthesis.kinds.dwell.triad_turn import BEGIN, FIXED, LEGS, SHORTEST, B, C, D, E, turned
from synthesis.kinds.dwell.triads import over_a_turn, pin_distances

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]
Integers = NDArray[np.int64]

DRAWN, ROUNDS = 200_000, 3
"""Number of sixbars drawn at a time, of which one in forty turns through and transmits enough, and number of rounds."""

EASED = 0.15
"""Minimum sine of a start's transmission angle, regardless of the required angle."""

GROUND, CRANK, LEG, ASIDE = (0.5, 5.0), (0.3, 3.0), (0.3, 4.0), (0.2, 2.0)
"""Ranges of drawn lengths: O2–O4, O2–C, links 3 and 5 relative to O2–A; E from the middle of B–D relative to B–D."""

PARALLEL, UNLIKE = 0.2, 0.1
"""Share of starts that are nearly parallelograms, and the deviation of their pins from that, relative to O2–A."""

OPPOSITE, LONG_LEG, OUTPUT = (0.5, 2.0), (1.5, 5.0), (0.4, 2.0)
"""Ranges of their lengths: O2–C, opposite to O2–A, links 3 and 5, and O4–E."""


def triad_starts(asked: Asked, rng: np.random.Generator, most: int) -> list[Start]:
    """Find the most promising shapes, best first."""
    dwells, places, way, transmission, link_ratio = asked
    lengths, least = np.array([samples_of(dwell) for dwell in dwells]), math.sin(transmission)
    found: list[Start] = []
    for _ in range(ROUNDS):
        shapes = drawn(rng, DRAWN, len(dwells))
        pins = pin_distances(shapes)
        scores = UNEVEN * np.log(np.maximum(pins.max(axis=1) / pins.min(axis=1) / link_ratio, 1.0))
        begins, ends = np.zeros((DRAWN, len(dwells)), np.int64), np.zeros((DRAWN, len(dwells)))
        judge_triads(shapes, lengths, np.array(places), way, least, scores, begins, ends)
        for n in promising(scores, np.arange(DRAWN), most):
            # The middle of the values allowed by the link ratio, on a logarithmic scale.
            shapes[n, SHORTEST] = math.sqrt(pins[n].min() * pins[n].max() / link_ratio)
            at = shapes[n, BEGIN] + begins[n] * (math.tau / CYCLE)
            shape = _standing(shapes[n], beginning(at, lengths, np.array(dwells)))
            found.append(Start(shape, 1, tuple(ends[n].tolist()), float(scores[n])))
    return sorted(found, key=lambda start: start.score)[:most]


def drawn(rng: np.random.Generator, count: int, dwells: int) -> Real:
    """Draw ``count`` random shapes for a number of dwells: general ones, and some near parallelograms."""
    near = round(PARALLEL * count)
    return np.concatenate([near_parallelograms(rng, near, dwells), at_random(rng, count - near, dwells)])


def at_random(rng: np.random.Generator, count: int, dwells: int) -> Real:
    """Draw shapes with the crank in any position, and their pins relative to it."""
    crank, carried = np.exp(2j * np.pi * rng.random(count)), _arms(rng, count, CRANK)
    b, d = crank + _arms(rng, count, LEG), carried * crank + _arms(rng, count, LEG)
    e = 0.5 * (b + d) + np.abs(d - b) * _arms(rng, count, ASIDE)
    return _shapes(crank, carried, b, d, e, np.abs(_arms(rng, count, GROUND)).astype(np.complex128), dwells)


def near_parallelograms(rng: np.random.Generator, count: int, dwells: int) -> Real:
    """Draw shapes in which A B D C is nearly a parallelogram, with E relative to B D like O2 relative to A C.

    In an exact parallelogram E stands still while the crank turns.
    """

    def off() -> Complex:
        return np.asarray(UNLIKE * (rng.standard_normal(count) + 1j * rng.standard_normal(count)))

    crank, carried = np.exp(2j * np.pi * rng.random(count)), off() - np.abs(_arms(rng, count, OPPOSITE))
    leg = _arms(rng, count, LONG_LEG)
    b, d, e = crank + leg + off(), carried * crank + leg + off(), leg + off()
    return _shapes(crank, carried, b, d, e, e + _arms(rng, count, OUTPUT), dwells)


def _arms(rng: np.random.Generator, count: int, lengths: tuple[float, float]) -> Complex:
    """Draw vectors in all directions with evenly spread logarithms of their lengths."""
    size = np.exp(rng.uniform(math.log(lengths[0]), math.log(lengths[1]), count))
    return np.asarray(size * np.exp(2j * np.pi * rng.random(count)))


def _shapes(crank: Complex, carried: Complex, b: Complex, d: Complex, e: Complex, o4: Complex, dwells: int) -> Real:
    """Assemble shapes from pins with O2 at the origin; ``carried`` is C in the frame of the crank."""
    # Rotate everything so that O4 lies on the positive real axis.
    back = np.conj(o4) / np.abs(o4)
    shapes = np.zeros((len(crank), BEGIN + dwells))
    shapes[:, FIXED], shapes[:, BEGIN] = np.abs(o4), np.angle(crank * back)
    for at, pin in ((C, carried), (B, b * back), (D, d * back), (E, e * back)):
        shapes[:, at], shapes[:, at + 1] = pin.real, pin.imag
    return shapes


@njit(cache=True, nogil=True, error_model="numpy")
def judge_triads(
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
    course, sines = np.empty(CYCLE), np.empty((CYCLE, LEGS))
    nowhere, no_pins = np.empty(0), np.empty((0, LEGS), np.complex128)
    no_curve = np.empty(0, np.complex128)
    at, share = np.empty(len(lengths), np.int64), np.empty(len(lengths))
    for i in range(len(shapes)):
        if not turned(shapes[i], nowhere, EASED, no_pins, course, sines):
            scores[i] = np.inf
            continue
        low, span = course.min(), course.max() - course.min()
        # An output that swings by half a turn may as well turn through.
        if not (span < math.pi and abs(math.log(span / way)) < WAY_APART):
            scores[i] = np.inf
            continue
        scores[i] += rests(course, low, span, lengths, places, at, share)
        scores[i] = lacking(scores[i], ROCKER, no_curve, span, way, least, sines.min())
        begins[i], ends[i] = at, share


def _standing(shape: Real, begins: Real) -> Real:
    """Return a shape with its pins at the begin of the first dwell, and with the angles at which the dwells begin."""
    (b, d, e), stood = over_a_turn(shape[None], begins[None, :1], CYCLE).pins[0, 0], shape.copy()
    for at, pin in ((B, b), (D, d), (E, e)):
        stood[at], stood[at + 1] = pin.real, pin.imag
    stood[BEGIN:] = np.remainder(begins + math.pi, math.tau) - math.pi
    return stood


def warm_up() -> None:
    """Compile or load the kernels."""
    shapes = drawn(np.random.default_rng(0), 64, 1)
    begins, ends = np.zeros((64, 1), np.int64), np.zeros((64, 1))
    judge_triads(shapes, np.array([5]), np.zeros(1), 1.0, 0.4, np.zeros(64), begins, ends)
    over_a_turn(shapes, np.empty((64, 0)), CYCLE)
