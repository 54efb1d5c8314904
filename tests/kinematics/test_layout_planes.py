"""The fewest planes against every arrangement that there is."""

from __future__ import annotations

from itertools import combinations, product

import numpy as np
import pytest

from kinematics.errors import DimensionError
from kinematics.linkage.layout.planes import MAX_PLATES, Spindle, find_reach, is_in_the_way, stack_plates
from tests.support.loops import check_each

Pairs = list[tuple[int, int]]


def filled(planes: tuple[int, ...], pin: Spindle) -> set[int]:
    """The planes of a pin, listed one by one; 0 and the one above all are bases."""
    own = [planes[plate] for plate in pin.plates]
    own += [0] if pin.below else []
    own += [max(planes) + 1] if pin.above else []
    return set(range(min(own), max(own) + 1))


def merit(planes: tuple[int, ...], pins: list[Spindle]) -> tuple[int, int]:
    """Plates in the way of pins, and planes."""
    return sum(planes[plate] in filled(planes, pin) for pin in pins for plate in pin.meets), max(planes)


def arrangements(count: int, apart: Pairs, meshes: list[list[int]]) -> list[tuple[int, ...]]:
    """All of them, without empty planes."""
    return [
        planes
        for planes in product(range(1, count + 1), repeat=count)
        if set(planes) == set(range(1, max(planes) + 1))
        and all(planes[one] != planes[other] for one, other in apart)
        and all(len({planes[plate] for plate in mesh}) == 1 for mesh in meshes)
    ]


def drawn(rng: np.random.Generator) -> tuple[int, Pairs, list[Spindle], list[list[int]]]:
    """Plates, pins that join some of them and meet others, and now and then a mesh."""
    count = int(rng.integers(2, 6))
    meshes = [sorted(rng.permutation(count)[:2].tolist())] if rng.random() < 0.3 else []
    pins = []
    for _ in range(int(rng.integers(1, 6))):
        order = rng.permutation(count).tolist()
        joined = int(rng.integers(1, min(count, 3) + 1))
        met = [plate for plate in order[joined:] if rng.random() < 0.5]
        below, above = (bool(flag) for flag in rng.random(2) < (0.5, 0.2))
        pins.append(Spindle(frozenset(order[:joined]), frozenset(met), below, above))
    joined_pairs = {pair for pin in pins for pair in combinations(sorted(pin.plates), 2)}
    crossing = {pair for pair in combinations(range(count), 2) if rng.random() < 0.3}
    return count, sorted((joined_pairs | crossing) - {tuple(mesh) for mesh in meshes}), pins, meshes


def check_none_is_better(seed: int) -> None:
    count, apart, pins, meshes = drawn(np.random.default_rng(seed))
    planes = stack_plates(count, apart, pins, meshes)
    every = arrangements(count, apart, meshes)
    assert planes in every
    best = min(merit(other, pins) for other in every)
    assert merit(planes, pins) == best

    def length(other: tuple[int, ...]) -> int:
        return sum(len(filled(other, pin) - {0, max(other) + 1}) for pin in pins)

    assert length(planes) == min(length(other) for other in every if merit(other, pins) == best)


@pytest.mark.slow
def test_none_is_better() -> None:
    check_each(range(300), check_none_is_better)


def check_what_a_pin_reaches(seed: int) -> None:
    count, apart, pins, meshes = drawn(np.random.default_rng(seed))
    planes = stack_plates(count, apart, pins, meshes)
    for pin in pins:
        assert set(range(find_reach(planes, pin)[0], find_reach(planes, pin)[1] + 1)) == filled(planes, pin)
        for plate in range(count):
            assert is_in_the_way(planes, pin, plate) == (planes[plate] in filled(planes, pin))


def test_what_a_pin_reaches() -> None:
    check_each(range(100), check_what_a_pin_reaches)


def test_a_double_crank_on_one_base_is_never_free_but_on_two_bases_it_is() -> None:
    """Either crank sweeps over the other's pivot: a drag link has its shafts on two sides."""
    apart = [(0, 1), (1, 2), (0, 2)]
    cranks = [Spindle(frozenset({0}), frozenset({2}), below=True), Spindle(frozenset({2}), frozenset({0}), below=True)]
    assert merit(stack_plates(3, apart, cranks), cranks) == (1, 3)
    cranks[1] = cranks[1]._replace(below=False, above=True)
    assert merit(stack_plates(3, apart, cranks), cranks) == (0, 3)


def test_as_many_plates_as_are_promised() -> None:
    apart = [(n, n + 1) for n in range(MAX_PLATES - 1)]
    assert max(stack_plates(MAX_PLATES, apart, [])) == 2
    with pytest.raises(DimensionError, match=f"at most {MAX_PLATES}"):
        stack_plates(MAX_PLATES + 1, apart, [])


def test_a_mesh_counts_as_one() -> None:
    planes = stack_plates(MAX_PLATES + 1, [(0, 1)], [], [[2, 3]])
    assert planes[2] == planes[3]
    assert planes[0] != planes[1]
