"""Minimum number of planes for plates that are joined by pins and must not collide.

*Plates* lie in planes 1, 2, ... above the base, plane 0. Plates that are *apart* lie in different planes, and plates of
one *mesh* in the same one. A *pin* reaches from the lowest of its plates to the highest; a pin on the base starts
there, and one held by a second base above all plates ends there. A plate that *meets* a pin must not lie in any plane
that the pin reaches.

An arrangement is built plane by plane. Whether plates T can form the next plane depends only on the set S of plates
below, not on their order: a pin is present if it has begun (a plate in S or T, or the base) and has not ended (all its
plates in S and no base above). So the optimum for all plates follows from the optimum for fewer (Bellman), over all
sets and all next planes, 3ⁿ steps for n plates; the search is exhaustive, and the minimum is proved. It minimizes, in
this order, the number of plates that block a pin they meet, the number of planes, and the total length of the pins in
planes.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Integers
from kinematics.compiling import njit
from kinematics.errors import DimensionError

MAX_PLATES = 12
"""Maximum number of plates, a mesh counted as one: 3¹² steps take a few milliseconds, and no linkage in textbooks has
more than seven moving links."""

_CONFLICT_WEIGHT, _PLANE_WEIGHT = 1 << 24, 1 << 12
"""Weights of a blocked pin and of a plane relative to one plane of pin length. The total pin length is below 4096: at
most 12 planes times 200 pins, so the order of the criteria is lexicographic."""

_UNKNOWN_COST = np.iinfo(np.int64).max


class Spindle(NamedTuple):
    """A pin: the numbers of the plates that it joins and of those that meet it, and the bases that hold it."""

    plates: frozenset[int]
    meets: frozenset[int] = frozenset()
    below: bool = False
    above: bool = False


def stack_plates(
    count: int,
    apart: Sequence[tuple[int, int]],
    pins: Sequence[Spindle],
    meshes: Sequence[Sequence[int]] = (),
) -> tuple[int, ...]:
    """Find the arrangement with the fewest plates that block pins, and among these with the fewest planes.

    Parameters
    ----------
    count : int
        Number of plates, at most :data:`MAX_PLATES` with each mesh as one.
    apart : sequence of pairs of int
        Plates that lie in different planes. Pairs within a mesh are ignored: its plates share a plane by design.
    pins : sequence of Spindle
        At most 200.
    meshes : sequence of sequences of int
        Plates that lie in one plane.

    Returns
    -------
    tuple of int
        The plane of each plate, from 1.

    Raises
    ------
    DimensionError
        For more plates than can be arranged.

    Examples
    --------
    Input, coupler and output of a fourbar (0, 1, 2). Without collisions two planes suffice; an input that meets the
    output's pivot (pin 1) lies above it:

    >>> O2, O4 = Spindle(frozenset({0}), below=True), Spindle(frozenset({2}), below=True)
    >>> stack_plates(3, [(0, 1), (1, 2)], [O2, O4])
    (1, 2, 1)
    >>> stack_plates(3, [(0, 1), (1, 2)], [O2, O4._replace(meets=frozenset({0}))])
    (2, 3, 1)
    """
    own = list(range(count))
    for mesh in meshes:
        # Merge the plates of a mesh into one, as they share a plane.
        first = min(own[plate] for plate in mesh)
        merged = {own[plate] for plate in mesh}
        own = [first if plate in merged else plate for plate in own]
    kept = sorted(set(own))
    place = [kept.index(plate) for plate in own]
    if len(kept) > MAX_PLATES:
        raise DimensionError("kinematics-plates", "kinematics-at-most", len(kept), most=MAX_PLATES)
    parted = np.zeros(len(kept), np.int64)
    for one, other in apart:
        if place[one] != place[other]:
            parted[place[one]] |= 1 << place[other]
            parted[place[other]] |= 1 << place[one]
    joined = np.array([_build_mask(place, pin.plates) for pin in pins], np.int64)
    # Several plates of a mesh may meet a pin: each counts.
    met = np.zeros((len(pins), len(kept)), np.int64)
    for n, pin in enumerate(pins):
        for plate in pin.meets:
            met[n, place[plate]] += 1
    held = np.array([[pin.below, pin.above] for pin in pins], np.bool_).reshape(-1, 2)
    last = _minimize_planes(len(kept), parted, joined, held, met)
    layers: list[int] = []
    lying = (1 << len(kept)) - 1
    while lying:
        layers.append(int(last[lying]))
        lying &= ~layers[-1]
    plane_of = [next(n for n, layer in enumerate(reversed(layers), 1) if layer >> k & 1) for k in range(len(kept))]
    return tuple(plane_of[k] for k in place)


def find_reach(planes: Sequence[int], pin: Spindle) -> tuple[int, int]:
    """Return the lowest and highest plane of a pin; 0 is the base, number of planes + 1 the upper base."""
    own = [planes[plate] for plate in pin.plates]
    return 0 if pin.below else min(own), max(planes) + 1 if pin.above else max(own)


def is_in_the_way(planes: Sequence[int], pin: Spindle, plate: int) -> bool:
    """Return whether a plate lies in a plane that a pin reaches."""
    low, high = find_reach(planes, pin)
    return low <= planes[plate] <= high


def _build_mask(place: Sequence[int], plates: frozenset[int]) -> int:
    mask = 0
    for plate in plates:
        mask |= 1 << place[plate]
    return mask


@njit(cache=True, nogil=True)
def _minimize_planes(
    count: int, parted: Integers, joined: Integers, held: NDArray[np.bool_], met: Integers
) -> Integers:
    """Compute for each set of plates the top plane of its best arrangement, as a set."""
    sets = 1 << count
    in_one_plane = np.ones(sets, np.bool_)
    for layer in range(1, sets):
        for plate in range(count):
            if layer >> plate & 1 and layer & parted[plate]:
                in_one_plane[layer] = False
                break
    least = np.full(sets, _UNKNOWN_COST, np.int64)
    last = np.zeros(sets, np.int64)
    least[0] = 0
    # Sets in increasing order: all subsets of a set come before it.
    for below in range(sets - 1):
        if least[below] == _UNKNOWN_COST:
            continue
        rest = (sets - 1) & ~below
        layer = rest
        while layer > 0:
            if in_one_plane[layer]:
                cost = least[below] + _PLANE_WEIGHT
                for pin in range(len(joined)):
                    # The pin passes this plane if it has begun and not yet ended.
                    begun = held[pin, 0] or (joined[pin] & (below | layer)) != 0
                    if begun and (held[pin, 1] or (joined[pin] & ~below) != 0):
                        cost += 1
                        for plate in range(count):
                            if layer >> plate & 1:
                                cost += _CONFLICT_WEIGHT * met[pin, plate]
                if cost < least[below | layer]:
                    least[below | layer] = cost
                    last[below | layer] = layer
            # Next smaller subset of ``rest``.
            layer = (layer - 1) & rest
    return last
