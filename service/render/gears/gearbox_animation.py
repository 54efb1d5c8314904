"""Gearboxes as GIF: every speed in turn with its engaged pairs, viewed from the shafts' ends."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np

from kinematics.arrays import Complex
from service.render.gears.gearbox_layout import BoxGear, BoxLayout, arrange_gearbox, arrange_layshaft
from service.render.gears.turning import GEAR_COLOURS, GEAR_FILLS, PITCH_COUNT, draw_external_gear
from service.render.page.animation import FRAME_COUNT, Stroke, draw_gif, make_circle
from service.render.page.svg import Box
from service.render.page.symbols import PALE
from synthesis.kinds.gearbox.design import GearboxDesign
from synthesis.kinds.gearbox.problem import GearboxProblem
from synthesis.kinds.layshaft_gearbox.design import LayshaftDesign
from synthesis.kinds.layshaft_gearbox.problem import LayshaftProblem

MIN_FRAMES = 6
"""Minimum number of frames per speed."""


def draw_gearbox_animation(design: GearboxDesign, problem: GearboxProblem, title: str) -> bytes:
    """Draw all spindle speeds of a machine-tool gearbox one after the other, as GIF."""
    phases = [
        [f"STAGE_{stage}_PAIR_{pair + 1}" for stage, pair in enumerate(row.engaged, 1)] for row in design.metrics.speeds
    ]
    return _draw_animation(arrange_gearbox(design.mechanism), phases)


def draw_layshaft_animation(design: LayshaftDesign, problem: LayshaftProblem, title: str) -> bytes:
    """Draw all gears of a layshaft gearbox in turn, reverse last, as GIF; in direct drive only the head pair."""
    mechanism = design.mechanism
    phases = [
        ["HEAD"] if gear.layshaft is None else ["HEAD", f"GEAR_{number}"]
        for number, gear in enumerate(mechanism.gears, 1)
    ]
    if mechanism.reverse is not None:
        phases.append(["HEAD", "REVERSE"])
    return _draw_animation(arrange_layshaft(mechanism), phases)


def _draw_animation(layout: BoxLayout, phases: Sequence[Sequence[str]]) -> bytes:
    outlines = [_get_outline(placed) for placed in layout.gears]
    # All speeds share the frames of one cycle.
    count = max(FRAME_COUNT // len(phases), MIN_FRAMES)

    def make_frames() -> Iterator[list[Stroke]]:
        for engaged in phases:
            speeds = compute_gearbox_speeds(layout, engaged)
            # The fastest mesh sets the pace, so that teeth do not seem to run backwards.
            passing = max(abs(speed) * placed.gear.teeth for placed, speed in _iterate_engaged(layout, speeds))
            for k in range(count):
                turned = math.tau * PITCH_COUNT / FRAME_COUNT / passing * k
                idle = [
                    Stroke(make_circle(placed.centre, placed.pitch_radius), PALE, 1.2, closed=True)
                    for placed in layout.gears
                    if placed.pair not in engaged
                ]
                yield idle + [
                    stroke
                    for placed, points in zip(layout.gears, outlines, strict=True)
                    if placed.pair in engaged
                    for stroke in draw_external_gear(
                        points,
                        placed.centre,
                        speeds[placed.pair, placed.shaft] * turned,
                        placed.pitch_radius,
                        GEAR_COLOURS[engaged.index(placed.pair) % len(GEAR_COLOURS)],
                        GEAR_FILLS[engaged.index(placed.pair) % len(GEAR_FILLS)],
                    )
                ]

    reached = [
        make_circle(placed.centre, float(np.abs(points).max()))
        for placed, points in zip(layout.gears, outlines, strict=True)
    ]
    return draw_gif(make_frames(), Box.enclose(np.concatenate(reached)))


def _get_outline(placed: BoxGear) -> Complex:
    teeth = placed.get_teeth()
    return make_circle(0j, placed.pitch_radius) if teeth is None else teeth


def compute_gearbox_speeds(layout: BoxLayout, engaged: Sequence[str]) -> dict[tuple[str, int], float]:
    """Return the speed of every engaged gear relative to the input's, by pair and shaft, following the power flow."""
    shafts = {0: 1.0}
    speeds: dict[tuple[str, int], float] = {}
    for pair in engaged:
        gears = [placed for placed in layout.gears if placed.pair == pair]
        teeth_passing = shafts[gears[0].shaft] * gears[0].gear.teeth
        for n, placed in enumerate(gears):
            # The same number of teeth passes every gear of a chain; external meshes reverse.
            shafts[placed.shaft] = speeds[pair, placed.shaft] = (-1) ** n * teeth_passing / placed.gear.teeth
    return speeds


def _iterate_engaged(layout: BoxLayout, speeds: dict[tuple[str, int], float]) -> Iterator[tuple[BoxGear, float]]:
    for placed in layout.gears:
        if (placed.pair, placed.shaft) in speeds:
            yield placed, speeds[placed.pair, placed.shaft]
