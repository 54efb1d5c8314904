"""The studio in the system's Chromium, against the real service."""

from pathlib import Path

import pytest
from playwright.sync_api import sync_playwright

from tests.support.service.running import LEAN, ROOT, RunningServer, until

CHROMIUM = "/usr/bin/chromium"
SCREENS = ROOT / "var" / "screens"
DESKTOP = {"width": 1360, "height": 1000}

FOURBAR = {
    "mechanism": {
        "type": "fourbar",
        "fixed_pivots": {"input": [0, 0], "output": [6, 0]},
        "links": {"input": 2, "coupler": 7, "output": 9},
    }
}

ANSWERED = "#answers:not([aria-busy]) .known"

PUT = "all => all.map(({transform: {baseVal: [{matrix}]}}) => [matrix.e, matrix.f])"
"""Where something that is drawn about the origin has been put, pixels of its picture."""

REPORT_VIOLATIONS = """
addEventListener("securitypolicyviolation", (event) =>
  console.error(`policy violated: ${event.violatedDirective} ${event.blockedURI}`));
"""


def pytest_configure(config):
    Studio.takes_screens = config.getoption("--screens")


@pytest.fixture(scope="session")
def server(tmp_path_factory):
    # A page has one job at a time, beside those that the worker for short ones takes.
    running = RunningServer(tmp_path_factory.mktemp("studio"), LEAN, workers=1)
    # On a busy machine the analysis core is loaded some time after the server is ready; until then it answers 503,
    # which the page bears, but the browser reports.
    until(lambda: running.client.post("/v1/analyses", json=FOURBAR).status_code == 200, 300, "the analysis core")
    yield running
    assert running.stop() == 0


@pytest.fixture(scope="session")
def chromium():
    assert Path(CHROMIUM).exists(), "make test-browser installs chromium, or says how"
    with sync_playwright() as playwright:
        # Without its sandbox, which needs a user other than root; it sees our own page only. And no GPU: solids
        # are drawn by the library that stands in for one. The page itself would take it six times as long.
        drawing = ("--use-angle=swiftshader", "--enable-unsafe-swiftshader")
        drawing += ("--disable-gpu-compositing", "--disable-gpu-rasterization")
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox", *drawing])
        yield browser
        browser.close()


class Studio:
    """The page in a window, and whatever went wrong in it."""

    takes_screens = False

    def __init__(self, browser, url, ready="#fields .field", opened="", before="", **options):
        self.url = url
        self.opened = opened or f"{url}/"
        self.ready = ready
        self.viewport = options.get("viewport")
        self.media = {name: options.get(name, "null") for name in ("color_scheme", "reduced_motion")}
        self.wrong = []
        self.context = browser.new_context(accept_downloads=True, **options)
        self.context.set_default_timeout(60_000)
        self.page = self.context.new_page()
        self.page.add_init_script(f"{REPORT_VIOLATIONS};{before}")
        self.page.on("console", lambda said: self.wrong.append(said.text) if said.type == "error" else None)
        self.page.on("pageerror", lambda error: self.wrong.append(str(error)))
        self.page.on("request", self._asked)
        self.load()

    def _asked(self, request):
        if not request.url.startswith((self.url, f"blob:{self.url}")):
            self.wrong.append(f"request to another host: {request.url}")

    def load(self):
        """The page as it is when it is opened: no job, no key, the first example where no other address is given."""
        self.page.goto(self.opened)
        self.page.wait_for_selector(self.ready)

    def leave(self):
        """Empty the window: the next test finds nothing of this one, and nothing runs on; what went wrong fails."""
        for other in self.context.pages:
            if other is not self.page:
                other.close()
        wrong, self.wrong = self.wrong, []
        if self.page.url.startswith(self.url):
            self.page.evaluate("sessionStorage.clear(); localStorage.clear()")
        self.context.clear_cookies()
        self.page.unroute_all(behavior="ignoreErrors")
        self.page.goto("about:blank")
        self.page.emulate_media(media="null", **self.media)
        self.page.set_viewport_size(self.viewport)
        self.wrong.clear()
        assert wrong == []

    def solve(self):
        self.page.click("#solve")
        self.answered()

    def answered(self):
        """Wait for the designs of the statement that was sent last."""
        self.page.wait_for_selector(ANSWERED, timeout=200_000)

    def screen(self, name, page=None):
        """Take a picture for people to look at, where pictures are asked for."""
        if self.takes_screens:
            SCREENS.mkdir(parents=True, exist_ok=True)
            (page or self.page).screenshot(path=SCREENS / f"{name}.png", full_page=True)

    def close(self):
        self.context.close()
        assert self.wrong == []


@pytest.fixture(scope="session")
def windows(chromium, server):
    """Windows by their options. To open one costs three times as much as to load the page in it anew."""
    opened = {}
    yield opened
    for one in opened.values():
        one.close()


@pytest.fixture
def open_studio(chromium, server, windows):
    """Loads the page into the window that has these options; at the end none of them may have had an error."""
    used = []

    def opens(**options):
        options.setdefault("viewport", dict(DESKTOP))
        key = repr(sorted(options.items()))
        assert key not in used, "a test that needs the same window twice opens one of its own"
        if key in windows:
            windows[key].load()
        else:
            windows[key] = Studio(chromium, server.url, **options)
        used.append(key)
        return windows[key]

    yield opens
    for key in used:
        _left(windows, key)


def _left(windows, key):
    """A window in which something went wrong serves no other test."""
    try:
        windows[key].leave()
    except BaseException:
        windows.pop(key).context.close()
        raise


@pytest.fixture
def studio(open_studio):
    return open_studio()


@pytest.fixture
def kept_studio(chromium, server, windows):
    """A page that is not loaded anew, for a test that begins with a statement, looks at it, and solves nothing."""
    if "kept" not in windows:
        windows["kept"] = Studio(chromium, server.url, viewport=dict(DESKTOP))
    studio = windows["kept"]
    yield studio
    if studio.wrong or studio.page.url != f"{studio.url}/":
        windows.pop("kept").close()


@pytest.fixture
def own_studio(chromium, server):
    """In a window of its own, for a test that changes the window itself."""
    studio = Studio(chromium, server.url, viewport=dict(DESKTOP))
    yield studio
    studio.close()
