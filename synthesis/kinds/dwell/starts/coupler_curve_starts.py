"""Find starts for dwell sixbars: random coupler curves, their arcs and lines, and outputs that rest on them.

Crank-rockers are drawn at random, half of them symmetric (coupler = rocker = B P), whose coupler curves have pairs of
arcs of equal radius. The pieces nearest to arcs or lines get outputs in all directions. Each sixbar is driven through
the turn on a grid of crank angles, and those with the best scores are refined.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Complex, Integers, Real
from kinematics.compiling import njit
from synthesis.kinds.dwell.motion.outputs import CYCLE_SAMPLE_COUNT, Carrier, Kind, compute_pin_distances, locate_points
from synthesis.kinds.dwell.motion.score import ROCKER_CODE, SLIDER_CODE, SLOT_CODE, score_outputs
from synthesis.kinds.dwell.problem import Turning
from synthesis.kinds.dwell.starts.arcs import fit_arcs, fit_lines

OUTPUT_CODES: dict[Kind, int] = {"rocker": ROCKER_CODE, "slider": SLIDER_CODE, "slot": SLOT_CODE}
"""Codes of the kinds of output in the compiled loops."""

DIMENSION_COUNTS: dict[Kind, int] = {"rocker": 4, "slider": 3, "slot": 2}
"""Number of dimensions of each kind of output."""

DRAW_COUNT = 4000
"""Number of symmetric and of general fourbars that are drawn."""

MAX_PIECES = 300
"""Maximum number of pieces of curves for which outputs are built."""

DIRECTION_COUNT, REACH_COUNT = 24, 10
"""Number of directions, and of distances, of an output's pivot from the point at which its pin rests."""

MIN_PIECE_ANGLE = math.radians(60.0)
"""Minimum length of the pieces for two dwells, radians of crank rotation. Shorter pieces are all close to some arc, so
that none would be excluded."""

MIN_SAMPLES = 4
"""Minimum number of samples of a piece: three always lie on a circle."""

MAX_PIECE_ERROR, MAX_PAIR_DIFFERENCE, MIN_CENTRE_SEPARATION = 0.03, 0.06, 0.15
"""Limits of pieces for two dwells: maximum distance from an arc or line, maximum difference of their radii or error of
their angles, minimum distance of the arcs' centres; shares of the curve's extent."""

MAX_PAIRS, MAX_JUDGED = 1_000_000, 60_000
"""Maximum number of pairs of pieces that are listed, and of those for which an output is built."""

UNEVENNESS_WEIGHT = 0.3
"""Weight in a start's score of the logarithm by which its link ratio exceeds the limit."""


class Start(NamedTuple):
    """A shape, the assembly sign of its output, and the place of each dwell in the output's range.

    Shapes are those of :mod:`synthesis.kinds.dwell.motion.outputs` or of
    :mod:`synthesis.kinds.dwell.refine.stephenson_2`. A Stephenson II has only one assembly sign, no link that carries
    P, and no fourbar.
    """

    shape: Real
    sign: int
    places: tuple[float, ...]
    score: float
    carrier: Carrier = "coupler"
    turning: Turning = "crank_rocker"


class Requirements(NamedTuple):
    """Requirements on starts.

    Attributes
    ----------
    dwells, places : tuple of float
        Length of each dwell, radians of the crank, and its share of the output's range; NaN for either end.
    way, transmission : float
        Range of the output and minimum transmission angle, radians; the range is NaN for a slider.
    link_ratio : float
        Maximum of the longest distance of two pins of a link over the shortest.
    """

    dwells: tuple[float, ...]
    places: tuple[float, ...]
    way: float
    transmission: float
    link_ratio: float


class Pieces(NamedTuple):
    """All pieces of curves that are ``length`` samples long: the arc or line of each, shapes (m, N).

    Places are centres of arcs or points of lines, sizes are radii or angles; ``share`` is the maximum distance of the
    piece from its arc or line, as a share of the curve's extent.
    """

    places: Complex
    sizes: Real
    share: Real
    length: int


class Outputs(NamedTuple):
    """Outputs to be tried: row of the curve, first samples of the dwells, and up to four dimensions of the output."""

    rows: Integers
    first: Integers
    second: Integers
    numbers: Real


def count_samples(dwell: float) -> int:
    """Return the number of samples of a piece as long as a dwell (radians), which is one more than its steps."""
    return max(MIN_SAMPLES, round(dwell / math.tau * CYCLE_SAMPLE_COUNT) + 1)


def compute_dwell_begins(at: Real, length: int | Integers, dwell: float | Real) -> Real:
    """Return the crank angles at which dwells begin, from those at which their pieces of ``length`` samples begin.

    A piece is a little longer or shorter than its dwell: both have the same middle.
    """
    return np.asarray(at + 0.5 * ((length - 1) * math.tau / CYCLE_SAMPLE_COUNT - dwell))


def select_promising(scores: Real, rows: Integers, most: int) -> Iterator[int]:
    """Yield the outputs with the lowest finite scores, at most ``most`` and only one for each row."""
    used: set[int] = set()
    for n in np.argsort(scores):
        if len(used) == most or not np.isfinite(scores[n]):
            return
        if int(rows[n]) not in used:
            used.add(int(rows[n]))
            yield int(n)


def compute_link_ratio(lengths: Real) -> Real:
    """Return the longest length over the shortest, including the crank of 1; lengths (n, k)."""
    return np.asarray(np.maximum(lengths.max(axis=1), 1.0) / np.minimum(lengths.min(axis=1), 1.0))


def compute_unevenness_cost(shapes: Real, tried: Outputs, kind: Kind, carrier: Carrier, link_ratio: float) -> Real:
    """Return the cost added to the scores of outputs that make a sixbar more uneven than allowed, (n,)."""
    whole = np.concatenate([shapes[tried.rows], tried.numbers[:, : DIMENSION_COUNTS[kind]]], axis=1)
    over = compute_link_ratio(np.stack(compute_pin_distances(whole, kind, carrier), axis=1)) / link_ratio
    return np.asarray(UNEVENNESS_WEIGHT * np.log(np.maximum(over, 1.0)))


def find_starts(kind: Kind, required: Requirements, rng: np.random.Generator, most: int) -> list[Start]:
    """Find the most promising shapes for one dwell, or two equal ones at both ends, one for each fourbar."""
    dwells, dwell, way = len(required.dwells), required.dwells[0], required.way
    shapes = draw_crank_rockers(rng, required.transmission)
    turn = np.linspace(0.0, 2.0 * np.pi, CYCLE_SAMPLE_COUNT, endpoint=False)
    curves = np.ascontiguousarray(locate_points(shapes, turn, "coupler"))
    # Pieces for two dwells are lengthened, so that only pronounced arcs match.
    length = count_samples(dwell if dwells == 1 else max(dwell, MIN_PIECE_ANGLE))
    found_on = fit_pieces(curves, length, kind)
    if dwells == 1:
        tried = (build_on_lines if kind == "slot" else build_on_arcs)(curves, found_on, kind)
    else:
        tried = (build_on_two_lines if kind == "slot" else build_on_two_arcs)(curves, (found_on, found_on), kind, way)
    if not len(tried.rows):
        return []
    scores, signs, ends = (
        np.empty(len(tried.rows)),
        np.empty(len(tried.rows), np.int64),
        np.empty((len(tried.rows), 2), np.int64),
    )
    score_outputs(
        OUTPUT_CODES[kind], curves, *tried, length, dwells, way, math.sin(required.transmission), scores, signs, ends
    )
    # A penalty instead of a limit: refinement often evens out the links.
    scores += compute_unevenness_cost(shapes, tried, kind, "coupler", required.link_ratio)
    found: list[Start] = []
    for n in select_promising(scores, tried.rows, most):
        angles = compute_dwell_begins(turn[[tried.first[n], tried.second[n]][:dwells]], length, dwell)
        shape = np.concatenate([shapes[tried.rows[n]], tried.numbers[n, : DIMENSION_COUNTS[kind]], angles])
        places = tuple(1.0 if end > 0 else 0.0 for end in ends[n, :dwells])
        found.append(Start(shape, int(signs[n]), places, float(scores[n])))
    return found


def draw_crank_rockers(rng: np.random.Generator, transmission: float) -> Real:
    """Draw crank-rockers with a crank of 1: b, c, d, and P in the coupler's frame."""
    # Most random triples are not sound crank-rockers; twelve times the number leaves enough of both kinds.
    count = 12 * DRAW_COUNT
    b, c, d = np.exp(rng.uniform(math.log(1.2), math.log(6.0), (3, count)))
    # Even rows are symmetric: coupler = rocker, and below also B P.
    c = np.where(np.arange(count) % 2 == 0, b, c)
    longest, total = np.maximum(np.maximum(b, c), d), 1.0 + b + c + d
    with np.errstate(invalid="ignore"):
        cosines = np.stack([(b * b + c * c - (d + k) ** 2) / (2.0 * b * c) for k in (-1.0, 1.0)])
    # Grashof's condition with a margin, and the extreme transmission angles, where the crank lies along the ground
    # line.
    sound = (2.0 * (longest + 1.0) < total - 0.1) & (np.abs(cosines).max(axis=0) < math.cos(transmission))
    rows = np.flatnonzero(sound)
    rows = np.sort(np.concatenate([rows[rows % 2 == 0][:DRAW_COUNT], rows[rows % 2 == 1][:DRAW_COUNT]]))
    b, c, d = b[rows], c[rows], d[rows]
    free = 1.5 * np.maximum(b, d) * np.sqrt(rng.random(len(rows))) * np.exp(2j * np.pi * rng.random(len(rows)))
    p = np.where(b == c, b + b * np.exp(2j * np.pi * rng.random(len(rows))), free)
    return np.stack([b, c, d, p.real, p.imag], axis=1)


def _measure_extent(curves: Complex) -> Real:
    return np.asarray(np.hypot(np.ptp(curves.real, axis=1), np.ptp(curves.imag, axis=1)))


def fit_pieces(curves: Complex, length: int, kind: Kind) -> Pieces:
    """Fit the arcs of all pieces of a length, or for a slotted output their lines."""
    places, sizes, off = np.empty_like(curves), np.empty(curves.shape), np.empty(curves.shape)
    extent = _measure_extent(curves)[:, None]
    if kind == "slot":
        fit_lines(curves, length, places, sizes, off)
        return Pieces(places, sizes, off / extent, length)
    fit_arcs(curves, length, places, sizes, off)
    # Much smaller or larger arcs would need a link 5 out of proportion to the fourbar.
    share = np.where((sizes > 0.2 * extent) & (sizes < 4.0 * extent), off / extent, np.inf)
    return Pieces(places, sizes, share, length)


def build_on_arcs(curves: Complex, pieces: Pieces, kind: Kind) -> Outputs:
    """Build outputs whose pin rests in the centre of each curve's best arc."""
    centres, radii, share, _ = pieces
    extent = _measure_extent(curves)
    first = share.argmin(axis=1)
    best = share[np.arange(len(curves)), first]
    rows = np.argsort(best)[:MAX_PIECES]
    rows = rows[np.isfinite(best[rows])]
    first = first[rows]
    # With link 5 as long as the radius, its pin stays in the centre while P follows the arc.
    centre, radius = centres[rows, first], radii[rows, first]
    if kind == "slider":
        angle = np.tile(np.linspace(0.0, np.pi, DIRECTION_COUNT, endpoint=False), len(rows))
        rows, first, centre, radius = (np.repeat(part, DIRECTION_COUNT) for part in (rows, first, centre, radius))
        offset = (centre * np.exp(-1j * angle)).imag
        return Outputs(rows, first, first, np.stack([radius, offset, angle, 0.0 * angle], axis=1))
    # Distances of the output's pivot from the rest, in extents of the curve.
    reach = np.geomspace(0.25, 2.5, REACH_COUNT)
    direction = np.exp(2j * np.pi * np.arange(DIRECTION_COUNT) / DIRECTION_COUNT)
    each = REACH_COUNT * DIRECTION_COUNT
    arm = np.tile((reach[:, None] * direction).ravel(), len(rows)) * np.repeat(extent[rows], each)
    rows, first, centre, radius = (np.repeat(part, each) for part in (rows, first, centre, radius))
    pivot = centre + arm
    return Outputs(rows, first, first, np.stack([radius, pivot.real, pivot.imag, np.abs(arm)], axis=1))


def build_on_two_arcs(curves: Complex, pieces: tuple[Pieces, Pieces], kind: Kind, way: float) -> Outputs:
    """Build outputs whose pin rests in the centres of two arcs of nearly equal radius.

    ``way`` is the swing, radians, from one rest to the other.
    """
    rows, first, second = _select_best_pairs(pieces, _measure_extent(curves), 0.0)
    one, other = pieces[0].places[rows, first], pieces[1].places[rows, second]
    # One link serves both arcs, so that their radii are averaged.
    radius = 0.5 * (pieces[0].sizes[rows, first] + pieces[1].sizes[rows, second])
    chord = other - one
    if kind == "slider":
        angle = np.angle(chord)
        offset = (0.5 * (one + other) * np.exp(-1j * angle)).imag
        return Outputs(rows, first, second, np.stack([radius, offset, angle, 0.0 * angle], axis=1))
    sides = []
    for side in (1j, -1j):
        # Seen from the pivot, the two rests are separated by the swing. The pivot may lie on either side of them.
        pivot = 0.5 * (one + other) + side * chord / (2.0 * math.tan(0.5 * way))
        sides.append(np.stack([radius, pivot.real, pivot.imag, np.abs(one - pivot)], axis=1))
    return Outputs(np.tile(rows, 2), np.tile(first, 2), np.tile(second, 2), np.concatenate(sides))


def _select_best_pairs(pieces: tuple[Pieces, Pieces], extent: Real, way: float) -> tuple[Integers, Integers, Integers]:
    """Return row, first and second piece of the best pairs."""
    found, score = np.empty((3, MAX_PAIRS), np.int64), np.empty(MAX_PAIRS)
    one, other = pieces
    alike = one is other
    count = _list_pairs(*one, *other, extent, way, alike, found, score)
    best = np.argsort(score[:count])[:MAX_JUDGED]
    return found[0, best], found[1, best], found[2, best]


def build_on_lines(curves: Complex, pieces: Pieces, _kind: Kind) -> Outputs:
    """Build slotted outputs along the straightest piece of each curve: their pivots lie on its line."""
    places, angles, share, _ = pieces
    extent = _measure_extent(curves)
    first = share.argmin(axis=1)
    best = share[np.arange(len(curves)), first]
    rows = np.argsort(best)[: 4 * MAX_PIECES]
    first = first[rows]
    away = np.concatenate([-np.geomspace(0.15, 4.0, 2 * REACH_COUNT), np.geomspace(0.15, 4.0, 2 * REACH_COUNT)])
    pivot = places[rows, first][:, None] + (extent[rows, None] * away * np.exp(1j * angles[rows, first])[:, None])
    rows, first = np.repeat(rows, len(away)), np.repeat(first, len(away))
    pivot = pivot.ravel()
    none = np.zeros(len(pivot))
    return Outputs(rows, first, first, np.stack([pivot.real, pivot.imag, none, none], axis=1))


def build_on_two_lines(curves: Complex, pieces: tuple[Pieces, Pieces], _kind: Kind, way: float) -> Outputs:
    """Build slotted outputs whose pivots lie at the intersection of two lines that cross at the angle ``way``."""
    places, angles = pieces[0].places, pieces[0].sizes
    rows, first, second = _select_best_pairs(pieces, _measure_extent(curves), way)
    one, other = np.exp(1j * angles[rows, first]), np.exp(1j * pieces[1].sizes[rows, second])
    apart = pieces[1].places[rows, second] - places[rows, first]
    pivot = places[rows, first] + one * (apart * other.conj()).imag / (one * other.conj()).imag
    none = np.zeros(len(pivot))
    return Outputs(rows, first, second, np.stack([pivot.real, pivot.imag, none, none], axis=1))


@njit(cache=True, nogil=True, error_model="numpy")
def _list_pairs(
    places: Complex,
    radii: Real,
    share: Real,
    length: int,
    other_places: Complex,
    other_radii: Real,
    other_share: Real,
    other_length: int,
    extent: Real,
    way: float,
    alike: bool,
    found: Integers,
    score: Real,
) -> int:
    """List all disjoint pairs of pieces of a curve that may rest an output twice; return their number.

    For arcs ``places`` are their centres, which must be separated, and the radii should be equal. For lines, with
    ``way`` the angle at which they should cross, ``radii`` are their angles. Pairs of ``alike`` pieces are listed once.
    Fills row, first and second piece, and a score.
    """
    n, count = share.shape[1], 0
    for row in range(len(share)):
        for i in range(n):
            if not share[row, i] < MAX_PIECE_ERROR:
                continue
            # The second piece begins after the first ends, and ends before the first begins.
            last = i + n - other_length + 1
            for beyond in range(i + length, min(n, last) if alike else last):
                j = beyond % n
                if not other_share[row, j] < MAX_PIECE_ERROR:
                    continue
                if way == 0.0:
                    wrong = abs(radii[row, i] - other_radii[row, j]) / extent[row]
                    if (
                        wrong > MAX_PAIR_DIFFERENCE
                        or abs(places[row, i] - other_places[row, j]) <= MIN_CENTRE_SEPARATION * extent[row]
                    ):
                        continue
                else:
                    # Lines have no direction: they cross at an angle and its supplement.
                    crossing = abs(radii[row, i] - other_radii[row, j]) % math.pi
                    wrong = 0.3 * min(abs(crossing - way), abs(math.pi - crossing - way))
                if wrong > MAX_PAIR_DIFFERENCE or count == len(score):
                    continue
                found[0, count], found[1, count], found[2, count] = row, i, j
                score[count] = max(share[row, i], other_share[row, j]) + wrong
                count += 1
    return count
