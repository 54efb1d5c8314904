"""Circuits and branches of random mechanisms, the core's against elimination by polynomials, type by type.

Elimination (``tests/oracles/elimination.py``) uses nothing of the package: all real roots of the products of radicands
over all assemblies are the only inputs at which an assembly can begin or end. For each design the number of branches,
their ends (to 1e-9 rad) and their assemblies must be the same, and each toggle the end of two of them.

    python -m benchmarks.circuits --designs 1000 [--type watt_2]

Types that dyads close from their input, and geared fivebars of seven ratios. A line a type: designs, designs without a
verdict (no series ended: two roots on one another), branches compared, differences, CPU seconds.
"""

from __future__ import annotations

import argparse
import sys
import time

import numpy as np

from kinematics.linkage.mechanism import Mechanism
from tests.kinematics import mechanism_sampling as sampling
from tests.kinematics.mechanism_sampling import EVERY, RATIOS, take
from tests.kinematics.test_branches import ELIMINATED, same_branches
from tests.oracles.elimination import Undecided

TURNS = {0.5: 2, 2.0 / 3.0: 3}
"""Turns of the input after which a geared fivebar repeats; one for the other ratios."""

SHOWN = 3
"""Differences that are printed for a type."""


def compared(mechanism: Mechanism, count: int, turns: int) -> tuple[int, int, list[int]]:
    """Branches that agree, designs without a verdict, and the numbers of designs that differ."""
    agreed = undecided = 0
    differ = []
    for k in range(count):
        try:
            agreed += same_branches(take(mechanism, k), turns)
        except Undecided:
            undecided += 1
        except AssertionError:
            differ.append(k)
    return agreed, undecided, differ


def main() -> None:
    """Print the table; exit with 1 where any design differs."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--designs", type=int, default=200)
    parser.add_argument("--type", default="", help="only types whose name holds this")
    parser.add_argument("--seed", type=int, default=71)
    given = parser.parse_args()
    failed = 0
    print(f"{'type':<40}{'designs':>9}{'no verdict':>12}{'branches':>10}{'differ':>8}{'CPU s':>9}")
    jobs: list[tuple[str, Mechanism, int]] = []
    for name in ELIMINATED:
        rng = np.random.default_rng([given.seed, list(EVERY).index(name)])
        if given.type in name:
            jobs.append((name, EVERY[name](rng, given.designs), 1))
    for n, ratio in enumerate(RATIOS):
        if given.type in "geared fivebar":
            rng = np.random.default_rng([given.seed + 1, n])
            made = sampling.geared_fivebar(rng, given.designs, ratio)
            jobs.append((f"geared fivebar, ratio {ratio:.3g}", made, TURNS.get(ratio, 1)))
    for name, mechanism, turns in jobs:
        begun = time.process_time()
        agreed, undecided, differ = compared(mechanism, given.designs, turns)
        spent = time.process_time() - begun
        print(f"{name:<40}{given.designs:>9}{undecided:>12}{agreed:>10}{len(differ):>8}{spent:>9.1f}", flush=True)
        if differ:
            failed += len(differ)
            print(f"    differ: {differ[:SHOWN]}")
    sys.exit(failed > 0)


if __name__ == "__main__":
    main()
