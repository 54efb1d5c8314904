"""A fourbar that exerts neither force nor moment on its frame, by geared counter-inertias (Berkof).

Let the coupler's centre of gravity lie on the line of its pins, at the distances r and b from them, and let its radius
of gyration satisfy k² = r b. The coupler then has the momentum and the angular momentum of two masses at the pins
(Norton, *Design of Machinery*, 12.12-12.17), which can be counted as parts of the cranks. With the force balanced, each
crank turns about its own centre of gravity. Its angular momentum I φ' is cancelled by an equal inertia that gears turn
in the opposite direction:

    m2 r2 = m3 b a2/a3,  m4 r4 = m3 r a4/a3,  I2 = m2 (k2² + r2² + a2 r2),  I4 = m4 (k4² + r4² + a4 r4)

(12.14-12.17; in 12.17a the first factor on the right is misprinted as m2).
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from kinematics.dynamics.bodies import Body, join_bodies, make_body
from kinematics.dynamics.machine import Machine
from kinematics.linkage.planar.mechanism import GROUND, GearPair, Mechanism
from kinematics.message import compose
from synthesis.kinds.balancing.linkage.force_balance import Weight
from synthesis.kinds.balancing.linkage.motion import list_moving_links
from synthesis.kinds.balancing.statement.counterweights import Counterweights

INLINE_TOLERANCE = 1e-9
"""Distance of the coupler's centre of gravity from the line of its pins, as a share of the coupler's length, that is
attributed to rounding."""


class NoMomentBalance(ValueError):
    """Gears cannot balance this linkage; the message gives the reason."""


class GearedBalance(NamedTuple):
    """The mechanism with the geared links, the counterweights, and the inertias of the geared links by name."""

    mechanism: Mechanism
    weights: list[Weight]
    inertias: dict[str, float]


def find_moment_balance(machine: Machine, requested: Counterweights) -> GearedBalance:
    """Find weights and geared inertias of a fourbar.

    Raises
    ------
    NoMomentBalance
        If the linkage is no fourbar, if the coupler's centre of gravity is off the line of its pins, or if there are
        masses elsewhere on it.
    """
    mechanism, scale = machine.mechanism, machine.scale
    crank, coupler, output = _identify_fourbar(mechanism)
    ground = mechanism.links[GROUND]
    pins = {link: next(j for j in mechanism.links[link] if j in mechanism.links[coupler]) for link in (crank, output)}
    pivots = {link: next(j for j in mechanism.links[link] if j in ground) for link in (crank, output)}
    place = {joint: complex(scale * z) for joint, z in mechanism.joints.items()}
    a, b = place[pins[crank]], place[pins[output]]
    known = machine.bodies.get(coupler, make_body(0.0))
    others = [j for j, mass in machine.pin_masses.items() if float(mass) > 0.0 and j not in (*pins.values(), *ground)]
    if others:
        raise NoMomentBalance(compose("balancing-mass-off-crank-pins", joint=others[0]))
    weights = _balance_coupler(coupler, known, a, b, requested, scale)
    whole = join_bodies([known, *(weight.body for weight in weights)])
    along = complex((complex(whole.cg) - a) / (b - a)) if float(whole.mass) > 0.0 else 0j
    shares = {crank: 1.0 - along.real, output: along.real}
    inertias: dict[str, float] = {}
    gears: list[GearPair] = []
    joints: dict[str, ArrayLike] = dict(mechanism.joints)
    links = dict(mechanism.links)
    for link in (crank, output):
        pivot, pin = place[pivots[link]], place[pins[link]]
        carried = float(machine.pin_masses.get(pins[link], np.zeros(()))) + shares[link] * float(whole.mass)
        own = machine.bodies.get(link, make_body(0.0))
        # One weight cancels both the coupler's share at the pin and the crank's own first moment.
        moment = -carried * (pin - pivot) - float(own.mass) * (complex(own.cg) - pivot)
        turned = [own]
        if abs(moment) > 0.0:
            radius = abs(pin - pivot) if requested.radius is None else scale * requested.radius
            mass = abs(moment) / radius if requested.mass is None else requested.mass
            weight = Weight(link, mass, pivot + moment / mass, requested.compute_inertia(mass, scale))
            weights.append(weight)
            turned.append(weight.body)
        about = sum(float(p.inertia) + float(p.mass) * abs(complex(p.cg) - pivot) ** 2 for p in turned)
        name = f"counter_{link}"
        inertias[name] = about + carried * abs(pin - pivot) ** 2
        far = f"{pivots[link]}_gear"
        joints[far] = np.asarray(mechanism.joints[pivots[link]] + 0.5 * (pin - pivot) / scale)
        links[name] = (pivots[link], far)
        gears.append(GearPair(link, name, -1.0))
    geared = Mechanism(joints, links, mechanism.input, mechanism.slides, tuple(gears), mechanism.turns)
    return GearedBalance(geared, weights, inertias)


def with_inertias(machine: Machine, geared: GearedBalance) -> Machine:
    """Add the geared links to a machine."""
    turned = {link: make_body(0.0, 0j, inertia) for link, inertia in geared.inertias.items()}
    return replace(machine, mechanism=geared.mechanism, bodies={**machine.bodies, **turned})


def _identify_fourbar(mechanism: Mechanism) -> tuple[str, str, str]:
    """Return input, coupler and output of a fourbar."""
    links, ground = list_moving_links(mechanism), set(mechanism.links[GROUND])
    cranks = [link for link in links if set(mechanism.links[link]) & ground]
    if len(links) != 3 or len(cranks) != 2 or mechanism.slides or mechanism.gears:
        raise NoMomentBalance(compose("balancing-geared-inertias-for-fourbars"))
    first = mechanism.input
    return first, next(link for link in links if link not in cranks), next(link for link in cranks if link != first)


def _balance_coupler(
    coupler: str, known: Body, a: complex, b: complex, requested: Counterweights, scale: float
) -> list[Weight]:
    """Make the coupler equivalent to two masses at its pins, if necessary by an inertia or a mass midway between them.

    The coupler is equivalent to two masses if m r b − I = 0. A mass at a pin does not change this expression. A mass in
    the middle adds a²/4 per unit mass. An inertia subtracts its own value.
    """
    mass, own = float(known.mass), float(known.inertia)
    if mass == 0.0 and own == 0.0:
        return []
    along = complex((complex(known.cg) - a) / (b - a)) if mass > 0.0 else 0j
    if abs(along.imag) > INLINE_TOLERANCE:
        raise NoMomentBalance(compose("balancing-coupler-center-off-pin-line"))
    square = abs(b - a) ** 2
    # m r b − I is positive if inertia is missing and negative if mass is missing.
    surplus = mass * along.real * (1.0 - along.real) * square - own
    if abs(surplus) <= INLINE_TOLERANCE * (own + mass * square):
        return []
    if surplus > 0.0:
        return [Weight(coupler, 0.0, a, surplus)]
    # A disc in the middle also has an inertia of its own, so that m a²/4 − m² I(1) must equal the deficit.
    quarter, own_of_one = 0.25 * square, requested.compute_inertia(1.0, scale)
    root = quarter**2 + 4.0 * own_of_one * surplus
    if root < 0.0:
        raise NoMomentBalance(compose("balancing-coupler-disc-too-flat"))
    needed = -2.0 * surplus / (quarter + math.sqrt(root))
    return [Weight(coupler, needed, 0.5 * (a + b), requested.compute_inertia(needed, scale))]
