"""Random linkages with masses, as a client states them for balancing."""

from __future__ import annotations

import cmath
import math
from typing import Any

import numpy as np

Statement = dict[str, Any]
Rng = np.random.Generator

AROUND = 25.0
"""Degrees to both sides of the reference over which a linkage moves."""


def pair(z: complex) -> list[float]:
    return [z.real, z.imag]


def meeting(rng: Rng, one: complex, other: complex) -> complex:
    """A joint of a dyad from two places, well away from a straight line."""
    return one + (other - one) * complex(rng.uniform(0.2, 0.8), rng.choice([-1.0, 1.0]) * rng.uniform(0.7, 1.3))


def fourbar(rng: Rng, unit: float = 100.0) -> tuple[dict[str, complex], dict[str, list[str]], float]:
    """Joints and links of a fourbar in some position, and the angle of its input, degrees."""
    o2, o4 = 0j, unit * complex(rng.uniform(2.0, 4.0), rng.uniform(-0.5, 0.5))
    a = o2 + cmath.rect(unit * rng.uniform(0.4, 0.9), rng.uniform(-math.pi, math.pi))
    b = meeting(rng, a, o4)
    joints = {"O2": o2, "O4": o4, "A": a, "B": b}
    links = {"ground": ["O2", "O4"], "input": ["O2", "A"], "coupler": ["A", "B"], "output": ["O4", "B"]}
    return joints, links, math.degrees(cmath.phase(a))


def sixbar(rng: Rng, unit: float = 100.0) -> tuple[dict[str, complex], dict[str, list[str]], float]:
    """The same of a sixbar: a fourbar with a dyad from its coupler, output or input to the ground."""
    joints, links, at = fourbar(rng, unit)
    driven = str(rng.choice(["coupler", "output", "input"]))
    first, second = (joints[name] for name in links[driven][:2])
    c = first + (second - first) * complex(rng.uniform(0.3, 1.2), rng.uniform(-0.8, 0.8))
    o6 = c + unit * cmath.rect(rng.uniform(2.0, 3.5), rng.uniform(-math.pi, math.pi))
    joints |= {"C": c, "O6": o6, "D": meeting(rng, c, o6)}
    links[driven] = [*links[driven], "C"]
    links["ground"] = [*links["ground"], "O6"]
    return joints, links | {"connecting": ["C", "D"], "rocker": ["O6", "D"]}, at


def across(one: complex, other: complex, first: float, second: float) -> complex:
    """Where circles about two places meet, on the left of the line between them."""
    apart = abs(other - one)
    along = (first**2 - second**2 + apart**2) / (2.0 * apart)
    return one + (other - one) / apart * complex(along, math.sqrt(first**2 - along**2))


def crank_rocker(rng: Rng, unit: float = 100.0) -> tuple[dict[str, complex], dict[str, list[str]], float]:
    """The same of a fourbar whose crank turns through, with room to spare."""
    while True:
        crank, *others = rng.uniform(0.3, 0.8), *rng.uniform(1.2, 3.5, 3)
        if crank + max(others) < 0.9 * (sum(others) - max(others)):
            break
    crank, ground, coupler, output = (unit * float(length) for length in (crank, *others))
    at = rng.uniform(-math.pi, math.pi)
    a, o4 = cmath.rect(crank, at), complex(ground)
    joints = {"O2": 0j, "O4": o4, "A": a, "B": across(a, o4, coupler, output)}
    links = {"ground": ["O2", "O4"], "input": ["O2", "A"], "coupler": ["A", "B"], "output": ["O4", "B"]}
    return joints, links, math.degrees(at)


def turning_sixbar(rng: Rng, unit: float = 100.0) -> tuple[dict[str, complex], dict[str, list[str]], float]:
    """The same of a crank-rocker with a dyad on its coupler, long enough for all of its curve."""
    joints, links, at = crank_rocker(rng, unit)
    c = joints["A"] + (joints["B"] - joints["A"]) * complex(rng.uniform(0.3, 1.0), rng.uniform(-0.4, 0.4))
    o6 = joints["O4"] + unit * cmath.rect(rng.uniform(0.5, 1.5), rng.uniform(-math.pi, math.pi))
    far = 2.5 * max(abs(c - o6), *(abs(z - o6) for z in joints.values()))
    joints |= {"C": c, "O6": o6, "D": across(c, o6, far, 0.9 * far)}
    links = {**links, "coupler": [*links["coupler"], "C"], "ground": [*links["ground"], "O6"]}
    return joints, links | {"connecting": ["C", "D"], "rocker": ["O6", "D"]}, at


TURNING = (crank_rocker, turning_sixbar)


def bodies(rng: Rng, joints: dict[str, complex], links: dict[str, list[str]]) -> Statement:
    """Masses of all moving links, kg, with centres of gravity near them and what inertia such a link has."""
    stated = {}
    for link, listed in links.items():
        if link == "ground":
            continue
        first, second = (joints[joint] for joint in listed[:2])
        size = abs(second - first)
        mass = float(rng.uniform(0.2, 2.0))
        cg = first + (second - first) * complex(rng.uniform(0.2, 0.9), rng.uniform(-0.2, 0.2))
        inertia = mass * (1e-3 * size) ** 2 * float(rng.uniform(0.05, 0.15))
        stated[link] = {"mass": mass, "cg": pair(cg), "inertia": inertia}
    return stated


def stated(rng: Rng, make: Any = fourbar, **more: Any) -> Statement:
    """A problem of balancing a random linkage."""
    joints, links, at = make(rng)
    return {
        "kind": "balancing",
        "object": "linkage",
        "mechanism": {
            "type": "skeleton",
            "skeleton": {
                "joints": {name: pair(z) for name, z in joints.items()},
                "links": [{"name": name, "joints": listed} for name, listed in links.items()],
                "input_link": "input",
            },
        },
        "motion": {
            "from": at - (0.0 if make in TURNING else AROUND),
            "to": at + (360.0 if make in TURNING else AROUND),
            "speed_rpm": 300.0,
        },
        "dynamics": {"bodies": bodies(rng, joints, links)},
        **more,
    }
