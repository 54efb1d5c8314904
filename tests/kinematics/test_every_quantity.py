"""What is said of every type of mechanism, each against geometry or differences of its positions alone.

Transmission angles at every dyad, by the lines of its links; limit positions, by looking along the branch; instant
centres, by what two links carry along from one position to the next.
"""

from __future__ import annotations

from itertools import combinations
from typing import NamedTuple

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

from kinematics.linkage.planar.drive import MechanismMotion, drive
from kinematics.linkage.planar.instant_centers import find_instant_centers
from kinematics.linkage.planar.limits import find_branches, find_limit_positions, find_reference_branch
from kinematics.linkage.planar.mechanism import GROUND, Mechanism
from tests.kinematics.mechanism_sampling import CLASS_THREE, DYADIC, EVERY, geared_fivebar, take

TURN = 2.0 * np.pi

FOURBAR = "A B O4"
DYADS: dict[str, tuple[str, ...]] = {
    "fourbar": (FOURBAR,),
    "slider-crank": ("A B on ground",),
    "slider-crank driven by its slider": ("B A O2",),
    "inverted slider-crank": ("O4 A on output",),
    "crank-shaper": ("O4 A on rocker", "C D on ground"),
    "Whitworth": ("O4 A on rocker", "C D on ground"),
    "geared fivebar": ("A C B",),
    "drag link and rocker": (FOURBAR, "C D O6"),
    "drag link and slider": (FOURBAR, "C D on ground"),
    "Peaucellier": ("O4 B A", "O4 C A", "B P C"),
    "watt_1 driven by its input": (FOURBAR, "C E D"),
    "watt_1 driven by its output": ("B A O2", "C E D"),
    "watt_2 driven by its input": (FOURBAR, "C D O6"),
    "watt_2 driven by its rocker": ("B A O2", "C D O6"),
    "watt_2 driven by its output": ("D C O4", "B A O2"),
    "stephenson_1 driven by its input": (FOURBAR, "C E D"),
    "stephenson_1 driven by its output": ("B A O2", "C E D"),
    "stephenson_3 driven by its input": (FOURBAR, "C D O6"),
    "stephenson_3 driven by its rocker": ("B A O2", "C D O6"),
    "dwell_rocker": (FOURBAR, "P D O6"),
    "dwell_slider": (FOURBAR, "P D on ground"),
    "dwell_slot": (FOURBAR, "O6 P on output"),
}
"""The dyads of each type: two pins with the joint between them, or two pins of a link one of which is on a line."""


def design(name: str, rng: np.random.Generator) -> Mechanism:
    """One of a type; with gears that bring it back."""
    made = geared_fivebar(rng, 1, -2.0) if name == "geared fivebar" else EVERY[name](rng, 1)
    return take(made, 0)


def direction(mechanism: Mechanism, motion: MechanismMotion, link: str) -> np.ndarray:
    """Direction of the line that is fixed in a link, at every input."""
    (slide,) = (s for s in mechanism.slides if s.link == link)
    turned = 0.0 if link == GROUND else motion.angles[link][0] - mechanism.link_angle(link)
    return np.exp(1j * (slide.angle + turned))


def sine(mechanism: Mechanism, motion: MechanismMotion, dyad: str) -> np.ndarray:
    """Sine of the transmission angle: between two links, or of a link and the normal of the line that it drives on."""
    one, other, *rest = dyad.split()
    z = {name: np.where(motion.valid, jet[0], n) for n, (name, jet) in enumerate(motion.joints.items())}
    along = (z[other] - z[one]) / np.abs(z[other] - z[one])
    if rest[0] == "on":
        return np.asarray(np.abs((np.conj(along) * direction(mechanism, motion, rest[1])).real))
    across = (z[other] - z[rest[0]]) / np.abs(z[other] - z[rest[0]])
    return np.asarray(np.abs((np.conj(along) * across).imag))


def test_every_type_that_closes_by_dyads_is_here() -> None:
    assert set(DYADS) == set(DYADIC)


@pytest.mark.parametrize("name", DYADS)
def test_transmission_angles_at_every_dyad(name: str) -> None:
    rng = np.random.default_rng([71, list(EVERY).index(name)])
    mechanism = EVERY[name](rng, 60)
    unit = 0.3 if mechanism.has_slide_input else 1.0
    at = mechanism.reference_input[:, None] + unit * rng.uniform(-1.0, 1.0, (60, 8))
    compared = 0
    for k in range(60):
        one = take(mechanism, k)
        motion = drive(one, at[k], order=0)
        mine = np.sort(np.abs(np.stack(list(motion.sines.values()))), axis=0)
        theirs = np.sort(np.stack([sine(one, motion, dyad) for dyad in DYADS[name]]), axis=0)
        assert mine.shape == theirs.shape
        sure = motion.valid & (np.nan_to_num(mine.min(axis=0)) > 1e-3)
        np.testing.assert_allclose(mine[:, sure], theirs[:, sure], atol=1e-9)
        compared += int(sure.sum())
    assert compared > 150


class Nearby(NamedTuple):
    """The angle of a link, or the position of a slide, as a function of the input, on the turn of a value nearby."""

    mechanism: Mechanism
    name: str
    turns: bool
    value: float
    sign: float

    def __call__(self, at: float) -> float:
        motion = drive(self.mechanism, np.array([at]), order=0)
        found = float((motion.angles if self.turns else motion.slides)[self.name][0, 0])
        return self.sign * (found - self.turns * TURN * round((found - self.value) / TURN))


@pytest.mark.parametrize("name", EVERY)
def test_limit_positions_are_the_extremes_along_the_branch(name: str) -> None:
    """No sampled position lies beyond them, and each is where the best of the samples leads."""
    rng = np.random.default_rng([72, list(EVERY).index(name)])
    bounded = 0
    for _ in range(3):
        mechanism = design(name, rng)
        here = find_reference_branch(mechanism, find_branches(mechanism))
        assert here is not None
        links = [link for link in mechanism.links if link != GROUND]
        slides = list(mechanism.slide_names)
        at = float(mechanism.reference_input)
        low = here.low if mechanism.has_slide_input else at - float(np.mod(at - here.low, 1e9 if here.full else TURN))
        low = at if here.full else low
        way = here.high - here.low
        share = 0.5 - 0.5 * np.cos(np.pi * np.linspace(0.0, 1.0, 3001)[1:-1])
        grid = low + way * (np.linspace(0.0, 1.0, 3001) if here.full else share)

        motion = drive(mechanism, grid, order=0)
        grid, known = grid[motion.valid], float(motion.valid.mean())
        assert known > 0.99
        of_links, of_slides = find_limit_positions(mechanism, here, links, slides)
        z = np.array([complex(joint) for joint in mechanism.joints.values()])
        size = float(np.abs(z[:, None] - z).max())
        spans = [(motion.angles[n], span, 1.0) for n, span in zip(links, of_links, strict=True)]
        spans += [(motion.slides[n], span, size) for n, span in zip(slides, of_slides, strict=True)]
        for row, (jet, span, scale) in enumerate(spans):
            turns = row < len(links)
            value = np.unwrap(jet[0, motion.valid]) if turns else jet[0, motion.valid]
            if span is None:
                assert turns
                assert np.ptp(value) > 0.999 * TURN
                continue
            if turns:
                value = value - TURN * np.round((value.min() + value.max() - sum(span)) / (2.0 * TURN))
            for sign, limit in ((1.0, span[0]), (-1.0, span[1])):
                best = int(np.argmin(sign * value))
                assert sign * (value[best] - limit) > -1e-9 * scale, (name, row, "beyond a limit")
                if not 0 < best < len(value) - 1:
                    assert abs(value[best] - limit) < 1e-2 * scale, (name, row, "at an end")
                    continue
                nearby = Nearby(mechanism, (links + slides)[row], turns, float(value[best]), sign)
                found = minimize_scalar(nearby, bounds=(grid[best - 1], grid[best + 1]), method="bounded")
                assert sign * found.fun == pytest.approx(limit, abs=1e-8 * scale), (name, row)
                bounded += 1
    assert bounded > 0


@pytest.mark.parametrize("name", EVERY)
def test_two_links_carry_their_instant_centre_alike(name: str) -> None:
    """From a little before to a little after, a point of either link that stands at the centre makes the same way."""
    rng = np.random.default_rng([73, list(EVERY).index(name)])
    compared = 0
    for _ in range(4):
        mechanism = design(name, rng)
        z = np.array([complex(joint) for joint in mechanism.joints.values()])
        size = float(np.abs(z[:, None] - z).max())
        step = 1e-5 * (size if mechanism.has_slide_input else 1.0)
        at = mechanism.reference_input + np.array([-step, 0.0, step])
        motion = drive(mechanism, at, order=1)
        sines = [np.abs(s).min() for s in motion.sines.values()]
        if not motion.smooth.all() or (sines and min(sines) < 0.1):
            continue
        centers = find_instant_centers(mechanism, motion)
        count = len(mechanism.links)
        assert len(centers) == count * (count - 1) // 2

        def carried(
            link: str, point: complex, mechanism: Mechanism = mechanism, motion: MechanismMotion = motion
        ) -> complex:
            """Way of a point of a link that stands there at the middle input."""
            if link == GROUND:
                return 0j
            joint = motion.joints[mechanism.links[link][0]][0]
            turned = np.exp(1j * (motion.angles[link][0] - motion.angles[link][0][1]))
            ends = joint + (point - joint[1]) * turned
            return complex(ends[2] - ends[0])

        for (one, other), center in centers.items():
            if not center.finite[1]:
                continue
            point = complex(center.point[1])
            reach = size + abs(point - z[0])
            assert abs(carried(one, point) - carried(other, point)) < 1e-4 * step * reach
            for joint in set(mechanism.links[one]) & set(mechanism.links[other]):
                assert point == pytest.approx(complex(motion.joints[joint][0][1]), abs=1e-9 * reach)
            compared += 1
        for a, b, c in combinations(mechanism.links, 3):
            three = [centers[pair] for pair in ((a, b), (b, c), (a, c))]
            if all(center.finite[1] for center in three):
                p, q, r = (complex(center.point[1]) for center in three)
                area = abs((np.conj(q - p) * (r - p)).imag)
                assert area <= 1e-7 * (abs(q - p) + abs(r - p) + size) ** 2, "Kennedy: on one line"
    assert compared > 0


def test_class_three_is_here_too() -> None:
    assert set(EVERY) == set(DYADS) | set(CLASS_THREE)
