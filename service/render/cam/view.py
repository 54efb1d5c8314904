"""The panels of cam drawings: profile, pitch curve, prime and base circle, follower and its envelope, cam angles.

Line styles distinguish the parts without colours, too: profile heavy, pitch curve dashed, prime circle dotted, base
circle dash-dotted, follower bold, its other positions thin. Parts are marked ``data-part``.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from service.render.cam.scene import CamScene, SecondScene
from service.render.page.labels import Labels
from service.render.page.numbers import angle
from service.render.page.sheet import framed
from service.render.page.svg import Box, Element, Viewport, circle, element, line, path, text
from service.render.page.symbols import (
    COUPLER,
    CURVE,
    GREY,
    GROUND,
    INK,
    INPUT,
    OUTPUT,
    PALE,
    arrow,
    bearing,
    scale_bar,
)
from synthesis.kinds.cam.design import BarrelCamMechanism, CamCurve
from synthesis.kinds.cam.mechanism import points_of

Complex = NDArray[np.complex128]

MARGIN, FOOT = 34.0, 24.0
"""Margins of the panel around the content, and additional space below for the scale bar, pixels."""

ENVELOPE = 36
"""Number of follower positions drawn around the cam."""

STATIONS = 30
"""Interval of the cam angles written around the cam, degrees."""

STATION, STATION_TEXT = 1.8, 9.5
"""Radius of the points at these cam angles, and font size of the angles, pixels."""

STEM = 0.8
"""Length of a translating follower's stem beyond its roller or face, as a share of the base radius."""

ROTATION, ROTATION_AT, ROTATION_ANGLE = 0.45, -110.0, 80.0
"""Arc that shows the rotation: radius as a share of the base radius, middle and angle on the sheet in degrees."""

BEARING, AXIS = 0.8, 4.0
"""Size of the ground symbols at the cam's centre and at a pivot, and radius of their pins, pixels."""

SMALLEST_ROLLER = 1.5
"""Minimum drawn radius of the follower's roller, pixels, so that a knife edge is visible."""

STYLES: dict[str, dict[str, str | float]] = {
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


def shown_box(scene: CamScene) -> Box:
    """Return the box that a panel must show."""
    roller = scene.roller
    reach = roller.roller_radius if roller else 0.0
    box = Box.around(np.concatenate([scene.pitch_curve, scene.profile])).grown(reach)
    if scene.second is not None:
        box = box.united(Box.around(scene.second.pitch_curve).grown(reach))
    # A flat face sweeps beyond the cam.
    face = max((max(abs(a), abs(b)) for a, b in scene.faces(1)), default=0.0) if roller is None else 0.0
    box = box.united(Box.around(np.array([-face - 1j * face, face + 1j * face]))) if face else box
    if scene.pivot is not None:
        return box.united(Box.around(np.array([scene.pivot])).grown(0.1 * scene.base_radius))
    start = scene.pitch_curve[0]
    return box.united(Box.around(np.array([start, start + reach + STEM * scene.base_radius])))


def panel(scene: CamScene, box: Box, unit: str) -> Element:
    """Draw a cam in a box of the sheet."""
    viewport = Viewport.fit(shown_box(scene), box, MARGIN, FOOT)
    labels = Labels(box)
    group = element("g", framed(box, "cam"), fill="none")
    group.add(_envelope(scene, viewport))
    centre = viewport.point(0j)
    group.add(circle(centre, viewport.scale * scene.base_radius, data_part="base circle", **STYLES["base circle"]))
    roller = scene.roller
    if roller:
        radius = viewport.scale * roller.prime_radius
        group.add(circle(centre, radius, data_part="prime circle", **STYLES["prime circle"]))
        group.add(_closed(scene.pitch_curve, viewport, "pitch curve"))
    group.add(_closed(scene.profile, viewport, "profile"))
    if scene.outer_wall is not None:
        group.add(_closed(scene.outer_wall, viewport, "outer wall"))
    if scene.second is not None:
        group.add(*_second(scene, scene.second, viewport))
    group.add(_stations(scene.mechanism.pitch_curve, viewport, labels, centre))
    group.add(_follower(scene, viewport))
    symbol, _ = bearing(centre, BEARING)
    group.add(
        element("g", symbol, circle(centre, AXIS, fill="#fff", stroke=GROUND, stroke_width=1.5), data_part="centre")
    )
    group.add(_rotation(scene, viewport))
    bar, _ = scale_bar(viewport, unit)
    return group.add(bar, *labels.drawn)


def _second(scene: CamScene, second: SecondScene, viewport: Viewport) -> list[Element | None]:
    """Draw the second of two conjugate cams, with its roller at cam angle 0 and its carrier."""
    centre, radius = complex(second.pitch_curve[0]), second.follower.roller_radius
    carrier = complex(scene.pitch_curve[0]) if scene.pivot is None else scene.pivot
    held = element("g", data_part="second follower", **STYLES["follower"])
    held.add(line(viewport.point(centre), viewport.point(carrier)))
    held.add(
        circle(viewport.point(centre), max(viewport.scale * radius, SMALLEST_ROLLER), fill="#fff", fill_opacity=0.7)
    )
    return [_closed(second.profile, viewport, "second cam"), held]


def _closed(points: Complex, viewport: Viewport, part: str) -> Element | None:
    around = np.append(points, points[0])
    return path(viewport.shown(around), data_part=part, **STYLES[part])


def _envelope(scene: CamScene, viewport: Viewport) -> Element:
    """Draw the roller or the face in positions around the cam; the profile is their envelope."""
    group = element("g", data_part="other positions", **STYLES["other positions"])
    # Thin the table to the number of drawn positions.
    every = max(1, round(len(scene.angle) / ENVELOPE))
    roller = scene.roller
    if roller and roller.roller_radius > 0.0:
        for centre in scene.pitch_curve[:: max(1, round(len(scene.pitch_curve) / ENVELOPE))]:
            group.add(circle(viewport.point(complex(centre)), viewport.scale * roller.roller_radius))
    elif roller is None:
        for start, end in scene.faces(every):
            group.add(line(viewport.point(start), viewport.point(end)))
    return group


def _stations(curve: CamCurve, viewport: Viewport, labels: Labels, centre: complex | None) -> Element:
    """Draw points on a curve at round cam angles, and those angles away from the cam's centre.

    Without a centre, on an unrolled cam, the angles are above the points.
    """
    group = element("g", data_part="cam angles")
    for at, degrees in _at_stations(curve, viewport):
        group.add(circle(at, STATION, fill=CURVE))
        away = 1j if centre is None else at - centre
        words, style = angle(degrees, 1), {"fill": GREY}
        labels.place(at, words, STATION_TEXT, clearance=4.0, away=away, optional=True, style=style)
    return group


def _at_stations(curve: CamCurve, viewport: Viewport) -> Iterator[tuple[complex, float]]:
    """Yield points of a curve on the sheet at round cam angles, and these angles."""
    for degrees in range(0, 360, STATIONS):
        # The nearest point of the curve's own angles.
        k = int(np.argmin(np.abs(np.array(curve.angle) - degrees)))
        yield viewport.point(complex(curve.x[k], curve.y[k])), float(degrees)


def _follower(scene: CamScene, viewport: Viewport) -> Element:
    """Draw the follower at cam angle 0."""
    group = element("g", data_part="follower", **STYLES["follower"])
    reach, roller = STEM * scene.base_radius, scene.roller
    group.add(*(line(viewport.point(start), viewport.point(end)) for start, end in scene.held))
    if roller is not None:
        centre = complex(scene.pitch_curve[0])
        if scene.pivot is None:
            group.add(*_stem(viewport, centre, centre + roller.roller_radius + reach))
        # A knife edge has no radius.
        radius = max(viewport.scale * roller.roller_radius, SMALLEST_ROLLER)
        group.add(circle(viewport.point(centre), radius, fill="#fff", fill_opacity=0.7))
        group.add(circle(viewport.point(centre), 2.5, fill=COUPLER))
    elif scene.pivot is None:
        foot = complex(scene.profile[0].real, scene.stem)
        group.add(*_stem(viewport, foot, foot + reach))
    if scene.pivot is not None:
        at = viewport.point(scene.pivot)
        group.add(bearing(at, BEARING)[0], circle(at, AXIS, fill="#fff", stroke=GROUND, stroke_width=1.5))
    return group


def _stem(viewport: Viewport, start: complex, end: complex) -> list[Element]:
    """Draw the stem of a translating follower, with hatched guides on both sides of its outer half."""
    a, b = viewport.point(start), viewport.point(end)
    along = (b - a) / abs(b - a)
    drawn = [line(a, b)]
    for side in (7j, -7j):
        low, high = a + 0.62 * (b - a) + side * along, b - 4.0 * along + side * along
        drawn.append(line(low, high, stroke=GROUND, stroke_width=1.4))
        count = max(2, int(abs(high - low) / 6.0))
        for k in range(count):
            root = low + (high - low) * (k + 0.5) / count
            drawn.append(line(root, root + (0.7 * side - 3.0) * along, stroke=GROUND, stroke_width=0.8))
    return drawn


def _rotation(scene: CamScene, viewport: Viewport) -> Element:
    """Draw an arc with an arrow in the cam's sense of rotation."""
    radius = ROTATION * scene.base_radius * viewport.scale
    centre = viewport.point(0j)
    # On the sheet y points down, so that a counter-clockwise rotation has decreasing angles.
    start, turn = math.radians(ROTATION_AT), -scene.sense * math.radians(ROTATION_ANGLE)
    start -= 0.5 * turn
    points = centre + radius * np.exp(1j * (start + turn * np.linspace(0.0, 1.0, 25)))
    tip = complex(points[-1])
    back = tip - 9.0 * cmath.exp(1j * (start + turn)) * 1j * math.copysign(1.0, turn)
    group = element("g", data_part="rotation", data_rotation=scene.mechanism.rotation)
    group.add(path([points[:-1]], stroke=OUTPUT, stroke_width=1.6), arrow(back, tip, 4.0, OUTPUT))
    middle = centre + (radius + 11.0) * cmath.exp(1j * (start + 0.5 * turn))
    return group.add(text(middle.real, middle.imag, "turns", 9.5, text_anchor="middle", fill=INK))


def barrel_panel(mechanism: BarrelCamMechanism, box: Box, unit: str) -> Element:
    """Draw the unrolled groove: walls heavy, pitch curve dashed, roller bold at cam angle 0, thin at other stations."""
    shown, roller, turn = barrel_box(mechanism), mechanism.follower.roller_radius, math.tau * mechanism.cylinder_radius
    viewport = Viewport.fit(shown, box, MARGIN, FOOT)
    labels = Labels(box)
    group = element("g", framed(box, "barrel cam"), fill="none")
    for x in (0.0, turn):
        ends = viewport.point(complex(x, shown.low)), viewport.point(complex(x, shown.high))
        group.add(line(*ends, data_part="seam", stroke=GREY, stroke_width=1.0, stroke_dasharray="11 3 2 3"))
    stations = _stations(mechanism.pitch_curve, viewport, labels, None)
    rollers = element("g", data_part="other positions", **STYLES["other positions"])
    group.add(
        rollers.add(*(circle(at, viewport.scale * roller) for at, _ in _at_stations(mechanism.pitch_curve, viewport)))
    )
    for part, curve, style in (
        ("lower wall", mechanism.lower_wall, "profile"),
        ("upper wall", mechanism.upper_wall, "profile"),
        ("pitch curve", mechanism.pitch_curve, "pitch curve"),
    ):
        points = points_of(curve)
        group.add(path(viewport.shown(np.append(points, points[0] + turn)), data_part=part, **STYLES[style]))
    start = viewport.point(complex(points_of(mechanism.pitch_curve)[0]))
    group.add(circle(start, viewport.scale * roller, data_part="follower", **STYLES["follower"]))
    return group.add(stations, scale_bar(viewport, unit)[0], *labels.drawn)


def barrel_box(mechanism: BarrelCamMechanism) -> Box:
    """Return the box of a barrel cam's panel: one turn of the groove, with the roller at both ends."""
    roller, turn = mechanism.follower.roller_radius, math.tau * mechanism.cylinder_radius
    return Box(-roller, min(mechanism.lower_wall.y), turn + roller, max(mechanism.upper_wall.y))
