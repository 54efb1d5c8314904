"""Code that several tests share: limited forces."""

from __future__ import annotations

import cmath
import math
from typing import Any

import numpy as np

from kinematics.linkage.planar.mechanism import GROUND, Mechanism, Slide
from synthesis.model.linkage.conversion import FOURBAR_LINKS

SPEED_RPM = 60.0
PLATE = {"density": 7800.0, "thickness": 10.0, "width": 20.0, "holes": {"A": 8.0, "B": 8.0}}
BLOCK: dict[str, Any] = {"gravity": {}, "links": PLATE, "speed_rpm": SPEED_RPM}
LADEN = BLOCK | {"point_masses": [{"joint": "P", "mass": 2.0}]}
SLIDER_LINKS = {GROUND: ("O2",), "crank": ("O2", "A"), "coupler": ("A", "B", "P")}


def fourbar(rng: np.random.Generator) -> Mechanism:
    """A fourbar whose input turns through, with a coupler point."""
    while True:
        a, b, c, d = rng.uniform((30.0, 100.0, 100.0, 100.0), (60.0, 300.0, 300.0, 300.0))
        if 2.0 * (a + max(b, c, d)) < a + b + c + d:
            break
    o2 = complex(*rng.normal(size=2)) * 50.0
    joint_a = o2 + cmath.rect(a, rng.uniform(0.0, math.tau))
    o4 = o2 + d
    gap = o4 - joint_a
    along = (abs(gap) ** 2 + b * b - c * c) / (2.0 * abs(gap))
    joint_b = joint_a + gap / abs(gap) * complex(along, math.sqrt(b * b - along * along))
    joints = {"O2": o2, "A": joint_a, "B": joint_b, "O4": o4, "P": joint_a + (joint_b - joint_a) * complex(0.5, 0.4)}
    return Mechanism(joints, FOURBAR_LINKS, "input")


def slider_crank(rng: np.random.Generator) -> Mechanism:
    """A slider-crank whose crank turns through, with a coupler point."""
    a, b = rng.uniform((30.0, 120.0), (60.0, 300.0))
    offset = rng.uniform(-0.5, 0.5) * (b - a)
    joint_a = cmath.rect(a, rng.uniform(0.0, math.tau))
    joint_b = complex(joint_a.real + math.sqrt(b * b - (offset - joint_a.imag) ** 2), offset)
    joints = {"O2": 0j, "A": joint_a, "B": joint_b, "P": joint_a + (joint_b - joint_a) * complex(0.5, 0.4)}
    return Mechanism(joints, SLIDER_LINKS, "crank", (Slide("B", GROUND, complex(0.0, offset), 0.0),))
