"""The speed ratio of an arrangement as a quotient of polynomials in its tooth numbers.

With one member fixed and one driven at speed 1, there are as many speed equations as unknown speeds. By Cramer's rule
the ratio input over output is a quotient of two determinants whose entries are tooth numbers; both are expanded once,
and then evaluated for millions of tooth numbers at a time.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from functools import cache
from math import gcd
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.gear.arrangements import ARRANGEMENTS, Arrangement

Polynomial = dict[tuple[str, ...], int]
"""Integer coefficients by monomial: the names of its factors, sorted, a square twice."""

Row = dict[str, Polynomial]
"""Coefficients of a speed equation, by body."""


class RatioForm(NamedTuple):
    """Ratio = over / under, without common factors that are integers or single tooth numbers."""

    over: Polynomial
    under: Polynomial


def build_mesh_row(first: str, second: str, carrier: str, names: tuple[str, str], sense: int) -> Row:
    """Return the row N1 (ω1 − ωc) − σ N2 (ω2 − ωc) = 0 for tooth numbers with these names."""
    one: Polynomial = {(names[0],): 1}
    other: Polynomial = {(names[1],): -sense}
    return {first: one, second: other, carrier: _add_polynomials([(-1, one), (-1, other)])}


def derive_ratio_form(rows: Sequence[Row], driver: str, driven: str, held: str) -> RatioForm:
    """Derive the speed of ``driver`` over that of ``driven``, ``held`` at rest; no terms if the train is locked."""
    bodies = dict.fromkeys(body for row in rows for body in row)
    unknown = [body for body in bodies if body not in (driver, held)]
    if len(unknown) != len(rows):
        raise ValueError(f"expected {len(unknown)} equations for {', '.join(unknown)}, got {len(rows)}")
    matrix = [[row.get(body, {}) for body in unknown] for row in rows]
    # Cramer's rule for the speed of the driven member; the driver's speed 1 goes to the right-hand side.
    at = unknown.index(driven)
    right = [{term: -c for term, c in row.get(driver, {}).items()} for row in rows]
    swapped = [[*line[:at], value, *line[at + 1 :]] for line, value in zip(matrix, right, strict=True)]
    return _reduce_form(_expand_determinant(matrix), _expand_determinant(swapped))


@cache
def derive_arrangement_form(name: str, driver: str, driven: str, held: str) -> RatioForm:
    """Derive the ratio of a known arrangement between three of its members."""
    row = ARRANGEMENTS[name]
    return derive_ratio_form(
        [line for planets in row.planet_sets for line in build_set_rows(row, planets)], driver, driven, held
    )


def build_set_rows(arrangement: Arrangement, planets: tuple[str, ...]) -> list[Row]:
    """Build the speed equations of the meshes of one planet set."""
    rows = []
    for one, other in arrangement.meshes:
        bodies = arrangement.places[one].body, arrangement.places[other].body
        on = [body for body in bodies if body in planets]
        if on:
            carrier = arrangement.carriers[on[0]]
            rows.append(build_mesh_row(*bodies, carrier, (one, other), arrangement.sense(one, other)))
    return rows


def evaluate_polynomial(
    polynomial: Polynomial, values: Mapping[str, NDArray[np.float64]], size: int
) -> NDArray[np.float64]:
    """Evaluate a polynomial at arrays of tooth numbers; integers, exact below 2^53."""
    total = np.zeros(size)
    for term, coefficient in polynomial.items():
        product = np.full(size, float(coefficient))
        for name in term:
            product *= values[name]
        total += product
    return total


def evaluate_exactly(polynomial: Polynomial, values: Mapping[str, int]) -> int:
    """Evaluate a polynomial at one set of tooth numbers."""
    total = 0
    for term, coefficient in polynomial.items():
        product = coefficient
        for name in term:
            product *= values[name]
        total += product
    return total


def _expand_determinant(matrix: Sequence[Sequence[Polynomial]]) -> Polynomial:
    """Expand along the first row; the matrices are small and sparse."""
    if not matrix:
        return {(): 1}
    parts = []
    for k, entry in enumerate(matrix[0]):
        if entry:
            minor = _expand_determinant([[*line[:k], *line[k + 1 :]] for line in matrix[1:]])
            parts.append(((-1) ** k, _multiply_polynomials(entry, minor)))
    return _add_polynomials(parts)


def _multiply_polynomials(one: Polynomial, other: Polynomial) -> Polynomial:
    parts = []
    for a, x in one.items():
        parts.append((x, {tuple(sorted(a + b)): y for b, y in other.items()}))
    return _add_polynomials(parts)


def _add_polynomials(parts: Iterable[tuple[int, Polynomial]]) -> Polynomial:
    total: Polynomial = {}
    for factor, polynomial in parts:
        for term, coefficient in polynomial.items():
            total[term] = total.get(term, 0) + factor * coefficient
    return {term: coefficient for term, coefficient in total.items() if coefficient}


def _reduce_form(over: Polynomial, under: Polynomial) -> RatioForm:
    """Divide both by the integer and the monomial that divide every term of both."""
    terms = [*over, *under]
    if not over or not under:
        return RatioForm({}, {})
    common = list(terms[0])
    # The common monomial: the intersection of all terms as multisets of factors.
    for term in terms[1:]:
        rest, kept = list(term), []
        for name in common:
            if name in rest:
                rest.remove(name)
                kept.append(name)
        common = kept
    # Common integer factor of all coefficients.
    number = gcd(*over.values(), *under.values())

    def divide_terms(polynomial: Polynomial) -> Polynomial:
        quotient = {}
        for term, coefficient in polynomial.items():
            rest = list(term)
            for name in common:
                rest.remove(name)
            quotient[tuple(rest)] = coefficient // number
        return quotient

    return RatioForm(divide_terms(over), divide_terms(under))
