"""Gears that are cut and turned against what the analysis says of them, and fitted trains against a brute force.

    python -m benchmarks.gears [--pairs 500] [--trains 100] [--typed 100] [--processes 3] [--seed 0]

Pairs, external and internal, are drawn at random and stated to the analysis `gear_pair`. The same gears are cut by a
rack, and rings by a cutter, point by point, and turned (`tests.support.independent.cut_gears`): undercut, contact in
fillets, and of pairs without such faults play, contact ratio and tip thickness. Trains with centre distances and
profile shifts are searched by the solver and by a loop over all gears (`tests.support.independent.fitted_trains`); so
are trains of typed stages (`tests.support.independent.typed_trains`). Then as many fresh processes, which have their
kernels loaded but have fitted no such teeth, solve reverted trains of two stages, of which the CPU time is told.
"""

from __future__ import annotations

import argparse
import multiprocessing
import resource
from typing import Any

from tests.support.independent import typed_trains
from tests.support.problems.gears import Solved, compare_pairs, compare_trains, compare_typed

TWO_STAGES: dict[str, Any] = {
    "kind": "gear_train",
    "ratio": "pi",
    "max_stages": 2,
    "teeth": {"min": 17, "max": 100},
    "reverted": True,
    "modules": [1.0, 1.25, 1.5, 2.0],
    "shift": {"min": -0.5, "max": 1.0},
}

DISTANCES: dict[str, Any] = {
    "no stated distance": {},
    "one distance": {"centre_distance": 120.0},
    "a range of distances": {"centre_distance": {"min": 60.0, "max": 140.0}},
}


def first_and_second(distance: dict[str, Any]) -> tuple[float, float]:
    """CPU seconds of a process for a train of two stages, and for the same once more; kernels are loaded before."""
    timed = Solved()
    timed.solve({**TWO_STAGES, **distance, "teeth": {"min": 17, "max": 24}, "shift": {"min": -0.4, "max": 0.9}})
    spent = [timed.spent]
    for _ in range(2):
        timed.solve({**TWO_STAGES, **distance})
        spent.append(timed.spent)
    return spent[1] - spent[0], spent[2] - spent[1]


def print_times(processes: int) -> None:
    """Of trains of two stages, each in as many fresh processes, one after another."""
    for name, distance in DISTANCES.items():
        with multiprocessing.get_context("spawn").Pool(1, maxtasksperchild=1) as pool:
            times = pool.map(first_and_second, [distance] * processes, chunksize=1)
        first, second = (", ".join(f"{one:.2f}" for one in column) for column in zip(*times, strict=True))
        print(f"two reverted stages of 17 to 100 teeth, four modules and shift, {name}: "
              f"{first} s of CPU, once more {second} s")  # fmt: skip


def main() -> None:
    """Print the comparisons and times."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--pairs", type=int, default=500)
    parser.add_argument("--trains", type=int, default=100)
    parser.add_argument("--typed", type=int, default=100)
    parser.add_argument("--processes", type=int, default=3)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    found = compare_pairs(options.pairs, options.seed)
    print(f"{found.pairs} pairs cut and turned: {found.sound} sound, {found.measured} measured, "
          f"{found.undercut} gears undercut, {found.in_fillet} pairs with contact in a fillet")  # fmt: skip
    for name, by in found.largest.items():
        print(f"  {name}: they differ by {by:.1e} at most")
    faults = list(found.faults)
    for name, told in (
        ("fitted", compare_trains(options.trains, options.seed)),
        ("typed", compare_typed(typed_trains.statements(options.typed, options.seed))),
    ):
        print(f"{told.some + told.none} {name} trains by brute force: {told.some} with an answer, {told.none} without; "
              f"solved in {told.spent:.1f} s of CPU")  # fmt: skip
        faults += told.faults
    for fault in faults:
        print("  FAULT", fault)
    if options.processes:
        print_times(options.processes)
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
    print(f"peak memory {peak:.0f} MiB")


if __name__ == "__main__":
    main()
