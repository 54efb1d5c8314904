"""Find starts for dwells of given lengths and places: sixbars of all types, scored by their motion alone.

Outputs of coupler curves rest on arcs or lines: on the best one of each curve for the longest dwell, or on two, each as
long as one of the dwells. Watt II sixbars, whose P moves back and forth on a circle about O4 or all around it, are
drawn at random.
"""

from __future__ import annotations

import math

import numpy as np

from kinematics.arrays import Complex, Real
from synthesis.kinds.dwell.motion.outputs import CYCLE_SAMPLE_COUNT, MIN_GRASHOF_MARGIN, Carrier, Kind, locate_points
from synthesis.kinds.dwell.motion.program_score import score_program
from synthesis.kinds.dwell.problem import Turning
from synthesis.kinds.dwell.starts.coupler_curve_starts import (
    DIMENSION_COUNTS,
    DRAW_COUNT,
    MIN_PIECE_ANGLE,
    OUTPUT_CODES,
    Outputs,
    Requirements,
    Start,
    build_on_arcs,
    build_on_lines,
    build_on_two_arcs,
    build_on_two_lines,
    compute_dwell_begins,
    compute_link_ratio,
    compute_unevenness_cost,
    count_samples,
    draw_crank_rockers,
    fit_pieces,
    select_promising,
)

OUTPUTS_PER_FOURBAR: dict[Carrier, int] = {"rocker": 24, "coupler": 8}
"""Number of random outputs for each fourbar, by the link that carries P."""


def find_placed_starts(
    kind: Kind,
    carrier: Carrier,
    turning: Turning,
    required: Requirements,
    rng: np.random.Generator,
    most: int,
) -> list[Start]:
    """Find the most promising shapes, one for each fourbar.

    Parameters
    ----------
    kind, carrier, turning : str
        Output, the link that carries P, and the class of the fourbar.
    required : Requirements
    rng : Generator
    most : int
        Maximum number of starts.

    Returns
    -------
    list of Start
        Best first.
    """
    dwells, places, way, transmission, link_ratio = required
    shapes = (
        draw_crank_rockers(rng, transmission) if turning == "crank_rocker" else draw_double_cranks(rng, transmission)
    )
    # Links of the fourbar itself can only become more uneven with the output.
    shapes = shapes[compute_link_ratio(shapes[:, :3]) <= link_ratio]
    if carrier == "rocker":
        # Size and direction of the second loop are free: initially P forms an equilateral triangle with O4 and B.
        shapes[:, 3], shapes[:, 4] = 0.5 * shapes[:, 1], math.sqrt(0.75) * shapes[:, 1]
    turn = np.linspace(0.0, 2.0 * np.pi, CYCLE_SAMPLE_COUNT, endpoint=False)
    curves = np.ascontiguousarray(locate_points(shapes, turn, carrier))
    lengths = np.array([count_samples(dwell) for dwell in dwells])
    if not len(shapes):
        return []
    tried = _draw_outputs(kind, carrier, shapes, curves, rng)
    if carrier == "coupler":
        on_curves = _build_on_curves(kind, curves, dwells, places, way)
        tried = Outputs(*(np.concatenate(parts) for parts in zip(tried, on_curves, strict=True)))
    count, numbers = len(tried.rows), tried.numbers
    scores, signs = np.empty(count), np.empty(count, np.int64)
    begins, ends = np.zeros((count, len(dwells)), np.int64), np.zeros((count, len(dwells)))
    score_program(
        OUTPUT_CODES[kind],
        curves,
        tried.rows,
        numbers,
        lengths,
        np.array(places),
        way,
        math.sin(transmission),
        scores,
        signs,
        begins,
        ends,
    )
    scores += compute_unevenness_cost(shapes, tried, kind, carrier, link_ratio)
    found: list[Start] = []
    for n in select_promising(scores, tried.rows, most):
        angles = compute_dwell_begins(turn[begins[n]], lengths, np.array(dwells))
        shape = np.concatenate([shapes[tried.rows[n]], numbers[n, : DIMENSION_COUNTS[kind]], angles])
        found.append(Start(shape, int(signs[n]), tuple(ends[n].tolist()), float(scores[n]), carrier, turning))
    return found


def draw_double_cranks(rng: np.random.Generator, transmission: float) -> Real:
    """Draw double cranks with a crank of 1: b, c, d, and P in the coupler's frame."""
    # Few random lengths make a sound double crank.
    count = 60 * DRAW_COUNT
    b, c = np.exp(rng.uniform(math.log(0.4), math.log(3.0), (2, count)))
    d = np.exp(rng.uniform(math.log(0.12), math.log(0.9), count))
    shortest = np.minimum(b + c - d - 1.0, np.minimum(c + 1.0 - b - d, b + 1.0 - c - d))
    cosines = np.stack([(b * b + c * c - (d + k) ** 2) / (2.0 * b * c) for k in (-1.0, 1.0)])
    sound = (shortest > 2.0 * MIN_GRASHOF_MARGIN) & (np.abs(cosines).max(axis=0) < math.cos(transmission))
    b, c, d = (part[np.flatnonzero(sound)[:DRAW_COUNT]] for part in (b, c, d))
    p = 1.5 * np.maximum(b, 1.0) * np.sqrt(rng.random(len(b))) * np.exp(2j * np.pi * rng.random(len(b)))
    return np.stack([b, c, d, p.real, p.imag], axis=1)


def _build_on_curves(
    kind: Kind, curves: Complex, dwells: tuple[float, ...], places: tuple[float, ...], way: float
) -> Outputs:
    """Build outputs that rest on the best arc or line of a curve, and on pairs of them."""
    longest = sorted(range(len(dwells)), key=lambda k: -dwells[k])
    found = [
        (build_on_lines if kind == "slot" else build_on_arcs)(
            curves, fit_pieces(curves, count_samples(dwells[longest[0]]), kind), kind
        )
    ]
    for other in longest[1:]:
        # Combine the longest dwell with each of the others.
        pair = dwells[longest[0]], dwells[other]
        # Longer pieces make pronounced arcs, as long as both fit into the turn.
        looked_at = [max(dwell, MIN_PIECE_ANGLE) if sum(pair) < math.pi else dwell for dwell in pair]
        two = [fit_pieces(curves, count_samples(dwell), kind) for dwell in looked_at]
        # The swing between two dwells is that share of the whole range.
        apart = abs(places[longest[0]] - places[other])
        rests = build_on_two_lines if kind == "slot" else build_on_two_arcs
        found.append(rests(curves, (two[0], two[1]), kind, apart * way))
    tried = Outputs(*(np.concatenate(parts) for parts in zip(*found, strict=True)))
    if kind != "slider":
        return tried
    # The same slide in the opposite direction exchanges low and high.
    turned = tried.numbers * np.array([1.0, -1.0, 1.0, 1.0]) + np.array([0.0, 0.0, math.pi, 0.0])
    both = np.concatenate([tried.numbers, turned])
    return Outputs(np.tile(tried.rows, 2), np.tile(tried.first, 2), np.tile(tried.second, 2), both)


def _draw_outputs(kind: Kind, carrier: Carrier, shapes: Real, curves: Complex, rng: np.random.Generator) -> Outputs:
    """Draw random links and outputs on P: in units of the rocker about O4, or of the curve about its middle."""
    rows = np.repeat(np.arange(len(shapes)), OUTPUTS_PER_FOURBAR[carrier])
    middle, size = shapes[:, 2] + 0j, shapes[:, 1]
    if carrier == "coupler":
        middle = curves.mean(axis=1)
        size = np.abs(curves - middle[:, None]).max(axis=1)
    middle, size = middle[rows], size[rows]
    link, other, reach = size * np.exp(rng.uniform(math.log(0.4), math.log(3.5), (3, len(rows))))
    direction = rng.uniform(0.0, math.tau, len(rows))
    none = np.zeros(len(rows))
    place = middle + reach * np.exp(1j * direction)
    if kind == "slider":
        offset = rng.uniform(-1.2, 1.2, len(rows)) * size + (middle * np.exp(-1j * direction)).imag
        numbers = np.stack([link, offset, direction, none], axis=1)
    elif kind == "slot":
        numbers = np.stack([place.real, place.imag, none, none], axis=1)
    else:
        numbers = np.stack([link, place.real, place.imag, other], axis=1)
    return Outputs(rows, rows, rows, numbers)
