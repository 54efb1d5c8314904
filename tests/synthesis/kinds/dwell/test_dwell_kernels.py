"""The compiled loops of the search for dwells against plain numpy."""

import math

import numpy as np
import pytest

from kinematics.linkage.fourbar import OPEN_ASSEMBLY, Fourbar, coupler_points
from synthesis.kinds.dwell.motion.outputs import CYCLE_SAMPLE_COUNT, compute_output
from synthesis.kinds.dwell.motion.score import ROCKER_CODE, SLIDER_CODE, SLOT_CODE, score_outputs
from synthesis.kinds.dwell.starts.arcs import fit_arcs, fit_lines

LENGTH, DWELL_WAY, LEAST = 11, 0.9, math.sin(0.5)


def curves(count):
    """Coupler curves of random crank-rockers with a crank of 1, shape (count, CYCLE)."""
    rng = np.random.default_rng(11)
    b, c, d = rng.uniform(1.5, 4.0, (3, 20 * count))
    longest = np.maximum(np.maximum(b, c), d)
    b, c, d = (part[2.0 * (longest + 1.0) < 1.0 + b + c + d][:count] for part in (b, c, d))
    p = rng.uniform(-2.0, 3.0, len(b)) + 1j * rng.uniform(-2.0, 3.0, len(b))
    linkage = Fourbar.from_lengths(np.ones(len(b)), b, c, d, p)
    found = coupler_points(linkage, np.linspace(0.0, 2.0 * np.pi, CYCLE_SAMPLE_COUNT, endpoint=False), OPEN_ASSEMBLY).p
    assert np.isfinite(found).all()
    return np.ascontiguousarray(found)


def pieces(curve, start):
    return curve[(start + np.arange(LENGTH)) % CYCLE_SAMPLE_COUNT]


def test_arcs_and_lines_are_those_of_least_squares():
    some = curves(6)
    centres, radii, off = np.empty_like(some), np.empty(some.shape), np.empty(some.shape)
    fit_arcs(some, LENGTH, centres, radii, off)
    points, angles, beside = np.empty_like(some), np.empty(some.shape), np.empty(some.shape)
    fit_lines(some, LENGTH, points, angles, beside)
    for row in range(len(some)):
        for start in range(0, CYCLE_SAMPLE_COUNT, 7):
            z = pieces(some[row], start)
            # |z|² = 2 Re(z̄ c) + k, least squares in c and k, from the middle of the piece.
            w = z - z.mean()
            matrix = np.stack([2.0 * w.real, 2.0 * w.imag, np.ones(LENGTH)], axis=1)
            (x, y, k), *_ = np.linalg.lstsq(matrix, np.abs(w) ** 2, rcond=None)
            centre, radius = complex(x, y) + z.mean(), math.sqrt(k + x * x + y * y)
            assert np.isclose(centres[row, start], centre, rtol=1e-7)
            assert np.isclose(radii[row, start], radius, rtol=1e-7)
            assert np.isclose(off[row, start], np.abs(np.abs(z - centre) - radius).max(), rtol=1e-4, atol=1e-9)
            direction = np.linalg.svd(np.stack([w.real, w.imag], axis=1))[2][0]
            assert abs(math.sin(angles[row, start] - math.atan2(direction[1], direction[0]))) < 1e-8
            across = w.imag * direction[0] - w.real * direction[1]
            assert np.isclose(beside[row, start], np.abs(across).max(), rtol=1e-9)
            assert np.isclose(points[row, start], z.mean())


def scored(kind, curve, numbers, firsts, dwells):
    """Sign, ends of the way and score of one output, by the formulas of the refinement; None where it cannot turn."""
    places = {"rocker": 9, "slider": 8, "slot": 7}[kind]
    shape = np.zeros((1, places))
    shape[0, 5:] = numbers[: places - 5]
    found = {}
    for sign in (1, -1) if kind != "slot" else (1,):
        out, sine = (part[0] for part in compute_output(kind, sign, shape, curve[None]))
        found[sign] = out, sine

    def rest(out, first):
        piece = out[(first + np.arange(LENGTH)) % CYCLE_SAMPLE_COUNT]
        return np.exp(1j * piece) if kind == "rocker" else piece

    if kind == "slot":
        sign = 1
        near = np.abs(curve - complex(*numbers[:2])).min() < 0.3
        if near:
            return None
    else:
        moved = {}
        for side, (out, _) in found.items():
            piece = rest(out, firsts[0])
            moved[side] = np.abs(piece - piece[0]).max() if kind == "rocker" else np.ptp(piece)
        sign = 1 if not moved[-1] < moved[1] else -1
    out, sine = found[sign]
    if not np.isfinite(out).all() or not np.isfinite(sine).all():
        return None
    low, high = out.min(), out.max()
    score, ending, ends = 0.0, 0.0, []
    for first in firsts[:dwells]:
        piece = out[(first + np.arange(LENGTH)) % CYCLE_SAMPLE_COUNT]
        score = max(score, np.ptp(piece) / (high - low))
        ends.append(1 if high - piece.mean() < piece.mean() - low else -1)
        ending = max(ending, min(high - piece.mean(), piece.mean() - low) / (high - low))
    if dwells == 2 and ends[0] == ends[1]:
        return None
    score += 0.5 * ending + 0.5 * max(0.0, 1.5 * LEAST - (1.0 if kind == "slot" else sine.min()))
    if kind == "slider":
        score += 0.05 * max(0.0, math.log(2.0 * np.abs(curve - curve[0]).max() / (high - low)))
    else:
        score += 0.3 * abs(math.log((high - low) / DWELL_WAY))
    return sign, ends, score


@pytest.mark.parametrize("dwells", [1, 2])
@pytest.mark.parametrize(("kind", "number"), [("rocker", ROCKER_CODE), ("slider", SLIDER_CODE), ("slot", SLOT_CODE)])
def test_scores_are_those_of_plain_formulas(kind, number, dwells):
    rng = np.random.default_rng(number)
    some = curves(12)
    centres, radii, off = np.empty_like(some), np.empty(some.shape), np.empty(some.shape)
    fit_arcs(some, LENGTH, centres, radii, off)
    count = 400
    rows, first = rng.integers(0, len(some), count), rng.integers(0, CYCLE_SAMPLE_COUNT, count)
    second = (first + 30) % CYCLE_SAMPLE_COUNT
    centre, radius = centres[rows, first], radii[rows, first]
    if kind == "rocker":
        arm = rng.uniform(1.0, 6.0, count) * np.exp(2j * np.pi * rng.random(count))
        numbers = np.stack([radius, (centre + arm).real, (centre + arm).imag, np.abs(arm)], axis=1)
    elif kind == "slider":
        angle = 2.0 * np.pi * rng.random(count)
        numbers = np.stack([radius, (centre * np.exp(-1j * angle)).imag, angle, np.zeros(count)], axis=1)
    else:
        numbers = np.concatenate([rng.uniform(-5.0, 5.0, (count, 2)), np.zeros((count, 2))], axis=1)
    scores, signs, ends = np.empty(count), np.empty(count, np.int64), np.zeros((count, 2), np.int64)
    score_outputs(number, some, rows, first, second, numbers, LENGTH, dwells, DWELL_WAY, LEAST, scores, signs, ends)
    compared = 0
    for k in range(count):
        known = scored(kind, some[rows[k]], numbers[k], (first[k], second[k]), dwells)
        assert (known is not None) == np.isfinite(scores[k])
        if known is not None:
            compared += 1
            assert signs[k] == known[0]
            assert ends[k, :dwells].tolist() == known[1]
            assert scores[k] == pytest.approx(known[2], rel=1e-9)
    assert compared > 20
