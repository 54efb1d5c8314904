"""Verification of springs: drive the answer over the grid, and compute its drive from all joint reactions.

Mechanism and block are read from the answer as ``POST /v1/analyses`` would read them, including springs, while the
programs computed the springs' share from lengths and their rates. If the balance is exact, the potential energy is
constant, which is a third check without any forces.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex, Real
from kinematics.dynamics.balance import compute_balance
from kinematics.dynamics.loads import Load
from kinematics.dynamics.machine import Machine
from kinematics.dynamics.places import Places
from kinematics.dynamics.reactions import Reactions, compute_reactions
from kinematics.dynamics.springs import Spring as MachineSpring
from kinematics.dynamics.springs import TorsionSpring
from kinematics.message import compose
from synthesis.analyses.linkages.requested_motion import pace_machine, place_machine
from synthesis.kinds.spring_balancing.design import FoundEnd, FoundSpring, SpringMetrics, SprungDesign, SprungLinkage
from synthesis.kinds.spring_balancing.effects import GRID_SIZE, Setting
from synthesis.kinds.spring_balancing.energy import compute_lengths, compute_potential, compute_tension, has_potential
from synthesis.kinds.spring_balancing.problem import SpringBalancingProblem
from synthesis.kinds.spring_balancing.program import compute_gap_tolerance, compute_norm
from synthesis.kinds.spring_balancing.requested_springs import SoughtSpring
from synthesis.kinds.spring_balancing.spring_parameters import Spring, list_blocks
from synthesis.mechanisms.link_bodies import BlockError
from synthesis.mechanisms.machine import build_machine
from synthesis.mechanisms.skeleton import GivenSkeleton, describe_skeleton
from synthesis.model.answer import Check, Verification
from synthesis.model.dynamics.request import DynamicsBlock
from synthesis.model.json_object import JsonObject
from synthesis.model.linkage.answer import Skeleton
from synthesis.verification.checks import LIMIT_SLACK, check_error, check_maximum, check_minimum

GAP_TOLERANCE = 5e-3
"""Maximum share of the value by which a proven bound may be below it; near an exact balance the solver's tolerance."""

ROUTE_TOLERANCE = 1e-6
"""Share of the peak by which two routes to the drive may differ."""

ZERO_TOLERANCE = 1e-9
"""Share of the unbalanced drive, and of its energy variation, that counts as zero."""

ROUNDING_TOLERANCE = 1e-14
"""Rounding error of a sum of energies, as a share of its largest part."""

LIMIT_TOLERANCE = 1e-4
"""Share of a limit by which a spring may exceed it between the positions of the program."""

EXACT_LIMITS = ("rate", "free_length", "preload")
"""Limits that do not depend on the position; these are kept to rounding."""

MAX_SLENDERNESS = 4.0
"""Free length over diameter above which a compression spring buckles."""


class DrivenMachine(NamedTuple):
    """A machine over the grid: the known positions, the reactions, the drive by energy, and the places."""

    known: NDArray[np.bool_]
    found: Reactions
    check: Real
    now: Places

    @property
    def drive(self) -> Real:
        """The drive from the reactions at the known positions."""
        return np.asarray(self.found.drive[self.known])


def verify_springs(
    setting: Setting, springs: Sequence[Spring], bound: float | None, *, proved: bool
) -> SprungDesign | str:
    """Measure a linkage with its springs; return the reason if no machine can be built from the answer.

    ``bound`` is the lower bound for all springs, if known, and ``proved`` is true if it is reached.
    """
    problem, task = setting.problem, setting.task
    answer, block = build_answer(setting, springs)
    try:
        machine = build_answer_machine(problem, answer, block)
    except BlockError:
        return "degenerate"
    grid = task.list_positions(max(GRID_SIZE, problem.motion.steps))
    before, after = (_drive_machine(setting, one, grid) for one in (task.machine, machine))
    if not after.known.any() or not np.array_equal(after.known, before.known):
        return "spring_without_direction"
    # The value is measured on the reactions, not taken from the program.
    first, last = compute_norm(before.drive, problem.norm), compute_norm(after.drive, problem.norm)
    peaks = [float(np.abs(one.drive).max()) for one in (before, after)]
    value = last / first
    exact = value <= ZERO_TOLERANCE
    if exact:
        bound, proved = 0.0, True
    gap = None if bound is None else 0.0 if exact else (value - bound) / value
    off = max(float(np.abs(one.drive - one.check[one.known]).max()) for one in (before, after))
    varied = _measure_variation(setting, machine, before, after, DynamicsBlock.model_validate(block))
    checks = [check_error("routes_agree", off / max(peaks), ROUTE_TOLERANCE)]
    if bound is not None and not exact:
        checks.insert(0, check_minimum("bound", value, bound))
    if gap is not None and proved and not exact:
        checks.append(check_error("gap", gap, compute_gap_tolerance(value, GAP_TOLERANCE) / value))
    if exact and varied is not None:
        checks.append(check_error("potential_energy", varied, ZERO_TOLERANCE))
    built = machine.loads[len(machine.loads) - len(springs) :]
    found_springs = [
        _describe_spring(setting, spring, load, after) for spring, load in zip(springs, built, strict=True)
    ]
    checks += _check_presence(problem, found_springs)
    checks += _check_limits(problem, found_springs)
    checks += _check_places(setting, springs)
    metrics = SpringMetrics(
        value=value,
        bound=bound,
        gap=gap,
        exact=exact,
        drive=peaks[1],
        unbalanced_drive=peaks[0],
        rms_drive=compute_norm(after.drive, "rms"),
        unbalanced_rms_drive=compute_norm(before.drive, "rms"),
        energy_variation=varied,
    )
    return SprungDesign(
        mechanism=answer,
        dynamics=block,
        springs=found_springs,
        warnings=[*_describe_gaps(before), *_list_warnings(problem, found_springs)],
        verification=Verification.from_checks(checks),
        metrics=metrics,
    )


def build_answer(setting: Setting, springs: Sequence[Spring]) -> tuple[SprungLinkage, JsonObject]:
    """Build mechanism and block of an answer."""
    stated = setting.problem.dynamics.model_dump(mode="json", by_alias=True, exclude_defaults=True)
    block = {**stated, "springs": [*stated.get("springs", []), *list_blocks(setting, springs)]}
    skeleton = Skeleton.model_validate(describe_skeleton(setting.task.machine.mechanism))
    return SprungLinkage(skeleton=skeleton), block


def build_answer_machine(problem: SpringBalancingProblem, mechanism: SprungLinkage, block: JsonObject) -> Machine:
    """Build the machine of an answer's mechanism and block, read like in an analysis.

    Raises
    ------
    BlockError
        For a spring without direction.
    """
    built = GivenSkeleton.model_validate(mechanism.model_dump()).build_mechanism()
    return build_machine(DynamicsBlock.model_validate(block), built, problem.length_unit)[0]


def _drive_machine(setting: Setting, machine: Machine, grid: Real) -> DrivenMachine:
    now = place_machine(machine, grid, setting.task.speed, setting.task.acceleration)
    found = compute_reactions(machine, now)
    check = compute_balance(machine, now, pace_machine(machine, grid), found.rubbing).drive
    return DrivenMachine(np.asarray(found.solved & np.isfinite(check)), found, check, now)


def _measure_variation(
    setting: Setting, machine: Machine, before: DrivenMachine, after: DrivenMachine, block: DynamicsBlock
) -> float | None:
    """Measure the range of the potential energy as a share of the unbalanced one; None without one, or with gaps."""
    stated = setting.problem.dynamics
    if setting.task.speed != 0.0 or setting.task.acceleration != 0.0 or not has_potential(stated):
        return None
    if not before.known.all():
        return None
    first, _ = compute_potential(setting.task.machine, stated, before.now)
    last, largest = compute_potential(machine, block, after.now)
    varied = max(float(np.ptp(last)) - ROUNDING_TOLERANCE * largest, 0.0)
    return varied / float(np.ptp(first)) if np.ptp(first) > 0.0 else None


def _describe_spring(setting: Setting, spring: Spring, load: Load, after: DrivenMachine) -> FoundSpring:
    """Describe a spring in the units of the answer, measured over the motion."""
    scale, stated = setting.task.machine.scale, setting.problem.springs[spring.number]
    if isinstance(load, TorsionSpring):
        torque = load.rate * (load.rotation(after.now)[after.known] - load.free)
        return FoundSpring(
            number=spring.number,
            links=load.links,
            torsion=load.rate,
            free_angle=float(np.degrees(load.free)),
            max_torque=float(np.abs(torque).max()),
        )
    assert isinstance(load, MachineSpring)
    assert stated.ends is not None
    length = compute_lengths(load, after.now)[after.known]
    points = [complex(at) / scale for at in load.places]
    one, other = (FoundEnd(link=link, point=(z.real, z.imag)) for link, z in zip(load.links, points, strict=True))
    return FoundSpring(
        number=spring.number,
        ends=(one, other),
        rate=load.rate,
        free_length=load.free_length / scale,
        preload=load.preload,
        min_length=float(length.min()) / scale,
        max_length=float(length.max()) / scale,
        max_force=float(np.abs(compute_tension(load, length)).max()),
    )


def _check_presence(problem: SpringBalancingProblem, springs: Sequence[FoundSpring]) -> list[Check]:
    """Check that no required spring is missing."""
    demanded = {n for n, spring in enumerate(problem.springs) if spring.is_required}
    missing = demanded - {spring.number for spring in springs}
    return [check_error("demanded_springs", float(len(missing)), 0.0)] if demanded else []


def _check_limits(problem: SpringBalancingProblem, springs: Sequence[FoundSpring]) -> list[Check]:
    """Check every given limit, each by the largest share of it that a spring uses.

    Free angles may have either sign; the maximum excess over their limits is reported in radians.
    """
    shares: dict[str, list[float]] = {}
    outside_of: list[float] = []

    # A share above 1 exceeds the limit.
    def add_maximum(name: str, value: float | None, limit: float | None) -> None:
        if value is not None and limit is not None:
            shares.setdefault(name, []).append(value / limit if limit > 0.0 else np.inf if value > 0.0 else 0.0)

    def add_minimum(name: str, value: float | None, limit: float | None) -> None:
        if value is not None and limit:
            shares.setdefault(name, []).append(limit / value if value > 0.0 else np.inf)

    for spring in springs:
        request = problem.springs[spring.number]
        low, high = request.rates
        add_minimum("rate", spring.rate if request.links is None else spring.torsion, low)
        add_maximum("rate", spring.rate if request.links is None else spring.torsion, high)
        # Torsion springs have angles and torques instead of lengths and forces.
        if request.links is not None:
            assert spring.free_angle is not None
            lowest, highest = request.free_angles
            outside_of.append(float(np.radians(max(lowest - spring.free_angle, spring.free_angle - highest, 0.0))))
            add_maximum("max_torque", spring.max_torque, request.max_torque)
            continue
        if not request.without_length:
            add_minimum("free_length", spring.free_length, request.free_lengths[0])
            add_maximum("free_length", spring.free_length, request.free_lengths[1])
            add_minimum("preload", spring.preload, request.preloads[0])
            add_maximum("preload", spring.preload, request.preloads[1])
        add_minimum("min_length", spring.min_length, request.min_length)
        add_maximum("max_length", spring.max_length, request.max_length)
        add_maximum("max_force", spring.max_force, request.max_force)
        # Deflection counts in both directions from the free length.
        free = spring.free_length or 0.0
        longest, shortest = spring.max_length or 0.0, spring.min_length or 0.0
        add_maximum("max_deflection", max(longest - free, free - shortest), request.max_deflection)
        # An extension spring must never be shorter than its free length.
        if request.form == "extension" and free > 0.0:
            add_minimum("extension", shortest, free)
        # A compression spring must never be longer than its free length.
        if request.form == "compression":
            add_maximum("compression", longest, free)
    checks = [
        check_maximum(name, max(listed_shares), 1.0, slack=LIMIT_SLACK if name in EXACT_LIMITS else LIMIT_TOLERANCE)
        for name, listed_shares in shares.items()
    ]
    return [*checks, check_error("free_angle", max(outside_of), ZERO_TOLERANCE)] if outside_of else checks


def _check_places(setting: Setting, springs: Sequence[Spring]) -> list[Check]:
    """Check the maximum distance of ends from their permitted areas, as a share of the linkage's size."""
    off = [
        measure_outside(corners, end) / setting.size
        for spring in springs
        for corners, end in zip(setting.list_corners(_find_request(setting, spring)), spring.ends, strict=True)
        if len(corners) > 1
    ]
    return [check_error("ends", max(off), ZERO_TOLERANCE)] if off else []


def _find_request(setting: Setting, spring: Spring) -> SoughtSpring:
    return setting.problem.springs[spring.number]


def measure_outside(corners: Complex, place: complex) -> float:
    """Measure the distance of a place from the convex area of corners in counter-clockwise order, or from a line."""
    # Project the place onto each edge and keep within the edge.
    ways = np.roll(corners, -1) - corners
    reached = ((place - corners) * ways.conj()).real / np.abs(ways) ** 2
    nearest = corners + np.clip(reached, 0.0, 1.0) * ways
    # Inside if the place is to the left of every edge.
    inside = len(corners) > 2 and bool((((place - corners) * ways.conj()).imag >= 0.0).all())
    return 0.0 if inside else float(np.abs(place - nearest).min())


def _describe_gaps(before: DrivenMachine) -> list[str]:
    """Describe the positions at which the linkage cannot be held."""
    known, count = int(before.known.sum()), len(before.known)
    if known == count:
        return []
    return [compose("spring_balancing-positions-not-held", known=known, count=count)]


def _list_warnings(problem: SpringBalancingProblem, springs: Sequence[FoundSpring]) -> list[str]:
    warnings = []
    for spring in springs:
        diameter = problem.springs[spring.number].diameter
        if diameter is not None and (spring.free_length or 0.0) > MAX_SLENDERNESS * diameter:
            slender = (spring.free_length or 0.0) / diameter
            warnings.append(
                compose("spring_balancing-spring-buckles", number=spring.number, slenderness=f"{slender:.3g}")
            )
    return warnings
