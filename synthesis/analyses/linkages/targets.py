"""Errors of a given fourbar or slider-crank at targets, and its manufacturing results, as for designs."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence

import numpy as np

from kinematics.linkage.variation import measure_deviations
from kinematics.message import compose
from synthesis.manufacture.linkage import Linkage, build_task, extract_linkage, find_target_inputs
from synthesis.manufacture.report import report_manufacture
from synthesis.mechanisms import GivenMechanism
from synthesis.model.json_object import JsonObject
from synthesis.model.linkage.targets import MetTarget, TargetSpec
from synthesis.model.manufacture.request import Exactness, ManufactureTask, RequiredTargets

SAMPLE_COUNT = 1440
"""Number of inputs per turn on the first grid of the search for the input nearest to a target."""

UNSUPPORTED_MESSAGE = "analyses-targets-need-fourbar-or-slider-crank"
"""Id of the message for mechanisms whose errors at targets are not computed."""


def find_target_errors(
    mechanism: GivenMechanism, targets: Sequence[TargetSpec], block: Exactness | None
) -> list[tuple[str, str]]:
    """Return errors that the validation of single fields cannot find, as pairs (path, detail)."""
    if not targets:
        return [("/targets", compose("analyses-manufacture-needs-targets"))] if block is not None else []
    linkage = extract_linkage(mechanism)
    if linkage is None:
        return [("/targets", compose(UNSUPPORTED_MESSAGE))]
    sorts = [target.sort for target in targets]
    faults = [
        (f"/targets/{k}", compose("analyses-targets-of-different-forms"))
        for k, sort in enumerate(sorts)
        if sort != sorts[0]
    ]
    if sorts[0] == "poses" and mechanism.reference_input_angle is None:
        detail = compose("analyses-reference-input-missing")
        faults.append(("/mechanism/reference_input_angle", detail))
    if block is None:
        return faults
    turns = sorts[0] == "poses" or (sorts[0] == "outputs" and linkage.slide_angle is None)
    made = ManufactureTask(sorts[0] != "outputs" or not turns, turns, sorts[0] != "outputs", len(targets))
    if block.quality is not None and block.quality.yield_ is not None:
        faults.append(("/manufacture/quality/yield", compose("analyses-yield-not-required")))
    if block.tolerances is None:
        faults.append(("/manufacture/tolerances", compose("analyses-tolerances-missing")))
    return faults + [(f"/manufacture{path}", detail) for path, detail in block.find_task_errors(made)]


def analyze_targets(mechanism: GivenMechanism, targets: Sequence[TargetSpec], block: Exactness | None) -> JsonObject:
    """Compute a linkage's errors at its targets and its manufacturing results, as fields of the answer.

    Parameters
    ----------
    mechanism : a given mechanism
        The linkage, for which :func:`find_target_errors` finds no errors.
    targets : sequence of TargetSpec
        Targets, all of one sort.
    block : Exactness or None
        Manufacturing accuracy.
    """
    linkage = extract_linkage(mechanism)
    assert linkage is not None
    held = _find_nearest_inputs(linkage, _build_requirements(mechanism, linkage, targets))
    found = find_target_inputs(linkage, held, (held.size, 1.0), None)
    met: list[JsonObject] = []
    if not isinstance(found, str):
        off = np.degrees(found[1][:, 2])
        distances = np.hypot(found[1][:, 0], found[1][:, 1])
        for k, at in enumerate(np.degrees(held.inputs)):
            target = MetTarget(index=k, input_angle=float(at))
            if targets[0].sort == "outputs":
                error = found[1][k, 0] if found[0].slides else off[k]
                target = target.model_copy(update={"error": float(error)})
            else:
                angle = abs(float(off[k])) if targets[0].sort == "poses" else None
                target = target.model_copy(update={"point_residual": float(distances[k]), "angle_residual": angle})
            met.append(target.model_dump())
    answer: JsonObject = {"targets": met}
    if block is None:
        return answer
    used = float(held.inputs.min()), float(held.inputs.max())
    report = report_manufacture(mechanism, held, block, 0, used)
    answer["manufacture"] = report.manufactured.model_dump()
    if report.yield_ is not None:
        answer["yield"] = report.yield_.model_dump()
    return answer


def _build_requirements(mechanism: GivenMechanism, linkage: Linkage, targets: Sequence[TargetSpec]) -> RequiredTargets:
    """Build the requirements from the targets; inputs that are left out are NaN."""
    inputs = np.radians([math.nan if target.input_angle is None else target.input_angle for target in targets])
    if targets[0].sort == "outputs":
        places = np.array([target.output for target in targets], np.float64)
        if linkage.slide_angle is not None:
            return RequiredTargets(inputs, travels=places, free=False)
        return RequiredTargets(inputs, angles=np.radians(places), free=False)
    points = np.array([complex(target.x or 0.0, target.y or 0.0) for target in targets])
    size = float(np.abs(points - points[0]).max()) or 1.0
    if targets[0].sort == "points":
        return RequiredTargets(inputs, points=points, size=size)
    stands = mechanism.reference_body_angle
    body = targets[0].angle if stands is None else stands
    angles = np.radians([target.angle for target in targets if target.angle is not None])
    return RequiredTargets(inputs, points=points, angles=angles, body=math.radians(body or 0.0), size=size)


def _find_nearest_inputs(linkage: Linkage, held: RequiredTargets) -> RequiredTargets:
    """Fill in omitted inputs by those at which the linkage comes nearest to the targets.

    Each input is first found on a grid; then all of them are refined at once.
    """
    known = np.isfinite(held.inputs)
    turn = np.linspace(0.0, math.tau, SAMPLE_COUNT, endpoint=False)
    inputs = np.where(known, held.inputs, 0.0)
    for k in np.flatnonzero(~known).tolist():
        every = dataclasses.replace(
            held,
            inputs=turn,
            points=None if held.points is None else np.full(SAMPLE_COUNT, held.points[k]),
            angles=None if held.angles is None else np.full(SAMPLE_COUNT, held.angles[k]),
        )
        task = build_task(linkage, every, (held.size, 1.0))
        if isinstance(task, str):
            return held
        off = measure_deviations(task, linkage.row[None, : task.dimensions])
        miss = np.hypot(off.distances[0] / held.size, off.angles[0])
        inputs[k] = turn[int(np.where(np.isfinite(miss), miss, np.inf).argmin())]
    task = build_task(linkage, dataclasses.replace(held, inputs=inputs), (held.size, 1.0))
    if isinstance(task, str):
        return held
    task = dataclasses.replace(task, adjusted=True, greatest=False)
    refined = measure_deviations(task, linkage.row[None, : task.dimensions]).inputs[0]
    inputs = np.where(known | ~np.isfinite(refined), inputs, refined)
    # A given input determines its turn. Each other input is in the turn nearest to the previous input.
    for k in range(1, len(inputs)):
        if not known[k]:
            inputs[k] -= math.tau * round((inputs[k] - inputs[k - 1]) / math.tau)
    return dataclasses.replace(held, inputs=inputs)
