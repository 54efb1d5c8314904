"""Parallel motion: sixbars from fourbars of every class and from a path, how truly their bodies translate, and times.

    python -m benchmarks.parallel_motion

Times are of the process (CPU), after the kernels are loaded; for the given fourbars medians of one. ``turn`` is the
greatest rotation of a body in any of the answers' designs, degrees, and ``off`` the greatest distance of its point P
from the given curve as a share of the longest link, both as verification measures them. The output of a double crank
and of a triple rocker passes the ground line, where guide and body come into one line: they have no such sixbar.
"""

from __future__ import annotations

import statistics
import time
from typing import Any

import numpy as np

from kinematics.linkage.fourbar import Fourbar, barker_class
from synthesis.dispatch import solve
from synthesis.kinds.parallel_motion.solver import warm_up
from synthesis.registry import parse_problem

FOURBARS = 40
"""Random fourbars, half of them crossed."""

PATH: dict[str, Any] = {
    "kind": "path",
    "timing": "prescribed",
    "points": [
        {"x": 0.0, "y": 0.0, "crank_angle": 0.0},
        {"x": 12.0, "y": 9.0, "crank_angle": 40.0},
        {"x": 28.0, "y": 10.0, "crank_angle": 80.0},
        {"x": 40.0, "y": 2.0, "crank_angle": 120.0},
    ],
}


def answered(stated: dict[str, Any]) -> tuple[Any, float]:
    """The answer to a problem and the processor's seconds."""
    problem = parse_problem({"kind": "parallel_motion", **stated})
    begun = time.process_time()
    return solve(problem, lambda share, words: None), time.process_time() - begun


def fourbars() -> list[dict[str, Any]]:
    rng = np.random.default_rng(3)
    found = []
    while len(found) < FOURBARS:
        a, b, c, d = np.exp(rng.uniform(-1.0, 1.0, 4)).tolist()
        if max(a, b, c, d) < 0.48 * (a + b + c + d):
            found.append(
                {
                    "fixed_pivots": {"input": [0.0, 0.0], "output": [d, 0.0]},
                    "links": {"input": a, "coupler": b, "output": c},
                    "coupler_point": {"distance": float(rng.uniform(0.3, 2.0)), "angle": float(rng.uniform(20, 340))},
                    "assembly": ("open", "crossed")[len(found) % 2],
                }
            )
    return found


def main() -> None:
    warm_up()
    classes: dict[str, list[tuple[int, float, float, float]]] = {}
    for linkage in fourbars():
        result, took = answered({"linkage": linkage, "max_designs": 6})
        links, ground = linkage["links"], linkage["fixed_pivots"]["output"][0]
        of = barker_class(Fourbar.from_lengths(links["input"], links["coupler"], links["output"], ground))
        turn = max((d.metrics.rotation for d in result.designs), default=0.0)
        off = max((d.metrics.curve_distance or 0.0 for d in result.designs), default=0.0)
        row = len(result.designs), turn, off / max(*links.values(), ground), took
        classes.setdefault(of.motion, []).append(row)
    print(f"{'given fourbar':<16}{'tasks':>6}{'solved':>8}{'sixbars':>9}{'turn °':>10}{'off':>10}{'s CPU':>8}")
    for name, rows in sorted(classes.items()):
        counts, turns, offs, times = zip(*rows, strict=True)
        print(
            f"{name:<16}{len(rows):>6}{sum(map(bool, counts)):>8}{sum(counts):>9}{max(turns):>10.1e}{max(offs):>10.1e}"
            f"{statistics.median(times):>8.3f}"
        )
    result, took = answered({"path": PATH})
    turn = max((d.metrics.rotation for d in result.designs), default=0.0)
    print(
        f"{'a timed path':<16}{1:>6}{bool(result.designs):>8}{len(result.designs):>9}{turn:>10.1e}{'':>10}{took:>8.3f}"
    )


if __name__ == "__main__":
    main()
