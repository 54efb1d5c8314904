"""The pictures of the studio's gallery: what the service answers to each example, drawn as the page draws its cards.

The page's own module draws them, in the page itself, so that a card and the picture of its example are alike; linkages
have the path of their telling point beside. All pictures are symbols of one file. Each has a sum of its statement, by
which the next run knows whether it is still the picture of its example; only the others are solved anew.
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
"""Samples of the path of a linkage."""

POLL_S = 1.0

WIDTH, HEIGHT = 150, 84
"""Of a picture, as the page's cards have it."""

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
    """An example that is not solved in the time that it has."""


def renewed(
    file: Path, client: httpx.Client, url: str, patience_s: float, told: Callable[[str], None] = print
) -> list[str]:
    """Bring the pictures in ``file`` up to date; returns the examples that were too slow for ``patience_s``.

    Raises
    ------
    httpx.HTTPStatusError
        Where the service refuses.
    RuntimeError
        Where an example has no design.
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
    """The symbols of a file by name."""
    text = file.read_text("utf-8") if file.exists() else ""
    return {found.group(1): found.group() for found in re.finditer(r'<symbol id="([^"]+)".*?</symbol>\n', text)}


def sum_of(problem: dict[str, Any] | None) -> str:
    """A statement in twelve digits."""
    return hashlib.sha256(json.dumps(problem, sort_keys=True).encode()).hexdigest()[:12]


def sum_in(symbol: str) -> str:
    """The sum of the statement that a symbol shows."""
    found = re.search(r'data-of="(\w+)"', symbol)
    return found.group(1) if found else ""


def _symbol(name: str, of: str, drawing: str) -> str:
    plain = drawing.replace(' xmlns="http://www.w3.org/2000/svg"', "")
    return f'<symbol id="{name}" data-of="{of}" viewBox="0 0 {WIDTH} {HEIGHT}">{shortened(plain)}</symbol>\n'


def shortened(drawing: str) -> str:
    """The same with a decimal for each number: a screen shows no more."""
    return re.sub(r"-?\d+\.\d{2,}", lambda found: f"{float(found.group()):.1f}", drawing)


def _drawn(client: httpx.Client, page: Page, problem: dict[str, Any], patience_s: float) -> str:
    job = _json(client.post("/v1/jobs", json={"problem": problem}, headers={"Prefer": "wait=5"}))
    at = f"/v1/jobs/{job['id']}"
    deadline = time.monotonic() + patience_s
    while job["status"] in ("queued", "running"):
        if time.monotonic() > deadline:
            client.delete(at).raise_for_status()
            raise TooSlow
        time.sleep(POLL_S)  # the job is another process's; this is a tool that waits for it
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
