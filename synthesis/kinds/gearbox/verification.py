"""Verification of a finished machine-tool gearbox, from its tooth numbers alone, in exact fractions."""

from __future__ import annotations

import math
from fractions import Fraction

from kinematics.gear.gearbox import list_spindle_speeds
from kinematics.gear.teeth import Mesh
from synthesis.kinds.gearbox.design import GearboxMechanism, GearboxMetrics, ShaftSpeeds, SpindleSpeed
from synthesis.kinds.gearbox.problem import GearboxProblem
from synthesis.model.answer import Check, Verification
from synthesis.model.gears.ratio_target import parse_decimal

ROUNDING_TOLERANCE = 1e-12
"""Slack for the logarithms of the speeds, which are rounded by some 1e-15 on each side."""


def verify(problem: GearboxProblem, mechanism: GearboxMechanism) -> Verification:
    """Check every constraint on a gearbox."""
    stages = _read_teeth(mechanism)
    errors = _compute_errors(problem, mechanism)
    sums = [{driver + driven for driver, driven in pairs} for pairs in stages]
    every = [pair for pairs in stages for pair in pairs]
    low, high = problem.teeth.min, problem.teeth.max
    # Driven speed over driving speed is driver over driven teeth.
    ratios = [Fraction(*pair) for pair in every]
    meshes = (Mesh.standard(pair, mechanism.module, math.radians(mechanism.pressure_angle)) for pair in every)
    least, most = problem.stage_ratio.min, problem.stage_ratio.max
    counts = [len(pairs) for pairs in stages]
    checks = [
        Check(
            name="speeds",
            passed=len(errors) == problem.speeds.count
            and max(errors, default=0.0) <= problem.widest + ROUNDING_TOLERANCE,
            value=max(errors, default=None),
            limit=problem.widest,
        ),
        Check(
            name="equal_tooth_sums",
            passed=all(
                len(own) == 1 and problem.tooth_sum.min <= min(own) and max(own) <= problem.tooth_sum.max
                for own in sums
            ),
        ),
        Check(name="tooth_limits", passed=all(low <= z <= high for pair in every for z in pair)),
        Check(
            name="stage_ratios",
            passed=all(
                least * (1.0 - ROUNDING_TOLERANCE) <= float(r) <= most * (1.0 + ROUNDING_TOLERANCE) for r in ratios
            ),
        ),
        Check(name="structure", passed=problem.structure is None or counts == problem.structure),
        Check(name="interference", passed=not any(mesh.interferes for mesh in meshes)),
    ]
    if problem.cluster_difference:
        steps = [sorted(driver for driver, _ in pairs)[-2:] for pairs in stages if len(pairs) > 2]
        narrowest = min((after - before for before, after in steps), default=None)
        passed = narrowest is None or narrowest >= problem.cluster_difference
        checks.append(
            Check(name="cluster_difference", passed=passed, value=narrowest, limit=problem.cluster_difference)
        )
    return Verification.from_checks(checks)


def measure(problem: GearboxProblem, mechanism: GearboxMechanism, standard: list[float] | None) -> GearboxMetrics:
    """Measure speeds of all shafts, deviations and loads."""
    stages = _read_teeth(mechanism)
    nominal = problem.speeds.nominal
    speeds = list_spindle_speeds(parse_decimal(mechanism.input_speed), stages)
    rounded: list[float | None] = [*standard] if standard else [None] * len(speeds)
    shafts = [
        ShaftSpeeds(
            shaft=k + 1,
            speeds=[float(s.speed) for s in list_spindle_speeds(parse_decimal(mechanism.input_speed), stages[:k])],
        )
        for k in range(len(stages) + 1)
    ]
    return GearboxMetrics(
        max_error=max(_compute_errors(problem, mechanism)),
        tooth_sum=sum(sum(pairs[0]) for pairs in stages),
        # The lowest speed of a shaft has the highest torque.
        torque=sum(mechanism.input_speed / shaft.speeds[0] for shaft in shafts[1:-1]),
        speeds=[
            SpindleSpeed(
                speed=float(own.speed),
                nominal=wanted,
                error=float(own.speed) / wanted - 1.0,
                standard=near,
                engaged=list(own.engaged),
            )
            for own, wanted, near in zip(speeds, nominal, rounded, strict=True)
        ],
        shafts=shafts,
    )


def _read_teeth(mechanism: GearboxMechanism) -> list[list[tuple[int, int]]]:
    return [[(pair.driver, pair.driven) for pair in stage.pairs] for stage in mechanism.stages]


def _compute_errors(problem: GearboxProblem, mechanism: GearboxMechanism) -> list[float]:
    """Compute |ln(speed/nominal)| of every speed, both in rising order."""
    speeds = list_spindle_speeds(parse_decimal(mechanism.input_speed), _read_teeth(mechanism))
    if len(speeds) != problem.speeds.count:
        return []
    return [
        abs(math.log(float(own.speed) / wanted)) for own, wanted in zip(speeds, problem.speeds.nominal, strict=True)
    ]
