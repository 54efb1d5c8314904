"""How soon the studio's first machine moves, from the moment that its page is asked for.

    python -m benchmarks.opening [--times 7]

A real server on a free loopback port, which has served the page once, and the system's Chromium, which opens it with an
empty cache each time. The page's own clock is read in the first frame in which the linkage stands elsewhere than in the
frame before.
"""

from __future__ import annotations

import argparse
import statistics
import tempfile
from pathlib import Path

from playwright.sync_api import sync_playwright

from tests.browser.conftest import CHROMIUM
from tests.support.browser.opening import MOVES
from tests.support.service.running import RunningServer

SIZES = {"desktop": (1440, 900), "phone": (390, 844)}


def main() -> None:
    """Print the times for a desktop and a phone."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--times", type=int, default=7)
    times = parser.parse_args().times
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as playwright:
        server = RunningServer(Path(folder), workers=1)
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        for name, (width, height) in SIZES.items():
            taken = []
            for _ in range(times + 1):
                context = browser.new_context(viewport={"width": width, "height": height})
                page = context.new_page()
                page.goto(f"{server.url}/")
                taken.append(float(page.wait_for_function(MOVES, polling="raf").json_value()))
                context.close()
            told = ", ".join(f"{one:.2f}" for one in sorted(taken[1:]))
            print(f"{name}: the first machine moves after {statistics.median(taken[1:]):.2f} s (of {told})")
        browser.close()
        server.stop()


if __name__ == "__main__":
    main()
