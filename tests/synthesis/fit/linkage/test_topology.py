"""Topologies: their number, their links, and the names of their joints."""

from __future__ import annotations

import pytest

from synthesis.fit.linkage.topology import DYAD, build_topology, list_chains
from tests.support.synthesis.random_linkages import SIXBAR_FORMS


@pytest.mark.parametrize(("dyads", "count"), [(1, 1), (2, 8), (3, 88)])
def test_number_of_chains(dyads: int, count: int) -> None:
    chains = list_chains(dyads)
    assert len(chains) == count
    assert len({chain.nodes.tobytes() for chain in chains}) == count


@pytest.mark.parametrize("dyads", [1, 2, 3])
def test_mobility_is_one(dyads: int) -> None:
    """Gruebler's count 3 (links − 1) − 2 joints; a pin of k links counts as k − 1 joints."""
    for chain in list_chains(dyads):
        pins = [pin for listed in chain.links.values() for pin in listed]
        joints = sum(pins.count(pin) - 1 for pin in set(pins))
        assert 3 * (len(chain.links) - 1) - 2 * joints == 1


def test_sixbars_have_the_joints_of_answers() -> None:
    for kind, forms in SIXBAR_FORMS.items():
        for form in forms:
            assert {"O2", "O4", "A", "B", "C", "P"} <= set(form.pin_names.values())
            assert ("O6" in form.joints) == (kind == "stephenson_3")
            assert set(form.pin_names) >= {pin for pins in form.links.values() for pin in pins}


def test_only_a_stephenson_2_transmits_by_a_triad() -> None:
    for kind, forms in SIXBAR_FORMS.items():
        assert all(bool(form.triad) == (kind == "stephenson_2") for form in forms)
        assert all((form.transmitting.sum() == 0) == (kind == "stephenson_2") for form in forms)


def test_links_of_a_watt_1() -> None:
    topology = build_topology(((1, 0), (2, 3)))
    names = {link: [topology.pin_names[pin] for pin in pins] for link, pins in topology.links.items()}
    assert names == {
        "ground": ["O2", "O4"],
        "input": ["O2", "A"],
        "coupler": ["A", "B", "C"],
        "output": ["O4", "B", "D"],
        "link_5": ["C", "E"],
        "link_6": ["D", "E"],
    }
    assert topology.body == "link_5"
    assert (topology.nodes[:, 0] == DYAD).sum() == 2
