"""A planar linkage of pins by the loops of its links, from its skeleton alone; nothing of the product is called.

Around a loop of links the vectors from pin to pin add up to nothing. Each link's vector turns with the link, so that
the loops are Σ e^{iφ} (q_out − q_in) = 0 in the rotations φ from the reference, one complex equation each. SciPy solves
them, in small steps of the input from the reference. The determinant of their Jacobian vanishes where branches meet: as
long as it keeps its sign, the linkage stays on one branch.
"""

from __future__ import annotations

import itertools
from typing import Any, NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.optimize import root

STEP = 0.01
"""Radians of the input from one solution to the next."""


class Followed(NamedTuple):
    """P and the rotation of the link with it at inputs, and how the linkage came there.

    ``branch``: the least determinant on the way over its value at the start; positive on one branch. ``angles``: the
    least angle between two links at any moving pin on the way, degrees, by the pin and the links. ``places``: the
    joints at each step of the way.
    """

    points: np.ndarray
    turns: np.ndarray
    branch: float
    angles: dict[tuple[str, str, str], float]
    places: list[dict[str, complex]]


class Loops:
    """The loops of a skeleton as JSON has it."""

    def __init__(self, skeleton: dict[str, Any]) -> None:
        self.joints = {name: complex(*place) for name, place in skeleton["joints"].items()}
        self.links = {link["name"]: link["joints"] for link in skeleton["links"]}
        self.input = skeleton["input_link"]
        self.body = next((name for name, listed in self.links.items() if "P" in listed), None)
        self.moving = [name for name in self.links if name not in ("ground", self.input)]
        self.triad = self._legs()
        self.loops = self._loops()
        assert len(self.moving) == 2 * len(self.loops), "a linkage of pins with one freedom"

    def _legs(self) -> list[str]:
        """The legs of a triad: three moving links with a pin on a fourth, and one on the input or the ground."""
        for carried in self.moving:
            ends = [set(self.links["ground"]), set(self.links[self.input])]
            legs = [
                name
                for name in self.moving
                if name != carried
                and len(set(self.links[name]) & set(self.links[carried]) - {"P"}) == 1
                and any(set(self.links[name]) & end for end in ends)
            ]
            if len(legs) == 3:
                return legs
        return []

    def _loops(self) -> list[list[tuple[str, complex]]]:
        """Independent loops: of a tree of links from the ground, one for each pin that the tree leaves out."""
        pins = [(joint, [name for name, listed in self.links.items() if joint in listed]) for joint in self.joints]
        pins = [(joint, on) for joint, on in pins if len(on) == 2]
        to: dict[str, tuple[str, str]] = {}
        reached, left = ["ground"], []
        for link in reached:
            for joint, on in pins:
                if link in on:
                    other = on[1 - on.index(link)]
                    if other not in reached:
                        to[other] = link, joint
                        reached.append(other)
        for joint, on in pins:
            if all(to.get(one) != (other, joint) for one, other in (on, on[::-1])):
                left.append((joint, on))

        def way(link: str, end: str) -> list[tuple[str, complex]]:
            """From the ground to a pin of a link: each link with the vector along it."""
            vectors = []
            while link != "ground":
                before, joint = to[link]
                vectors.append((link, self.joints[end] - self.joints[joint]))
                link, end = before, joint
            return [*vectors, ("ground", self.joints[end])]

        return [[*way(on[0], joint), *((name, -z) for name, z in way(on[1], joint))] for joint, on in left]

    def residuals(self, turns: np.ndarray, at: float) -> np.ndarray:
        phi = {"ground": 0.0, self.input: at, **dict(zip(self.moving, turns, strict=True))}
        sums = [sum(z * np.exp(1j * phi[name]) for name, z in loop) for loop in self.loops]
        return np.array([part for s in sums for part in (s.real, s.imag)])

    def jacobian(self, turns: np.ndarray, at: float) -> np.ndarray:
        rows = np.zeros((2 * len(self.loops), len(self.moving)))
        for n, loop in enumerate(self.loops):
            for name, z in loop:
                if name in self.moving:
                    k = self.moving.index(name)
                    by = 1j * z * np.exp(1j * turns[k])
                    rows[2 * n, k] += by.real
                    rows[2 * n + 1, k] += by.imag
        return rows

    def places(self, turns: np.ndarray, at: float) -> dict[str, complex]:
        """All joints, link by link from the ground."""
        phi = {"ground": 0.0, self.input: at, **dict(zip(self.moving, turns, strict=True))}
        known = {joint: self.joints[joint] for joint in self.links["ground"]}
        waiting = [name for name in self.links if name != "ground"]
        while waiting:
            link = next(name for name in waiting if set(self.links[name]) & set(known))
            pin = next(joint for joint in self.links[link] if joint in known)
            for joint in self.links[link]:
                turned = np.exp(1j * phi[link]) * (self.joints[joint] - self.joints[pin])
                known.setdefault(joint, complex(known[pin] + turned))
            waiting.remove(link)
        return known

    def followed(self, inputs: np.ndarray) -> Followed:
        """The linkage at input rotations from the reference, radians, one after the other."""
        turns, at = np.zeros(len(self.moving)), 0.0
        start = np.linalg.det(self.jacobian(turns, at))
        least, points, turned = 1.0, [], []
        angles: dict[tuple[str, str, str], float] = {}
        way = [self.places(turns, at)]
        for goal in inputs:
            for step in np.linspace(at, goal, max(2, int(abs(goal - at) / STEP) + 2))[1:]:
                turns, at = self._next(turns, at, float(step)), float(step)
                least = min(least, np.linalg.det(self.jacobian(turns, at)) / start)
                way.append(self.places(turns, at))
                self._note(way[-1], angles)
            points.append(way[-1]["P"])
            turned.append(turns[self.moving.index(self.body)])
        return Followed(np.array(points), np.array(turned), float(least), angles, way)

    def _next(self, turns: np.ndarray, at: float, step: float) -> np.ndarray:
        """Rotations at an input that is near to another one, from those there."""
        rate = -np.linalg.solve(self.jacobian(turns, at), self._by_input(at))
        solved = root(
            self.residuals, turns + (step - at) * rate, (step,), method="hybr",
            jac=self.jacobian, options={"xtol": 1e-14},
        )  # fmt: skip
        size = max(map(abs, self.joints.values()))
        assert np.abs(self.residuals(solved.x, step)).max() < 1e-9 * size, "the loops do not close"
        return solved.x

    def turned(self, steps: int) -> dict[str, np.ndarray]:
        """Rotations of the moving links, radians, at so many even steps of a whole turn of the input, both ends among
        them: by splines through those of every half degree, and Newton's method from there."""
        coarse = np.linspace(0.0, 2.0 * np.pi, 721)
        followed = [np.zeros(len(self.moving))]
        for at, step in itertools.pairwise(coarse):
            followed.append(self._next(followed[-1], at, step))
        inputs = np.linspace(0.0, 2.0 * np.pi, steps)
        turns = CubicSpline(coarse, np.array(followed))(inputs)
        for _ in range(3):
            rows = np.array([self.residuals(at, angle) for at, angle in zip(turns, inputs, strict=True)])
            slopes = np.array([self.jacobian(at, angle) for at, angle in zip(turns, inputs, strict=True)])
            turns -= np.linalg.solve(slopes, rows[:, :, None])[:, :, 0]
        assert np.abs(rows).max() < 1e-9 * max(map(abs, self.joints.values()))
        return dict(zip(self.moving, turns.T, strict=True))

    def pushed(self, places: dict[str, complex], link: str) -> float:
        """The transmission angle of a link at the ground or the input, degrees, by the forces at all pins.

        The link alone is loaded, by a torque of 1. Its pin's force f at a distance r from its pivot has the torque
        f r sin μ = 1, whatever the chain between it and the input is.
        """
        pins = [
            (joint, on)
            for joint in places
            if len(on := [n for n, listed in self.links.items() if joint in listed]) == 2
        ]
        bodies = [name for name in self.links if name != "ground"]
        balance = np.zeros((3 * len(bodies), 2 * len(pins) + 1))
        for k, (joint, on) in enumerate(pins):
            x, y = places[joint].real, places[joint].imag
            for sign, name in ((1.0, on[0]), (-1.0, on[1])):
                if name != "ground":
                    row = 3 * bodies.index(name)
                    balance[row : row + 3, 2 * k : 2 * k + 2] = sign * np.array([[1.0, 0.0], [0.0, 1.0], [-y, x]])
        balance[3 * bodies.index(self.input) + 2, -1] = 1.0
        load = np.zeros(len(balance))
        load[3 * bodies.index(link) + 2] = -1.0
        forces = np.linalg.solve(balance, load)
        held = {*self.links["ground"], *self.links[self.input]}
        own = [joint for joint, on in pins if link in on]
        pivot, pin = (next(joint for joint in own if (joint in held) == outer) for outer in (True, False))
        k = next(n for n, (joint, _) in enumerate(pins) if joint == pin)
        lever = np.hypot(*forces[2 * k : 2 * k + 2]) * abs(places[pin] - places[pivot])
        return float(np.degrees(np.arcsin(min(1.0 / lever, 1.0))))

    def transmission(self, met: Followed, dyads: dict[str, str]) -> dict[str, float]:
        """The least transmission angles on a way, degrees, by links: of dyads by their pins; else at all three legs."""
        if self.triad:
            return {link: min(self.pushed(places, link) for places in met.places) for link in self.triad}
        return {
            link: min(value for (joint, *on), value in met.angles.items() if joint == pin and link in on)
            for link, pin in dyads.items()
        }

    def _by_input(self, at: float) -> np.ndarray:
        rates = [sum(1j * z * np.exp(1j * at) for name, z in loop if name == self.input) for loop in self.loops]
        return np.array([part for s in rates for part in (complex(s).real, complex(s).imag)])

    def _note(self, places: dict[str, complex], angles: dict[tuple[str, str, str], float]) -> None:
        """Angles between the first pin of one link, a pin that it shares with another, and that one's first pin."""
        for joint in places:
            on = [name for name, listed in self.links.items() if joint in listed and name != "ground"]
            for n, one in enumerate(on):
                for other in on[n + 1 :]:
                    ends = [next(j for j in self.links[name] if j not in (joint, "P")) for name in (one, other)]
                    arms = [places[joint] - places[end] for end in ends]
                    turn = abs(np.angle(arms[0] / arms[1]))
                    angle = float(np.degrees(min(turn, np.pi - turn)))
                    key = joint, one, other
                    angles[key] = min(angles.get(key, 90.0), angle)
