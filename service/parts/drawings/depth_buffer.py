"""A picture of an assembly with non-parallel axes: triangles with hidden surfaces removed pixel by pixel.

It has the same view as the isometric picture, from above at an angle, and a second one from the opposite side. Every
triangle that faces the viewer is rendered into a depth buffer. Lines are drawn where neighbouring pixels show different
parts, or faces with different normals. The picture is embedded in the sheet as an image.
"""

from __future__ import annotations

import base64
import io
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Real
from service.parts.assembly.model import Assembly, compute_poses
from service.parts.drawings.isometric import COSINE, RIGHT_DIRECTION, SINE, VIEWER_DIRECTION
from service.parts.geometry.meshes import read_triangles
from service.render.page.sheet import BORDER, INNER_WIDTH, TOP, draw_caption, draw_panel, write_sheet
from service.render.page.svg import Box, Element, Viewport, make_element
from service.render.page.symbols import draw_scale_bar

PANEL_HEIGHT, MARGIN = 430.0, 24.0
"""Height of a panel and its margin, pixels."""

OVERSAMPLING = 2
"""Number of samples per pixel of the sheet in each direction."""

LIGHT_DIRECTION = np.array([0.35, 0.75, 0.9])
"""Direction of the light: to the right in the view, upwards in it, and towards the viewer."""

MIN_BRIGHTNESS = 0.45
"""Brightness of a face turned away from the light."""

CREASE_COSINE = 0.75
"""Cosine of the angle between two faces below which the edge between them is drawn."""

MAX_ROWS = 1 << 16
"""Number of triangle rows that are rendered at once."""

EDGE_TOLERANCE = 1e-9
"""Distance from a triangle's edge, in samples, at which a sample counts as inside."""

LINE_COLOUR = np.array([38.0, 44.0, 51.0])


class Shot(NamedTuple):
    """A picture: the bytes of a PNG, and the map from the view to the panel."""

    image: bytes
    shown: Viewport


def draw_rendered_sheet(assembly: Assembly, title: str, at: float) -> str:
    """Draw the picture as an SVG document.

    Parameters
    ----------
    assembly : Assembly
    title : str
        Title without characters that XML forbids.
    at : float
        Input at which it is shown, radians or millimetres along the slide.
    """
    parts: list[Element] = []
    triangles, number = _place_triangles(assembly, at)
    half = 0.5 * (INNER_WIDTH - 12.0)
    for n, words in enumerate(("From the front", "From behind")):
        left = BORDER + n * (half + 12.0)
        panel = Box(left, TOP, left + half, TOP + PANEL_HEIGHT)
        shot = _render_view(assembly, triangles, number, panel, behind=n == 1)
        data = "data:image/png;base64," + base64.b64encode(shot.image).decode()
        image = make_element("image", x=panel.left, y=panel.low, width=panel.width, height=panel.height, href=data)
        bar, _ = draw_scale_bar(Viewport(panel, 0j, 0j, shot.shown.scale), "mm")
        parts += [draw_panel(panel, f"seen_{n + 1}"), image, draw_caption(panel, words), bar]
    words = f"{len(assembly.parts)} parts, isometric; lengths in millimetres"
    if assembly.scale != 1.0:
        words += f"; {assembly.scale:g} times the design"
    return write_sheet(
        title, words, f"An assembly of {len(assembly.parts)} parts from two sides.", parts, TOP + PANEL_HEIGHT
    )


def _render_view(assembly: Assembly, triangles: Real, number: NDArray[np.int64], panel: Box, *, behind: bool) -> Shot:
    """Render the triangles of an assembly as large as a panel permits."""
    turn = -1.0 if behind else 1.0
    right, toward = turn * RIGHT_DIRECTION, turn * VIEWER_DIRECTION
    # Rows: right, up and towards the viewer.
    axes = np.array(
        [
            (right.real, right.imag, 0.0),
            (-SINE * toward.real, -SINE * toward.imag, COSINE),
            (COSINE * toward.real, COSINE * toward.imag, SINE),
        ]
    )
    triangles = triangles @ axes.T
    box = Box.enclose(triangles[:, :, 0].ravel() + 1j * triangles[:, :, 1].ravel())
    shown = Viewport.fit(box, panel, MARGIN, 22.0)
    colours = np.array([[int(part.colour[k : k + 2], 16) for k in (1, 3, 5)] for part in assembly.parts], float)
    return Shot(_encode_png(_render_pixels(triangles, number, colours, shown)), shown)


def _place_triangles(assembly: Assembly, at: float) -> tuple[Real, NDArray[np.int64]]:
    """Return triangles of all parts in place at an input, shape (m, 3, 3), and the part index of each."""
    state = assembly.motion.compute_state(np.array([at]))
    solids = []
    for part in assembly.parts:
        rotation, place = compute_poses(assembly.motion.compute_placement(part.carrier, state), 1)
        corners, triangles = read_triangles(part.mesh)
        solids.append((corners @ rotation[0].T + place[0])[triangles])
    return np.concatenate(solids), np.repeat(np.arange(len(solids)), [len(triangles) for triangles in solids])


def _render_pixels(triangles: Real, number: NDArray[np.int64], colours: Real, shown: Viewport) -> NDArray[np.uint8]:
    """Render the pixels of the panel."""
    panel = shown.panel
    width, height = OVERSAMPLING * round(panel.width), OVERSAMPLING * round(panel.height)
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    length = np.linalg.norm(normals, axis=1)
    # Back faces and faces seen edge-on are invisible.
    seen = normals[:, 2] > 1e-9 * length
    triangles, number, normals = triangles[seen], number[seen], normals[seen] / length[seen, None]
    points = shown.points(triangles[:, :, 0] + 1j * triangles[:, :, 1]) - complex(panel.left, panel.low)
    corners = np.stack(
        [OVERSAMPLING * points.real - 0.5, OVERSAMPLING * points.imag - 0.5, triangles[:, :, 2]], axis=-1
    )
    owner = find_nearest(corners, width, height)
    lit = MIN_BRIGHTNESS + (1.0 - MIN_BRIGHTNESS) * np.clip(
        normals @ (LIGHT_DIRECTION / np.linalg.norm(LIGHT_DIRECTION)), 0.0, 1.0
    )
    paint = np.vstack([np.minimum(255.0, lit[:, None] * (colours[number] + 0.2 * (255.0 - colours[number]))),
                       np.full(3, 255.0)])  # fmt: skip
    picture = paint[owner]
    picture[_find_lines(owner, np.append(number, -1), np.vstack([normals, np.zeros(3)]))] = LINE_COLOUR
    # Averaging the samples smooths the edges.
    picture = picture.reshape(height // OVERSAMPLING, OVERSAMPLING, width // OVERSAMPLING, OVERSAMPLING, 3)
    return np.asarray(np.round(picture.mean(axis=(1, 3))), np.uint8)


def find_nearest(corners: Real, width: int, height: int) -> NDArray[np.int64]:
    """Return the index of the nearest triangle at each sample, -1 for none; shape (height, width).

    Parameters
    ----------
    corners : ndarray, shape (m, 3, 3)
        Column, row and closeness to the viewer of non-degenerate triangles.
    """
    depth, owner = np.full(height * width, -np.inf), np.full(height * width, -1)
    x, y, z = np.moveaxis(corners, -1, 0)
    (ax, bx, cx), (ay, by, cy), (az, bz, cz) = x.T, y.T, z.T
    whole = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay)
    whole = np.where(whole == 0.0, np.inf, whole)  # a degenerate triangle gets a constant depth
    # Gradient of the depth over columns and rows.
    along = ((bz - az) * (cy - ay) - (cz - az) * (by - ay)) / whole
    down = ((cz - az) * (bx - ax) - (bz - az) * (cx - ax)) / whole
    # Rows of samples that each triangle covers, within the picture.
    first = np.maximum(np.ceil(y.min(axis=1)), 0.0).astype(int)
    last = np.minimum(np.floor(y.max(axis=1)), height - 1.0).astype(int)
    number, row = _enumerate_ranges(first, last)
    for some in np.array_split(np.arange(len(row)), 1 + len(row) // MAX_ROWS):
        k, at = number[some], row[some]
        left, right = _find_span(x[k], y[k], at)
        begin = np.maximum(np.ceil(left - EDGE_TOLERANCE), 0.0).astype(int)
        end = np.minimum(np.floor(right + EDGE_TOLERANCE), width - 1.0).astype(int)
        n, column = _enumerate_ranges(begin, end)
        k, at = k[n], at[n]
        near = az[k] + along[k] * (column - ax[k]) + down[k] * (at - ay[k])
        place = at * width + column
        # Discard samples behind earlier triangles.
        nearer = near > depth[place]
        k, near, place = k[nearer], near[nearer], place[nearer]
        # Several triangles may hit one pixel: keep the nearest one.
        np.maximum.at(depth, place, near)
        nearest = near == depth[place]
        # Reversed, so that the first of equally near triangles wins.
        owner[place[nearest][::-1]] = k[nearest][::-1]
    return owner.reshape(height, width)


def _enumerate_ranges(first: NDArray[np.int64], last: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return all integers of ranges, ends included, and the index of the range of each."""
    counts = np.maximum(last - first + 1, 0)
    of = np.repeat(np.arange(len(counts)), counts)
    return of, np.arange(len(of)) - np.repeat(np.cumsum(counts) - counts - first, counts)


def _find_span(x: Real, y: Real, row: NDArray[np.int64]) -> tuple[Real, Real]:
    """Return the left and right ends of rows within their triangles, whose corners have shape (n, 3)."""
    ahead_x, ahead_y = np.roll(x, -1, axis=1), np.roll(y, -1, axis=1)
    rise = ahead_y - y
    share = (row[:, None] - y) / np.where(rise == 0.0, 1.0, rise)
    met = (rise != 0.0) & (share >= 0.0) & (share <= 1.0)
    at = x + share * (ahead_x - x)
    return np.where(met, at, np.inf).min(axis=1), np.where(met, at, -np.inf).max(axis=1)


def _find_lines(owner: NDArray[np.int64], part: NDArray[np.int64], normals: Real) -> NDArray[np.bool_]:
    """Return where a pixel's neighbour shows another part, or a face with a different normal."""
    found = np.zeros(owner.shape, bool)
    for axis in (0, 1):
        ahead = np.roll(owner, -1, axis)
        differ = owner != ahead
        one, other = owner[differ], ahead[differ]
        bent = np.einsum("ij,ij->i", normals[one], normals[other]) < CREASE_COSINE
        found[differ] |= (part[one] != part[other]) | (bent & (one >= 0) & (other >= 0))
    return found


def _encode_png(pixels: NDArray[np.uint8]) -> bytes:
    """Encode a picture of shape (rows, columns, 3) as PNG."""
    from PIL import Image

    buffer = io.BytesIO()
    Image.fromarray(pixels).save(buffer, "PNG")
    return buffer.getvalue()
