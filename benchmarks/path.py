"""Paths through nine points: completeness, counts and times.

    python -m benchmarks.path [--problems 10] [--seed 0]

Nine points of a random fourbar's coupler curve, and nine random points, in turn. `real` and `one circuit` count triples
of cognates; `planted` tells whether the fourbar and both cognates were among the designs, of which those come first
that stand within a box around these three. `complete` is what the answer claims. Times are from the parsed problem to
the verified answer: wall clock with two threads, and CPU. `python -m benchmarks.path_fit` has the tasks of the
literature with more or fewer points, beside the published errors.
"""

from __future__ import annotations

import argparse
import resource
import statistics
import time
from typing import Any

import numpy as np

from kinematics.linkage.fourbar import OPEN_ASSEMBLY, Fourbar, build_cognates, positions
from synthesis.dispatch import solve
from synthesis.kinds.path.design import PathResult
from synthesis.kinds.path.exact.nine_point_system import ORBIT_COUNT
from synthesis.kinds.path.solver import warm_up
from synthesis.registry import parse_problem

LIMIT_S = 3.0

FOUND = 1e-6
"""A planted linkage counts as found when its joints agree to this share of its size."""


def drawn(rng: np.random.Generator) -> tuple[Any, Any]:
    """A fourbar whose input turns through, and nine crank angles in order."""
    while True:
        a, b, c = rng.uniform(0.3, 2.0, 3)
        o2, o4 = rng.normal(size=2) + 1j * rng.normal(size=2)
        d = abs(o4 - o2)
        sides = sorted([a, b, c, d])
        if min(a, d) == sides[0] and sides[0] + sides[3] < 0.98 * (sides[1] + sides[2]):
            point = b * complex(rng.normal(), rng.normal())
            return Fourbar(o2, o4, a, b, c, point), np.sort(rng.uniform(0.0, 2.0 * np.pi, 9))


def is_among(result: PathResult, linkage: Any, start: float) -> bool:
    """Whether the fourbar and both of its cognates are among the designs."""
    first = complex(positions(linkage, start, OPEN_ASSEMBLY).p)
    found = np.array(
        [
            [complex(*design.mechanism.fixed_pivots.input), complex(*design.mechanism.fixed_pivots.output)]
            for design in result.designs
        ]
    )
    pair = build_cognates(linkage)
    wanted = [linkage, pair.left.linkage, pair.right.linkage]
    size = max(abs(first - linkage.input_pivot), abs(linkage.output_pivot - linkage.input_pivot))
    return all(
        np.abs(found - np.array([complex(one.input_pivot), complex(one.output_pivot)])).max(axis=1).min() < FOUND * size
        for one in wanted
    )


def around(linkage: Any) -> dict[str, list[float]]:
    """A box around the pivots of a fourbar and its cognates."""
    pair = build_cognates(linkage)
    pivots = np.array(
        [
            complex(z)
            for one in (linkage, pair.left.linkage, pair.right.linkage)
            for z in (one.input_pivot, one.output_pivot)
        ]
    )
    margin = 0.01 * float(np.abs(pivots - pivots.mean()).max())
    return {
        "x": [float(pivots.real.min()) - margin, float(pivots.real.max()) + margin],
        "y": [float(pivots.imag.min()) - margin, float(pivots.imag.max()) + margin],
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--problems", type=int, default=10)
    parser.add_argument("--seed", type=int, default=0)
    arguments = parser.parse_args()
    rng = np.random.default_rng(arguments.seed)
    warm_up()
    walls, complete, counted, planted, plants = [], 0, 0, 0, 0
    columns = f"{'one circuit':>13}{'planted':>9}{'complete':>10}{'wall s':>8}{'CPU s':>7}"
    print(f"{'points':<14}{'triples':>8}{'real':>6}{columns}")
    for n in range(arguments.problems):
        linkage = angles = None
        points = rng.normal(size=9) + 1j * rng.normal(size=9)
        constraints: dict[str, Any] = {"same_branch": False, "in_order": False}
        if n % 2 == 0:
            linkage, angles = drawn(rng)
            points = positions(linkage, angles, OPEN_ASSEMBLY).p
            constraints["fixed_pivot_region"] = around(linkage)
        problem = parse_problem(
            {
                "kind": "path",
                "points": [{"x": z.real, "y": z.imag} for z in points],
                "constraints": constraints,
                "max_designs": 200,
                "include_failed": True,
            }
        )
        began, cpu = time.perf_counter(), time.process_time()
        result = solve(problem, lambda share, message: None)
        walls.append(time.perf_counter() - began)
        assert isinstance(result, PathResult)
        word = ""
        if linkage is not None and angles is not None:
            plants += 1
            found = is_among(result, linkage, float(angles[0]))
            planted += found
            word = "yes" if found else "NO"
        complete += result.search.complete
        triples = result.triples
        assert triples is not None
        counted += triples.computed == ORBIT_COUNT and triples.closed_under_conjugation
        print(
            f"{'of a fourbar' if word else 'random':<14}{triples.computed:>8}{triples.real:>6}"
            f"{triples.on_one_circuit:>13}{word:>9}{'yes' if result.search.complete else 'no':>10}"
            f"{walls[-1]:>8.2f}{time.process_time() - cpu:>7.2f}"
        )
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(f"all {ORBIT_COUNT} triples, closed under conjugation: {counted} of {len(walls)}")
    print(f"complete: {complete} of {len(walls)}; planted linkage and cognates found: {planted} of {plants}")
    print(
        f"wall: median {statistics.median(walls):.2f} s, worst {max(walls):.2f} s (limit {LIMIT_S} s); {memory:.0f} MiB"
    )


if __name__ == "__main__":
    main()
