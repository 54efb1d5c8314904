"""Reactions against balances that know none, against equilibrium link by link, and against simple machines by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest

from kinematics.dynamics import Machine, Places, compute_reactions, make_body
from kinematics.dynamics.loads import JointForce, make_constant
from kinematics.linkage.planar import catalogue
from kinematics.linkage.planar.drive import drive
from kinematics.linkage.planar.mechanism import GROUND, Mechanism
from tests.campaign import sampled
from tests.kinematics.dynamics.machines import differences, machine, moved
from tests.kinematics.mechanism_sampling import CHAIN, EVERY

AGREES = 1e-9
"""Of the peak: what the two routes may differ by."""


@pytest.mark.parametrize("name", EVERY)
def test_reactions_agree_with_energy_and_momentum(name: str) -> None:
    rng = np.random.default_rng([20, 0, list(EVERY).index(name)])
    told = differences(rng, EVERY[name](rng, 3)).told
    assert np.nanmax(told) <= AGREES


@pytest.mark.campaign
@pytest.mark.timeout(600)
@pytest.mark.parametrize("name", EVERY | CHAIN)
def test_reactions_agree_with_energy_and_momentum_of_many(name: str) -> None:
    rng = np.random.default_rng([20, 1, list(EVERY | CHAIN).index(name)])
    count = sampled(10_000) // len(EVERY | CHAIN) + 1
    told = differences(rng, (EVERY | CHAIN)[name](rng, count), math.pi, 37).told
    assert np.isfinite(told).all(axis=0).mean() > 0.9
    assert np.nanmax(told) <= AGREES


@pytest.mark.parametrize("name", list(CHAIN)[:7])
def test_reactions_agree_with_energy_and_momentum_in_chains_of_dyads(name: str) -> None:
    rng = np.random.default_rng([20, 2, list(CHAIN).index(name)])
    assert np.nanmax(differences(rng, CHAIN[name](rng, 10)).told) <= AGREES


@pytest.mark.parametrize("name", ["slider-crank", "geared fivebar", "watt_2 driven by its input", "Peaucellier"])
def test_forces_at_a_pin_add_up_and_every_link_is_in_equilibrium(name: str) -> None:
    rng = np.random.default_rng(5)
    mechanism = EVERY[name](rng, 4)
    whole = machine(rng, mechanism)
    now, _ = moved(mechanism)
    found = compute_reactions(whole, now)
    for joint, on in found.joints.items():
        given = sum(
            (e.force for load in whole.loads for e in load.efforts(now) if e.joint == joint),
            np.zeros(now.smooth.shape, complex),
        )
        if joint in whole.pin_masses:
            given = given + whole.pin_masses[joint][:, None] * (whole.gravity - now.joints[joint][2])
        for n, slide in enumerate(mechanism.slides):
            if slide.joint == joint:
                given = given + found.slides[n] * 1j * now.direction(n)[0]
        missing = given - sum(on.values())
        assert np.abs(missing[found.solved]).max(initial=0.0) < 1e-9 * np.abs(found.drive[found.solved]).max()


def test_physical_pendulum() -> None:
    """A bar on a pivot: T = (I + m r²) α + m g r cos θ, and the pivot carries m (a − g)."""
    crank = Mechanism({"O": 0.0, "P": 2.0}, {GROUND: ("O",), "input": ("O", "P")}, "input")
    m, r, inertia, g, speed, alpha = 3.0, 0.7, 0.4, 9.81, 2.0, -5.0
    at = np.linspace(0.0, 6.0, 13)
    pendulum = Machine(crank, {"input": make_body(m, r + 0j, inertia)}, gravity=-1j * g)
    found = compute_reactions(pendulum, Places(crank, drive(crank, at, speed=speed, acceleration=alpha, order=2)))
    np.testing.assert_allclose(found.drive, (inertia + m * r * r) * alpha + m * g * r * np.cos(at), rtol=1e-13)
    acceleration = r * np.exp(1j * at) * (1j * alpha - speed**2)
    np.testing.assert_allclose(found.joints["O"]["input"], m * (acceleration + 1j * g), rtol=1e-12)


def test_slider_crank_by_the_closed_form() -> None:
    """Massless rod: a force F on the piston gives the torque F x tan φ, its inertia likewise (Norton 13.6, 13.15)."""
    r, length, force, mass, speed = 1.0, 3.2, -250.0, 1.3, 20.0
    theta = np.radians(np.arange(1.0, 360.0, 7.0))
    engine = catalogue.make_slider_crank(0j, 0j, 0.0, r, length, 0.5, 1)
    piston = Machine(engine, {}, {"B": np.asarray(mass)}, loads=(JointForce("B", make_constant(force)),))
    found = compute_reactions(piston, Places(engine, drive(engine, theta, speed=speed, order=2)))
    tangent = r * np.sin(theta) / np.sqrt(length**2 - (r * np.sin(theta)) ** 2)
    x = r * np.cos(theta) + np.sqrt(length**2 - (r * np.sin(theta)) ** 2)
    root = np.sqrt(length**2 - (r * np.sin(theta)) ** 2)
    slope = -r * np.cos(theta) - r**2 * np.cos(2 * theta) / root - r**4 * np.sin(2 * theta) ** 2 / (4.0 * root**3)
    along = force - mass * slope * speed**2
    np.testing.assert_allclose(found.drive, along * tangent * x, rtol=1e-11, atol=1e-9 * np.abs(found.drive).max())
    np.testing.assert_allclose(np.abs(found.slides[0]), np.abs(along * tangent), rtol=1e-10, atol=1e-8)


def test_drive_is_lagranges_from_the_energy_alone() -> None:
    """d/dt(∂L/∂q̇) − ∂L/∂q with T and V from positions, differentiated numerically."""
    rng = np.random.default_rng(8)
    mechanism = EVERY["fourbar"](rng, 40)
    whole = machine(rng, mechanism)
    whole = Machine(mechanism, whole.bodies, whole.pin_masses, whole.gravity)
    q1, q2, h = 1.3, -2.0, 1e-3
    at = np.asarray(mechanism.reference_input)[:, None] + h * np.arange(-4, 5)
    motion = drive(mechanism, at, order=2)
    places = Places(mechanism, motion)

    def derivative(values: np.ndarray) -> np.ndarray:
        """By central differences of the fourth order, on the inner positions."""
        return (values[..., :-4] - 8.0 * values[..., 1:-3] + 8.0 * values[..., 3:-1] - values[..., 4:]) / (12.0 * h)

    inertia, potential = np.zeros((40, 5)), np.zeros((40, 9))
    parts = [(b.mass, places.point(link, b.cg)[0]) for link, b in whole.bodies.items()]
    parts += [(mass, places.joints[joint][0]) for joint, mass in whole.pin_masses.items()]
    for mass, place in parts:
        inertia += mass[:, None] * np.abs(derivative(place)) ** 2
        potential -= mass[:, None] * (np.conj(whole.gravity) * place).real
    for link, b in whole.bodies.items():
        inertia += b.inertia[:, None] * derivative(places.spins[link][0]) ** 2
    expected = inertia[:, 2] * q2 + 0.5 * derivative(inertia)[:, 0] * q1**2 + derivative(potential)[:, 2]
    now = Places(mechanism, drive(mechanism, at[:, 4:5], speed=q1, acceleration=q2, order=2))
    found = compute_reactions(whole, now)
    posed = motion.smooth.all(axis=-1) & (found.condition[:, 0] < 300.0)
    assert posed.sum() > 15
    np.testing.assert_allclose(
        found.drive[posed, 0], expected[posed], rtol=2e-5, atol=2e-5 * np.abs(expected[posed]).max()
    )


def test_forces_go_with_the_square_of_the_speed_and_with_the_mass() -> None:
    rng = np.random.default_rng(9)
    mechanism = EVERY["watt_1 driven by its input"](rng, 3)
    whole = machine(rng, mechanism)
    free = Machine(mechanism, whole.bodies, whole.pin_masses, about=whole.about)
    heavy = Machine(
        mechanism,
        {link: b._replace(mass=3.0 * b.mass, inertia=3.0 * b.inertia) for link, b in whole.bodies.items()},
        {joint: 3.0 * mass for joint, mass in whole.pin_masses.items()},
        about=whole.about,
    )
    once, twice = (compute_reactions(free, moved(mechanism, speed=s, acceleration=s * s)[0]) for s in (1.0, 2.0))
    thrice = compute_reactions(heavy, moved(mechanism, speed=1.0, acceleration=1.0)[0])
    for values, others, factor in (
        (twice.drive, once.drive, 4.0),
        (twice.shaking_moment, once.shaking_moment, 4.0),
        (thrice.drive, once.drive, 3.0),
    ):
        np.testing.assert_allclose(values, factor * others, rtol=1e-9)


def test_dead_centre_has_no_forces() -> None:
    """A slider cannot push a crank through its dead centre: nothing there is a number."""
    engine = catalogue.make_slider_crank(0j, 0j, 0.0, 1.0, 3.0, 0.5, 1)
    driven = Mechanism(engine.joints, engine.links, "B", engine.slides)
    pushed = Machine(driven, {}, {}, loads=(JointForce("A", make_constant(1 + 1j)),))
    found = compute_reactions(pushed, Places(driven, drive(driven, [4.0 - 1e-16, 3.5], order=2)))
    assert found.solved.tolist() == [False, True]
    assert math.isnan(found.drive[0])
    assert math.isnan(found.joints["A"]["coupler" if "coupler" in driven.links else driven.input].real[0])
