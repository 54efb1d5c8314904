"""Common interface for driving function generators in the analysis core: fourbars, slider-cranks and sixbars."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex, Real
from kinematics.errors import DimensionError, MechanismError
from kinematics.linkage import SliderCrank, slider_crank
from kinematics.linkage.fourbar import (
    CROSSED_ASSEMBLY,
    OPEN_ASSEMBLY,
    BarkerClass,
    barker_class,
    can_assemble,
    find_transmission_extremes,
    is_same_circuit,
    positions,
    stays_on_branch,
)
from kinematics.linkage.planar.limits import find_branches, find_reference_branch
from kinematics.linkage.planar.mechanism import GROUND
from kinematics.linkage.refined_extremes import GRID_SIZE, find_min_transmission_angles
from kinematics.linkage.slider_crank import range as slider_range
from synthesis.kinds.function.design import FunctionMechanism
from synthesis.model.linkage.answer import (
    EightbarMechanism,
    FourbarMechanism,
    MultiloopMechanism,
    SixbarMechanism,
    SliderCrankMechanism,
)
from synthesis.model.linkage.conversion import build_driven_fourbar, to_complex
from synthesis.verification.branch_drive import MechanismOnBranch
from synthesis.verification.measures import ROTATING_INPUT_CLASSES, classify_inner_fourbar
from synthesis.verification.reconstruction import rebuild_mechanism

RANGE_TOLERANCE = 1e-9
"""Tolerance, radians, of a range at the end of its branch; it covers rounding."""

DYAD_LINKS = {
    "stephenson_2": ("link_3", "link_5", "output"),
    "eightbar": ("coupler", "link_5", "link_7"),
}
"""First links of the driven dyads, or legs of a triad, of types that differ from other sixbars."""


class DrivenStates(NamedTuple):
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
    def compute_positions(self, angles: Real, assembly: int) -> DrivenStates:
        """Compute positions at absolute input angles, radians."""

    @abstractmethod
    def is_on_branch(self, start: float, end: float) -> bool:
        """Return whether the input can turn from start to end without a toggle."""

    @abstractmethod
    def compute_min_transmissions(self, start: float, end: float) -> dict[str, float]:
        """Return the minimum transmission angles over the range, radians, by the links of :attr:`dyads`."""

    @abstractmethod
    def is_one_circuit(self, angles: Real, assemblies: NDArray[np.int64]) -> bool:
        """Return whether the configurations lie on one circuit."""


class _Fourbar(Drive):
    turns = math.tau

    def __init__(self, mechanism: FourbarMechanism) -> None:
        fourbar = build_driven_fourbar(mechanism)
        self.linkage, self.assembly = fourbar.linkage, fourbar.assembly
        # Some dimensions satisfy the model but close at no input angle.
        if not can_assemble(self.linkage):
            raise DimensionError("input", "lengths that can be assembled", math.nan)
        self.pivots = [complex(self.linkage.input_pivot), complex(self.linkage.output_pivot)]
        self.frame = float(self.linkage.ground_angle)
        self.barker = barker_class(self.linkage)
        self.full = self.barker.motion in ROTATING_INPUT_CLASSES

    def compute_positions(self, angles: Real, assembly: int) -> DrivenStates:
        at = positions(self.linkage, angles, assembly)
        return DrivenStates(at.valid, at.output_angle, np.stack([at.a, at.b]))

    def is_on_branch(self, start: float, end: float) -> bool:
        return bool(stays_on_branch(self.linkage, start, end))

    def compute_min_transmissions(self, start: float, end: float) -> dict[str, float]:
        return {"coupler": float(find_transmission_extremes(self.linkage, start, end)[0])}

    def is_one_circuit(self, angles: Real, assemblies: NDArray[np.int64]) -> bool:
        return bool(np.all(is_same_circuit(self.linkage, angles[0], assemblies[0], angles, assemblies)))


class _Slider(Drive):
    turns = math.inf

    def __init__(self, mechanism: SliderCrankMechanism) -> None:
        pivot, angle = to_complex(mechanism.fixed_pivot), math.radians(mechanism.slide.angle)
        along = complex(math.cos(angle), math.sin(angle))
        line = to_complex(mechanism.slide.point)
        # Travel is measured from the foot of the pivot on the slide's line.
        foot = line + along * ((pivot - line) * along.conjugate()).real
        self.linkage = SliderCrank(pivot, foot, angle, mechanism.links.crank, mechanism.links.coupler)
        self.assembly = OPEN_ASSEMBLY if mechanism.assembly == "open" else CROSSED_ASSEMBLY
        self.pivots = [pivot]
        self.frame = angle
        self.full = bool(slider_crank.has_full_rotation(self.linkage))

    def compute_positions(self, angles: Real, assembly: int) -> DrivenStates:
        at = slider_crank.positions(self.linkage, angles, assembly)
        return DrivenStates(at.valid, at.travel, np.stack([at.a, at.b]))

    def is_on_branch(self, start: float, end: float) -> bool:
        return slider_range.stays_on_branch(self.linkage, start, end)

    def compute_min_transmissions(self, start: float, end: float) -> dict[str, float]:
        return {"coupler": slider_range.find_min_transmission_angle(self.linkage, start, end)}

    def is_one_circuit(self, angles: Real, assemblies: NDArray[np.int64]) -> bool:
        first = float(angles[0]), int(assemblies[0])
        rest = zip(angles, assemblies, strict=True)
        return all(slider_range.is_same_circuit(self.linkage, *first, float(x), int(sign)) for x, sign in rest)


class _Multiloop(Drive):
    turns = math.tau

    def __init__(self, design: SixbarMechanism | EightbarMechanism) -> None:
        mechanism = rebuild_mechanism(design)
        if mechanism is None:
            raise DimensionError("input", "lengths that can be assembled", math.nan)
        try:
            # Only the branch of the reference counts: a generator never changes its assembly.
            own = find_reference_branch(mechanism, find_branches(mechanism))
        except MechanismError as fault:
            raise DimensionError("input", "a linkage whose circuits are known", math.nan) from fault
        if own is None:
            raise DimensionError("input", "a linkage that does not begin at a toggle", math.nan)
        self.assembly, self.mechanism, self.own = 0, mechanism, MechanismOnBranch(mechanism, own)
        ground = mechanism.links[GROUND]
        self.pivots = [complex(mechanism.joints[name]) for name in ground]
        self._moving = [name for name in mechanism.joints if name not in ground]
        # Linkages of several loops are measured with absolute angles, so their frame is not turned.
        self.frame = 0.0
        self.full = own.full
        self.dyads = DYAD_LINKS.get(design.type, ("coupler", "link_5"))
        self.barker = classify_inner_fourbar(mechanism)

    def _remove_full_turns(self, angles: Real | float) -> Real:
        """Remove the full turns between the first input angle and the reference."""
        # Branch ranges are given around the reference, angles of the dial in any turn.
        first = np.ravel(angles)[0]
        return np.asarray(angles - math.tau * round((first - float(self.mechanism.reference_input)) / math.tau))

    def compute_positions(self, angles: Real, assembly: int) -> DrivenStates:
        motion = self.own.evaluate_motion(self._remove_full_turns(angles))
        moving = np.stack([motion.joints[name][0] for name in self._moving])
        return DrivenStates(motion.valid, motion.angles["output"][0], moving)

    def is_on_branch(self, start: float, end: float) -> bool:
        low, high = self.own.range
        way = self._remove_full_turns(np.array([start, end]))
        # A full branch contains every range.
        return self.full or bool(np.all((way >= low - RANGE_TOLERANCE) & (way <= high + RANGE_TOLERANCE)))

    def compute_min_transmissions(self, start: float, end: float) -> dict[str, float]:
        return find_min_transmission_angles(
            self.own.evaluate_motion, self._remove_full_turns(np.linspace(start, end, GRID_SIZE))
        )

    def is_one_circuit(self, angles: Real, assemblies: NDArray[np.int64]) -> bool:
        # Beyond the ends of the reference's branch no other branch is known to belong to the same circuit.
        return self.is_on_branch(float(angles.min()), float(angles.max()))


def make_drive(mechanism: FunctionMechanism) -> Drive:
    """Make the drive of a linkage.

    Raises
    ------
    DimensionError
        If it cannot be assembled, or its circuits are unknown.
    """
    if isinstance(mechanism, FourbarMechanism):
        return _Fourbar(mechanism)
    return _Multiloop(mechanism) if isinstance(mechanism, MultiloopMechanism) else _Slider(mechanism)
