"""Verification of a finished series, from its tooth numbers alone.

All units are joined into one list of meshes. The output of each unit is the same body as the input of the next one, and
fixed members are the ground. The speed equations of this train give the ratio in exact fractions. The kind of each unit
checks the unit's constraints, for the ratio that the unit has.
"""

from __future__ import annotations

import itertools
from fractions import Fraction

from kinematics.gear.arrangements import ARRANGEMENTS
from kinematics.gear.planetary import GROUND, Mesh, Train, solve_speeds
from synthesis.kinds.gear_train.design import GearTrainMechanism, GearTrainMetrics
from synthesis.kinds.gear_train.verification import build_train
from synthesis.kinds.gear_train.verification import verify as verify_ordinary
from synthesis.kinds.planetary_train.design import PlanetaryMechanism, PlanetaryMetrics
from synthesis.kinds.planetary_train.problem import PlanetaryProblem
from synthesis.kinds.planetary_train.verification import measure
from synthesis.kinds.planetary_train.verification import verify as verify_planetary
from synthesis.kinds.train_series.design import (
    TrainSeriesDesign,
    TrainSeriesMechanism,
    TrainSeriesMetrics,
    UnitMechanism,
)
from synthesis.kinds.train_series.problem import TrainSeriesProblem
from synthesis.kinds.train_series.units import Trains, build_unit_problem
from synthesis.model.answer import Check, Verification


def join_units(mechanism: TrainSeriesMechanism) -> Train:
    """Join all units to one train; the shafts between them are the bodies ``shaft_0``, ``shaft_1``, ..."""
    meshes: list[Mesh] = []
    planets: set[str] = set()
    for k, unit in enumerate(mechanism.units):
        ends = f"shaft_{k}", f"shaft_{k + 1}"
        if isinstance(unit, PlanetaryMechanism):
            train = ARRANGEMENTS[unit.arrangement].build_train(unit.teeth)
            names = {body: f"unit_{k + 1}_{body}" for body in train.bodies}
            names |= {unit.input: ends[0], unit.output: ends[1], unit.fixed: GROUND, GROUND: GROUND}
            planets |= {names[body] for body in train.planets}
            meshes += [
                Mesh(names[m.first], names[m.second], names[m.carrier], m.first_teeth, m.second_teeth, m.sense)
                for m in train.meshes
            ]
        else:
            meshes += _build_ordinary_meshes(unit, k, *ends)
    return Train(tuple(meshes), frozenset(planets))


def _build_ordinary_meshes(unit: GearTrainMechanism, number: int, driving: str, driven: str) -> list[Mesh]:
    """Build the meshes of ordinary gears on fixed shafts."""
    meshes = []
    stages = build_train(unit).stages
    shaft = driving
    for k, stage in enumerate(stages):
        bodies = [shaft, *(f"unit_{number + 1}_idler_{k}_{i}" for i in range(len(stage.idlers)))]
        shaft = driven if k == len(stages) - 1 else f"unit_{number + 1}_shaft_{k + 1}"
        for (one, other), (a, b) in zip(
            itertools.pairwise([*bodies, shaft]), itertools.pairwise(stage.gears), strict=True
        ):
            meshes.append(Mesh(one, other, GROUND, a, b, stage.sense))
    return meshes


def verify(problem: TrainSeriesProblem, mechanism: TrainSeriesMechanism) -> TrainSeriesDesign | None:
    """Drive a series and measure it; None if gears of a unit cannot be made at all, or are not coaxial with it."""
    turning = solve_speeds(join_units(mechanism), {"shaft_0": 1})
    shafts = [turning.values[f"shaft_{k}"] for k in range(len(mechanism.units) + 1)]
    known = [speed for speed in shafts if speed]
    checks = [Check(name="ratio", passed=False)]
    error = Fraction(0)
    if len(known) == len(shafts) and turning.contradiction is None:
        error, ratio_checks = _check_ratio(problem, mechanism, 1 / known[-1])
        checks = ratio_checks
    metrics: list[PlanetaryMetrics | GearTrainMetrics] = []
    for k, (stated, unit, (before, after)) in enumerate(
        zip(problem.units, mechanism.units, itertools.pairwise(shafts), strict=True), 1
    ):
        if not before or not after:
            return None
        measured = _verify_unit(build_unit_problem(stated, before / after, problem.length_unit), unit)
        if measured is None:
            return None
        metrics.append(measured[1])
        checks += [check.model_copy(update={"name": f"unit_{k}_{check.name}"}) for check in measured[0].checks]
    planetary = [one for one in metrics if isinstance(one, PlanetaryMetrics)]
    # Ordinary gears report their losses in their own analysis.
    efficiency = None
    if len(planetary) == len(metrics):
        efficiency = 1.0
        for one in planetary:
            efficiency *= one.efficiency
    return TrainSeriesDesign(
        mechanism=mechanism,
        verification=Verification.from_checks(checks),
        metrics=TrainSeriesMetrics(
            error=float(error),
            total_teeth=sum(one.total_teeth for one in metrics),
            speeds=[float(speed) for speed in known],
            efficiency=efficiency,
            self_locking=any(one.self_locking for one in planetary),
            units=metrics,
        ),
    )


def _check_ratio(
    problem: TrainSeriesProblem, mechanism: TrainSeriesMechanism, ratio: Fraction
) -> tuple[Fraction, list[Check]]:
    """Compute the relative error of the ratio, and check ratio, direction and tolerance, in exact fractions."""
    signed = ratio * problem.sign
    low, high = problem.target.enclose(512)
    error = signed / ((low + high) / 2) - 1
    stated = mechanism.ratio.exact
    checks = [
        Check(name="ratio", passed=stated == ratio and mechanism.ratio.value == float(stated)),
        Check(name="direction", passed=signed > 0),
    ]
    tolerance = problem.exact_tolerance
    if tolerance is not None:
        passed = signed > 0 and problem.target.is_within(signed, tolerance)
        checks.append(Check(name="ratio_error", passed=passed, value=abs(float(error)), limit=float(tolerance)))
    return error, checks


def _verify_unit(
    problem: Trains, unit: UnitMechanism
) -> tuple[Verification, PlanetaryMetrics | GearTrainMetrics] | None:
    """Verify the unit by its own kind, for exactly the ratio that the unit has."""
    if isinstance(problem, PlanetaryProblem):
        # Mechanisms keep the order of the requested units, so that each has the kind of its problem.
        assert isinstance(unit, PlanetaryMechanism)
        verification = verify_planetary(problem, unit)
        coaxial = all(check.passed for check in verification.checks if check.name == "coaxial")
        return (verification, measure(problem, unit)) if coaxial else None
    assert isinstance(unit, GearTrainMechanism)
    design = verify_ordinary(problem, unit)
    return None if design is None else (design.verification, design.metrics)
