"""Layouts of random linkages against solids that are moved through the motion, and against every arrangement.

    python -m benchmarks.layout [linkages] [seed]

Each linkage is driven by :mod:`tests.support.independent.drive` in steps of a quarter of a degree. Its plates and pins
are prisms and cylinders there, whose distance is the greatest gap of their supports in any direction that may part
them. Checked are: that no two solids in the planes of the answer come too near within its free range; that the number
of planes, and of plates in the way of pins, is that of the best of all arrangements; and that no longer range is free.
Linkages of which some pair keeps the gap by less than steps of a quarter of a degree can tell are left out of the
last two.
"""

from __future__ import annotations

import sys
from copy import deepcopy

import numpy as np

from tests.support.problems.layout import Verdict, judged, tasks


def main() -> int:
    """Print what came of them; 1 where anything is wrong."""
    count, seed = (int(text) for text in (sys.argv[1:] + ["500", "1"][len(sys.argv) - 1 :])[:2])
    verdicts: list[Verdict] = []
    loaded: set[str] = set()
    for task, drive in tasks(count, seed):
        if task.kind not in loaded:
            deepcopy(task).answer()  # loads the kernels; of the linkage itself nothing is known by that
            loaded.add(task.kind)
        verdict = judged(task, drive)
        verdicts.append(verdict)
        if verdict.said:
            print(f"{len(verdicts)} {task.kind}: {verdict.said}", flush=True)
    told = [verdict for verdict in verdicts if verdict.told]
    seconds = 1e3 * np.array([verdict.seconds for verdict in verdicts])
    print(f"{sum(v.clear for v in verdicts)} of {count} linkages: no solids meet in the free range")
    print(f"{sum(v.right for v in told)} of {len(told)} that can be told: crossings, stubs, least planes, free range")
    print(f"{sum(v.buildable for v in verdicts)} can be built over their whole motion")
    print(f"{np.count_nonzero(seconds <= 50.0)} of {count} laid out within 50 ms of processor time")
    print(f"CPU time of a layout: median {np.median(seconds):.1f} ms, 95 % {np.percentile(seconds, 95):.1f} ms, "
          f"worst {seconds.max():.1f} ms")  # fmt: skip
    return int(not all(v.clear and v.right for v in verdicts))


if __name__ == "__main__":
    sys.exit(main())
