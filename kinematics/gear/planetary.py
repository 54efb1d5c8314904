"""Speeds of any gear train, with fixed or revolving axes: one linear equation per mesh, solved exactly.

Relative to the body that holds both axes, the carrier c, two meshing gears roll on each other (Willis 1841; Norton,
Sec. 9.8)::

    N1 (ω1 − ωc) = σ N2 (ω2 − ωc)        σ = −1 external, +1 internal mesh

Glossary:

body      parts that turn as one piece: a shaft with all its gears, a carrier, a ring;
carrier   the body that holds the axes of a mesh; :data:`GROUND` for fixed axes;
planet    a body whose axis revolves with its carrier; it cannot be fixed or driven from outside;
member    a body about the train's own axis, which can be input, output or fixed;
freedom   number of speeds that can be chosen before all others follow.

Suns, rings, simple and stepped planets, several rows that share members, ordinary gears and differentials are rows of
the same list; no arrangement has formulas of its own. Bevel gears fit in: a planet's speed is then about its own axis,
and the two sides of a differential mesh it with opposite σ.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from fractions import Fraction

from kinematics.errors import DimensionError
from kinematics.gear.elimination import Elimination

GROUND = "ground"
"""The body that never turns."""

EXTERNAL, INTERNAL = -1, 1
"""Sense σ of a mesh: seen from their carrier the gears turn in opposite (−1) or equal (+1) directions."""


@dataclass(frozen=True)
class Mesh:
    """Two gears in mesh: the bodies that they sit on, the carrier of their axes, their teeth and the sense σ.

    Only the quotient of the tooth numbers matters for speeds, so a row known only by its train value is a mesh of two
    numbers with that quotient.

    Raises
    ------
    DimensionError
        For tooth numbers below 1, a sense other than ±1, or bodies that are not three different ones.
    """

    first: str
    second: str
    carrier: str
    first_teeth: int
    second_teeth: int
    sense: int = EXTERNAL

    def __post_init__(self) -> None:
        for name, teeth in (("first_teeth", self.first_teeth), ("second_teeth", self.second_teeth)):
            if teeth < 1:
                raise DimensionError(name, "kinematics-count-at-least", teeth, least=1)
        if self.sense not in (EXTERNAL, INTERNAL):
            raise DimensionError("sense", "kinematics-sign", self.sense)
        bodies = (self.first, self.second, self.carrier)
        # With two equal bodies the equation would degenerate to a lock.
        if len(set(bodies)) != 3:
            raise DimensionError("kinematics-bodies-of-mesh", "kinematics-three-different-bodies", bodies)

    def build_equation(self) -> dict[str, int]:
        """Build the coefficients, by body, of the speed equation; its right side is 0."""
        # N1 ω1 − σ N2 ω2 − (N1 − σ N2) ωc = 0.
        first, second = self.first_teeth, -self.sense * self.second_teeth
        return {self.first: first, self.second: second, self.carrier: -first - second}


@dataclass(frozen=True)
class Train:
    """A train: its meshes, and those of its bodies that are planets."""

    meshes: tuple[Mesh, ...]
    planets: frozenset[str] = frozenset()

    @property
    def bodies(self) -> tuple[str, ...]:
        """All bodies except the ground, in the order in which the meshes name them."""
        named = dict.fromkeys(body for mesh in self.meshes for body in (mesh.first, mesh.second, mesh.carrier))
        return tuple(body for body in named if body != GROUND)

    @property
    def members(self) -> tuple[str, ...]:
        """The bodies that are not planets."""
        return tuple(body for body in self.bodies if body not in self.planets)


@dataclass(frozen=True)
class Speeds:
    """Solution of the speed equations.

    Attributes
    ----------
    values : dict
        Speed of every body in the unit of the known ones; None if it does not follow from them.
    freedom : int
        Degrees of freedom of the train, locks included; 0 if it cannot turn at all.
    open : int
        Number of speeds that can still be chosen.
    contradiction : str or None
        The first known speed, in the order given, that contradicts the train and the earlier ones. ``values`` ignores
        it.
    """

    values: dict[str, Fraction | None]
    freedom: int
    open: int
    contradiction: str | None


def solve_speeds(train: Train, known: Mapping[str, Fraction | int], locked: Iterable[tuple[str, str]] = ()) -> Speeds:
    """Solve for the speeds of all bodies from some of them, as exact fractions.

    Parameters
    ----------
    train : Train
        The meshes.
    known : mapping
        Speeds by body, 0 for a fixed body; any number of them.
    locked : iterable of pairs
        Bodies that a clutch joins: they turn together.

    Returns
    -------
    Speeds
        With ``open > 0`` if too few speeds are known, and ``contradiction`` set if they disagree.

    Raises
    ------
    DimensionError
        For a body that the train does not have.

    Examples
    --------
    Norton, Example 9-5: sun 40, planet 20, ring 80; arm at −200 rpm, sun at −100 rpm.

    >>> train = Train((Mesh("sun", "planet", "arm", 40, 20), Mesh("planet", "ring", "arm", 20, 80, INTERNAL)))
    >>> solve_speeds(train, {"arm": -200, "sun": -100}).values["ring"]
    Fraction(-250, 1)
    """
    bodies = train.bodies
    system = Elimination(bodies)
    pairs = list(locked)
    for body in [*known, *(body for pair in pairs for body in pair)]:
        if body not in bodies and body != GROUND:
            raise DimensionError("body", "kinematics-body-of-train", body, bodies=", ".join(bodies))
    for mesh in train.meshes:
        system.add({body: Fraction(c) for body, c in mesh.build_equation().items() if body != GROUND}, Fraction(0))
    for first, second in pairs:
        locking = {first: Fraction(1), second: Fraction(-1)}
        system.add({body: c for body, c in locking.items() if body != GROUND}, Fraction(0))
    # Before the known speeds are added: the rank counts meshes and locks only.
    freedom = len(bodies) - system.rank
    contradiction = None
    for body, speed in known.items():
        own = {body: Fraction(1)} if body != GROUND else {}
        # Later speeds are still used, so that as much as possible is determined.
        if not system.add(own, Fraction(speed)) and contradiction is None:
            contradiction = body
    return Speeds(system.values(), freedom, len(bodies) - system.rank, contradiction)


def compute_speed_ratio(train: Train, driver: str, driven: str, held: Iterable[str] = ()) -> Fraction | None:
    """Compute the speed of the driver over that of the driven body, with other bodies fixed.

    Return None if the driven body stands still or is free, or the train is locked.
    """
    # The equations are linear: unit speed of the driver gives the ratio.
    solution = solve_speeds(train, {**dict.fromkeys(held, 0), driver: 1})
    driven_speed = solution.values[driven]
    if solution.contradiction is not None or not driven_speed:
        return None
    return 1 / driven_speed
