"""Fourbars through five points at given crank angles, by Newton's method from very many starts.

With the crank pin at O2 + w r_k (r_k the crank's rotations) the coupler side keeps its length,

    |P_k − O2 − w r_k| = |P_0 − O2 − w|,        k = 1 … 4,

four equations for O2 and w. The coupler's rotations s_k follow, and the output link keeps its length:
|P_k − O4 + q s_k| = |P_0 − O4 + q| with q from P to B. That is the same system with w = −q.
"""

from __future__ import annotations

import numpy as np

STARTS, STEPS = 600, 80


def dyads(points, rotations, rng):
    """All real (O, w) that many starts lead to, in units of the points; shape (n, 2), complex."""
    size = np.abs(points[:, None] - points).max()
    spread = size * np.exp(rng.uniform(-2.0, 3.0, (STARTS, 2)))
    turned = np.exp(2j * np.pi * rng.uniform(size=(STARTS, 2)))
    z = spread * turned + np.array([points.mean(), 0.0])
    for _ in range(STEPS):
        gap = points - z[:, :1] - z[:, 1:] * rotations
        value = np.abs(gap[:, 1:]) ** 2 - np.abs(gap[:, :1]) ** 2
        by_o = -2.0 * (gap[:, 1:] - gap[:, :1])
        by_w = -2.0 * (gap[:, 1:] * rotations[1:].conj() - gap[:, :1])
        jacobian = np.stack([by_o.real, by_o.imag, by_w.real, by_w.imag], axis=-1)
        jacobian += 1e-14 * size * np.eye(4)
        step = np.linalg.solve(jacobian, -value[..., None])[..., 0]
        moved = np.stack([step[:, 0] + 1j * step[:, 1], step[:, 2] + 1j * step[:, 3]], axis=1)
        length = np.abs(moved).max(axis=1, keepdims=True)
        z = z + moved * np.minimum(
            1.0, 2.0 * (size + np.abs(z).max(axis=1, keepdims=True)) / np.maximum(length, 1e-300)
        )
        z = np.where(np.abs(z) < 1e7 * size, z, 0.1 * size)
    gap = points - z[:, :1] - z[:, 1:] * rotations
    reach = np.abs(gap).max(axis=1)
    off = np.abs(np.abs(gap[:, 1:]) - np.abs(gap[:, :1])).max(axis=1)
    good = z[(off <= 1e-9 * reach) & (np.abs(z).max(axis=1) < 1e5 * size)]
    kept = []
    for one in good:
        if all(np.abs(one - other).max() > 1e-5 * (size + np.abs(one).max()) for other in kept):
            kept.append(one)
    return np.array(kept, np.complex128).reshape(-1, 2)


def fourbars(points, turns, rng):
    """O2, A, B, O4 of all fourbars that are found, and the number of input dyads."""
    inputs = dyads(points, np.exp(1j * turns), rng)
    found = []
    for o2, w in inputs:
        gap = points - o2 - w * np.exp(1j * turns)
        a = o2 + w
        for o4, minus_q in dyads(points, gap / gap[0], rng):
            b = points[0] - minus_q
            if max(abs(o4 - o2), abs(b - a)) > 1e-5 * (np.abs(points).max() + abs(o2) + abs(a)):
                found.append((o2, a, b, o4))
    return np.array(found, np.complex128).reshape(-1, 4), len(inputs)
