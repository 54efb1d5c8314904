"""Planted motion: positions of random sixbars of each type and of eightbars, and how often a sound one is found.

Planted linkages close over a random turn of their input, transmit with 20° at least and are no larger than five sizes
of their task. Of five positions at random turns, found is a sound linkage; of 24 at equal ones, of which one design is
wanted, a sound one off by a millionth of the task's size at most, root mean square. Each answer is driven once more by
its loops; ``false`` counts what they do not confirm.
"""

from __future__ import annotations

import itertools
import math
import statistics

import numpy as np

from kinematics.arrays import Complex, Real
from synthesis.fit.linkage.closure import trace_linkage
from synthesis.fit.linkage.topology import VIEW, Topology, list_forms
from synthesis.fit.triad_slant import find_min_slant
from synthesis.kinds.motion.task.ranking import get_rms_error
from tests.support.sixbars.motion import REACH, SIXBARS, SOUND, Task, false_claim, solved, sound, stated
from tests.support.sixbars.spread import each

TASKS = 100

FEW, MANY = 5, 24
TYPES = [*SIXBARS, "eightbar"]
STRIDE = 23
"""Step from a task's topology to the next one's: no divisor of the number of topologies, so that all take part."""

FOUND = 1e-6
"""Root mean square over many positions of a distance in task sizes and an angle in radians."""


def planted(rng: np.random.Generator, form: Topology, count: int) -> Task:
    """So many positions of a random linkage of a topology with a heading."""
    n, shown = len(form.nodes), form.nodes[:, 0] == VIEW
    while True:
        z = rng.normal(size=n) + 1j * rng.normal(size=n)
        z[shown] = 0.0
        steps = rng.uniform(0.2, 1.0, count - 1) if count == FEW else np.ones(count - 1)
        inputs = np.concatenate([[0.0], np.cumsum(steps)])
        inputs *= rng.uniform(math.radians(40.0), math.radians(300.0)) / inputs[-1]
        every = np.concatenate([np.linspace(0.0, inputs[-1], 80), inputs])
        places, cosines = np.empty((len(every), n, 2)), np.zeros((len(every), n))
        trace_linkage(form.nodes, z.view(float), every, places, cosines)
        if not np.isfinite(places).all() or not _transmits(form, places @ [1.0, 1.0j], cosines):
            continue
        points = places[-count:, form.point] @ [1.0, 1.0j]
        angles = np.unwrap(np.angle(places[-count:, form.heading] @ [1.0, 1.0j] - points))
        size, pins = np.abs(points[:, None] - points).max(), z[~shown]
        if np.abs(pins[:, None] - pins).max() <= REACH * size:
            return stated(100.0 * points, np.degrees(angles))


def _transmits(form: Topology, places: Complex, cosines: Real) -> bool:
    """Whether a motion transmits soundly, and never turns over."""
    limit = math.cos(math.radians(SOUND))
    if not form.triad:
        return bool(np.abs(cosines).max() <= limit)
    slants = [find_min_slant(*row[list(form.triad)]) for row in places]
    return max(abs(slant[0]) for slant in slants) <= limit and len({slant[1] > 0.0 for slant in slants}) == 1


def tried(kind: str, task: Task) -> tuple[bool, float, list[str]]:
    """Whether a task has a sound linkage of a type, what that took, and what is not confirmed of each."""
    result, processor, _ = solved(task, mechanisms=[kind], max_designs=3 if len(task) == FEW else 1)
    designs = sound(result)
    found = [design for design in designs if len(task) == FEW or get_rms_error(design) <= FOUND]
    return bool(found), processor, [false_claim(design, task) for design in designs]


def table(tasks: int, seed: int) -> None:
    print(f"{'planted':<16}{'positions':>10}{'tasks':>6}{'found %':>9}{'CPU s':>8}{'most':>7}{'false':>8}")
    for count, kind in itertools.product((FEW, MANY), TYPES):
        rng = np.random.default_rng(seed)
        forms = list_forms(kind, guides=True)
        drawn = [(kind, planted(rng, forms[STRIDE * n % len(forms)], count)) for n in range(tasks)]
        found, times, faults = zip(*each(tried, drawn), strict=True)
        listed = [fault for of_task in faults for fault in of_task]
        share = 100.0 * sum(found) / tasks
        print(
            f"{kind:<16}{count:>10}{tasks:>6}{share:>9.1f}{statistics.median(times):>8.2f}{max(times):>7.1f}"
            f"{sum(map(bool, listed)):>5}/{len(listed)}",
            flush=True,
        )
