"""Branches of a mechanism whose input does not close it by dyads, found by driving it at another link.

The configurations of a mechanism do not depend on the choice of ground and input. If the input leaves a class III
group, or is a slide, another pair of links is chosen as ground and input such that all closures are dyads. The
configurations are then known as curves (:mod:`kinematics.linkage.planar.configuration_curves`), along which the true
input is a smooth function; its reversals are toggles, and the stretches between them are the branches.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from kinematics.arrays import Integers, Real
from kinematics.errors import DimensionError
from kinematics.linkage.planar.branches import Branch, sort_reference_first
from kinematics.linkage.planar.closures import decompose, order_closures
from kinematics.linkage.planar.configuration_curves import (
    CELL_COUNT,
    Closures,
    Curve,
    Place,
    evaluate_places,
    find_configuration_curves,
    number_circuits,
    stack_chains,
)
from kinematics.linkage.planar.drive import MechanismMotion, drive_one, find_assembly_signs
from kinematics.linkage.planar.mechanism import GROUND, Mechanism, TopologyError
from kinematics.linkage.planar.positive_arcs import END_OFFSET, Domain, find_positive_arcs
from kinematics.linkage.planar.program import build_program

FULL_TURN = 2.0 * np.pi

MIN_TRAVEL = 1e-9
"""Travel of the true input along a curve, in units of the mechanism, below which it counts as at rest."""

MAX_LEAP = 0.5
"""Change of an angle between neighbouring samples, radians, above which they are too distant to be unwrapped."""


def find_other_driver(mechanism: Mechanism) -> Mechanism:
    """Find another ground and input that close the mechanism by dyads; the names of the two grounds are exchanged.

    Raises
    ------
    TopologyError
        If no pair of pinned links closes it by dyads, or gears couple it to its ground.
    """
    if mechanism.gears:
        raise TopologyError("kinematics-geared-needs-dyads")
    for base in (GROUND, *(link for link in mechanism.links if link != GROUND)):
        swapped = {GROUND: base, base: GROUND}
        links = {swapped.get(name, name): listed for name, listed in mechanism.links.items()}
        slides = tuple(slide._replace(link=swapped.get(slide.link, slide.link)) for slide in mechanism.slides)
        for driver, listed in links.items():
            # Only links pinned to the new ground can drive.
            if driver == GROUND or not set(listed) & set(links[GROUND]):
                continue
            if order_closures(links, driver, slides, ()).left:
                continue
            try:
                redriven = Mechanism(dict(mechanism.joints), links, driver, slides)
                build_program(redriven)
                return redriven
            except DimensionError:  # a link with coincident pivots cannot drive or be driven
                continue
    raise TopologyError("kinematics-no-pair-closes-by-dyads")


def find_branches_by_other_driver(mechanism: Mechanism) -> list[Branch]:
    """Find all branches of one design, circuit by circuit, the reference's first; ``signs`` and closures stay empty.

    Raises
    ------
    TopologyError
        If no pair of links closes the mechanism by dyads, or a link swings freely while the other driver stands still:
        such a motion lies on none of its curves.
    """
    other = find_other_driver(mechanism)
    decomposition = decompose(other)
    closures = Closures(other, decomposition)
    curves = find_configuration_curves(other, closures, FULL_TURN)
    if any(end.point.swings for curve in curves for end in curve.ends):
        raise TopologyError("kinematics-link-swings-at-standstill")
    true_input = _TrueInput(mechanism, other, closures, curves)
    numbers = number_circuits(curves)
    signs = find_assembly_signs(other, decomposition.steps)
    choice = np.array([int(signs[n]) for n in closures.position])
    at = float(other.reference_input)
    held = {n for n, curve in enumerate(curves) if _is_passing(curve, at, choice)}
    branches = [(branch, n in held) for n in range(len(curves)) for branch in true_input.branches(n, numbers[n])]
    first = next((k for k, (_, holds) in enumerate(branches) if holds), 0)
    return sort_reference_first([branch for branch, _ in branches], first)


def _is_passing(curve: Curve, theta: float, choice: Integers) -> bool:
    """Return whether a curve of the other driver passes one of its inputs in given assemblies."""
    cuts = [turn.at for turn in curve.turns]
    cuts = [*cuts, cuts[0] + curve.high - curve.low] if curve.closed and cuts else [curve.low, *cuts, curve.high]
    for low, high in pairwise(cuts):
        ends = sorted((curve.evaluate_input(low), curve.evaluate_input(high)))
        middle = curve.place(np.array([0.5 * (low + high)])).signs[:, 0]
        hair = 1e-7
        if np.mod(theta - ends[0] + hair, FULL_TURN) <= ends[1] - ends[0] + 2.0 * hair and np.all(middle == choice):
            return True
    return False


class _TrueInput:
    """The true input as a function along the curves of the other driver."""

    def __init__(self, mechanism: Mechanism, other: Mechanism, closures: Closures, curves: list[Curve]) -> None:
        self.mechanism, self.other, self.closures, self.curves = mechanism, other, closures, curves
        self.chains = stack_chains(curves) if curves else np.empty((0, 0, 4))
        self.slide = mechanism.has_slide_input
        pushed = [s.link == GROUND and s.joint == mechanism.input for s in mechanism.slides]
        self.pushed = mechanism.slide_names[pushed.index(True)] if self.slide else ""
        self.base = next(name for name, listed in other.links.items() if listed == mechanism.links[GROUND])
        self.link = {GROUND: self.base, self.base: GROUND}.get(mechanism.input, mechanism.input)
        arcs = find_positive_arcs(
            self._evaluate_rates, [Domain(c.low, c.high, c.closed, 2 * CELL_COUNT) for c in curves]
        )
        self.turns = [
            sorted(
                {at for arc in own for at, kind in ((arc.low, arc.at_low), (arc.high, arc.at_high)) if kind == "zero"}
            )
            for own in arcs
        ]

    def _evaluate_jet(self, place: Place, order: int) -> Real:
        """Evaluate the jet of the true input by the other one; shape (order + 1, n)."""
        signs = self.closures.signs(place.signs)
        motion = drive_one(self.other, place.theta[:, None], signs, order)
        if self.slide:
            return np.asarray(motion.slides[self.pushed][..., 0])
        turned = _evaluate_rotation(self.other, motion, self.link) - _evaluate_rotation(self.other, motion, self.base)
        turned[0] += self.mechanism.reference_input
        return turned

    def _evaluate_rates(self, row: Integers, at: Real) -> tuple[Real, Real]:
        """Evaluate the first two derivatives of the true input by the parameters of curves."""
        place = evaluate_places(self.chains, row, at)
        jet = self._evaluate_jet(place, 2)
        return jet[1] * place.rate, jet[2] * place.rate**2 + jet[1] * place.second

    def branches(self, n: int, circuit: int) -> list[Branch]:
        """Return the branches along one curve."""
        curve, turns = self.curves[n], self.turns[n]
        length = curve.high - curve.low
        if curve.closed:
            start = turns[0] if turns else curve.low + 0.1 * length
            cuts = [t for t in turns if t - start < length * (1.0 - 1e-12)] if turns else [start]
            if turns and len(cuts) % 2:
                raise TopologyError("kinematics-limits-too-close")
            cuts.append(cuts[0] + length)
        else:
            cuts = [curve.low, *turns, curve.high]
        values = self._unwrap_along(curve, cuts)
        found = []
        for one, another in pairwise(values):
            low, high = min(one, another), max(one, another)
            # The true input is at rest while the other driver moves.
            if high - low <= MIN_TRAVEL:
                continue
            start = low if self.slide else float(np.mod(low, FULL_TURN))
            found.append(Branch(circuit, start, start + high - low, curve.closed and not turns, (), "", ""))
        return found

    def _unwrap_along(self, curve: Curve, cuts: list[float]) -> list[float]:
        """Evaluate the true input at places on a curve, unwrapped."""
        length = curve.high - curve.low
        # Shifted slightly, so that samples avoid folds at regular places.
        inner = np.linspace(cuts[0], cuts[-1], CELL_COUNT + 1)[1:-1] + 0.003 / CELL_COUNT * length
        known = np.unique(np.concatenate([cuts, inner]))
        if not curve.closed:
            known = np.clip(known, curve.low + END_OFFSET * length, curve.high - END_OFFSET * length)
        value = self._evaluate_value(curve, known)
        while not self.slide:
            leap = np.abs(np.mod(np.diff(value) + np.pi, FULL_TURN) - np.pi) > MAX_LEAP
            leap &= np.diff(known) > 1e-12 * length
            if not leap.any():
                break
            between = 0.5 * (known[:-1] + known[1:])[leap]
            place = np.flatnonzero(leap) + 1
            known, value = (
                np.insert(known, place, between),
                np.insert(value, place, self._evaluate_value(curve, between)),
            )
        smooth = value if self.slide else np.unwrap(value)
        ends = np.clip(cuts, known[0], known[-1])
        inputs = smooth[np.searchsorted(known, ends)]
        if not curve.closed:
            # At a crossing rounding may lose the assembly: extrapolate from a nearby point by the Taylor series.
            at = np.array([known[0], known[-1]])
            hair = np.array([cuts[0], cuts[-1]]) - at
            rate, second = self._evaluate_rates(np.full(2, self.curves.index(curve)), at)
            inputs[[0, -1]] += hair * rate + 0.5 * hair**2 * second
        return [float(x) for x in inputs]

    def _evaluate_value(self, curve: Curve, at: Real) -> Real:
        """Evaluate the true input; where rounding loses the assembly at a fold, take a point next to it."""
        value: Real = self._evaluate_jet(curve.place(at), 0)[0]
        lost = np.isnan(value)
        if lost.any():
            value[lost] = self._evaluate_jet(curve.place(at[lost] + END_OFFSET), 0)[0]
        return value


def _evaluate_rotation(mechanism: Mechanism, motion: MechanismMotion, link: str) -> Real:
    """Evaluate the jet of a link's rotation from the reference; shape (n, inputs)."""
    if link == GROUND:
        return np.zeros(motion.input.shape[:2])
    rotation: Real = motion.angles[link][..., 0].copy()
    rotation[0] -= mechanism.link_angle(link)
    return rotation
