"""Random linkages that weigh something, and springs that are known to balance them."""

from __future__ import annotations

import cmath
import math
from typing import Any

import numpy as np

from synthesis.kinds.spring_balancing.problem import SpringBalancingProblem
from tests.support.synthesis.balanced_linkages import bodies, crank_rocker, pair

Statement = dict[str, Any]
Rng = np.random.Generator

GRAVITY = 9.80665


def skeleton(joints: dict[str, complex], links: dict[str, list[str]], slides: Any = ()) -> Statement:
    return {
        "type": "skeleton",
        "skeleton": {
            "joints": {name: pair(z) for name, z in joints.items()},
            "links": [{"name": name, "joints": listed} for name, listed in links.items()],
            "slides": list(slides),
            "input_link": "input",
        },
    }


def problem(mechanism: Statement, motion: Statement, dynamics: Statement, springs: list[Statement], **more: Any) -> Any:
    return {
        "kind": "spring_balancing",
        "mechanism": mechanism,
        "motion": motion,
        "dynamics": {"gravity": {}, **dynamics},
        "springs": springs,
        **more,
    }


def around(rng: Rng, place: complex, size: float) -> list[list[float]]:
    """A triangle with a place in it."""
    turn = rng.uniform(0.0, 2.0 * math.pi)
    corners = [size * cmath.rect(rng.uniform(0.5, 1.0), turn + 2.0 * math.pi * n / 3.0) for n in range(3)]
    shares = rng.dirichlet([2.0, 2.0, 2.0])
    middle = complex(sum(share * corner for share, corner in zip(shares, corners, strict=True)))
    return [pair(place + corner - middle) for corner in corners]


def lever(rng: Rng, *, both: bool = False) -> Statement:
    """A lever that a zero-free-length spring balances: k a b = W c, with a above the pivot and b where W c points."""
    length = rng.uniform(100.0, 500.0)
    cg = length * cmath.rect(rng.uniform(0.3, 1.0), rng.uniform(-0.5, 0.5))
    mass, share = rng.uniform(0.5, 10.0), rng.uniform(0.2, 0.8)
    above, held = 1j * rng.uniform(0.5, 1.5) * length, share * cg
    ends: list[Statement] = [
        {"link": "ground", "point": pair(above)},
        {"link": "input", "within": around(rng, held, 0.3 * length)},
    ]
    if both:
        ends[0] = {"link": "ground", "within": around(rng, above, 0.3 * length)}
    elif rng.random() < 0.5:
        ends = [{"link": "ground", "within": around(rng, above, 0.3 * length)}, {"link": "input", "point": pair(held)}]
    rate = mass * GRAVITY / (1e-3 * abs(above) * share)
    first = rng.uniform(-180.0, 180.0)
    return problem(
        skeleton({"O": 0j, "A": complex(length)}, {"ground": ["O"], "input": ["O", "A"]}),
        {"from": first, "to": first + rng.uniform(40.0, 360.0)},
        {"bodies": {"input": {"mass": mass, "cg": pair(cg)}}},
        [{"ends": ends, "max_rate": 3.0 * rate}],
    )


def fourbar(rng: Rng) -> Statement:
    """A crank-rocker that two zero-free-length springs balance, one on each link with a fixed pivot.

    The height of a point of the coupler is linear in the places of its pins, and each pin goes round a fixed pivot.
    """
    joints, links, _ = crank_rocker(rng)
    weights = bodies(rng, joints, links)
    # What all weights do, by the places of the pins A and B: Re(w conj A) + Re(v conj B).
    pulls = {"A": 0j, "B": 0j}
    for link, body in weights.items():
        cg, weight = complex(*body["cg"]), body["mass"] * GRAVITY
        first, second = (joints[name] for name in links[link][:2])
        share = (cg - first) / (second - first)
        # y = Im(first + share (second − first)), and Im(s z) = Re(i conj(s) conj(z))
        for name, factor in ((links[link][0], 1.0 - share), (links[link][1], share)):
            if name in pulls:
                pulls[name] += weight * 1j * factor.conjugate()
    springs = []
    for pin, pivot, link in (("A", "O2", "input"), ("B", "O4", "output")):
        arm, share = joints[pin] - joints[pivot], rng.uniform(0.3, 1.2)
        reach = abs(arm) * rng.uniform(1.0, 3.0)
        # k |a − O| share |arm| = |pull| |arm|, and a is where the pull is upwards.
        held = joints[pivot] + share * arm
        anchor = joints[pivot] + reach * pulls[pin] / abs(pulls[pin])
        rate = abs(pulls[pin]) / (1e-3 * reach * share)
        ends = [{"link": "ground", "within": around(rng, anchor, 30.0)}, {"link": link, "point": pair(held)}]
        springs.append({"ends": ends, "max_rate": 4.0 * rate})
    return problem(skeleton(joints, links), {"from": 0.0, "to": 360.0}, {"bodies": weights}, springs)


def slider_crank(rng: Rng) -> Statement:
    """A slider-crank on an inclined line, with real springs on its crank and piston at given ends."""
    crank, rod, tilt = rng.uniform(40.0, 80.0), rng.uniform(150.0, 250.0), rng.uniform(-1.2, 1.2)
    line = cmath.rect(1.0, tilt)
    at = rng.uniform(-math.pi, math.pi)
    pin = cmath.rect(crank, at)
    along = (pin * line.conjugate()).real + math.sqrt(rod**2 - (pin * line.conjugate()).imag ** 2)
    piston = along * line
    joints = {"O": 0j, "A": pin, "B": piston}
    links = {"ground": ["O"], "input": ["O", "A"], "coupler": ["A", "B"]}
    slides = [{"joint": "B", "link": "ground", "point": [0.0, 0.0], "angle": math.degrees(tilt)}]
    weights = bodies(rng, joints, links)
    far = 2.5 * (crank + rod)
    springs: list[Statement] = []
    for link, held in (("input", 0.7 * pin), ("coupler", piston)):
        anchor = rng.uniform(0.6, 1.0) * far * cmath.rect(1.0, rng.uniform(-math.pi, math.pi))
        springs.append(
            {
                "ends": [{"link": "ground", "point": pair(anchor)}, {"link": link, "point": pair(held)}],
                "max_rate": float(rng.uniform(500.0, 5000.0)),
                "min_free_length": 20.0,
                "max_free_length": float(rng.uniform(50.0, 400.0)),
                "max_preload": float(rng.uniform(0.0, 20.0)),
                **({"form": "extension"} if rng.random() < 0.5 else {}),
                **({"max_force": float(rng.uniform(50.0, 400.0))} if rng.random() < 0.5 else {}),
            }
        )
    start = math.degrees(at)
    dynamics = {"bodies": weights, "point_masses": [{"joint": "B", "mass": float(rng.uniform(0.5, 3.0))}]}
    return problem(skeleton(joints, links, slides), {"from": start, "to": start + 360.0}, dynamics, springs)


def missed(rng: Rng) -> Statement:
    """A fourbar whose springs may hold in areas beside the places that would balance it."""
    stated = fourbar(rng)
    for spring in stated["springs"]:
        away = 60.0 * cmath.rect(1.0, rng.uniform(-math.pi, math.pi))
        area = spring["ends"][0]["within"]
        spring["ends"][0]["within"] = [pair(complex(*corner) + away) for corner in area]
        spring["max_rate"] *= rng.uniform(0.3, 1.0)
    return {**stated, "norm": str(rng.choice(["max", "rms"]))}


def both_open(rng: Rng) -> Statement:
    """The same with the ends on its links in areas, too."""
    stated = missed(rng)
    for spring in stated["springs"]:
        end = spring["ends"][1]
        place = complex(*end.pop("point"))
        end["within"] = around(rng, place + 10.0 * cmath.rect(1.0, rng.uniform(-math.pi, math.pi)), 20.0)
    return stated


def problem_of(statement: Statement) -> SpringBalancingProblem:
    """The problem of a statement that contradicts nothing."""
    problem = SpringBalancingProblem.model_validate(statement)
    problem.require_consistent()
    return problem
