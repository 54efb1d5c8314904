"""Friction: every link is in equilibrium with it, it is what Coulomb says, and energy knows what it takes."""

from __future__ import annotations

import numpy as np
import pytest

from kinematics.dynamics import compute_balance, compute_reactions
from kinematics.linkage.planar.mechanism import GROUND
from tests.kinematics.dynamics.machines import machine, moved, rubbing
from tests.kinematics.mechanism_sampling import EVERY

TYPES = [
    "fourbar",
    "slider-crank",
    "slider-crank driven by its slider",
    "inverted slider-crank",
    "geared fivebar",
    "Peaucellier",
]

CLOSE = 1e-9
"""Of the largest force: what equilibrium may miss."""


def cross(arm: np.ndarray, force: np.ndarray) -> np.ndarray:
    return (np.conj(arm) * force).imag


@pytest.mark.parametrize("name", TYPES)
def test_every_link_is_in_equilibrium_with_friction(name: str) -> None:
    """Newton and Euler, link by link, about the origin, from what is reported alone."""
    rng = np.random.default_rng(31)
    mechanism = EVERY[name](rng, 6)
    whole = rubbing(rng, machine(rng, mechanism))
    now, paced = moved(mechanism)
    found = compute_reactions(whole, now)
    known = found.solved & (found.condition < 1e4)
    assert known.any()
    forces = {link: np.zeros(now.smooth.shape, complex) for link in mechanism.links}
    moments = {link: np.zeros(now.smooth.shape) for link in mechanism.links}

    def add(link: str, at: np.ndarray, force: np.ndarray, couple: np.ndarray | float = 0.0) -> None:
        forces[link] = forces[link] + force
        moments[link] = moments[link] + cross(at, force) + couple

    for joint, on in found.joints.items():
        for link, force in on.items():
            add(link, now.joints[joint][0], force)
    lines = [found.slides[n] * 1j * now.direction(n)[0] for n in range(len(mechanism.slides))]
    for contact, friction in zip(found.rubbing.contacts, found.rubbing.frictions, strict=True):
        if contact.slide >= 0:
            n = contact.slide
            lines[n] = lines[n] + friction * now.direction(n)[0]
            speed, normal = now.slides[n][1], np.abs(found.slides[n])
            np.testing.assert_allclose(
                friction[known], (-np.sign(speed) * whole.friction.slides[n] * normal)[known], rtol=1e-9, atol=1e-12
            )
        else:
            add(contact.link, 0.0 * friction, 0.0 * friction, friction)
            add(contact.against, 0.0 * friction, 0.0 * friction, -friction)
            assert (friction * (now.spins[contact.link][1] - now.spins[contact.against][1]) <= 0.0)[known].all()
    for n, slide in enumerate(mechanism.slides):
        add(slide.link, now.joints[slide.joint][0], -lines[n])
    for gear, torque in zip(mechanism.gears, found.gears, strict=True):
        add(gear.second, 0.0 * torque, 0.0 * torque, torque)
        add(gear.first, 0.0 * torque, 0.0 * torque, -gear.ratio * torque)
    if not mechanism.has_slide_input:
        add(mechanism.input, 0.0 * found.drive, 0.0 * found.drive, found.drive)
    for load in whole.loads:
        for effort in load.efforts(now):
            if not effort.joint:
                add(effort.link, effort.at, effort.force, effort.couple)
    scale = max(np.abs(f[known]).max() for on in found.joints.values() for f in on.values())
    for link in mechanism.links:
        if link == GROUND:
            continue
        momentum, angular = 0.0, 0.0
        if link in whole.bodies:
            part = whole.bodies[link]
            at, _, acceleration = now.point(link, part.cg)
            momentum = part.mass[:, None] * (acceleration - whole.gravity)
            angular = cross(at, momentum) + part.inertia[:, None] * now.spins[link][2]
        assert np.abs((forces[link] - momentum)[known]).max() < CLOSE * scale
        assert np.abs((moments[link] - angular)[known]).max() < 100.0 * CLOSE * scale
    check = compute_balance(whole, now, paced, found.rubbing)
    assert np.abs((found.drive - check.drive)[known]).max() < CLOSE * check.scale[known].max()
    assert (found.rubbing.work(now)[known] < 0.0).all()


def test_friction_grows_from_none() -> None:
    """With little friction the drive grows by what friction takes from the frictionless forces."""
    rng = np.random.default_rng(32)
    mechanism = EVERY["slider-crank"](rng, 5)
    whole = machine(rng, mechanism)
    now, _ = moved(mechanism)
    free = compute_reactions(whole, now)
    little = rubbing(rng, whole)
    for joint, (_, radius) in list(little.friction.pins.items()):
        little.friction.pins[joint] = (1e-6, radius)
    for slide in little.friction.slides:
        little.friction.slides[slide] = 1e-6
    found = compute_reactions(little, now)
    known = free.solved & (free.condition < 1e3)
    grown = (found.drive - free.drive)[known] * now.input[1][known]
    np.testing.assert_allclose(grown, -found.rubbing.work(now)[known], rtol=1e-3, atol=1e-9)
