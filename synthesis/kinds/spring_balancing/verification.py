"""The proof of springs: the answer driven over the grid, and its drive from the reactions of all joints.

Mechanism and block are read from the answer as ``POST /v1/analyses`` would read them, springs and all; the programs had
the springs' share from lengths and their rates. Where the balance is exact the potential energy is constant, a third
route without a force in it.
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
"""Share of the value that a proved bound may be below it; near an exact balance it is the solver's tolerance."""

AGREEMENT = 1e-6
"""Share of the peak by which two routes to the drive may differ."""

VANISHES = 1e-9
"""Drive, and variation of the potential energy, as a share of what they were, that is nothing."""

ROUNDING = 1e-14
"""Share of the greatest part of the energy that a sum of them may be off."""

KEPT = 1e-4
"""Share of a limit by which a spring may be beyond it between the positions that the program has looked at."""

STILL = ("rate", "free_length", "preload")
"""Limits of what a spring is at all positions; these are kept but for rounding."""

SLENDER = 4.0
"""Free length over diameter from which a compression spring buckles."""


class Held(NamedTuple):
    """A machine over the grid: where all is known, the reactions, the drive by energy, and the places."""

    known: NDArray[np.bool_]
    found: Reactions
    check: Real
    now: Places

    @property
    def drive(self) -> Real:
        """The drive of the reactions where it is known."""
        return np.asarray(self.found.drive[self.known])


def verify_springs(
    setting: Setting, springs: Sequence[Spring], bound: float | None, *, proved: bool
) -> SprungDesign | str:
    """A linkage with its springs, measured; the reason where no machine can be made of the answer.

    ``bound`` is what no springs go below, where that is known, and ``proved`` tells whether it is reached.
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
    """Mechanism and block of an answer."""
    stated = setting.problem.dynamics.model_dump(mode="json", by_alias=True, exclude_defaults=True)
    block = {**stated, "springs": [*stated.get("springs", []), *listed(setting, springs)]}
    skeleton = Skeleton.model_validate(skeleton_of(setting.task.machine.mechanism))
    return SprungLinkage(skeleton=skeleton), block


def machine_of_answer(problem: SpringBalancingProblem, mechanism: SprungLinkage, block: dict[str, Any]) -> Machine:
    """The machine that mechanism and block of an answer make, read as an analysis reads them.

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
    """The range of the potential energy over what it was; None where there is none, or the motion has gaps."""
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
    """A spring in the units of the answer, measured over the motion."""
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
    """How many of the springs that may not be left out are missing."""
    demanded = {n for n, spring in enumerate(problem.springs) if spring.demanded}
    missing = demanded - {spring.number for spring in told}
    return [tolerated("demanded_springs", float(len(missing)), 0.0)] if demanded else []


def _limits(problem: SpringBalancingProblem, told: Sequence[FoundSpring]) -> list[Check]:
    """Every sort of limit that is stated, each as the largest share of it that a spring takes.

    Free angles may be of either sign; how far the farthest is outside of its limits is told in radians.
    """
    shares: dict[str, list[float]] = {}
    outside_of: list[float] = []

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
        free = spring.free_length or 0.0
        longest, shortest = spring.max_length or 0.0, spring.min_length or 0.0
        most("max_deflection", max(longest - free, free - shortest), asked.max_deflection)
        if asked.form == "extension" and free > 0.0:
            least("extension", shortest, free)
        if asked.form == "compression":
            most("compression", longest, free)
    checks = [
        at_most(name, max(listed_shares), 1.0, slack=LIMIT_SLACK if name in STILL else KEPT)
        for name, listed_shares in shares.items()
    ]
    return [*checks, tolerated("free_angle", max(outside_of), VANISHES)] if outside_of else checks


def _places(setting: Setting, springs: Sequence[Spring]) -> list[Check]:
    """How far ends are outside of where they may be, as a share of the linkage's size."""
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
    """How far a place is outside of the convex area between corners in order, counter-clockwise; of a line, from it."""
    ways = np.roll(corners, -1) - corners
    reached = ((place - corners) * ways.conj()).real / np.abs(ways) ** 2
    nearest = corners + np.clip(reached, 0.0, 1.0) * ways
    inside = len(corners) > 2 and bool((((place - corners) * ways.conj()).imag >= 0.0).all())
    return 0.0 if inside else float(np.abs(place - nearest).min())


def _gaps(before: Held) -> list[str]:
    """Where the linkage cannot be held."""
    known, count = int(before.known.sum()), len(before.known)
    if known == count:
        return []
    return [f"motion: the drive is known at {known} of {count} positions; at the others nothing is said"]


def _warnings(problem: SpringBalancingProblem, told: Sequence[FoundSpring]) -> list[str]:
    said = []
    for spring in told:
        diameter = problem.springs[spring.number].diameter
        if diameter is not None and (spring.free_length or 0.0) > SLENDER * diameter:
            slender = (spring.free_length or 0.0) / diameter
            said.append(f"springs/{spring.number}: {slender:.3g} times as long as wide; guide it, or it buckles")
    return said
