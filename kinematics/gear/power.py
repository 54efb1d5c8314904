"""Torque and power in any gear train with losses at its meshes; self-locking and circulating power.

Each mesh has one unknown tooth force. Every body is in equilibrium, planets without external torque, and a mesh loses a
share of the power that it transmits *relative to its carrier*: seen from there its axes are fixed, and it is an
ordinary pair with the efficiency η of one (Radzimovsky 1956, doi:10.1115/1.4014457; Norton,
Sec. 9.11). With the speed equation N1 (ω1 − ωc) = σ N2 (ω2 − ωc) of a mesh and its force λ, the torques of the mesh on
its bodies are::

    on the first gear   λ N1
    on the second       −λ σ N2 e       e = η where the first gear drives the second, 1/η where it is driven
    on the carrier      −λ (N1 − σ N2 e)

Which gear drives depends on the sign of λ, so directions are tried until they agree with the resulting forces. A train
is self-locking if the desired direction of power requires power from the other side as well.

Power circulates if a member between two rows carries more than the input power. Likewise a mesh may transmit more than
the input power relative to its carrier (rolling power). Both cause losses; the second explains why trains with a train
value near 1 have huge ratios and very low efficiencies.
"""

from __future__ import annotations

import itertools
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction

from kinematics.errors import DimensionError
from kinematics.gear.elimination import Elimination
from kinematics.gear.planetary import GROUND, Mesh, Train

Exact = Fraction | int


@dataclass(frozen=True)
class MeshLoad:
    """Load of one mesh: torques on its gears and carrier, power relative to the carrier, and power lost.

    ``rolling_power`` is positive where the first gear drives the second.
    """

    first_torque: Fraction
    second_torque: Fraction
    carrier_torque: Fraction
    rolling_power: Fraction
    loss: Fraction


@dataclass(frozen=True)
class PowerFlow:
    """Torques and powers of a train at given speeds.

    Attributes
    ----------
    torques : dict
        Torque from outside on every member; planets have none.
    powers : dict
        Torque × speed, positive where power enters. Together with the losses they sum to 0.
    meshes : tuple of MeshLoad
        Loads in the order of the train's meshes.
    input_power, output_power : Fraction
        Sums of the entering and the leaving powers.
    efficiency : Fraction or None
        Output over input power; None if no power flows.
    self_locking : bool
        No power leaves although some enters: the train does not move in this direction. The torques are then those
        that would keep it moving.
    largest_rolling_power : Fraction
        Maximum power that a mesh transmits relative to its carrier, as a share of the input.
    largest_branch_power : Fraction
        Maximum power that a row of meshes exchanges with one member, as a share of the input.
    """

    torques: dict[str, Fraction]
    powers: dict[str, Fraction]
    meshes: tuple[MeshLoad, ...]
    input_power: Fraction
    output_power: Fraction
    efficiency: Fraction | None
    self_locking: bool
    largest_rolling_power: Fraction
    largest_branch_power: Fraction

    @property
    def circulates(self) -> bool:
        """Whether a member between rows carries more than the input power."""
        return self.largest_branch_power > 1


def solve_power_flow(
    train: Train,
    speeds: Mapping[str, Exact],
    loads: Collection[str],
    known: Mapping[str, Exact],
    efficiency: Exact | Sequence[Exact] = 1,
) -> PowerFlow | None:
    """Solve for the torques of a train in equilibrium at given speeds.

    Parameters
    ----------
    train : Train
        The meshes.
    speeds : mapping
        Speed of every body, see :func:`kinematics.gear.planetary.solve_speeds`.
    loads : collection of str
        Members with external torque (fixed, driven or braked); all other bodies turn freely.
    known : mapping
        Known external torques by member; all members are among ``loads``.
    efficiency : Fraction or sequence of Fraction
        Efficiency of each mesh as an ordinary pair, in (0, 1]: one for all, or one per mesh.

    Returns
    -------
    PowerFlow or None
        None if the known torques do not determine the others, or contradict each other.

    Raises
    ------
    DimensionError
        For an efficiency outside (0, 1], a speed that is missing, or a load on a planet.

    Examples
    --------
    Rao, Solved Problem 8.10: stepped planet, annulus held, 100 N m on the carrier.

    >>> from kinematics.gear.planetary import INTERNAL, Train, Mesh, solve_speeds
    >>> train = Train((Mesh("A", "p", "C", 52, 15), Mesh("p", "B", "C", 25, 92, INTERNAL)), frozenset({"p"}))
    >>> found = solve_speeds(train, {"C": 200, "B": 0}).values
    >>> round(float(solve_power_flow(train, found, {"A", "B", "C"}, {"C": 100}).torques["A"]), 1)
    -48.5
    """
    shares = _check_efficiencies(train, efficiency)
    turning = {**{body: _get_known_speed(body, speeds) for body in train.bodies}, GROUND: Fraction(0)}
    for body in (*loads, *known):
        if body not in train.bodies or body in train.planets:
            raise DimensionError("load", "kinematics-load-on-member", body, members=", ".join(train.members))
    relative = [turning[mesh.first] - turning[mesh.carrier] for mesh in train.meshes]
    # Without losses first: it defines the input power and the likely directions.
    ideal = _balance_bodies(train, loads, known, [Fraction(1)] * len(shares))
    if ideal is None:
        return None
    settled = _find_consistent_balance(train, loads, known, shares, relative, ideal[0])
    without_loss = _build_flow(train, turning, relative, *ideal, [Fraction(1)] * len(shares))
    flow = _build_flow(train, turning, relative, *(settled[0] or ideal), settled[1])
    # Reference of the shares, since losses would blur a circulating power.
    put_in = without_loss.input_power
    # Power enters without losses, but none leaves with them.
    locked = put_in > 0 and (settled[0] is None or flow.output_power <= 0)
    return PowerFlow(
        flow.torques,
        flow.powers,
        flow.meshes,
        flow.input_power,
        flow.output_power,
        Fraction(0) if locked else flow.output_power / flow.input_power if flow.input_power else None,
        locked,
        max((abs(mesh.rolling_power) for mesh in without_loss.meshes), default=Fraction(0)) / (put_in or 1),
        _find_branch_power(train, turning, without_loss.meshes) / (put_in or 1),
    )


def _check_efficiencies(train: Train, efficiency: Exact | Sequence[Exact]) -> list[Fraction]:
    each = list(efficiency) if isinstance(efficiency, Sequence) else [efficiency] * len(train.meshes)
    if len(each) != len(train.meshes):
        raise DimensionError("efficiency", "kinematics-efficiency-of-meshes", len(each), count=len(train.meshes))
    for share in each:
        if not 0 < share <= 1:
            raise DimensionError("efficiency", "kinematics-above-0-to-1", share)
    return [Fraction(share) for share in each]


def _get_known_speed(body: str, speeds: Mapping[str, Exact]) -> Fraction:
    if speeds.get(body) is None:
        raise DimensionError("speeds", "kinematics-known-for-every-body", body)
    return Fraction(speeds[body])


def _compute_torques(mesh: Mesh, share: Fraction) -> tuple[Fraction, Fraction, Fraction]:
    """Compute the torques of a mesh on first gear, second gear and carrier per unit force."""
    first, second = Fraction(mesh.first_teeth), share * -mesh.sense * mesh.second_teeth
    return first, second, -first - second


def _balance_bodies(
    train: Train, loads: Collection[str], known: Mapping[str, Exact], shares: list[Fraction]
) -> tuple[list[Fraction], dict[str, Fraction]] | None:
    """Solve for mesh forces and load torques from the equilibrium of every body."""
    meshes = [f"force {k}" for k in range(len(train.meshes))]
    system = Elimination((*meshes, *(f"torque {body}" for body in loads)))
    rows: dict[str, dict[str, Fraction]] = {body: {} for body in train.bodies}
    for name, mesh, share in zip(meshes, train.meshes, shares, strict=True):
        for body, torque in zip((mesh.first, mesh.second, mesh.carrier), _compute_torques(mesh, share), strict=True):
            if body != GROUND:
                rows[body][name] = torque
    for body, row in rows.items():
        if body in loads:
            row[f"torque {body}"] = Fraction(1)
        # A contradiction: the known torques are incompatible.
        if not system.add(row, Fraction(0)):
            return None
    for body, stated in known.items():
        if not system.add({f"torque {body}": Fraction(1)}, Fraction(stated)):
            return None
    solution = system.values()
    forces = [solution[name] for name in meshes]
    torques = {body: solution[f"torque {body}"] for body in loads}
    if any(value is None for value in (*forces, *torques.values())):
        return None
    return [f for f in forces if f is not None], {body: t for body, t in torques.items() if t is not None}


def _find_consistent_balance(
    train: Train,
    loads: Collection[str],
    known: Mapping[str, Exact],
    shares: list[Fraction],
    relative: list[Fraction],
    forces: list[Fraction],
) -> tuple[tuple[list[Fraction], dict[str, Fraction]] | None, list[Fraction]]:
    """Find the balance whose directions of power agree with its forces; None if there is none.

    The directions without loss are tried first: with small losses they are correct.
    """

    def apply_losses(driving: Sequence[bool]) -> list[Fraction]:
        return [share if first else 1 / share for share, first in zip(shares, driving, strict=True)]

    def find_directions(forces: list[Fraction]) -> tuple[bool, ...]:
        # Power into a gear, relative to the carrier, is minus the mesh's power on it.
        return tuple(-force * rate > 0 for force, rate in zip(forces, relative, strict=True))

    first = find_directions(forces)
    # Meshes without relative motion or without loss have no direction to decide.
    idle = [not rate or share == 1 for rate, share in zip(relative, shares, strict=True)]
    shares = [Fraction(1) if still else share for still, share in zip(idle, shares, strict=True)]
    others = itertools.product(*([a] if still else [a, not a] for a, still in zip(first, idle, strict=True)))
    for driving in others:
        found = _balance_bodies(train, loads, known, apply_losses(driving))
        if found is not None and all(
            still or not force or a == b
            for a, b, still, force in zip(driving, find_directions(found[0]), idle, found[0], strict=True)
        ):
            return found, apply_losses(driving)
    return None, [Fraction(1)] * len(shares)


def _build_flow(
    train: Train,
    turning: Mapping[str, Fraction],
    relative: list[Fraction],
    forces: list[Fraction],
    torques: dict[str, Fraction],
    shares: list[Fraction],
) -> PowerFlow:
    """Build the power flow from the tooth forces and torques; its efficiency and shares are left open."""
    loads = []
    for mesh, force, rate, share in zip(train.meshes, forces, relative, shares, strict=True):
        first, second, carrier = (force * torque for torque in _compute_torques(mesh, share))
        # Relative to the carrier the second gear turns σ N1/N2 times as fast as the first one.
        loss = -first * rate - second * rate * Fraction(mesh.sense * mesh.first_teeth, mesh.second_teeth)
        loads.append(MeshLoad(first, second, carrier, -first * rate, loss))
    every = {body: torques.get(body, Fraction(0)) for body in train.members}
    powers = {body: torque * turning[body] for body, torque in every.items()}
    put_in = sum((p for p in powers.values() if p > 0), Fraction(0))
    put_out = -sum((p for p in powers.values() if p < 0), Fraction(0))
    return PowerFlow(every, powers, tuple(loads), put_in, put_out, None, False, Fraction(0), Fraction(0))


def _find_branch_power(train: Train, turning: Mapping[str, Fraction], loads: Sequence[MeshLoad]) -> Fraction:
    """Find the maximum power between a row and a member; a row consists of meshes connected by planets."""
    row_of: dict[str, int] = {}
    rows: list[dict[str, Fraction]] = []
    for mesh, load in zip(train.meshes, loads, strict=True):
        planets = [body for body in (mesh.first, mesh.second) if body in train.planets]
        # Meshes that share a planet form one row; merge rows that this mesh connects.
        joined = sorted({row_of[body] for body in planets if body in row_of})
        target = joined[0] if joined else len(rows)
        if not joined:
            rows.append({})
        for other in joined[1:]:
            for body, torque in rows[other].items():
                rows[target][body] = rows[target].get(body, Fraction(0)) + torque
            rows[other] = {}
            row_of.update({body: target for body, row in row_of.items() if row == other})
        row_of.update(dict.fromkeys(planets, target))
        shared = (load.first_torque, load.second_torque, load.carrier_torque)
        for body, torque in zip((mesh.first, mesh.second, mesh.carrier), shared, strict=True):
            if body not in train.planets and body != GROUND:
                rows[target][body] = rows[target].get(body, Fraction(0)) + torque
    return max((abs(torque * turning[body]) for row in rows for body, torque in row.items()), default=Fraction(0))
