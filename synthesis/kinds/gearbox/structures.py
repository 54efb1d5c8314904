"""Structures of machine-tool gearboxes: the number of pairs in every stage, and the steps between them.

A gearbox of z speeds has stages of p₁, p₂, ... pairs with p₁ p₂ ... = z. In one stage neighbouring pairs differ by one
step of the progression, characteristic 1; in the next by the number of pairs of the first; in the third by the product
of both numbers; and so on, so that every speed comes once. The *structural formula* 3(1) 2(3) names the stages in the
order of the shafts with their characteristics (Rao, Sec. 8.5; Acherkan, Machine Tool Design, vol. 3).
"""

from __future__ import annotations

import itertools
import math
from typing import NamedTuple


class Group(NamedTuple):
    """The pairs between two shafts: their number, and the steps from one to the next."""

    pairs: int
    characteristic: int


Structure = tuple[Group, ...]


def format_formula(structure: Structure) -> str:
    """Return the structural formula, e.g. ``3(1) 2(3)``; a single pair has no characteristic."""
    return " ".join(
        str(group.pairs) if group.pairs == 1 else f"{group.pairs}({group.characteristic})" for group in structure
    )


def list_structures(count: int, most: int) -> list[Structure]:
    """List all structures of ``count`` speeds with 2 to ``most`` pairs in a stage."""
    orders = []
    for factors in _list_factorizations(count, most):
        for order in itertools.permutations(range(len(factors))):
            characteristic, groups = 1, {}
            # The order in which characteristics are assigned is independent of the order of the shafts.
            for at in order:
                groups[at] = Group(factors[at], characteristic)
                characteristic *= factors[at]
            orders.append(tuple(groups[at] for at in range(len(factors))))
    return orders


def _list_factorizations(count: int, most: int) -> list[tuple[int, ...]]:
    """List ordered factorizations into factors 2 to ``most``."""
    if count == 1:
        return [()]
    factorizations = []
    for factor in range(2, min(count, most) + 1):
        if count % factor == 0:
            factorizations += [(factor, *rest) for rest in _list_factorizations(count // factor, most)]
    return factorizations


def compute_spread(group: Group, ratio: float) -> float:
    """Return the quotient of the fastest and slowest ratio of a stage, φ^((p − 1) x)."""
    return math.exp((group.pairs - 1) * group.characteristic * math.log(ratio))
