"""Planted motion: positions of random sixbars of each type, and for how many a sound one of that type is found.

Planted sixbars close over a random turn of their input, transmit with 20° at least and are no larger than five sizes of
their task. Of five positions at random turns, found is a sound sixbar; of 24 at equal ones, of which one design is
wanted, a sound one off by a millionth of the task's size at most, root mean square. Each answer is driven once more by
its loops; ``false`` counts what they do not confirm.
"""

from __future__ import annotations

import itertools
import math
import statistics

import numpy as np

from synthesis.kinds.motion.sixbar import residuals as rows
from synthesis.kinds.motion.sixbar.dyad_assembly import O4, Q1, Q2, A, B, J, compute_signed_sine
from synthesis.kinds.motion.sixbar.topologies import TOPOLOGIES
from synthesis.kinds.motion.task.ranking import get_rms_error
from tests.support.sixbars.motion import REACH, SIXBARS, SOUND, Task, false_claim, solved, sound, stated
from tests.support.sixbars.spread import each

TASKS = 100

FEW, MANY = 5, 24
FOUND = 1e-6
"""Root mean square over many positions of a distance in task sizes and an angle in radians."""


def planted(rng: np.random.Generator, make: int, count: int) -> Task:
    """So many positions of a random sixbar."""
    at, turns = np.empty(6, complex), np.ones(4, complex)
    while True:
        z = rng.normal(size=7) + 1j * rng.normal(size=7)
        setting = np.zeros(rows.SETTING.size)
        sides = (
            math.copysign(1.0, compute_signed_sine(z[A], z[O4], z[B])),
            math.copysign(1.0, compute_signed_sine(z[Q1], z[Q2], z[J])),
        )
        setting[[rows.TOPOLOGY, rows.FIRST_SIDE, rows.SECOND_SIDE]] = make, *sides
        lengths, inverses = np.empty(4), np.empty(4, complex)
        rows.compute_dimensions(z, lengths, inverses)
        steps = rng.uniform(0.2, 1.0, count - 1) if count == FEW else np.ones(count - 1)
        inputs = np.concatenate([[0.0], np.cumsum(steps)])
        inputs *= rng.uniform(math.radians(40.0), math.radians(300.0)) / inputs[-1]
        points, angles, most = [], [], 0.0
        for angle in [*np.linspace(0.0, inputs[-1], 80), *inputs]:
            most = max(most, *map(abs, rows.drive_linkage(z, lengths, inverses, setting, angle, at, turns)))
            if most > math.cos(math.radians(SOUND)):
                break
            points.append(at[5])
            angles.append(np.degrees(np.angle(turns[3])))
        else:
            met = np.array(points[-count:])
            size = np.abs(met[:, None] - met).max()
            spread = np.abs(np.append(z, 0.0)[:, None] - np.append(z, 0.0)).max()
            if spread <= REACH * size:
                return stated(100.0 * met, np.array(angles[-count:]))


def tried(kind: str, task: Task) -> tuple[bool, float, list[str]]:
    """Whether a task has a sound sixbar of a type, what that took, and what is not confirmed of each."""
    result, processor, _ = solved(task, mechanisms=[kind], max_designs=3 if len(task) == FEW else 1)
    designs = sound(result)
    found = [design for design in designs if len(task) == FEW or get_rms_error(design) <= FOUND]
    return bool(found), processor, [false_claim(design, task) for design in designs]


def table(tasks: int, seed: int) -> None:
    print(f"{'planted':<16}{'positions':>10}{'tasks':>6}{'found %':>9}{'CPU s':>8}{'most':>7}{'false':>8}")
    for count, kind in itertools.product((FEW, MANY), SIXBARS):
        rng = np.random.default_rng(seed)
        of_kind = [n for n, make in enumerate(TOPOLOGIES) if make.type == kind]
        drawn = [(kind, planted(rng, of_kind[n % len(of_kind)], count)) for n in range(tasks)]
        found, times, faults = zip(*each(tried, drawn), strict=True)
        listed = [fault for of_task in faults for fault in of_task]
        share = 100.0 * sum(found) / tasks
        print(
            f"{kind:<16}{count:>10}{tasks:>6}{share:>9.1f}{statistics.median(times):>8.2f}{max(times):>7.1f}"
            f"{sum(map(bool, listed)):>5}/{len(listed)}",
            flush=True,
        )
