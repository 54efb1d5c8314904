"""Enumeration of all arrangements of an engine's throws that fire evenly, equivalent ones only once.

Arrangements are equivalent if they differ by a rotation, by a mirror, or by counting from the other end.

Even firing puts the top dead centres on slots: n slots with one cylinder each, or, in a four-stroke engine with an even
number n of cylinders, n/2 slots with two each. A throw with cylinders of several banks occupies the slots of all of
them, so that banks can only share throws if the angles between them are whole numbers of slots. An arrangement is a
word: the slot of the first cylinder of each throw. Words are built one throw after the other, from the free slots.

For more than eight throws, each with one cylinder, words are counted by Burnside's lemma. No rotation alone, and no
mirror of more than two slots, leaves a word unchanged. Counting from the other end may leave it unchanged, if the
places p and N − 1 − p of every pair have the slots s and π(s), where π is an involution: a half turn, or a mirror. If π
fixes f slots and exchanges t pairs of slots of capacity c, there are (N/2)!/((c/2)!^f c!^t) 2^(tc) such words.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from synthesis.kinds.engine.arrangement import list_axes
from synthesis.kinds.engine.problem import EngineLayout, EngineProblem

MAX_LISTED_THROWS = 8
"""Number of throws up to which all arrangements are listed."""

MAX_SAMPLED = 5040
"""Maximum number of symmetric arrangements that are listed for more throws."""

SLOT_TOLERANCE = 1e-9
"""Permitted deviation of an angle between banks from a whole number of slots, in slots."""

ANGLE_DIGITS = 7
"""Decimals of a degree to which arrangements are compared."""


class Arrangements(NamedTuple):
    """The listed phases of throws in degrees, the number of all arrangements, and whether all are listed."""

    phases: list[tuple[float, ...]]
    total: int
    complete: bool


class Slots(NamedTuple):
    """Slots of even firing within a turn: their number, the cylinders per slot, and the degrees between slots."""

    number: int
    capacity: int
    step: float


def compute_slots(cylinders: int, strokes: int) -> Slots:
    """Return the slots of even firing."""
    if strokes == 4 and cylinders % 2 == 0:
        return Slots(cylinders // 2, 2, 720.0 / cylinders)
    return Slots(cylinders, 1, 360.0 / cylinders)


def list_even_arrangements(problem: EngineProblem, layout: EngineLayout) -> Arrangements:
    """List the arrangements of a layout's throws that fire evenly, the first throw at 0."""
    axes = list_axes(layout, problem.cylinders)
    slots = compute_slots(problem.cylinders, problem.stroke_cycle)
    # Bank angles relative to the throw's first cylinder, in slots.
    steps = [[(axis - row[0]) / slots.step for axis in row] for row in axes]
    if any(abs(step - round(step)) > SLOT_TOLERANCE for row in steps for step in row):
        return Arrangements([], 0, True)
    taken = [[round(step) for step in row] for row in steps]
    if len(axes) > MAX_LISTED_THROWS:
        words, count, complete = (
            _list_symmetric_words(problem, slots, len(axes)),
            _count_arrangements(layout, slots, len(axes)),
            False,
        )
    else:
        words, count, complete = _enumerate_words(taken, slots), 0, True
    origin = [axes[0][0] - row[0] for row in axes]
    phases = (tuple(slots.step * s + o for s, o in zip(word, origin, strict=True)) for word in words)
    listed = select_distinct(phases, layout, problem.cylinders)
    return Arrangements(listed, count or len(listed), complete)


def list_requested_arrangements(problem: EngineProblem, layout: EngineLayout, angles: Sequence[float]) -> Arrangements:
    """List all arrangements of given phases, even or not, with the first throw at the first phase."""
    throws = layout.count_throws(problem.cylinders) or 1
    first = angles[0]
    combinations = itertools.product(angles, repeat=throws - 1)
    listed = select_distinct(((first, *others) for others in combinations), layout, problem.cylinders)
    return Arrangements(listed, len(listed), True)


def select_distinct(
    phases: Iterator[tuple[float, ...]], layout: EngineLayout, cylinders: int
) -> list[tuple[float, ...]]:
    """Select one of each set of equivalent arrangements, the first throw at 0, in the order of their phases."""
    # Arrangements that a symmetry maps onto each other shake alike.
    turns = _list_symmetries(layout, cylinders)
    found: dict[tuple[float, ...], tuple[float, ...]] = {}
    for throws in phases:
        images = []
        for mirror, other in turns:
            image = throws[::-1] if other else throws
            exact = tuple(_reduce_angle(mirror * (phase - image[0])) for phase in image)
            images.append((tuple(round(phase, ANGLE_DIGITS) for phase in exact), exact))
        # The lexicographically smallest image represents the whole set.
        key, exact = min(images)
        found.setdefault(key, exact)
    return [found[key] for key in sorted(found)]


def _reduce_angle(angle: float) -> float:
    """Reduce an angle to 0 up to below 360; a full turn except for rounding becomes 0."""
    turned = angle % 360.0
    return 0.0 if min(turned, 360.0 - turned) < 0.5 * 10.0**-ANGLE_DIGITS else turned


def _list_symmetries(layout: EngineLayout, cylinders: int) -> list[tuple[float, bool]]:
    """List the symmetries of the cylinders: mirror (−1) or none (1), and whether to count from the other end.

    The engine may also be rotated by a half turn, which maps opposed cylinders to those of the other bank.
    """
    axes = list_axes(layout, cylinders)
    places = layout.positions or list(range(len(axes)))
    ends = [low + high for low, high in zip(places, reversed(places), strict=True)]

    def transform_axes(mirror: float, turn: float) -> list[list[float]]:
        return [sorted(round(_reduce_angle(mirror * axis + turn), ANGLE_DIGITS) for axis in row) for row in axes]

    own, found = transform_axes(1.0, 0.0), []
    for mirror, other in itertools.product((1.0, -1.0), (False, True)):
        images = [transform_axes(mirror, turn)[:: -1 if other else 1] for turn in (0.0, 180.0)]
        if own in images and (not other or max(ends) - min(ends) <= SLOT_TOLERANCE):
            found.append((mirror, other))
    return found


def _enumerate_words(taken: list[list[int]], slots: Slots) -> Iterator[tuple[int, ...]]:
    """Yield the words with first letter 0; ``taken`` are the slots that a throw occupies relative to its first one."""
    # Free places per slot.
    left = [slots.capacity] * slots.number
    word: list[int] = []

    def follow() -> Iterator[tuple[int, ...]]:
        if len(word) == len(taken):
            yield tuple(word)
            return
        for slot in range(slots.number if word else 1):
            used = [(slot + step) % slots.number for step in taken[len(word)]]
            for one in used:
                # One throw may use a slot twice: check only after all decrements.
                left[one] -= 1
            if all(left[one] >= 0 for one in used):
                word.append(slot)
                yield from follow()
                word.pop()
            for one in used:
                left[one] += 1

    yield from follow()


def _list_symmetric_words(problem: EngineProblem, slots: Slots, throws: int) -> Iterator[tuple[int, ...]]:
    """Yield palindromic words; if each slot is taken once, the other end reads them mirrored."""
    if slots.capacity == 2:
        for half in itertools.permutations(range(1, slots.number)):
            yield (0, *half, *reversed(half), 0)
        return
    # If there are too many to list, draw a random sample.
    rng = np.random.default_rng(problem.seed)
    for _ in range(MAX_SAMPLED):
        last = int(rng.integers(1, slots.number))
        pairs = [{slot, (last - slot) % slots.number} for slot in range(slots.number)]
        chosen = {min(pair): tuple(pair) for pair in pairs if len(pair) == 2}
        fixed = [slot for slot in range(slots.number) if (last - slot) % slots.number == slot]
        if 2 * len(chosen) != throws - throws % 2 or len(fixed) != throws % 2:
            continue
        others = [pair for low, pair in chosen.items() if low != 0]
        rng.shuffle(others)
        front = [0, *(int(pair[int(rng.integers(2))]) for pair in others)]
        yield (*front, *fixed, *((last - slot) % slots.number for slot in reversed(front)))


def _count_arrangements(layout: EngineLayout, slots: Slots, throws: int) -> int:
    """Count the arrangements of throws with one cylinder each, by Burnside's lemma; more than two slots."""
    m, c = slots.number, slots.capacity
    alike = _list_symmetries(layout, throws)
    # Every rotation of the shaft is combined with each of these. Only involutions leave a word unchanged.
    halves = {0, m // 2} if m % 2 == 0 else {0}
    turns = [[(s + r) % m for s in range(m)] for r in halves if (1.0, True) in alike]
    mirrors = [[(r - s) % m for s in range(m)] for r in range(m) if (-1.0, True) in alike]
    fixed = sum(_count_fixed_words(turn, c, throws) for turn in [*turns, *mirrors])
    return int(math.factorial(throws) // math.factorial(c) ** m + fixed) // (len(alike) * m)


def _count_fixed_words(image: list[int], capacity: int, throws: int) -> int:
    """Count the words that an involution of the slots, combined with counting from the other end, leaves unchanged."""
    kept = sum(image[slot] == slot for slot in range(len(image)))
    pairs = (len(image) - kept) // 2
    half = throws // 2
    if kept and capacity == 1:
        return math.factorial(half) * 2**pairs if throws % 2 and kept == 1 else 0
    if throws % 2:
        return 0
    return int(math.factorial(half) // math.factorial(capacity) ** pairs * 2 ** (capacity * pairs))
