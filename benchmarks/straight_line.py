"""Straight lines: Norton's Table 3-1 beside what is found, the other types, and times.

    python -m benchmarks.straight_line

Times are of the process (CPU), after the kernels are loaded.
"""

from __future__ import annotations

import time
from typing import Any

import numpy as np

from synthesis.dispatch import solve
from synthesis.kinds.straight_line.problem import LINE_MECHANISMS
from synthesis.registry import parse_problem
from tests.cases import load
from tests.support.synthesis.straight_line import norton_path


def solved(**fields: Any) -> tuple[Any, float]:
    problem = parse_problem({"kind": "straight_line", "length": 100.0, "max_designs": 50, **fields})
    begun = time.process_time()
    result = solve(problem, lambda fraction, message: None)
    return result, time.process_time() - begun


def known_rows() -> dict[tuple[str, float], tuple[float, ...]]:
    """ΔCy % and ΔV % of the table's rows, by objective and range: as printed, and as their linkages have them."""
    found = {}
    for case in load():
        if case.kind == "straight_line_optimum" and case.inputs is not None:
            x = case.inputs
            measure = "straightness" if x["objective"] == "straightness" else "velocity"
            path = norton_path(x["L1_over_L2"], x["L3_over_L2_exact"], x["dbeta"])
            speed = np.diff(path.real)
            own = 100.0 * np.ptp(path.imag) / np.ptp(path.real), 100.0 * np.ptp(speed) / speed.mean()
            found[measure, float(x["dbeta"])] = (case.expected["dCy_pct"].value, case.expected["dV_pct"].value, *own)
    return found


def table() -> None:
    known = known_rows()
    print("Hoeken's linkage; errors in percent, the optimized one marked *. printed: Norton, Table 3-1, rounded;")
    print("row: a linkage of the row's proportions, measured at 20 001 places; over: found to row, of the optimized")
    print(
        f"{'optimized':>13} {'range':>6}  {'printed dCy':>12} {'dV':>7}   {'row dCy':>10} {'dV':>9}   "
        f"{'found dCy':>10} {'dV':>9}   {'over':>6} {'s CPU':>6}"
    )
    for measure in ("straightness", "velocity"):
        for span in range(20, 200, 20):
            result, took = solved(mechanism="hoeken", crank_range=float(span), optimize=measure)
            metrics = result.designs[0].metrics
            found = metrics.straightness_error, metrics.velocity_variation
            row = known.get((measure, float(span)))
            own = 0 if measure == "straightness" else 1
            before, over = f"{'not in the cases':>43}", ""
            if row is not None:
                before = f"{row[0]:12.3g} {row[1]:7.3g}   {row[2]:10.4g} {row[3]:9.4g}"
                over = f"{found[own] / row[2 + own]:6.3f}"
            stars = ("*", " ") if measure == "straightness" else (" ", "*")
            print(
                f"{measure:>13} {span:5d}°  {before}   {found[0]:10.4g}{stars[0]} {found[1]:8.4g}{stars[1]} "
                f"{over:>6} {took:6.2f}"
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
