"""All constraints of a mechanism at once, for mechanisms with redundant constraints.

A parallelogram with a third crank moves because its dimensions agree, although a count of its links and joints gives no
freedom. Dyads cannot show that, since they ignore redundant constraints. Here the unknowns are the poses of all moving
links, z + (p − p₀) e^{iφ} for the point p of the reference, p₀ the link's first joint, and

    pin     point of a link = point of the hub, the first link at that joint      two equations
    slide   Re(n̄ (joint − point of the line)) = 0, n the line's normal            one
    gears   rotation of the second − ratio × rotation of the first = 0            one
    input   rotation of the input link, or Re(t̄ (joint − point of the line)),     one
            minus the given input

are more equations than unknowns. Their rank gives the mobility (unknowns − rank of all but the input's equation). Least
squares give poses from nearby poses and, derivative by derivative, the rates: the n-th derivative of every equation is
its Jacobian times the n-th derivatives of the unknowns, plus terms that are known by then.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex, Integers, Mask, Real

MAX_MISFIT = 3e-6
"""Maximum misfit, as a share of the size, at which constraints count as satisfied: dimensions may be rounded."""

RANK_TOLERANCE = 1e-5
"""Singular value, as a share of the largest, below which constraints of rounded dimensions are dependent."""

MIN_INPUT_MOVE = 0.2
"""Displacement of the input from the reference, radians or shares of the size, that proves that a mechanism moves."""

MIN_STEP = 1e-9
"""Step of the input, radians or shares of the size, below which the motion from the reference ends."""

MAX_TRIALS = 100
"""Maximum number of steps, including rejected ones."""

LIMIT_RATIO = 0.1
"""Smallest singular value, as a share of its maximum along the motion, below which an end is a limit of the motion:
near a limit it goes with the root of the distance. At an end where constraints disagree it hardly changes."""

MAX_STEP_ROTATION = 0.5
"""Rotation of a link in one step, radians, above which the step may have reached another assembly."""

MIN_SINGULAR_VALUE = 1e-6
"""Smallest singular value, as a share of the largest, below which rates are undefined: the error of accelerations goes
with rounding over its square, about 1e-5 at this limit."""

MAX_ITERATIONS = 60
"""Maximum number of Gauss-Newton steps. Starting from a dyad's position two usually suffice; near a change point every
step only halves the error, and the misfit is its square."""

STEP_TOLERANCE = 1e-10
"""Step, as a share of the size or in radians, below which the iteration has converged."""

SINGULAR_STEP_TOLERANCE = 1e-14
"""The same near a singular position, times the smallest singular value: rounding moves poses by this amount there."""


class Poses(NamedTuple):
    """Positions of the links' first joints and rotations from the reference, as jets of shape (n, links, M)."""

    places: Complex
    rotations: Real

    @classmethod
    def unknown(cls, length: int, links: int, count: int) -> Poses:
        """Make unknown poses, filled with NaN."""
        return cls(np.full((length, links, count), np.nan + 0j), np.full((length, links, count), np.nan))

    def take(self, which: Mask | Integers) -> Poses:
        """Select the poses at some positions."""
        return Poses(self.places[:, :, which], self.rotations[:, :, which])

    def measure_distance(self, which: Mask | Integers, others: Poses) -> Real:
        """Measure the distance of other poses from those at some positions, shape (M,); NaN where these are unknown."""
        places = np.abs(self.places[0, :, which].T - others.places[0]).max(axis=0)
        return np.asarray(np.maximum(places, np.abs(self.rotations[0, :, which].T - others.rotations[0]).max(axis=0)))

    def store(self, which: Mask | Integers, others: Poses) -> None:
        """Store poses at some positions."""
        self.places[:, :, which], self.rotations[:, :, which] = others


class Constraints:
    """The constraints of M designs (or positions) in unit coordinates.

    Parameters
    ----------
    joints : mapping of str to complex, shape (M,)
        Positions in the reference.
    links : mapping of str to sequence of str
        Joints of every link; ``ground`` is the fixed one.
    slides : sequence of (joint, link, point, angle)
        Points and angles in the reference, shape (M,).
    gears : sequence of (first, second, ratio)
    input : str
        A link, or the joint of a slide on the ground.
    """

    def __init__(
        self,
        joints: Mapping[str, Complex],
        links: Mapping[str, Sequence[str]],
        slides: Sequence[tuple[str, str, Complex, Real]],
        gears: Sequence[tuple[str, str, float]],
        input: str,
        ground: str,
    ) -> None:
        self.links = tuple(link for link in links if link != ground)
        number = {link: n for n, link in enumerate(self.links)}
        number[ground] = len(self.links)
        self.bases = tuple(links[link][0] for link in self.links)
        self._base = np.stack([*(joints[joint] for joint in self.bases), np.zeros_like(next(iter(joints.values())))])
        hubs = {joint: next(link for link, listed in links.items() if joint in listed) for joint in joints}
        self._joints = {joint: (number[hub], joints[joint]) for joint, hub in hubs.items()}
        self._pins = [
            (number[link], number[hubs[joint]], joints[joint])
            for joint in joints
            for link, listed in links.items()
            if joint in listed and link != hubs[joint]
        ]
        self._slides = [
            (number[hubs[joint]], joints[joint], number[link], point, 1j * np.exp(1j * angle))
            for joint, link, point, angle in slides
        ]
        self._gears = [(number[first], number[second], ratio) for first, second, ratio in gears]
        self._input = number.get(input)
        if self._input is None:
            hub, at, on, point, normal = next(
                line
                for line, (joint, link, _, _) in zip(self._slides, slides, strict=True)
                if joint == input and link == ground
            )
            self._along = hub, at, on, point, -1j * normal

    @property
    def reference(self) -> Poses:
        """Poses of the reference."""
        places = self._base[None, :-1].copy()
        return Poses(places, np.zeros(places.shape))

    def get_input(self, poses: Poses) -> Real:
        """Return the input, shape (n, M)."""
        return self._evaluate_input(self._evaluate_jets(poses))

    def settle(self, start: Poses, input: Real) -> tuple[Poses, Real, Real]:
        """Solve for poses that satisfy all constraints, and their derivatives, from nearby poses.

        Parameters
        ----------
        start : Poses
            Poses nearby, shape (1, links, M).
        input : float, shape (n, M)
            Input relative to the reference, and its rates.

        Returns
        -------
        poses : Poses, shape (n, links, M)
        misfit : float, shape (M,)
            Largest remaining residual; infinite if the iteration has not converged.
        least : float, shape (M,)
            Smallest singular value of the Jacobian as a share of the largest: 0 where the input does not determine
            the motion of the links.
        """
        poses = start
        for _ in range(MAX_ITERATIONS):
            jets = self._evaluate_jets(poses)
            inverse, least = self._invert_jacobian(jets)
            change = self._compute_step(inverse, self._compute_residuals(jets, input[:1])[0])
            poses = Poses(poses.places - change[0], poses.rotations - change[1])
            moved = np.maximum(np.abs(change[0]).max(axis=0), np.abs(change[1]).max(axis=0))
            # Both sides times the smallest singular value: near a singular position rounding limits the step.
            still = moved * least <= np.maximum(STEP_TOLERANCE * least, SINGULAR_STEP_TOLERANCE)
            if np.all(still | ~np.isfinite(moved)):
                break
        jets = self._evaluate_jets(poses)
        misfit = np.where(still, np.abs(self._compute_residuals(jets, input[:1])[0]).max(axis=0), np.inf)
        inverse, least = self._invert_jacobian(jets)
        for n in range(1, len(input)):
            further = np.zeros_like(poses.places[:1]), np.zeros_like(poses.rotations[:1])
            poses = Poses(*(np.concatenate([jet, none]) for jet, none in zip(poses, further, strict=True)))
            change = self._compute_step(inverse, self._compute_residuals(self._evaluate_jets(poses), input[: n + 1])[n])
            # With the unknown derivative set to zero, the residual equals the terms that it must cancel.
            poses.places[n], poses.rotations[n] = -change[0], -change[1]
        return poses, misfit, least

    def mobility(self, poses: Poses) -> NDArray[np.int64]:
        """Return the mobility: unknowns minus the rank of all constraints but the input's, shape (M,)."""
        jacobian = self._build_jacobian(self._evaluate_jets(poses))[:, :-1]
        unknowns = jacobian.shape[2]
        if not jacobian.shape[1]:
            return np.full(len(jacobian), unknowns)
        values = np.linalg.svd(jacobian, compute_uv=False)
        return np.asarray(unknowns - (values > RANK_TOLERANCE * values[:, :1]).sum(axis=1))

    def moves(self) -> bool:
        """Return whether the input can move all designs from the reference, in at least one direction.

        The motion is followed in steps along the tangent until it has moved :data:`MIN_INPUT_MOVE`, or to a limit.
        """
        at = self.get_input(self.reference)
        moved = np.zeros(at.shape[1], np.bool_)
        # A mechanism at a limit of its motion can move in one direction only.
        for way in (-1.0, 1.0):
            moved |= self._is_moving(at, way)
        return bool(moved.all())

    def _is_moving(self, at: Real, way: float) -> NDArray[np.bool_]:
        """Return which designs the input can move from the reference in one direction; see :meth:`moves`."""
        count = at.shape[1]
        rates = np.concatenate([at, np.full((1, count), way)])
        poses, _, least = self.settle(self.reference, rates)
        most, done = least.copy(), np.zeros(count)
        # Steps grow after success and shrink after failure.
        step = np.full(count, 0.25 * MIN_INPUT_MOVE)
        for _ in range(MAX_TRIALS):
            shown = (done >= MIN_INPUT_MOVE) | ((done > 0.0) & (least < LIMIT_RATIO * most))
            if not (~shown & (step > MIN_STEP)).any():
                break
            guess = Poses(poses.places[:1] + step * poses.places[1:], poses.rotations[:1] + step * poses.rotations[1:])
            tried, misfit, smallest = self.settle(guess, rates + np.array([[way], [0.0]]) * (done + step))
            turned = np.abs(tried.rotations[0] - poses.rotations[0]).max(axis=0)
            met = (
                (misfit <= MAX_MISFIT)
                & (turned <= MAX_STEP_ROTATION)
                & (smallest > MIN_SINGULAR_VALUE * most)
                & (done < MIN_INPUT_MOVE)
            )
            poses.store(met, tried.take(met))
            least = np.where(met, smallest, least)
            most = np.maximum(most, least)
            done = np.where(met, done + step, done)
            step = np.where(met, 1.5 * step, 0.5 * step)
        return (done >= MIN_INPUT_MOVE) | ((done > 0.0) & (least < LIMIT_RATIO * most))

    def misfit(self, poses: Poses, input: Real) -> Real:
        """Return the largest residual of poses of shape (1, links, M) at inputs (1, M), shape (M,); NaN for NaN."""
        return np.asarray(np.abs(self._compute_residuals(self._evaluate_jets(poses), input)[0]).max(axis=0))

    def points(self, poses: Poses) -> dict[str, Complex]:
        """Return the jets of all joints, shape (n, M) each."""
        jets = self._evaluate_jets(poses)
        return {joint: self._evaluate_point(jets, hub, at) for joint, (hub, at) in self._joints.items()}

    def travels(self, poses: Poses) -> list[Real]:
        """Return the jets of the slides' positions along their lines, from the lines' points; shape (n, M) each."""
        jets = self._evaluate_jets(poses)
        return [self._measure_along_line(jets, *line[:4], -1j * line[4]) for line in self._slides]

    def _evaluate_jets(self, poses: Poses) -> tuple[Complex, Complex, Real]:
        """Evaluate positions, e^{iφ} and φ of all links, the ground last; shape (n, links + 1, M)."""
        places, rotations = poses
        n, _, count = places.shape
        unit = np.empty(rotations.shape, np.complex128)
        unit[0] = np.exp(1j * rotations[0])
        if n > 1:
            unit[1] = 1j * rotations[1] * unit[0]
        if n > 2:
            unit[2] = (1j * rotations[2] - rotations[1] ** 2) * unit[0]
        if n > 3:
            w, alpha = rotations[1], rotations[2]
            unit[3] = (1j * (rotations[3] - w**3) - 3.0 * w * alpha) * unit[0]
        still = np.zeros((n, 1, count))
        standing = still + 0j
        standing[0] = 1.0
        return (
            np.concatenate([places, still + 0j], axis=1),
            np.concatenate([unit, standing], axis=1),
            np.concatenate([rotations, still], axis=1),
        )

    def _evaluate_point(self, jets: tuple[Complex, Complex, Real], link: int, at: Complex) -> Complex:
        places, unit, _ = jets
        return np.asarray(places[:, link] + unit[:, link] * (at - self._base[link]))

    def _evaluate_input(self, jets: tuple[Complex, Complex, Real]) -> Real:
        if self._input is not None:
            return jets[2][:, self._input]
        hub, at, on, point, along = self._along
        offset = self._evaluate_point(jets, hub, at) - self._evaluate_point(jets, on, point)
        return np.asarray((np.conj(along) * offset).real)

    def _measure_along_line(
        self, jets: tuple[Complex, Complex, Real], hub: int, at: Complex, on: int, point: Complex, direction: Complex
    ) -> Real:
        """Measure the jet of a joint's distance from a line's point, along a direction of the line's link; (n, M)."""
        offset = self._evaluate_point(jets, hub, at) - self._evaluate_point(jets, on, point)
        along = np.conj(jets[1][:, on] * direction)
        return np.stack(
            [
                np.sum([math.comb(n, j) * (along[j] * offset[n - j]).real for j in range(n + 1)], axis=0)
                for n in range(len(offset))
            ]
        )

    def _compute_residuals(self, jets: tuple[Complex, Complex, Real], input: Real) -> Real:
        """Compute all equations and their derivatives, shape (n, equations, M)."""
        rows: list[Real] = []
        for link, hub, at in self._pins:
            apart = self._evaluate_point(jets, link, at) - self._evaluate_point(jets, hub, at)
            rows += [apart.real, apart.imag]
        rows += [self._measure_along_line(jets, *line) for line in self._slides]
        for first, second, ratio in self._gears:
            turned = jets[2][:, second] - ratio * jets[2][:, first]
            # Gears couple rotations modulo full turns.
            turned[0] = np.remainder(turned[0] + np.pi, 2.0 * np.pi) - np.pi
            rows.append(turned)
        rows.append(self._evaluate_input(jets) - input)
        return np.stack(rows, axis=1)

    def _build_jacobian(self, jets: tuple[Complex, Complex, Real]) -> Real:
        """Build the Jacobian of the equations by x, y, φ of each link, shape (M, equations, 3 × links)."""
        count = jets[0].shape[2]
        moving = len(self.links)
        rows: list[NDArray[np.float64]] = []

        def add_row() -> Real:
            rows.append(np.zeros((3 * moving + 3, count)))
            return rows[-1]

        def add_derivative(into: Real, direction: Complex, link: int, at: Complex, sign: float) -> None:
            """Add the derivative of Re(conj(direction) · point of the link)."""
            arm = 1j * jets[1][0, link] * (at - self._base[link])
            into[3 * link] += sign * direction.real
            into[3 * link + 1] += sign * direction.imag
            into[3 * link + 2] += sign * (np.conj(direction) * arm).real

        right = np.ones(count, np.complex128)
        for link, hub, at in self._pins:
            for direction in (right, 1j * right):
                one = add_row()
                add_derivative(one, direction, link, at, 1.0)
                add_derivative(one, direction, hub, at, -1.0)
        for hub, at, on, point, normal in self._slides:
            across, one = jets[1][0, on] * normal, add_row()
            add_derivative(one, across, hub, at, 1.0)
            add_derivative(one, across, on, point, -1.0)
            offset = (self._evaluate_point(jets, hub, at) - self._evaluate_point(jets, on, point))[0]
            one[3 * on + 2] += (np.conj(1j * across) * offset).real
        for first, second, ratio in self._gears:
            one = add_row()
            one[3 * second + 2] += 1.0
            one[3 * first + 2] -= ratio
        one = add_row()
        if self._input is not None:
            one[3 * self._input + 2] += 1.0
        else:
            hub, at, _, _, along = self._along
            add_derivative(one, along + 0j * right, hub, at, 1.0)
        return np.moveaxis(np.stack(rows), 2, 0)[:, :, : 3 * moving]

    def _invert_jacobian(self, jets: tuple[Complex, Complex, Real]) -> tuple[Real, Real]:
        """Compute the pseudoinverse of the Jacobian, and its smallest singular value over the largest."""
        jacobian = self._build_jacobian(jets)
        known: NDArray[np.bool_] = np.asarray(np.isfinite(jacobian).all(axis=(1, 2)))
        left, values, right = np.linalg.svd(np.where(known[:, None, None], jacobian, 0.0), full_matrices=False)
        largest = values[:, :1]
        # Dependent constraints are dropped from the pseudoinverse.
        kept = values > 1e-9 * largest
        inverse = np.where(kept, 1.0 / np.where(kept, values, 1.0), 0.0)
        least = np.where(known, values[:, -1] / np.where(largest[:, 0] > 0.0, largest[:, 0], 1.0), np.nan)
        return np.swapaxes(right, 1, 2) * inverse[:, None, :] @ np.swapaxes(left, 1, 2), least

    def _compute_step(self, inverse: Real, residuals: Real) -> tuple[Complex, Real]:
        """Compute changes of positions and rotations, shape (links, M), for residuals of shape (equations, M)."""
        change = np.einsum("mij,jm->im", inverse, residuals).reshape(-1, 3, residuals.shape[1])
        return change[:, 0] + 1j * change[:, 1], change[:, 2]


__all__ = ["MAX_MISFIT", "RANK_TOLERANCE", "Constraints", "Poses"]
