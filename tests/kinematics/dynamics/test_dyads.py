"""Forces of linkages of dyads by elimination against the general equations, and against the same in plain numpy."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from kinematics.dynamics import JointForce, Machine, Places, PointForce, Torque, compute_reactions, make_constant
from kinematics.dynamics.dyads import NoDyadsError, compute_dyad_forces, is_built_of_dyads
from kinematics.dynamics.friction import Friction
from kinematics.linkage.planar.drive import drive
from kinematics.linkage.planar.mechanism import GROUND, Mechanism
from tests.campaign import further
from tests.kinematics.dynamics.dyad_twin import Twin
from tests.kinematics.dynamics.machines import GRAVITY, Rng, machine, masses
from tests.kinematics.mechanism_sampling import CHAIN, CLASS_THREE, DYADIC
from tests.support.kinematics.redundant_constraints import parallelogram

AGREES = 1e-9

WELL_POSED = 1e4
"""Condition number up to which both kinematics agree so well: near a toggle each has rounding of its own."""

MAKES = DYADIC | CHAIN
ALWAYS = [*DYADIC, *list(CHAIN)[:7]]


def loaded(rng: Rng, mechanism: Mechanism) -> Machine:
    """A machine of masses on links and pins, and of loads that know the input alone."""
    moving = [link for link in mechanism.links if link != GROUND]
    bodies, pin_masses = masses(rng, mechanism)
    first, second, third = (str(link) for link in rng.choice(moving, size=3))

    def place() -> np.ndarray:
        return np.asarray(rng.normal(size=mechanism.shape) + 1j * rng.normal(size=mechanism.shape))

    loads = (
        PointForce(first, place(), make_constant(complex(4.0, -7.0)), True),
        PointForce(second, place(), make_constant(complex(-5.0, 2.0))),
        JointForce(str(rng.choice(list(mechanism.joints))), lambda input: 3.0 * np.exp(1j * input[0])),
        Torque(third, make_constant(2.0)),
    )
    return Machine(mechanism, bodies, pin_masses, GRAVITY, loads, complex(*rng.normal(size=2)))


@pytest.mark.parametrize("name", further(MAKES, ALWAYS))
def test_forces_are_those_of_the_general_equations(name: str) -> None:
    rng = np.random.default_rng([26, list(MAKES).index(name)])
    whole = replace(loaded(rng, MAKES[name](rng, 40)), scale=1.0)
    mechanism = whole.mechanism
    at = np.asarray(mechanism.reference_input)[:, None] + np.linspace(-0.3, 0.3, 5)
    found = compute_dyad_forces(whole, at, 2.0, 3.0)
    general = compute_reactions(whole, Places(mechanism, drive(mechanism, at, speed=2.0, acceleration=3.0, order=2)))
    np.testing.assert_array_equal(np.isfinite(found.drive), general.solved)
    posed = general.solved & (general.condition < WELL_POSED)
    assert posed.any(axis=-1).sum() > 10
    pin = np.max([np.abs(force) for on in general.joints.values() for force in on.values()], axis=0)
    scale = np.where(posed, pin, 0.0).max(axis=-1)
    for one, other in (
        (found.drive, general.drive),
        (found.pin, pin),
        (found.shaking_force, general.shaking_force),
        (found.shaking_moment, general.shaking_moment),
    ):
        peak = np.where(posed, np.abs(other), 0.0).max(axis=-1)
        apart = np.where(posed, np.abs(one - other), 0.0).max(axis=-1)
        assert (apart <= AGREES * np.maximum(peak, 1e-3 * scale)).all()


@pytest.mark.parametrize(
    "name", ["slider-crank driven by its slider", "geared fivebar", "crank-shaper", "dyad chain 6"]
)
def test_plain_numpy_gives_the_same(name: str) -> None:
    rng = np.random.default_rng([27, list(MAKES).index(name)])
    whole = loaded(rng, MAKES[name](rng, 20))
    at = np.asarray(whole.mechanism.reference_input)[:, None] + np.linspace(-0.1, 0.1, 3)
    found = compute_dyad_forces(whole, at, -1.5)
    with np.errstate(invalid="ignore"):
        twin = Twin(whole, at, -1.5)
    for one, other in (
        (found.drive, twin.drive),
        (found.pin, twin.largest),
        (found.shaking_force, twin.shaking_force),
        (found.shaking_moment, twin.shaking_moment),
    ):
        known = np.isfinite(one)
        assert known.any()
        np.testing.assert_allclose(one[known], other[known], rtol=1e-6, atol=1e-9 * np.abs(other[known]).max())


def test_lengths_in_another_unit_and_a_far_origin() -> None:
    """A thousandth of the lengths at a scale of a thousand, and all of it far away, is the same machine."""
    rng = np.random.default_rng(28)
    whole = loaded(rng, DYADIC["dwell_slot"](rng, 5))
    mechanism, far = whole.mechanism, 1e4 + 2e4j
    shrunk = Mechanism(
        {joint: 1e-3 * (z + far) for joint, z in mechanism.joints.items()},
        mechanism.links,
        mechanism.input,
        tuple(s._replace(point=1e-3 * (s.point + far)) for s in mechanism.slides),
    )
    moved = replace(
        whole,
        mechanism=shrunk,
        scale=1e3,
        bodies={link: part._replace(cg=part.cg + far) for link, part in whole.bodies.items()},
        loads=tuple(
            replace(load, place=load.place + far) if isinstance(load, PointForce) else load for load in whole.loads
        ),
        about=whole.about + far,
    )
    at = np.asarray(mechanism.reference_input)[:, None]
    for one, other in zip(compute_dyad_forces(moved, at, 2.0), compute_dyad_forces(whole, at, 2.0), strict=True):
        np.testing.assert_allclose(one, other, rtol=1e-6)


def test_others_are_left_to_the_general_equations() -> None:
    rng = np.random.default_rng(29)
    fourbar = DYADIC["fourbar"](rng, 2)
    others = [
        machine(rng, fourbar),  # springs, and resistance against motion
        Machine(next(iter(CLASS_THREE.values()))(rng, 2)),
        Machine(parallelogram(5.0 + 1j)),
        Machine(fourbar, friction=Friction({"A": (0.1, 0.1)})),
    ]
    for other in others:
        assert not is_built_of_dyads(other)
        with pytest.raises(NoDyadsError):
            compute_dyad_forces(other, [0.3])


def test_toggle_and_open_positions_have_no_forces() -> None:
    links = {"ground": ("O2", "O4"), "input": ("O2", "A"), "coupler": ("A", "B"), "output": ("O4", "B")}
    folded = Mechanism({"O2": 0.0, "A": 1.0, "B": 3.0 + 1.0j, "O4": 4.0}, links, "input")
    found = compute_dyad_forces(Machine(folded, gravity=-9.81j, pin_masses={"B": np.asarray(1.0)}), [0.0, np.pi])
    assert np.isfinite(found.drive).tolist() == [True, False]
