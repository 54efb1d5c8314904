"""Trains with moving axes as GIF: true outlines in mesh, each gear at its own speed, planets on their arms."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Complex
from kinematics.gear.arrangements import ARRANGEMENTS
from service.render.gears.placement import PlacedGear
from service.render.gears.planetary_layout import place_planetary_gears
from service.render.gears.series_layout import arrange_series
from service.render.page.animation import FRAME_COUNT, Stroke, draw_gif, make_circle
from service.render.page.svg import Box
from service.render.page.symbols import COUPLER, CURVE, GREY, GROUND, INPUT, OUTPUT
from synthesis.kinds.planetary_train.design import PlanetaryDesign
from synthesis.kinds.planetary_train.problem import PlanetaryProblem
from synthesis.kinds.train_series.design import TrainSeriesDesign
from synthesis.kinds.train_series.problem import TrainSeriesProblem

PITCH_COUNT = 9.0
"""Number of teeth of the fastest mesh that pass in a cycle; few enough for the eye to follow."""

RIM_WIDTH = 3.0
"""Width of a ring outside its pitch circle, modules."""

SPOKE_LENGTH, HUB_RADIUS = 0.8, 0.08
"""Length of the line that shows a gear's rotation, and radius of its shaft, as shares of the pitch radius."""

GEAR_COLOURS = (INPUT, OUTPUT, COUPLER, CURVE, GROUND)
GEAR_FILLS = ("#e8eef6", "#e6f1ea", "#f8eee2", "#f1ecf6", "#eef0f2")
"""Colours by unit of a series, or by the role of the gears in one train."""


class TurningGear(NamedTuple):
    """A gear that rotates in an animation.

    ``speed`` is its own speed, and ``orbit`` that of its carrier about ``axis``, both relative to the input's speed.
    ``tone`` is the index of its colour, and ``arm`` is the colour of its carrier.
    """

    placed: PlacedGear
    speed: float
    orbit: float
    axis: complex
    tone: int
    toothed: bool
    arm: str = GREY


@dataclass(frozen=True)
class _GearOutline:
    """A gear's outline about its centre, and its rim if it is a ring."""

    gear: TurningGear
    points: Complex
    rim: Complex | None

    @property
    def reach(self) -> float:
        """Radius of the drawn gear about its centre."""
        return float(max(np.abs(self.points).max(), 0.0 if self.rim is None else np.abs(self.rim).max()))


def draw_planetary_animation(design: PlanetaryDesign, problem: PlanetaryProblem, title: str) -> bytes:
    """Draw a planetary train over some teeth as GIF: input blue, output green, fixed members dark; carriers alike."""
    mechanism, speeds = design.mechanism, design.metrics.speeds
    arrangement = ARRANGEMENTS[mechanism.arrangement]
    # Indices of COLOURS: blue, green, dark.
    tones = {mechanism.input: 0, mechanism.output: 1, mechanism.fixed: 4}
    return draw_turning_gears(
        TurningGear(
            placed,
            speeds[placed.body],
            speeds.get(arrangement.carriers.get(placed.body, ""), 0.0),
            0j,
            tones.get(placed.body, 2 if placed.body in arrangement.carriers else 3),
            not arrangement.bevel,
            _choose_arm_colour(tones.get(arrangement.carriers.get(placed.body, ""))),
        )
        for placed in place_planetary_gears(mechanism)
    )


def _choose_arm_colour(tone: int | None) -> str:
    return GREY if tone is None else GEAR_COLOURS[tone]


def draw_series_animation(design: TrainSeriesDesign, problem: TrainSeriesProblem, title: str) -> bytes:
    """Draw trains in series over some teeth as GIF, each unit in its own colour."""
    return draw_turning_gears(
        TurningGear(gear.placed, gear.speed, gear.orbit, gear.axis, (gear.unit - 1) % len(GEAR_COLOURS), gear.toothed)
        for gear in arrange_series(design, problem)
    )


def draw_turning_gears(gears: Iterable[TurningGear]) -> bytes:
    """Draw a GIF of turning gears that covers the passage of :data:`PITCH_COUNT` teeth of the fastest one."""
    # Rings lie behind the gears that run inside them.
    drawn = sorted((_make_gear_outline(gear) for gear in gears), key=lambda one: -one.reach * (one.rim is not None))
    # Relative to the carrier: that is the speed at which teeth pass their mates.
    passing = max(abs(one.gear.speed - one.gear.orbit) * one.gear.placed.gear.teeth for one in drawn)
    # A locked train has no relative motion.
    turn = math.tau * PITCH_COUNT / passing if passing > 0.0 else 0.0

    def make_frames() -> Iterator[list[Stroke]]:
        for k in range(FRAME_COUNT):
            yield [stroke for one in drawn for stroke in _draw_gear(one, turn * k / FRAME_COUNT)] + _draw_arms(
                drawn, turn * k / FRAME_COUNT
            )

    shown = [
        # Orbiting gears sweep a circle about the axis.
        make_circle(one.gear.axis, abs(one.gear.placed.centre - one.gear.axis) + one.reach)
        for one in drawn
        if one.gear.orbit
    ]
    shown += [make_circle(one.gear.placed.centre, one.reach) for one in drawn if not one.gear.orbit]
    return draw_gif(make_frames(), Box.enclose(np.concatenate(shown)))


def _make_gear_outline(gear: TurningGear) -> _GearOutline:
    placed = gear.placed
    teeth = placed.get_teeth() if gear.toothed else None
    points = make_circle(0j, placed.pitch_radius) if teeth is None else teeth
    rim = make_circle(0j, placed.pitch_radius + RIM_WIDTH * placed.gear.module) if placed.gear.internal else None
    return _GearOutline(gear, points, rim)


def _find_centre(gear: TurningGear, turned: float) -> complex:
    """Return the centre after a rotation of the input (radians)."""
    return gear.axis + (gear.placed.centre - gear.axis) * complex(np.exp(1j * gear.orbit * turned))


def _draw_gear(one: _GearOutline, turned: float) -> list[Stroke]:
    """Return a gear with a line that shows its rotation."""
    gear, placed = one.gear, one.gear.placed
    centre, spin = _find_centre(gear, turned), complex(np.exp(1j * gear.speed * turned))
    colour, face = GEAR_COLOURS[gear.tone], GEAR_FILLS[gear.tone]
    if one.rim is not None:
        inner, outer = placed.gear.root_radius, float(np.abs(one.rim).max())
        return [
            Stroke(centre + one.rim, colour, 1.3, closed=True, fill=face),
            Stroke(centre + one.points * spin, colour, 1.3, closed=True, fill="#ffffff"),
            Stroke(np.array([centre + inner * spin, centre + outer * spin]), colour, 2.0),
        ]
    return draw_external_gear(one.points, centre, gear.speed * turned, placed.pitch_radius, colour, face)


def draw_external_gear(
    outline: Complex, centre: complex, turned: float, pitch_radius: float, colour: str, face: str
) -> list[Stroke]:
    """Return a rotated external gear (radians) with a line that shows the rotation, and its shaft."""
    spin = complex(np.exp(1j * turned))
    spoke = np.array([centre, centre + SPOKE_LENGTH * pitch_radius * spin])
    return [
        Stroke(centre + outline * spin, colour, 1.3, closed=True, fill=face),
        Stroke(spoke, colour, 1.6),
        Stroke(make_circle(centre, HUB_RADIUS * pitch_radius), GROUND, 1.3, True, "#ffffff"),
    ]


def _draw_arms(drawn: Sequence[_GearOutline], turned: float) -> list[Stroke]:
    """Return carriers as lines from the axis to the planets."""
    return [
        Stroke(np.array([one.gear.axis, _find_centre(one.gear, turned)]), one.gear.arm, 2.2)
        for one in drawn
        if abs(one.gear.placed.centre - one.gear.axis) > 0.0 and one.gear.orbit
    ]
