"""Random mechanisms of every type for the laws: batches of reference configurations; everything follows from a seed."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

import numpy as np
from numpy.typing import NDArray

from kinematics.errors import DimensionError
from kinematics.linkage.planar.catalogue import SIXBAR_LINKS, make_peaucellier, make_quick_return, make_sixbar
from kinematics.linkage.planar.mechanism import GearPair, Mechanism, Slide

Rng = np.random.Generator
Make = Callable[[Rng, int], Mechanism]
RATIOS = (1.0, -1.0, 2.0, 0.5, -3.0, 2.0 / 3.0)


def points(rng: Rng, names: str, n: int) -> dict[str, NDArray[np.complex128]]:
    """Joints anywhere, no two nearer than a tenth of the spread."""
    listed = names.split()
    z = rng.normal(size=(20 * n + 200, len(listed))) + 1j * rng.normal(size=(20 * n + 200, len(listed)))
    apart = np.abs(z[:, :, None] - z[:, None, :]) + 10.0 * np.eye(len(listed))
    z = z[apart.min(axis=(1, 2)) > 0.1][:n]
    assert len(z) == n
    return dict(zip(listed, z.T, strict=True))


def stack(mechanisms: Sequence[Mechanism]) -> Mechanism:
    """Single designs of one topology as a batch."""
    first = mechanisms[0]
    slides = tuple(
        Slide(
            slide.joint,
            slide.link,
            np.array([m.slides[k].point for m in mechanisms]),
            np.array([m.slides[k].angle for m in mechanisms]),
        )
        for k, slide in enumerate(first.slides)
    )
    joints = {name: np.array([m.joints[name] for m in mechanisms]) for name in first.joints}
    return Mechanism(joints, first.links, first.input, slides, first.gears)


def take(mechanism: Mechanism, index: object) -> Mechanism:
    """Some designs of a batch, or one."""
    slides = tuple(s._replace(point=s.point[index], angle=s.angle[index]) for s in mechanism.slides)
    joints = {name: z[index] for name, z in mechanism.joints.items()}
    return Mechanism(joints, mechanism.links, mechanism.input, slides, mechanism.gears)


def fourbar(rng: Rng, n: int) -> Mechanism:
    links = {"ground": ("O2", "O4"), "input": ("O2", "A"), "coupler": ("A", "B", "P"), "output": ("O4", "B")}
    return Mechanism(points(rng, "O2 O4 A B P", n), links, "input")


def _slider_crank(rng: Rng, n: int, input: str) -> Mechanism:
    joints = points(rng, "O2 A B P", n)
    line = Slide("B", "ground", joints["B"] + 0.0, rng.uniform(-np.pi, np.pi, n))
    return Mechanism(joints, {"ground": ("O2",), "crank": ("O2", "A"), "coupler": ("A", "B", "P")}, input, (line,))


def slider_crank(rng: Rng, n: int) -> Mechanism:
    return _slider_crank(rng, n, "crank")


def driven_slider(rng: Rng, n: int) -> Mechanism:
    return _slider_crank(rng, n, "B")


def inverted_slider_crank(rng: Rng, n: int) -> Mechanism:
    joints = points(rng, "O2 O4 A B", n)
    angle = rng.uniform(-np.pi, np.pi, n)
    line = Slide("A", "output", joints["A"] + rng.normal(size=n) * np.exp(1j * angle), angle)
    return Mechanism(joints, {"ground": ("O2", "O4"), "input": ("O2", "A"), "output": ("O4", "B")}, "input", (line,))


def _quick_return(rng: Rng, n: int, low: float, high: float) -> Mechanism:
    made: list[Mechanism] = []
    while len(made) < n:
        o2, o4 = complex(*rng.normal(size=2)), complex(*rng.normal(size=2))
        crank = abs(o4 - o2) * rng.uniform(low, high)
        try:
            made.append(
                make_quick_return(
                    o2,
                    o4,
                    crank,
                    rng.uniform(0.5, 3.0),
                    rng.uniform(0.5, 5.0),
                    complex(*rng.normal(size=2)),
                    rng.uniform(-np.pi, np.pi),
                    rng.uniform(-np.pi, np.pi),
                    int(rng.choice([1, -1])),
                    int(rng.choice([1, -1])),
                )
            )
        except DimensionError:
            continue
    return stack(made)


def crank_shaper(rng: Rng, n: int) -> Mechanism:
    return _quick_return(rng, n, 0.1, 0.9)


def whitworth(rng: Rng, n: int) -> Mechanism:
    return _quick_return(rng, n, 1.1, 4.0)


def geared_fivebar(rng: Rng, n: int, ratio: float | None = None) -> Mechanism:
    links = {
        "ground": ("O2", "O5"),
        "input": ("O2", "A"),
        "coupler_1": ("A", "C", "P"),
        "coupler_2": ("B", "C"),
        "output": ("O5", "B"),
    }
    ratio = float(rng.uniform(-4.0, 4.0)) if ratio is None else ratio
    return Mechanism(points(rng, "O2 O5 A B C P", n), links, "input", gears=(GearPair("input", "output", ratio),))


def _sixbar(kind: str, input: str) -> Make:
    names = " ".join(dict.fromkeys(joint for listed in SIXBAR_LINKS[kind].values() for joint in listed))
    return lambda rng, n: make_sixbar(kind, {**points(rng, names, n)}, input)


def _drag_link(rng: Rng, n: int) -> list[tuple[complex, ...]]:
    """Grashof fourbars O2, O4, A, B whose ground is the shortest link, with C on the output."""
    found = []
    while len(found) < n:
        a, b, c = rng.uniform(1.0, 2.0, 3)
        d = rng.uniform(0.1, 0.6)
        lengths = sorted((a, b, c, d))
        theta = rng.uniform(-np.pi, np.pi)
        pin_a = a * np.exp(1j * theta)
        f = abs(d - pin_a)
        if lengths[0] + lengths[3] > 0.98 * (lengths[1] + lengths[2]):
            continue
        x = (f * f + b * b - c * c) / (2.0 * f)
        pin_b = pin_a + (d - pin_a) / f * (x + 1j * rng.choice([1.0, -1.0]) * np.sqrt(b * b - x * x))
        arm = pin_b - d
        found.append((0j, complex(d), pin_a, pin_b, d + arm * complex(*rng.uniform(0.4, 1.2, 2))))
    return found


def drag_link_rocker(rng: Rng, n: int) -> Mechanism:
    made = np.array(_drag_link(rng, n)).T
    joints = dict(zip(("O2", "O4", "A", "B", "C"), made, strict=True))
    joints["O6"] = joints["O4"] + rng.uniform(2.0, 5.0, n) * np.exp(1j * rng.uniform(-np.pi, np.pi, n))
    joints["D"] = joints["C"] + rng.uniform(2.0, 5.0, n) * np.exp(1j * rng.uniform(-np.pi, np.pi, n))
    return make_sixbar("watt_2", joints)


def drag_link_slider(rng: Rng, n: int) -> Mechanism:
    made = np.array(_drag_link(rng, n)).T
    joints = dict(zip(("O2", "O4", "A", "B", "C"), made, strict=True))
    joints["D"] = joints["C"] + rng.uniform(2.0, 5.0, n) * np.exp(1j * rng.uniform(-np.pi, np.pi, n))
    links = {
        "ground": ("O2", "O4"),
        "input": ("O2", "A"),
        "coupler": ("A", "B"),
        "rocker": ("O4", "B", "C"),
        "link_5": ("C", "D"),
    }
    slide = Slide("D", "ground", joints["D"] + 0.0, rng.uniform(-np.pi, np.pi, n))
    return Mechanism(joints, links, "input", (slide,))


def peaucellier_cell(rng: Rng, n: int) -> Mechanism:
    made: list[Mechanism] = []
    while len(made) < n:
        o2, turn = complex(*rng.normal(size=2)), rng.uniform(-np.pi, np.pi)
        crank, side = rng.uniform(0.5, 2.0), rng.uniform(0.3, 1.5)
        arm = side + rng.uniform(0.2, 4.0)
        try:
            made.append(
                make_peaucellier(o2, o2 - crank * np.exp(1j * turn), crank, arm, side, turn + rng.uniform(-2.5, 2.5))
            )
        except DimensionError:
            continue
    return stack(made)


def dyad_chain(rng: Rng, n: int, links: int = 10) -> Mechanism:
    """A crank and dyads on points of the links before, of random make: two links, or a link and a slide.

    Of its make all designs are one; up to so many links, the ground among them. Joints of a dyad are new points.
    """
    joints: dict[str, NDArray[np.complex128]] = {"O": np.zeros(n, np.complex128)}
    listed: dict[str, tuple[str, ...]] = {"ground": ("O",), "crank": ("O", "J0")}
    slides: list[Slide] = []

    def place() -> NDArray[np.complex128]:
        return np.asarray(rng.normal(size=n) + 1j * rng.normal(size=n))

    def joint(*on: str) -> str:
        name = f"J{len(joints) - 1}"
        joints[name] = place()
        for link in on:
            listed[link] = (*listed[link], name)
        return name

    joints["J0"] = place()
    while len(listed) < links:
        known = list(listed)
        first, second = (str(link) for link in rng.choice(known, size=2, replace=False))
        kind = str(rng.choice(["RRR", "RRP", "RPR"])) if len(listed) + 2 <= links else str(rng.choice(["RRP", "RPR"]))
        link = f"link {len(listed)}"
        listed[link] = (joint(first),)
        angle = rng.uniform(-np.pi, np.pi, n)
        if kind == "RRR":
            other = f"link {len(listed)}"
            listed[other] = (joint(second),)
            joint(link, other)
        elif kind == "RRP":
            slider = joint(link)
            slides.append(Slide(slider, second, joints[slider] + rng.normal(size=n) * np.exp(1j * angle), angle))
        else:
            joint(link)
            slot = joint(second)
            slides.append(Slide(slot, link, joints[slot] + rng.normal(size=n) * np.exp(1j * angle), angle))
    return Mechanism(joints, listed, "crank", tuple(slides))


DYADIC: dict[str, Make] = {
    "fourbar": fourbar,
    "slider-crank": slider_crank,
    "slider-crank driven by its slider": driven_slider,
    "inverted slider-crank": inverted_slider_crank,
    "crank-shaper": crank_shaper,
    "Whitworth": whitworth,
    "geared fivebar": geared_fivebar,
    "drag link and rocker": drag_link_rocker,
    "drag link and slider": drag_link_slider,
    "Peaucellier": peaucellier_cell,
}
"""Types that close by dyads, the sixbars' dyadic inputs apart."""

CLASS_THREE: dict[str, Make] = {}
"""Types that do not."""

_CLASS_THREE = {
    ("watt_1", "output"): False,
    ("watt_1", "input"): False,
    ("watt_2", "input"): False,
    ("watt_2", "rocker"): False,
    ("watt_2", "output"): False,
    ("stephenson_1", "input"): False,
    ("stephenson_1", "output"): False,
    ("stephenson_2", "input"): True,
    ("stephenson_2", "output"): True,
    ("stephenson_3", "input"): False,
    ("stephenson_3", "rocker"): False,
    ("stephenson_3", "output"): True,
}
for (_kind, _input), _three in _CLASS_THREE.items():
    (CLASS_THREE if _three else DYADIC)[f"{_kind} driven by its {_input}"] = _sixbar(_kind, _input)


def _dwell(output: str, rng: Rng, n: int) -> Mechanism:
    """A fourbar whose coupler point drives an output: rocker or slider by a link, or a slot through the point."""
    names = {"rocker": "O2 O4 O6 A B P D", "slider": "O2 O4 A B P D", "slot": "O2 O4 O6 A B P C"}[output]
    joints = points(rng, names, n)
    links: dict[str, tuple[str, ...]] = {
        "ground": tuple(joint for joint in names.split() if joint[0] == "O"),
        "input": ("O2", "A"),
        "coupler": ("A", "B", "P"),
        "rocker": ("O4", "B"),
    }
    if output == "rocker":
        return Mechanism(joints, links | {"link_5": ("P", "D"), "output": ("O6", "D")}, "input")
    angle = rng.uniform(-np.pi, np.pi, n)
    if output == "slider":
        return Mechanism(joints, links | {"link_5": ("P", "D")}, "input", (Slide("D", "ground", joints["D"], angle),))
    slot = Slide("P", "output", joints["P"] + rng.normal(size=n) * np.exp(1j * angle), angle)
    return Mechanism(joints, links | {"output": ("O6", "C")}, "input", (slot,))


_DWELLS: dict[str, Make] = {f"dwell_{output}": partial(_dwell, output) for output in ("rocker", "slider", "slot")}

CHAINS = 30
"""Makes of dyad chains that are drawn."""

CHAIN: dict[str, Make] = {f"dyad chain {k}": partial(dyad_chain, links=4 + k % 7) for k in range(CHAINS)}
"""Dyad chains of four to ten links."""

EVERY = DYADIC | CLASS_THREE | _DWELLS
DYADIC |= _DWELLS
