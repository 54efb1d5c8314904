"""Verification of a finished planetary train, from its tooth numbers alone.

The ratio comes from the speed equations in exact fractions, coaxiality from exact centre distances, assembly from
trying every tooth of every planet at its place, clearance from the coordinates of the pins, and the meshes from the
geometry of their teeth. Tip interference with the teeth that rack and cutter leave is found by trying all positions of
these tools. No result of the solver is used.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from fractions import Fraction
from functools import lru_cache

from kinematics.errors import DimensionError
from kinematics.gear.arrangements import ARRANGEMENTS, Arrangement
from kinematics.gear.assembly import Gap, compute_pin_distances, has_fit_at, is_coaxial, measure_gaps
from kinematics.gear.cut_space import measure_tip_depth
from kinematics.gear.planetary import compute_speed_ratio, solve_speeds
from kinematics.gear.power import PowerFlow, solve_power_flow
from kinematics.gear.teeth import Gear, Mesh
from synthesis.kinds.planetary_train.design import MeshContact, PlanetaryMechanism, PlanetaryMetrics
from synthesis.kinds.planetary_train.problem import DIAMETER_SLACK, PlanetaryProblem
from synthesis.model.answer import Check, Verification
from synthesis.model.dimension import LENGTH
from synthesis.model.dynamics.request import METRES_PER_UNIT
from synthesis.model.gears.answer import is_fillet_reached, shape_ring
from synthesis.model.gears.planet_strength import MeshLoad, describe_strengths
from synthesis.model.gears.ratio_target import parse_decimal
from synthesis.model.gears.strength import PairStrength
from synthesis.results.exhaustive import is_within_tolerance
from synthesis.verification.checks import check_error, check_maximum, check_minimum

SIZE_SLACK = 1e-12
"""Relative slack of the size, an integer number of half modules except for the rounding of one product."""


TIP_DEPTH_TOLERANCE = 1e-6
"""Apparent tip interference, in modules, of flanks that touch: the positions of the tools are tried in steps."""

ROUNDING_TOLERANCE = 1e-9
"""Relative shortfall of a safety or a face that is attributed to rounding."""


def verify(problem: PlanetaryProblem, mechanism: PlanetaryMechanism) -> Verification:
    """Check every constraint on a planetary train."""
    arrangement = ARRANGEMENTS[mechanism.arrangement]
    coaxial = is_coaxial(arrangement, mechanism.teeth)
    checks = [_check_ratio(problem, mechanism, arrangement), _check_limits(problem, mechanism, arrangement)]
    checks.append(Check(name="coaxial", passed=coaxial))
    # Without coaxial gears there are no pin distances to measure.
    if coaxial:
        checks += _check_strength(problem, mechanism)
        checks += [_check_assembly(mechanism, arrangement), _check_clearance(problem, mechanism, arrangement)]
        checks += _check_meshes(problem, mechanism, arrangement)
        if problem.max_size is not None:
            size = compute_size(mechanism) * mechanism.module
            checks.append(check_maximum("size", size, problem.max_size, LENGTH, SIZE_SLACK))
        rings = [mechanism.teeth[gear.name] for gear in arrangement.gears if gear.internal]
        if problem.max_ring_diameter is not None and rings:
            diameter = max(rings) * mechanism.module
            checks.append(check_maximum("ring_diameter", diameter, problem.max_ring_diameter, LENGTH, DIAMETER_SLACK))
        if problem.min_efficiency is not None:
            roles = (mechanism.input, mechanism.output, mechanism.fixed)
            efficiency = solve_efficiency(problem, arrangement, mechanism.teeth, roles)
            checks.append(check_minimum("efficiency", efficiency, problem.min_efficiency))
    return Verification.from_checks(checks)


def _compute_strengths(problem: PlanetaryProblem, mechanism: PlanetaryMechanism) -> list[PairStrength | None]:
    """Compute the stresses of every mesh over the faces, from lossless torques and speeds in exact fractions."""
    arrangement, stated = ARRANGEMENTS[mechanism.arrangement], problem.strength
    train = arrangement.build_train(mechanism.teeth)
    members = mechanism.input, mechanism.output, mechanism.fixed
    turning = {body: w or Fraction(0) for body, w in solve_speeds(train, {members[2]: 0, members[0]: 1}).values.items()}
    flow = solve_power_flow(train, turning, members, {members[0]: 1})
    if stated is None or flow is None:
        return [None] * len(train.meshes)
    torque = stated.power / stated.speed
    loads = [
        MeshLoad(
            (float(load.first_torque) * torque, float(load.second_torque) * torque),
            float(turning[mesh.first] - turning[mesh.carrier]) * stated.speed,
        )
        for mesh, load in zip(train.meshes, flow.meshes, strict=True)
    ]
    gears = {name: _build_gear(mechanism, arrangement, name) for name in mechanism.teeth}
    unit = 1000.0 * METRES_PER_UNIT[problem.length_unit]
    strengths = describe_strengths(arrangement, gears, loads, mechanism.planets, stated, mechanism.face_widths, unit)
    return [None if one is None else PairStrength(**one) for one in strengths]


def _check_strength(problem: PlanetaryProblem, mechanism: PlanetaryMechanism) -> list[Check]:
    """Check the safeties of all judged gears, and the face widths."""
    stated = problem.strength
    if stated is None:
        return []
    meshes = [mesh for mesh in _compute_strengths(problem, mechanism) if mesh is not None]
    safeties = [
        getattr(gear, name)
        for mesh in meshes
        for gear in mesh.gears
        for name in stated.required_safeties
        if name != "bending_safety" or gear.bending_judged is None
    ]
    least = min(0.0 if safety is None else safety for safety in safeties)
    widest = max((mesh.face_width or math.inf) / mechanism.module for mesh in meshes)
    return [
        Check(name="strength", passed=least >= 1.0 - ROUNDING_TOLERANCE, value=least, limit=1.0),
        check_error("relative_face_width", widest, stated.max_face_width * (1.0 + ROUNDING_TOLERANCE)),
    ]


def compute_exact_ratio(mechanism: PlanetaryMechanism) -> Fraction | None:
    """Compute the ratio by the speed equations; None if the train is locked or the output does not turn."""
    train = ARRANGEMENTS[mechanism.arrangement].build_train(mechanism.teeth)
    return compute_speed_ratio(train, mechanism.input, mechanism.output, [mechanism.fixed])


def compute_size(mechanism: PlanetaryMechanism) -> float:
    """Compute the largest pitch diameter around the axis, planets included, in modules; for coaxial gears."""
    arrangement, teeth = ARRANGEMENTS[mechanism.arrangement], mechanism.teeth
    reach = [float(teeth[gear.name]) for gear in arrangement.gears if gear.internal]
    distances = compute_pin_distances(arrangement, teeth)
    for gear in arrangement.gears:
        if gear.body in arrangement.carriers:
            at = float(distances[gear.body][0])
            reach.append(max(2.0 * at, teeth[gear.name]) if arrangement.bevel else 2.0 * at + teeth[gear.name])
    return max(reach)


def solve_flow(
    problem: PlanetaryProblem, arrangement: Arrangement, teeth: Mapping[str, int], roles: tuple[str, str, str]
) -> PowerFlow:
    """Solve the power flow of a train, from input to output with the third member fixed, for unit input speed."""
    train = arrangement.build_train(dict(teeth))
    driving, _, fixed = roles
    turning = solve_speeds(train, {fixed: 0, driving: 1}).values
    known = {body: speed for body, speed in turning.items() if speed is not None}
    flow = solve_power_flow(train, known, roles, {driving: 1}, parse_decimal(problem.mesh_efficiency))
    assert flow is not None
    return flow


def solve_efficiency(
    problem: PlanetaryProblem, arrangement: Arrangement, teeth: Mapping[str, int], roles: tuple[str, str, str]
) -> float:
    """Return the efficiency of a train; 0 if it is self-locking."""
    return float(solve_flow(problem, arrangement, teeth, roles).efficiency or 0)


def measure(problem: PlanetaryProblem, mechanism: PlanetaryMechanism) -> PlanetaryMetrics:
    """Measure the properties of a coaxial train that its checks do not cover."""
    arrangement = ARRANGEMENTS[mechanism.arrangement]
    train = arrangement.build_train(mechanism.teeth)
    turning = solve_speeds(train, {mechanism.fixed: 0, mechanism.input: 1}).values
    known = {body: speed for body, speed in turning.items() if speed is not None}
    members = mechanism.input, mechanism.output, mechanism.fixed
    flow = solve_flow(problem, arrangement, mechanism.teeth, members)
    ratio = compute_exact_ratio(mechanism)
    assert ratio is not None
    rooms = _measure_gaps(mechanism, arrangement)
    toothed = _build_meshes(mechanism, arrangement)
    return PlanetaryMetrics(
        error=float(ratio / problem.target - 1),
        size=compute_size(mechanism) * mechanism.module,
        total_teeth=sum(mechanism.teeth.values()),
        speeds={body: float(speed) for body, speed in known.items()},
        efficiency=float(flow.efficiency or 0),
        self_locking=flow.self_locking,
        rolling_power=float(flow.largest_rolling_power),
        branch_power=float(flow.largest_branch_power),
        circulating_power=flow.circulates,
        least_room=min(gap.room for gap in rooms) * mechanism.module if rooms else None,
        meshes=[
            MeshContact(
                gears=pair,
                contact_ratio=mesh.contact_ratio,
                centre_distance=_compute_centre_distance(arrangement, pair, mesh),
                fillet_interference=is_fillet_reached(mesh),
                tip_depth=_measure_tip_depth(mesh),
                strength=strength,
            )
            for (pair, mesh), strength in zip(toothed.items(), _compute_strengths(problem, mechanism), strict=True)
        ],
        undercut=[
            gear.name
            for gear in arrangement.gears
            if not gear.internal and _build_gear(mechanism, arrangement, gear.name).is_undercut
        ],
    )


def _check_ratio(problem: PlanetaryProblem, mechanism: PlanetaryMechanism, arrangement: Arrangement) -> Check:
    """Check that the reported ratio is that of the teeth, with the requested direction, within the tolerance."""
    ratio = compute_exact_ratio(mechanism)
    members = (mechanism.input, mechanism.output, mechanism.fixed)
    if ratio is None or members not in problem.list_roles(arrangement):
        return Check(name="ratio", passed=False)
    # Exact fractions, so the error is not rounded.
    error = abs(ratio / problem.target - 1)
    passed = (
        ratio == mechanism.ratio.exact and ratio * problem.target > 0 and is_within_tolerance(error, problem.tolerance)
    )
    return Check(name="ratio", passed=passed, value=float(error), limit=problem.tolerance)


def _check_limits(problem: PlanetaryProblem, mechanism: PlanetaryMechanism, arrangement: Arrangement) -> Check:
    """Check the tooth numbers against their limits; planets and module must be as requested."""
    within = all(
        low <= mechanism.teeth[gear.name] <= high
        for gear in arrangement.gears
        for low, high in [problem.compute_tooth_limits(gear.name, gear.internal)]
    )
    as_asked = mechanism.planets == problem.planets and mechanism.module in problem.module_choices
    return Check(name="tooth_limits", passed=within and as_asked)


def _list_turns(mechanism: PlanetaryMechanism) -> dict[str, list[Fraction]]:
    return {
        planet: [Fraction(step, places.divisions) for step in places.steps]
        for planet, places in mechanism.places.items()
    }


def _check_assembly(mechanism: PlanetaryMechanism, arrangement: Arrangement) -> Check:
    """Check that every copy of every planet set can be assembled at its place, and that no two coincide."""
    turns = _list_turns(mechanism)
    passed = True
    for members in arrangement.planet_sets:
        places = turns[members[0]]
        # Planets of one set sit on one carrier: their copies share the same places.
        alike = all(turns[planet] == places for planet in members)
        passed &= alike and len({turn % 1 for turn in places}) == mechanism.planets
        passed &= all(has_fit_at(arrangement, mechanism.teeth, members, turn) for turn in places)
    return Check(name="assembly", passed=passed)


def _measure_gaps(mechanism: PlanetaryMechanism, arrangement: Arrangement) -> list[Gap]:
    return measure_gaps(arrangement, mechanism.teeth, _list_turns(mechanism))


def _check_clearance(problem: PlanetaryProblem, mechanism: PlanetaryMechanism, arrangement: Arrangement) -> Check:
    """Check the minimum clearance between tips of gears that do not mesh."""
    rooms = _measure_gaps(mechanism, arrangement)
    # Room is in modules.
    least = min((gap.room for gap in rooms), default=math.inf)
    return Check(
        name="clearance",
        passed=least >= problem.compute_min_clearance(mechanism.module),
        value=least * mechanism.module if rooms else None,
        limit=problem.min_clearance,
        dimension=LENGTH,
    )


def _build_gear(mechanism: PlanetaryMechanism, arrangement: Arrangement, name: str, mate: str | None = None) -> Gear:
    """Build a gear; for bevel gears the spur gear with the teeth of the back cone (Tredgold; Norton, Sec. 9.7)."""
    teeth: float = mechanism.teeth[name]
    if arrangement.bevel:
        meshed = mechanism.teeth[mate or arrangement.list_mates(name)[0]]
        # The back cone has z/cos δ teeth, with tan δ the ratio of the teeth.
        teeth *= math.hypot(teeth, meshed) / meshed
    return Gear(
        teeth,
        mechanism.module,
        math.radians(mechanism.pressure_angle),
        mechanism.addendum[name],
        internal=arrangement.places[name].internal,
    )


def _build_meshes(mechanism: PlanetaryMechanism, arrangement: Arrangement) -> dict[tuple[str, str], Mesh]:
    """Build every mesh with its teeth."""
    meshes = {}
    for first, second in arrangement.meshes:
        # A ring is always the gear of its mesh.
        pinion, gear = (second, first) if arrangement.places[first].internal else (first, second)
        meshes[first, second] = Mesh(
            _build_gear(mechanism, arrangement, pinion, gear), _build_gear(mechanism, arrangement, gear, pinion)
        )
    return meshes


def _compute_centre_distance(arrangement: Arrangement, pair: tuple[str, str], mesh: Mesh) -> float:
    """Return the distance of the axes of a mesh; bevel axes intersect."""
    return 0.0 if arrangement.bevel else mesh.centre_distance


def _check_meshes(problem: PlanetaryProblem, mechanism: PlanetaryMechanism, arrangement: Arrangement) -> list[Check]:
    """Check the interference and the contact ratio of all meshes."""
    # Impossible teeth fail as interference.
    try:
        meshes: Mapping[tuple[str, str], Mesh] = _build_meshes(mechanism, arrangement)
    except DimensionError:
        return [Check(name="interference", passed=False)]
    least = min(mesh.contact_ratio for mesh in meshes.values())
    checks = [
        Check(name="interference", passed=not any(mesh.interferes for mesh in meshes.values())),
        check_minimum("contact_ratio", least, problem.min_contact_ratio),
    ]
    if problem.fillets == "refuse":
        # The worst mesh decides.
        depth, reached = 0.0, False
        for mesh in meshes.values():
            depth, reached = max(depth, _measure_tip_depth(mesh)), reached or is_fillet_reached(mesh)
        # Touching flanks appear to overlap by the step of the tool positions.
        limit = TIP_DEPTH_TOLERANCE * mechanism.module
        rings = [shape_ring(mesh) for mesh in meshes.values() if mesh.gear.internal]
        checks += [
            Check(
                name="fillet_interference",
                passed=not reached and depth <= limit,
                value=depth,
                limit=limit,
                dimension=LENGTH,
            ),
            Check(name="ring_trimmed", passed=not any(ring.is_trimmed for ring in rings)),
        ]
    return checks


@lru_cache(maxsize=1024)
def _measure_tip_depth(mesh: Mesh) -> float:
    """Measure how deep tips dig into the teeth that the rack and the usual cutter leave; 0 if they run free."""
    return max(0.0, measure_tip_depth(mesh, shape_ring(mesh).cutter_teeth if mesh.gear.internal else 0))
