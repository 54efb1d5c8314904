"""A turning gear train as GIF: true outlines in mesh, each gear at its own speed."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from kinematics.arrays import Complex
from service.render.gears.train_layout import TrainGear, place_gears, shift_section
from service.render.page.animation import FRAME_COUNT, Stroke, draw_gif, make_circle
from service.render.page.svg import Box
from service.render.page.symbols import COUPLER, GROUND, INPUT, OUTPUT
from synthesis.kinds.gear_train.design import GearTrainDesign
from synthesis.kinds.gear_train.problem import GearTrainProblem
from synthesis.kinds.gear_train.verification import build_train

STAGE_COLOURS = (INPUT, OUTPUT, COUPLER)
"""Colours of the stages."""

STAGE_FILLS = ("#e8eef6", "#e6f1ea", "#f8eee2")

SPOKE_LENGTH, HUB_RADIUS = 0.8, 0.08
"""Length of the line that shows a gear's rotation, and radius of its shaft, as shares of the pitch radius."""

PITCH_COUNT = 6
"""Number of the input gear's teeth that pass in one cycle; gears of other stages do not return to their start."""


def draw_gear_train_animation(design: GearTrainDesign, problem: GearTrainProblem, title: str) -> bytes:
    """Draw a gear train over some teeth of its input as GIF."""
    gears = place_gears(design.mechanism, problem.reverted)
    # Rings lie behind the gears that run inside them.
    gears.sort(key=lambda gear: not gear.gear.internal)
    outlines = [_get_outline(gear) for gear in gears]
    first = design.mechanism.stages[0]
    # A driving worm advances its gear by one tooth per thread.
    turn = math.tau * (1 if first.type == "worm" else PITCH_COUNT) / first.driver
    train = build_train(design.mechanism)

    def make_frames() -> Iterator[list[Stroke]]:
        for k in range(FRAME_COUNT):
            strokes = []
            for gear, points in zip(gears, outlines, strict=True):
                # Rotation of the gear in this frame.
                turned = complex(np.exp(1j * turn * k / FRAME_COUNT * float(gear.speed)))
                colour, face = STAGE_COLOURS[(gear.stage - 1) % 3], STAGE_FILLS[(gear.stage - 1) % 3]
                if gear.section is not None:
                    stage = train.stages[gear.stage - 1]
                    moved = shift_section(gear, stage, train.pressure_angle, turn * k / FRAME_COUNT)
                    strokes.append(Stroke(gear.centre + moved, colour, 1.4, closed=True, fill=face))
                    strokes.append(Stroke(gear.centre + gear.section.axis, GROUND, 1.4))
                    continue
                if gear.gear.internal:
                    strokes += _draw_ring(gear, points, turned, colour, face)
                    continue
                strokes.append(Stroke(gear.centre + points * turned, colour, 1.4, closed=True, fill=face))
                spoke = np.array([gear.centre, gear.centre + SPOKE_LENGTH * gear.pitch_radius * turned])
                strokes.append(Stroke(spoke, colour, 1.6))
                strokes.append(
                    Stroke(make_circle(gear.centre, HUB_RADIUS * gear.pitch_radius), GROUND, 1.4, True, "#ffffff")
                )
            yield strokes

    reached = [
        gear.get_corners()
        if gear.section is not None or gear.gear.internal
        else make_circle(gear.centre, np.abs(points).max())
        for gear, points in zip(gears, outlines, strict=True)
    ]
    return draw_gif(make_frames(), Box.enclose(np.concatenate(reached)))


def _draw_ring(gear: TrainGear, points: Complex, turned: complex, colour: str, face: str) -> list[Stroke]:
    """Return a ring as its rim, its internal teeth, and a line that shows its rotation."""
    inner = gear.gear.root_radius
    return [
        Stroke(make_circle(gear.centre, gear.reach), colour, 1.4, closed=True, fill=face),
        Stroke(gear.centre + points * turned, colour, 1.4, closed=True, fill="#ffffff"),
        Stroke(np.array([gear.centre + inner * turned, gear.centre + gear.reach * turned]), colour, 1.6),
    ]


def _get_outline(placed: TrainGear) -> Complex:
    """Return all teeth around the origin; the pitch circle if there are none."""
    teeth = placed.get_teeth()
    return make_circle(0j, placed.pitch_radius) if teeth is None else teeth
