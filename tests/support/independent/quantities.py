"""What designs state, by its path in a design: every number, class and check, and which of them is no measure.

The paths leave out indices of lists and names of links; a check is ``checks.`` and its name.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, get_args

from pydantic import BaseModel

SKIPPED = ("mechanism", "placement", "verification", "layout", "forces", "manufacture", "exact", "yield_")
"""Fields of a design that are its dimensions, from which all is measured; the checks, which are listed by name; and
what has a measure of its own: planes (:mod:`benchmarks.layout`), forces (:mod:`benchmarks.dynamics`), and linkages as
they are made (:mod:`benchmarks.manufacture`)."""

NOT_MEASURED = {
    "targets.index": "a number in a list",
    "cognate_choice": "words",
    "point_link": "what the answer calls it",
    "metrics.family": "what the solver calls the design",
    "metrics.proportions": "what the solver calls the design",
    "metrics.base": "what the solver calls the design",
    "metrics.input_side": "what the solver calls the design",
    "metrics.moving_links": "a count of the skeleton's links",
    "metrics.runs_on_slide": "whether the skeleton has slides",
    "metrics.min_pin_distance": "compared with layouts in planes",
    "metrics.max_link_width": "compared with layouts in planes",
    "metrics.relative_link_width": "compared with layouts in planes",
    "cognates.side": "what the answer calls it",
    "dials.input.at": "a dimension, by which the targets are measured",
    "dials.input.place": "a dimension, by which the targets are measured",
    "dials.input.scale": "a dimension, by which the targets are measured",
    "dials.output.at": "a dimension, by which the targets are measured",
    "dials.output.place": "a dimension, by which the targets are measured",
    "dials.output.scale": "a dimension, by which the targets are measured",
    "structural_error.unit": "a unit",
    "segments.motion": "as it is stated",
    "segments.law": "as it is stated, or the name of what was found",
    "joints.segments": "numbers in a list",
    "optimality.criterion": "as it is stated",
    "optimality.bound": "a bound that the tests of the bounds attack, not a measure of the cam",
    "optimality.gap": "value over bound",
    "optimality.scope": "words",
    "optimality.warning": "words",
    "metrics.forces.warning": "words",
}
"""What a design states that is no measure of it, and why."""


_LINKAGE = """
metrics.grashof metrics.barker metrics.min_transmission_angle metrics.transmission_angles metrics.full_rotation
metrics.link_ratio metrics.reach metrics.size metrics.quality metrics.used_range
checks.same_branch checks.visits_in_order checks.transmission_angle checks.grashof checks.full_rotation
checks.shortest_link checks.longest_link checks.link_ratio checks.fixed_pivot_region checks.moving_pivot_region
checks.fixed_pivot_zones checks.moving_pivot_zones checks.box checks.obstacles
mechanism.links
"""
"""What every kind of linkage states."""

_TARGETS = """
metrics.same_branch metrics.visits_in_order metrics.input_rotation metrics.rms_residual
targets.input_angle targets.residual
checks.same_circuit checks.reaches_targets
"""
"""What is stated where a linkage goes through targets."""

_PATH_CHECKS = """
checks.within_tolerance checks.curve_within_tolerance checks.input_pivot_region checks.fixed_pivots checks.coupler_point
checks.crank_phase checks.stance_flatness checks.stance_speed
"""

COMPARED: dict[str, frozenset[str]] = {
    kind: frozenset(" ".join(quantities).split())
    for kind, quantities in {
        "motion": (
            _LINKAGE,
            _TARGETS,
            """
            metrics.input_stroke metrics.input_travel metrics.body_travel_ratio metrics.body_turn_ratio
            metrics.used_stroke targets.input_place targets.point_residual targets.angle_residual
            checks.within_tolerance checks.input_side checks.output_side checks.ground_line
            checks.crank_turns checks.limits checks.driver_pivot_region
            """,
        ),
        "path": (
            _LINKAGE,
            _TARGETS,
            _PATH_CHECKS,
            """
            metrics.sum_of_squares metrics.rms_distance metrics.max_distance metrics.curve_distance metrics.excursion
            metrics.both_way_rms targets.point_residual
            metrics.stance_flatness metrics.stance_speed_deviation metrics.stance_rotation
            cognates.grashof cognates.full_rotation cognates.same_timing cognates.same_branch cognates.visits_in_order
            cognates.min_transmission_angle cognates.deviation
            """,
        ),
        "function": (
            _LINKAGE,
            _TARGETS,
            """
            metrics.max_structural_error metrics.rms_structural_error metrics.output_range
            targets.input targets.output targets.output_place targets.error
            structural_error.max structural_error.rms structural_error.alternations
            structural_error.extremes.input structural_error.extremes.input_angle structural_error.extremes.error
            structural_error.curve.input structural_error.curve.input_angle structural_error.curve.error
            checks.covers_range checks.dials
            """,
        ),
        "dwell": (
            _LINKAGE,
            """
            metrics.same_branch metrics.way metrics.jitter metrics.peak_velocity metrics.peak_acceleration
            targets.input_angle targets.level targets.jitter targets.width targets.off_end
            dwells.angle dwells.at dwells.error
            checks.crank_turns checks.way checks.dwell_1 checks.dwell_1_at_end checks.dwell_2 checks.dwell_2_at_end
            checks.dwell_3 checks.dwell_1_at_place checks.dwell_2_at_place checks.dwell_3_at_place checks.dwells_apart
            """,
        ),
        "quick_return": (
            _LINKAGE,
            """
            metrics.time_ratio metrics.slow_rotation metrics.fast_rotation metrics.swing metrics.stroke
            targets.input_angle targets.output
            checks.crank_turns checks.time_ratio checks.swing checks.stroke checks.reaches_targets
            """,
        ),
        "straight_line": (
            _LINKAGE,
            """
            metrics.same_branch metrics.visits_in_order metrics.deviation metrics.straightness_error
            metrics.velocity_variation metrics.mean_velocity metrics.middle_velocity metrics.input_rotation
            metrics.cycle_transmission_angle
            targets.input_angle targets.x targets.y targets.deviation
            checks.reaches_ends checks.exact_line checks.deviation checks.velocity_variation checks.rotation
            """,
        ),
        "parallel_motion": (
            _LINKAGE,
            _TARGETS,
            _PATH_CHECKS,
            """
            metrics.rotation metrics.translation metrics.curve_distance metrics.input_range targets.point_residual
            checks.translates checks.on_curve
            """,
        ),
        "steering": (
            """
            metrics.steering_error metrics.correct_at metrics.outer_lock metrics.arm_length metrics.arm_angle
            metrics.tie_rod metrics.turning_radius metrics.min_transmission_angle metrics.link_ratio metrics.size
            metrics.bar_travel metrics.tie_rod_clearance metrics.used_range metrics.used_stroke mechanism.links
            targets.input_angle targets.input_place targets.inner targets.outer targets.required targets.error
            checks.same_branch checks.visits_in_order checks.transmission_angle checks.grashof checks.shortest_link
            checks.longest_link checks.link_ratio checks.fixed_pivot_region checks.moving_pivot_region
            checks.reaches_locks checks.steers_correctly checks.steering_error checks.tie_rod_clearance
            checks.fixed_pivot_zones checks.moving_pivot_zones checks.box checks.obstacles
            """,
        ),
        "cam": (
            """
            metrics.size metrics.lift metrics.max_pressure_angle_rise metrics.max_pressure_angle_fall
            metrics.min_convex_radius metrics.min_concave_radius metrics.min_radius metrics.curvature_ratio
            metrics.overturning_moment metrics.face_width metrics.groove_width metrics.length metrics.peak_velocity
            metrics.peak_acceleration metrics.peak_jerk metrics.rms_acceleration metrics.peak_inertia_torque
            metrics.forces.preload metrics.forces.least_preload metrics.forces.min_contact_force
            metrics.forces.max_contact_force metrics.forces.min_torque metrics.forces.max_torque
            metrics.forces.wall_changes metrics.forces.natural_frequency metrics.forces.frequency_ratio
            metrics.forces.spring_rate metrics.forces.jump_speed metrics.forces.damped_frequency
            metrics.forces.pushing.start metrics.forces.pushing.end metrics.forces.pushing.cam
            metrics.second.size metrics.second.max_pressure_angle_rise metrics.second.max_pressure_angle_fall
            metrics.second.min_convex_radius metrics.second.min_concave_radius metrics.second.curvature_ratio
            metrics.forces.over_speeds.max_rpm metrics.forces.over_speeds.min_contact_force
            metrics.forces.over_speeds.angle metrics.forces.over_speeds.rpm metrics.forces.spring.max_contact_force
            metrics.forces.spring.bound metrics.forces.spring.gap metrics.forces.spring.binding
            metrics.forces.train.natural_frequency metrics.forces.train.damped_frequency
            metrics.forces.train.frequency_ratio metrics.forces.train.period_ratio
            metrics.forces.train.residual_amplitude metrics.forces.train.min_contact_force
            metrics.forces.train.max_contact_force
            segments.start segments.angle segments.displacement segments.peak_velocity segments.peak_acceleration
            segments.peak_jerk
            joints.angle joints.continuous joints.jump.s joints.jump.v joints.jump.a joints.jump.j
            optimality.value
            checks.keeps_the_statement checks.table_velocity checks.table_acceleration checks.table_jerk
            checks.touches_everywhere checks.reproduces_program checks.no_cusp checks.does_not_cross_itself
            checks.outer_wall_reproduces_program checks.outer_wall_is_sound checks.lower_wall_reproduces_program
            checks.upper_wall_reproduces_program checks.peak_velocity checks.peak_acceleration checks.peak_jerk
            checks.meets_positions checks.meets_velocities checks.meets_accelerations checks.min_radius checks.convex
            checks.face_width checks.clears_pivot checks.pressure_angle checks.pressure_angle_fall
            checks.curvature_ratio checks.hub_radius checks.size checks.contact_force checks.contact_on_profile
            checks.roller_distance checks.second_reproduces_program checks.second_no_cusp
            checks.second_does_not_cross_itself checks.second_pressure_angle checks.second_pressure_angle_fall
            checks.second_curvature_ratio checks.second_hub_radius checks.second_size checks.second_clears_pivot
            mechanism.second checks.frequency_ratio checks.overturning_moment checks.overturning_on_profile
            checks.limit checks.passed
            mechanism.program mechanism.conditions mechanism.profile mechanism.outer_wall mechanism.lower_wall
            mechanism.upper_wall mechanism.pitch_curve mechanism.smallest mechanism.roller_radius
            mechanism.best_law
            """,
        ),
    }.items()
}
"""What is compared of each kind, where a design states it."""

NEVER_STATED = {
    "motion": "checks.chain",
    "path": "metrics.input_stroke metrics.input_travel metrics.body_travel_ratio metrics.body_turn_ratio "
    "metrics.used_stroke targets.input_place targets.angle_residual",
    "parallel_motion": "metrics.input_stroke metrics.input_travel metrics.body_travel_ratio metrics.body_turn_ratio "
    "metrics.used_stroke targets.input_place targets.angle_residual",
    "function": "metrics.input_stroke metrics.input_travel metrics.body_travel_ratio metrics.body_turn_ratio "
    "metrics.used_stroke",
    "dwell": "metrics.used_stroke",
    "quick_return": "metrics.used_stroke",
    "straight_line": "metrics.used_stroke",
    "cam": "checks.follower_can_be_laid_on",
}
"""Fields that a kind's models have from others and never fill in; and checks of which no design is left, or which the
campaign never states: stated chains of sixbars are measured in the tests of their jobs."""


def stated_by(design: Any) -> set[str]:
    """Paths of all that a design states, with the names of its checks."""
    paths = {path for path, _ in _leaves(design.model_dump(exclude=set(SKIPPED)))}
    return paths | {f"checks.{check.name}" for check in design.verification.checks}


def _leaves(value: Any, path: str = "") -> Iterator[tuple[str, Any]]:
    if isinstance(value, dict):
        for name, inner in value.items():
            if name == "mechanism" or (path == "metrics" and name == "transmission_angles"):
                if name == "transmission_angles" and inner:
                    yield f"{path}.{name}", inner
                continue
            yield from _leaves(inner, f"{path}.{name}".lstrip("."))
    elif isinstance(value, list | tuple):
        for inner in value:
            yield from _leaves(inner, path)
    elif value is not None:
        yield path, value


def fields_of(model: type[BaseModel]) -> set[str]:
    """Paths of all that designs of a model may state, the checks apart."""
    return {path for name, path in _fields(model, "") if name not in SKIPPED}


def _fields(model: type[BaseModel], before: str) -> Iterator[tuple[str, str]]:
    for name, field in model.model_fields.items():
        if name in ("mechanism", "yield_") or (not before and name in SKIPPED):
            continue
        path = f"{before}.{name}".lstrip(".")
        inner = list(models_of(field.annotation))
        if not inner:
            yield name, path
        for part in inner:
            yield from _fields(part, path)


def models_of(annotation: Any) -> Iterator[type[BaseModel]]:
    """The models within an annotation."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        yield annotation
    for part in get_args(annotation):
        yield from models_of(part)
