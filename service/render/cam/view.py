"""The panels of cam drawings: profile, pitch curve, prime and base circle, follower and its envelope, cam angles.

Line styles distinguish the parts without colours, too: profile heavy, pitch curve dashed, prime circle dotted, base
circle dash-dotted, follower bold, its other positions thin. Parts are marked ``data-part``.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator

import numpy as np

from kinematics.arrays import Complex
from service.render.cam.scene import CamScene, SecondScene
from service.render.page.labels import Label, Labels
from service.render.page.numbers import format_angle
from service.render.page.sheet import draw_panel
from service.render.page.svg import Box, Element, Viewport, draw_circle, draw_line, draw_path, draw_text, make_element
from service.render.page.symbols import (
    COUPLER,
    CURVE,
    GREY,
    GROUND,
    INK,
    INPUT,
    OUTPUT,
    PALE,
    draw_arrow,
    draw_bearing,
    draw_scale_bar,
)
from synthesis.kinds.cam.design import BarrelCamMechanism, CamCurve
from synthesis.kinds.cam.profile import read_points

MARGIN, MARGIN_BELOW = 34.0, 24.0
"""Margins of the panel around the content, and additional space below for the scale bar, pixels."""

ENVELOPE_COUNT = 36
"""Number of follower positions drawn around the cam."""

STATION_STEP = 30
"""Interval of the cam angles written around the cam, degrees."""

STATION_RADIUS, STATION_FONT_SIZE = 1.8, 9.5
"""Radius of the points at these cam angles, and font size of the angles, pixels."""

STEM_LENGTH = 0.8
"""Length of a translating follower's stem beyond its roller or face, as a share of the base radius."""

ROTATION_RADIUS, ROTATION_MIDDLE, ROTATION_ANGLE = 0.45, -110.0, 80.0
"""Arc that shows the rotation: radius as a share of the base radius, middle and angle on the sheet in degrees."""

BEARING_SIZE, AXIS_RADIUS = 0.8, 4.0
"""Size of the ground symbols at the cam's centre and at a pivot, and radius of their pins, pixels."""

MIN_ROLLER_RADIUS = 1.5
"""Minimum drawn radius of the follower's roller, pixels, so that a knife edge is visible."""

LINE_STYLES: dict[str, dict[str, str | float]] = {
    "profile": {"stroke": INPUT, "stroke_width": 2.6, "stroke_linejoin": "round"},
    "outer wall": {"stroke": INPUT, "stroke_width": 2.6, "stroke_linejoin": "round"},
    "second cam": {"stroke": OUTPUT, "stroke_width": 2.2, "stroke_linejoin": "round"},
    "pitch curve": {"stroke": CURVE, "stroke_width": 1.1, "stroke_dasharray": "7 4"},
    "prime circle": {"stroke": GREY, "stroke_width": 1.0, "stroke_dasharray": "2 3"},
    "base circle": {"stroke": GREY, "stroke_width": 1.0, "stroke_dasharray": "11 3 2 3"},
    "follower": {"stroke": COUPLER, "stroke_width": 2.4},
    "other positions": {"stroke": PALE, "stroke_width": 0.7},
}
"""Line styles by part; the key of the sheet lists them."""


def find_shown_box(scene: CamScene) -> Box:
    """Return the box that a panel must show."""
    roller = scene.roller
    reach = roller.roller_radius if roller else 0.0
    box = Box.enclose(np.concatenate([scene.pitch_curve, scene.profile])).grow(reach)
    if scene.second is not None:
        box = box.merge_with(Box.enclose(scene.second.pitch_curve).grow(reach))
    # A flat face sweeps beyond the cam.
    face = max((max(abs(a), abs(b)) for a, b in scene.list_faces(1)), default=0.0) if roller is None else 0.0
    box = box.merge_with(Box.enclose(np.array([-face - 1j * face, face + 1j * face]))) if face else box
    if scene.pivot is not None:
        return box.merge_with(Box.enclose(np.array([scene.pivot])).grow(0.1 * scene.base_radius))
    start = scene.pitch_curve[0]
    return box.merge_with(Box.enclose(np.array([start, start + reach + STEM_LENGTH * scene.base_radius])))


def draw_cam_panel(scene: CamScene, box: Box, unit: str) -> Element:
    """Draw a cam in a box of the sheet."""
    viewport = Viewport.fit(find_shown_box(scene), box, MARGIN, MARGIN_BELOW)
    labels = Labels(box)
    group = make_element("g", draw_panel(box, "cam"), fill="none")
    group.add(_draw_envelope(scene, viewport))
    centre = viewport.point(0j)
    group.add(
        draw_circle(centre, viewport.scale * scene.base_radius, data_part="base circle", **LINE_STYLES["base circle"])
    )
    roller = scene.roller
    if roller:
        radius = viewport.scale * roller.prime_radius
        group.add(draw_circle(centre, radius, data_part="prime circle", **LINE_STYLES["prime circle"]))
        group.add(_draw_closed(scene.pitch_curve, viewport, "pitch curve"))
    group.add(_draw_closed(scene.profile, viewport, "profile"))
    if scene.outer_wall is not None:
        group.add(_draw_closed(scene.outer_wall, viewport, "outer wall"))
    if scene.second is not None:
        group.add(*_draw_second(scene, scene.second, viewport))
    group.add(_draw_stations(scene.mechanism.pitch_curve, viewport, labels, centre))
    group.add(_draw_follower(scene, viewport))
    symbol, _ = draw_bearing(centre, BEARING_SIZE)
    group.add(
        make_element(
            "g",
            symbol,
            draw_circle(centre, AXIS_RADIUS, fill="#fff", stroke=GROUND, stroke_width=1.5),
            data_part="centre",
        )
    )
    group.add(_draw_rotation(scene, viewport))
    bar, _ = draw_scale_bar(viewport, unit)
    return group.add(bar, *labels.drawn)


def _draw_second(scene: CamScene, second: SecondScene, viewport: Viewport) -> list[Element | None]:
    """Draw the second of two conjugate cams, with its roller at cam angle 0 and its carrier."""
    centre, radius = complex(second.pitch_curve[0]), second.follower.roller_radius
    carrier = complex(scene.pitch_curve[0]) if scene.pivot is None else scene.pivot
    held = make_element("g", data_part="second follower", **LINE_STYLES["follower"])
    held.add(draw_line(viewport.point(centre), viewport.point(carrier)))
    held.add(
        draw_circle(
            viewport.point(centre), max(viewport.scale * radius, MIN_ROLLER_RADIUS), fill="#fff", fill_opacity=0.7
        )
    )
    return [_draw_closed(second.profile, viewport, "second cam"), held]


def _draw_closed(points: Complex, viewport: Viewport, part: str) -> Element | None:
    around = np.append(points, points[0])
    return draw_path(viewport.clip_to_panel(around), data_part=part, **LINE_STYLES[part])


def _draw_envelope(scene: CamScene, viewport: Viewport) -> Element:
    """Draw the roller or the face in positions around the cam; the profile is their envelope."""
    group = make_element("g", data_part="other positions", **LINE_STYLES["other positions"])
    # Thin the table to the number of drawn positions.
    every = max(1, round(len(scene.angle) / ENVELOPE_COUNT))
    roller = scene.roller
    if roller and roller.roller_radius > 0.0:
        for centre in scene.pitch_curve[:: max(1, round(len(scene.pitch_curve) / ENVELOPE_COUNT))]:
            group.add(draw_circle(viewport.point(complex(centre)), viewport.scale * roller.roller_radius))
    elif roller is None:
        for start, end in scene.list_faces(every):
            group.add(draw_line(viewport.point(start), viewport.point(end)))
    return group


def _draw_stations(curve: CamCurve, viewport: Viewport, labels: Labels, centre: complex | None) -> Element:
    """Draw points on a curve at round cam angles, and those angles away from the cam's centre.

    Without a centre, on an unrolled cam, the angles are above the points.
    """
    group = make_element("g", data_part="cam angles")
    for at, degrees in _find_stations(curve, viewport):
        group.add(draw_circle(at, STATION_RADIUS, fill=CURVE))
        away = 1j if centre is None else at - centre
        words, style = format_angle(degrees, 1), {"fill": GREY}
        labels.place(at, Label(words, STATION_FONT_SIZE, style), clearance=4.0, away=away, optional=True)
    return group


def _find_stations(curve: CamCurve, viewport: Viewport) -> Iterator[tuple[complex, float]]:
    """Yield points of a curve on the sheet at round cam angles, and these angles."""
    for degrees in range(0, 360, STATION_STEP):
        # The nearest point of the curve's own angles.
        k = int(np.argmin(np.abs(np.array(curve.angle) - degrees)))
        yield viewport.point(complex(curve.x[k], curve.y[k])), float(degrees)


def _draw_follower(scene: CamScene, viewport: Viewport) -> Element:
    """Draw the follower at cam angle 0."""
    group = make_element("g", data_part="follower", **LINE_STYLES["follower"])
    reach, roller = STEM_LENGTH * scene.base_radius, scene.roller
    group.add(*(draw_line(viewport.point(start), viewport.point(end)) for start, end in scene.carrier_lines))
    if roller is not None:
        centre = complex(scene.pitch_curve[0])
        if scene.pivot is None:
            group.add(*_draw_stem(viewport, centre, centre + roller.roller_radius + reach))
        # A knife edge has no radius.
        radius = max(viewport.scale * roller.roller_radius, MIN_ROLLER_RADIUS)
        group.add(draw_circle(viewport.point(centre), radius, fill="#fff", fill_opacity=0.7))
        group.add(draw_circle(viewport.point(centre), 2.5, fill=COUPLER))
    elif scene.pivot is None:
        foot = complex(scene.profile[0].real, scene.stem)
        group.add(*_draw_stem(viewport, foot, foot + reach))
    if scene.pivot is not None:
        at = viewport.point(scene.pivot)
        group.add(
            draw_bearing(at, BEARING_SIZE)[0],
            draw_circle(at, AXIS_RADIUS, fill="#fff", stroke=GROUND, stroke_width=1.5),
        )
    return group


def _draw_stem(viewport: Viewport, start: complex, end: complex) -> list[Element]:
    """Draw the stem of a translating follower, with hatched guides on both sides of its outer half."""
    a, b = viewport.point(start), viewport.point(end)
    along = (b - a) / abs(b - a)
    drawn = [draw_line(a, b)]
    for side in (7j, -7j):
        low, high = a + 0.62 * (b - a) + side * along, b - 4.0 * along + side * along
        drawn.append(draw_line(low, high, stroke=GROUND, stroke_width=1.4))
        count = max(2, int(abs(high - low) / 6.0))
        for k in range(count):
            root = low + (high - low) * (k + 0.5) / count
            drawn.append(draw_line(root, root + (0.7 * side - 3.0) * along, stroke=GROUND, stroke_width=0.8))
    return drawn


def _draw_rotation(scene: CamScene, viewport: Viewport) -> Element:
    """Draw an arc with an arrow in the cam's sense of rotation."""
    radius = ROTATION_RADIUS * scene.base_radius * viewport.scale
    centre = viewport.point(0j)
    # On the sheet y points down, so that a counter-clockwise rotation has decreasing angles.
    start, turn = math.radians(ROTATION_MIDDLE), -scene.sense * math.radians(ROTATION_ANGLE)
    start -= 0.5 * turn
    points = centre + radius * np.exp(1j * (start + turn * np.linspace(0.0, 1.0, 25)))
    tip = complex(points[-1])
    back = tip - 9.0 * cmath.exp(1j * (start + turn)) * 1j * math.copysign(1.0, turn)
    group = make_element("g", data_part="rotation", data_rotation=scene.mechanism.rotation)
    group.add(draw_path([points[:-1]], stroke=OUTPUT, stroke_width=1.6), draw_arrow(back, tip, 4.0, OUTPUT))
    middle = centre + (radius + 11.0) * cmath.exp(1j * (start + 0.5 * turn))
    return group.add(draw_text(middle.real, middle.imag, "turns", 9.5, text_anchor="middle", fill=INK))


def draw_barrel_panel(mechanism: BarrelCamMechanism, box: Box, unit: str) -> Element:
    """Draw the unrolled groove: walls heavy, pitch curve dashed, roller bold at cam angle 0, thin at other stations."""
    shown, roller, turn = (
        find_barrel_box(mechanism),
        mechanism.follower.roller_radius,
        math.tau * mechanism.cylinder_radius,
    )
    viewport = Viewport.fit(shown, box, MARGIN, MARGIN_BELOW)
    labels = Labels(box)
    group = make_element("g", draw_panel(box, "barrel cam"), fill="none")
    for x in (0.0, turn):
        ends = viewport.point(complex(x, shown.low)), viewport.point(complex(x, shown.high))
        group.add(draw_line(*ends, data_part="seam", stroke=GREY, stroke_width=1.0, stroke_dasharray="11 3 2 3"))
    stations = _draw_stations(mechanism.pitch_curve, viewport, labels, None)
    rollers = make_element("g", data_part="other positions", **LINE_STYLES["other positions"])
    group.add(
        rollers.add(
            *(draw_circle(at, viewport.scale * roller) for at, _ in _find_stations(mechanism.pitch_curve, viewport))
        )
    )
    for part, curve, style in (
        ("lower wall", mechanism.lower_wall, "profile"),
        ("upper wall", mechanism.upper_wall, "profile"),
        ("pitch curve", mechanism.pitch_curve, "pitch curve"),
    ):
        points = read_points(curve)
        group.add(
            draw_path(viewport.clip_to_panel(np.append(points, points[0] + turn)), data_part=part, **LINE_STYLES[style])
        )
    start = viewport.point(complex(read_points(mechanism.pitch_curve)[0]))
    group.add(draw_circle(start, viewport.scale * roller, data_part="follower", **LINE_STYLES["follower"]))
    return group.add(stations, draw_scale_bar(viewport, unit)[0], *labels.drawn)


def find_barrel_box(mechanism: BarrelCamMechanism) -> Box:
    """Return the box of a barrel cam's panel: one turn of the groove, with the roller at both ends."""
    roller, turn = mechanism.follower.roller_radius, math.tau * mechanism.cylinder_radius
    return Box(-roller, min(mechanism.lower_wall.y), turn + roller, max(mechanism.upper_wall.y))
