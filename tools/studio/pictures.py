"""Take the pictures of the studio for the documentation: ``python -m tools.studio.pictures URL``.

URL is the address of a running service. The pictures are taken in the system's Chromium and reduced to a small palette.
"""

from __future__ import annotations

import argparse
import io
import json
from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw
from playwright.sync_api import Page, sync_playwright
from scipy.interpolate import CubicSpline

from synthesis.registry import KINDS, list_examples

CHROMIUM = "/usr/bin/chromium"
DOCS = Path(__file__).parents[2] / "docs" / "images"
KIND_FOLDER = DOCS / "studio_kinds"

SIZE = (1280, 800)
"""Width and height of the window, pixels."""

KIND_SIZE = (1024, 640)
"""Width and height of the window for the picture of a kind, pixels. The drawer is closed at this size."""

COMMON, FURTHER = 96, 96
"""Number of colours in a picture. The most frequent ones are kept exactly, so that backgrounds and text do not change.
The further ones represent all others. A file then has about fifty kilobytes."""

WAIT_MS = 200_000

SOON = {"motion": 0, "path": 1, "function": 2, "dwell": 1}
"""Index of an example that is solved quickly, by kind, if it is not the first."""


LID: Mapping[str, object] = {
    "kind": "motion",
    "positions": [
        {"x": 0.0, "y": 0.0, "angle": 0.0},
        {"x": 230.0, "y": 240.0, "angle": 40.0},
        {"x": 190.0, "y": 470.0, "angle": 85.0},
    ],
    "length_unit": "mm",
}
"""Problem of the lid of a cabinet."""

LID_OUTLINE = [[0.0, -100.0], [60.0, -100.0], [60.0, 80.0], [-30.0, 80.0]]

ROOM: Mapping[str, object] = {
    **LID,
    "space": {
        "fixed_pivots": {"input": {"polygon": [[-450.0, 60.0], [-130.0, 60.0], [-130.0, 360.0], [-450.0, 360.0]]}},
        "obstacles": [
            {"polygon": [[-450.0, 500.0], [20.0, 500.0], [20.0, 560.0], [-450.0, 560.0]]},
            {"circle": {"center": [410.0, 40.0], "radius": 60.0}},
        ],
        "body": {"outline": LID_OUTLINE},
        "clearance": 5.0,
    },
}
"""Problem of the lid with a workspace: a zone for a pivot, a shelf and a post as obstacles, the outline of the lid."""

SWEPT: Mapping[str, object] = {
    **LID,
    "input_side": {"fixed_pivot": [-170.0, 500.0]},
    "output_side": {"fixed_pivot": [-195.0, 368.0]},
    "max_designs": 1,
    "space": {
        "obstacles": [{"circle": {"center": [-300.0, 40.0], "radius": 60.0}}],
        "body": {"outline": LID_OUTLINE},
        "link_width": 16.0,
    },
}
"""Problem of the lid with both fixed pivots given. It has a single linkage, which is found at once."""

LOADED: Mapping[str, object] = {
    "kind": "quick_return",
    "time_ratio": 1.4,
    "stroke": 100.0,
    "mechanism": "crank_shaper",
    "max_designs": 1,
    "length_unit": "mm",
    "dynamics": {
        "gravity": {},
        "speed_rpm": 60.0,
        "links": {"density": 7800.0, "thickness": 10.0, "width": 20.0},
        "loads": [{"joint": "D", "force": {"constant": [200.0, 0.0]}}],
    },
}
"""Problem of a shaper. Its ram is loaded in the slow stroke, to the left."""

OUTLINE = list_examples("path")[3]["points"]
"""Points of the closed curve of an example. A picture shows the curve, and its first points are traced."""

TRACED = 11

SKETCH = 600
"""Width and height of the picture behind the canvas, pixels."""

SKETCH_MM = 78.67
"""Width at which the page shows that picture, millimetres: four thirds of the height of the points."""


def _stated(page: Page, problem: Mapping[str, object]) -> None:
    """Enter a problem as JSON, and scroll the task to its top."""
    page.locator("#json").evaluate("details => { details.open = true; }")
    page.fill("#json-text", json.dumps(problem))
    page.locator("#json").evaluate("details => { details.open = false; }")
    page.locator("#statement").evaluate("task => { task.scrollTop = 0; }")


def _answered(page: Page) -> None:
    """Solve the entered problem, and stop the motion at 0.3 of its range."""
    page.click("#solve")
    page.wait_for_selector("#answers:not([aria-busy]) .card", timeout=WAIT_MS)
    page.wait_for_selector(".moving .stage .canvas", timeout=WAIT_MS)
    page.wait_for_selector("#watch:not(.waiting)")
    _led(page, 0.3)


def _led(page: Page, share: float) -> None:
    """Set the motion to a share of its range, from 0 to 1."""
    page.locator("#scrub").evaluate(
        "(one, share) => { one.value = String(share * one.max); one.dispatchEvent(new Event('input')); one.blur(); }",
        share,
    )
    page.wait_for_timeout(300)


def _solved(page: Page, kind: str, example: int) -> None:
    """Select an example, solve it, and stop the motion at 0.3 of its range."""
    page.select_option("#kind", kind)
    page.select_option("#example", str(example))
    _answered(page)


def _opening(page: Page) -> None:
    page.wait_for_selector(".moving .live .link")


def _gallery(page: Page) -> None:
    page.click("#gallery-open")
    page.wait_for_selector("#gallery .gallery-card:last-child .thumbnail")


def _choosing(page: Page) -> None:
    """Show two designs of the first example side by side."""
    _solved(page, "motion", 0)
    page.click("#tab-compare")
    page.select_option("#compare-with", "1")
    page.get_by_role("button", name="Side by side").click()
    page.wait_for_selector("#other .live .link")
    page.wait_for_timeout(300)


def _guided(page: Page) -> None:
    page.click("#gallery-open")
    page.locator(".guide-start").first.click()
    page.wait_for_selector(".guided")
    page.wait_for_timeout(300)


def _room(page: Page) -> None:
    _stated(page, ROOM)
    page.wait_for_selector("#sketch .room .area.obstacle")
    page.wait_for_timeout(300)


def _import(page: Page) -> None:
    """Show the picture of a curve behind the points that trace it, with two places of it clicked to set its scale."""
    _stated(page, {"kind": "path", "points": OUTLINE[:TRACED], "length_unit": "mm"})
    with page.expect_file_chooser() as choosing:
        page.click("#curve-import")
    choosing.value.set_files({"name": "sketch.png", "mimeType": "image/png", "buffer": _sketch()})
    page.click("#curve-behind")
    page.wait_for_selector("#sketch image.backdrop")
    page.click("#backdrop-pick")
    box = page.locator("#sketch image.backdrop").bounding_box()
    assert box is not None
    for x, y in ((11.6, 33.5), (59.0, 59.0)):
        u, v = _in_sketch(x, y)
        page.mouse.click(box["x"] + u * box["width"] / SKETCH, box["y"] + v * box["height"] / SKETCH)
    page.fill("#backdrop-distance", "54")
    page.wait_for_timeout(300)


def _in_sketch(x: float, y: float) -> tuple[float, float]:
    """Return the pixel coordinates in the picture of a point of the plane (millimetres).

    The page centres a picture on the middle of the given points, which is (32.3, 41.5) here.
    """
    finer = SKETCH / SKETCH_MM
    return SKETCH / 2 + (x - 32.3) * finer, SKETCH / 2 - (y - 41.5) * finer


def _sketch() -> bytes:
    """Return a picture of the area inside the outline, filled, as PNG."""
    turns = [*OUTLINE, OUTLINE[0]]
    curve = CubicSpline(range(len(turns)), [(one["x"], one["y"]) for one in turns], bc_type="periodic")
    places = [_in_sketch(x, y) for x, y in curve([k / 20 for k in range(20 * len(OUTLINE))])]
    finer = 4
    picture = Image.new("L", (finer * SKETCH, finer * SKETCH), 255)
    ImageDraw.Draw(picture).polygon([(finer * u, finer * v) for u, v in places], fill=90)
    file = io.BytesIO()
    picture.resize((SKETCH, SKETCH), Image.Resampling.BOX).save(file, "PNG")
    return file.getvalue()


def _sweep(page: Page) -> None:
    _stated(page, SWEPT)
    _answered(page)
    page.check("#sweep")
    page.wait_for_selector(".moving .sweep .swept")
    page.get_by_label("Other circuit").uncheck()
    page.locator("#watch").get_by_role("button", name="Zoom in", exact=True).click()
    _led(page, 0.2)


def _planes(page: Page) -> None:
    _solved(page, "quick_return", 3)
    page.wait_for_selector(".moving .side .slab")


def _forces(page: Page) -> None:
    _stated(page, LOADED)
    _answered(page)
    _led(page, 0.2)
    page.click("#tab-plots")
    page.wait_for_selector(".moving .force")
    page.locator("#forces").evaluate("one => one.scrollIntoView()")
    page.wait_for_timeout(300)


def _assembly(page: Page) -> None:
    """Show the assembly of the first example in exploded view."""
    _solved(page, "motion", 0)
    page.click("#tab-assembly")
    page.wait_for_selector("#assembly .parts li", timeout=WAIT_MS)
    _led(page, 0.65)
    page.fill("#explode", "1")
    page.locator("#built").get_by_role("button", name="Fit", exact=True).click()
    page.wait_for_timeout(1000)


PICTURES: Mapping[str, Callable[[Page], None]] = {
    "studio": _opening,
    "studio_gallery": _gallery,
    "studio_choosing": _choosing,
    "studio_guided": _guided,
    "studio_room": _room,
    "studio_import": _import,
    "studio_sweep": _sweep,
    "studio_planes": _planes,
    "studio_forces": _forces,
    "studio_assembly": _assembly,
}


def write(picture: bytes, path: Path) -> None:
    """Write a picture with a reduced palette."""
    image = Image.open(io.BytesIO(picture)).convert("RGB")
    colours, places, counts = np.unique(
        np.asarray(image).reshape(-1, 3), axis=0, return_inverse=True, return_counts=True
    )
    common = colours[np.argsort(-counts, kind="stable")[:COMMON]]
    # Maximum coverage also keeps the colours of details that have only a few pixels.
    further = image.quantize(FURTHER, method=Image.Quantize.MAXCOVERAGE).getpalette() or []
    palette = np.vstack([common, np.reshape(further, (-1, 3))]).astype(np.int64)
    nearest = np.square(colours[:, None].astype(np.int64) - palette).sum(axis=2).argmin(axis=1)
    few = Image.fromarray(nearest[places].reshape(image.height, image.width).astype(np.uint8))
    few.putpalette(palette.ravel().tolist())
    few.save(path, optimize=True)


def taken(page: Page, url: str, name: str) -> bytes:
    """Take the picture of a name, or of a kind of problem, as PNG; ``page`` must prefer reduced motion."""
    width, height = SIZE if name in PICTURES else KIND_SIZE
    page.set_viewport_size({"width": width, "height": height})
    page.goto("about:blank")
    page.goto(url)
    page.wait_for_selector("#fields .field", timeout=WAIT_MS)
    if name in PICTURES:
        PICTURES[name](page)
    else:
        _solved(page, name, SOON.get(name, 0))
    return page.screenshot()


def path_of(name: str) -> Path:
    """Return the path of the file of a picture."""
    return (DOCS if name in PICTURES else KIND_FOLDER) / f"{name}.png"


def main() -> None:
    """Take and write all pictures, or those selected on the command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("url", help="where a service without keys runs, as http://127.0.0.1:8000")
    parser.add_argument("--only", nargs="*", help="names of pictures or of kinds; all where none is said")
    asked = parser.parse_args()
    KIND_FOLDER.mkdir(exist_ok=True)
    with sync_playwright() as playwright:
        # The sandbox does not work as root. It is not needed, because the browser opens only our own page.
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        for name in [*PICTURES, *KINDS]:
            if asked.only and name not in asked.only:
                continue
            # A new browser context has no stored problem of an earlier picture.
            page = browser.new_page(reduced_motion="reduce")
            write(taken(page, asked.url, name), path_of(name))
            page.close()
        browser.close()


if __name__ == "__main__":
    main()
