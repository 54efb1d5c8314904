"""Random problems, most of them absurd: each must be answered or refused, never with NaN, a defect, or a hang.

``python -m benchmarks.geometry_fuzz --cases 2000 --kind motion`` prints what became of the cases of
:mod:`benchmarks.geometry_cases`; without ``--kind`` all kinds. A case goes the way of a job: it is read, solved,
written as JSON and read again, and for a part of the answers every file of the first design is made and its motion
computed. Each case has 30 s of CPU; one that needs more is a hang and its process is ended, native code included. The
exit status is 1 where anything is wrong.
"""

from __future__ import annotations

import argparse
import sys
import time

from synthesis.registry import KINDS
from tests.support.problems.geometry_fuzz import tally


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--kind", choices=list(KINDS), action="append", help="only these kinds; all when left out")
    parser.add_argument("--cases", type=int, default=2000)
    parser.add_argument("--first", type=int, default=0, help="the number of the first case")
    parser.add_argument("--workers", type=int, default=1)
    given = parser.parse_args()
    wrong = 0
    for kind in given.kind or KINDS:
        began = time.perf_counter()
        counted = tally(kind, range(given.first, given.first + given.cases), given.workers)
        wrong += len(counted.wrong)
        cpu_s, number = counted.slowest
        results = ", ".join(f"{n} {what}" for what, n in counted.results.most_common())
        print(f"{kind}: {given.cases} cases in {time.perf_counter() - began:.0f} s: {results}")
        print(f"    slowest: case {number}, {cpu_s:.2f} s of CPU")
        print(f"    refused: {', '.join(f'{n} {where}' for where, n in counted.refusals.most_common(12))}")
        for number, outcome in counted.wrong:
            print(f"    WRONG: case {number}: {outcome.what}: {outcome.where}")
        sys.stdout.flush()
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
