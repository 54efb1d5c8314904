"""What must not matter to forces: where the frame stands, which way round it is seen, and which way it is run."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from kinematics.dynamics import (
    Body,
    JointForce,
    Machine,
    Places,
    PointForce,
    Reactions,
    Torque,
    compute_reactions,
    make_constant,
)
from kinematics.dynamics.bodies import join_bodies
from kinematics.linkage.planar.drive import drive
from kinematics.linkage.planar.mechanism import GROUND, Mechanism
from tests.kinematics.dynamics.machines import GRAVITY, Rng, masses
from tests.kinematics.mechanism_sampling import CHAIN, EVERY

NAMES = [
    *("slider-crank", "slider-crank driven by its slider", "geared fivebar", "crank-shaper", "dyad chain 6"),
    "stephenson_3 driven by its output",
]
SPEED, ACCELERATION = 2.0, 3.0


class Pull:
    """Constant loads of a machine: a force that turns with its link, one on a joint, and a torque."""

    def __init__(self, rng: Rng, mechanism: Mechanism) -> None:
        moving = [link for link in mechanism.links if link != GROUND]
        self.links = [str(link) for link in rng.choice(moving, size=2)]
        self.joint = str(rng.choice(list(mechanism.joints)))
        self.place = rng.normal(size=mechanism.shape) + 1j * rng.normal(size=mechanism.shape)
        self.forces, self.torque = (complex(4.0, -7.0), complex(-3.0, 2.0)), 2.5

    def loads(self, seen, torque: float = 1.0):
        """As they are seen, by what becomes of a vector and of a place."""
        vector, place = seen
        return (
            PointForce(self.links[0], place(self.place), make_constant(vector(self.forces[0])), True),
            JointForce(self.joint, make_constant(vector(self.forces[1]))),
            Torque(self.links[1], make_constant(torque * self.torque)),
        )


def drawn(name: str) -> tuple[Machine, Pull]:
    rng = np.random.default_rng([31, NAMES.index(name)])
    mechanism = (EVERY | CHAIN)[name](rng, 6)
    bodies, pin_masses = masses(rng, mechanism)
    pull = Pull(rng, mechanism)
    here = (lambda z: z, lambda z: z)
    return Machine(mechanism, bodies, pin_masses, GRAVITY, pull.loads(here), complex(*rng.normal(size=2))), pull


def run(whole: Machine, sign: float = 1.0, speed: float = SPEED, acceleration: float = ACCELERATION) -> Reactions:
    mechanism = whole.mechanism
    at = np.asarray(mechanism.reference_input)[:, None] + sign * np.linspace(-0.2, 0.2, 3)
    return compute_reactions(
        whole, Places(mechanism, drive(mechanism, at, speed=speed, acceleration=acceleration, order=2))
    )


def same(one: Reactions, other: Reactions, drive: float = 1.0, moment: float = 1.0, vector=lambda z: z) -> None:
    posed = one.solved & other.solved & (one.condition < 1e4)
    assert posed.sum() > 6
    largest = max(np.abs(force[posed]).max() for on in one.joints.values() for force in on.values())
    for found, expected in (
        (other.drive, drive * one.drive),
        (other.shaking_force, vector(one.shaking_force)),
        (other.shaking_moment, moment * one.shaking_moment),
        *((other.joints[j][link], vector(force)) for j, on in one.joints.items() for link, force in on.items()),
    ):
        np.testing.assert_allclose(found[posed], expected[posed], rtol=1e-8, atol=1e-9 * largest)


@pytest.mark.parametrize("name", NAMES)
def test_frame_may_stand_elsewhere_and_askew(name: str) -> None:
    whole, pull = drawn(name)
    turn, shift = np.exp(0.8j), complex(30.0, -12.0)

    def placed(z):
        return turn * z + shift

    mechanism = whole.mechanism
    moved = Mechanism(
        {joint: placed(z) for joint, z in mechanism.joints.items()},
        mechanism.links,
        mechanism.input,
        tuple(s._replace(point=placed(s.point), angle=s.angle + 0.8) for s in mechanism.slides),
        mechanism.gears,
    )
    bodies = {link: part._replace(cg=placed(part.cg)) for link, part in whole.bodies.items()}
    loads = pull.loads((lambda z: turn * z, placed))
    askew = replace(
        whole, mechanism=moved, bodies=bodies, gravity=turn * GRAVITY, loads=loads, about=placed(whole.about)
    )
    same(run(whole), run(askew), vector=lambda z: turn * z)


@pytest.mark.parametrize("name", NAMES)
def test_mirror_turns_torques_round(name: str) -> None:
    whole, pull = drawn(name)
    mechanism = whole.mechanism
    seen = Mechanism(
        {joint: np.conj(z) for joint, z in mechanism.joints.items()},
        mechanism.links,
        mechanism.input,
        tuple(s._replace(point=np.conj(s.point), angle=-s.angle) for s in mechanism.slides),
        mechanism.gears,
    )
    bodies = {link: part._replace(cg=np.conj(part.cg)) for link, part in whole.bodies.items()}
    loads = pull.loads((np.conj, np.conj), -1.0)
    mirrored = replace(
        whole, mechanism=seen, bodies=bodies, gravity=np.conj(GRAVITY), loads=loads, about=np.conj(whole.about)
    )
    sign = 1.0 if mechanism.has_slide_input else -1.0
    found = run(mirrored, sign, sign * SPEED, sign * ACCELERATION)
    same(run(whole), found, drive=sign, moment=-1.0, vector=np.conj)


@pytest.mark.parametrize("name", NAMES)
def test_motion_may_be_run_backwards(name: str) -> None:
    """At the same acceleration: nothing here asks for the sign of a speed."""
    whole, _ = drawn(name)
    same(run(whole), run(whole, speed=-SPEED))


@pytest.mark.parametrize("name", NAMES)
def test_body_may_be_two_that_are_one(name: str) -> None:
    whole, _ = drawn(name)

    def halves(part: Body) -> Body:
        """Two pieces at different places that have its mass, its centre and its moment of inertia."""
        apart = np.sqrt(0.5 * part.inertia / part.mass) * np.exp(0.3j)
        pieces = [
            Body(0.5 * part.mass, part.cg + side * apart, 0.5 * (part.inertia - part.mass * np.abs(apart) ** 2))
            for side in (1.0, -1.0)
        ]
        return join_bodies(pieces)

    same(run(whole), run(replace(whole, bodies={link: halves(part) for link, part in whole.bodies.items()})))
