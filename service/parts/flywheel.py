"""Parts of a flywheel: the wheel on its keyed shaft between two plates.

The wheel is one plate of the answer's thickness. A disc has a bore with a keyway, whereas that of the answer is solid;
shaft and key fill the bore and rotate with the disc. A rim also has arms and a hub, whereas that of the answer is a
plain ring. The bill of materials has the mass of the wheel as made, and the README has the difference from the answer.
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass

from kinematics.message import compose
from service.parts.assembly.colours import LINK_COLOURS
from service.parts.assembly.keys import find_key, make_bore
from service.parts.assembly.model import Assembly, Carrier, Part
from service.parts.assembly.sizes import (
    DEFAULT_CLEARANCES,
    MAX_CLEARANCE_PER_PIN,
    MAX_PIN,
    MIN_CLEARANCE_PER_PIN,
    MIN_PIN,
    WIDTH_PER_PIN,
    NotMade,
    PartsQuery,
    Sizes,
    check_sizes,
    choose_pin,
    choose_sheet,
    round_down,
)
from service.parts.gears.housing import Housing, Shaft, stack_levels
from service.parts.gears.motion import BodyRotation, TrainMotion
from service.parts.gears.sizing import GearSizing
from service.parts.gears.wheels import check_assembly
from service.parts.geometry.regions import Disc, Loop, Region, measure_area
from service.parts.geometry.solids import Prism
from synthesis.kinds.flywheel.design import FlywheelDesign
from synthesis.kinds.flywheel.problem import FlywheelProblem

MAX_BORE_SHARE = 0.2
"""Thickest default shaft, as a share of the wheel's radius."""

HUB_RADIUS, ARM_COUNT, ARM_WIDTH = 1.0, 5, 0.4
"""Radius of a hub in shaft diameters, number of arms of a rim, and their width in shaft diameters."""

MAX_BORE_PER_WALL = 3.5
"""Thickest default shaft, in walls of a rim."""

MIN_WINDOW_WIDTH = 0.5
"""Minimum width of the windows between hub and rim, in shaft diameters; narrower ones are not cut."""

ON_SHAFT = Carrier("flywheel_shaft", None)


def make_flywheel_parts(design: FlywheelDesign, problem: FlywheelProblem, query: PartsQuery) -> Assembly:
    """Make the parts of a flywheel.

    Parameters
    ----------
    design : FlywheelDesign
    problem : FlywheelProblem
    query : PartsQuery
        Lengths in the unit of the problem.

    Raises
    ------
    NotMade
        If the shaft does not fit the wheel.
    """
    sizing = GearSizing(query, problem.length_unit)
    wheel = design.mechanism
    sizing.check_size(2.0 * wheel.radius * sizing.factor, "parts-flywheel-too-large")
    outer, inner, thick = (sizing.factor * length for length in (wheel.radius, wheel.inner_radius, wheel.thickness))
    si = problem.units == "si"
    density = compose("parts-density-in-si" if si else "parts-density", density=f"{wheel.density:.6g}")
    # Mass unit of the answer: problem.scale is the length unit in that of the density.
    to_cubic_millimetre = (problem.scale / sizing.unit) ** 3
    made = _Wheel(outer, inner, thick, _choose_sizes(outer, inner, sizing), wheel.density * to_cubic_millimetre)
    return made.build_assembly(sizing, density, "kg" if si else compose("parts-units-of-mass"))


def _choose_sizes(outer: float, inner: float, sizing: GearSizing) -> Sizes:
    """Return sizes with the requested bore, or with the thickest that fits the wheel."""
    query, unit = sizing.query, sizing.unit
    room = inner or outer
    most = min(MAX_BORE_SHARE * outer, room / (HUB_RADIUS + MIN_WINDOW_WIDTH))
    if inner:
        most = min(most, MAX_BORE_PER_WALL * (outer - inner))
    bore = choose_pin(min(most, MAX_PIN)) if query.bore is None else query.bore * unit
    if not MIN_PIN <= bore <= MAX_PIN:
        raise NotMade(
            compose(
                "parts-shaft-not-available",
                bore=f"{bore / unit:.6g}",
                unit=sizing.words,
                smallest=f"{MIN_PIN / unit:g}",
                largest=f"{MAX_PIN / unit:g}",
            ),
            sizing.path,
        )
    if HUB_RADIUS * bore > room:
        raise NotMade(
            compose(
                "parts-no-hub-within-rim" if inner else "parts-no-hub-in-disc",
                bore=f"{bore / unit:.6g}",
                unit=sizing.words,
                largest=f"{round_down(room / HUB_RADIUS / unit):g}",
            ),
            "/query/bore",
        )
    usual = min(
        max(DEFAULT_CLEARANCES[query.process], 2.0 * MIN_CLEARANCE_PER_PIN * bore), 0.5 * MAX_CLEARANCE_PER_PIN * bore
    )
    clearance = usual if query.clearance is None else query.clearance * unit
    thickness = choose_sheet(bore) if query.thickness is None else query.thickness * unit
    sizes = Sizes(query.process, WIDTH_PER_PIN * bore, bore, thickness, clearance)
    check_sizes(sizes, unit)
    return sizes


@dataclass(frozen=True)
class _Wheel:
    """A flywheel in millimetres; ``inner`` is 0 for a disc, ``density`` is mass per cubic millimetre."""

    outer: float
    inner: float
    thick: float
    sizes: Sizes
    density: float

    def build_assembly(self, sizing: GearSizing, density: str, mass_unit: str) -> Assembly:
        """Return the wheel on its shaft, after an interference check."""
        sizes = self.sizes
        levels = stack_levels([sizes.thickness, self.thick, sizes.thickness], sizes)
        bore = make_bore(0j, sizes.pin, find_key(sizes.pin), sizes.clearance)
        windows = self._make_windows()
        region = Region(Disc(0j, self.outer), (bore, *windows))
        body = Prism(region, levels[1].low, levels[1].high)
        wheel = Part(
            "flywheel",
            compose("parts-flywheel"),
            "wheel",
            ON_SHAFT,
            (body,),
            1.0 + 0.0j,
            (1, 1),
            density,
            LINK_COLOURS[0],
            mass=self.density * body.volume,
        )
        shaft = Shaft(compose("parts-flywheel-shaft"), ON_SHAFT, 0j, (0, 2), keyed=(1,), ends=True)
        housing = Housing(sizes, levels, (shaft,), ((0j, self.outer),))
        motion = TrainMotion({ON_SHAFT.link: BodyRotation(0j, 1.0)}, 2.0 * self.outer)
        parts = (wheel, *housing.make_parts())
        notes = self._list_notes(wheel, bore, windows, mass_unit)
        return check_assembly(Assembly(parts, motion, 1, 2, sizing.factor, sizing.query.scale, notes), sizes, sizing)

    def _make_windows(self) -> tuple[Loop, ...]:
        """Return the cut-outs between the hub, the arms and the rim."""
        hub, half = HUB_RADIUS * self.sizes.pin, 0.5 * ARM_WIDTH * self.sizes.pin
        # Without enough space the plate inside the rim stays solid.
        if self.inner < hub + MIN_WINDOW_WIDTH * self.sizes.pin:
            return ()
        far, near = (math.asin(half / radius) for radius in (self.inner, hub))
        pitch = 2.0 * math.pi / ARM_COUNT
        corners = [
            cmath.rect(self.inner, far), cmath.rect(self.inner, pitch - far),
            cmath.rect(hub, pitch - near), cmath.rect(hub, near),
        ]  # fmt: skip
        bulges = math.tan(0.25 * (pitch - 2.0 * far)), 0.0, -math.tan(0.25 * (pitch - 2.0 * near)), 0.0
        # The keyway points along the first arm.
        turns = [cmath.exp(1j * k * pitch) for k in range(ARM_COUNT)]
        return tuple(Loop(tuple(turn * z for z in corners), bulges) for turn in turns)

    def _list_notes(self, wheel: Part, bore: Loop, windows: tuple[Loop, ...], mass_unit: str) -> tuple[str, ...]:
        """Describe the difference of mass and moment of inertia from the answer's."""
        assert wheel.mass is not None
        stated = self.density * self.thick * math.pi * (self.outer**2 - self.inner**2)
        if not self.inner:
            lost = self.density * self.thick * measure_area(bore)
            # The bore is treated as a disc of the shaft's radius.
            share = 0.5 * lost * (0.5 * self.sizes.pin) ** 2 / (0.5 * stated * self.outer**2)
            return (
                compose(
                    "parts-flywheel-disc-difference",
                    mass=f"{stated:.6g}",
                    unit=mass_unit,
                    removed=f"{lost:.4g}",
                    share=f"{share:.2g}",
                ),
            )
        more = wheel.mass - stated
        values = {"mass": f"{stated:.6g}", "more": f"{more:.4g}", "unit": mass_unit}
        if windows:
            return (compose("parts-arms-add-mass", **values, count=ARM_COUNT),)
        return (compose("parts-plate-adds-mass", **values),)
