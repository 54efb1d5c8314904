"""Pictures of the studio's gallery: the answer of the service to each example, drawn like the cards of the page.

They are drawn in the page by its own module, so that a card and the picture of its example look alike. Pictures of
linkages also show the path of the traced joint. All pictures are symbols of one file. Each symbol contains a checksum
of its problem. The next run solves only examples whose checksum has changed.
"""

from __future__ import annotations

import hashlib
import json
import re
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import httpx
from playwright.sync_api import Page, sync_playwright

from synthesis.registry import KINDS, list_examples

STEPS = 120
"""Number of steps of the motion, and thus of points on the path of a linkage."""

POLL_S = 1.0

WIDTH, HEIGHT = 150, 84
"""Width and height of a picture in pixels, the same as those of the page's cards."""

CHROMIUM = "/usr/bin/chromium"

DRAW = """async ([design, motion]) => {
  const { createThumbnail } = await import("/studio/motion/thumbnail.js");
  const { findTracedJoint } = await import("/studio/motion/circuits.js");
  const skeleton = design.mechanism.skeleton;
  const track = skeleton && motion && motion.joints[findTracedJoint(skeleton)];
  const curve = track ? track.x.map((x, k) => (x === null ? [NaN, NaN] : [x, track.y[k]])) : [];
  return [...createThumbnail(design, curve).children].map(one => new XMLSerializer().serializeToString(one)).join("");
}"""


class TooSlow(Exception):
    """An example is not solved within its time limit."""


def renewed(
    file: Path, client: httpx.Client, url: str, patience_s: float, told: Callable[[str], None] = print
) -> list[str]:
    """Update the pictures in ``file``; return the names of the examples that took longer than ``patience_s`` seconds.

    Raises
    ------
    httpx.HTTPStatusError
        If the service refuses a request.
    RuntimeError
        If an example has no design.
    """
    wanted = {f"{kind}-{n}": problem for kind in KINDS for n, problem in enumerate(list_examples(kind))}
    symbols = {name: symbol for name, symbol in kept(file).items() if sum_in(symbol) == sum_of(wanted.get(name))}
    slow = []
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        page = browser.new_page(reduced_motion="reduce")
        page.goto(f"{url}/")
        for name, problem in wanted.items():
            if name in symbols:
                continue
            try:
                symbols[name] = _symbol(name, sum_of(problem), _drawn(client, page, problem, patience_s))
                told(name)
            except TooSlow:
                slow.append(name)
                told(f"{name} is not solved in {patience_s:g} s")
            listed = "".join(symbols[one] for one in wanted if one in symbols)
            file.write_text(f'<svg xmlns="http://www.w3.org/2000/svg">\n{listed}</svg>\n', encoding="utf-8")
        browser.close()
    return slow


def kept(file: Path) -> dict[str, str]:
    """Return the symbols in a file by name; an empty mapping if there is no file."""
    text = file.read_text("utf-8") if file.exists() else ""
    return {found.group(1): found.group() for found in re.finditer(r'<symbol id="([^"]+)".*?</symbol>\n', text)}


def sum_of(problem: dict[str, Any] | None) -> str:
    """Return the checksum of a problem: twelve hexadecimal digits of its SHA-256."""
    return hashlib.sha256(json.dumps(problem, sort_keys=True).encode()).hexdigest()[:12]


def sum_in(symbol: str) -> str:
    """Return the checksum in a symbol, or an empty string if it has none."""
    found = re.search(r'data-of="(\w+)"', symbol)
    return found.group(1) if found else ""


def _symbol(name: str, of: str, drawing: str) -> str:
    plain = drawing.replace(' xmlns="http://www.w3.org/2000/svg"', "")
    return f'<symbol id="{name}" data-of="{of}" viewBox="0 0 {WIDTH} {HEIGHT}">{shortened(plain)}</symbol>\n'


def shortened(drawing: str) -> str:
    """Return a drawing with all numbers rounded to one decimal, which is enough for a screen."""
    return re.sub(r"-?\d+\.\d{2,}", lambda found: f"{float(found.group()):.1f}", drawing)


def _drawn(client: httpx.Client, page: Page, problem: dict[str, Any], patience_s: float) -> str:
    job = _json(client.post("/v1/jobs", json={"problem": problem}, headers={"Prefer": "wait=5"}))
    at = f"/v1/jobs/{job['id']}"
    deadline = time.monotonic() + patience_s
    while job["status"] in ("queued", "running"):
        if time.monotonic() > deadline:
            client.delete(at).raise_for_status()
            raise TooSlow
        time.sleep(POLL_S)  # the service solves the job, and this program has nothing else to do
        job = _json(client.get(at))
    if not job["result"] or not job["result"]["designs"]:
        raise RuntimeError(f"an example is {job['status']} without a design: {job['error']}: {problem}")
    design = job["result"]["designs"][0]
    motion = None
    if "skeleton" in design["mechanism"]:
        answer = client.get(f"{at}/designs/0/motion", params={"steps": STEPS})
        motion = answer.json() if answer.status_code == 200 else None
    client.delete(at).raise_for_status()
    drawing: str = page.evaluate(DRAW, [design, motion])
    return drawing


def _json(answer: httpx.Response) -> Any:
    return answer.raise_for_status().json()
