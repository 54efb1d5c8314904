"""Reactions where constraints are redundant: what is unique is exact, and what is not is told as such."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from kinematics.dynamics import JointForce, Machine, Places, compute_balance, compute_reactions, make_constant
from kinematics.dynamics.friction import Friction
from kinematics.linkage.planar.drive import drive
from kinematics.linkage.planar.mechanism import Mechanism, Slide, TopologyError
from tests.campaign import further
from tests.kinematics.dynamics.machines import machine, moved
from tests.kinematics.mechanism_sampling import CHAIN, DYADIC, take
from tests.support.kinematics.redundant_constraints import CRANK, LINKS, geared, parallelogram


def with_rod() -> Mechanism:
    """Three parallel cranks whose coupler moves a slider by a rod: pins that redundancy does not reach."""
    joints = {"O2": 0j, "O4": 3.0, "O6": 5.0 + 1.3j, "A": CRANK, "B": 3.0 + CRANK, "C": 5.0 + 1.3j + CRANK}
    joints |= {"P": 4.0 + 2.0j + CRANK, "D": 9.0 + 2.5j}
    links = LINKS | {"coupler": ("A", "B", "C", "P"), "rod": ("P", "D")}
    return Mechanism(joints, links, "input", (Slide("D", "ground", np.asarray(9.0 + 2.5j), np.asarray(0.2)),))


@pytest.mark.parametrize("mechanism", [parallelogram(5.0 + 1.3j), parallelogram(5.0 + 0j), geared(1.0), with_rod()])
@pytest.mark.parametrize("minimum_norm", [False, True])
def test_drive_and_shaking_are_those_of_energy_and_momentum(mechanism: Mechanism, minimum_norm: bool) -> None:
    whole = machine(np.random.default_rng(3), mechanism)
    now, paced = moved(mechanism, reach=np.pi, count=36)
    found, check = compute_reactions(whole, now, minimum_norm=minimum_norm), compute_balance(whole, now, paced)
    assert found.solved.all()
    assert found.indeterminate.all()
    for values, others in (
        (found.drive, check.drive),
        (found.shaking_force, check.shaking_force),
        (found.shaking_moment, check.shaking_moment),
    ):
        assert np.abs(values - others).max() < 1e-10 * np.abs(others).max()
    assert np.isnan([force for on in found.joints.values() for force in on.values()]).any() == (
        not minimum_norm and not mechanism.gears
    )
    assert all(np.isnan(torque).all() != minimum_norm for torque in found.gears)


@pytest.mark.slow
@pytest.mark.parametrize("name", further(DYADIC | CHAIN, ["slider-crank", "geared fivebar", *list(CHAIN)[:1]]))
def test_link_that_is_there_twice_changes_no_motion_and_no_unique_force(name: str) -> None:
    """A copy without mass on the first two joints of a link, over a full turn or from toggle to toggle."""
    rng = np.random.default_rng([26, list(DYADIC | CHAIN).index(name)])
    designs = (DYADIC | CHAIN)[name](rng, 3)
    built = 0
    for n in range(3):
        once = take(designs, n)
        link = str(rng.choice([link for link in once.links if link != "ground"]))
        links = {**once.links, "copy": once.links[link][:2]}
        whole = machine(rng, once)
        try:
            twice = Mechanism(once.joints, links, once.input, once.slides, once.gears)
        except TopologyError:  # a long chain may jam before it has moved far enough for the copy to be proven harmless
            assert name in CHAIN
            continue
        built += 1
        at = np.asarray(once.reference_input) + np.linspace(-np.pi, np.pi, 25)
        plain, more = (drive(each, at, speed=2.0, acceleration=3.0, order=2) for each in (once, twice))
        np.testing.assert_array_equal(plain.smooth, more.smooth)
        found = compute_reactions(whole, Places(once, plain))
        doubled = compute_reactions(replace(whole, mechanism=twice), Places(twice, more))
        posed = found.solved & doubled.solved & (found.condition < 1e5)
        if not posed.any():
            continue
        assert doubled.indeterminate[posed].all()
        largest = max(np.abs(force[posed]).max() for on in found.joints.values() for force in on.values())
        for one, other in (
            (found.drive, doubled.drive),
            (found.shaking_force, doubled.shaking_force),
            (found.shaking_moment, doubled.shaking_moment),
        ):
            assert np.abs(one - other)[posed].max() <= 1e-8 * np.abs(one[posed]).max()
        for joint, on in found.joints.items():
            for of, force in on.items():
                there = posed & np.isfinite(doubled.joints[joint][of])
                assert np.abs(force - doubled.joints[joint][of])[there].max(initial=0.0) <= 1e-9 * largest
    assert built >= 2


def test_forces_that_redundancy_does_not_reach_stay() -> None:
    """Those at a rod are the same as without the third crank."""
    mechanism = with_rod()
    free = Mechanism(
        {joint: z for joint, z in mechanism.joints.items() if joint != "O6"},
        {link: tuple(j for j in listed if j != "O6") for link, listed in mechanism.links.items() if link != "third"},
        "input",
        mechanism.slides,
    )
    whole = machine(np.random.default_rng(4), free)
    more = replace(whole, mechanism=mechanism)
    found, without = (compute_reactions(each, moved(each.mechanism, reach=0.5)[0]) for each in (more, whole))
    for joint, on in found.joints.items():
        for link, force in on.items():
            if joint in ("P", "D"):
                np.testing.assert_allclose(force, without.joints[joint][link], rtol=1e-9)
            else:
                assert np.isnan(force).all()
    np.testing.assert_allclose(found.slides[0], without.slides[0], rtol=1e-9)
    np.testing.assert_allclose(found.drive, without.drive, rtol=1e-9)


def test_least_forces_share_a_load_evenly() -> None:
    """Three upright cranks in line under a bar that is loaded in the middle: each carries a third."""
    mechanism = Mechanism({"O2": 0j, "O4": 2.0, "O6": 4.0, "A": 1j, "B": 2.0 + 1j, "C": 4.0 + 1j}, LINKS, "input")
    loaded = Machine(mechanism, loads=(JointForce("B", make_constant(-9j)),))
    found = compute_reactions(
        loaded, Places(mechanism, drive(mechanism, [np.pi / 2.0], speed=0.0, order=2)), minimum_norm=True
    )
    for pivot, link in (("O2", "input"), ("O4", "rocker"), ("O6", "third")):
        assert found.joints[pivot][link][0] == pytest.approx(3j, abs=1e-12)
    assert found.drive[0] == pytest.approx(0.0, abs=1e-12)
    assert found.indeterminate.all()


def test_dead_centre_has_no_forces() -> None:
    mechanism = parallelogram(5.0 + 0j)
    now = Places(mechanism, drive(mechanism, [0.0, 1e-3], order=2))
    found = compute_reactions(machine(np.random.default_rng(5), mechanism), now)
    assert found.solved.tolist() == [False, True]
    assert found.indeterminate.tolist() == [False, True]
    assert np.isnan(found.drive[0])


def test_friction_is_not_determined() -> None:
    whole = replace(machine(np.random.default_rng(6), parallelogram(5.0 + 1j)), friction=Friction({"A": (0.1, 0.05)}))
    with pytest.raises(TopologyError, match="friction"):
        compute_reactions(whole, moved(whole.mechanism)[0])
