"""Circuits and branches of random mechanisms, the core's against elimination by polynomials, type by type.

Elimination (``tests/oracles/elimination.py``) uses nothing of the package: all real roots of the products of radicands
over all assemblies are the only inputs at which an assembly can begin or end. For each design the number of branches,
their ends (to 1e-9 rad) and their assemblies must be the same, and each toggle the end of two of them.

    python -m benchmarks.circuits --designs 1000 [--type watt_2]

Types that dyads close from their input, geared fivebars of six ratios, and those that no dyads close: these are
eliminated from another link (``tests/oracles/turning.py``), and their circuits compared one by one. Peaucellier's
cell has a closed form (``tests/kinematics/test_peaucellier_branches.py``). A line a type: designs, designs without a
verdict (no series ended: two roots on one another), branches compared, differences, CPU seconds.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Callable
from functools import partial

import numpy as np

from kinematics.linkage.planar.mechanism import Mechanism
from tests.kinematics import mechanism_sampling as sampling
from tests.kinematics.mechanism_sampling import EVERY, RATIOS, take
from tests.oracles.elimination import Undecided
from tests.support.kinematics.branches import ELIMINATED, same_branches
from tests.support.kinematics.circuits_from_other_links import TURNED, same_circuits
from tests.support.kinematics.peaucellier_branches import same_cell

TURNS = {0.5: 2, 2.0 / 3.0: 3}
"""Turns of the input after which a geared fivebar repeats; one for the other ratios."""

SHOWN = 3
"""Differences that are printed for a type."""


def compared(mechanism: Mechanism, count: int, same: Callable[[Mechanism], int]) -> tuple[int, int, list[int]]:
    """Branches that agree, designs without a verdict, and the numbers of designs that differ."""
    agreed = undecided = 0
    differ = []
    for k in range(count):
        try:
            agreed += same(take(mechanism, k))
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
    jobs: list[tuple[str, Callable[[], Mechanism], Callable[[Mechanism], int]]] = []
    for name in (*ELIMINATED, *TURNED):
        rng = np.random.default_rng([given.seed, list(EVERY).index(name)])
        same = partial(same_circuits, name) if name in TURNED else same_branches
        jobs.append((name, partial(EVERY[name], rng, given.designs), same))
    for n, ratio in enumerate(RATIOS):
        rng = np.random.default_rng([given.seed + 1, n])
        made = partial(sampling.geared_fivebar, rng, given.designs, ratio)
        same = partial(same_branches, turns=TURNS.get(ratio, 1))
        jobs.append((f"geared fivebar, ratio {ratio:.3g}", made, same))
    rng = np.random.default_rng(given.seed + 2)
    jobs.append(("Peaucellier", partial(EVERY["Peaucellier"], rng, given.designs), same_cell))
    for name, make, same in jobs:
        if given.type not in name:
            continue
        mechanism = make()
        begun = time.process_time()
        agreed, undecided, differ = compared(mechanism, given.designs, same)
        spent = time.process_time() - begun
        print(f"{name:<40}{given.designs:>9}{undecided:>12}{agreed:>10}{len(differ):>8}{spent:>9.1f}", flush=True)
        if differ:
            failed += len(differ)
            print(f"    differ: {differ[:SHOWN]}")
    sys.exit(failed > 0)


if __name__ == "__main__":
    main()
