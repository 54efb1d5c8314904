"""Verification of a finished layshaft gearbox: its power paths as trains of meshes on fixed axes."""

from __future__ import annotations

import math
from fractions import Fraction

from kinematics.gear.planetary import GROUND, Train, compute_speed_ratio
from kinematics.gear.planetary import Mesh as Rolling
from kinematics.gear.teeth import Mesh
from synthesis.kinds.layshaft_gearbox.design import LayshaftMechanism, LayshaftMetrics
from synthesis.kinds.layshaft_gearbox.problem import LayshaftProblem
from synthesis.model.answer import Check, Verification
from synthesis.model.gears.answer import GearPairTeeth
from synthesis.model.gears.ratio_target import parse_decimal
from synthesis.results.exhaustive import is_within_tolerance

CLEARANCE_TOLERANCE = 1e-9
"""Clearance between the tips of reverse gears on layshaft and main shaft, in modules, that counts as no contact."""


def verify(problem: LayshaftProblem, mechanism: LayshaftMechanism) -> Verification:
    """Check every constraint on a layshaft gearbox."""
    errors = _compute_errors(problem, mechanism)
    sums = {one + other for one, other in _list_coaxial_pairs(mechanism)}
    teeth = [z for pair in _list_meshing_pairs(mechanism) for z in pair]
    low, high = problem.teeth.min, problem.teeth.max
    least, most = problem.tooth_sum.min, problem.tooth_sum.max
    checks = [
        Check(
            name="ratios",
            passed=errors is not None and is_within_tolerance(max(map(abs, errors)), problem.tolerance),
            value=None if errors is None else float(max(map(abs, errors))),
            limit=problem.tolerance,
        ),
        Check(name="equal_tooth_sums", passed=len(sums) == 1 and least <= min(sums) and max(sums) <= most),
        Check(name="tooth_limits", passed=all(low <= z <= high for z in teeth)),
    ]
    if problem.reverse is not None:
        checks.append(Check(name="reverse_fits", passed=_is_reverse_feasible(mechanism)))
    if problem.interference == "refuse":
        checks.append(Check(name="interference", passed=not _find_interfering(mechanism)))
    return Verification.from_checks(checks)


def measure(problem: LayshaftProblem, mechanism: LayshaftMechanism) -> LayshaftMetrics:
    """Measure the errors of the gears and the geometry of the meshes."""
    errors = _compute_errors(problem, mechanism)
    assert errors is not None
    return LayshaftMetrics(
        max_error=float(max(map(abs, errors))),
        errors=[float(error) for error in errors],
        tooth_sum=mechanism.head.driver + mechanism.head.driven,
        interfering=[GearPairTeeth(driver=one, driven=other) for one, other in _find_interfering(mechanism)],
        contact_ratios=[_build_mesh(mechanism, pair).contact_ratio for pair in _list_meshing_pairs(mechanism)],
    )


def _compute_errors(problem: LayshaftProblem, mechanism: LayshaftMechanism) -> list[Fraction] | None:
    """Compute the relative errors of all gears, reverse last; None if a gear is missing or reports a wrong ratio."""
    demanded = [parse_decimal(ratio) for ratio in problem.ratios]
    if len(mechanism.gears) != len(demanded) or (mechanism.reverse is None) != (problem.reverse is None):
        return None
    head = Rolling("input", "layshaft", GROUND, mechanism.head.driver, mechanism.head.driven)
    errors = []
    for gear, target in zip(mechanism.gears, demanded, strict=True):
        ratio = Fraction(1)
        if gear.layshaft is not None and gear.mainshaft is not None:
            pair = Rolling("layshaft", "mainshaft", GROUND, gear.layshaft, gear.mainshaft)
            ratio = compute_speed_ratio(Train((head, pair)), "input", "mainshaft") or Fraction(0)
        elif not problem.direct or target != 1:
            return None
        if ratio != gear.ratio.exact:
            return None
        errors.append(ratio / target - 1)
    if mechanism.reverse is not None and problem.reverse is not None:
        back = mechanism.reverse
        pairs = (
            Rolling("layshaft", "idler", GROUND, back.layshaft, back.idler),
            Rolling("idler", "mainshaft", GROUND, back.idler, back.mainshaft),
        )
        ratio = compute_speed_ratio(Train((head, *pairs)), "input", "mainshaft") or Fraction(0)
        if ratio != back.ratio.exact or ratio >= 0:
            return None
        errors.append(-ratio / parse_decimal(problem.reverse) - 1)
    return errors


def _list_coaxial_pairs(mechanism: LayshaftMechanism) -> list[tuple[int, int]]:
    """List the pairs between input or main shaft and layshaft."""
    head = mechanism.head.driver, mechanism.head.driven
    return [head, *((g.layshaft, g.mainshaft) for g in mechanism.gears if g.layshaft and g.mainshaft)]


def _list_meshing_pairs(mechanism: LayshaftMechanism) -> list[tuple[int, int]]:
    back = mechanism.reverse
    idling = [] if back is None else [(back.layshaft, back.idler), (back.idler, back.mainshaft)]
    return [*_list_coaxial_pairs(mechanism), *idling]


def _is_reverse_feasible(mechanism: LayshaftMechanism) -> bool:
    """Return whether the reverse gears clear each other, and the idler's centre has a place for both meshes."""
    back = mechanism.reverse
    if back is None:
        return False
    apart = mechanism.centre_distance / mechanism.module
    one, other, idler = (0.5 * z for z in (back.layshaft, back.mainshaft, back.idler))
    passing = apart - (one + 1.0) - (other + 1.0) >= CLEARANCE_TOLERANCE
    # Distances of the idler's axis from the two shafts.
    reach = one + idler, idler + other
    # The triangle inequality of the three shaft axes.
    return passing and sum(reach) >= apart and abs(reach[0] - reach[1]) <= apart


def _build_mesh(mechanism: LayshaftMechanism, pair: tuple[int, int]) -> Mesh:
    return Mesh.standard(pair, mechanism.module, math.radians(mechanism.pressure_angle))


def _find_interfering(mechanism: LayshaftMechanism) -> list[tuple[int, int]]:
    return [pair for pair in _list_meshing_pairs(mechanism) if _build_mesh(mechanism, pair).interferes]
