"""Tasks from practice: is the first design of the answer one that a shop can build, or any of its designs?

    python -m benchmarks.practice [--only TEXT] [--verbose]

No task limits the transmission angle, the link ratio or the order of the designs unless its name says so. A design
counts as buildable if

* it has parts, as ``GET /v1/jobs/{id}/designs/{n}/parts`` makes them for a laser, each checked in motion for
  interference (:mod:`service.parts`), which knows nothing of the order of designs;
* two pins of a link are nowhere nearer than a fiftieth of the longest side of a link, or than the pin diameter that
  the task gives;
* the transmission angle is at least 20 degrees, the link ratio at most 10, and no side of a link longer than five
  times the length that the task names; and
* the error is at most that which the task permits. For gears: no gear has fewer teeth than undercut permits.

Printed are the first fault of the first design of each task, and how many first designs, and how many answers with any
such design, there are.
"""

from __future__ import annotations

import argparse
import math
import time
from collections.abc import Callable, Sequence
from itertools import combinations
from typing import Any, NamedTuple

from service.parts.assembly.sizes import NotMade, PartsQuery
from service.parts.registry import make_parts
from synthesis import parse_problem, solve

MIN_ANGLE, MAX_RATIO, MAX_REACH = 20.0, 10.0, 5.0
"""Minimum transmission angle, degrees, maximum link ratio, and maximum side of a link in lengths of the task."""

MIN_PIN_SHARE = 0.02
"""Minimum distance of two pins of a link, as a share of the longest side of a link."""

MIN_UNDERCUT_TEETH = 17
"""Minimum number of teeth of a straight 20° gear without shift that is not undercut."""

Statement = dict[str, Any]

Fault = Callable[[Any], str]
"""Callable that returns what a design lacks beyond the faults of every linkage; empty if nothing."""


class Task(NamedTuple):
    """A task: its name, its statement, its length in length units (0 without one), and further requirements."""

    name: str
    statement: Statement
    length: float = 0.0
    fault: Fault = lambda design: ""


def limit(metric: str, most: float) -> Fault:
    """Return a requirement that a metric is at most a value."""

    def find_fault(design: Any) -> str:
        value = abs(getattr(design.metrics, metric))
        return f"{metric} {value:.4g} > {most:g}" if value > most else ""

    return find_fault


def limit_function_error(most: float) -> Fault:
    """Return a requirement that the structural error is at most a value, degrees."""

    def find_fault(design: Any) -> str:
        return f"error {design.structural_error.max:.4g} > {most:g}" if design.structural_error.max > most else ""

    return find_fault


def check_tie_rod(track: float, wheel: float) -> Fault:
    """Return a requirement that the pins of the tie rod keep inside wheels of a diameter on a track."""

    def find_fault(design: Any) -> str:
        joints = design.mechanism.skeleton.joints
        # Wheels of half their diameter before and behind the axle, a tenth of the diameter from their middle plane.
        outside = max(abs(joints["A"][0]), abs(joints["B"][0])) > 0.5 * track - 0.15 * wheel
        return "tie rod in the wheels" if outside and abs(joints["A"][1]) < 0.5 * wheel else ""

    return find_fault


def check_undercut(design: Any) -> str:
    """Return a fault for a train of straight gears with an undercut pinion."""
    least = min(min(stage.driver, stage.driven) for stage in design.mechanism.stages)
    return f"pinion of {least} teeth" if least < MIN_UNDERCUT_TEETH else ""


def poses(*listed: tuple[float, float, float]) -> list[Statement]:
    """Return positions of a body."""
    return [{"x": x, "y": y, "angle": angle} for x, y, angle in listed]


def points(*listed: tuple[float, float]) -> list[Statement]:
    """Return points of a path."""
    return [{"x": x, "y": y} for x, y in listed]


def function(name: str, x: tuple[float, float], spans: tuple[float, float], **more: Any) -> Statement:
    """Return the statement of a function with ranges of input and output, degrees."""
    stated = {"name": name, "x": list(x), **({"exponent": more.pop("exponent")} if "exponent" in more else {})}
    return {"kind": "function", "function": stated, "input_range": spans[0], "output_range": spans[1], **more}


STEP = points(
    (-75, 0), (-50, -1), (-25, 0), (0, 0.5), (25, 0), (50, -1), (75, 0), (86, 10), (75, 27), (45, 42), (10, 47),
    (-30, 42), (-65, 28), (-82, 11),
)  # fmt: skip
CLAW = points((0, 0), (9, 0.3), (18, 0), (21, 3), (18, 8), (10, 10.5), (2, 8.5), (-2, 3.5))


def turn_points(count: int, x: float, y: float, skew: float) -> list[Statement]:
    """Return points of a closed curve like an ellipse with the semi-axes ``x`` and ``y``."""
    turns = [math.tau * n / count for n in range(count)]
    return points(*((x * math.cos(turn), y * math.sin(turn) * (1.0 + skew * math.cos(turn))) for turn in turns))


def motion(name: str, length: float, *listed: tuple[float, float, float], **more: Any) -> Task:
    """Return a task of positions of a body."""
    return Task(name, {"kind": "motion", "positions": poses(*listed), **more}, length)


WIDE_LINKS = {"link_width": 16.0, "pin_diameter": 8.0, "thickness": 6.0, "gap": 0.5}

BODIES = (
    motion("cabinet hinge", 62.0, (0, 0, 0), (28, 22, 48), (20, 60, 95)),
    motion("garage door", 1580.0, (0, 0, 90), (380, 900, 45), (1050, 1180, 0)),
    motion("hatch", 283.0, (0, 0, 0), (90, 150, 35), (40, 280, 80)),
    motion("excavator bucket", 437.0, (0, 0, 0), (140, -180, 45), (120, -420, 100)),
    motion("folding step", 281.0, (0, 0, 0), (60, -70, 30), (70, -190, 70), (20, -280, 100)),
    motion("transfer arm", 300.0, (0, 0, 0), (150, 60, 0), (300, 0, 0)),
    motion("tipping bucket", 300.0, (0, 0, 0), (50, 120, 20), (60, 230, 70), (10, 300, 120)),
    motion("latch", 15.0, (0, 0, 0), (12, 9, 35)),
    motion("bonnet, five positions", 330.0, (0, 0, 0), (-10, 60, 9), (-5, 130, 20), (25, 230, 38), (75, 320, 58)),
    motion("links 16 mm wide", 175.0, (0, 0, 0), (70, 60, 30), (90, 150, 75), layout=WIDE_LINKS),
    motion("small flap, links 16 mm wide", 60.0, (0, 0, 0), (40, 15, -25), (55, 5, -60), layout=WIDE_LINKS),
    Task(
        "loader arm, seven positions",
        {
            "kind": "motion",
            "method": "least_squares",
            "positions": poses(
                (0, 0, 0), (40, 90, 4), (60, 190, 9), (55, 300, 15), (30, 410, 24), (-15, 500, 36), (-70, 570, 52)
            ),
        },
        575.0,
        limit("rms_residual", 0.03),
    ),
)  # fmt: skip
"""Bodies that are carried through positions."""

FUNCTIONS = (
    Task(
        "gripper jaws 1:-1",
        {
            "kind": "function",
            "mechanisms": "auto",
            "pairs": [
                {"input": 40.0, "output": 140.0}, {"input": 55.0, "output": 125.0}, {"input": 70.0, "output": 110.0}
            ],
        },
        fault=limit_function_error(0.05),
    ),
    Task(
        "gripper jaws, whole range",
        function("power", (1.0, 2.0), (40.0, -40.0), exponent=1.0, mechanisms="auto"),
        fault=limit_function_error(0.05),
    ),
    Task(
        "throttle, square law",
        function("power", (0.0, 1.0), (80.0, 80.0), exponent=2.0),
        fault=limit_function_error(2.0),
    ),
    Task("logarithmic gauge", function("logarithm", (1.0, 5.0), (70.0, 70.0)), fault=limit_function_error(0.5)),
    Task("sine lever", function("sine", (0.0, 90.0), (90.0, 60.0)), fault=limit_function_error(1.0)),
)  # fmt: skip
"""Levers whose output follows their input."""

PATHS = (
    Task(
        "walking leg",
        {"kind": "path", "method": "curve_match", "closed": True, "points": STEP},
        168.0,
        limit("rms_distance", 5.0),
    ),
    Task("film claw", {"kind": "path", "closed": True, "points": CLAW}, 24.0, limit("rms_distance", 0.8)),
    Task(
        "feeder, five points",
        {"kind": "path", "points": points((0, 0), (30, 28), (70, 40), (110, 30), (140, 0))},
        140.0,
    ),
    Task(
        "stirrer",
        {"kind": "path", "closed": True, "points": turn_points(16, 80.0, 35.0, 0.25)},
        160.0,
        limit("rms_distance", 4.0),
    ),
    Task(
        "mixer, drawn curve",
        {"kind": "path", "method": "curve_match", "closed": True, "points": turn_points(40, 60.0, 30.0, 0.2)},
        120.0,
        limit("rms_distance", 3.0),
    ),
    Task(
        "tray",
        {"kind": "parallel_motion", "path": {"kind": "path", "closed": True, "points": turn_points(12, 90, 40, 0.1)}},
        180.0,
    ),
    Task("straight line", {"kind": "straight_line", "length": 120.0}, 120.0, limit("straightness_error", 1.0)),
    Task(
        "straight line by a crank",
        {"kind": "straight_line", "length": 80.0, "crank_range": 140.0},
        80.0,
        limit("straightness_error", 1.0),
    ),
)
"""Points on curves."""

STROKES = (
    Task("wiper", {"kind": "quick_return", "time_ratio": 1.0, "swing": 95.0, "rocker_length": 40.0}),
    Task("rocker of 60 mm", {"kind": "quick_return", "time_ratio": 1.15, "swing": 50.0, "rocker_length": 60.0}, 51.0),
    Task("sieve", {"kind": "quick_return", "time_ratio": 1.3, "swing": 30.0, "rocker_length": 120.0}, 62.0),
    Task("shaper", {"kind": "quick_return", "time_ratio": 1.5, "stroke": 200.0}, 200.0),
    Task("pump", {"kind": "quick_return", "time_ratio": 1.1, "stroke": 40.0}, 40.0),
    Task("press that rests", {"kind": "dwell", "dwell_angle": 50.0, "output": {"type": "slider", "stroke": 80}}, 80.0),
    Task("lever that rests", {"kind": "dwell", "dwell_angle": 60.0, "output": {"type": "rocker", "swing": 60.0}}),
)
"""Outputs that move to and fro."""


def steer(name: str, size: tuple[float, float, float], lock: float, wheel: float, **more: Any) -> Task:
    """Return a task of steering, with wheelbase, distance of the kingpins and track, and the diameter of the wheels."""
    wheelbase, pivots, track = size
    stated = {"wheelbase": wheelbase, "pivot_distance": pivots, "track": track, "lock": lock, **more}
    return Task(name, {"kind": "steering", **stated}, pivots, check_tie_rod(track, wheel))


STEERING = (
    steer("steering of a cart", (1200.0, 700.0, 820.0), 35.0, 400.0),
    steer("steering of a van", (3300.0, 1450.0, 1700.0), 42.0, 680.0),
    steer(
        "steering by accuracy", (2700.0, 1300.0, 1500.0), 38.0, 600.0, arm_length={"min": 0.01, "max": 600.0},
        rank_by="accuracy",
    ),
)  # fmt: skip

GEARS = (
    Task(
        "clock 12:1",
        {
            "kind": "gear_train", "ratio": "12", "max_stages": 2, "teeth": {"min": 10, "max": 80}, "reverted": True,
            "tolerance": 0.0,
        },
        fault=check_undercut,
    ),
    Task(
        "winch 20:1",
        {"kind": "gear_train", "ratio": "20", "max_stages": 2, "teeth": {"min": 12, "max": 100}, "tolerance": 0.002},
        fault=check_undercut,
    ),
)  # fmt: skip

TASKS = (*BODIES, *FUNCTIONS, *PATHS, *STROKES, *STEERING, *GEARS)


def find_fault(task: Task, problem: Any, design: Any) -> str:
    """Return the first reason why a design of a task cannot be built; empty if it can."""
    if not design.verification.passed:
        return "failed checks"
    if hasattr(design.mechanism, "skeleton"):
        fault = find_linkage_fault(task, design)
        if fault:
            return fault
    fault = task.fault(design)
    if fault:
        return fault
    try:
        make_parts(design, problem, PartsQuery())
    except NotMade as error:
        return f"no parts: {error}"[:90]
    return ""


def find_linkage_fault(task: Task, design: Any) -> str:
    """Return what a linkage lacks in its dimensions and in the transmission of force."""
    metrics = design.metrics
    if metrics.min_transmission_angle < MIN_ANGLE * (1.0 - 1e-6):
        return f"transmission angle {metrics.min_transmission_angle:.1f}°"
    if metrics.link_ratio > MAX_RATIO * (1.0 + 1e-6):
        return f"link ratio {metrics.link_ratio:.3g}"
    sides, pins = list_distances(design, pins_only=False), list_distances(design, pins_only=True)
    if task.length and max(sides) > MAX_REACH * task.length:
        return f"a link of {max(sides):.4g} for a task of {task.length:g}"
    sizes = task.statement.get("layout", {})
    least = max(MIN_PIN_SHARE * max(sides), sizes.get("pin_diameter", 0.0))
    return f"pins {min(pins):.3g} apart, {least:.3g} needed" if min(pins) < least else ""


def list_distances(design: Any, *, pins_only: bool) -> Sequence[float]:
    """Return the distances of two different joints of a link or of the ground, with P or of pins only."""
    skeleton = design.mechanism.skeleton
    at = {name: complex(*place) for name, place in skeleton.joints.items()}
    sliding = {slide.joint for slide in skeleton.slides}
    pins = {name for name in at if name in sliding or sum(name in link.joints for link in skeleton.links) > 1}
    joints = pins if pins_only else at.keys()
    apart = [
        abs(at[a] - at[b])
        for link in skeleton.links
        for a, b in combinations([n for n in link.joints if n in joints], 2)
    ]
    return [length for length in apart if length > 1e-9 * max(apart)]


def main() -> None:
    """Judge all tasks."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", default="", help="tasks whose name contains this text")
    parser.add_argument("--verbose", action="store_true", help="also the summary of each answer")
    given = parser.parse_args()
    first, some, seconds = 0, 0, []
    tasks = [task for task in TASKS if given.only in task.name]
    for task in tasks:
        problem = parse_problem(task.statement)
        begun = time.perf_counter()
        result = solve(problem)
        seconds.append(time.perf_counter() - begun)
        faults = [find_fault(task, problem, result.designs[0]) if result.designs else "no design"]
        # The others matter only if the first cannot be built.
        rest = result.designs[1:] if faults[0] else []
        which = next((n for n, design in enumerate(rest, 2) if not find_fault(task, problem, design)), None)
        first += not faults[0]
        some += not faults[0] or which is not None
        other = "" if not faults[0] else f"; {'none' if which is None else f'number {which}'} of {len(result.designs)}"
        print(f"{task.name:<28}{seconds[-1]:>7.1f} s  {faults[0] + other or 'buildable'}", flush=True)
        if given.verbose:
            print(f"    {result.summary}", flush=True)
    print(f"of {len(tasks)} tasks: first design buildable {first}, any design buildable {some}")


if __name__ == "__main__":
    main()
