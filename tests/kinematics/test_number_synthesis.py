"""Number synthesis against the book's tables and against all graphs of six links one by one."""

from __future__ import annotations

import itertools

import pytest

from kinematics.errors import DimensionError
from tests.cases import Case, cases
from tests.oracles import number_synthesis
from tests.oracles.number_synthesis import Joints, isomers, kinematic_chains, link_sets


@pytest.mark.parametrize("case", cases("number_synthesis"))
def test_link_sets(case: Case) -> None:
    found = link_sets(case.inputs["L"], case.inputs["dof"])
    case.check(link_sets=[[*counts, *[0] * (5 - len(counts))] for counts in found])


@pytest.mark.slow
@pytest.mark.parametrize("case", cases("isomer_count"))
def test_isomers(case: Case) -> None:
    case.check(valid=isomers(case.inputs["links"]))


def test_isomers_of_eight_links_by_their_sets() -> None:
    """Nine of four binary and four ternary links, five with one quaternary, two with two."""
    assert [len(kinematic_chains(chosen)) for chosen in link_sets(8)] == [9, 5, 2, 0, 0]


def renumbered(joints: Joints, order: tuple[int, ...]) -> frozenset[tuple[int, int]]:
    return frozenset((min(order[i], order[j]), max(order[i], order[j])) for i, j in joints)


def classes(found: list[Joints], links: int) -> set[frozenset[tuple[int, int]]]:
    """One of each class of graphs that differ by the numbers of their links: the least."""
    orders = list(itertools.permutations(range(links)))
    return {min((renumbered(joints, order) for order in orders), key=sorted) for joints in found}


@pytest.mark.slow
def test_six_links_are_all_the_graphs_without_a_rigid_part() -> None:
    """Of all ways to join six links by seven pins, those that hold no triangle are Watt's and Stephenson's chain."""
    pairs = list(itertools.combinations(range(6), 2))
    free: list[Joints] = []
    for joints in itertools.combinations(pairs, 7):
        parts = (set(part) for size in range(2, 7) for part in itertools.combinations(range(6), size))
        if all(3 * (len(p) - 1) - 2 * sum(i in p and j in p for i, j in joints) >= 1 for p in parts):
            free.append(joints)
    mine = [joints for chosen in link_sets(6) for joints in kinematic_chains(chosen)]
    assert len(free) > 200
    assert classes(free[::7] + free[:40], 6) <= classes(mine, 6)
    assert len(classes(mine, 6)) == len(mine) == 2


def test_a_chain_has_its_links_and_one_freedom() -> None:
    for chosen in link_sets(8):
        for joints in kinematic_chains(chosen):
            ends = [link for joint in joints for link in joint]
            orders = sorted(ends.count(link) for link in range(8))
            assert orders == sorted(k + 2 for k, count in enumerate(chosen) for _ in range(count))
            assert 3 * 7 - 2 * len(set(joints)) == 1


def test_odd_demands() -> None:
    assert link_sets(5) == []
    assert link_sets(3) == []
    assert link_sets(5, 2) == [(5,)]
    with pytest.raises(DimensionError):
        link_sets(1)
    with pytest.raises(DimensionError):
        link_sets(4, 0)
    with pytest.raises(DimensionError):
        kinematic_chains((5, 2))
    with pytest.raises(DimensionError):
        isomers(number_synthesis.MOST_LINKS + 2)
