"""The least number of planes in which plates can lie that pins join and that have to keep out of one another's way.

*Plates* lie in planes 1, 2, ... above the base, plane 0. Plates that are *apart* lie in different planes, and plates of
one *mesh* in the same one. A *pin* reaches from the lowest of its plates to the highest; one that stands on the base
from there, one that hangs on a second base above all plates up to that. A plate that *meets* it may not lie anywhere
between, these planes included.

An arrangement is built plane by plane. Whether plates T may make the next plane depends on the set S of the plates that
lie below alone, not on how these lie: a pin is there if it has begun, by a plate in S or T or at the base, and not
ended, with all of its plates in S and no base above to reach. So the least for all plates follows from the least for
fewer (Bellman), over all sets and all next planes, 3ⁿ steps for n plates; nothing is left out, and the number is proved
to be the least. What is least is, in this order, the plates that lie in the way of a pin they meet, the planes, and the
planes that pins reach through: the shortest pins.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.compiling import njit
from kinematics.errors import DimensionError

Masks = NDArray[np.int64]

MOST_PLATES = 12
"""Plates that are arranged at most, a mesh as one: 3¹² steps take some milliseconds, and no linkage of a book has more
moving links than seven."""

_BROKEN, _PLANE = 1 << 24, 1 << 12
"""What a plate in the way of a pin and a plane weigh against a plane that a pin reaches through: of these there are
fewer than 4096, 12 planes at most times 200 pins."""

_UNKNOWN = np.iinfo(np.int64).max


class Spindle(NamedTuple):
    """A pin by numbers: the plates that it joins, those that meet it, and the bases, below and above, that hold it."""

    plates: frozenset[int]
    meets: frozenset[int] = frozenset()
    below: bool = False
    above: bool = False


def stacked(
    count: int,
    apart: Sequence[tuple[int, int]],
    pins: Sequence[Spindle],
    meshes: Sequence[Sequence[int]] = (),
) -> tuple[int, ...]:
    """The arrangement with the least plates in the way of pins, of these with the fewest planes.

    Parameters
    ----------
    count : int
        Number of plates, at most :data:`MOST_PLATES` with each mesh as one.
    apart : sequence of pairs of int
        Plates that lie in different planes. Of one mesh there is none: its plates are in one plane by design.
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
    Input, coupler and output of a fourbar (0, 1, 2). Where nothing meets, two planes do; where the input meets the
    output's pivot (pin 1) it lies above it:

    >>> O2, O4 = Spindle(frozenset({0}), below=True), Spindle(frozenset({2}), below=True)
    >>> stacked(3, [(0, 1), (1, 2)], [O2, O4])
    (1, 2, 1)
    >>> stacked(3, [(0, 1), (1, 2)], [O2, O4._replace(meets=frozenset({0}))])
    (2, 3, 1)
    """
    own = list(range(count))
    for mesh in meshes:
        first = min(own[plate] for plate in mesh)
        merged = {own[plate] for plate in mesh}
        own = [first if plate in merged else plate for plate in own]
    kept = sorted(set(own))
    place = [kept.index(plate) for plate in own]
    if len(kept) > MOST_PLATES:
        raise DimensionError("plates", f"{MOST_PLATES} at most", len(kept))
    parted = np.zeros(len(kept), np.int64)
    for one, other in apart:
        if place[one] != place[other]:
            parted[place[one]] |= 1 << place[other]
            parted[place[other]] |= 1 << place[one]
    joined = np.array([_mask(place, pin.plates) for pin in pins], np.int64)
    # Of a mesh two plates may meet a pin: each counts.
    met = np.zeros((len(pins), len(kept)), np.int64)
    for n, pin in enumerate(pins):
        for plate in pin.meets:
            met[n, place[plate]] += 1
    held = np.array([[pin.below, pin.above] for pin in pins], np.bool_).reshape(-1, 2)
    last = _fewest(len(kept), parted, joined, held, met)
    layers: list[int] = []
    lying = (1 << len(kept)) - 1
    while lying:
        layers.append(int(last[lying]))
        lying &= ~layers[-1]
    plane_of = [next(n for n, layer in enumerate(reversed(layers), 1) if layer >> k & 1) for k in range(len(kept))]
    return tuple(plane_of[k] for k in place)


def reach(planes: Sequence[int], pin: Spindle) -> tuple[int, int]:
    """The lowest and the highest plane of a pin; 0 is the base, and one more than there are planes that above them."""
    own = [planes[plate] for plate in pin.plates]
    return 0 if pin.below else min(own), max(planes) + 1 if pin.above else max(own)


def in_the_way(planes: Sequence[int], pin: Spindle, plate: int) -> bool:
    """Whether a plate lies where a pin reaches."""
    low, high = reach(planes, pin)
    return low <= planes[plate] <= high


def _mask(place: Sequence[int], plates: frozenset[int]) -> int:
    mask = 0
    for plate in plates:
        mask |= 1 << place[plate]
    return mask


@njit(cache=True, nogil=True)
def _fewest(count: int, parted: Masks, joined: Masks, held: NDArray[np.bool_], met: Masks) -> Masks:
    """For each set of plates the highest plane of its best arrangement, as a set."""
    sets = 1 << count
    in_one_plane = np.ones(sets, np.bool_)
    for layer in range(1, sets):
        for plate in range(count):
            if layer >> plate & 1 and layer & parted[plate]:
                in_one_plane[layer] = False
                break
    least = np.full(sets, _UNKNOWN, np.int64)
    last = np.zeros(sets, np.int64)
    least[0] = 0
    for below in range(sets - 1):
        if least[below] == _UNKNOWN:
            continue
        rest = (sets - 1) & ~below
        layer = rest
        while layer > 0:
            if in_one_plane[layer]:
                cost = least[below] + _PLANE
                for pin in range(len(joined)):
                    begun = held[pin, 0] or (joined[pin] & (below | layer)) != 0
                    if begun and (held[pin, 1] or (joined[pin] & ~below) != 0):
                        cost += 1
                        for plate in range(count):
                            if layer >> plate & 1:
                                cost += _BROKEN * met[pin, plate]
                if cost < least[below | layer]:
                    least[below | layer] = cost
                    last[below | layer] = layer
            layer = (layer - 1) & rest
    return last
