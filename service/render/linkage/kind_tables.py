"""Sheet contents by kind of problem: one function per kind, collected in one table."""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from kinematics.linkage.planar.limits import cycle_from_reference
from kinematics.linkage.planar.mechanism import GROUND
from service.render.linkage import fourbar_tables
from service.render.linkage.content import Content
from service.render.linkage.drawing import PlanarPicture, Scene
from service.render.linkage.fourbar import scene as fourbar_scene
from service.render.linkage.fourbar_picture import FourbarPicture, description
from service.render.linkage.function_diagram import function_diagram, range_arc
from service.render.linkage.motion import DrivenLinkage, demands_of, stance_curve, target_curve
from service.render.linkage.sprung import spring_balancing
from service.render.linkage.styles import STANCE
from service.render.page import blocks
from service.render.page.diagrams import Diagram
from service.render.page.numbers import angle, length, small
from service.render.page.svg import Box, Element, Viewport, circle, line, path
from service.render.page.symbols import CURVE, DEMANDED, OUTPUT
from service.units import symbols
from synthesis.kinds.balancing.curves import shaking_curves
from synthesis.kinds.balancing.design import BalancedDesign
from synthesis.kinds.balancing.problem import BalancingProblem
from synthesis.kinds.dwell.design import DwellDesign, DwellMechanism
from synthesis.kinds.dwell.problem import DwellProblem
from synthesis.kinds.function.design import FunctionDesign
from synthesis.kinds.function.problem import FunctionProblem
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.kinds.parallel_motion.design import ParallelMotionDesign
from synthesis.kinds.parallel_motion.problem import ParallelMotionProblem
from synthesis.kinds.path.problem import PathProblem
from synthesis.kinds.quick_return.design import QuickReturnDesign
from synthesis.kinds.quick_return.problem import QuickReturnProblem
from synthesis.kinds.quick_return.verification import OUTPUTS
from synthesis.kinds.steering.design import SteeringDesign
from synthesis.kinds.steering.problem import SteeringProblem
from synthesis.kinds.straight_line.design import StraightLineDesign
from synthesis.kinds.straight_line.problem import StraightLineProblem
from synthesis.model.dimension import Dimension
from synthesis.model.linkage_answer import FourbarMechanism, LinkageDesign, SixbarMechanism
from synthesis.model.sixbars import IN_WORDS

SAMPLES = 721
"""Number of points of a diagram's curve, and of P's path during a dwell."""

MAX_ROWS = 12
"""Maximum number of targets that are listed, and of configurations of a function generator that are drawn."""

PLACES = 4
"""Number of places of its range at which a parallel motion is drawn; the body is drawn heavy at all of them."""

WEIGHT = 16.0
"""Drawn radius of the heaviest counterweight without a disc radius, pixels."""

NAMES = {
    "slider_crank": "Slider-crank",
    "geared_fivebar": "Geared fivebar",
    "inverted_slider_crank": "Inverted slider-crank",
    "watt_2": "Fourbar with a driver dyad (Watt II sixbar)",
    "stephenson_3": "Fourbar with a driver dyad on its coupler (Stephenson III sixbar)",
    "crank_shaper": "Crank-shaper",
    "whitworth": "Whitworth quick return",
    "drag_link_rocker": "Drag-link sixbar with a rocker",
    "drag_link_slider": "Drag-link sixbar with a slider",
    "davis": "Davis steering gear",
    "dwell_rocker": "Dwell sixbar with a rocker",
    "dwell_slider": "Dwell sixbar with a slider",
    "dwell_slot": "Dwell sixbar with a slotted rocker",
    "dwell_watt_rocker": "Watt II dwell sixbar with a rocker",
    "dwell_watt_slider": "Watt II dwell sixbar with a slider",
    "dwell_stephenson_2": "Stephenson II dwell sixbar",
    "watt_1": "Watt I sixbar for parallel motion",
}
"""Names of mechanism types on a sheet."""

GENERATOR_NAMES = {**IN_WORDS, "fourbar": "Fourbar", "slider_crank": "Slider-crank"}
"""First words of a function generator's title."""

STROKE_NAMES = NAMES | {"fourbar": "Crank-rocker", "slider_crank": "Offset slider-crank"}

LINE_NAMES = {
    "hoeken": "Hoeken's straight-line linkage",
    "chebyshev": "Chebyshev's straight-line linkage",
    "watt": "Watt's straight-line linkage",
    "roberts": "Roberts' straight-line linkage",
    "evans": "Evans' straight-line linkage",
    "peaucellier": "Peaucellier's inversor",
    "hart": "Hart's inversor",
    "scott_russell": "Scott-Russell's mechanism",
}
"""Names of the families of straight-line linkages."""

PROPORTIONS = {"optimal": "best", "classical": "classical", "exact": "exact"}

BASES = {
    "source": "of the given fourbar",
    "left_cognate": "of its left cognate",
    "right_cognate": "of its right cognate",
    "path": "of a fourbar through the points",
}
"""Origin of a sixbar for parallel motion."""


def guided(design: LinkageDesign, problem: MotionProblem | PathProblem, linkage: DrivenLinkage) -> Content:
    """Return the content for a guided body or point: at the targets; for a whole curve, at its first and last point."""
    unit = problem.length_unit
    if isinstance(design.mechanism, FourbarMechanism):
        fourbar = fourbar_scene(design, problem, linkage)
        grashof = design.metrics.grashof
        kind = "" if grashof is None else f", {fourbar_tables.GRASHOF[grashof]}"
        return Content(
            "Fourbar linkage",
            f"Fourbar linkage, {design.mechanism.assembly} assembly{kind}",
            description(design, unit, fourbar),
            FourbarPicture(fourbar, unit),
            [fourbar_tables.targets(design, fourbar, unit)],
            dimensions=fourbar_tables.dimensions(design, fourbar, unit),
        )
    inputs, target, demands = linkage.targets(design), target_curve(problem), demands_of(problem)
    if isinstance(problem, PathProblem) and problem.matched:
        # A closed curve is drawn over a full cycle.
        last = inputs[0] + cycle_from_reference(linkage.mechanism) if problem.closed else inputs[-1]
        inputs, demands = np.array([inputs[0], last]), demands[:1]
    scene = Scene(linkage, inputs, ["P"], "P", demands, target)
    slides = linkage.mechanism.driven_by_slide
    met = [
        (
            f"{target.index + 1}: input {length(target.at) if slides else angle(target.at, 2)}",
            f"off by {small(target.point_residual)} {unit}"
            + ("" if target.angle_residual is None else f", {angle(target.angle_residual, 2)}"),
        )
        for target in design.targets
    ]
    driven = not isinstance(design.mechanism, SixbarMechanism) or "driver_coupler" in design.mechanism.links
    name = (NAMES if driven else IN_WORDS)[design.mechanism.type]
    return Content(
        name,
        name,
        f"a linkage at {len(inputs)} targets",
        PlanarPicture(scene, unit, partial(_stance, problem), heights=(460.0, 860.0)),
        [blocks.rows("Targets", _first(met))],
    )


def _stance(problem: MotionProblem | PathProblem, view: Viewport) -> list[Element]:
    """Draw the required points of a stance."""
    points = stance_curve(problem)
    drawn = None if points is None else path(view.shown(points), **STANCE, data_curve="stance")
    return [] if drawn is None else [drawn]


def _first(rows: list[tuple[str, str]]) -> list[tuple[str, str]]:
    """Return the first rows, and the number of omitted ones."""
    more = len(rows) - MAX_ROWS
    return [*rows[:MAX_ROWS], (f"and {more} more", "")] if more > 0 else rows


def function(design: FunctionDesign, problem: FunctionProblem, linkage: DrivenLinkage) -> Content:
    """Return the content for a function generator: targets, the range of the input as an arc, structural error or
    output.
    """
    unit, error, dials = problem.length_unit, design.structural_error, design.dials
    slides = error.unit == "length"
    # Evenly chosen targets, first and last included.
    chosen = np.unique(np.linspace(0, len(design.targets) - 1, min(MAX_ROWS, len(design.targets))).astype(int))
    scene = Scene(linkage, linkage.targets(design)[chosen], [], hidden={"P"})

    def off(value: float) -> str:
        return f"{length(value, digits=4)}{f' {unit}' if slides else '°'}"

    def placed(place: float) -> str:
        return f"{length(place)} {unit}" if slides else angle(place)

    readings = [
        (f"input at {angle(dials.input.place)}", f"has the value {length(dials.input.at)}"),
        ("input rotation per unit", angle(dials.input.scale, 6)),
        (f"output at {placed(dials.output.place)}", f"has the value {length(dials.output.at)}"),
        ("output travel per unit", placed(dials.output.scale)),
    ]
    met = [
        (
            f"{target.index + 1}: {length(target.input, digits=5)} → {length(target.output, digits=5)}",
            f"at {angle(target.input_angle, 2)}, off by {off(target.error)}",
        )
        for target in design.targets
    ]
    mechanism = design.mechanism
    more = [("offset", length(mechanism.offset))] if mechanism.type == "slider_crank" else []
    if not isinstance(mechanism, SixbarMechanism):
        more.append(("assembly", mechanism.assembly))
    name = f"{GENERATOR_NAMES[mechanism.type]} function generator"
    return Content(
        name,
        name,
        f"a linkage at {len(design.targets)} targets; structural error at most {off(error.max)}",
        PlanarPicture(scene, unit, lambda view: range_arc(design, scene, view), heights=(380.0, 640.0)),
        [blocks.rows("Dials", readings), blocks.rows("Targets", _first(met))],
        more_dimensions=more,
        hidden={"P"},
        diagrams=[function_diagram(design, problem, linkage)],
    )


def quick_return(design: QuickReturnDesign, problem: QuickReturnProblem, linkage: DrivenLinkage) -> Content:
    """Return the content for a quick return: both limit positions, and the output and its rate over a turn from the
    first.
    """
    unit, metrics, kind = problem.length_unit, design.metrics, design.mechanism.type
    scene = Scene(linkage, linkage.targets(design), [joint for joint in linkage.moving if joint != "P"])
    size, name = scene.box().diagonal, STROKE_NAMES[kind]
    turned = np.linspace(0.0, 360.0, SAMPLES)
    # A full turn from the first limit position.
    motion = linkage.driven(linkage.inputs(design.targets[0].input_angle + turned), order=1)
    if OUTPUTS[kind] in linkage.mechanism.links:
        place, rate = motion.angles[OUTPUTS[kind]]
        value, what, by = np.degrees(np.unwrap(place)), "swing (°)", "output speed over crank speed"
    else:
        value, rate = motion.slides[OUTPUTS[kind]]
        what, by = f"stroke ({unit})", f"slider speed ({unit} per radian of the crank)"
    over = "over the crank's rotation from the first limit position"
    limits = [
        (
            f"limit {target.index + 1}: crank {angle(target.input_angle, 3)}",
            f"{length(target.output, size)} {unit}" if metrics.swing is None else angle(target.output, 3),
        )
        for target in design.targets
    ]
    return Content(
        name,
        f"{name} with a time ratio of {length(metrics.time_ratio)}",
        "a mechanism at both limit positions of its output",
        PlanarPicture(scene, unit, heights=(400.0, 700.0)),
        [blocks.rows("Limits", limits)],
        standing="at the first limit",
        diagrams=[
            Diagram(f"{what} {over}", "output", turned, value - value[0], CURVE),
            Diagram(by, "rate", turned, rate, OUTPUT),
        ],
    )


def steering(design: SteeringDesign, problem: SteeringProblem, linkage: DrivenLinkage) -> Content:
    """Return the content for a steering mechanism: straight and at both locks; outer angle and error over the inner
    angle.
    """
    unit, metrics, targets = problem.length_unit, design.metrics, design.targets
    straight = float(linkage.mechanism.reference_input)
    if linkage.mechanism.driven_by_slide:
        # Both locks are equally far from the straight position.
        locks = [targets[-1].at, 2.0 * straight - targets[-1].at]
    else:
        locks = [straight + math.radians(problem.lock), straight - math.radians(metrics.outer_lock)]
    scene = Scene(linkage, np.array([straight, *locks]), [])
    name = NAMES.get(design.mechanism.type, "Ackermann steering linkage")
    inner, outer, error = (
        np.array([getattr(target, quantity) for target in targets]) for quantity in ("inner", "outer", "error")
    )
    # The dashed lines mark the largest steering error.
    limit = metrics.steering_error
    met = [
        (f"inner {angle(target.inner, 2)}: outer {angle(target.outer, 3)}", f"error {angle(target.error, 4)}")
        for target in targets
    ]
    return Content(
        name,
        f"{name}, tie rod {metrics.tie_rod} the kingpins, to a lock of {angle(problem.lock)}",
        "a steering mechanism, straight and at both locks",
        PlanarPicture(scene, unit, heights=(260.0, 520.0)),
        [blocks.rows("Targets", met)],
        left_out={"tie_rod"},
        standing="when straight",
        diagrams=[
            Diagram("outer wheel (°) over the inner wheel's angle", "outer", inner, outer, CURVE),
            Diagram("steering error (°)", "error", inner, error, OUTPUT, (-limit, limit)),
        ],
    )


def straight_line(design: StraightLineDesign, problem: StraightLineProblem, linkage: DrivenLinkage) -> Content:
    """Return the content for a straight-line linkage: ends and middle; deviation and velocity along the line."""
    unit, metrics = problem.length_unit, design.metrics
    first, last = (float(at) for at in linkage.targets(design))
    scene = Scene(linkage, np.array([first, 0.5 * (first + last), last]), ["P"], "P")
    start = complex(*problem.start)
    along = cmath.rect(1.0, math.radians(problem.direction))
    end = start + problem.length * along
    box = Box.around(np.concatenate([scene.places(), [start, end], scene.used]))
    # Diagrams run from the start, whatever the input's direction.
    turned, sense = np.linspace(0.0, abs(last - first), SAMPLES), math.copysign(1.0, last - first)
    point, rate = linkage.driven(first + sense * turned, order=1).joints["P"]
    at = np.degrees(turned)

    def demanded(view: Viewport) -> list[Element]:
        ends = view.point(start), view.point(end)
        return [line(*ends, stroke=DEMANDED, stroke_width=1.4, stroke_dasharray="6 4", data_line="demanded")]

    ends = [
        (
            f"{what}: input {angle(target.input_angle)}",
            f"({length(target.x, box.diagonal)}, {length(target.y, box.diagonal)})",
        )
        for what, target in zip(("start", "end"), design.targets, strict=True)
    ]
    name, across = LINE_NAMES[metrics.family], ((point - start) * along.conjugate()).imag
    heading = f"distance from the line ({unit}) over the input's rotation"
    per = f"velocity along the line ({unit}/rad) over the input's rotation"
    return Content(
        name,
        f"{name}, {PROPORTIONS[metrics.proportions]} proportions",
        "a linkage at both ends and in the middle of a straight line",
        PlanarPicture(scene, unit, demanded, box),
        [blocks.rows("Line", ends)],
        left_out={"family", "proportions"},
        titles={"deviation": "greatest deviation", "middle velocity": "velocity in the middle"},
        standing="at the start",
        diagrams=[
            Diagram(heading, "deviation", at, across, CURVE),
            Diagram(per, "velocity", at, sense * (rate * along.conjugate()).real, OUTPUT),
        ],
    )


def dwell(design: DwellDesign, problem: DwellProblem, linkage: DrivenLinkage) -> Content:
    """Return the content for a dwell sixbar: start and end of a dwell, and away from it; the output over a turn."""
    unit, mechanism = problem.length_unit, design.mechanism
    begun = [float(at) for at in linkage.targets(design)]
    rotations, slides = [math.radians(wanted.angle) for wanted in problem.wanted], problem.slides
    rotation = rotations[0]
    # The last configuration shows the second rest, or the output farthest from its only rest.
    away = begun[1] if len(begun) > 1 else begun[0] + 0.5 * rotation + math.pi
    # In a Stephenson II the path of B shows the rotation of link 4 about E while the output rests.
    along = "B" if mechanism.type == "dwell_stephenson_2" else "P"
    traced = [joint for joint in (along, "D") if joint in linkage.mechanism.joints]
    scene = Scene(linkage, np.array([begun[0], begun[0] + rotation, away]), traced)
    # Input ranges of the dwells.
    spans = [(at, at + wide) for at, wide in zip(begun, rotations, strict=True)]
    resting = [linkage.path(along, *span, SAMPLES) for span in spans]
    turned = np.linspace(0.0, 360.0, SAMPLES)
    motion = linkage.driven(begun[0] + np.radians(turned), order=2)
    jet = motion.slides["D"] if slides else motion.angles["output"]
    place = jet[0] if slides else np.degrees(np.unwrap(jet[0]))
    per = f"{unit}/rad²" if slides else "rad/rad²"
    bend = f"acceleration ({per})" if slides else "angular acceleration (rad per rad² of the crank)"
    what, over = f"slider ({unit})" if slides else "output angle (°)", "over the crank's rotation from the first dwell"

    def measure(value: float) -> str:
        return f"{length(value, digits=4)} {unit}" if slides else angle(value, 4)

    def dwells(view: Viewport) -> list[Element]:
        drawn = (path(view.shown(at), stroke=DEMANDED, stroke_width=2.6, data_curve="dwell") for at in resting)
        return [curve for curve in drawn if curve is not None]

    rests = []
    for rest in design.targets:
        rests.append((f"dwell {rest.index + 1} from", angle(rest.input_angle, 2)))
        if design.dwells is not None:
            placed = design.dwells[rest.index]
            rests.append((f"over {angle(placed.angle, 2)}, at", f"{length(100.0 * placed.at, digits=3)} % of the way"))
        rests += [
            ("jitter", measure(rest.jitter)),
            (f"width at {measure(problem.allowed)}", angle(rest.width, 2)),
        ]
    name = NAMES[mechanism.type]
    return Content(
        name,
        f"{name}, crank turns counter-clockwise",
        "a sixbar as a dwell begins and ends, and away from it",
        PlanarPicture(scene, unit, dwells),
        [blocks.rows("Dwells", rests)],
        titles={"way": "stroke" if slides else "swing"},
        standing="there",
        more_dimensions=_point_of_dwell(mechanism),
        diagrams=[
            Diagram(f"{what} {over}", "output", turned, place - place[0], CURVE),
            Diagram(bend, "acceleration", turned, jet[2], OUTPUT),
        ],
        marks=[math.degrees(at - begun[0]) % 360.0 for span in spans for at in span],
    )


def parallel_motion(design: ParallelMotionDesign, problem: ParallelMotionProblem, linkage: DrivenLinkage) -> Content:
    """Return the content for a parallel motion: the body and its two paths over the range, and transmission angles."""
    unit, metrics = problem.length_unit, design.metrics
    first, last = (math.radians(degrees) for degrees in metrics.input_range)
    scene = Scene(linkage, np.linspace(first, last, PLACES + 1)[:-1], ["P", "Q"])
    turned = np.linspace(0.0, abs(last - first), SAMPLES)
    sines = linkage.driven(first + math.copysign(1.0, last - first) * turned).sines

    def bodies(view: Viewport) -> list[Element]:
        return [
            line(view.point(at["P"]), view.point(at["Q"]), stroke=DEMANDED, stroke_width=3.0, data_body=f"{k + 1}")
            for k in range(PLACES)
            if (at := scene.joints(k))
        ]

    name = NAMES[design.mechanism.type]
    return Content(
        name,
        f"{name}, {BASES[metrics.base]}",
        f"a sixbar at {PLACES} places of its range",
        PlanarPicture(scene, unit, bodies),
        left_out={"base"},
        titles={"rotation": "rotation of the body", "translation": "Q from P"},
        standing="there",
        more_dimensions=_coupler_point(design.mechanism),
        diagrams=[
            Diagram(
                f"transmission angle at the {link} (°) over the input's rotation",
                f"transmission_{link}",
                np.degrees(turned),
                np.degrees(np.arcsin(np.minimum(np.abs(sine), 1.0))),
                OUTPUT,
            )
            for link, sine in sines.items()
        ],
    )


def _coupler_point(mechanism: Any) -> list[tuple[str, str]]:
    point = mechanism.coupler_point
    on_coupler = [("coupler point A–P", length(point.distance)), ("its angle from A–B", angle(point.angle))]
    return [*on_coupler, ("reference input angle", angle(mechanism.reference_input_angle))]


def _point_of_dwell(mechanism: DwellMechanism) -> list[tuple[str, str]]:
    """Return the rows of P on the coupler, or of third pins by their angles; their distances are among the links."""
    if mechanism.coupler_point is not None:
        return _coupler_point(mechanism)
    triad = mechanism.type == "dwell_stephenson_2"
    corners = [("O2", "A", "C"), ("B", "D", "E")] if triad else [("O4", "B", "P")]
    angles = []
    for pin, end, other in corners:
        at, to, third = (complex(*mechanism.skeleton.joints[name]) for name in (pin, end, other))
        turned = math.degrees(cmath.phase((third - at) / (to - at)))
        angles.append((f"angle from {pin}–{end} to {pin}–{other}", angle(turned)))
    return [*angles, ("reference input angle", angle(mechanism.reference_input_angle))]


def balancing(design: BalancedDesign, problem: BalancingProblem, linkage: DrivenLinkage) -> Content:
    """Return the content for a balanced linkage: places of its cycle, counterweights, shaking force and moment."""
    links, start = linkage.mechanism.links, float(linkage.mechanism.reference_input)
    # A geared inertia is drawn as a wheel; the auxiliary joint that gives its link an angle is hidden.
    hidden = {joint for gear in design.geared for joint in links[gear.link]} - set(links[GROUND])
    scene = Scene(linkage, np.linspace(start, linkage.cycle[1], PLACES + 1)[:-1], [], hidden=hidden)
    weights = [(weight, complex(*weight.at)) for weight in design.counterweights if weight.mass > 0.0]
    heaviest = max((weight.mass for weight, _ in weights), default=1.0)
    box = Box.around(np.concatenate([scene.places(), [at for _, at in weights]]))

    def discs(view: Viewport) -> list[Element]:
        drawn = []
        for weight, at in weights:
            # Drawn area is proportional to mass.
            size = WEIGHT * math.sqrt(weight.mass / heaviest)
            if weight.disc_radius is not None:
                size = view.scale * weight.disc_radius
            arm = complex(linkage.mechanism.joints[weight.joint])
            drawn.append(line(view.point(arm), view.point(at), stroke=DEMANDED, stroke_width=2.0))
            marks = {"fill": "none", "stroke": DEMANDED, "data_counterweight": weight.link}
            drawn.append(circle(view.point(at), size, stroke_width=2.4, **marks))
        return drawn

    units, unit = symbols(problem), problem.length_unit
    mass = units[Dimension.MASS]
    rows = [
        (f"on {weight.link}", f"{length(weight.mass)} {mass} at {length(weight.radius)} {unit}, {angle(weight.angle)}")
        for weight, _ in weights
    ]
    rows += [
        (f"{gear.link} : {gear.against}", f"{gear.ratio:g}, {length(gear.inertia)} {units[Dimension.INERTIA]}")
        for gear in design.geared
    ]
    places = [
        (name, f"({length(x, box.diagonal)}, {length(y, box.diagonal)})")
        for name, (x, y) in design.mechanism.skeleton.joints.items()
        if name not in hidden
    ]
    curves = shaking_curves(problem, design)
    per = f"({units[Dimension.FORCE]})", f"({units[Dimension.TORQUE]})"
    return Content(
        "Balanced linkage",
        f"Linkage with {len(weights)} counterweight{'s' * (len(weights) != 1)}",
        f"a linkage at {PLACES} places of its motion, with its counterweights",
        PlanarPicture(scene, unit, discs, box),
        [blocks.rows("Counterweights", rows or [("none", "")])],
        titles={"value": "residual", "bound": "lower bound"},
        dimensions=blocks.rows(f"Joints in the reference ({unit})", places),
        diagrams=[
            Diagram(f"shaking force before {per[0]}", "force_before", curves.at, curves.force_before, CURVE),
            Diagram(f"shaking force after {per[0]}", "force_after", curves.at, curves.force_after, OUTPUT),
            Diagram(f"shaking moment before {per[1]}", "moment_before", curves.at, curves.moment_before, CURVE),
            Diagram(f"shaking moment after {per[1]}", "moment_after", curves.at, curves.moment_after, OUTPUT),
        ],
    )


_CONTENTS: dict[str, Callable[[Any, Any, DrivenLinkage], Content]] = {
    "motion": guided,
    "path": guided,
    "function": function,
    "quick_return": quick_return,
    "steering": steering,
    "straight_line": straight_line,
    "dwell": dwell,
    "parallel_motion": parallel_motion,
    "balancing": balancing,
    "spring_balancing": spring_balancing,
}


def content_of(design: Any, problem: Any, linkage: DrivenLinkage) -> Content:
    """Return the sheet content of a design for its kind of problem."""
    return _CONTENTS[problem.kind](design, problem, linkage)
