"""The sheet of a steering mechanism: straight and at both locks, tables, and the outer wheel's angle with its error."""

from __future__ import annotations

import math

import numpy as np

from kinematics.linkage.planar.mechanism import GROUND
from service.render.checks import checks
from service.render.linkage.drawing import Scene
from service.render.linkage.driven_sheet import driven_sheet, verdict
from service.render.linkage.rebuilt import rebuilt
from service.render.page import blocks
from service.render.page.diagrams import Diagram
from service.render.page.numbers import (
    angle,
    length,
    small,
)
from service.render.page.symbols import CURVE, OUTPUT
from synthesis.kinds.steering.design import SteeringDesign
from synthesis.kinds.steering.problem import SteeringProblem
from synthesis.model.answer import Check

HEIGHTS = (260.0, 520.0)
"""Least and greatest height of the drawing, pixels."""

NAMES = {"fourbar": "Ackermann steering linkage", "davis": "Davis steering gear"}
"""What the types are called on a sheet."""


def steering_sheet(design: SteeringDesign, problem: SteeringProblem, title: str) -> str:
    """The drawing of a steering design as a complete SVG document."""
    mechanism = rebuilt(design)
    straight, metrics = float(mechanism.reference_input), design.metrics
    if mechanism.driven_by_slide:
        # Both locks are as far from the straight position.
        locks = [design.targets[-1].input_angle, 2.0 * straight - design.targets[-1].input_angle]
    else:
        locks = [straight + math.radians(problem.lock), straight - math.radians(metrics.outer_lock)]
    traced = [joint for joint in mechanism.joints if joint not in mechanism.links[GROUND]]
    shown = Scene(mechanism, np.array([straight, *locks]), [])
    name = NAMES[design.mechanism.type]
    words = (
        f"{name}, tie rod {metrics.tie_rod} the kingpins, to a lock of {angle(problem.lock)}; "
        f"lengths in {problem.length_unit}; {verdict(design.verification)}"
    )
    return driven_sheet(
        title or name,
        words,
        shown,
        shown.box(),
        problem.length_unit,
        lambda view: [],
        _diagrams(design),
        _tables(design, problem, shown.box().diagonal, traced),
        heights=HEIGHTS,
        subject="a steering mechanism, straight and at both locks",
    )


def _diagrams(design: SteeringDesign) -> list[Diagram]:
    """The outer wheel's angle and its error over the inner wheel's, to the left."""
    inner = np.array([target.inner for target in design.targets])
    outer = np.array([target.outer for target in design.targets])
    error = np.array([target.error for target in design.targets])
    span, limit = float(inner[-1]), design.metrics.steering_error
    return [
        Diagram("outer wheel (°) over the inner wheel's angle", "outer", inner, outer, CURVE, span=span),
        Diagram("steering error (°)", "error", inner, error, OUTPUT, limits=(-limit, limit), span=span),
    ]


def _tables(design: SteeringDesign, problem: SteeringProblem, size: float, moving: list[str]) -> list[blocks.Block]:
    unit, metrics, mechanism = problem.length_unit, design.metrics, design.mechanism
    links = mechanism.links if isinstance(mechanism.links, dict) else mechanism.links.model_dump()
    rows = [(name.replace("_", " "), length(value)) for name, value in links.items()]
    for name in ("O2", "O4", *moving):
        x, y = mechanism.skeleton.joints[name]
        rows.append((f"{name}, straight", f"({length(x, size)}, {length(y, size)})"))
    met = [
        (f"inner {angle(target.inner, 2)}: outer {angle(target.outer, 3)}", f"error {angle(target.error, 4)}")
        for target in design.targets
    ]
    measured = [
        ("steering error", f"{small(metrics.steering_error)}°"),
        ("correct at", ", ".join(angle(at, 2) for at in metrics.correct_at) or "everywhere"),
        ("outer wheel at the lock", angle(metrics.outer_lock)),
        ("arms", f"{length(metrics.arm_length)} {unit} at {angle(metrics.arm_angle)}"),
        ("turning radius", f"{length(metrics.turning_radius)} {unit}"),
        ("min transmission angle", angle(metrics.min_transmission_angle, 2)),
    ]
    if metrics.bar_travel is not None:
        measured.append(("travel of the bar", f"± {length(metrics.bar_travel)} {unit}"))
    return [
        blocks.rows(f"Dimensions ({unit})", rows),
        blocks.rows("Targets", met),
        checks(design.verification, _written),
        blocks.rows("Metrics", measured),
    ]


def _written(check: Check, value: float) -> str:
    return angle(value, 3) if check.name in ("transmission_angle", "steering_error") else small(value)
