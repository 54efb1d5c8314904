"""Topologies of sixbars that contain a chain of three links: types, links, and indices of joints in the kernel."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex, Real
from synthesis.kinds.motion.sixbar.dyad_assembly import O2, O4, Q1, Q2, A, B, J
from synthesis.kinds.motion.statement.mechanism_types import Sixbar
from synthesis.model.linkage.sixbars import Links


class Topology(NamedTuple):
    """A topology: type, index of each joint among the kernel's joints, and links."""

    type: Sixbar
    joints: dict[str, int]
    links: Links


_FOURBAR = {"O2": O2, "A": A, "B": B, "O4": O4}

TOPOLOGIES = (
    Topology(
        "watt_1",
        _FOURBAR | {"C": Q1, "D": Q2, "E": J},
        {"ground": ("O2", "O4"), "input": ("O2", "A", "D"), "coupler": ("A", "B", "C"), "output": ("O4", "B"),
         "link_5": ("C", "E", "P"), "link_6": ("D", "E")},
    ),
    Topology(
        "watt_1",
        _FOURBAR | {"C": Q1, "D": Q2, "E": J},
        {"ground": ("O2", "O4"), "input": ("O2", "A"), "coupler": ("A", "B", "C"), "output": ("O4", "B", "D"),
         "link_5": ("C", "E", "P"), "link_6": ("D", "E")},
    ),
    Topology(
        "stephenson_3",
        _FOURBAR | {"C": Q1, "O6": Q2, "D": J},
        {"ground": ("O2", "O4", "O6"), "input": ("O2", "A"), "coupler": ("A", "B", "C"), "rocker": ("O4", "B"),
         "link_5": ("C", "D", "P"), "output": ("O6", "D")},
    ),
    Topology(
        "stephenson_1",
        _FOURBAR | {"C": Q1, "D": Q2, "E": J},
        {"ground": ("O2", "O4"), "input": ("O2", "A", "C"), "coupler": ("A", "B"), "output": ("O4", "B", "D"),
         "link_5": ("C", "E", "P"), "link_6": ("D", "E")},
    ),
    Topology(
        "stephenson_1",
        _FOURBAR | {"D": Q1, "C": Q2, "E": J},
        {"ground": ("O2", "O4"), "input": ("O2", "A", "C"), "coupler": ("A", "B"), "output": ("O4", "B", "D"),
         "link_5": ("C", "E"), "link_6": ("D", "E", "P")},
    ),
)  # fmt: skip
"""Topologies in the order of their kernel numbers
(:data:`~synthesis.kinds.motion.sixbar.dyad_assembly.TOPOLOGY_LINKS`)."""


class SixbarCandidates(NamedTuple):
    """Candidate sixbars of a search, best first.

    ``makes`` (n,) are topology numbers, ``joints`` (n, 7) and ``bodies`` (n,) the joints and P in the first position,
    ``stands`` (n,) the body's rotation there from its target angle, radians, and ``values`` (n,) the scores.
    """

    makes: NDArray[np.int64]
    joints: Complex
    bodies: Complex
    stands: Real
    values: Real

    @classmethod
    def make_empty(cls) -> SixbarCandidates:
        """Return an empty set of candidates."""
        return cls.allocate(0)

    @classmethod
    def allocate(cls, n: int) -> SixbarCandidates:
        """Allocate uninitialised arrays for n candidates."""
        return cls(np.empty(n, np.int64), np.empty((n, 7), complex), np.empty(n, complex), np.empty(n), np.empty(n))

    def select_rows(self, rows: NDArray[np.int64]) -> SixbarCandidates:
        """Return selected candidates, in the order of the given row indices."""
        return SixbarCandidates(
            self.makes[rows], self.joints[rows], self.bodies[rows], self.stands[rows], self.values[rows]
        )

    def merge(self, other: SixbarCandidates) -> SixbarCandidates:
        """Return these candidates followed by others."""
        return SixbarCandidates(
            np.concatenate([self.makes, other.makes]),
            np.concatenate([self.joints, other.joints]),
            np.concatenate([self.bodies, other.bodies]),
            np.concatenate([self.stands, other.stands]),
            np.concatenate([self.values, other.values]),
        )
