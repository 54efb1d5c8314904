"""A service with keys: the page asks for one, keeps it for the tab, and everything works with it."""

import pytest

from tests.browser.conftest import Studio
from tests.support.browser.studio import PLAIN, drawn, state
from tests.support.service.access import made
from tests.support.service.running import LEAN, RunningServer, until

pytestmark = pytest.mark.browser


def test_a_key_opens_the_service(chromium, tmp_path):
    key = made(tmp_path, "acme")
    server = RunningServer(tmp_path, LEAN, workers=1, reserve=0)
    studio = Studio(chromium, server.url, ready="#key[open]")
    try:
        page = studio.page
        assert "Send an API key" in page.inner_text("#status")
        # The browser itself reports the answer 401; nothing else may have gone wrong.
        assert [text for text in studio.wrong if "401" not in text] == []
        studio.wrong.clear()
        page.fill("#key-value", key)
        page.keyboard.press("Enter")
        page.wait_for_selector("#fields .field")
        assert page.inner_text("#status") == ""
        state(page, PLAIN)
        studio.solve()
        page.wait_for_selector(".moving .live .link")
        until(lambda: drawn(page), 30, "the drawing")
        page.click("#tab-files")
        with page.expect_download():
            page.get_by_role("button", name="DXF", exact=True).click()
        assert key not in page.content()
        assert key not in page.evaluate("JSON.stringify({...localStorage}) + document.cookie")
        studio.close()
    finally:
        assert server.stop() == 0
