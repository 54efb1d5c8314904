"""Davis's steering gear, which steers correctly at every angle: its arms lean by α with 2 tan α = w/L.

The arms spread if the bar is behind the kingpins and close if it is ahead. With the bar at the height h and moved by x
the outer wheel turns to tan⁻¹(tan α + x/h) − α and the inner one to α − tan⁻¹(tan α − x/h); every lock below a right
angle is reached.
"""

from __future__ import annotations

import cmath
import math

from kinematics.linkage.steering import compute_davis_arm_angle, compute_outer_angle
from synthesis.kinds.steering.design import DavisMechanism
from synthesis.kinds.steering.problem import SteeringProblem
from synthesis.model.linkage.conversion import build_skeleton, build_slide, to_point

SLOT_LENGTH_RATIO = 1.1
"""Length of the slotted arms relative to the minimum that they need at the lock."""


def build_davis_gears(problem: SteeringProblem) -> list[DavisMechanism]:
    """Return the gear with its bar on each allowed side."""
    return [_build_mechanism(problem, -1.0 if side == "behind" else 1.0) for side in problem.sides]


def _build_mechanism(problem: SteeringProblem, ahead: float) -> DavisMechanism:
    """Build the gear in the straight position, its kingpins on the x-axis, the vehicle along y."""
    half, ratio = 0.5 * problem.pivot_distance, problem.pivot_distance / problem.wheelbase
    lean, lock = float(compute_davis_arm_angle(ratio)), math.radians(problem.lock)
    length = 0.5 * sum(problem.arms) * problem.pivot_distance
    arm = ahead * length * complex(math.sin(lean), math.cos(lean))
    # The arm that deviates most from the normal of the bar needs the longest slot.
    leaning = max(lean + float(compute_outer_angle(lock, ratio)), lock - lean)
    slot = SLOT_LENGTH_RATIO * math.cos(lean) / math.cos(leaning) * arm
    places = {
        "O2": complex(-half),
        "O4": complex(half),
        "A": -half + arm,
        "B": half - arm.conjugate(),
        "C": -half + slot,
        "D": half - slot.conjugate(),
    }
    return DavisMechanism(
        fixed_pivots={name: to_point(places[name]) for name in ("O2", "O4")},
        links={"ground": 2.0 * half, "bar": abs(places["B"] - places["A"])},
        skeleton=build_skeleton(
            places,
            {"ground": ["O2", "O4"], "bar": ["A", "B"], "left_arm": ["O2", "C"], "right_arm": ["O4", "D"]},
            slides=[
                build_slide("A", "ground", places["A"], 0.0),
                build_slide("B", "ground", places["A"], 0.0),
                build_slide("A", "left_arm", places["O2"], cmath.phase(arm)),
                build_slide("B", "right_arm", places["O4"], cmath.phase(-arm.conjugate())),
            ],
            input_link="A",
        ),
    )
