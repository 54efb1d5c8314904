"""Gearboxes as GIF: every speed in turn with its engaged pairs, viewed from the shafts' ends."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np

from service.render.gears.gearbox_layout import BoxGear, BoxLayout, gearbox_layout, layshaft_layout
from service.render.gears.turning import COLOURS, FACES, PITCHES, gear_strokes
from service.render.page.animation import FRAMES, Stroke, animated, ring
from service.render.page.svg import Box, Points
from service.render.page.symbols import PALE
from synthesis.kinds.gearbox.design import GearboxDesign
from synthesis.kinds.gearbox.problem import GearboxProblem
from synthesis.kinds.layshaft_gearbox.design import LayshaftDesign
from synthesis.kinds.layshaft_gearbox.problem import LayshaftProblem

LEAST_FRAMES = 6
"""Minimum number of frames per speed."""


def gearbox_animation(design: GearboxDesign, problem: GearboxProblem, title: str) -> bytes:
    """Draw all spindle speeds of a machine-tool gearbox one after the other, as GIF."""
    phases = [
        [f"STAGE_{stage}_PAIR_{pair + 1}" for stage, pair in enumerate(row.engaged, 1)] for row in design.metrics.speeds
    ]
    return _animation(gearbox_layout(design.mechanism), phases)


def layshaft_animation(design: LayshaftDesign, problem: LayshaftProblem, title: str) -> bytes:
    """Draw all gears of a layshaft gearbox in turn, reverse last, as GIF; in direct drive only the head pair."""
    mechanism = design.mechanism
    phases = [
        ["HEAD"] if gear.layshaft is None else ["HEAD", f"GEAR_{number}"]
        for number, gear in enumerate(mechanism.gears, 1)
    ]
    if mechanism.reverse is not None:
        phases.append(["HEAD", "REVERSE"])
    return _animation(layshaft_layout(mechanism), phases)


def _animation(layout: BoxLayout, phases: Sequence[Sequence[str]]) -> bytes:
    outlines = [_outline(placed) for placed in layout.gears]
    # All speeds share the frames of one cycle.
    count = max(FRAMES // len(phases), LEAST_FRAMES)

    def frames() -> Iterator[list[Stroke]]:
        for engaged in phases:
            speeds = gearbox_speeds(layout, engaged)
            # The fastest mesh sets the pace, so that teeth do not seem to run backwards.
            passing = max(abs(speed) * placed.gear.teeth for placed, speed in _turning(layout, speeds))
            for k in range(count):
                turned = math.tau * PITCHES / FRAMES / passing * k
                idle = [
                    Stroke(ring(placed.centre, placed.pitch_radius), PALE, 1.2, closed=True)
                    for placed in layout.gears
                    if placed.pair not in engaged
                ]
                yield idle + [
                    stroke
                    for placed, points in zip(layout.gears, outlines, strict=True)
                    if placed.pair in engaged
                    for stroke in gear_strokes(
                        points,
                        placed.centre,
                        speeds[placed.pair, placed.shaft] * turned,
                        placed.pitch_radius,
                        COLOURS[engaged.index(placed.pair) % len(COLOURS)],
                        FACES[engaged.index(placed.pair) % len(FACES)],
                    )
                ]

    reached = [
        ring(placed.centre, float(np.abs(points).max())) for placed, points in zip(layout.gears, outlines, strict=True)
    ]
    return animated(frames(), Box.around(np.concatenate(reached)))


def _outline(placed: BoxGear) -> Points:
    teeth = placed.teeth()
    return ring(0j, placed.pitch_radius) if teeth is None else teeth


def gearbox_speeds(layout: BoxLayout, engaged: Sequence[str]) -> dict[tuple[str, int], float]:
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


def _turning(layout: BoxLayout, speeds: dict[tuple[str, int], float]) -> Iterator[tuple[BoxGear, float]]:
    for placed in layout.gears:
        if (placed.pair, placed.shaft) in speeds:
            yield placed, speeds[placed.pair, placed.shaft]
