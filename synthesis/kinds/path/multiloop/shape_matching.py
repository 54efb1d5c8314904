"""Find random linkages whose curves have the shape of a target: drawn, compared and placed in batches.

Linkages are drawn by :mod:`synthesis.fit.linkage.population`, and their curves compared like those of fourbars
(:mod:`synthesis.kinds.path.curve.shape_matching`).
"""

from __future__ import annotations

import math
from concurrent.futures import ThreadPoolExecutor

import numpy as np

from kinematics.arrays import Complex, Integers, Real
from synthesis.fit.linkage.closure import move_reference
from synthesis.fit.linkage.descent import Fit
from synthesis.fit.linkage.population import SWEEP_STEP_COUNT, Population
from synthesis.fit.linkage.topology import Topology
from synthesis.kinds.path.curve.shape_matching import (
    CHUNK_SIZE,
    WINDOW_LENGTHS,
    compare_closed,
    compare_open,
    fit_similarity,
    resample_matched,
)
from synthesis.kinds.path.task.target_curve import SHAPE_POINT_COUNT
from synthesis.numerics.portions import THREAD_COUNT
from synthesis.results.ranking import select_distinct

MIN_TRANSMISSION_ANGLE = 15.0
"""Minimum transmission angle, degrees, of a drawn linkage; descents that start closer to a toggle seldom leave it."""

START_DUPLICATE_TOLERANCE = 0.05
"""Starts whose joints agree to this share of the target's size lead to the same linkage."""

OVERSUPPLY_FACTOR = 4
"""Multiple of the requested number that is searched for distinct linkages."""

MAX_OVERSIZE_RATIO = 2.0
"""Maximum excess factor of the span of a start over the longest permitted link; most links shrink in the descent."""


def find_similar_linkages(
    topology: Topology,
    target: Complex,
    closed: bool,
    count: int,
    keep: int,
    rng: np.random.Generator,
    *,
    family: int = -1,
    longest: float = math.inf,
    full_turn: bool = True,
) -> list[Fit]:
    """Draw linkages of a topology and return the most similar to a target, placed on it, the most similar first.

    Parameters
    ----------
    topology : Topology
    target : complex, shape (SHAPE_POINT_COUNT,)
        Equal steps along the target.
    closed : bool
        Whether it is a closed curve; an open one is compared with windows of the curves.
    count, keep : int
        Number of linkages drawn and maximum number returned.
    rng : Generator
    family : int
        The shortest link of the first fourbar, see :class:`~synthesis.fit.linkage.population.Population`.
    longest : float
        Longest link, in the target's unit.
    full_turn : bool
        Whether the reference position may be anywhere; otherwise it becomes the middle of the stroke.

    Returns
    -------
    list of Fit
        Their cost is the dissimilarity √(1 − ρ²).
    """
    shape = target - target.mean()
    shape /= np.linalg.norm(shape)
    seeds = rng.integers(2**31, size=math.ceil(count / CHUNK_SIZE))

    def compare_chunk(seed: int) -> tuple[Real, Complex, Real, Integers]:
        drawn = Population(topology, min(count, CHUNK_SIZE), MIN_TRANSMISSION_ANGLE, family, seed)
        found = compare_closed(drawn.curves, shape) if closed else compare_open(drawn.curves, True, shape)
        # The least similar of a chunk are never among the best of all.
        best = np.argsort(-found.rho, kind="stable")[: OVERSUPPLY_FACTOR * keep]
        return drawn.z[best], drawn.curves[best], found.rho[best], found.where[best]

    with ThreadPoolExecutor(THREAD_COUNT) as pool:
        chunks = list(pool.map(compare_chunk, map(int, seeds)))
    z, curves, rho, where = (np.concatenate(parts) for parts in zip(*chunks, strict=True))
    order = np.argsort(-rho, kind="stable")[: OVERSUPPLY_FACTOR * keep]
    placed = [_place_linkage(topology, z[k], curves[k], where[k], target, closed) for k in order]
    if not full_turn:
        placed = [_move_to_middle(fit) for fit in placed]
    size = float(np.ptp(target.real) + np.ptp(target.imag))
    joints = np.array([fit.x[0::2] + 1j * fit.x[1::2] for fit in placed])
    # Joints far outside mean links beyond the limit. The negation also drops NaN.
    near = np.flatnonzero(np.abs(joints - target.mean()).max(axis=1) <= MAX_OVERSIZE_RATIO * longest)
    kept = near[select_distinct(joints[near], keep, START_DUPLICATE_TOLERANCE * size)] if len(near) else near
    return [placed[k]._replace(cost=math.sqrt(max(0.0, 1.0 - float(rho[order[k]]) ** 2))) for k in kept]


_INPUTS = 2.0 * np.pi * np.arange(SWEEP_STEP_COUNT) / SWEEP_STEP_COUNT


def _place_linkage(
    topology: Topology, z: Real, curve: Complex, where: Integers, target: Complex, closed: bool
) -> Fit:  # fmt: skip
    """Move a linkage onto the target by a similarity transformation; its inputs are those at the target's points."""
    matched, inputs, mirrored = resample_matched(
        curve, _INPUTS, True, 2.0 * math.pi, where, np.array(WINDOW_LENGTHS), closed, SHAPE_POINT_COUNT
    )
    places = z[0::2] + 1j * z[1::2]
    if mirrored:
        places = places.conj()
    centre = matched.mean()
    placed = fit_similarity(matched, centre, target) * (places - centre) + target.mean()
    x = np.empty(len(z))
    x[0::2], x[1::2] = placed.real, placed.imag
    return Fit(topology, x, np.ascontiguousarray(inputs))


def _move_to_middle(fit: Fit) -> Fit:
    """Move the reference position to the middle of the stroke, from where the ends are equally far."""
    middle, moved = 0.5 * float(fit.inputs[0] + fit.inputs[-1]), fit.x.copy()
    # Drawn linkages close at every input.
    move_reference(fit.topology.nodes, fit.x, middle, moved)
    return fit._replace(x=moved, inputs=fit.inputs - middle)
