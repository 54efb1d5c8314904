"""What ``auto`` costs: motion tasks of three positions that have a sound fourbar, with ``mechanisms`` and without."""

from __future__ import annotations

import numpy as np

from tests.support.sixbars.motion import on_a_way, solved, sound

TASKS = 100


def table(tasks: int, seed: int) -> None:
    rng = np.random.default_rng(seed)
    without, auto = [], []
    for _ in range(tasks):
        task = on_a_way(rng, 3)
        result, processor, _ = solved(task)
        if sound(result):
            again, longer, _ = solved(task, mechanisms="auto")
            assert again.designs == result.designs
            without.append(processor)
            auto.append(longer)
    share = 100.0 * (sum(auto) / sum(without) - 1.0)
    print(f"auto on {len(auto)} tasks with a sound fourbar: {share:+.1f} % time, the same answers")
