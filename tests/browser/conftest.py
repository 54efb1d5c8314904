"""The studio in the system's Chromium, against the real service."""

from pathlib import Path

import pytest
from playwright.sync_api import sync_playwright

from tests.service.running import ROOT, RunningServer, until

CHROMIUM = "/usr/bin/chromium"
SCREENS = ROOT / "var" / "screens"

FOURBAR = {
    "mechanism": {
        "type": "fourbar",
        "fixed_pivots": {"input": [0, 0], "output": [6, 0]},
        "links": {"input": 2, "coupler": 7, "output": 9},
    }
}

REPORT_VIOLATIONS = """
addEventListener("securitypolicyviolation", (event) =>
  console.error(`policy violated: ${event.violatedDirective} ${event.blockedURI}`));
"""


@pytest.fixture(scope="session")
def server(tmp_path_factory):
    running = RunningServer(tmp_path_factory.mktemp("studio"))
    # On a busy machine the analysis core is loaded some time after the server is ready; until then it answers 503,
    # which the page bears, but the browser reports.
    until(lambda: running.client.post("/v1/analyses", json=FOURBAR).status_code == 200, 300, "the analysis core")
    yield running
    assert running.stop() == 0


@pytest.fixture(scope="session")
def chromium():
    assert Path(CHROMIUM).exists(), "make test-browser installs chromium, or says how"
    with sync_playwright() as playwright:
        # Without its sandbox, which needs a user other than root; it sees our own page only.
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        yield browser
        browser.close()


class Studio:
    """The page in a window of its own, and whatever went wrong in it."""

    def __init__(self, browser, url, ready="#fields .field", **options):
        self.url = url
        self.wrong = []
        self.context = browser.new_context(accept_downloads=True, **options)
        self.context.set_default_timeout(60_000)
        self.page = self.context.new_page()
        self.page.add_init_script(REPORT_VIOLATIONS)
        self.page.on("console", lambda said: self.wrong.append(said.text) if said.type == "error" else None)
        self.page.on("pageerror", lambda error: self.wrong.append(str(error)))
        self.page.on("request", self._asked)
        self.page.goto(f"{url}/")
        self.page.wait_for_selector(ready)

    def _asked(self, request):
        if not request.url.startswith((self.url, f"blob:{self.url}")):
            self.wrong.append(f"request to another host: {request.url}")

    def solve(self):
        self.page.click("#solve")
        self.page.wait_for_selector(".card", timeout=200_000)

    def screen(self, name, page=None):
        SCREENS.mkdir(parents=True, exist_ok=True)
        (page or self.page).screenshot(path=SCREENS / f"{name}.png", full_page=True)

    def close(self):
        self.context.close()
        assert self.wrong == []


@pytest.fixture
def open_studio(chromium, server):
    """Opens windows; at the end none of them may have had an error."""
    opened = []

    def opens(**options):
        options.setdefault("viewport", {"width": 1360, "height": 1000})
        opened.append(Studio(chromium, server.url, **options))
        return opened[-1]

    yield opens
    for one in opened:
        one.close()


@pytest.fixture
def studio(open_studio):
    return open_studio()
