"""Counterweights that balance the shaking force of any planar linkage exactly.

This is the method of linearly independent vectors of Berkof and Lowen (A new method for completely force balancing
simple linkages, J. Eng. Ind. 91, 1969; Norton, *Design of Machinery*, 12.6-12.8), without loop equations. No force
shakes the frame in any motion if the momentum per unit of input speed, P(q) = Σ m r', vanishes at all positions. A
weight of mass μ and of first moment c about a joint O of its link adds

    μ O' + i φ' c e^{iφ},

which is linear in μ and c. About a fixed pivot μ has no effect. Over many generic positions this is a linear system,
which has a solution if and only if the closure of the loops lets the weights cancel the momentum.

Masses on the links alone can balance a linkage if each link reaches the ground by a path of pins (Tepper and
Lowen, General theorems concerning full force balancing of planar linkages by internal mass redistribution, J. Eng. Ind.
94, 1972); :func:`list_unpinned_links` lists those that do not.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Complex, Real
from kinematics.dynamics.bodies import Body, make_body
from kinematics.dynamics.machine import Machine
from kinematics.dynamics.places import Places
from kinematics.linkage.planar.mechanism import GROUND, Mechanism
from synthesis.analyses.linkages.requested_motion import Task, place_machine
from synthesis.kinds.balancing.linkage.motion import find_pivot, is_on_fixed_pivot, list_moving_links, strip_loads
from synthesis.kinds.balancing.statement.counterweights import Counterweights
from synthesis.numerics.conic import ConeRows, solve_conic_program

POSITION_COUNT = 97
"""Number of positions of the linear system. It is prime, so that the positions share no symmetry of the motion."""

MOMENTUM_TOLERANCE = 1e-9
"""Momentum that is attributed to rounding, as a share of the summed magnitudes of its parts."""

RANK_TOLERANCE = 1e-11
"""Singular value, as a share of the largest, below which columns count as linearly dependent."""

MIN_MOMENT_SHARE = 1e-12
"""Share of the largest first moment below which a weight is omitted."""

MIN_MASS_SHARE = 1e-6
"""Share of the largest mass below which a weight on a link without a fixed pivot is within the solver's tolerance."""

MAX_SETS = 200
"""Maximum number of sets of links to try."""


class Weight(NamedTuple):
    """A counterweight: its link, mass, position in the reference pose and inertia, in the units of the forces."""

    link: str
    mass: float
    at: complex
    inertia: float

    @property
    def body(self) -> Body:
        """The weight as a body."""
        return make_body(self.mass, self.at, self.inertia)


def compute_momentum(machine: Machine, paced: Places) -> tuple[Complex, float]:
    """Compute Σ m r' over positions, and the largest sum of the magnitudes of its parts."""
    parts = [np.asarray(part.mass)[..., None] * paced.point(link, part.cg)[1] for link, part in machine.bodies.items()]
    parts += [np.asarray(mass)[..., None] * paced.joints[joint][1] for joint, mass in machine.pin_masses.items()]
    return np.asarray(sum(parts)), float(sum(np.abs(part) for part in parts).max())


def find_force_balances(task: Task, requested: Counterweights) -> list[list[Weight]]:
    """Find the sets of counterweights that balance the shaking force; the list is empty if no set does.

    If the client names links, there is one set on these links. Otherwise all sets of as few links as possible are
    found. Sets on fixed pivots come first, then the lightest.
    """
    machine = strip_loads(task.machine)
    system = _MomentumSystem(machine, _choose_positions(task), requested)
    if requested.links is not None:
        found = system.find_weights(requested.links)
        return [] if found is None else [found]
    links = list_moving_links(machine.mechanism)
    fixed = [link for link in links if is_on_fixed_pivot(machine.mechanism, link)]
    for candidates in (fixed, links):
        # If weights on all candidates cannot balance the force, no subset can.
        if not system.is_solvable(candidates):
            continue
        tried = 0
        for count in range(len(candidates) + 1):
            sets = []
            for chosen in combinations(candidates, count):
                tried += 1
                if (
                    tried <= MAX_SETS
                    and system.is_solvable(chosen)
                    and (found := system.find_weights(chosen)) is not None
                ):
                    sets.append(found)
            if sets:
                return sorted(sets, key=lambda weights: sum(weight.mass for weight in weights))
        found = system.find_weights(candidates)
        return [] if found is None else [found]
    return []


def is_balanceable(task: Task) -> bool:
    """Return whether weights on all moving links could balance the force."""
    machine = strip_loads(task.machine)
    return _MomentumSystem(machine, _choose_positions(task), Counterweights()).is_solvable(
        list_moving_links(machine.mechanism)
    )


def list_unpinned_links(mechanism: Mechanism) -> list[str]:
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


def _choose_positions(task: Task) -> Real:
    """Choose positions inside the range of the motion, excluding its ends."""
    # An irrational-looking offset keeps the positions away from ends, middle and other special places.
    shares = (np.arange(POSITION_COUNT) + 0.382) / POSITION_COUNT
    return np.asarray(task.start + (task.end - task.start) * shares)


class _MomentumSystem:
    """The linear system by which weights cancel a machine's momentum at generic positions."""

    def __init__(self, machine: Machine, at: Real, stated: Counterweights) -> None:
        self.machine, self.stated = machine, stated
        self.mechanism = machine.mechanism
        paced = place_machine(machine, at)
        known = paced.smooth
        total, self.size = compute_momentum(machine, paced)
        self.total = _stack_parts(total[known])
        self.turning = {}
        self.carried = {}
        for link in list_moving_links(self.mechanism):
            turn = paced.turns[link][1][known]
            self.turning[link] = np.stack([_stack_parts(turn), _stack_parts(1j * turn)], axis=1)
            self.carried[link] = _stack_parts(paced.joints[find_pivot(self.mechanism, link)][1][known])

    def is_solvable(self, links: Sequence[str]) -> bool:
        """Return whether weights of any mass on these links can cancel the momentum."""
        loose = [link for link in links if not is_on_fixed_pivot(self.mechanism, link)]
        columns = [*(self.turning[link] for link in links), *(self.carried[link][:, None] for link in loose)]
        return self._solve_columns(columns, self.total) is not None

    def find_weights(self, links: Sequence[str]) -> list[Weight] | None:
        """Find the weights on these links; None if no weights on them balance the force."""
        loose = [link for link in links if not is_on_fixed_pivot(self.mechanism, link)]
        columns = [self.turning[link] for link in links]
        masses = dict.fromkeys(links, self.stated.mass)
        if loose and self.stated.mass is None:
            found = self._minimize_mass(links, loose)
            if found is None:
                return None
            moments, masses = found
            used = [link for link in links if link not in loose or masses[link] > MIN_MASS_SHARE * max(masses.values())]
            # Drop masses within the solver's tolerance if the remaining weights still balance the force.
            if len(used) < len(links) and (without := self.find_weights(used)) is not None:
                return without
        else:
            carried = sum((self.stated.mass or 0.0) * self.carried[link] for link in loose)
            solved = self._solve_columns(columns, self.total + carried)
            if solved is None:
                return None
            moments = dict(zip(links, (solved[0::2] + 1j * solved[1::2]).tolist(), strict=True))
        # Drop negligible weights, except on links whose mass counts in the momentum.
        largest = max((abs(moment) for moment in moments.values()), default=0.0)
        return [
            self._build_weight(link, moment, masses[link])
            for link, moment in moments.items()
            if abs(moment) > MIN_MOMENT_SHARE * largest or link in loose
        ]

    def _build_weight(self, link: str, moment: complex, mass: float | None) -> Weight:
        about = complex(self.machine.scale * self.mechanism.joints[find_pivot(self.mechanism, link)])
        mass = abs(moment) / self._choose_radius(link) if mass is None else mass
        at = about + (moment / mass if mass > 0.0 else 0j)
        return Weight(link, mass, at, self.stated.compute_inertia(mass, self.machine.scale))

    def _choose_radius(self, link: str) -> float:
        """Return the radius of a weight on a link: the requested radius, or the length of the link."""
        if self.stated.radius is not None:
            return self.machine.scale * self.stated.radius
        first, second = (complex(self.mechanism.joints[joint]) for joint in self.mechanism.link_line(link))
        return self.machine.scale * abs(second - first)

    def _solve_columns(self, columns: Sequence[Real], total: Real) -> Real | None:
        """Return the minimum-norm coefficients with which the columns cancel a total; None if there are none."""
        if not columns:
            return np.zeros(0) if np.abs(total).max() <= MOMENTUM_TOLERANCE * self.size else None
        matrix = np.concatenate(columns, axis=1)
        # Columns are normalized, so that the rank tolerance does not depend on units.
        sizes = np.linalg.norm(matrix, axis=0)
        sizes[sizes == 0.0] = 1.0
        found = np.linalg.lstsq(matrix / sizes, -total, rcond=RANK_TOLERANCE)[0] / sizes
        left = np.abs(matrix @ found + total).max()
        return np.asarray(found) if left <= MOMENTUM_TOLERANCE * self.size else None

    def _minimize_mass(
        self, links: Sequence[str], loose: list[str]
    ) -> tuple[dict[str, complex], dict[str, float]] | None:
        """Find moments and masses of minimum total mass, with no weight farther out than its radius.

        The masses of weights on links without a fixed pivot count in the momentum. This is a second-order cone program.
        Its solution is then corrected by the minimum-norm change that solves the linear system to rounding.
        """
        columns = [*(self.turning[link] for link in links), *(self.carried[link][:, None] for link in loose)]
        if (start := self._solve_columns(columns, self.total)) is None:
            return None
        matrix = np.concatenate(columns, axis=1)
        sizes = np.linalg.norm(matrix, axis=0)
        sizes[sizes == 0.0] = 1.0
        _, values, rows = np.linalg.svd(matrix / sizes, full_matrices=False)
        kept = rows[values > RANK_TOLERANCE * values[0]] * sizes  # combinations of x that the positions determine
        count, turned = len(links) + 2 * len(links), 2 * len(links)
        # Unknowns: moments, masses of the loose links, masses of the other links, all scaled by ``unit``.
        unit = max(float(np.abs(start).max()), 1e-300)
        order = [*loose, *(link for link in links if link not in loose)]
        equal = np.zeros((len(kept), count))
        equal[:, : kept.shape[1]] = kept
        scale = np.abs(equal).max(axis=1)
        cones = np.zeros((3 * len(links), count))
        # |moment| ≤ radius · mass of every weight.
        for n, link in enumerate(links):
            cones[3 * n, turned + order.index(link)] = -self._choose_radius(link)
            cones[3 * n + 1, 2 * n] = cones[3 * n + 2, 2 * n + 1] = -1.0
        cost = np.concatenate([np.zeros(turned), np.ones(len(links))])
        solution = solve_conic_program(
            cost,
            [
                ConeRows("zero", equal / scale[:, None], equal[:, : len(start)] @ start / unit / scale),
                ConeRows("second_order", cones, np.zeros(3 * len(links)), 3),
            ],
        )
        if solution.status != "solved":
            return None
        # The cone program is only accurate to the solver's tolerance: the next step removes the residual.
        near = unit * solution.x
        x = near[: turned + len(loose)]
        x = x + np.linalg.lstsq(kept, kept @ (start - x), rcond=None)[0]
        moments = dict(zip(links, (x[0:turned:2] + 1j * x[1:turned:2]).tolist(), strict=True))
        masses = dict(zip(order, [*x[turned:].tolist(), *near[turned + len(loose) :].tolist()], strict=True))
        if min(masses.values()) < 0.0:
            masses = {link: max(mass, 0.0) for link, mass in masses.items()}
        return moments, masses


def _stack_parts(values: Complex) -> Real:
    """Stack real and imaginary parts of complex values."""
    return np.concatenate([values.real, values.imag])
