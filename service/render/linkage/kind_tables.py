"""Content of a linkage's sheet for each kind of problem: one function per kind, collected in one table."""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from kinematics.linkage.planar.limits import find_cycle_from_reference
from kinematics.linkage.planar.mechanism import GROUND
from service.render.linkage import fourbar_tables
from service.render.linkage.content import Content
from service.render.linkage.drawing import PlanarPicture, Scene
from service.render.linkage.fourbar import build_scene as fourbar_scene
from service.render.linkage.fourbar_picture import FourbarPicture, describe_fourbar
from service.render.linkage.function_diagram import draw_range_arc, make_function_diagram
from service.render.linkage.motion import DrivenLinkage, get_stance_curve, get_target_curve, list_demands
from service.render.linkage.spring_balancing import make_spring_balancing
from service.render.linkage.styles import STANCE_LINE
from service.render.page import blocks
from service.render.page.diagrams import Diagram
from service.render.page.numbers import format_angle, format_length, format_small
from service.render.page.svg import Box, Element, Viewport, draw_circle, draw_line, draw_path
from service.render.page.symbols import CURVE, OUTPUT, TARGET_COLOUR
from service.units import list_symbols
from synthesis.kinds.balancing.curves import compute_shaking_curves
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
from synthesis.kinds.quick_return.verification import OUTPUT_NAMES
from synthesis.kinds.steering.design import SteeringDesign
from synthesis.kinds.steering.problem import SteeringProblem
from synthesis.kinds.straight_line.design import StraightLineDesign
from synthesis.kinds.straight_line.problem import StraightLineProblem
from synthesis.model.design_interface import AnyDesign
from synthesis.model.dimension import Dimension
from synthesis.model.linkage.answer import (
    CouplerPoint,
    FourbarMechanism,
    LinkageDesign,
    MultiloopMechanism,
    SixbarMechanism,
)
from synthesis.model.linkage.sixbars import SIXBAR_NAMES
from synthesis.model.problem import ProblemBase

SAMPLE_COUNT = 721
"""Number of points of a diagram's curve, and of P's path during a dwell."""

MAX_ROWS = 12
"""Maximum number of targets that are listed, and of configurations of a function generator that are drawn."""

PLACE_COUNT = 4
"""Number of places of its range at which a parallel motion is drawn; the body is drawn heavy at all of them."""

MAX_WEIGHT_RADIUS = 16.0
"""Drawn radius of the heaviest counterweight without a disc radius, pixels."""

TYPE_NAMES = {
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
    "eightbar": "Eightbar",
}
"""Names of mechanism types on a sheet."""

GENERATOR_NAMES = {**SIXBAR_NAMES, "fourbar": "Fourbar", "slider_crank": "Slider-crank", "eightbar": "Eightbar"}
"""First words of a function generator's title."""

STROKE_NAMES = TYPE_NAMES | {"fourbar": "Crank-rocker", "slider_crank": "Offset slider-crank"}

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

PROPORTION_NAMES = {"optimal": "best", "classical": "classical", "exact": "exact"}

BASE_NAMES = {
    "source": "of the given fourbar",
    "left_cognate": "of its left cognate",
    "right_cognate": "of its right cognate",
    "path": "of a fourbar through the points",
}
"""Origin of a sixbar for parallel motion."""


def make_guided(design: LinkageDesign, problem: MotionProblem | PathProblem, linkage: DrivenLinkage) -> Content:
    """Return the content for a guided body or point: at the targets; for a whole curve, at its first and last point."""
    unit = problem.length_unit
    if isinstance(design.mechanism, FourbarMechanism):
        fourbar = fourbar_scene(design, problem, linkage)
        grashof = design.metrics.grashof
        kind = "" if grashof is None else f", {fourbar_tables.GRASHOF_NAMES[grashof]}"
        return Content(
            "Fourbar linkage",
            f"Fourbar linkage, {design.mechanism.assembly} assembly{kind}",
            describe_fourbar(design, unit, fourbar),
            FourbarPicture(fourbar, unit),
            [fourbar_tables.make_targets_block(design, fourbar, unit)],
            dimensions=fourbar_tables.make_dimensions_block(design, fourbar, unit),
        )
    inputs, target, demands = linkage.find_target_inputs(design), get_target_curve(problem), list_demands(problem)
    if isinstance(problem, PathProblem) and problem.is_matched:
        # A closed curve is drawn over a full cycle.
        last = inputs[0] + find_cycle_from_reference(linkage.mechanism) if problem.closed else inputs[-1]
        inputs, demands = np.array([inputs[0], last]), demands[:1]
    scene = Scene(linkage, inputs, ["P"], "P", demands, target)
    slides = linkage.mechanism.has_slide_input
    met = [
        (
            f"{target.index + 1}: input "
            f"{format_length(target.position) if slides else format_angle(target.position, 2)}",
            f"off by {format_small(target.point_residual)} {unit}"
            + ("" if target.angle_residual is None else f", {format_angle(target.angle_residual, 2)}"),
        )
        for target in design.targets
    ]
    driven = not isinstance(design.mechanism, SixbarMechanism) or "driver_coupler" in design.mechanism.links
    name = (TYPE_NAMES if driven else SIXBAR_NAMES)[design.mechanism.type]
    return Content(
        name,
        name,
        f"a linkage at {len(inputs)} targets",
        PlanarPicture(scene, unit, partial(_draw_stance, problem), heights=(460.0, 860.0)),
        [blocks.make_rows("Targets", _truncate_rows(met))],
    )


def _draw_stance(problem: MotionProblem | PathProblem, view: Viewport) -> list[Element]:
    """Draw the required points of a stance."""
    points = get_stance_curve(problem)
    drawn = None if points is None else draw_path(view.clip_to_panel(points), **STANCE_LINE, data_curve="stance")
    return [] if drawn is None else [drawn]


def _truncate_rows(rows: list[tuple[str, str]]) -> list[tuple[str, str]]:
    """Return the first rows, and the number of omitted ones."""
    more = len(rows) - MAX_ROWS
    return [*rows[:MAX_ROWS], (f"and {more} more", "")] if more > 0 else rows


def make_function(design: FunctionDesign, problem: FunctionProblem, linkage: DrivenLinkage) -> Content:
    """Return the content for a function generator.

    It shows the targets, the range of the input as an arc, and the structural error or the output.
    """
    unit, error, dials = problem.length_unit, design.structural_error, design.dials
    slides = error.unit == "length"
    # Evenly chosen targets, first and last included.
    chosen = np.unique(np.linspace(0, len(design.targets) - 1, min(MAX_ROWS, len(design.targets))).astype(int))
    scene = Scene(linkage, linkage.find_target_inputs(design)[chosen], [], hidden={"P"})

    def format_error(value: float) -> str:
        return f"{format_length(value, digits=4)}{f' {unit}' if slides else '°'}"

    def format_place(place: float) -> str:
        return f"{format_length(place)} {unit}" if slides else format_angle(place)

    readings = [
        (f"input at {format_angle(dials.input.place)}", f"has the value {format_length(dials.input.at)}"),
        ("input rotation per unit", format_angle(dials.input.scale, 6)),
        (f"output at {format_place(dials.output.place)}", f"has the value {format_length(dials.output.at)}"),
        ("output travel per unit", format_place(dials.output.scale)),
    ]
    met = [
        (
            f"{target.index + 1}: {format_length(target.input, digits=5)} → {format_length(target.output, digits=5)}",
            f"at {format_angle(target.input_angle, 2)}, off by {format_error(target.error)}",
        )
        for target in design.targets
    ]
    mechanism = design.mechanism
    more = [("offset", format_length(mechanism.offset))] if mechanism.type == "slider_crank" else []
    if not isinstance(mechanism, MultiloopMechanism):
        more.append(("assembly", mechanism.assembly))
    name = f"{GENERATOR_NAMES[mechanism.type]} function generator"
    return Content(
        name,
        name,
        f"a linkage at {len(design.targets)} targets; structural error at most {format_error(error.max)}",
        PlanarPicture(scene, unit, lambda view: draw_range_arc(design, scene, view), heights=(380.0, 640.0)),
        [blocks.make_rows("Dials", readings), blocks.make_rows("Targets", _truncate_rows(met))],
        more_dimensions=more,
        hidden={"P"},
        diagrams=[make_function_diagram(design, problem, linkage)],
    )


def make_quick_return(design: QuickReturnDesign, problem: QuickReturnProblem, linkage: DrivenLinkage) -> Content:
    """Return the content for a quick return.

    It shows both limit positions, and the output and its rate over a turn from the first of them.
    """
    unit, metrics, kind = problem.length_unit, design.metrics, design.mechanism.type
    scene = Scene(linkage, linkage.find_target_inputs(design), [joint for joint in linkage.moving if joint != "P"])
    size, name = scene.find_box().diagonal, STROKE_NAMES[kind]
    turned = np.linspace(0.0, 360.0, SAMPLE_COUNT)
    # A full turn from the first limit position.
    motion = linkage.drive_over(linkage.convert_inputs(design.targets[0].input_angle + turned), order=1)
    if OUTPUT_NAMES[kind] in linkage.mechanism.links:
        place, rate = motion.angles[OUTPUT_NAMES[kind]]
        value, what, by = np.degrees(np.unwrap(place)), "swing (°)", "output speed over crank speed"
    else:
        value, rate = motion.slides[OUTPUT_NAMES[kind]]
        what, by = f"stroke ({unit})", f"slider speed ({unit} per radian of the crank)"
    over = "over the crank's rotation from the first limit position"
    limits = [
        (
            f"limit {target.index + 1}: crank {format_angle(target.input_angle, 3)}",
            f"{format_length(target.output, size)} {unit}" if metrics.swing is None else format_angle(target.output, 3),
        )
        for target in design.targets
    ]
    return Content(
        name,
        f"{name} with a time ratio of {format_length(metrics.time_ratio)}",
        "a mechanism at both limit positions of its output",
        PlanarPicture(scene, unit, heights=(400.0, 700.0)),
        [blocks.make_rows("Limits", limits)],
        standing="at the first limit",
        diagrams=[
            Diagram(f"{what} {over}", "output", turned, value - value[0], CURVE),
            Diagram(by, "rate", turned, rate, OUTPUT),
        ],
    )


def make_steering(design: SteeringDesign, problem: SteeringProblem, linkage: DrivenLinkage) -> Content:
    """Return the content for a steering mechanism.

    It shows the linkage straight ahead and at both locks, and the outer angle and its error over the inner angle.
    """
    unit, metrics, targets = problem.length_unit, design.metrics, design.targets
    straight = float(linkage.mechanism.reference_input)
    if linkage.mechanism.has_slide_input:
        # Both locks are equally far from the straight position.
        locks = [targets[-1].position, 2.0 * straight - targets[-1].position]
    else:
        locks = [straight + math.radians(problem.lock), straight - math.radians(metrics.outer_lock)]
    scene = Scene(linkage, np.array([straight, *locks]), [])
    name = TYPE_NAMES.get(design.mechanism.type, "Ackermann steering linkage")
    inner, outer, error = (
        np.array([getattr(target, quantity) for target in targets]) for quantity in ("inner", "outer", "error")
    )
    # The dashed lines mark the largest steering error.
    limit = metrics.steering_error
    met = [
        (
            f"inner {format_angle(target.inner, 2)}: outer {format_angle(target.outer, 3)}",
            f"error {format_angle(target.error, 4)}",
        )
        for target in targets
    ]
    return Content(
        name,
        f"{name}, tie rod {metrics.tie_rod} the kingpins, to a lock of {format_angle(problem.lock)}",
        "a steering mechanism, straight and at both locks",
        PlanarPicture(scene, unit, heights=(260.0, 520.0)),
        [blocks.make_rows("Targets", met)],
        left_out={"tie_rod"},
        standing="when straight",
        diagrams=[
            Diagram("outer wheel (°) over the inner wheel's angle", "outer", inner, outer, CURVE),
            Diagram("steering error (°)", "error", inner, error, OUTPUT, (-limit, limit)),
        ],
    )


def make_straight_line(design: StraightLineDesign, problem: StraightLineProblem, linkage: DrivenLinkage) -> Content:
    """Return the content for a straight-line linkage: ends and middle; deviation and velocity along the line."""
    unit, metrics = problem.length_unit, design.metrics
    first, last = (float(at) for at in linkage.find_target_inputs(design))
    scene = Scene(linkage, np.array([first, 0.5 * (first + last), last]), ["P"], "P")
    start = complex(*problem.start)
    along = cmath.rect(1.0, math.radians(problem.direction))
    end = start + problem.length * along
    box = Box.enclose(np.concatenate([scene.list_places(), [start, end], scene.used]))
    # Diagrams run from the start in either direction of the input.
    turned, sense = np.linspace(0.0, abs(last - first), SAMPLE_COUNT), math.copysign(1.0, last - first)
    point, rate = linkage.drive_over(first + sense * turned, order=1).joints["P"]
    at = np.degrees(turned)

    def draw_line_target(view: Viewport) -> list[Element]:
        ends = view.point(start), view.point(end)
        return [draw_line(*ends, stroke=TARGET_COLOUR, stroke_width=1.4, stroke_dasharray="6 4", data_line="demanded")]

    ends = [
        (
            f"{what}: input {format_angle(target.input_angle)}",
            f"({format_length(target.x, box.diagonal)}, {format_length(target.y, box.diagonal)})",
        )
        for what, target in zip(("start", "end"), design.targets, strict=True)
    ]
    name, across = LINE_NAMES[metrics.family], ((point - start) * along.conjugate()).imag
    heading = f"distance from the line ({unit}) over the input's rotation"
    per = f"velocity along the line ({unit}/rad) over the input's rotation"
    return Content(
        name,
        f"{name}, {PROPORTION_NAMES[metrics.proportions]} proportions",
        "a linkage at both ends and in the middle of a straight line",
        PlanarPicture(scene, unit, draw_line_target, box),
        [blocks.make_rows("Line", ends)],
        left_out={"family", "proportions"},
        titles={"deviation": "greatest deviation", "middle velocity": "velocity in the middle"},
        standing="at the start",
        diagrams=[
            Diagram(heading, "deviation", at, across, CURVE),
            Diagram(per, "velocity", at, sense * (rate * along.conjugate()).real, OUTPUT),
        ],
    )


def _list_rests(design: DwellDesign, problem: DwellProblem) -> list[tuple[str, str]]:
    """Return the rows of the table of dwells."""

    def measure(value: float) -> str:
        if problem.slides:
            return f"{format_length(value, digits=4)} {problem.length_unit}"
        return format_angle(value, 4)

    rests = []
    for rest in design.targets:
        rests.append((f"dwell {rest.index + 1} from", format_angle(rest.input_angle, 2)))
        if design.dwells is not None:
            placed = design.dwells[rest.index]
            share = f"{format_length(100.0 * placed.at, digits=3)} % of the way"
            rests.append((f"over {format_angle(placed.angle, 2)}, at", share))
        rests += [
            ("jitter", measure(rest.jitter)),
            (f"width at {measure(problem.max_movement)}", format_angle(rest.width, 2)),
        ]
    return rests


def make_dwell(design: DwellDesign, problem: DwellProblem, linkage: DrivenLinkage) -> Content:
    """Return the content for a dwell sixbar: start and end of a dwell, and away from it; the output over a turn."""
    unit, mechanism = problem.length_unit, design.mechanism
    begun = [float(at) for at in linkage.find_target_inputs(design)]
    rotations, slides = [math.radians(wanted.angle) for wanted in problem.dwell_requests], problem.slides
    rotation = rotations[0]
    # The last configuration shows the second rest, or the output farthest from its only rest.
    away = begun[1] if len(begun) > 1 else begun[0] + 0.5 * rotation + math.pi
    # In a Stephenson II the path of B shows the rotation of link 4 about E while the output rests.
    along = "B" if mechanism.type == "dwell_stephenson_2" else "P"
    traced = [joint for joint in (along, "D") if joint in linkage.mechanism.joints]
    scene = Scene(linkage, np.array([begun[0], begun[0] + rotation, away]), traced)
    # Input ranges of the dwells.
    spans = [(at, at + wide) for at, wide in zip(begun, rotations, strict=True)]
    resting = [linkage.trace_path(along, *span, SAMPLE_COUNT) for span in spans]
    turned = np.linspace(0.0, 360.0, SAMPLE_COUNT)
    motion = linkage.drive_over(begun[0] + np.radians(turned), order=2)
    jet = motion.slides["D"] if slides else motion.angles["output"]
    place = jet[0] if slides else np.degrees(np.unwrap(jet[0]))
    per = f"{unit}/rad²" if slides else "rad/rad²"
    bend = f"acceleration ({per})" if slides else "angular acceleration (rad per rad² of the crank)"
    what, over = f"slider ({unit})" if slides else "output angle (°)", "over the crank's rotation from the first dwell"

    def draw_dwells(view: Viewport) -> list[Element]:
        drawn = (
            draw_path(view.clip_to_panel(at), stroke=TARGET_COLOUR, stroke_width=2.6, data_curve="dwell")
            for at in resting
        )
        return [curve for curve in drawn if curve is not None]

    name = TYPE_NAMES[mechanism.type]
    return Content(
        name,
        f"{name}, crank turns counter-clockwise",
        "a sixbar as a dwell begins and ends, and away from it",
        PlanarPicture(scene, unit, draw_dwells),
        [blocks.make_rows("Dwells", _list_rests(design, problem))],
        titles={"way": "stroke" if slides else "swing"},
        standing="there",
        more_dimensions=_list_dwell_point(mechanism),
        diagrams=[
            Diagram(f"{what} {over}", "output", turned, place - place[0], CURVE),
            Diagram(bend, "acceleration", turned, jet[2], OUTPUT),
        ],
        marks=[math.degrees(at - begun[0]) % 360.0 for span in spans for at in span],
    )


def make_parallel_motion(
    design: ParallelMotionDesign, problem: ParallelMotionProblem, linkage: DrivenLinkage
) -> Content:
    """Return the content for a parallel motion: the body and its two paths over the range, and transmission angles."""
    unit, metrics = problem.length_unit, design.metrics
    first, last = (math.radians(degrees) for degrees in metrics.input_range)
    scene = Scene(linkage, np.linspace(first, last, PLACE_COUNT + 1)[:-1], ["P", "Q"])
    turned = np.linspace(0.0, abs(last - first), SAMPLE_COUNT)
    sines = linkage.drive_over(first + math.copysign(1.0, last - first) * turned).sines

    def draw_bodies(view: Viewport) -> list[Element]:
        return [
            draw_line(
                view.point(at["P"]), view.point(at["Q"]), stroke=TARGET_COLOUR, stroke_width=3.0, data_body=f"{k + 1}"
            )
            for k in range(PLACE_COUNT)
            if (at := scene.get_joints(k))
        ]

    name = TYPE_NAMES[design.mechanism.type]
    return Content(
        name,
        f"{name}, {BASE_NAMES[metrics.base]}",
        f"a sixbar at {PLACE_COUNT} places of its range",
        PlanarPicture(scene, unit, draw_bodies),
        left_out={"base"},
        titles={"rotation": "rotation of the body", "translation": "Q from P"},
        standing="there",
        more_dimensions=_list_coupler_point(design.mechanism.coupler_point, design.mechanism.reference_input_angle),
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


def _list_coupler_point(point: CouplerPoint, input_angle: float) -> list[tuple[str, str]]:
    on_coupler = [
        ("coupler point A–P", format_length(point.distance)),
        ("its angle from A–B", format_angle(point.angle)),
    ]
    return [*on_coupler, ("reference input angle", format_angle(input_angle))]


def _list_dwell_point(mechanism: DwellMechanism) -> list[tuple[str, str]]:
    """Return the rows of P on the coupler, or of third pins by their angles; their distances are among the links."""
    if mechanism.coupler_point is not None:
        return _list_coupler_point(mechanism.coupler_point, mechanism.reference_input_angle)
    triad = mechanism.type == "dwell_stephenson_2"
    corners = [("O2", "A", "C"), ("B", "D", "E")] if triad else [("O4", "B", "P")]
    angles = []
    for pin, end, other in corners:
        at, to, third = (complex(*mechanism.skeleton.joints[name]) for name in (pin, end, other))
        turned = math.degrees(cmath.phase((third - at) / (to - at)))
        angles.append((f"angle from {pin}–{end} to {pin}–{other}", format_angle(turned)))
    return [*angles, ("reference input angle", format_angle(mechanism.reference_input_angle))]


def make_balancing(design: BalancedDesign, problem: BalancingProblem, linkage: DrivenLinkage) -> Content:
    """Return the content for a balanced linkage: places of its cycle, counterweights, shaking force and moment."""
    links, start = linkage.mechanism.links, float(linkage.mechanism.reference_input)
    # A geared inertia is drawn as a wheel; the auxiliary joint that gives its link an angle is hidden.
    hidden = {joint for gear in design.geared for joint in links[gear.link]} - set(links[GROUND])
    scene = Scene(linkage, np.linspace(start, linkage.cycle[1], PLACE_COUNT + 1)[:-1], [], hidden=hidden)
    weights = [(weight, complex(*weight.at)) for weight in design.counterweights if weight.mass > 0.0]
    heaviest = max((weight.mass for weight, _ in weights), default=1.0)
    box = Box.enclose(np.concatenate([scene.list_places(), [at for _, at in weights]]))

    def draw_discs(view: Viewport) -> list[Element]:
        drawn = []
        for weight, at in weights:
            # Drawn area is proportional to mass.
            size = MAX_WEIGHT_RADIUS * math.sqrt(weight.mass / heaviest)
            if weight.disc_radius is not None:
                size = view.scale * weight.disc_radius
            arm = complex(linkage.mechanism.joints[weight.joint])
            drawn.append(draw_line(view.point(arm), view.point(at), stroke=TARGET_COLOUR, stroke_width=2.0))
            marks = {"fill": "none", "stroke": TARGET_COLOUR, "data_counterweight": weight.link}
            drawn.append(draw_circle(view.point(at), size, stroke_width=2.4, **marks))
        return drawn

    units, unit = list_symbols(problem), problem.length_unit
    mass = units[Dimension.MASS]
    rows = [
        (
            f"on {weight.link}",
            f"{format_length(weight.mass)} {mass} at {format_length(weight.radius)} {unit}, "
            f"{format_angle(weight.angle)}",
        )
        for weight, _ in weights
    ]
    rows += [
        (f"{gear.link} : {gear.against}", f"{gear.ratio:g}, {format_length(gear.inertia)} {units[Dimension.INERTIA]}")
        for gear in design.geared
    ]
    places = [
        (name, f"({format_length(x, box.diagonal)}, {format_length(y, box.diagonal)})")
        for name, (x, y) in design.mechanism.skeleton.joints.items()
        if name not in hidden
    ]
    curves = compute_shaking_curves(problem, design)
    per = f"({units[Dimension.FORCE]})", f"({units[Dimension.TORQUE]})"
    return Content(
        "Balanced linkage",
        f"Linkage with {len(weights)} counterweight{'s' * (len(weights) != 1)}",
        f"a linkage at {PLACE_COUNT} places of its motion, with its counterweights",
        PlanarPicture(scene, unit, draw_discs, box),
        [blocks.make_rows("Counterweights", rows or [("none", "")])],
        titles={"value": "residual", "bound": "lower bound"},
        dimensions=blocks.make_rows(f"Joints in the reference ({unit})", places),
        diagrams=[
            Diagram(f"shaking force before {per[0]}", "force_before", curves.at, curves.force_before, CURVE),
            Diagram(f"shaking force after {per[0]}", "force_after", curves.at, curves.force_after, OUTPUT),
            Diagram(f"shaking moment before {per[1]}", "moment_before", curves.at, curves.moment_before, CURVE),
            Diagram(f"shaking moment after {per[1]}", "moment_after", curves.at, curves.moment_after, OUTPUT),
        ],
    )


_CONTENT_MAKERS: dict[str, Callable[[Any, Any, DrivenLinkage], Content]] = {
    "motion": make_guided,
    "path": make_guided,
    "function": make_function,
    "quick_return": make_quick_return,
    "steering": make_steering,
    "straight_line": make_straight_line,
    "dwell": make_dwell,
    "parallel_motion": make_parallel_motion,
    "balancing": make_balancing,
    "spring_balancing": make_spring_balancing,
}


def make_content(design: AnyDesign, problem: ProblemBase, linkage: DrivenLinkage) -> Content:
    """Return the sheet content of a design for its kind of problem."""
    return _CONTENT_MAKERS[problem.kind](design, problem, linkage)
