"""Catalogue of all trains that satisfy the constraints of a unit, sorted by ratio.

Trains with the same ratio and the same number of teeth form an *entry*. The search does not distinguish them. Only
returned series are built from the trains themselves.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from fractions import Fraction
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Integers, Real
from synthesis.kinds.gear_train.construction.train import build_mechanism as ordinary_mechanism
from synthesis.kinds.gear_train.design import GearTrainMechanism
from synthesis.kinds.gear_train.problem import GearTrainProblem
from synthesis.kinds.gear_train.search.enumeration import list_every_train as every_ordinary
from synthesis.kinds.gear_train.search.pairing_rules import MAX_STAGES
from synthesis.kinds.gear_train.search.search import Train
from synthesis.kinds.gear_train.search.task import build_task
from synthesis.kinds.gear_train.statement.stages import compute_sense
from synthesis.kinds.planetary_train.build import build_mechanism as planetary_mechanism
from synthesis.kinds.planetary_train.design import PlanetaryMechanism
from synthesis.kinds.planetary_train.enumeration import SoundTrains
from synthesis.kinds.planetary_train.enumeration import list_every_train as every_planetary
from synthesis.kinds.planetary_train.problem import PlanetaryProblem
from synthesis.kinds.train_series.design import UnitMechanism
from synthesis.kinds.train_series.units import Unit, build_unit_problem

MAX_RATIO = 1e9
"""Maximum ratio of a unit, and inverse of the minimum: no larger ratio may be requested."""


class Batch(NamedTuple):
    """Trains of a unit: their ratios over/under, the sums of their teeth, and the builder of one by its row."""

    over: Integers
    under: Integers
    total: Integers
    build_train: Callable[[int], UnitMechanism | None]


class Catalogue(NamedTuple):
    """The entries of a unit, sorted by ratio and number of teeth.

    ``over``/``under`` are reduced, with the sign in ``over``; ``value`` is the quotient. The trains of entry e are the
    rows ``starts[e]`` to ``starts[e + 1]`` of ``trains``, pairs of batch and row.
    """

    value: Real
    over: Integers
    under: Integers
    total: Integers
    starts: Integers
    trains: Integers
    batches: list[Batch]

    @property
    def counts(self) -> Integers:
        """Number of trains of each entry."""
        return np.diff(self.starts)

    def ratio(self, entry: int) -> Fraction:
        """Return input speed over output speed, exact."""
        return Fraction(int(self.over[entry]), int(self.under[entry]))

    def build_train(self, row: int) -> UnitMechanism | None:
        """Build the mechanism of a row of ``trains``; None if it needs an idler and there is none."""
        batch, at = self.trains[row]
        mechanism: UnitMechanism | None = self.batches[batch].build_train(int(at))
        return mechanism


def build_catalogue(unit: Unit, length_unit: str) -> Catalogue:
    """Build the catalogue of a consistent unit."""
    problem = build_unit_problem(unit, Fraction(1), length_unit)
    batches = list(_list_ordinary(problem) if isinstance(problem, GearTrainProblem) else _list_planetary(problem))
    parts = [_reduce_batch(batch, k) for k, batch in enumerate(batches)]
    over, under, total, batch, row = (
        np.concatenate([part[column] for part in parts] or [np.zeros(0, np.int64)]) for column in range(5)
    )
    value = over / under
    order = np.lexsort((row, batch, under, over, total, value))
    over, under, total, batch, row = (column[order] for column in (over, under, total, batch, row))
    new = np.ones(len(over), np.bool_)
    # Sorted neighbours with equal reduced ratio and teeth form one entry.
    new[1:] = (np.diff(over) != 0) | (np.diff(under) != 0) | (np.diff(total) != 0)
    firsts = np.flatnonzero(new)
    return Catalogue(
        value[order][firsts],
        over[firsts],
        under[firsts],
        total[firsts],
        np.append(firsts, len(over)),
        np.stack([batch, row], axis=1),
        batches,
    )


def _reduce_batch(batch: Batch, number: int) -> tuple[Integers, Integers, Integers, Integers, Integers]:
    """Reduce the fractions of a batch, without locked trains: over, under, total, the batch and the row."""
    with np.errstate(divide="ignore", invalid="ignore"):
        # Locked trains give 0/0 or x/0 and are dropped by the comparison.
        size = np.abs(batch.over / batch.under)
    row = np.flatnonzero((size <= MAX_RATIO) & (size >= 1.0 / MAX_RATIO))
    over, under = batch.over[row], batch.under[row]
    common = np.gcd(over, under) * np.where(under < 0, -1, 1)
    return over // common, under // common, batch.total[row], np.full(len(row), number), row


def _list_planetary(problem: PlanetaryProblem) -> Iterator[Batch]:
    for sound in every_planetary(problem):

        def build_train(row: int, sound: SoundTrains = sound) -> PlanetaryMechanism:
            return planetary_mechanism(problem, sound.build_candidate(row), problem.module)

        yield Batch(sound.over, sound.under, sound.total, build_train)


def _list_ordinary(problem: GearTrainProblem) -> Iterator[Batch]:
    task = build_task(problem, coprime=problem.hunting_tooth == "require")
    every = every_ordinary(task)

    def build_train(row: int) -> GearTrainMechanism | None:
        numbers = every.rows[row].tolist()
        k = sum(n > 0 for n in numbers[:MAX_STAGES])
        parts = (tuple(numbers[start : start + k]) for start in (0, MAX_STAGES, 2 * MAX_STAGES))
        return ordinary_mechanism(problem, task, Train(*parts))

    # Every external stage reverses the direction; an idler, which a given direction may need, restores it.
    count = np.count_nonzero(every.rows[:, :MAX_STAGES], axis=1)
    # Stages that are given one by one determine the direction themselves.
    wanted = problem.required_sign if problem.stages is None else compute_sense(problem.stages)
    sign = np.where(count % 2, -1, 1) if wanted == 0 else np.full(len(count), wanted)
    yield Batch(sign * every.over, every.under, every.total, build_train)
