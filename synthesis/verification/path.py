"""Verification of a fourbar that guides a point: it is driven to where its coupler point passes each demanded point.

The pin A lies on the crank's circle and at the coupler point's distance from the demanded point: two places, of which
the output link excludes one, as a rule. They give the input angles to which the linkage is driven, in both assemblies;
what is measured is where P then stands. A curve may pass a point twice: the passage on the first target's circuit
counts.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.errors import DimensionError
from kinematics.linkage import (
    barker_class,
    can_assemble,
    positions,
    same_circuit,
    transmission_extremes,
    traverse,
)
from synthesis.designs import Check, FourbarMechanism, LinkageDesign, LinkageMetrics, Target, Verification
from synthesis.linkages import DrivenFourbar, driven_fourbar
from synthesis.problems import PathProblem
from synthesis.ranking import quality
from synthesis.verification.checks import TARGET_REACHED, constraint_checks

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]


class _Passages(NamedTuple):
    """The linkage as it passes the points: input angles, assembly signs, joints A, B and P, and the misses."""

    angles: Real
    assemblies: NDArray[np.int64]
    a: Complex
    b: Complex
    p: Complex
    misses: Real


def verify_path(problem: PathProblem, mechanism: FourbarMechanism) -> LinkageDesign | None:
    """Drive a fourbar past a problem's points and measure it.

    Parameters
    ----------
    problem : PathProblem
        What was asked.
    mechanism : FourbarMechanism
        Dimensions only; the skeleton is not looked at.

    Returns
    -------
    LinkageDesign or None
        None where the dimensions make no linkage that can be assembled, or it stays out of reach of a point.
    """
    try:
        fourbar = driven_fourbar(mechanism)
    except DimensionError:
        return None
    linkage = fourbar.linkage
    if not can_assemble(linkage):
        return None
    points = np.array([point.point for point in problem.points])
    passed = _passages(fourbar, points)
    if passed is None:
        return None
    size = problem.task_size
    way = traverse(linkage, passed.angles, passed.assemblies)
    on_circuit = way.same_branch or bool(
        np.all(same_circuit(linkage, passed.angles[0], passed.assemblies[0], passed.angles, passed.assemblies))
    )
    barker = barker_class(linkage)
    least = float(transmission_extremes(linkage, way.start, way.end)[0]) if way.same_branch else 0.0
    links, point = mechanism.links, complex(linkage.coupler_point)
    lengths = [links.ground, links.input, links.coupler, links.output]
    reach = max(*lengths, abs(point), abs(point - links.coupler))
    pivots = [complex(linkage.input_pivot), complex(linkage.output_pivot)]
    joints = np.concatenate([passed.a, passed.b, passed.p, pivots])
    residuals = passed.misses / size
    metrics = LinkageMetrics(
        grashof=barker.motion,
        barker=barker.code,
        min_transmission_angle=math.degrees(least),
        transmission_angles={"coupler": math.degrees(least)},
        same_branch=way.same_branch,
        visits_in_order=on_circuit and way.in_order,
        full_rotation=barker.motion in ("double_crank", "crank_rocker"),
        input_rotation=math.degrees(way.angles[-1] - way.angles[0]),
        link_ratio=max(lengths) / min(lengths),
        rms_residual=math.sqrt(float(np.mean(residuals**2))),
        size=math.hypot(*np.ptp(joints.view(np.float64).reshape(-1, 2), axis=0)),
        quality=quality(math.sin(least), reach / size, max(lengths) / min(lengths)),
    )
    residual = float(residuals.max())
    checks = [
        Check(name="reaches_targets", passed=residual <= TARGET_REACHED, value=residual, limit=TARGET_REACHED),
        Check(name="same_circuit", passed=on_circuit),
        *constraint_checks(problem.constraints, lengths, pivots, [complex(passed.a[0]), complex(passed.b[0])], metrics),
    ]
    inputs = np.degrees(way.angles)
    inputs += 360.0 * np.round((mechanism.reference_input_angle - inputs[0]) / 360.0)
    return LinkageDesign(
        mechanism=mechanism,
        targets=[
            Target(index=k, input_angle=float(at), residual=float(miss / size), point_residual=float(miss))
            for k, (at, miss) in enumerate(zip(inputs, passed.misses, strict=True))
        ],
        verification=Verification(passed=all(check.passed for check in checks), checks=checks),
        metrics=metrics,
    )


def _passages(fourbar: DrivenFourbar, points: Complex) -> _Passages | None:
    """Where P passes each point, on the reference's circuit if it can be; None where no crank angle brings it near."""
    linkage = fourbar.linkage
    reference = positions(linkage, fourbar.reference, fourbar.assembly)
    if not reference.valid:
        return None
    reach = points - linkage.input_pivot
    a, r, f = float(linkage.input), abs(complex(linkage.coupler_point)), np.abs(reach)
    with np.errstate(divide="ignore", invalid="ignore"):
        lean = np.arccos(np.clip((a * a + f * f - r * r) / (2.0 * a * f), -1.0, 1.0))
    angles = np.angle(reach) + np.stack([lean, lean, -lean, -lean])
    assemblies = np.array([1, -1, 1, -1])
    signs = np.broadcast_to(assemblies[:, None], angles.shape)
    if not np.isfinite(angles).all():
        return None
    at = positions(linkage, angles, assemblies)
    misses = np.where(at.valid, np.abs(at.p - points), np.inf)
    here = same_circuit(linkage, fourbar.reference, fourbar.assembly, angles, signs)
    # The first target is met by the reference configuration itself, or not at all.
    first = abs(complex(reference.p) - points[0])
    good = misses <= np.maximum(4.0 * misses.min(axis=0), TARGET_REACHED * np.abs(points - points[0]).max())
    best = np.where(good & here, 0.0, np.where(good, 1.0, 2.0)).argmin(axis=0), np.arange(len(points))
    if not np.isfinite(misses[best]).all():
        return None
    chosen = [np.array(part[best]) for part in (angles, signs, at.a, at.b, at.p, misses)]
    for part, value in zip(
        chosen, (fourbar.reference, fourbar.assembly, reference.a, reference.b, reference.p, first), strict=True
    ):
        part[0] = value
    return _Passages(*chosen)
