"""Enumeration of every feasible train of a task, of any ratio: each set of gears once, in its best pairing."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Integers, Real
from kinematics.compiling import njit
from synthesis.kinds.gear_train.search.candidates import Halves, list_coaxial_meshes
from synthesis.kinds.gear_train.search.kernels import Gears, has_common_distance
from synthesis.kinds.gear_train.search.pairing_rules import (
    MAX_STAGES,
    Rule,
    arrange_pairs,
    is_foremost,
    is_within_limits,
)
from synthesis.kinds.gear_train.search.task import UNLIMITED_TOLERANCE, Task

GROWTH_FACTOR = 4
"""Growth factor of the array of trains if it was too small."""

INITIAL_CAPACITY = 1 << 16
"""Number of trains for which the first array has space."""


class EveryTrain(NamedTuple):
    """Trains as rows of a₁...a₄ b₁...b₄ and marks₁...₄; N, D of their ratios N/D, and the sum of their teeth."""

    rows: Gears
    over: Integers
    under: Integers
    total: Integers


def list_every_train(task: Task) -> EveryTrain:
    """List all trains of a task, those of few stages first."""
    listed = [np.zeros((0, 3 * MAX_STAGES), np.int16), *(_list_stage_trains(task, k) for k in task.stage_counts)]
    rows = np.concatenate(listed)
    drivers, driven = rows[:, :MAX_STAGES].astype(np.int64), rows[:, MAX_STAGES : 2 * MAX_STAGES].astype(np.int64)
    return EveryTrain(
        rows,
        # Missing stages have zero teeth, which must not make the products zero.
        np.maximum(driven, 1).prod(axis=1),
        np.maximum(drivers, 1).prod(axis=1),
        drivers.sum(axis=1) + driven.sum(axis=1),
    )


def _list_stage_trains(task: Task, k: int) -> Gears:
    rule = task.build_rule(UNLIMITED_TOLERANCE, k)
    room = INITIAL_CAPACITY
    if task.reverted:
        meshes = list_coaxial_meshes(task, k)
        lists = meshes.a, meshes.b, meshes.mark, meshes.groups, meshes.distances
    else:
        halves = Halves(task, k)
    while True:
        rows = np.zeros((room, 3 * MAX_STAGES), np.int16)
        if task.reverted:
            number = _combine_coaxial(k, *lists, rule, rows)
        else:
            number = _combine_halves(k, halves.drivers.teeth, halves.driven.teeth, rule, rows)
        # The compiled loop continues to count after the array is full, so that one repetition suffices.
        if number <= room:
            return rows[:number]
        # The count of the failed pass is the exact size needed.
        room = max(number, GROWTH_FACTOR * room)


@njit(cache=True, nogil=True)
def _combine_halves(k: int, drivers: Gears, driven: Gears, rule: Rule, rows: Gears) -> int:
    """Combine all drivers with all driven gears; return the number of trains, and write as many as fit into rows."""
    teeth, number = np.zeros(3 * MAX_STAGES, np.int64), 0
    for i in range(len(drivers)):
        for j in range(len(driven)):
            teeth[:] = 0
            for stage in range(k):
                teeth[stage], teeth[MAX_STAGES + stage] = drivers[i, stage], driven[j, stage]
            if is_within_limits(teeth, k, rule) and arrange_pairs(teeth, k, rule):
                if number < len(rows):
                    rows[number] = teeth
                number += 1
    return number


@njit(cache=True, nogil=True)
def _combine_coaxial(
    k: int,
    a: Integers,
    b: Integers,
    mark: Integers,
    groups: NDArray[np.int64],
    distances: Real,
    rule: Rule,
    rows: Gears,
) -> int:
    """Combine meshes from one group of coaxial ones, one per stage; otherwise like :func:`_combine_halves`."""
    teeth, place, number = np.zeros(3 * MAX_STAGES, np.int64), np.zeros(MAX_STAGES, np.int64), 0
    for g in range(len(groups)):
        stage, place[0] = 0, groups[g, 0]
        while stage >= 0:
            # This stage's list is exhausted: go back one stage and advance it.
            if place[stage] >= (groups[g, stage + 1] if rule.ordered else groups[g, 1]):
                stage -= 1
                if stage >= 0:
                    place[stage] += 1
                continue
            if stage < k - 1:
                stage += 1
                # Interchangeable stages choose in rising order, so that each multiset occurs once.
                place[stage] = groups[g, stage] if rule.ordered else place[stage - 1]
                continue
            for i in range(k):
                teeth[i], teeth[MAX_STAGES + i] = a[place[i]], b[place[i]]
                teeth[2 * MAX_STAGES + i] = mark[place[i]]
            sound = has_common_distance(distances, place, k) and is_within_limits(teeth, k, rule)
            if sound and (not rule.ordered or is_foremost(teeth, k, rule, True)):
                if number < len(rows):
                    rows[number] = teeth
                number += 1
            place[stage] += 1
    return number
