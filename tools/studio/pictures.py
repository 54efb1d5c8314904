"""Take the pictures of the studio that the pages show: ``python -m tools.studio.pictures URL`` of a service that runs.

They are taken in the system's Chromium, and have as few colours as they need.
"""

from __future__ import annotations

import argparse
import io
from collections.abc import Callable, Mapping
from pathlib import Path

from PIL import Image
from playwright.sync_api import Page, sync_playwright

from synthesis.registry import KINDS

CHROMIUM = "/usr/bin/chromium"
DOCS = Path(__file__).parents[2] / "docs"
KIND_FOLDER = DOCS / "studio_kinds"

SIZE = (1280, 800)
"""Of the window, pixels."""

KIND_SIZE = (1024, 640)
"""The same for a picture of a kind: the drawer is shut."""

COLOURS = 160
"""Of a picture: text stays legible, pale grounds keep their colour, and a file has some fifty kilobytes."""

WAIT_MS = 200_000

SOON = {"motion": 0, "path": 1, "function": 2, "dwell": 1}
"""The example of each kind that is soon solved, where that is not the first."""


def _solved(page: Page, kind: str, example: int) -> None:
    """State an example, solve it, and let it stand still a third of its way on."""
    page.select_option("#kind", kind)
    page.select_option("#example", str(example))
    page.click("#solve")
    page.wait_for_selector("#answers:not([aria-busy]) .card", timeout=WAIT_MS)
    page.wait_for_selector(".moving .stage .canvas", timeout=WAIT_MS)
    page.wait_for_selector("#watch:not(.waiting)")
    page.locator("#scrub").evaluate(
        "one => { one.value = String(0.3 * one.max); one.dispatchEvent(new Event('input')); one.blur(); }"
    )
    page.wait_for_timeout(300)


def _opening(page: Page) -> None:
    page.wait_for_selector(".moving .live .link")


def _gallery(page: Page) -> None:
    page.click("#gallery-open")
    page.wait_for_selector("#gallery .gallery-card:last-child .thumbnail")


def _choosing(page: Page) -> None:
    """Two designs of the first example beside each other."""
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


PICTURES: Mapping[str, Callable[[Page], None]] = {
    "studio": _opening,
    "studio_gallery": _gallery,
    "studio_choosing": _choosing,
    "studio_guided": _guided,
}


def write(picture: bytes, path: Path) -> None:
    """Write a picture with few colours."""
    image = Image.open(io.BytesIO(picture)).convert("RGB")
    # Of what is drawn in a few pixels the colour is kept, too.
    image.quantize(COLOURS, method=Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE).save(path, optimize=True)


def taken(page: Page, url: str, name: str) -> bytes:
    """The picture of this name, or of this kind, as PNG; the page is one that was asked for reduced motion."""
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
    """Where the picture of this name is kept."""
    return (DOCS if name in PICTURES else KIND_FOLDER) / f"{name}.png"


def main() -> None:
    """Open the page for each picture, and write it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("url", help="where a service without keys runs, as http://127.0.0.1:8000")
    parser.add_argument("--only", nargs="*", help="names of pictures or of kinds; all where none is said")
    asked = parser.parse_args()
    KIND_FOLDER.mkdir(exist_ok=True)
    with sync_playwright() as playwright:
        # Without its sandbox, which needs a user other than root; it sees our own page only.
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        page = browser.new_page(reduced_motion="reduce")
        for name in [*PICTURES, *KINDS]:
            if asked.only and name not in asked.only:
                continue
            write(taken(page, asked.url, name), path_of(name))
        browser.close()


if __name__ == "__main__":
    main()
