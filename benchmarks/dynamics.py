"""Forces of linkages: how fast they are had, and whether a limit on them is met where a known linkage meets it.

    python -m benchmarks.dynamics [speed | dyads | analysis | limited | routes] [--count N] [--seed N] [--kind KIND]

``speed``: force analyses a second of fourbars in closed form, compiled, beside plain vectorised numpy of the same
formulas and the general equations; 10 000 candidates ordered by their peak torque. ``dyads``: the same of linkages of
dyads, sixbars and chains to ten links, by elimination. ``analysis``: what a block
``dynamics`` adds to an analysis of 360 steps. ``limited``: planted tasks with limits on forces
(:mod:`benchmarks.limited_forces`), of all kinds or of one. ``routes``: 10 000 random machines of every type and chains
of dyads to ten links, with springs, dampers, weight, loads that follow their links and masses on pins, over a full
turn: how far reactions and the balances of energy and momentum differ. Times are of the processor, on one core.
"""

from __future__ import annotations

import argparse
import math
import statistics
import time
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import numpy as np

from benchmarks.limited_forces import KINDS, limited
from kinematics.dynamics import Machine, Places, compute_reactions, make_body
from kinematics.dynamics.dyads import compute_dyad_forces
from kinematics.dynamics.fourbar import DRIVE, Fourbars, Weights, compute_peaks
from kinematics.linkage.planar.drive import drive
from kinematics.linkage.planar.mechanism import Mechanism
from synthesis.analyses import parse_request
from synthesis.mechanisms.fourbar_weights import JOINTS, build_fourbars, build_weights
from synthesis.model.dynamics.request import DesignDynamics
from synthesis.model.linkage.conversion import FOURBAR_LINKS
from synthesis.results.forces import apply_link_shape
from tests.kinematics.dynamics.dyad_twin import Twin
from tests.kinematics.dynamics.machines import differences, masses
from tests.kinematics.mechanism_sampling import CHAIN, EVERY, take
from tests.support.problems.limited_forces import LADEN, PLATE, SPEED_RPM

POSITIONS = 72
DYADIC_ROWS = (
    "fourbar",
    "slider-crank",
    "watt_1 driven by its input",
    "watt_2 driven by its input",
    "stephenson_1 driven by its input",
    "stephenson_3 driven by its input",
    "geared fivebar",
    "drag link and slider",
    "dyad chain 6",
    "dyad chain 13",
    "dyad chain 20",
)
"""Of the chains those with ten links."""
SPEED = SPEED_RPM * math.tau / 60.0


def crank_rockers(rng: np.random.Generator, count: int) -> np.ndarray:
    """Joints O2, A, B, O4, P of fourbars whose input turns through, millimetres."""
    found: list[np.ndarray] = []
    while len(found) < count:
        a, b, c, d = rng.uniform((30.0, 100.0, 100.0, 100.0), (60.0, 300.0, 300.0, 300.0))
        if 2.0 * (a + max(b, c, d)) >= a + b + c + d:
            continue
        o2 = complex(*rng.normal(size=2)) * 50.0
        joint_a = o2 + a * np.exp(1j * rng.uniform(0.0, math.tau))
        o4 = o2 + d
        gap = o4 - joint_a
        along = (abs(gap) ** 2 + b * b - c * c) / (2.0 * abs(gap))
        joint_b = joint_a + gap / abs(gap) * complex(along, math.sqrt(b * b - along * along))
        found.append(np.array([o2, joint_a, joint_b, o4, joint_a + (joint_b - joint_a) * complex(0.5, 0.4)]))
    return np.array(found)


def cpu_of(work: Callable[[], Any], repeats: int = 5) -> float:
    """Least processor time of a few runs, after one that compiles."""
    work()
    times = []
    for _ in range(repeats):
        begun = time.process_time()
        work()
        times.append(time.process_time() - begun)
    return min(times)


def in_numpy(linkages: Fourbars, carried: Weights) -> np.ndarray:
    """Peak torque by the formulas of the closed form in plain numpy, all positions at once, without loads."""
    steps = np.linspace(0.0, 1.0, POSITIONS + 1)
    a, b, c = (value[:, None] for value in (linkages.a, linkages.b, linkages.c))
    u2 = np.exp(1j * (linkages.start[:, None] + linkages.span[:, None] * steps))
    crank = a * u2
    diagonal = (linkages.o4 - linkages.o2)[:, None] - crank
    squared = np.abs(diagonal) ** 2
    along = 0.5 * (squared + b * b - c * c)
    height = np.sqrt(b * b * squared - along**2)
    u3 = diagonal * (along + 1j * linkages.sign[:, None] * height) / (squared * b)
    u4 = (b * u3 - diagonal) / c

    def cross(u: np.ndarray, v: np.ndarray) -> np.ndarray:
        return u.real * v.imag - u.imag * v.real

    def dot(u: np.ndarray, v: np.ndarray) -> np.ndarray:
        return u.real * v.real + u.imag * v.imag

    s = cross(u4, u3)
    w3, w4 = SPEED * cross(crank, u4) / (b * s), SPEED * cross(crank, u3) / (c * s)
    pull, cosine = -SPEED * SPEED * crank, dot(u3, u4)
    alpha4 = (dot(pull, u3) - w3**2 * b + w4**2 * c * cosine) / (c * s)
    alpha3 = (dot(pull, u4) + w4**2 * c - w3**2 * b * cosine) / (b * s)
    m, g, inertia = carried.mass, carried.cg, carried.inertia
    arms = [g[:, k, None] * u for k, u in enumerate((u2, u3, u4))]
    rates = [np.full_like(u2, -SPEED * SPEED), 1j * alpha3 - w3**2, 1j * alpha4 - w4**2]
    bases = [0.0, pull, 0.0]
    need = [
        m[:, k, None] * (base + rate * arm - carried.gravity)
        for k, (base, rate, arm) in enumerate(zip(bases, rates, arms, strict=True))
    ]
    arm_p = linkages.point[:, None] * u3
    payload = carried.pins[:, 2, None] * (carried.gravity - pull - rates[1] * arm_p)
    turned2 = cross(arms[0], need[0])
    turned3 = inertia[:, 1, None] * alpha3 + cross(arms[1], need[1]) - cross(arm_p, payload)
    turned4 = inertia[:, 2, None] * alpha4 + cross(arms[2], need[2])
    b_on_output = turned4 / (c * s) * u3 + turned3 / (b * s) * u4
    a_on_input = -(need[1] - payload + b_on_output)
    return np.abs(turned2 - cross(crank, a_on_input)).max(axis=1)


def in_general(joints: np.ndarray, carried: Weights) -> np.ndarray:
    """Peak torque by the general equations of the skeleton, for all fourbars and positions at once."""
    mechanism = Mechanism(dict(zip(JOINTS, joints.T * 1e-3, strict=True)), FOURBAR_LINKS, "input")
    bases, ends = (joints[:, [0, 1, 3]] * 1e-3, joints[:, [1, 2, 2]] * 1e-3)
    centres = bases + carried.cg * (ends - bases) / np.abs(ends - bases)
    machine = Machine(
        mechanism,
        {
            link: make_body(0.0)._replace(mass=carried.mass[:, k], cg=centres[:, k], inertia=carried.inertia[:, k])
            for k, link in enumerate(("input", "coupler", "output"))
        },
        {"P": carried.pins[:, 2]},
        carried.gravity,
    )
    start = np.asarray(mechanism.reference_input)
    inputs = start[:, None] + math.tau * np.linspace(0.0, 1.0, POSITIONS + 1)
    found = compute_reactions(machine, Places(mechanism, drive(mechanism, inputs, speed=SPEED, order=2)))
    return np.abs(found.drive).max(axis=1)


def speed(count: int, seed: int) -> None:
    """Analyses a second, three ways, which agree."""
    joints = crank_rockers(np.random.default_rng(seed), count)
    stated = apply_link_shape(DesignDynamics.model_validate(LADEN), FOURBAR_LINKS)
    whole = np.full(count, math.tau)
    linkages, carried = build_fourbars(joints, whole, 1e-3), build_weights(stated, joints, "mm")
    analyses = count * (POSITIONS + 1)
    few = min(count, 500)
    some = [column[:few] for column in linkages]
    light = carried._replace(
        **{name: getattr(carried, name)[:few] for name in ("mass", "cg", "inertia", "pins", "arm", "force", "about")}
    )
    compiled, plain = compute_peaks(linkages, carried, SPEED, POSITIONS + 1)[:, DRIVE], in_numpy(Fourbars(*some), light)
    general = in_general(joints[:few], light)
    differ = max(float(np.abs(one / compiled[:few] - 1.0).max()) for one in (plain, general))
    print(f"{count} fourbars, {POSITIONS + 1} positions each; three ways to the peak torque differ by {differ:.1e}")
    spent = cpu_of(lambda: compute_peaks(linkages, carried, SPEED, POSITIONS + 1))
    print(f"closed form, compiled, kinematics included: {analyses / spent / 1e6:.1f} M analyses/s")
    spent = cpu_of(lambda: in_numpy(Fourbars(*some), light))
    print(f"the same in plain numpy: {few * (POSITIONS + 1) / spent / 1e6:.2f} M analyses/s")
    spent = cpu_of(lambda: in_general(joints[:few], light))
    print(f"general equations, kinematics included: {few * (POSITIONS + 1) / spent / 1e3:.0f} k analyses/s")

    def order() -> np.ndarray:
        carried = build_weights(stated, joints, "mm")
        return np.argsort(compute_peaks(build_fourbars(joints, whole, 1e-3), carried, SPEED, POSITIONS + 1)[:, DRIVE])

    print(f"{count} candidates weighed by their shapes and ordered by peak torque: {cpu_of(order, 3):.2f} s")


def dyads(count: int, seed: int) -> None:
    """Analyses a second of linkages of dyads by elimination, beside plain numpy and the general equations."""
    for name in DYADIC_ROWS:
        rng = np.random.default_rng([seed, 50])
        drawn = (EVERY | CHAIN)[name](rng, 3 * count)
        start = np.asarray(drawn.reference_input)[:, None]
        inputs = start + np.linspace(-0.05, 0.05, POSITIONS)
        whole = drive(drawn, inputs, order=2).smooth.all(axis=1)
        mechanism = take(drawn, np.flatnonzero(whole)[:count])
        inputs = inputs[whole][:count]
        bodies, pin_masses = masses(rng, mechanism)
        machine = Machine(mechanism, bodies, pin_masses, -9.81j)
        few = take(mechanism, slice(0, 100))
        some = Machine(
            few,
            {
                k: make_body(0.0)._replace(mass=b.mass[:100], cg=b.cg[:100], inertia=b.inertia[:100])
                for k, b in bodies.items()
            },
            {joint: mass[:100] for joint, mass in pin_masses.items()},
            -9.81j,
        )

        def by_equations(some: Machine = some, at: np.ndarray = inputs[:100]) -> Any:
            return compute_reactions(some, Places(some.mechanism, drive(some.mechanism, at, speed=SPEED, order=2)))

        found = compute_dyad_forces(machine, inputs, SPEED)
        general, plain = by_equations(), Twin(some, inputs[:100], SPEED)
        posed = general.condition < 1e4
        peak = np.where(posed, np.abs(general.drive), 0.0).max(axis=1, keepdims=True)
        differ = max(
            float((np.where(posed, np.abs(one - general.drive), 0.0) / peak).max())
            for one in (found.drive[:100], plain.drive)
        )
        rates = [
            one.size / cpu_of(work)
            for one, work in (
                (inputs, partial(compute_dyad_forces, machine, inputs, SPEED)),
                (inputs[:100], partial(Twin, some, inputs[:100], SPEED)),
                (inputs[:100], by_equations),
            )
        ]
        print(
            f"{name}, {len(mechanism.links)} links, {len(inputs)} designs: compiled {rates[0] / 1e6:.2f} M analyses/s, "
            f"plain numpy {rates[1] / 1e6:.2f} M, general equations {rates[2] / 1e3:.0f} k; they differ by {differ:.0e}"
        )


def analysis(count: int, seed: int) -> None:
    """What forces add to an analysis of 360 steps."""
    added = []
    for row in crank_rockers(np.random.default_rng(seed), count):
        o2, a, b, o4, p = (complex(z) for z in row)
        vector = (p - a) / (b - a)
        stated: dict[str, Any] = {
            "mechanism": {
                "type": "fourbar",
                "fixed_pivots": {"input": [o2.real, o2.imag], "output": [o4.real, o4.imag]},
                "links": {"input": abs(a - o2), "coupler": abs(b - a), "output": abs(b - o4)},
                "coupler_point": {"distance": abs(p - a), "angle": math.degrees(np.angle(vector))},
                "assembly": "open",
            },
            "motion": {"from": 0.0, "to": 360.0, "steps": 360, "speed_rpm": SPEED_RPM},
        }
        bodies = {
            link: {"shape": PLATE if link == "coupler" else {**PLATE, "holes": {}}} for link in ("input", "coupler")
        }
        block = {"gravity": {}, "bodies": bodies, "point_masses": [{"joint": "P", "mass": 2.0}]}
        plain, forced = parse_request(stated), parse_request({**stated, "dynamics": block})
        added.append(1e3 * (cpu_of(forced.build_answer, 3) - cpu_of(plain.build_answer, 3)))
    print(
        f"forces add to an analysis of 360 steps: median {statistics.median(added):.1f} ms, worst {max(added):.1f} ms"
    )


def routes(count: int, seed: int) -> None:
    """Reactions against energy and momentum on random machines of all makes."""
    makes = EVERY | CHAIN
    each = -(-count // len(makes))
    begun = time.process_time()
    found: list[Any] = []
    which: list[str] = []
    for n, (name, make) in enumerate(makes.items()):
        rng = np.random.default_rng([seed, 40, n])
        found.append(differences(rng, make(rng, each), math.pi, 37))
        which += [name] * each
    bare, told = (np.concatenate(columns, axis=1) for columns in zip(*found, strict=True))
    known = np.isfinite(told).all(axis=0)
    print(f"{int(known.sum())} of {known.size} machines of {len(makes)} makes have positions with forces")
    for name, shares in (("of the peak", told), ("of the peak, even where it is what millions of it leave", bare)):
        worst = [(float(np.nanmax(row)), which[int(np.nanargmax(row))]) for row in shares]
        listed = ", ".join(
            f"{what} {value:.1e} ({make})"
            for what, (value, make) in zip(("drive", "shaking force", "moment"), worst, strict=True)
        )
        above = int((np.nanmax(np.where(known, shares, 0.0), axis=0) > 1e-9).sum())
        print(f"worst difference, {name}: {listed}; {above} above 1e-9")
    print(f"CPU: {time.process_time() - begun:.0f} s")


def all_limited(count: int, seed: int, kinds: Sequence[str]) -> None:
    """Planted tasks of these kinds."""
    for kind in kinds:
        limited(kind, count, seed)


def main() -> None:
    """Run one part, or all."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("part", nargs="?", choices=["speed", "analysis", "limited", "routes", "dyads"])
    parser.add_argument("--count", type=int)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--kind", choices=list(KINDS), help="of limited tasks")
    asked = parser.parse_args()
    kinds = tuple(KINDS) if asked.kind is None else (asked.kind,)
    parts = (
        ("speed", speed, 10_000),
        ("dyads", dyads, 1000),
        ("analysis", analysis, 20),
        ("limited", partial(all_limited, kinds=kinds), 100),
        ("routes", routes, 10_000),
    )
    for name, part, count in parts:
        if asked.part in (None, name):
            part(asked.count or count, asked.seed)


if __name__ == "__main__":
    main()
