"""Circuits and branches of the fourbar as Grashof's rule counts them."""

from __future__ import annotations

from typing import NamedTuple

from kinematics.linkage.fourbar.circuits import has_full_rotation
from kinematics.linkage.fourbar.classification import can_assemble, grashof_class
from kinematics.linkage.fourbar.closed_form import Fourbar


class Circuits(NamedTuple):
    """Number of circuits and of branches on each circuit, input driving (Norton, Table 4-1)."""

    circuits: int
    branches: int


def count_circuits(linkage: Fourbar) -> Circuits:
    """Circuits of one design and branches per circuit; a special-case linkage is one circuit of two branches."""
    if not can_assemble(linkage):
        return Circuits(0, 0)
    kind = int(grashof_class(linkage.lengths))
    return Circuits(2 if kind == 1 else 1, 1 if has_full_rotation(linkage) else 2)
