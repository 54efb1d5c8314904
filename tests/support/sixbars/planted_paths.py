"""Planted curves: random linkages, each with 24 points of its own curve, and whether one as good is found.

A planted sixbar or eightbar has a crank that turns fully, transmission angles of 15° at least, and P on a link that is
not joined to the ground. The task is the points, the type, the planted transmission angle and twice the link ratio. The
search minimizes the distance both ways between the curve and the polygon through the points, which the planted linkage
does not make zero either: *as good* are the tasks with a design that has no more of it than the planted one. ``near``
are those whose points lie on the curve of a design to a thousandth of their box's diagonal, root mean square. ``false``
counts designs that their loops (tests/oracles/loops.py) do not confirm over a whole turn: branch, closure, curve, or
transmission angles.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from kinematics.arrays import Complex
from kinematics.linkage.planar import catalogue
from kinematics.linkage.planar.drive import drive
from kinematics.linkage.planar.mechanism import Mechanism
from synthesis.fit.linkage.topology import CRANK, FIXED, POINT, Topology, list_chains
from synthesis.model.linkage.sixbars import list_lengths
from synthesis.verification.reconstruction import rebuild_mechanism
from tests.oracles.loops import Loops
from tests.support.sixbars.driven import find_dyad_pins, transmits
from tests.support.sixbars.path import both_ways, off, solved
from tests.support.sixbars.planted_functions import ratio_of
from tests.support.sixbars.spread import each

TASKS = 100

SAMPLES, DENSE, FINE, DRIVEN = 24, 240, 28_800, 361
LEAST, WIDEST = 15.0, 10.0
NEAR = 1e-3
TYPES = ["watt_1", "stephenson_1", "stephenson_3", "stephenson_2", "eightbar"]
BATCH, SWEPT = 40_000, 48
EIGHTBARS = list_chains(3)


def list_closing(topology: Topology, rng: np.random.Generator) -> list[dict[str, complex]]:
    """Random eightbars, of coordinates that are drawn evenly, whose crank turns through with the least angle."""
    names = {node: name for name, node in topology.joints.items()}
    places = rng.uniform(-1.0, 1.0, (BATCH, len(topology.nodes))) + 1j * rng.uniform(
        -1.0, 1.0, (BATCH, len(topology.nodes))
    )
    turn = np.exp(2j * np.pi * np.arange(SWEPT) / SWEPT)
    moved: list[Any] = []
    for k, (kind, i, j, _) in enumerate(topology.nodes):
        own = places[:, k, None]
        if kind == FIXED:
            moved.append(own + 0.0 * turn)
        elif kind == CRANK:
            moved.append(places[:, i, None] + turn * (own - places[:, i, None]))
        elif kind == POINT:
            ratio = (own - places[:, i, None]) / (places[:, j, None] - places[:, i, None])
            moved.append(moved[i] + ratio * (moved[j] - moved[i]))
        else:
            # Two circles about the pins of the dyad: cosine of its angle, and the side of the reference.
            r1, r2 = np.abs(own - places[:, i, None]), np.abs(own - places[:, j, None])
            base = moved[j] - moved[i]
            cosine = (r1**2 + r2**2 - np.abs(base) ** 2) / (2.0 * r1 * r2)
            kept = np.abs(cosine).max(axis=1) < math.cos(math.radians(LEAST))
            along = (r1**2 - r2**2 + np.abs(base) ** 2) / (2.0 * np.abs(base) ** 2)
            side = np.sign(((places[:, j] - places[:, i]).conj() * (places[:, k] - places[:, i])).imag)[:, None]
            height = np.sqrt(np.maximum((r1 / np.abs(base)) ** 2 - along**2, 0.0))
            moved.append(moved[i] + base * (along + 1j * side * height))
            places, moved = places[kept], [row[kept] for row in moved]
    return [{name: complex(row[node]) for node, name in names.items()} for row in places]


def draw_eightbar(rng: np.random.Generator) -> tuple[dict[str, complex], dict[str, tuple[str, ...]]]:
    """A random eightbar whose crank turns through: its joints and links."""
    while True:
        topology = EIGHTBARS[rng.integers(len(EIGHTBARS))]
        names = {node: name for name, node in topology.joints.items()}
        links = {link: tuple(names[pin] for pin in pins) for link, pins in topology.links.items()}
        links[topology.body] += ("P",)
        closing = list_closing(topology, rng)
        if closing:
            return closing[0], links


def planted(kind: str, rng: np.random.Generator) -> tuple[Complex, float, dict[str, float]]:
    """Points of a random sixbar's curve, its distance from them both ways, and what it keeps."""
    turn = np.linspace(0.0, 2.0 * math.pi, DENSE, endpoint=False)
    while True:
        if kind == "eightbar":
            joints, links = draw_eightbar(rng)
            lengths = list_lengths(joints, links).values()
            ratio = max(lengths) / min(lengths)
        else:
            names = sorted({joint for listed in catalogue.SIXBAR_LINKS[kind].values() for joint in listed})
            places = rng.uniform(-1.0, 1.0, len(names)) + 1j * rng.uniform(-1.0, 1.0, len(names))
            joints = dict(zip(names, (complex(z) for z in places), strict=True))
            ratio = ratio_of(joints, kind)
        if ratio > WIDEST:
            continue
        mechanism = Mechanism(joints, links, "input") if kind == "eightbar" else catalogue.make_sixbar(kind, joints)
        motion = drive(mechanism, float(mechanism.reference_input) + turn, order=0)
        if not motion.valid.all():
            continue
        least = math.degrees(math.asin(min(float(np.abs(sine).min()) for sine in motion.sines.values())))
        curve = motion.joints["P"][0]
        if least < LEAST or math.hypot(float(np.ptp(curve.real)), float(np.ptp(curve.imag))) < 0.2:
            continue
        points = curve[:: DENSE // SAMPLES]
        return (
            points,
            both_ways(mechanism, points),
            {"min_transmission_angle": least - 0.5, "max_link_ratio": 2.0 * ratio},
        )


def distance(design: Any, points: Complex) -> float:
    """The root mean square of the distances of points from the curve of a design, in diagonals of their box."""
    mechanism = rebuild_mechanism(design.mechanism)
    turn = np.linspace(0.0, 2.0 * math.pi, FINE, endpoint=False)
    curve = drive(mechanism, float(mechanism.reference_input) + turn, order=0).joints["P"][0]
    size = math.hypot(float(np.ptp(points.real)), float(np.ptp(points.imag)))
    return float(np.sqrt(np.mean(off(points, curve) ** 2))) / size


def false_claim(design: Any) -> str:
    """What another formulation does not confirm of a design over a turn; empty where it confirms all."""
    mechanism = rebuild_mechanism(design.mechanism)
    turn = np.linspace(0.0, 2.0 * math.pi, DRIVEN)
    try:
        loops = Loops(design.mechanism.skeleton.model_dump(mode="json"))
        met = loops.followed(turn)
    except AssertionError as error:
        return str(error)
    if not met.branch > 0.0:
        return "another branch"
    curve = drive(mechanism, float(mechanism.reference_input) + turn, order=0).joints["P"][0]
    if not max(np.abs(met.points - curve).max(), abs(met.points[-1] - met.points[0])) < 1e-7 * np.abs(curve).max():
        return "another curve"
    return "" if transmits(design, loops, met, find_dyad_pins(design.mechanism.type, loops)) else "transmission angle"


def tried(kind: str, points: Complex, own: float, constraints: dict[str, float]) -> tuple[float, float, float, Any]:
    """The least distance both ways in those of the planted, and of the points in diagonals; the processor time, and
    what is not confirmed of each."""
    result, processor, _ = solved(points, mechanisms=[kind], constraints=constraints, max_designs=3)
    passed = [design for design in result.designs if design.verification.passed]
    both = min((both_ways(rebuild_mechanism(design.mechanism), points) for design in passed), default=math.inf)
    near = min((distance(design, points) for design in passed), default=math.inf)
    return both / own, near, processor, [false_claim(design) for design in passed]


def table(tasks: int, seed: int) -> None:
    print(
        f"{'planted':<14}{'tasks':>6}{'as good %':>10}{'median share':>13}{'worst':>8}{'near %':>8}{'median off':>11}"
        f"{'CPU s':>7}{'most':>7}{'false':>8}"
    )
    for kind in TYPES:
        rng = np.random.default_rng([seed, TYPES.index(kind)])
        rows = list(each(tried, [(kind, *planted(kind, rng)) for _ in range(tasks)]))
        shares, errors, times = (np.array(column) for column in list(zip(*rows, strict=True))[:3])
        listed = [fault for *_, faults in rows for fault in faults]
        print(
            f"{kind:<14}{tasks:>6}{100.0 * np.mean(shares <= 1.0):>10.1f}{np.median(shares):>13.3f}{shares.max():>8.3f}"
            f"{100.0 * np.mean(errors <= NEAR):>8.1f}{np.median(errors):>11.2e}{np.median(times):>7.2f}"
            f"{max(times):>7.1f}{sum(map(bool, listed)):>5}/{len(listed)}",
            flush=True,
        )
