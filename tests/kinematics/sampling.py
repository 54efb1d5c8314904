"""Random linkages and configurations for the laws; everything follows from a seed."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Integers, Real
from kinematics.linkage.fourbar import Fourbar
from tests.oracles.continuation import Linkages


def random_fourbars(rng: np.random.Generator, n: int, gap: float = 0.0) -> Fourbar:
    """n fourbars that can be assembled, anywhere in the plane, link lengths between 0.1 and 3.

    ``gap`` keeps S + L − P − Q away from zero, as a share of the perimeter.
    """
    lengths = np.exp(rng.uniform(np.log(0.1), np.log(3.0), (4 * n + 100, 4)))
    ordered = np.sort(lengths, axis=1)
    perimeter = ordered.sum(axis=1)
    excess = ordered[:, 0] + ordered[:, 3] - ordered[:, 1] - ordered[:, 2]
    sound = (2.0 * ordered[:, 3] < (1.0 - gap) * perimeter) & (np.abs(excess) > gap * perimeter)
    d, a, b, c = lengths[sound][:n].T
    assert len(a) == n
    pivot = rng.normal(size=n) + 1j * rng.normal(size=n)
    turned = pivot + d * np.exp(1j * rng.uniform(-np.pi, np.pi, n))
    return Fourbar(pivot, turned, a, b, c, rng.normal(size=n) + 1j * rng.normal(size=n))


def assembled_angles(rng: np.random.Generator, linkage: Fourbar, m: int, margin: float = 0.0) -> Real:
    """m input angles of each linkage at which it closes, shape (n, m), found by trial from its lengths alone.

    ``margin`` keeps the diagonal A–O4 away from its limits, as a share of the coupler and output together.
    """
    n = linkage.input.size
    b, c = linkage.coupler[:, None, None], linkage.output[:, None, None]
    tried = rng.uniform(-np.pi, np.pi, (n, m, 150))
    base = (linkage.output_pivot - linkage.input_pivot)[:, None, None]
    f = np.abs(base - linkage.input[:, None, None] * np.exp(1j * tried))
    room = margin * (b + c)
    good = (f < b + c - room) & (f > np.abs(b - c) + room)
    first = good.argmax(axis=-1)[..., None]
    found = np.take_along_axis(tried, first, axis=-1)[..., 0]
    return np.where(np.take_along_axis(good, first, axis=-1)[..., 0], found, np.nan)


def signs(rng: np.random.Generator, *shape: int) -> Integers:
    return rng.choice(np.array([1, -1]), shape)


def plain(linkage: Fourbar) -> Linkages:
    """The same designs as the continuation takes them."""
    fields = (linkage.input_pivot, linkage.output_pivot, linkage.input, linkage.coupler, linkage.output)
    return Linkages(*(np.atleast_1d(field) for field in fields))


def take(linkage: Fourbar, index: object) -> Fourbar:
    """Some designs of a batch, or one."""
    fields = ("input_pivot", "output_pivot", "input", "coupler", "output", "coupler_point")
    return Fourbar(*(getattr(linkage, name)[index] for name in fields))


def hand_of_b(linkage: Fourbar, pin_a: NDArray[np.complex128], pin_b: NDArray[np.complex128]) -> Real:
    """Side of B seen from A towards O4, for designs × angles: +1 left, −1 right."""
    forward, towards = linkage.output_pivot[..., None] - pin_a, pin_b - pin_a
    return np.sign(forward.real * towards.imag - forward.imag * towards.real)
