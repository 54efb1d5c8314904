"""Straight lines: Norton's Table 3-1 beside what is found, the other types, and times.

    python -m benchmarks.straight_line

Times are of the process (CPU), after the kernels are loaded.
"""

from __future__ import annotations

import time
from typing import Any

from synthesis.dispatch import solve
from synthesis.kinds import parse_problem
from synthesis.problems.straight_line import LINE_MECHANISMS
from tests.cases import load


def solved(**fields: Any) -> tuple[Any, float]:
    problem = parse_problem({"kind": "straight_line", "length": 100.0, "max_designs": 50, **fields})
    begun = time.process_time()
    result = solve(problem, lambda fraction, message: None)
    return result, time.process_time() - begun


def printed() -> dict[tuple[str, float], tuple[float, float]]:
    """ΔCy % and ΔV % of the table's rows, by objective and range."""
    found = {}
    for case in load():
        if case.kind == "straight_line_optimum" and case.inputs is not None:
            measure = "straightness" if case.inputs["objective"] == "straightness" else "velocity"
            values = case.expected["dCy_pct"].value, case.expected["dV_pct"].value
            found[measure, float(case.inputs["dbeta"])] = values
    return found


def table() -> None:
    known = printed()
    print("Hoeken's linkage; errors in percent, the optimized one marked *; printed: Norton, Table 3-1")
    print(f"{'optimized':>13} {'range':>6}  {'printed dCy':>12} {'dV':>8}   {'found dCy':>12} {'dV':>8}  {'s CPU':>6}")
    for measure in ("straightness", "velocity"):
        for span in range(20, 200, 20):
            result, took = solved(mechanism="hoeken", crank_range=float(span), optimize=measure)
            metrics = result.designs[0].metrics
            row = known.get((measure, float(span)))
            before = f"{'not in the cases':>21}" if row is None else f"{row[0]:12.3g} {row[1]:8.3g}"
            stars = ("*", " ") if measure == "straightness" else (" ", "*")
            print(
                f"{measure:>13} {span:5d}°  {before}   {metrics.straightness_error:11.3g}{stars[0]} "
                f"{metrics.velocity_variation:7.3g}{stars[1]}  {took:6.2f}"
            )


def types() -> None:
    print("\nAll types at their usual ranges")
    head = f"{'type':>14} {'optimized':>13} {'proportions':>12} {'dCy %':>9} {'dV %':>8} {'trans.':>7} {'s CPU':>6}"
    print(head)
    for name in (*LINE_MECHANISMS, "auto"):
        for measure in ("straightness", "velocity"):
            result, took = solved(mechanism=name, optimize=measure)
            if name == "auto":
                print(f"{name:>14} {measure:>13} {len(result.designs):3d} designs {'':35}{took:6.2f}")
                continue
            for design in result.designs:
                m = design.metrics
                print(
                    f"{name:>14} {measure:>13} {m.proportions:>12} {m.straightness_error:9.2g} "
                    f"{m.velocity_variation:8.3g} {m.min_transmission_angle:6.1f}° {took:6.2f}"
                )


def main() -> None:
    solved(mechanism="hoeken")
    table()
    types()


if __name__ == "__main__":
    main()
