"""Curves of a file, such as the letters of an alphabet, drawn by linkages: how near, how soundly, and how fast.

The file is JSON with an object ``letters`` (or ``curves``) of lists of points by name. A curve is closed if its ends
are as near as its first two points. Distances are the Chamfer distance of Nobari et al. (LInK, TMLR 2024): target and
curve are resampled to 2,000 points of equal arc length, and the mean distances of each from the other are added, as a
share of the root mean square radius of the target. Designs are driven by their loops (tests/oracles/loops.py), strokes
over their whole range; ``false`` counts those whose loops disagree with the answer. ``ratio`` includes the distances of
the traced point from the pins of its link.
"""

from __future__ import annotations

import argparse
import json
import math
import time
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial import cKDTree

from kinematics.arrays import Complex, Real
from synthesis.dispatch import solve
from synthesis.registry import KINDS, parse_problem
from tests.oracles.loops import Followed, Loops
from tests.support.sixbars.driven import find_dyad_pins, transmits

SAMPLE_COUNT = 2000
"""Number of points that both curves are resampled to."""

DRIVE_STEP_COUNT = 2001
"""Number of inputs at which a design is driven."""

MISS_TOLERANCE = 1e-6
"""Difference between reported and independent distances of points, in radii, above which a design is false."""

CLOSURE_SHARE = 1e-6
"""Distance of the ends of a closed curve, in sides of its polyline, below which they are one point."""


def resample(curve: Complex, closed: bool) -> Real:
    """Return points of equal arc length along a polyline, shape (SAMPLE_COUNT, 2)."""
    curve = np.append(curve, curve[0]) if closed else curve
    along = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(curve)))])
    places = np.linspace(0.0, along[-1], SAMPLE_COUNT, endpoint=not closed)
    return np.stack([np.interp(places, along, curve.real), np.interp(places, along, curve.imag)], axis=1)


def chamfer_distance(one: Real, other: Real) -> float:
    """Return the sum of the mean distances of the points of each set from the other."""
    return float(cKDTree(one).query(other)[0].mean() + cKDTree(other).query(one)[0].mean())


def is_closed(curve: Complex) -> bool:
    """Return whether the ends of a curve are as near to each other as its first two points."""
    return bool(abs(curve[-1] - curve[0]) <= 1.1 * abs(curve[1] - curve[0]))


def compute_link_ratio(skeleton: dict[str, Any]) -> float:
    """Return the longest over the shortest distance of two joints of one link, the traced point included."""
    places = {name: complex(*place) for name, place in skeleton["joints"].items()}
    lengths = [abs(places[a] - places[b]) for link in skeleton["links"] for a, b in combinations(link["joints"], 2)]
    return max(lengths) / min(lengths)


def drive_independently(design: Any, closed: bool) -> tuple[Loops, Followed, Followed]:
    """Drive a design by its loops: at its targets, and at equal steps from the first target to the last."""
    skeleton = design.mechanism.skeleton.model_dump(mode="json")
    pivot, pin = (complex(*skeleton["joints"][name]) for name in ("O2", "A"))
    # The nearest place to the first target may be another one than that in which the skeleton is given.
    turns = np.radians([target.input_angle for target in design.targets]) - np.angle(pin - pivot)
    last = math.copysign(2.0 * math.pi, turns[-1] - turns[0]) if closed else turns[-1] - turns[0]
    loops = Loops(skeleton)
    at_targets = loops.followed(turns)
    return loops, at_targets, loops.followed(turns[0] + np.linspace(0.0, last, DRIVE_STEP_COUNT))


def find_falsehood(
    design: Any, loops: Loops, points: Complex, at_targets: Followed, whole: Followed, radius: float
) -> str:
    """Return what the loops of a design do not confirm; empty if they confirm all."""
    if not min(at_targets.branch, whole.branch) > 0.0:
        return "branch"
    reported = np.array([target.point_residual for target in design.targets])
    if np.abs(np.abs(at_targets.points - points) - reported).max() > MISS_TOLERANCE * radius:
        return "distance"
    return "" if transmits(design, loops, whole, find_dyad_pins(design.mechanism.type, loops)) else "angle"


def measure_curve(curve: Complex, mechanisms: list[str], angle: float, seed: int) -> dict[str, Any]:
    """Solve for one curve and measure the designs that pass."""
    closed = is_closed(curve)
    repeats = abs(curve[-1] - curve[0]) < CLOSURE_SHARE * abs(curve[1] - curve[0])
    points = curve[:-1] if closed and repeats else curve
    target = resample(points, closed)
    radius = float(np.sqrt(np.mean(((target - target.mean(axis=0)) ** 2).sum(axis=1))))
    problem = {
        "kind": "path",
        "method": "curve_match",
        "closed": closed,
        "points": [{"x": float(z.real), "y": float(z.imag)} for z in points],
        "mechanisms": mechanisms,
        "constraints": {"min_transmission_angle": angle, "max_link_ratio": 20.0},
        "rank_by": "accuracy",
        "max_designs": 3,
        "seed": seed,
    }
    begun = time.process_time()
    designs = solve(parse_problem(problem), lambda *_: None).designs
    row: dict[str, Any] = {"closed": closed, "seconds": time.process_time() - begun, "distance": math.inf, "false": []}
    for design in designs:
        if not design.verification.passed:
            continue
        loops, at_targets, whole = drive_independently(design, closed)
        row["false"].append(find_falsehood(design, loops, points, at_targets, whole, radius))
        distance = chamfer_distance(resample(whole.points[:-1] if closed else whole.points, closed), target) / radius
        if distance < row["distance"]:
            ratio = compute_link_ratio(design.mechanism.skeleton.model_dump(mode="json"))
            row |= {"distance": distance, "angle": design.metrics.min_transmission_angle, "ratio": ratio}
    return row


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", type=Path)
    parser.add_argument("--names", help="names of the curves, separated by commas; all by default")
    parser.add_argument("--mechanisms", default="eightbar", help="types, separated by commas")
    parser.add_argument("--angle", type=float, default=15.0, help="least transmission angle, degrees")
    parser.add_argument("--seed", type=int, default=0)
    given = parser.parse_args()
    stored = json.loads(given.file.read_text())
    curves = stored.get("letters") or stored["curves"]
    names = given.names.split(",") if given.names else sorted(curves)
    KINDS["path"].warm_up()
    print(f"{'curve':<10}{'closed':>7}{'Chamfer':>9}{'angle':>7}{'ratio':>7}{'CPU s':>7}{'false':>8}")
    rows = []
    for name in names:
        curve = np.array([complex(x, y) for x, y in curves[name]])
        row = measure_curve(curve, given.mechanisms.split(","), given.angle, given.seed)
        rows.append(row)
        faults = [fault for fault in row["false"] if fault]
        print(
            f"{name:<10}{row['closed']!s:>7}{row['distance']:>9.4f}{row.get('angle', math.nan):>7.1f}"
            f"{row.get('ratio', math.nan):>7.1f}{row['seconds']:>7.1f}{len(faults):>4}/{len(row['false'])} "
            f"{' '.join(faults)}",
            flush=True,
        )
    distances = [row["distance"] for row in rows if math.isfinite(row["distance"])]
    seconds = [row["seconds"] for row in rows]
    print(f"{len(distances)} of {len(rows)} drawn")
    if distances:
        print(f"mean {np.mean(distances):.4f}, median {np.median(distances):.4f}, worst {max(distances):.4f}")
    print(f"median {np.median(seconds):.1f} CPU s, most {max(seconds):.1f}")


if __name__ == "__main__":
    main()
