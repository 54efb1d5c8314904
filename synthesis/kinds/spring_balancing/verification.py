"""Verification of springs: drive the answer over the grid, and compute its drive from all joint reactions.

Mechanism and block are read from the answer as ``POST /v1/analyses`` would read them, including springs, while the
programs computed the springs' share from lengths and their rates. If the balance is exact, the potential energy is
constant, a third route without any force.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.dynamics.balance import balance
from kinematics.dynamics.machine import Machine
from kinematics.dynamics.places import Places
from kinematics.dynamics.reactions import Reactions, reactions
from kinematics.dynamics.springs import Spring as MachineSpring
from kinematics.dynamics.springs import TorsionSpring
from synthesis.analyses.driven import paced, placed
from synthesis.kinds.spring_balancing.design import FoundEnd, FoundSpring, SpringMetrics, SprungDesign, SprungLinkage
from synthesis.kinds.spring_balancing.effects import GRID, Setting
from synthesis.kinds.spring_balancing.energy import has_potential, lengths, potential, tension
from synthesis.kinds.spring_balancing.found import Spring, listed
from synthesis.kinds.spring_balancing.problem import SpringBalancingProblem
from synthesis.kinds.spring_balancing.program import left_open, size_of
from synthesis.kinds.spring_balancing.stated_springs import SoughtSpring
from synthesis.mechanisms.link_bodies import BlockError
from synthesis.mechanisms.machine import machine_of
from synthesis.mechanisms.skeleton import GivenSkeleton, skeleton_of
from synthesis.model.answer import Check, Verification
from synthesis.model.dynamics import DynamicsBlock
from synthesis.model.linkage_answer import Skeleton
from synthesis.proof.checks import LIMIT_SLACK, at_least, at_most, tolerated

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

GAP = 5e-3
"""Maximum share of the value by which a proven bound may be below it; near an exact balance the solver's tolerance."""

AGREEMENT = 1e-6
"""Share of the peak by which two routes to the drive may differ."""

VANISHES = 1e-9
"""Share of the unbalanced drive, and of its energy variation, that counts as zero."""

ROUNDING = 1e-14
"""Share of the greatest part of the energy by which a sum of the parts may be off."""

KEPT = 1e-4
"""Share of a limit by which a spring may exceed it between the positions of the program."""

STILL = ("rate", "free_length", "preload")
"""Limits that do not depend on the position; these are kept to rounding."""

SLENDER = 4.0
"""Free length over diameter above which a compression spring buckles."""


class Held(NamedTuple):
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
    answer, block = answer_of(setting, springs)
    try:
        machine = machine_of_answer(problem, answer, block)
    except BlockError:
        return "degenerate"
    grid = task.positions(max(GRID, problem.motion.steps))
    before, after = (_held(setting, one, grid) for one in (task.machine, machine))
    if not after.known.any() or not np.array_equal(after.known, before.known):
        return "spring_without_direction"
    # The value is measured on the reactions, not taken from the program.
    first, last = size_of(before.drive, problem.norm), size_of(after.drive, problem.norm)
    peaks = [float(np.abs(one.drive).max()) for one in (before, after)]
    value = last / first
    exact = value <= VANISHES
    if exact:
        bound, proved = 0.0, True
    gap = None if bound is None else 0.0 if exact else (value - bound) / value
    off = max(float(np.abs(one.drive - one.check[one.known]).max()) for one in (before, after))
    varied = _variation(setting, machine, before, after, DynamicsBlock.model_validate(block))
    checks = [tolerated("routes_agree", off / max(peaks), AGREEMENT)]
    if bound is not None and not exact:
        checks.insert(0, at_least("bound", value, bound))
    if gap is not None and proved and not exact:
        checks.append(tolerated("gap", gap, left_open(value, GAP) / value))
    if exact and varied is not None:
        checks.append(tolerated("potential_energy", varied, VANISHES))
    built = machine.loads[len(machine.loads) - len(springs) :]
    told = [_told(setting, spring, load, after) for spring, load in zip(springs, built, strict=True)]
    checks += _present(problem, told)
    checks += _limits(problem, told)
    checks += _places(setting, springs)
    metrics = SpringMetrics(
        value=value,
        bound=bound,
        gap=gap,
        exact=exact,
        drive=peaks[1],
        unbalanced_drive=peaks[0],
        rms_drive=size_of(after.drive, "rms"),
        unbalanced_rms_drive=size_of(before.drive, "rms"),
        energy_variation=varied,
    )
    return SprungDesign(
        mechanism=answer,
        dynamics=block,
        springs=told,
        warnings=[*_gaps(before), *_warnings(problem, told)],
        verification=Verification.of(checks),
        metrics=metrics,
    )


def answer_of(setting: Setting, springs: Sequence[Spring]) -> tuple[SprungLinkage, dict[str, Any]]:
    """Build mechanism and block of an answer."""
    stated = setting.problem.dynamics.model_dump(mode="json", by_alias=True, exclude_defaults=True)
    block = {**stated, "springs": [*stated.get("springs", []), *listed(setting, springs)]}
    skeleton = Skeleton.model_validate(skeleton_of(setting.task.machine.mechanism))
    return SprungLinkage(skeleton=skeleton), block


def machine_of_answer(problem: SpringBalancingProblem, mechanism: SprungLinkage, block: dict[str, Any]) -> Machine:
    """Build the machine of an answer's mechanism and block, read like in an analysis.

    Raises
    ------
    BlockError
        For a spring without direction.
    """
    built = GivenSkeleton.model_validate(mechanism.model_dump()).mechanism()
    return machine_of(DynamicsBlock.model_validate(block), built, problem.length_unit)[0]


def _held(setting: Setting, machine: Machine, grid: Real) -> Held:
    now = placed(machine, grid, setting.task.speed, setting.task.acceleration)
    found = reactions(machine, now)
    check = balance(machine, now, paced(machine, grid), found.rubbing).drive
    return Held(np.asarray(found.solved & np.isfinite(check)), found, check, now)


def _variation(setting: Setting, machine: Machine, before: Held, after: Held, block: DynamicsBlock) -> float | None:
    """Measure the range of the potential energy as a share of the unbalanced one; None without one, or with gaps."""
    stated = setting.problem.dynamics
    if setting.task.speed != 0.0 or setting.task.acceleration != 0.0 or not has_potential(stated):
        return None
    if not before.known.all():
        return None
    first, _ = potential(setting.task.machine, stated, before.now)
    last, largest = potential(machine, block, after.now)
    varied = max(float(np.ptp(last)) - ROUNDING * largest, 0.0)
    return varied / float(np.ptp(first)) if np.ptp(first) > 0.0 else None


def _told(setting: Setting, spring: Spring, load: Any, after: Held) -> FoundSpring:
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
    length = lengths(load, after.now)[after.known]
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
        max_force=float(np.abs(tension(load, length)).max()),
    )


def _present(problem: SpringBalancingProblem, told: Sequence[FoundSpring]) -> list[Check]:
    """Check that no required spring is missing."""
    demanded = {n for n, spring in enumerate(problem.springs) if spring.demanded}
    missing = demanded - {spring.number for spring in told}
    return [tolerated("demanded_springs", float(len(missing)), 0.0)] if demanded else []


def _limits(problem: SpringBalancingProblem, told: Sequence[FoundSpring]) -> list[Check]:
    """Check every given limit, each by the largest share of it that a spring uses.

    Free angles may have either sign; the greatest excess over their limits is reported in radians.
    """
    shares: dict[str, list[float]] = {}
    outside_of: list[float] = []

    # A share above 1 exceeds the limit.
    def most(name: str, value: float | None, limit: float | None) -> None:
        if value is not None and limit is not None:
            shares.setdefault(name, []).append(value / limit if limit > 0.0 else np.inf if value > 0.0 else 0.0)

    def least(name: str, value: float | None, limit: float | None) -> None:
        if value is not None and limit:
            shares.setdefault(name, []).append(limit / value if value > 0.0 else np.inf)

    for spring in told:
        asked = problem.springs[spring.number]
        low, high = asked.rates
        least("rate", spring.rate if asked.links is None else spring.torsion, low)
        most("rate", spring.rate if asked.links is None else spring.torsion, high)
        # Torsion springs have angles and torques instead of lengths and forces.
        if asked.links is not None:
            assert spring.free_angle is not None
            lowest, highest = asked.free_angles
            outside_of.append(float(np.radians(max(lowest - spring.free_angle, spring.free_angle - highest, 0.0))))
            most("max_torque", spring.max_torque, asked.max_torque)
            continue
        if not asked.without_length:
            least("free_length", spring.free_length, asked.free_lengths[0])
            most("free_length", spring.free_length, asked.free_lengths[1])
            least("preload", spring.preload, asked.preloads[0])
            most("preload", spring.preload, asked.preloads[1])
        least("min_length", spring.min_length, asked.min_length)
        most("max_length", spring.max_length, asked.max_length)
        most("max_force", spring.max_force, asked.max_force)
        # Deflection counts in both directions from the free length.
        free = spring.free_length or 0.0
        longest, shortest = spring.max_length or 0.0, spring.min_length or 0.0
        most("max_deflection", max(longest - free, free - shortest), asked.max_deflection)
        # An extension spring must never be shorter than its free length.
        if asked.form == "extension" and free > 0.0:
            least("extension", shortest, free)
        # A compression spring must never be longer than its free length.
        if asked.form == "compression":
            most("compression", longest, free)
    checks = [
        at_most(name, max(listed_shares), 1.0, slack=LIMIT_SLACK if name in STILL else KEPT)
        for name, listed_shares in shares.items()
    ]
    return [*checks, tolerated("free_angle", max(outside_of), VANISHES)] if outside_of else checks


def _places(setting: Setting, springs: Sequence[Spring]) -> list[Check]:
    """Check the greatest distance of ends from their permitted areas, as a share of the linkage's size."""
    off = [
        outside(corners, end) / setting.size
        for spring in springs
        for corners, end in zip(setting.places(_asked(setting, spring)), spring.ends, strict=True)
        if len(corners) > 1
    ]
    return [tolerated("ends", max(off), VANISHES)] if off else []


def _asked(setting: Setting, spring: Spring) -> SoughtSpring:
    return setting.problem.springs[spring.number]


def outside(corners: Complex, place: complex) -> float:
    """Measure the distance of a place from the convex area of corners in counter-clockwise order, or from a line."""
    # Project the place onto each edge and keep within the edge.
    ways = np.roll(corners, -1) - corners
    reached = ((place - corners) * ways.conj()).real / np.abs(ways) ** 2
    nearest = corners + np.clip(reached, 0.0, 1.0) * ways
    # Inside if the place is to the left of every edge.
    inside = len(corners) > 2 and bool((((place - corners) * ways.conj()).imag >= 0.0).all())
    return 0.0 if inside else float(np.abs(place - nearest).min())


def _gaps(before: Held) -> list[str]:
    """Describe the positions at which the linkage cannot be held."""
    known, count = int(before.known.sum()), len(before.known)
    if known == count:
        return []
    return [f"motion: the drive is known at {known} of {count} positions; the others are not assessed"]


def _warnings(problem: SpringBalancingProblem, told: Sequence[FoundSpring]) -> list[str]:
    said = []
    for spring in told:
        diameter = problem.springs[spring.number].diameter
        if diameter is not None and (spring.free_length or 0.0) > SLENDER * diameter:
            slender = (spring.free_length or 0.0) / diameter
            said.append(f"springs/{spring.number}: {slender:.3g} times as long as wide; it buckles unless it is guided")
    return said
