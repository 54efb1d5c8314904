"""Springs with open ends whose program is not convex: a search from many places, without proof.

At given ends the program has its optimum. From the best of many places the ends are moved by sequential programs: the
effect of a small step towards each corner of an area on the drive and on the limits is added to the program as a
further parameter, within a trust region that shrinks if a step is no gain.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Real
from synthesis.kinds.spring_balancing.branching import Places, solve_at
from synthesis.kinds.spring_balancing.effects import Effects, Setting, compute_effects
from synthesis.kinds.spring_balancing.program import EXACT_TOLERANCE, BestParameters, find_best
from synthesis.kinds.spring_balancing.spring_parameters import Spring, build_springs, evaluate_springs

POSITION_COUNT = 120
"""Number of positions of the motion used by the search."""

START_COUNT, REFINED_COUNT = 40, 6
"""Number of places that are tried, and of the best of them that are refined."""

MAX_STEPS = 24
"""Maximum number of steps from a place."""

MAX_STEP_SHARE, MIN_STEP_SHARE = 0.4, 1e-5
"""Maximum step as a share of the distance to the corners, and minimum at which the refinement ends."""

DIFFERENCE_STEP = 1e-6
"""Share of the distance to a corner by which derivatives are taken."""

MIN_GAIN = 1e-7
"""Minimum relative gain of a step."""

DUPLICATE_TOLERANCE = 0.02
"""Share of the linkage's size, and of a rate, within which springs are duplicates."""


class TrialPlaces(NamedTuple):
    """Places of the searched ends, and the best parameters there."""

    points: tuple[complex, ...]
    best: BestParameters


class PlaceSearch:
    """The search for the places of some ends of a problem's springs."""

    def __init__(self, setting: Setting) -> None:
        self.setting, self.few = setting, setting.thin_positions(POSITION_COUNT)
        springs = setting.problem.springs
        self.areas: Places = [setting.list_corners(spring) for spring in springs]
        self.moved = [
            (n, k)
            for n, spring in enumerate(springs)
            # Of a superposable spring one searched end suffices: the other is then convex.
            for k in ([0] if spring.is_superposable else [0, 1])
            if spring.ends is not None and not spring.convex and len(self.areas[n][k]) > 1
        ]

    def build_places(self, points: Sequence[complex]) -> Places:
        """Return the corners of all ends, with the searched ones at given points."""
        places = [list(ends) for ends in self.areas]
        for (n, k), at in zip(self.moved, points, strict=True):
            places[n][k] = np.array([at])
        return places

    def try_places(self, points: Sequence[complex]) -> TrialPlaces:
        """Find the best parameters at places."""
        return TrialPlaces(tuple(points), solve_at(self.few, self.build_places(points), bounded=False))

    def sample_places(self, rng: np.random.Generator) -> tuple[complex, ...]:
        """Sample random places in the areas."""
        return tuple(complex(rng.dirichlet(np.ones(len(self.areas[n][k]))) @ self.areas[n][k]) for n, k in self.moved)

    def refine_places(self, start: TrialPlaces) -> TrialPlaces:
        """Find the best places near a start."""
        at, way = start, MAX_STEP_SHARE
        for _ in range(MAX_STEPS):
            if way < MIN_STEP_SHARE or at.best.value <= EXACT_TOLERANCE:
                break
            points = self._take_step(at, way)
            tried = None if points is None else self.try_places(points)
            if tried is not None and tried.best.value < at.best.value * (1.0 - MIN_GAIN):
                at, way = tried, min(2.0 * way, MAX_STEP_SHARE)
            else:
                way *= 0.25
        return at

    def _compute_effects(self, points: Sequence[complex]) -> list[Effects]:
        springs = self.setting.problem.springs
        return [
            compute_effects(self.few, spring, ends)
            for spring, ends in zip(springs, self.build_places(points), strict=True)
        ]

    def _take_step(self, at: TrialPlaces, way: float) -> tuple[complex, ...] | None:
        """Return places a step further, from the program with the steps towards the corners as parameters."""
        here = self._compute_effects(at.points)
        drives, rows, corners = [], [], []
        for m, (n, k) in enumerate(self.moved):
            for corner in self.areas[n][k]:
                moved = [*at.points]
                # One-sided difference towards a corner, so that the point stays inside the area.
                moved[m] += DIFFERENCE_STEP * (complex(corner) - moved[m])
                there = self._compute_effects(moved)[n]
                own = at.best.parameters[n]
                drives.append(own @ (there.drive - here[n].drive) / DIFFERENCE_STEP)
                shifted = np.zeros(sum(len(part.rows) for part in here))
                if len(there.rows) == len(here[n].rows):
                    first = sum(len(part.rows) for part in here[:n])
                    shifted[first : first + len(there.rows)] = (there.rows - here[n].rows) @ own / DIFFERENCE_STEP
                rows.append(shifted)
                corners.append((m, complex(corner)))
        whole = self._join_effects(here, np.array(drives), np.array(rows).T, [m for m, _ in corners], way)
        found = find_best(self.few.fixed, [whole], self.setting.problem.norm, bounded=False)
        if found.status != "solved":
            return None
        points = [*at.points]
        for (m, corner), share in zip(corners, found.parameters[0][-len(corners) :].tolist(), strict=True):
            points[m] += max(share, 0.0) * (corner - at.points[m])
        return tuple(points)

    @staticmethod
    def _join_effects(here: Sequence[Effects], drives: Real, shifts: Real, ends: list[int], way: float) -> Effects:
        """Join all springs and the steps of their ends to one set of effects."""
        count, more = sum(len(part.drive) for part in here), len(ends)
        rows, at = np.zeros((len(shifts), count + more)), 0
        first = 0
        for part in here:
            rows[first : first + len(part.rows), at : at + len(part.drive)] = part.rows
            first, at = first + len(part.rows), at + len(part.drive)
        rows[:, count:] = shifts
        ways = np.zeros((more + max(ends) + 1, count + more))
        # Steps are non-negative, and those of one end add up to at most the trust region.
        ways[:more, count:] = -np.eye(more)
        for column, end in enumerate(ends):
            ways[more + end, count + column] = 1.0
        limits = [*(part.limits for part in here), np.zeros(more), np.full(max(ends) + 1, way)]
        stiff = np.concatenate([*(part.stiff for part in here), np.zeros(more)])
        drive = np.concatenate([*(part.drive for part in here), drives])
        return Effects(drive, np.concatenate([rows, ways]), np.concatenate(limits), stiff)


def search_springs(setting: Setting, report: Callable[[float], None]) -> list[list[Spring]]:
    """Search for springs; return distinct ones, sorted by value."""
    search = PlaceSearch(setting)
    rng = np.random.default_rng(setting.problem.seed)
    middle = tuple(complex(search.areas[n][k].mean()) for n, k in search.moved)
    starts = [
        search.try_places(points) for points in (middle, *(search.sample_places(rng) for _ in range(START_COUNT)))
    ]
    report(0.3)
    solved = sorted((start for start in starts if start.best.status == "solved"), key=lambda one: one.best.value)
    found: list[tuple[float, list[Spring]]] = []
    for n, start in enumerate(solved[: max(REFINED_COUNT, min(setting.problem.max_designs, START_COUNT))]):
        places = search.build_places(search.refine_places(start).points)
        last = solve_at(setting, places)
        if last.status == "solved":
            springs = build_springs(setting, places, last.parameters)
            found.append((evaluate_springs(setting, springs), springs))
        report(0.3 + 0.7 * (n + 1) / REFINED_COUNT)
    # Several starts often converge to the same springs.
    different: list[list[Spring]] = []
    for _, springs in sorted(found, key=lambda one: one[0]):
        if not any(_is_duplicate(setting, springs, other) for other in different):
            different.append(springs)
    return different


def _is_duplicate(setting: Setting, one: Sequence[Spring], other: Sequence[Spring]) -> bool:
    if [spring.number for spring in one] != [spring.number for spring in other]:
        return False
    for mine, its in zip(one, other, strict=True):
        if abs(mine.rate - its.rate) > DUPLICATE_TOLERANCE * max(mine.rate, its.rate):
            return False
        if any(abs(a - b) > DUPLICATE_TOLERANCE * setting.size for a, b in zip(mine.ends, its.ends, strict=True)):
            return False
    return True
