"""All trains that a unit can be, sorted by ratio.

Trains of one ratio and one number of teeth make an *entry*: the search does not distinguish them, and only returned
series are built from the trains themselves.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from fractions import Fraction
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from synthesis.kinds.gear_train.every import every_train as every_ordinary
from synthesis.kinds.gear_train.making import mechanism_of as ordinary_mechanism
from synthesis.kinds.gear_train.pairing import MOST_STAGES
from synthesis.kinds.gear_train.problem import GearTrainProblem
from synthesis.kinds.gear_train.search import Train
from synthesis.kinds.gear_train.stated_stages import sense_of
from synthesis.kinds.gear_train.task import gear_train_task
from synthesis.kinds.planetary_train.every import SoundTrains
from synthesis.kinds.planetary_train.every import every_train as every_planetary
from synthesis.kinds.planetary_train.making import mechanism_of as planetary_mechanism
from synthesis.kinds.planetary_train.problem import PlanetaryProblem
from synthesis.kinds.train_series.stated_units import problem_of

Whole = NDArray[np.int64]
Real = NDArray[np.float64]

GREATEST = 1e9
"""Maximum ratio of a unit, and inverse of the minimum: no larger ratio may be requested."""


class Batch(NamedTuple):
    """Trains of a unit: their ratios over/under, the sums of their teeth, and the builder of one by its row."""

    over: Whole
    under: Whole
    total: Whole
    made: Callable[[int], Any]


class Catalogue(NamedTuple):
    """The entries of a unit, sorted by ratio and number of teeth.

    ``over``/``under`` are reduced, with the sign in ``over``; ``value`` is the quotient. The trains of entry e are the
    rows ``starts[e]`` to ``starts[e + 1]`` of ``trains``, pairs of batch and row.
    """

    value: Real
    over: Whole
    under: Whole
    total: Whole
    starts: Whole
    trains: Whole
    batches: list[Batch]

    @property
    def counts(self) -> Whole:
        """Number of trains of each entry."""
        return np.diff(self.starts)

    def ratio(self, entry: int) -> Fraction:
        """Return input speed over output speed, exact."""
        return Fraction(int(self.over[entry]), int(self.under[entry]))

    def train(self, row: int) -> Any:
        """Build the mechanism of a row of ``trains``; None if it needs an idler and there is none."""
        batch, at = self.trains[row]
        return self.batches[batch].made(int(at))


def catalogue_of(unit: Any, length_unit: str) -> Catalogue:
    """Build the catalogue of a consistent unit."""
    problem = problem_of(unit, Fraction(1), length_unit)
    batches = list(_ordinary(problem) if isinstance(problem, GearTrainProblem) else _planetary(problem))
    parts = [_reduced(batch, k) for k, batch in enumerate(batches)]
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


def _reduced(batch: Batch, number: int) -> tuple[Whole, Whole, Whole, Whole, Whole]:
    """Reduce the fractions of a batch, without locked trains: over, under, total, the batch and the row."""
    with np.errstate(divide="ignore", invalid="ignore"):
        # Locked trains give 0/0 or x/0 and are dropped by the comparison.
        size = np.abs(batch.over / batch.under)
    row = np.flatnonzero((size <= GREATEST) & (size >= 1.0 / GREATEST))
    over, under = batch.over[row], batch.under[row]
    common = np.gcd(over, under) * np.where(under < 0, -1, 1)
    return over // common, under // common, batch.total[row], np.full(len(row), number), row


def _planetary(problem: PlanetaryProblem) -> Iterator[Batch]:
    for sound in every_planetary(problem):

        def made(row: int, sound: SoundTrains = sound) -> Any:
            return planetary_mechanism(problem, sound.candidate(row), problem.module)

        yield Batch(sound.over, sound.under, sound.total, made)


def _ordinary(problem: GearTrainProblem) -> Iterator[Batch]:
    task = gear_train_task(problem, coprime=problem.hunting_tooth == "require")
    every = every_ordinary(task)

    def made(row: int) -> Any:
        numbers = every.rows[row].tolist()
        k = sum(n > 0 for n in numbers[:MOST_STAGES])
        parts = (tuple(numbers[start : start + k]) for start in (0, MOST_STAGES, 2 * MOST_STAGES))
        return ordinary_mechanism(problem, task, Train(*parts))

    # Every external stage reverses the direction; an idler, which a given direction may need, restores it.
    count = np.count_nonzero(every.rows[:, :MOST_STAGES], axis=1)
    # Stages that are given one by one determine the direction themselves.
    wanted = problem.demanded_sign if problem.stages is None else sense_of(problem.stages)
    sign = np.where(count % 2, -1, 1) if wanted == 0 else np.full(len(count), wanted)
    yield Batch(sign * every.over, every.under, every.total, made)
