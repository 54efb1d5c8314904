"""Verification of a gear train: speeds followed from mesh to mesh, meshes constructed from the tooth numbers.

Nothing from the search is used. The ratio is computed from the speeds of the shafts in exact fractions, and its error
from the target's enclosure between rational numbers. Distances, contact and interference follow from the geometry of
the teeth.
"""

from __future__ import annotations

import math
from collections import Counter
from fractions import Fraction

from kinematics.errors import DimensionError
from kinematics.gear.train import OrdinaryTrain, TrainStage
from synthesis.kinds.gear_train.design import GearTrainDesign, GearTrainMechanism, GearTrainMetrics, Stage, TurningShaft
from synthesis.kinds.gear_train.problem import GearTrainProblem
from synthesis.kinds.gear_train.statement.stages import RequestedStage
from synthesis.model.answer import Check, Verification
from synthesis.model.dimension import LENGTH
from synthesis.model.dynamics.request import METRES_PER_UNIT
from synthesis.model.gears.answer import Ratio, describe_meshes
from synthesis.model.gears.ratio_target import parse_decimal
from synthesis.model.gears.stages import FIELD_STAGE_TYPES, build_train_stage
from synthesis.model.gears.strength import LoadedPair, PairStrength, build_stage_contact, describe_strength
from synthesis.verification.checks import check_error

DISTANCE_TOLERANCE = 1e-12
"""Relative difference of equal centre distances that is attributed to rounding."""

FIT_TOLERANCE = 1e-9
"""Violation of a constraint by a fitted mesh, as a share of a module or of a contact ratio, attributed to rounding."""

PARALLEL_TOLERANCE = 1e-12
"""Deviation from 1 of the cosine of the angle between parallel axes that is attributed to rounding."""

AXIS_DIGITS = 15
"""Decimals to which axes are reported, so that right angles are exact."""

ENCLOSURE_BITS = 256
"""Precision of the target's enclosure in bits, with which errors of trains are accurate to about sixty digits."""


def build_train(mechanism: GearTrainMechanism) -> OrdinaryTrain:
    """Build the mechanism for the analysis core; raises DimensionError for impossible gears."""
    idlers: dict[int, list[int]] = {}
    for idler in mechanism.idlers:
        idlers.setdefault(idler.stage, []).append(idler.teeth)
    angle = math.radians(mechanism.pressure_angle)
    stages = (
        build_train_stage(stage, angle, tuple(idlers.get(number, ())))
        for number, stage in enumerate(mechanism.stages, 1)
    )
    return OrdinaryTrain(tuple(stages), angle)


def verify(problem: GearTrainProblem, mechanism: GearTrainMechanism) -> GearTrainDesign | None:
    """Drive a train and measure it; None if its gears cannot be made at all."""
    try:
        train = build_train(mechanism)
    except DimensionError:
        return None
    errors = _compute_errors(problem, abs(train.ratio))
    meshes = describe_meshes(train, problem.is_fitted)
    gears = [n for stage in train.stages for n in (stage.driver, stage.driven)]
    pairs = [pair for stage in train.stages for pair in zip(stage.gears[:-1], stage.gears[1:], strict=True)]
    metrics = GearTrainMetrics(
        error=float(errors[0] * abs(train.ratio) / (1 + errors[0])),
        relative_error=float(errors[0]),
        total_teeth=sum(gears),
        largest_gear=max(gears),
        largest_stage_ratio=max(_compute_widest_ratio(stage) for stage in train.stages),
        hunting_tooth=all(math.gcd(*pair) == 1 for pair in pairs),
        centre_distances=list(train.centre_distances),
        meshes=meshes,
        strength=_compute_strength(problem, mechanism, train),
        shafts=None if problem.stages is None else _describe_shafts(train),
    )
    checks = [
        *_check_ratio(problem, mechanism, train, errors),
        *_check_gears(problem, mechanism, train, metrics),
        *_check_types(problem, mechanism, train, metrics),
        *_check_meshes(problem, metrics),
        *(_check_fit(problem, mechanism, metrics) if problem.is_fitted else []),
        *_check_strength(problem, mechanism, metrics),
    ]
    return GearTrainDesign(
        mechanism=mechanism,
        verification=Verification.from_checks(checks),
        metrics=metrics,
    )


def _compute_widest_ratio(stage: TrainStage) -> float:
    """Return the larger over the smaller number of teeth, or of a worm's threads."""
    return max(stage.driver, stage.driven) / min(stage.driver, stage.driven)


def _compute_errors(problem: GearTrainProblem, ratio: Fraction) -> tuple[Fraction, Fraction]:
    """Return the relative error of the ratio, for the two ends of the target's enclosure."""
    low, high = problem.target.enclose(ENCLOSURE_BITS)
    return ratio / high - 1, ratio / low - 1


def _check_ratio(
    problem: GearTrainProblem,
    mechanism: GearTrainMechanism,
    train: OrdinaryTrain,
    errors: tuple[Fraction, Fraction],
) -> list[Check]:
    """Check ratio, error and direction, in exact fractions."""
    stated = mechanism.ratio.exact
    checks = [Check(name="ratio", passed=stated == train.ratio and mechanism.ratio.value == float(stated))]
    tolerance = problem.exact_tolerance
    if tolerance is not None:
        # Compared as fractions, so that a train exactly at the tolerance passes in spite of rounding.
        worst = max(abs(error) for error in errors)
        passed = worst <= tolerance
        checks.append(Check(name="ratio_error", passed=passed, value=float(worst), limit=float(tolerance)))
    if problem.required_sign:
        checks.append(Check(name="direction", passed=(train.ratio > 0) == (problem.required_sign > 0)))
    return checks


def _check_gears(
    problem: GearTrainProblem, mechanism: GearTrainMechanism, train: OrdinaryTrain, metrics: GearTrainMetrics
) -> list[Check]:
    """Check the numbers of stages and teeth, the stock, and the largest stage ratio."""
    count = len(train.stages)
    checks = [check_error("stages", count, problem.most_stages)]
    if problem.stock is not None:
        used, stocked = Counter(n for stage in train.stages for n in stage.gears), problem.count_stock()
        checks.append(Check(name="stock", passed=all(stocked.get(n, 0) >= many for n, many in used.items())))
    elif count <= problem.most_stages:
        ranges = problem.list_position_ranges()
        gears = [n for stage in train.stages for n in (stage.driver, stage.driven)]
        inside = all(low <= n <= high for n, (low, high) in zip(gears, ranges, strict=False))
        checks.append(Check(name="teeth", passed=inside))
    if problem.max_stage_ratio is not None:
        limit = parse_decimal(problem.max_stage_ratio)
        kept = all(
            Fraction(s.driven, s.driver) <= limit and Fraction(s.driver, s.driven) <= limit
            for s in train.stages
            if s.kind != "worm"
        )
        value = max((_compute_widest_ratio(s) for s in train.stages if s.kind != "worm"), default=1.0)
        checks.append(Check(name="stage_ratio", passed=kept, value=value, limit=problem.max_stage_ratio))
    if problem.max_total_teeth is not None:
        checks.append(check_error("total_teeth", metrics.total_teeth, problem.max_total_teeth))
    return checks


def _check_types(
    problem: GearTrainProblem, mechanism: GearTrainMechanism, train: OrdinaryTrain, metrics: GearTrainMetrics
) -> list[Check]:
    """Check the types of stages that are given, with their values, and that pinions run in their rings."""
    if problem.stages is None:
        return []
    stated = len(problem.stages) == len(mechanism.stages) and all(
        _is_as_requested(one, made) for one, made in zip(problem.stages, mechanism.stages, strict=True)
    )
    checks = [Check(name="stage_types", passed=stated)]
    rings = [mesh for mesh in metrics.meshes if mesh.type == "internal"]
    if rings:
        runs = not any(mesh.interferes or mesh.ring_trimmed or mesh.contact_ratio < 1.0 for mesh in rings)
        checks.append(Check(name="rings", passed=runs))
    return checks


def _is_as_requested(requested: RequestedStage, made: Stage) -> bool:
    """Return whether a stage has all requested values, and its ring in the requested place."""
    requested_values = {name: getattr(requested, name) for name in ("type", *FIELD_STAGE_TYPES)}
    ring = made.driver if requested.ring == "driver" else made.driven
    return all(value is None or getattr(made, name) == value for name, value in requested_values.items()) and (
        requested.type != "internal" or ring == max(made.driver, made.driven)
    )


def _describe_shafts(train: OrdinaryTrain) -> list[TurningShaft]:
    """Describe the shafts from the input's on, by the followed speeds about their axes."""
    speeds = [Fraction(1), *(stage[-1] for stage in train.speeds)]
    first, shafts = train.axes[0], []
    for speed, axis in zip(speeds, train.axes, strict=True):
        along = float(axis @ first)
        turns = None
        if abs(along) > 1.0 - PARALLEL_TOLERANCE:
            turns = "same" if along * speed > 0 else "opposite"
        # Adding 0.0 turns a rounded −0.0 into 0.0.
        reported_axis = None if train.is_parallel else tuple(float(round(part, AXIS_DIGITS)) + 0.0 for part in axis)
        shafts.append(TurningShaft(speed=Ratio.from_fraction(speed), turns=turns, axis=reported_axis))
    return shafts


def _check_meshes(problem: GearTrainProblem, metrics: GearTrainMetrics) -> list[Check]:
    """Check coaxial shafts, hunting teeth and interference, if required."""
    checks = []
    if problem.reverted:
        distances = metrics.centre_distances
        apart = max(distances) - min(distances)
        checks.append(check_error("coaxial", apart, DISTANCE_TOLERANCE * max(distances), LENGTH))
    if problem.hunting_tooth == "require":
        checks.append(Check(name="hunting_tooth", passed=metrics.hunting_tooth))
    if problem.interference == "refuse":
        checks.append(Check(name="interference", passed=not any(mesh.interferes for mesh in metrics.meshes)))
    return checks


def _check_fit(problem: GearTrainProblem, mechanism: GearTrainMechanism, metrics: GearTrainMetrics) -> list[Check]:
    """Check fitted teeth, from the geometry of the meshes at the distance that results from the shifts."""
    least_shift, most_shift = problem.shift_limits
    shifts = [x for stage in mechanism.stages if stage.shift for x in (stage.shift.driver, stage.shift.driven)]
    tips, apart, chosen = [], [], []
    for number, (mesh, stage) in enumerate(zip(metrics.meshes, mechanism.stages, strict=True)):
        low, high = problem.get_distance_limits(number)
        distance, stated = mesh.centre_distance, stage.centre_distance or math.nan
        apart.append(max(low - distance, distance - high, abs(distance - stated)) / distance)
        if mesh.tip_thickness is not None:
            tips += [mesh.tip_thickness.driver / stage.module, mesh.tip_thickness.driven / stage.module]
        chosen.append(stage.module in problem.list_modules(number))
    # The weakest mesh decides.
    ratio = min(mesh.contact_ratio for mesh in metrics.meshes)
    return [
        Check(name="module", passed=all(chosen)),
        check_error("centre_distance", max(apart), FIT_TOLERANCE),
        Check(
            name="least_shift", passed=min(shifts) >= least_shift - FIT_TOLERANCE, value=min(shifts), limit=least_shift
        ),
        Check(
            name="greatest_shift", passed=max(shifts) <= most_shift + FIT_TOLERANCE, value=max(shifts), limit=most_shift
        ),
        Check(name="undercut", passed=not any(mesh.undercut for mesh in metrics.meshes)),
        Check(name="fillet_interference", passed=not any(mesh.interferes for mesh in metrics.meshes)),
        _check_minimum("contact_ratio", ratio, problem.least_contact_ratio),
        _check_minimum("tip_thickness", min(tips), problem.least_tip_thickness),
    ]


def _compute_strength(
    problem: GearTrainProblem, mechanism: GearTrainMechanism, train: OrdinaryTrain
) -> list[PairStrength] | None:
    """Compute the stresses of every mesh over its stage's face, from the shaft speeds; None without a given power."""
    stated = problem.strength
    if stated is None:
        return None
    unit, found = 1000.0 * METRES_PER_UNIT[problem.length_unit], []
    for made, stage, speeds in zip(mechanism.stages, train.stages, train.speeds, strict=True):
        for place, speed in enumerate(speeds[:-1]):
            contact = build_stage_contact(stage, place, train.pressure_angle, unit)
            # Idlers are bent in both directions.
            idle = place > 0, place + 1 < len(stage.gears) - 1
            turning = abs(float(speed)) * stated.speed
            loaded = LoadedPair(contact, stated.power, turning, idle, helix_angle=stage.helix_angle)
            found.append(PairStrength(**describe_strength(loaded, stated, made.face_width, unit)))
    return found


def _check_strength(problem: GearTrainProblem, mechanism: GearTrainMechanism, metrics: GearTrainMetrics) -> list[Check]:
    """Check the safeties of all gears, and the face widths."""
    stated = problem.strength
    if stated is None or metrics.strength is None:
        return []
    safeties = [
        getattr(gear, name) for mesh in metrics.strength for gear in mesh.gears for name in stated.required_safeties
    ]
    least = min(0.0 if safety is None else safety for safety in safeties)
    widest = max((stage.face_width or math.inf) / stage.module for stage in mechanism.stages)
    return [
        Check(name="strength", passed=least >= 1.0 - FIT_TOLERANCE, value=least, limit=1.0),
        check_error("relative_face_width", widest, stated.max_face_width * (1.0 + FIT_TOLERANCE)),
    ]


def _check_minimum(name: str, value: float, limit: float) -> Check:
    return Check(name=name, passed=value >= limit - FIT_TOLERANCE, value=value, limit=limit)
