"""Counterweights that balance the shaking force of any planar linkage, exactly.

The linearly independent vectors of Berkof and Lowen (A new method for completely force balancing simple linkages,
J. Eng. Ind. 91, 1969; Norton, *Design of Machinery*, 12.6-12.8), without setting up loop equations: no force shakes
the frame in any motion if the momentum by the input, P(q) = Σ m r', vanishes at all positions. A weight of mass μ and
of first moment c about a joint O of its link adds

    μ O' + i φ' c e^{iφ},

which is linear in μ and c; about a fixed pivot μ does not count. Over many generic positions that is a linear system,
and it has a solution if and only if the closure of the loops lets the weights cancel the momentum.

With masses on its links alone a linkage can be balanced if each link reaches the ground by a path of pins (Tepper and
Lowen, General theorems concerning full force balancing of planar linkages by internal mass redistribution, J. Eng. Ind.
94, 1972); :func:`unpinned` lists those that do not.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.dynamics.bodies import Body, body
from kinematics.dynamics.machine import Machine
from kinematics.dynamics.places import Places
from kinematics.linkage.planar.mechanism import GROUND, Mechanism
from synthesis.analyses.driven import Task, placed
from synthesis.kinds.balancing.driven import inertial, moving, on_fixed_pivot, pivot
from synthesis.kinds.balancing.stated_weights import Counterweights
from synthesis.numerics.conic import Rows, minimized

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

GENERIC = 97
"""Number of positions of the linear system: prime, so that no symmetry of a motion coincides with them."""

VANISHES = 1e-9
"""Share of the momentum of all separate parts that is attributed to rounding."""

DEPENDENT = 1e-11
"""Singular value, as a share of the largest, below which columns count as dependent."""

NO_WEIGHT = 1e-12
"""Share of the largest first moment below which a weight is omitted."""

IDLE = 1e-6
"""Share of the largest mass below which a weight on a link without a fixed pivot is the program's tolerance."""

MOST_SETS = 200
"""Maximum number of sets of links that are tried."""


class Weight(NamedTuple):
    """A counterweight: its link, mass, place in the reference and inertia, in the units of the forces."""

    link: str
    mass: float
    at: complex
    inertia: float

    @property
    def body(self) -> Body:
        """The weight as a body."""
        return body(self.mass, self.at, self.inertia)


def momentum(machine: Machine, paced: Places) -> tuple[Complex, float]:
    """Compute Σ m r' over positions, and the largest sum of the magnitudes of its parts."""
    parts = [np.asarray(part.mass)[..., None] * paced.point(link, part.cg)[1] for link, part in machine.bodies.items()]
    parts += [np.asarray(mass)[..., None] * paced.joints[joint][1] for joint, mass in machine.pin_masses.items()]
    return np.asarray(sum(parts)), float(sum(np.abs(part) for part in parts).max())


def force_balances(task: Task, stated: Counterweights) -> list[list[Weight]]:
    """Find sets of counterweights that balance the shaking force; none if no set does.

    One set on links that the client names; else all sets of as few links as possible, those on fixed pivots first,
    then the lightest.
    """
    machine = inertial(task.machine)
    system = _System(machine, _generic(task), stated)
    if stated.links is not None:
        found = system.weights(stated.links)
        return [] if found is None else [found]
    links = moving(machine.mechanism)
    fixed = [link for link in links if on_fixed_pivot(machine.mechanism, link)]
    for candidates in (fixed, links):
        # If weights on all candidates cannot balance the force, no subset can.
        if not system.solvable(candidates):
            continue
        tried = 0
        for count in range(len(candidates) + 1):
            sets = []
            for chosen in combinations(candidates, count):
                tried += 1
                if tried <= MOST_SETS and system.solvable(chosen) and (found := system.weights(chosen)) is not None:
                    sets.append(found)
            if sets:
                return sorted(sets, key=lambda weights: sum(weight.mass for weight in weights))
        found = system.weights(candidates)
        return [] if found is None else [found]
    return []


def balanceable(task: Task) -> bool:
    """Return whether weights on all moving links could balance the force."""
    machine = inertial(task.machine)
    return _System(machine, _generic(task), Counterweights()).solvable(moving(machine.mechanism))


def unpinned(mechanism: Mechanism) -> list[str]:
    """List the links from which no path of pins leads to the ground."""
    reached, ahead = {GROUND}, [GROUND]
    while ahead:
        joints = mechanism.links[ahead.pop()]
        for link, listed in mechanism.links.items():
            if link not in reached and set(listed) & set(joints):
                # Two links are pinned together if they share a joint; slides do not count.
                reached.add(link)
                ahead.append(link)
    return [link for link in mechanism.links if link not in reached]


def _generic(task: Task) -> Real:
    """Choose positions over the range, none at its ends."""
    # An irrational-looking offset keeps the positions away from ends, middle and other special places.
    shares = (np.arange(GENERIC) + 0.382) / GENERIC
    return np.asarray(task.start + (task.end - task.start) * shares)


class _System:
    """The linear system of a machine's momentum at generic positions."""

    def __init__(self, machine: Machine, at: Real, stated: Counterweights) -> None:
        self.machine, self.stated = machine, stated
        self.mechanism = machine.mechanism
        paced = placed(machine, at)
        known = paced.smooth
        total, self.size = momentum(machine, paced)
        self.total = _real(total[known])
        self.turning = {}
        self.carried = {}
        for link in moving(self.mechanism):
            turn = paced.turns[link][1][known]
            self.turning[link] = np.stack([_real(turn), _real(1j * turn)], axis=1)
            self.carried[link] = _real(paced.joints[pivot(self.mechanism, link)][1][known])

    def solvable(self, links: Sequence[str]) -> bool:
        """Return whether weights of any mass on these links can cancel the momentum."""
        loose = [link for link in links if not on_fixed_pivot(self.mechanism, link)]
        columns = [*(self.turning[link] for link in links), *(self.carried[link][:, None] for link in loose)]
        return self._solution(columns, self.total) is not None

    def weights(self, links: Sequence[str]) -> list[Weight] | None:
        """Find the weights on these links; None if they cannot balance the force."""
        loose = [link for link in links if not on_fixed_pivot(self.mechanism, link)]
        columns = [self.turning[link] for link in links]
        masses = dict.fromkeys(links, self.stated.mass)
        if loose and self.stated.mass is None:
            found = self._lightest(links, loose)
            if found is None:
                return None
            moments, masses = found
            used = [link for link in links if link not in loose or masses[link] > IDLE * max(masses.values())]
            # Masses at the program's tolerance are dropped if the rest still balances.
            if len(used) < len(links) and (without := self.weights(used)) is not None:
                return without
        else:
            carried = sum((self.stated.mass or 0.0) * self.carried[link] for link in loose)
            solved = self._solution(columns, self.total + carried)
            if solved is None:
                return None
            moments = dict(zip(links, (solved[0::2] + 1j * solved[1::2]).tolist(), strict=True))
        # Negligible weights are dropped, except on links whose mass is carried.
        largest = max((abs(moment) for moment in moments.values()), default=0.0)
        return [
            self._weight(link, moment, masses[link])
            for link, moment in moments.items()
            if abs(moment) > NO_WEIGHT * largest or link in loose
        ]

    def _weight(self, link: str, moment: complex, mass: float | None) -> Weight:
        about = complex(self.machine.scale * self.mechanism.joints[pivot(self.mechanism, link)])
        mass = abs(moment) / self._radius(link) if mass is None else mass
        at = about + (moment / mass if mass > 0.0 else 0j)
        return Weight(link, mass, at, self.stated.inertia(mass, self.machine.scale))

    def _radius(self, link: str) -> float:
        """Return the radius of a weight on a link: the given one, or the length of the link."""
        if self.stated.radius is not None:
            return self.machine.scale * self.stated.radius
        first, second = (complex(self.mechanism.joints[joint]) for joint in self.mechanism.link_line(link))
        return self.machine.scale * abs(second - first)

    def _solution(self, columns: Sequence[Real], total: Real) -> Real | None:
        """Solve for the least coefficients with which the columns cancel a total; None if there are none."""
        if not columns:
            return np.zeros(0) if np.abs(total).max() <= VANISHES * self.size else None
        matrix = np.concatenate(columns, axis=1)
        # Columns are normalized, so that the rank tolerance does not depend on units.
        sizes = np.linalg.norm(matrix, axis=0)
        sizes[sizes == 0.0] = 1.0
        found = np.linalg.lstsq(matrix / sizes, -total, rcond=DEPENDENT)[0] / sizes
        left = np.abs(matrix @ found + total).max()
        return np.asarray(found) if left <= VANISHES * self.size else None

    def _lightest(self, links: Sequence[str], loose: list[str]) -> tuple[dict[str, complex], dict[str, float]] | None:
        """Find moments and masses of minimum total mass, with no weight farther out than its radius.

        The masses of weights on links without a fixed pivot count in the momentum. The program is a second-order cone
        program; its answer is corrected by the least change that solves the linear system, to rounding.
        """
        columns = [*(self.turning[link] for link in links), *(self.carried[link][:, None] for link in loose)]
        if (start := self._solution(columns, self.total)) is None:
            return None
        matrix = np.concatenate(columns, axis=1)
        sizes = np.linalg.norm(matrix, axis=0)
        sizes[sizes == 0.0] = 1.0
        _, values, rows = np.linalg.svd(matrix / sizes, full_matrices=False)
        kept = rows[values > DEPENDENT * values[0]] * sizes  # combinations of x that the positions determine
        count, turned = len(links) + 2 * len(links), 2 * len(links)
        # Unknowns: moments, masses of the loose links, masses of the others; in units of a mass on a link.
        unit = max(float(np.abs(start).max()), 1e-300)
        order = [*loose, *(link for link in links if link not in loose)]
        equal = np.zeros((len(kept), count))
        equal[:, : kept.shape[1]] = kept
        scale = np.abs(equal).max(axis=1)
        cones = np.zeros((3 * len(links), count))
        # |moment| ≤ radius · mass of every weight.
        for n, link in enumerate(links):
            cones[3 * n, turned + order.index(link)] = -self._radius(link)
            cones[3 * n + 1, 2 * n] = cones[3 * n + 2, 2 * n + 1] = -1.0
        cost = np.concatenate([np.zeros(turned), np.ones(len(links))])
        solution = minimized(
            cost,
            [
                Rows("zero", equal / scale[:, None], equal[:, : len(start)] @ start / unit / scale),
                Rows("second_order", cones, np.zeros(3 * len(links)), 3),
            ],
        )
        if solution.status != "solved":
            return None
        # The cone program is only accurate to its tolerance; the next step removes the residual.
        near = unit * solution.x
        x = near[: turned + len(loose)]
        x = x + np.linalg.lstsq(kept, kept @ (start - x), rcond=None)[0]
        moments = dict(zip(links, (x[0:turned:2] + 1j * x[1:turned:2]).tolist(), strict=True))
        masses = dict(zip(order, [*x[turned:].tolist(), *near[turned + len(loose) :].tolist()], strict=True))
        if min(masses.values()) < 0.0:
            masses = {link: max(mass, 0.0) for link, mass in masses.items()}
        return moments, masses


def _real(values: Complex) -> Real:
    """Stack real and imaginary parts of complex values."""
    return np.concatenate([values.real, values.imag])
