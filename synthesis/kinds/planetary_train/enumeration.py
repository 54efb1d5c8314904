"""Enumeration of every feasible train of a problem, of any ratio, as exact quotients of integers."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from kinematics.arrays import Integers
from kinematics.gear.arrangements import Arrangement
from synthesis.kinds.planetary_train.build import build_demands
from synthesis.kinds.planetary_train.nearest import Candidate, Coupling, Roles, SetTable, compute_train_value
from synthesis.kinds.planetary_train.problem import PlanetaryProblem
from synthesis.kinds.planetary_train.ratio_form import derive_arrangement_form, evaluate_polynomial
from synthesis.kinds.planetary_train.tooth_numbers import ToothNumbers


@dataclass(frozen=True)
class SoundTrains:
    """The trains of one arrangement and choice of members: N and D of the ratios N/D, and the sums of teeth.

    The sums count the teeth of one copy of every planet. If two planet sets are coupled, every row of one is combined
    with every row of the other. N and D may be 0.
    """

    arrangement: str
    roles: Roles
    tables: tuple[SetTable, ...]
    over: Integers
    under: Integers
    total: Integers

    def build_candidate(self, row: int) -> Candidate:
        """Build one train, ranked for its own ratio."""
        places = [row] if len(self.tables) == 1 else list(divmod(row, len(self.tables[1].size)))
        teeth = tuple(gear for table, at in zip(self.tables, places, strict=True) for gear in table.read_row(at))
        size = max(int(table.size[at]) for table, at in zip(self.tables, places, strict=True))
        ratio = Fraction(int(self.over[row]), int(self.under[row]))
        return Candidate(Fraction(0), size, int(self.total[row]), self.arrangement, self.roles, teeth, ratio)


def list_every_train(problem: PlanetaryProblem) -> Iterator[SoundTrains]:
    """Yield the trains of every arrangement and choice of members that the problem permits, without locked trains."""
    for arrangement in problem.arrangements:
        numbers = [
            ToothNumbers(arrangement, planets, build_demands(problem, arrangement))
            for planets in arrangement.planet_sets
        ]
        tables = tuple(SetTable(each.teeth, each.size) for each in numbers)
        for roles in problem.list_roles(arrangement):
            found = (
                _list_coupled_sets(arrangement, tables, roles)
                if len(tables) > 1
                else _list_single_set(arrangement, tables[0], roles)
            )
            if found is not None:
                yield found


def _list_single_set(arrangement: Arrangement, table: SetTable, roles: Roles) -> SoundTrains | None:
    form, count = derive_arrangement_form(arrangement.name, *roles), len(table.size)
    if not form.over:
        return None
    over, under = (evaluate_polynomial(part, table.values, count).astype(np.int64) for part in form)
    return SoundTrains(arrangement.name, roles, (table,), over, under, table.total)


def _list_coupled_sets(arrangement: Arrangement, tables: tuple[SetTable, ...], roles: Roles) -> SoundTrains | None:
    coupling = Coupling.from_arrangement(arrangement, roles)
    if coupling is None:
        return None
    parts = []
    for table, planets in zip(tables, arrangement.planet_sets, strict=True):
        over, under = (
            evaluate_polynomial(part, table.values, len(table.size))
            for part in compute_train_value(arrangement.name, planets).form
        )
        # Train values are reduced, so that the products below stay exact in double precision.
        common = np.gcd(over.astype(np.int64), under.astype(np.int64))
        parts.append((over / common, under / common))
    first, second = (len(table.size) for table in tables)
    # Row i·n + j combines row i of the first set with row j of the second.
    one = tuple(np.repeat(part, second) for part in parts[0])
    other = tuple(np.tile(part, first) for part in parts[1])
    over, under = coupling.compute_quotient((one[0], one[1]), (other[0], other[1]))
    total = np.repeat(tables[0].total, second) + np.tile(tables[1].total, first)
    return SoundTrains(arrangement.name, roles, tables, over.astype(np.int64), under.astype(np.int64), total)
