"""Common interface for driving function generators in the analysis core: fourbars, slider-cranks and sixbars."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.errors import DimensionError, MechanismError
from kinematics.linkage import SliderCrank, slider_crank
from kinematics.linkage.fourbar import (
    CROSSED,
    OPEN,
    BarkerClass,
    barker_class,
    can_assemble,
    positions,
    same_circuit,
    stays_on_branch,
    transmission_extremes,
)
from kinematics.linkage.planar.limits import branches, holding_reference
from kinematics.linkage.planar.mechanism import GROUND
from kinematics.linkage.slider_crank import range as slider_range
from synthesis.model.linkage_answer import FourbarMechanism, SixbarMechanism, SliderCrankMechanism
from synthesis.model.linkages import driven_fourbar, to_complex
from synthesis.proof.closer import GRID, least_angles
from synthesis.proof.measures import TURNS_THROUGH, barker_within
from synthesis.proof.on_branch import OnBranch
from synthesis.proof.rebuilt import rebuilt

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

AT_END = 1e-9
"""Tolerance, radians, of a range at the end of its branch; it covers rounding."""


class Driven(NamedTuple):
    """A linkage at input angles (n,): whether it is assembled, the output's position (radians or length), and its
    moving pivots (pivots, n)."""

    valid: NDArray[np.bool_]
    place: Real
    moving: Complex


class Drive(ABC):
    """A linkage driven at its input by the analysis core."""

    assembly: int
    pivots: list[complex]
    turns: float
    """Period of the output, radians; infinite for a slider."""
    frame: float
    """Direction of the ground line or of the slide, radians."""
    full: bool
    """Whether the input rotates fully."""
    barker: BarkerClass | None = None
    dyads: tuple[str, ...] = ("coupler",)
    """First links of the driven dyads, or legs of a triad."""

    @abstractmethod
    def at(self, angles: Real, assembly: int) -> Driven:
        """Compute positions at absolute input angles, radians."""

    @abstractmethod
    def on_branch(self, start: float, end: float) -> bool:
        """Return whether the input can turn from start to end without a toggle."""

    @abstractmethod
    def least_transmissions(self, start: float, end: float) -> dict[str, float]:
        """Return the minimum transmission angles over the range, radians, by the links of :attr:`dyads`."""

    @abstractmethod
    def one_circuit(self, angles: Real, assemblies: NDArray[np.int64]) -> bool:
        """Return whether the configurations lie on one circuit."""


class _Fourbar(Drive):
    turns = math.tau

    def __init__(self, mechanism: FourbarMechanism) -> None:
        fourbar = driven_fourbar(mechanism)
        self.linkage, self.assembly = fourbar.linkage, fourbar.assembly
        if not can_assemble(self.linkage):
            raise DimensionError("input", "lengths that can be assembled", math.nan)
        self.pivots = [complex(self.linkage.input_pivot), complex(self.linkage.output_pivot)]
        self.frame = float(self.linkage.ground_angle)
        self.barker = barker_class(self.linkage)
        self.full = self.barker.motion in TURNS_THROUGH

    def at(self, angles: Real, assembly: int) -> Driven:
        at = positions(self.linkage, angles, assembly)
        return Driven(at.valid, at.output_angle, np.stack([at.a, at.b]))

    def on_branch(self, start: float, end: float) -> bool:
        return bool(stays_on_branch(self.linkage, start, end))

    def least_transmissions(self, start: float, end: float) -> dict[str, float]:
        return {"coupler": float(transmission_extremes(self.linkage, start, end)[0])}

    def one_circuit(self, angles: Real, assemblies: NDArray[np.int64]) -> bool:
        return bool(np.all(same_circuit(self.linkage, angles[0], assemblies[0], angles, assemblies)))


class _Slider(Drive):
    turns = math.inf

    def __init__(self, mechanism: SliderCrankMechanism) -> None:
        pivot, angle = to_complex(mechanism.fixed_pivot), math.radians(mechanism.slide.angle)
        along = complex(math.cos(angle), math.sin(angle))
        line = to_complex(mechanism.slide.point)
        # Travel is measured from the foot of the pivot on the slide's line.
        foot = line + along * ((pivot - line) * along.conjugate()).real
        self.linkage = SliderCrank(pivot, foot, angle, mechanism.links.crank, mechanism.links.coupler)
        self.assembly = OPEN if mechanism.assembly == "open" else CROSSED
        self.pivots = [pivot]
        self.frame = angle
        self.full = bool(slider_crank.full_rotation(self.linkage))

    def at(self, angles: Real, assembly: int) -> Driven:
        at = slider_crank.positions(self.linkage, angles, assembly)
        return Driven(at.valid, at.travel, np.stack([at.a, at.b]))

    def on_branch(self, start: float, end: float) -> bool:
        return slider_range.stays_on_branch(self.linkage, start, end)

    def least_transmissions(self, start: float, end: float) -> dict[str, float]:
        return {"coupler": slider_range.least_transmission_angle(self.linkage, start, end)}

    def one_circuit(self, angles: Real, assemblies: NDArray[np.int64]) -> bool:
        first = float(angles[0]), int(assemblies[0])
        rest = zip(angles, assemblies, strict=True)
        return all(slider_range.same_circuit(self.linkage, *first, float(x), int(sign)) for x, sign in rest)


class _Sixbar(Drive):
    turns = math.tau

    def __init__(self, design: SixbarMechanism) -> None:
        mechanism = rebuilt(design)
        if mechanism is None:
            raise DimensionError("input", "lengths that can be assembled", math.nan)
        try:
            own = holding_reference(mechanism, branches(mechanism))
        except MechanismError as fault:
            raise DimensionError("input", "a sixbar whose circuits are known", math.nan) from fault
        if own is None:
            raise DimensionError("input", "a sixbar that does not begin at a toggle", math.nan)
        self.assembly, self.mechanism, self.own = 0, mechanism, OnBranch(mechanism, own)
        ground = mechanism.links[GROUND]
        self.pivots = [complex(mechanism.joints[name]) for name in ground]
        self._moving = [name for name in mechanism.joints if name not in ground]
        self.frame = 0.0
        self.full = own.full
        self.dyads = ("link_3", "link_5", "output") if design.type == "stephenson_2" else ("coupler", "link_5")
        self.barker = barker_within(mechanism)

    def _near(self, angles: Real | float) -> Real:
        """Remove the full turns between the first input angle and the reference."""
        first = np.ravel(angles)[0]
        return np.asarray(angles - math.tau * round((first - float(self.mechanism.reference_input)) / math.tau))

    def at(self, angles: Real, assembly: int) -> Driven:
        motion = self.own.at(self._near(angles))
        moving = np.stack([motion.joints[name][0] for name in self._moving])
        return Driven(motion.valid, motion.angles["output"][0], moving)

    def on_branch(self, start: float, end: float) -> bool:
        low, high = self.own.range
        way = self._near(np.array([start, end]))
        return self.full or bool(np.all((way >= low - AT_END) & (way <= high + AT_END)))

    def least_transmissions(self, start: float, end: float) -> dict[str, float]:
        return least_angles(self.own.at, self._near(np.linspace(start, end, GRID)))

    def one_circuit(self, angles: Real, assemblies: NDArray[np.int64]) -> bool:
        # Beyond the ends of the reference's branch no other branch is known to belong to the same circuit.
        return self.on_branch(float(angles.min()), float(angles.max()))


def drive_of(mechanism: FourbarMechanism | SliderCrankMechanism | SixbarMechanism) -> Drive:
    """Make the drive of a linkage.

    Raises
    ------
    DimensionError
        If it cannot be assembled, or its circuits are unknown.
    """
    if isinstance(mechanism, FourbarMechanism):
        return _Fourbar(mechanism)
    return _Sixbar(mechanism) if isinstance(mechanism, SixbarMechanism) else _Slider(mechanism)
